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
constexpr int kMostSettlings = 20;

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

/// Solves a x = b for three unknowns, by Cramer's rule.
inline void solve3(const double (&a)[3][3], const double (&b)[3], double (&x)[3]) {
  const auto minor = [&](int i, int j, int k, int l) {
    return a[i][k] * a[j][l] - a[i][l] * a[j][k];
  };
  const double first[3] = {minor(1, 2, 1, 2), -minor(0, 2, 1, 2), minor(0, 1, 1, 2)};
  const double second[3] = {-minor(1, 2, 0, 2), minor(0, 2, 0, 2), -minor(0, 1, 0, 2)};
  const double third[3] = {minor(1, 2, 0, 1), -minor(0, 2, 0, 1), minor(0, 1, 0, 1)};
  double whole = 0.0;
  for (int i = 0; i < 3; ++i) whole += a[i][0] * first[i];
  x[0] = x[1] = x[2] = 0.0;
  for (int i = 0; i < 3; ++i) {
    x[0] += first[i] * b[i] / whole;
    x[1] += second[i] * b[i] / whole;
    x[2] += third[i] * b[i] / whole;
  }
}

/// Adds what a node answers to the equations of the motion (vx, vy, spin) of its body.
inline void add_answer(const Answer& m, const BodyNode& node, double (&a)[3][3], double (&b)[3]) {
  const Pair whole = m.of(Pair(node.free[0], node.free[1]));
  const Pair turn = m.of(Pair(-node.arm[1], node.arm[0]));
  const double left = node.arm[0] * m.yx - node.arm[1] * m.xx;
  const double up = node.arm[0] * m.yy - node.arm[1] * m.xy;
  const double rows[3][3] = {
      {m.xx, m.xy, turn[0]}, {m.yx, m.yy, turn[1]}, {left, up, cross(node.arm, turn)}};
  const double right[3] = {whole[0], whole[1], cross(node.arm, whole)};
  for (int i = 0; i < 3; ++i) {
    b[i] += right[i];
    for (int j = 0; j < 3; ++j) a[i][j] += rows[i][j];
  }
}

/// The impulses between a body and the soil at its nodes, and its velocity with them: that velocity
/// tells how the soil meets it, and the impulses, linear in it, what it is; in turn until meetings
/// and directions of slip stay (a semi-smooth Newton method).
inline void settle_nodes(const BodiesView& all, int body) {
  HeldBody& held = all.held[body];
  const double mass = all.mass[body], inertia = all.inertia[body], friction = all.friction[body];
  BodyNode* nodes = all.nodes + static_cast<std::ptrdiff_t>(body) * all.window * all.window;
  const int count = all.reaches[body];
  const double alone[3] = {held.velocity[0] + held.taken[0] / mass,
                           held.velocity[1] + held.taken[1] / mass,
                           held.spin + held.taken_moment / inertia};
  double now[3] = {held.velocity[0], held.velocity[1], held.spin};
  const auto apart = [&](const BodyNode& node, const double* motion) -> Pair {
    return Pair(node.free[0], node.free[1]) - velocity_at(motion, motion[2], node.arm);
  };
  for (int settling = 0; settling < kMostSettlings; ++settling) {
    bool same = settling > 0;
    double a[3][3] = {{mass, 0.0, 0.0}, {0.0, mass, 0.0}, {0.0, 0.0, inertia}};
    double b[3] = {mass * alone[0], mass * alone[1], inertia * alone[2]};
    held.taken[0] = held.taken[1] = held.taken_moment = 0.0;
    for (int k = 0; k < count; ++k) {
      BodyNode& node = nodes[k];
      const Pair off = apart(node, now);
      const Meeting meeting = meeting_of(node, off, friction);
      const double slip = cross(node.normal, off) > 0.0 ? 1.0 : -1.0;
      same = same && meeting == node.meeting && (meeting != Meeting::slipping || slip == node.slip);
      node.meeting = meeting;
      node.slip = slip;
      const Answer m = answer_of(node, friction);
      set(node.taken, -m.of(off));
      const Pair taken(node.taken[0], node.taken[1]);
      for (int c = 0; c < 2; ++c) held.taken[c] += taken[c];
      held.taken_moment += cross(node.arm, taken);
      add_answer(m, node, a, b);
    }
    if (same) break;
    solve3(a, b, now);
  }
  for (int c = 0; c < 2; ++c) held.velocity[c] = alone[c] - held.taken[c] / mass;
  held.spin = alone[2] - held.taken_moment / inertia;
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
