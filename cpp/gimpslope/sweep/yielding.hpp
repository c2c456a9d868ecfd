// Which blocks are asked whether they yield. How far the stresses of a block are from yield is
// measured once; from then on each step takes off what its strains can have changed at most, and
// while something is left no point can yield, so that the elastic part of the law is all of it.
#pragma once

#include <cmath>

#include "../view.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Margins, Pa: positive where known, of the point of a block that is nearest to yield.
constexpr double kUnknown = 0.0;
constexpr double kAlwaysAsked = -1.0;  // a point yields, or nearly

/// Share of its stresses and strength within which a point counts as yielding: more than rounding
/// adds up to in single precision between two sorts.
constexpr double kNearlyYields = 1e-5;

/// Strain increments and rotations of the points of a block.
struct Strains {
  alignas(kCacheLine) double xx[kBlock], yy[kBlock], xy[kBlock];
  double cosine[kBlock], sine[kBlock];  // of twice the angle
  double most_volume;                   // of the points after them, m2
  double largest;                       // |xx| + |yy| + |xy| of a point
};

/// Takes the strains of a block off its margin; whether its points may yield.
inline bool may_yield(const DruckerPrager& law, const Strains& s, double& margin) {
  if (margin <= 0.0) return true;
  const double left = margin - law.per_strain * s.largest;
  margin = left > 0.0 ? left : kUnknown;
  return margin == kUnknown;
}

/// The margin of n points from `begin` on.
template <class Real>
double yield_margin(const DruckerPrager& law, const PointsView<Real>& p, int begin, int n) {
  const Real *xx = p.stress_xx + begin, *yy = p.stress_yy + begin;
  const Real *zz = p.stress_zz + begin, *xy = p.stress_xy + begin;
  double least = law.tension;
#pragma omp simd reduction(min : least)
  for (int k = 0; k < n; ++k) {
    const Mohr s = circle_of({xx[k], yy[k], zz[k], xy[k]});
    const double mean = s.centre - common_deviator(s), root = root_j2(s);
    const double near = kNearlyYields * (root + std::fabs(mean) + law.k);
    const double below_cone = law.k - law.eta * mean - root - near;
    const double below_tension = law.tension - mean - near;
    const double margin = below_cone < below_tension ? below_cone : below_tension;
    least = margin < least ? margin : least;
  }
  return least > 0.0 ? least : kAlwaysAsked;
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
