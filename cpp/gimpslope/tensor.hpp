// The small fixed-size arrays in which a point meets its nodes.
#pragma once

#include <Eigen/Core>

#ifdef __AVX__
#include <immintrin.h>
#endif

#include "instruction_set.hpp"

#if !EIGEN_VERSION_AT_LEAST(3, 4, 0)
#error "gimpslope needs Eigen 3.4 or newer"
#endif

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Four doubles that are loaded, multiplied and added as one: what a node keeps together. The
/// vector extension of GCC and Clang, since they lay out an Eigen array that is put together from
/// parts by way of memory, which costs a fifth of the speed.
using Quad [[gnu::vector_size(4 * sizeof(double))]] = double;

/// The same in memory that holds doubles.
using QuadOfDoubles [[gnu::may_alias]] = Quad;
inline QuadOfDoubles& quad(double* four) { return *reinterpret_cast<QuadOfDoubles*>(four); }
inline const QuadOfDoubles& quad(const double* four) {
  return *reinterpret_cast<const QuadOfDoubles*>(four);
}

/// {a, b, a, b} of the pair {a, b}.
inline Quad twice(const double* pair) {
#ifdef __AVX__
  return _mm256_broadcast_pd(reinterpret_cast<const __m128d*>(pair));  // a load without a shuffle
#else
  return Quad{pair[0], pair[1], pair[0], pair[1]};
#endif
}

/// Two doubles: a vector in the plane.
using Pair = Eigen::Array<double, 2, 1>;

inline Eigen::Map<const Pair, Eigen::Aligned16> pair(const double* two) {
  return Eigen::Map<const Pair, Eigen::Aligned16>(two);
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
