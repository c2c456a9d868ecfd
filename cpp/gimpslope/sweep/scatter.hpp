// Sums of point values at the nodes.
#pragma once

#include "../tensor.hpp"
#include "weights.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// The nodes of one point, summed in registers for as long as the following points share them.
template <class Shape>
class NodeSums {
 public:
  NodeSums(double* field, int stride) : field_(field), stride_(stride) {}
  NodeSums(const NodeSums&) = delete;
  NodeSums& operator=(const NodeSums&) = delete;
  ~NodeSums() { store(); }

  /// Makes the nodes from `first` on those that `add` adds to.
  void move_to(int first) {
    if (first == first_) return;
    store();
    first_ = first;
    for (auto& row : sum_)
      for (Quad& node : row) node.setZero();
  }

  void add(int row, int column, const Quad& value) { sum_[row][column] += value; }

 private:
  void store() {
    if (first_ < 0) return;
    for (int j = 0; j < Shape::nodes; ++j)
      for (int i = 0; i < Shape::nodes; ++i)
        quad(field_ + 4 * (first_ + j * stride_ + i)) += sum_[j][i];
  }

  double* field_;
  int stride_;
  int first_ = -1;
  Quad sum_[Shape::nodes][Shape::nodes];
};

/// Mass and momentum at the nodes (paper eq. 18-19), from weights at the points' present places.
template <class Shape>
void scatter_momentum(const View& view, int begin, int n, const Weights<Shape>& weights) {
  const double* motion = view.points.motion + 4 * begin;
  const double* mass = view.points.mass + begin;
  const Quad masses(1.0, 1.0, 0.0, 0.0), velocities(0.0, 0.0, 1.0, 1.0);
  NodeSums<Shape> nodes(view.grid.momentum, view.grid.stride);
  for (int k = 0; k < n; ++k) {
    const Quad point = mass[k] * (velocities * quad(motion + 4 * k) + masses);
    nodes.move_to(weights.first[k]);
    for (int j = 0; j < Shape::nodes; ++j) {
      const Quad row = point * weights.y[j][k];
      for (int i = 0; i < Shape::nodes; ++i) nodes.add(j, i, row * weights.x[i][k]);
    }
  }
}

/// Body forces at the nodes: sum of S m b (paper eq. 12, the first term).
template <class Shape>
void scatter_body_forces(const View& view, int begin, int n, const Weights<Shape>& weights) {
  const double* force = view.points.body_force + 2 * begin;
  const double* mass = view.points.mass + begin;
  NodeSums<Shape> nodes(view.grid.body, view.grid.stride);
  for (int k = 0; k < n; ++k) {
    const Quad point(mass[k] * force[2 * k], mass[k] * force[2 * k + 1], 0.0, 0.0);
    nodes.move_to(weights.first[k]);
    for (int j = 0; j < Shape::nodes; ++j) {
      const Quad row = point * weights.y[j][k];
      for (int i = 0; i < Shape::nodes; ++i) nodes.add(j, i, row * weights.x[i][k]);
    }
  }
}

/// Internal forces at the nodes (paper eq. 11): -V sigma grad S, with forces[k] = -V / h
/// {xx, xy, xy, yy}.
template <class Shape>
void scatter_forces(const View& view, int n, const Weights<Shape>& weights, const double* forces) {
  NodeSums<Shape> nodes(view.grid.force, view.grid.stride);
  for (int k = 0; k < n; ++k) {
    const Quad point = quad(forces + 4 * k);
    Quad x[Shape::nodes];
    for (int i = 0; i < Shape::nodes; ++i)
      x[i] = Quad(weights.dx[i][k], weights.x[i][k], weights.dx[i][k], weights.x[i][k]);
    nodes.move_to(weights.first[k]);
    for (int j = 0; j < Shape::nodes; ++j) {
      const Quad y(weights.y[j][k], weights.dy[j][k], weights.y[j][k], weights.dy[j][k]);
      const Quad row = point * y;
      for (int i = 0; i < Shape::nodes; ++i) nodes.add(j, i, row * x[i]);
    }
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
