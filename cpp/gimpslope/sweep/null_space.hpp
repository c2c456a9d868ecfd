// XPIC: PIC that leaves out less of the points' velocities V, the noise alone that no node sees
// (Hammerquist and Nairn 2017, doi 10.1016/j.cma.2017.01.035). With S from nodes to points and S+,
// the mean of the points at each node, a step of order m makes of them
//
//   V <- (1 - (1 - S S+)^m) V + S (v+ - v-) = S (v+ + sum of (1 - S+ S)^k v-, k = 1 to m - 1)
//
// with v- = S+ V. Order 1 is PIC.
#pragma once

#include "loops.hpp"
#include "nodes.hpp"
#include "scatter.hpp"
#include "weights.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// The terms begin with v-.
inline void start_terms(const GridView& g, int row) {
  for (int k = row * g.stride + g.active[row].begin; k < row * g.stride + g.active[row].end; ++k) {
    const Pair v = velocity_of(g.momentum + 4 * k);
    quad(g.terms + 4 * k) = Quad{v[0], v[1], 0.0, 0.0};
  }
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
  for (int k = row * g.stride + g.active[row].begin; k < row * g.stride + g.active[row].end; ++k) {
    double *spread = g.spread + 4 * k, *term = g.terms + 4 * k;
    const double mass = g.momentum[4 * k], inverse = mass > 0.0 ? 1.0 / mass : 0.0;
    for (int c = 0; c < 2; ++c) {
      term[c] -= inverse * spread[c];
      term[c + 2] += term[c];
    }
    quad(spread) = Quad{};
  }
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
