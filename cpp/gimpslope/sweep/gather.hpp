// Sums of node values at a point.
#pragma once

#include <cstddef>

#include "../tensor.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Sum of x(i) y(j) times the quad of node (i, j), counted from the one at `first`, in a field with
/// `stride` nodes a row.
template <class Shape, class X, class Y>
[[gnu::always_inline]] inline Quad gather(const double* first, std::ptrdiff_t stride, X x, Y y) {
  Quad sum{};
  for (int j = 0; j < Shape::nodes; ++j) {
    const double* row = first + 4 * j * stride;
    Quad along = quad(row) * x(0);
    for (int i = 1; i < Shape::nodes; ++i) along += quad(row + 4 * i) * x(i);
    sum += along * y(j);
  }
  return sum;
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
