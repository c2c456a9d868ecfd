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

/// Mass and momentum at the nodes (paper eq. 18-19), from weights at the points' present places.
template <class Shape, class Real>
void scatter_momentum(const View<Real>& view, int begin, int n,
                      const Weights<Shape, Need::values>& weights) {
  const Real* vx = view.points.vx + begin;
  const Real* vy = view.points.vy + begin;
  const Real* mass = view.points.mass + begin;
  NodeSums<Shape> nodes(view.grid.momentum, view.grid.stride);
  for (int k = 0; k < n; ++k) {
    nodes.move_to(weights.first[k]);
    const double m = mass[k];
    nodes.add(
        Quad{m, m, m * vx[k], m * vy[k]}, [&](int i) { return weights.value_x(i, k); },
        [&](int j) { return weights.value_y(j, k); });
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
          const double* x = weights.pair_x(i, k);
          return Quad{x[0], x[1], x[1], 0.0};
        },
        [&](int j) {
          const double* y = weights.pair_y(j, k);
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

/// -V / h times the stresses in the plane, of the points of a block.
struct PointForces {
  alignas(kCacheLine) double xx[kBlock], yy[kBlock], xy[kBlock];
};

/// Internal forces at the nodes (paper eq. 11): -V sigma grad S.
template <class Shape, class Real>
void scatter_forces(const View<Real>& view, int n, const Weights<Shape, Need::gradients>& weights,
                    const PointForces& forces) {
  NodeSums<Shape> nodes(view.grid.force, view.grid.stride);
  for (int k = 0; k < n; ++k) {
    nodes.move_to(weights.first[k]);
    nodes.add(
        Quad{forces.xx[k], forces.xy[k], forces.xy[k], forces.yy[k]},
        [&](int i) { return twice(weights.pair_x(i, k)); },
        [&](int j) { return twice(weights.pair_y(j, k)); });
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
