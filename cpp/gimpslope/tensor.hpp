// The small fixed-size arrays in which a point meets its nodes.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <type_traits>

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

/// Four numbers that follow one another anywhere, or so many of them and the last one again.
template <class Real, class Count>
[[gnu::always_inline]] inline Quad four(const Real* numbers, Count count) {
  if constexpr (std::is_same_v<Count, int>) {
    const int last = count - 1;
    return Quad{numbers[0], numbers[last < 1 ? last : 1], numbers[last < 2 ? last : 2],
                numbers[last]};
  } else if constexpr (sizeof(Real) == sizeof(double)) {
    using Anywhere [[gnu::may_alias, gnu::aligned(alignof(double))]] = Quad;
    return *reinterpret_cast<const Anywhere*>(numbers);
  } else {
    return Quad{numbers[0], numbers[1], numbers[2], numbers[3]};
  }
}

/// Calls act(k, count) for points k to k + 3 of n, with a constant, and for those that are left.
template <class Act>
[[gnu::always_inline]] inline void by_fours(int n, Act act) {
  int k = 0;
  for (; k + 4 <= n; k += 4) act(k, std::integral_constant<int, 4>{});
  if (k < n) act(k, n - k);
}

/// A number four times.
[[gnu::always_inline]] inline Quad fourfold(double x) {
#ifdef __AVX__
  return _mm256_set1_pd(x);
#elif __has_builtin(__builtin_shufflevector)
  const Quad q{x};  // by way of memory otherwise, where quads do not fit into registers
  return __builtin_shufflevector(q, q, 0, 0, 0, 0);
#else
  return Quad{x, x, x, x};
#endif
}

/// {a, b, a, b} of the pair {a, b}.
inline Quad twice(const double* pair) {
#ifdef __AVX__
  return _mm256_broadcast_pd(reinterpret_cast<const __m128d*>(pair));  // a load without a shuffle
#else
  return Quad{pair[0], pair[1], pair[0], pair[1]};
#endif
}

/// Element m of a quad, four times.
[[gnu::always_inline]] inline Quad spread(Quad q, int m) {
#ifdef __AVX2__
  const auto v = reinterpret_cast<__m256d>(q);  // m is known once the loop over it is unrolled
  if (m == 0) return reinterpret_cast<Quad>(_mm256_permute4x64_pd(v, 0x00));
  if (m == 1) return reinterpret_cast<Quad>(_mm256_permute4x64_pd(v, 0x55));
  if (m == 2) return reinterpret_cast<Quad>(_mm256_permute4x64_pd(v, 0xAA));
  return reinterpret_cast<Quad>(_mm256_permute4x64_pd(v, 0xFF));
#else
  return Quad{q[m], q[m], q[m], q[m]};
#endif
}

/// {a, b, a, b} of the first (m = 0) or second (m = 1) pair of a quad.
[[gnu::always_inline]] inline Quad spread_pair(Quad q, int m) {
#ifdef __AVX2__
  const auto v = reinterpret_cast<__m256d>(q);
  if (m == 0) return reinterpret_cast<Quad>(_mm256_permute4x64_pd(v, 0x44));
  return reinterpret_cast<Quad>(_mm256_permute4x64_pd(v, 0xEE));
#else
  return Quad{q[2 * m], q[2 * m + 1], q[2 * m], q[2 * m + 1]};
#endif
}

/// Of four quads, one of their first elements, one of their second ones, and so on.
[[gnu::always_inline]] inline void transpose(Quad (&q)[4]) {
#ifdef __AVX__
  const auto a = reinterpret_cast<__m256d>(q[0]), b = reinterpret_cast<__m256d>(q[1]);
  const auto c = reinterpret_cast<__m256d>(q[2]), d = reinterpret_cast<__m256d>(q[3]);
  const __m256d even = _mm256_unpacklo_pd(a, b), odd = _mm256_unpackhi_pd(a, b);
  const __m256d later_even = _mm256_unpacklo_pd(c, d), later_odd = _mm256_unpackhi_pd(c, d);
  q[0] = reinterpret_cast<Quad>(_mm256_permute2f128_pd(even, later_even, 0x20));
  q[1] = reinterpret_cast<Quad>(_mm256_permute2f128_pd(odd, later_odd, 0x20));
  q[2] = reinterpret_cast<Quad>(_mm256_permute2f128_pd(even, later_even, 0x31));
  q[3] = reinterpret_cast<Quad>(_mm256_permute2f128_pd(odd, later_odd, 0x31));
#else
  const Quad a = q[0], b = q[1], c = q[2], d = q[3];
  for (int i = 0; i < 4; ++i) q[i] = Quad{a[i], b[i], c[i], d[i]};
#endif
}

/// Without signs.
[[gnu::always_inline]] inline double absolute(double x) { return std::fabs(x); }
[[gnu::always_inline]] inline Quad absolute(Quad q) {
  using Bits [[gnu::vector_size(sizeof(Quad))]] = long long;
  return reinterpret_cast<Quad>(reinterpret_cast<Bits>(q) & 0x7fff'ffff'ffff'ffff);
}

/// The larger elements; those of b where either is NaN.
[[gnu::always_inline]] inline Quad larger(Quad a, Quad b) { return a > b ? a : b; }

/// Two doubles: a vector in the plane.
using Pair = Eigen::Array<double, 2, 1>;

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
