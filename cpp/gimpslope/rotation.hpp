// The exact rotation of a stress state in its plane: cosine and sine of twice the angle that a step
// turns a point.
#pragma once

#include <cmath>

#include "instruction_set.hpp"
#include "material/elastic.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Largest angles, rad, at which the series below are exact to rounding.
constexpr double kSmallAngle = 0.5, kTinyAngle = 1.0 / 64;

/// Cosine and sine by their Taylor series: free of branches, so that loops over points vectorise.
inline void small_rotation(double angle, double& cosine, double& sine) {
  const double a = angle * angle;
  cosine =
      1.0 +
      a * (-1.0 / 2 +
           a * (1.0 / 24 +
                a * (-1.0 / 720 +
                     a * (1.0 / 40320 + a * (-1.0 / 3628800 +
                                             a * (1.0 / 479001600 + a * (-1.0 / 87178291200)))))));
  sine =
      angle *
      (1.0 + a * (-1.0 / 6 +
                  a * (1.0 / 120 +
                       a * (-1.0 / 5040 +
                            a * (1.0 / 362880 + a * (-1.0 / 39916800 + a * (1.0 / 6227020800)))))));
}

/// The first terms of the same series.
inline void tiny_rotation(double angle, double& cosine, double& sine) {
  const double a = angle * angle;
  cosine = 1.0 + a * (-1.0 / 2 + a * (1.0 / 24 + a * (-1.0 / 720)));
  sine = angle * (1.0 + a * (-1.0 / 6 + a * (1.0 / 120 + a * (-1.0 / 5040))));
}

/// The same for any angle of a block, by the series that its largest one allows or by the library's
/// functions.
inline void rotation(double angle, double largest, double& cosine, double& sine) {
  if (largest <= kTinyAngle) {
    tiny_rotation(angle, cosine, sine);
  } else if (largest <= kSmallAngle) {
    small_rotation(angle, cosine, sine);
  } else {
    cosine = std::cos(angle);
    sine = std::sin(angle);
  }
}

/// A stress turned with the material, given cosine and sine of twice the angle.
inline Mohr turned(const Mohr& s, double cosine, double sine) {
  return {s.centre, s.half_difference * cosine - s.xy * sine, s.zz,
          s.half_difference * sine + s.xy * cosine};
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
