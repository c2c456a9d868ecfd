// Which nodes a rigid body holds, and that they move with it.
#pragma once

#include <cmath>

#include "body_motion.hpp"
#include "contacts.hpp"
#include "weights.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Share of a cell from which on a body holds its node; where it is small, of its largest share. Of
/// a flat edge those are held up to e^(-1/2) cells away, with a share of (1 - e^(-1/2))^2 / 2: soil
/// that is strained between the edge, a part s of a cell away from the first free line of nodes,
/// and the next such line is too soft or too stiff by turns as s goes from 0 to 1, and right in the
/// mean.
constexpr double kHeldShare = 0.0774;

/// The nodes that a body reaches, with its share of their cells.
template <class Shape, bool kOwnDomain>
void reach_nodes(const View<double>& view, int thread, int body) {
  const BodiesView& all = *view.bodies;
  const GridView& g = view.grid;
  const BodyState& state = all.state[body];
  const int width = all.window, size = width * width;
  double* shares = all.shares + thread * size;
  for (int k = 0; k < size; ++k) shares[k] = 0.0;
  const double per_cell = 1.0 / g.cell, per_area = per_cell * per_cell;
  const int left =
      static_cast<int>(std::floor((state.centre[0] - all.radius[body] - g.left) * per_cell)) - 2;
  const int bottom =
      static_cast<int>(std::floor((state.centre[1] - all.radius[body] - g.bottom) * per_cell)) - 2;

  alignas(kCacheLine) double x[kBlock], y[kBlock], lx[kBlock], ly[kBlock];
  View<double> local = view;  // of some points of the body, one after the other
  local.points.x = x;
  local.points.y = y;
  local.points.half_length[0] = lx;
  local.points.half_length[1] = ly;
  const double cosine = std::cos(state.angle), sine = std::sin(state.angle);
  Weights<Shape, Need::values> weights;
  for (int begin = all.begin[body]; begin < all.begin[body + 1]; begin += kBlock) {
    const int left_over = all.begin[body + 1] - begin, n = left_over < kBlock ? left_over : kBlock;
    for (int k = 0; k < n; ++k) {
      const double ox = all.offset[0][begin + k], oy = all.offset[1][begin + k];
      x[k] = state.centre[0] + cosine * ox - sine * oy;
      y[k] = state.centre[1] + sine * ox + cosine * oy;
      lx[k] = all.half_length[0][begin + k];
      ly[k] = all.half_length[1][begin + k];
    }
    evaluate<Shape, kOwnDomain>(local, 0, n, weights);
    for (int k = 0; k < n; ++k) {
      const int row = weights.first[k] / g.stride, column = weights.first[k] - row * g.stride;
      double* first = shares + (row - bottom) * width + column - left;
      const double share = view.points.volume[all.member[begin + k]] * per_area;
      for (int j = 0; j < Shape::nodes; ++j)
        for (int i = 0; i < Shape::nodes; ++i)
          first[j * width + i] += share * weights.value_x(i, k) * weights.value_y(j, k);
    }
  }
  double most = 0.0;
  for (int k = 0; k < size; ++k) most = shares[k] > most ? shares[k] : most;
  const double least = kHeldShare * (most < 1.0 ? most : 1.0);
  BodyNode* nodes = all.nodes + static_cast<std::ptrdiff_t>(body) * size;
  int count = 0;
  for (int j = 0; j < width; ++j) {
    for (int i = 0; i < width; ++i) {
      const double share = shares[j * width + i];
      if (share == 0.0) continue;
      const int row = bottom + j, column = left + i;
      BodyNode& node = nodes[count++];
      node.node = row * g.stride + column;
      node.share = share;
      node.arm[0] = g.left + column * g.cell - state.centre[0];
      node.arm[1] = g.bottom + row * g.cell - state.centre[1];
      // At a wall the wall rules; where there is no soil there is nothing to hold.
      const bool at_wall = column <= g.wall[Side::left] || column >= g.wall[Side::right] ||
                           row <= g.wall[Side::bottom] || row >= g.wall[Side::top];
      node.held = share >= least && !at_wall && g.momentum[4 * node.node] > 0.0;
    }
  }
  all.reaches[body] = count;
}

/// Gives each node that several bodies reach to the one with the largest share, and finds where
/// bodies overlap. By one thread, in the order of the bodies.
inline void share_nodes(const BodiesView& all) {
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(all.window) * all.window;
  *all.contact_count = 0;
  for (int body = 0; body < all.count; ++body) {
    BodyNode* nodes = all.nodes + body * size;
    for (int k = 0; k < all.reaches[body]; ++k) {
      std::int32_t& owner = all.owner[nodes[k].node];
      if (owner < 0) {
        owner = static_cast<std::int32_t>(body * size + k);
        continue;
      }
      BodyNode& before = all.nodes[owner];
      if (before.share + nodes[k].share > 1.0)
        add_overlap(all, static_cast<int>(owner / size), before, body, nodes[k]);
      if (before.share < nodes[k].share) {
        before.held = false;
        owner = static_cast<std::int32_t>(body * size + k);
      } else {
        nodes[k].held = false;
      }
    }
  }
  finish_overlaps(all);
  for (int body = 0; body < all.count; ++body)
    for (int k = 0; k < all.reaches[body]; ++k) all.owner[all.nodes[body * size + k].node] = -1;
}

/// Puts the held nodes at the velocity of their body, before the soil is strained.
inline void hold_nodes(const View<double>& view, int body) {
  const BodiesView& all = *view.bodies;
  BodyNode* nodes = all.nodes + static_cast<std::ptrdiff_t>(body) * all.window * all.window;
  int count = 0;
  for (int k = 0; k < all.reaches[body]; ++k)
    if (nodes[k].held) nodes[count++] = nodes[k];
  all.reaches[body] = count;
  for (int k = 0; k < count; ++k) {
    const Pair v = velocity_at(all.state[body].velocity, all.state[body].spin, nodes[k].arm);
    quad(view.grid.velocity + 4 * nodes[k].node) = Quad{v[0], v[0], v[1], v[1]};
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
