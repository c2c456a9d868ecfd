// Linear elasticity in plane strain: the increment of the Jaumann rate (paper eq. 24-25).
#pragma once

#include <cmath>

#include "../instruction_set.hpp"

namespace gimpslope {

/// Cauchy stress in plane strain, Pa, tension positive.
struct Stress {
  double xx, yy, zz, xy;
};

/// The same by Mohr's circle in the plane: its centre (xx + yy) / 2, and (xx - yy) / 2 and xy,
/// which alone turn with the material.
struct Mohr {
  double centre, half_difference, zz, xy;
};

/// Strain increment in plane strain; xy is the tensor component.
struct Strain {
  double xx, yy, xy;
};

/// Constants of Hooke's law, Pa.
struct Elastic {
  double lame, shear;
};

inline namespace GIMPSLOPE_INSTRUCTION_SET {

inline Mohr circle_of(const Stress& s) {
  return {0.5 * (s.xx + s.yy), 0.5 * (s.xx - s.yy), s.zz, s.xy};
}
inline Stress stress_of(const Mohr& s) {
  return {s.centre + s.half_difference, s.centre - s.half_difference, s.zz, s.xy};
}

/// What the product of two stresses with the compliance in between needs, 1/Pa.
struct Compliance {
  double mean, deviator;
};

inline Compliance compliance_of(const Elastic& law) {
  return {1.0 / (law.lame + 2.0 / 3.0 * law.shear), 0.5 / law.shear};
}

/// a : C^-1 : b, J/m3; half of it is the elastic energy where both are the same.
inline double product(const Compliance& c, const Stress& a, const Stress& b) {
  const double mean_a = (a.xx + a.yy + a.zz) * (1.0 / 3.0);
  const double mean_b = (b.xx + b.yy + b.zz) * (1.0 / 3.0);
  const double deviators = (a.xx - mean_a) * (b.xx - mean_b) + (a.yy - mean_a) * (b.yy - mean_b) +
                           (a.zz - mean_a) * (b.zz - mean_b) + 2.0 * a.xy * b.xy;
  return c.mean * mean_a * mean_b + c.deviator * deviators;
}

/// The deviatoric stress that xx and yy have in common: with d for it and h for half of their
/// difference, the deviator is d + h, d - h, -2 d and xy.
inline double common_deviator(const Mohr& s) { return (s.centre - s.zz) * (1.0 / 3.0); }

/// sqrt(J2), half the deviator's product with itself.
inline double root_j2(const Mohr& s) {
  const double common = common_deviator(s);
  return std::sqrt((s.half_difference * s.half_difference + s.xy * s.xy) + 3.0 * common * common);
}

/// Adds the elastic increment to a stress that has turned with the material already.
inline void update(const Elastic& law, Mohr& circle, const Strain& increment,
                   double& /*plastic_strain*/) {
  const double grown = increment.xx + increment.yy;
  circle.centre += (law.lame + law.shear) * grown;
  circle.half_difference += law.shear * (increment.xx - increment.yy);
  circle.zz += law.lame * grown;
  circle.xy += 2.0 * law.shear * increment.xy;
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
