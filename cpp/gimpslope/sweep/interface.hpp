// How soil meets a rigid body that it may slide along: at a node that the body holds, the soil
// takes the normal velocity of the body where it would run into it, and as friction at most mu
// times as much impulse along the surface; where it comes off, it is free (Bardenhagen et al. 2001,
// An improved contact algorithm for the material point method).
#pragma once

#include <cmath>

#include "body_terms.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Gap up to which soil touches a body, cells: the shape functions of points that have moved tell
/// an edge no better.
constexpr double kTouch = 0.1;
constexpr double kNoSlope = 1e-3;  // of a share, a cell: no telling which way it falls

/// Distance from a node to the flat edge of what fills a share of its cell, in cells and positive
/// outside of it. Of a half-plane at a distance d that share is (1 - d)^2 / 2 and falls by 1 - d a
/// cell, and 1 - (1 + d)^2 / 2 and 1 + d where the node is within. The ratio of both tells d, also
/// where what fills the cell ends along the edge (as the contact distances of Nairn, Hammerquist
/// and Smith 2020).
inline double distance_to_edge(double share, double slope) {
  if (slope <= kNoSlope) return share > 0.5 ? -1.0 : 1.0;
  const double ratio = share / slope;
  return ratio <= 0.5 ? 1.0 - 2.0 * ratio : std::sqrt(ratio * ratio + 2.0) - ratio - 1.0;
}

/// The body's normal at a node: down the steeper one of the two shares (maximum volume gradient,
/// Nairn 2013, Modeling imperfect interfaces in the material point method), so that it is that of
/// the flat where a corner meets a flat. Returns whether soil and body touch there.
inline bool face_soil(const GridView& g, BodyNode& node) {
  const double per_area = 1.0 / (g.cell * g.cell);
  const double* soil = g.soil + 4 * node.node;
  const Pair of_soil = -per_area * Pair(soil[0], soil[1]);  // up the share of the soil
  const Pair of_body(node.slope[0], node.slope[1]);         // down that of the body
  const double steep_soil = std::hypot(of_soil[0], of_soil[1]);
  const double steep_body = std::hypot(of_body[0], of_body[1]);
  const double steepest = steep_soil > steep_body ? steep_soil : steep_body;
  if (steepest <= kNoSlope) {
    node.meeting = Meeting::welded;
    return true;
  }
  const Pair normal = (1.0 / steepest) * (steep_soil > steep_body ? of_soil : of_body);
  set(node.normal, normal);
  const double gap = distance_to_edge(per_area * soil[2], (of_soil * normal).sum()) +
                     distance_to_edge(node.share, (of_body * normal).sum());
  return gap <= kTouch;
}

/// Velocity of soil that touches the body, before it is strained: not into the body, and as walls
/// have it (see wall.hpp) not off it or along it where it was held so in the step before.
inline Pair velocity_at_interface(const BodyNode& node, const Pair& soil, const Pair& body) {
  const Pair normal(node.normal[0], node.normal[1]), tangent(-normal[1], normal[0]);
  if (node.meeting == Meeting::welded) return body;
  const double off = ((soil - body) * normal).sum(), along = ((soil - body) * tangent).sum();
  Pair result = soil;
  if (node.meeting != Meeting::apart || off < 0.0) result -= off * normal;
  if (node.meeting == Meeting::stuck) result -= along * tangent;
  return result;
}

/// How soil meets the body by its velocity from that of the body there.
inline Meeting meeting_of(const BodyNode& node, const Pair& apart, double friction) {
  if (node.meeting == Meeting::welded) return Meeting::welded;
  const Pair normal(node.normal[0], node.normal[1]);
  const double into = -(apart * normal).sum();
  if (into <= 0.0) return Meeting::apart;
  return std::fabs(cross(node.normal, apart)) > friction * into ? Meeting::slipping
                                                                : Meeting::stuck;
}

/// The matrix that turns the approach of the soil into the impulse that it takes: its mass times
/// (n - s mu t) n^T where it slips, with s the direction of slip, and times one where it sticks.
struct Answer {
  double xx = 0.0, xy = 0.0, yx = 0.0, yy = 0.0;

  Pair of(const Pair& v) const { return {xx * v[0] + xy * v[1], yx * v[0] + yy * v[1]}; }
};

inline Answer answer_of(const BodyNode& node, double friction) {
  Answer a;
  if (node.meeting == Meeting::apart) return a;
  a.xx = a.yy = node.mass;
  if (node.meeting != Meeting::slipping) return a;
  const double nx = node.normal[0], ny = node.normal[1];
  const double rub = -node.slip * friction;
  const double x = node.mass * (nx - rub * ny), y = node.mass * (ny + rub * nx);
  return {x * nx, x * ny, y * nx, y * ny};
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
