// APIC: points carry the linear part of the motion of their nodes, v(x) = v_p + B D^-1 (x - x_p),
// and bring it back to them, which keeps angular momentum (Jiang, Schroeder, Selle, Teran and
// Stomakhin 2015, doi 10.1145/2766996). That of a point is then
// m (x_p x v_p + B_yx - B_xy).
#pragma once

#include "gather.hpp"
#include "scatter.hpp"
#include "weights.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Where the nodes of a point lie from it along one axis, in cells, and the second moment of its
/// weights: D of Jiang et al., which is diagonal, for weights that are products reproduce places.
template <class Shape>
struct Arms {
  double arm[Shape::nodes], moment;
};

template <class Shape, class Weight>
[[gnu::always_inline]] inline Arms<Shape> arms_of(Weight weight) {
  Arms<Shape> a;
  double place = 0.0;  // of the point, from its first node
  for (int i = 1; i < Shape::nodes; ++i) place += i * weight(i);
  a.moment = 0.0;
  for (int i = 0; i < Shape::nodes; ++i) {
    a.arm[i] = i - place;
    a.moment += weight(i) * a.arm[i] * a.arm[i];
  }
  return a;
}

/// B = sum of S v (x - x_p), of the nodes' new velocities.
template <class Shape, class Real>
[[gnu::noinline]] void gather_affine(const View<Real>& view, int begin, int n,
                                     const Weights<Shape, Need::values>& weights) {
  Real* const* b = view.points.affine;
  const double cell = view.grid.cell;
  for (int k = 0; k < n; ++k) {
    const auto x = [&](int i) {
      return weights.value_x(i, k);
    };
    const auto y = [&](int j) {
      return weights.value_y(j, k);
    };
    const Arms<Shape> along = arms_of<Shape>(x), up = arms_of<Shape>(y);
    const double* first = view.grid.update + 4 * weights.first[k];
    const Quad by_x =
        gather<Shape>(first, view.grid.stride, [&](int i) { return x(i) * along.arm[i]; }, y);
    const Quad by_y =
        gather<Shape>(first, view.grid.stride, x, [&](int j) { return y(j) * up.arm[j]; });
    b[0][begin + k] = cell * by_x[2];
    b[1][begin + k] = cell * by_y[2];
    b[2][begin + k] = cell * by_x[3];
    b[3][begin + k] = cell * by_y[3];
  }
}

/// Adds m S B D^-1 (x - x_p) to the momentum at the nodes. Where D = 0 a point has
/// but one node, and nothing to add.
template <class Shape, class Real>
[[gnu::noinline]] void scatter_affine(const View<Real>& view, int begin, int n,
                                      const Weights<Shape, Need::values>& weights) {
  const Real* const* b = view.points.affine;
  const double per_cell = 1.0 / view.grid.cell;
  const auto inverse = [](double moment) {
    return moment > 0.0 ? 1.0 / moment : 0.0;
  };
  NodeSums<Shape> nodes(view.grid.momentum, view.grid.stride);
  for (int k = 0; k < n; ++k) {
    const auto x = [&](int i) {
      return weights.value_x(i, k);
    };
    const auto y = [&](int j) {
      return weights.value_y(j, k);
    };
    const Arms<Shape> along = arms_of<Shape>(x), up = arms_of<Shape>(y);
    const double mass = per_cell * view.points.mass[begin + k];
    const Quad by_x = Quad{0.0, 0.0, b[0][begin + k], b[2][begin + k]};
    const Quad by_y = Quad{0.0, 0.0, b[1][begin + k], b[3][begin + k]};
    nodes.move_to(weights.first[k]);
    nodes.add(mass * inverse(along.moment) * by_x, [&](int i) { return x(i) * along.arm[i]; }, y);
    nodes.add(mass * inverse(up.moment) * by_y, x, [&](int j) { return y(j) * up.arm[j]; });
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
