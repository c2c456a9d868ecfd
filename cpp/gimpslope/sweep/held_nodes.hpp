// Which nodes a rigid body holds, and that they move with it.
#pragma once

#include <cmath>

#include "body_terms.hpp"
#include "interface.hpp"
#include "weights.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Share of a cell from which on a body holds its node; where it is small, of its largest share. Of
/// a flat edge those are held up to e^(-1/2) cells away, with a share of (1 - e^(-1/2))^2 / 2: soil
/// that is strained between the edge, a part s of a cell away from the first free line of nodes,
/// and the next such line is too soft or too stiff by turns as s goes from 0 to 1, and right in the
/// mean.
constexpr double kHeldShare = 0.0774;

/// Column and row of the lower left node that a body may reach.
inline void find_window(const View<double>& view, int body, int (&corner)[2]) {
  const GridView& g = view.grid;
  for (int c = 0; c < 2; ++c) {
    const double low = view.bodies->state[body].centre[c] - view.bodies->radius[body];
    corner[c] = static_cast<int>(std::floor((low - (c == 0 ? g.left : g.bottom)) / g.cell)) - 2;
  }
}

/// Adds up the share of each cell that a body fills, and with gradients how it falls: three numbers
/// for each node of its window, whose lower left one is at `corner`.
template <class Shape, bool kOwnDomain, Need kNeed>
void add_shares(const View<double>& view, int body, const int (&corner)[2], double* shares) {
  const BodiesView& all = *view.bodies;
  const GridView& g = view.grid;
  const BodyState& state = all.state[body];
  const double per_area = 1.0 / g.cell * (1.0 / g.cell);
  alignas(kCacheLine) double x[kBlock], y[kBlock], lx[kBlock], ly[kBlock];
  View<double> local = view;  // of some points of the body, one after the other
  local.points.x = x;
  local.points.y = y;
  local.points.half_length[0] = lx;
  local.points.half_length[1] = ly;
  const double cosine = std::cos(state.angle), sine = std::sin(state.angle);
  Weights<Shape, kNeed> weights;
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
      double* first = shares + 3 * ((row - corner[1]) * all.window + column - corner[0]);
      const double share = view.points.volume[all.member[begin + k]] * per_area;
      for (int j = 0; j < Shape::nodes; ++j) {
        for (int i = 0; i < Shape::nodes; ++i) {
          double* node = first + 3 * (j * all.window + i);
          if constexpr (kNeed == Need::gradients) {
            const Quad along_x = weights.pairs_x(i, k), along_y = weights.pairs_y(j, k);
            node[0] += share * along_x[1] * along_y[0];
            node[1] += share * along_x[0] * along_y[0];
            node[2] += share * along_x[1] * along_y[1];
          } else {
            node[0] += share * weights.value_x(i, k) * weights.value_y(j, k);
          }
        }
      }
    }
  }
}

