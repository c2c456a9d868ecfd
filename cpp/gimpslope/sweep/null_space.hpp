// XPIC: PIC that leaves out less of the points' velocities V, the noise alone that no node sees
// (Hammerquist and Nairn 2017, doi 10.1016/j.cma.2017.01.035). With S from nodes to points and S+,
// the mean of the points at each node within the walls, a step of order m makes of them
//
//   V <- (1 - (1 - S S+)^m) V + S (v+ - v') = S (v+ + sum of (1 - S+ S)^k v', k = 1 to m - 1)
//
// with v' = S+ V. Order 1 is PIC. Walls hold in every term what they hold in v', or else motion
// that ends at a wall would be taken for noise. Places move by S v+ dt, as with any other transfer.
#pragma once

#include "loops.hpp"
#include "nodes.hpp"
#include "scatter.hpp"
#include "weights.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// The terms begin with v'.
inline void start_terms(const GridView& g, int row) {
  for (int k = row * g.stride + g.active[row].begin; k < row * g.stride + g.active[row].end; ++k)
    quad(g.terms + 4 * k) = Quad{g.velocity[4 * k], g.velocity[4 * k + 2], 0.0, 0.0};
}

/// m S u of the present term u to the nodes.
template <class Shape, bool kOwnDomain, class Real>
[[gnu::noinline]] void spread_term(const View<Real>& view, const Block& block) {
  const int begin = block.begin, n = block.end - block.begin;
  const Real* mass = view.points.mass + begin;
  Weights<Shape, Need::values> weights;
  evaluate<Shape, kOwnDomain>(view, begin, n, weights);
  NodeSums<Shape> nodes(view.grid.spread, view.grid.stride);
  for (int k = 0; k < n; ++k) {
    const auto x = [&](int i) {
      return weights.value_x(i, k);
    };
    const auto y = [&](int j) {
      return weights.value_y(j, k);
    };
    const Quad term = gather<Shape>(view.grid.terms + 4 * weights.first[k], view.grid.stride, x, y);
    nodes.move_to(weights.first[k]);
    nodes.add(static_cast<double>(mass[k]) * term, x, y);
  }
}

/// The next term, u - S+ S u, and the sum of those so far.
inline void next_term(const GridView& g, int row) {
  const auto subtract = [&](int node, double share_x, double share_y) {
    const double inverse = inverse_of(g.momentum[4 * node]);
    double *spread = g.spread + 4 * node, *term = g.terms + 4 * node;
    term[0] -= share_x * inverse * spread[0];
    term[1] -= share_y * inverse * spread[1];
    term[2] += term[0];
    term[3] += term[1];
    quad(spread) = Quad{};
  };
  for_each_node(
      g, row,
      [&]<class V>(V, int node) {
        for (int m = 0; m < kLanes<V>; ++m) subtract(node + m, 1.0, 1.0);
      },
      [&](int node, int /*column*/) {
        const double* shown = g.velocity + 4 * node;
        subtract(node, shown[0] != 0.0, shown[2] != 0.0);
      });
}

/// The sum of the terms of the points at their places, once mass and momentum are at the nodes.
template <class Shape, bool kOwnDomain, class Real>
void sum_terms(const View<Real>& view, int order, int thread) {
  if (view.grid.terms == nullptr) return;
  for_each_row(view, thread, [&](int row) { start_terms(view.grid, row); });
  for (int k = 1; k < order; ++k) {
    for_each_slab(view, thread, [&](int slab) {
      for_each_block(view, slab,
                     [&](const Block& block) { spread_term<Shape, kOwnDomain>(view, block); });
    });
    for_each_row(view, thread, [&](int row) { next_term(view.grid, row); });
  }
}

/// Adds the sum to what points take from the nodes.
template <class Real>
void add_terms(const View<Real>& view, int thread) {
  const GridView& g = view.grid;
  if (g.terms == nullptr) return;
  for_each_row(view, thread, [&](int row) {
    const int start = row * g.stride;
    for (int k = start + g.active[row].begin; k < start + g.active[row].end; ++k)
      for (int c = 2; c < 4; ++c) g.update[4 * k + c] += g.terms[4 * k + c];
  });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
