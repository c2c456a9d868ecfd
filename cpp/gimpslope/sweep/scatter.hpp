// Sums of point values at the nodes.
#pragma once

#include <cstddef>

#include "../tensor.hpp"
#include "weights.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// The nodes of one point, summed in registers for as long as the following points share them. All
/// is inlined and unrolled on demand, or else the compiler may keep the sums in memory.
template <class Shape>
class NodeSums {
 public:
  NodeSums(double* field, std::ptrdiff_t stride) : field_(field), stride_(stride) {}
  NodeSums(const NodeSums&) = delete;
  NodeSums& operator=(const NodeSums&) = delete;
  [[gnu::always_inline]] ~NodeSums() { store(); }

  /// Makes the nodes from `first` on those that `add` adds to.
  [[gnu::always_inline]] void move_to(int first) {
    if (first == first_) return;
    store();
    first_ = first;
#pragma GCC unroll 8
    for (auto& row : sum_)
#pragma GCC unroll 8
      for (Quad& node : row) node = Quad{};
  }

  /// Adds point x(i) y(j) to node (i, j).
  template <class X, class Y>
  [[gnu::always_inline]] void add(Quad point, X x, Y y) {
#pragma GCC unroll 8
    for (int j = 0; j < Shape::nodes; ++j) {
      const Quad row = point * y(j);
#pragma GCC unroll 8
      for (int i = 0; i < Shape::nodes; ++i) sum_[j][i] += row * x(i);
    }
  }

 private:
  [[gnu::always_inline]] void store() {
    if (first_ < 0) return;
    double* row = field_ + 4 * first_;
#pragma GCC unroll 8
    for (int j = 0; j < Shape::nodes; ++j, row += 4 * stride_)
#pragma GCC unroll 8
      for (int i = 0; i < Shape::nodes; ++i) quad(row + 4 * i) += sum_[j][i];
  }

  double* field_;
  std::ptrdiff_t stride_, first_ = -1;
  Quad sum_[Shape::nodes][Shape::nodes]{};
};

/// What each point of a block brings to its nodes, put together for four points at a time.
class PointQuads {
 public:
  /// Of points k to k + 3, by component.
  [[gnu::always_inline]] void put(int k, const Quad (&components)[4]) {
    Quad points[4] = {components[0], components[1], components[2], components[3]};
    transpose(points);
#pragma GCC unroll 4
    for (int m = 0; m < 4; ++m) quad(quads_ + 4 * (k + m)) = points[m];
  }
  [[gnu::always_inline]] Quad of(int k) const { return quad(quads_ + 4 * k); }

 private:
  alignas(kCacheLine) double quads_[4 * kBlock];
};

/// {m, m, m vx, m vy} of the points of a block. A function of its own, for it is faster so.
template <class Real>
[[gnu::noinline]] void take_momenta(const PointsView<Real>& p, int begin, int n,
                                    PointQuads& momenta) {
  const Real *mass = p.mass + begin, *vx = p.vx + begin, *vy = p.vy + begin;
  by_fours(n, [&](int k, auto count) {
    const Quad m = four(mass + k, count);
    momenta.put(k, {m, m, m * four(vx + k, count), m * four(vy + k, count)});
  });
}

/// Mass and momentum at the nodes (paper eq. 18-19), from weights at the points' present places.
template <class Shape, class Real>
void scatter_momentum(const View<Real>& view, int begin, int n,
                      const Weights<Shape, Need::values>& weights) {
  PointQuads momenta;
  take_momenta(view.points, begin, n, momenta);
  NodeSums<Shape> nodes(view.grid.momentum, view.grid.stride);
  for (int k = 0; k < n; ++k) {
    nodes.move_to(weights.first[k]);
    nodes.add(
        momenta.of(k), [&](int i) { return fourfold(weights.value_x(i, k)); },
        [&](int j) { return fourfold(weights.value_y(j, k)); });
  }
}

/// Volume at the nodes and its gradient times the cell size.
template <class Shape, class Real>
void scatter_soil(const View<Real>& view, int begin, int n,
                  const Weights<Shape, Need::gradients>& weights) {
  const Real* volume = view.points.volume + begin;
  NodeSums<Shape> nodes(view.grid.soil, view.grid.stride);
  for (int k = 0; k < n; ++k) {
    nodes.move_to(weights.first[k]);
    const double v = volume[k];
    nodes.add(
        Quad{v, v, v, 0.0},
        [&](int i) {
          const Quad x = weights.pairs_x(i, k);
          return Quad{x[0], x[1], x[1], 0.0};
        },
        [&](int j) {
          const Quad y = weights.pairs_y(j, k);
          return Quad{y[0], y[1], y[0], 0.0};
        });
  }
}

/// Body forces at the nodes: sum of S m b (paper eq. 12, the first term).
template <class Shape, class Real>
void scatter_body_forces(const View<Real>& view, int begin, int n,
                         const Weights<Shape, Need::gradients>& weights) {
  const Real* bx = view.points.body_force[0] + begin;
  const Real* by = view.points.body_force[1] + begin;
  const Real* mass = view.points.mass + begin;
  NodeSums<Shape> nodes(view.grid.body, view.grid.stride);
  for (int k = 0; k < n; ++k) {
    nodes.move_to(weights.first[k]);
    nodes.add(
        static_cast<double>(mass[k]) * Quad{bx[k], by[k], 0.0, 0.0},
        [&](int i) { return weights.value_x(i, k); }, [&](int j) { return weights.value_y(j, k); });
  }
}

/// Internal forces at the nodes (paper eq. 11): -V sigma grad S, of quads {xx, xy, xy, yy} of
/// -V sigma / h.
template <class Shape, class Real>
void scatter_forces(const View<Real>& view, int n, const Weights<Shape, Need::gradients>& weights,
                    const PointQuads& forces) {
  NodeSums<Shape> nodes(view.grid.force, view.grid.stride);
  for (int k = 0; k < n; ++k) {
    nodes.move_to(weights.first[k]);
    nodes.add(
        forces.of(k), [&](int i) { return weights.pairs_x(i, k); },
        [&](int j) { return weights.pairs_y(j, k); });
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