/// The nodes that a body reaches, with its share of their cells and, where soil may slide along it,
/// how that falls.
template <class Shape, bool kOwnDomain>
void reach_nodes(const View<double>& view, int thread, int body) {
  const BodiesView& all = *view.bodies;
  const GridView& g = view.grid;
  const BodyState& state = all.state[body];
  const int width = all.window, size = width * width;
  double* shares = all.shares + 3 * thread * size;
  for (int k = 0; k < 3 * size; ++k) shares[k] = 0.0;
  int corner[2];
  find_window(view, body, corner);
  const int left = corner[0], bottom = corner[1];
  if (all.friction[body] < 0.0) {
    add_shares<Shape, kOwnDomain, Need::values>(view, body, corner, shares);
  } else {
    add_shares<Shape, kOwnDomain, Need::gradients>(view, body, corner, shares);
  }
  double most = 0.0;
  for (int k = 0; k < size; ++k) most = shares[3 * k] > most ? shares[3 * k] : most;
  const double least = kHeldShare * (most < 1.0 ? most : 1.0);
  BodyNode* nodes = all.nodes + static_cast<std::ptrdiff_t>(body) * size;
  int count = 0;
  for (int j = 0; j < width; ++j) {
    for (int i = 0; i < width; ++i) {
      const double* found = shares + 3 * (j * width + i);
      const double share = found[0];
      if (share == 0.0) continue;
      const int row = bottom + j, column = left + i;
      BodyNode& node = nodes[count++];
      node.node = row * g.stride + column;
      node.share = share;
      node.slope[0] = found[1];
      node.slope[1] = found[2];
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

/// Gives each node that several bodies reach to the one with the largest share. By one thread, in
/// the order of the bodies.
inline void share_nodes(const BodiesView& all) {
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(all.window) * all.window;
  for (int body = 0; body < all.count; ++body) {
    BodyNode* nodes = all.nodes + body * size;
    for (int k = 0; k < all.reaches[body]; ++k) {
      std::int32_t& owner = all.owner[nodes[k].node];
      if (owner < 0) {
        owner = static_cast<std::int32_t>(body * size + k);
        continue;
      }
      BodyNode& before = all.nodes[owner];
      if (before.share < nodes[k].share) {
        before.held = false;
        owner = static_cast<std::int32_t>(body * size + k);
      } else {
        nodes[k].held = false;
      }
    }
  }
  for (int body = 0; body < all.count; ++body)
    for (int k = 0; k < all.reaches[body]; ++k) all.owner[all.nodes[body * size + k].node] = -1;
}

/// How the soil at a node met a body in the step before.
inline Meeting met_before(const View<double>& view, int body, std::int32_t node) {
  const BodiesView& all = *view.bodies;
  const GridView& g = view.grid;
  const int row = node / g.stride, column = node - row * g.stride;
  const int i = column + g.column - all.window_at[2 * body];
  const int j = row + g.row - all.window_at[2 * body + 1];
  if (i < 0 || i >= all.window || j < 0 || j >= all.window) return Meeting::apart;
  const std::ptrdiff_t place =
      (static_cast<std::ptrdiff_t>(body) * all.window + j) * all.window + i;
  return all.meetings[place] == Meeting::welded ? Meeting::stuck : all.meetings[place];
}

/// Remembers how the soil at the nodes of a body has met it.
inline void remember_meetings(const View<double>& view, int body) {
  const BodiesView& all = *view.bodies;
  const GridView& g = view.grid;
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(all.window) * all.window;
  Meeting* meetings = all.meetings + body * size;
  for (std::ptrdiff_t k = 0; k < size; ++k) meetings[k] = Meeting::apart;
  int corner[2];
  find_window(view, body, corner);
  all.window_at[2 * body] = corner[0] + g.column;
  all.window_at[2 * body + 1] = corner[1] + g.row;
  const BodyNode* nodes = all.nodes + body * size;
  for (int k = 0; k < all.reaches[body]; ++k) {
    const int row = nodes[k].node / g.stride, column = nodes[k].node - row * g.stride;
    meetings[(row - corner[1]) * all.window + column - corner[0]] = nodes[k].meeting;
  }
}

/// Puts the held nodes at the velocity of their body, before the soil is strained; where the soil
/// may slide along it, as far as it touches it.
inline void hold_nodes(const View<double>& view, int body) {
  const BodiesView& all = *view.bodies;
  BodyNode* nodes = all.nodes + static_cast<std::ptrdiff_t>(body) * all.window * all.window;
  const bool slides = all.friction[body] >= 0.0;
  int count = 0;
  for (int k = 0; k < all.reaches[body]; ++k) {
    if (!nodes[k].held) continue;
    if (slides) {
      nodes[k].meeting = met_before(view, body, nodes[k].node);
      if (!face_soil(view.grid, nodes[k])) continue;
    }
    nodes[count++] = nodes[k];
  }
  all.reaches[body] = count;
  for (int k = 0; k < count; ++k) {
    double* shown = view.grid.velocity + 4 * nodes[k].node;
    Pair v = velocity_at(all.state[body].velocity, all.state[body].spin, nodes[k].arm);
    if (slides) v = velocity_at_interface(nodes[k], Pair(shown[0], shown[2]), v);
    quad(shown) = Quad{v[0], v[0], v[1], v[1]};
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
