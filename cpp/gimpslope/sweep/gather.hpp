// Sums of node values at a point.
#pragma once

#include <cstddef>

#include "../tensor.hpp"
#include "weights.hpp"

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

/// Sums of a field at the n points of a block, four points at a time in step, which keeps the
/// processor busier than one after the other: calls take(k, sums) with the four components of
/// points k to k + 3, beyond the last one those of the last one.
template <class Shape, class Weights, class Take>
[[gnu::always_inline]] inline void gather_block(const double* field, std::ptrdiff_t stride, int n,
                                                const Weights& weights, Take take) {
  for (int k = 0; k < n; k += 4) {
    const auto w = weights.four(k);
    const double* first[4];
    for (int m = 0; m < 4; ++m)
      first[m] = field + 4 * static_cast<std::ptrdiff_t>(weights.first[k + m]);
    Quad sums[4];
#pragma GCC unroll 8
    for (int j = 0; j < Shape::nodes; ++j)
#pragma GCC unroll 8
      for (int m = 0; m < 4; ++m) {
        const double* row = first[m] + 4 * j * stride;
        Quad along = quad(row) * w.x(0, m);
#pragma GCC unroll 8
        for (int i = 1; i < Shape::nodes; ++i) along += quad(row + 4 * i) * w.x(i, m);
        sums[m] = j == 0 ? along * w.y(j, m) : sums[m] + along * w.y(j, m);
      }
    transpose(sums);
    take(k, sums);
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
