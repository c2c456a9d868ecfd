// The nodes of a block of points with their shape functions.
#pragma once

#include "../view.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// One array a node, so that the loops over the points of a block vectorise. Derivatives are times
/// the cell size.
template <class Shape>
struct Weights {
  static constexpr int nodes = Shape::nodes;
  int first[kBlock];  // index of the lower left node
  double x[nodes][kBlock], y[nodes][kBlock];
  double dx[nodes][kBlock], dy[nodes][kBlock];
};

enum class Need { values, gradients };  // gradients: values and derivatives

/// Shape functions of the n points from `begin` on. With kOwnDomain each point has its own
/// half-lengths, otherwise all share one.
template <class Shape, bool kOwnDomain, Need kNeed>
void evaluate(const View& view, int begin, int n, Weights<Shape>& out) {
  const GridView& grid = view.grid;
  const double* motion = view.points.motion + 4 * begin;
  const double* half_length = kOwnDomain ? view.points.half_length + 2 * begin : nullptr;
  const double per_cell = 1.0 / grid.cell;
  const double left = grid.left, bottom = grid.bottom;
  const double stride = grid.stride;
  const double common = Shape::extended ? 2.0 * view.half_length * per_cell : 0.0;
  const double common_inverse = Shape::extended ? 1.0 / common : 0.0;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    double width_x = common, width_y = common;
    double inverse_x = common_inverse, inverse_y = common_inverse;
    if constexpr (kOwnDomain) {
      width_x = 2.0 * half_length[2 * k] * per_cell;
      width_y = 2.0 * half_length[2 * k + 1] * per_cell;
      inverse_x = 1.0 / width_x;
      inverse_y = 1.0 / width_y;
    }
    const double x = (motion[4 * k] - left) * per_cell - 0.5 * width_x;
    const double y = (motion[4 * k + 1] - bottom) * per_cell - 0.5 * width_y;
    const double column = static_cast<int>(x), row = static_cast<int>(y);
    out.first[k] = static_cast<int>(row * stride + column);  // exact: under 2^53

    double w[Shape::nodes], d[Shape::nodes];
    Shape::evaluate(x - column, width_x, inverse_x, w, d);
    for (int i = 0; i < Shape::nodes; ++i) {
      out.x[i][k] = w[i];
      if constexpr (kNeed == Need::gradients) out.dx[i][k] = d[i];
    }
    Shape::evaluate(y - row, width_y, inverse_y, w, d);
    for (int i = 0; i < Shape::nodes; ++i) {
      out.y[i][k] = w[i];
      if constexpr (kNeed == Need::gradients) out.dy[i][k] = d[i];
    }
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
