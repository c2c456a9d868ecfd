// Linear elasticity in plane strain: the increment of the Jaumann rate (paper eq. 24-25).
#pragma once

#include "../instruction_set.hpp"

namespace gimpslope {

/// Cauchy stress in plane strain, Pa, tension positive.
struct Stress {
  double xx, yy, zz, xy;
};

/// The same by Mohr's circle in the plane: its centre and half the difference of xx and yy, which
/// turns with xy alone.
struct Mohr {
  double centre, half, zz, xy;
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

inline Mohr mohr(const Stress& s) { return {0.5 * (s.xx + s.yy), 0.5 * (s.xx - s.yy), s.zz, s.xy}; }
inline Stress stress(const Mohr& s) { return {s.centre + s.half, s.centre - s.half, s.zz, s.xy}; }

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

/// Adds the elastic increment to a stress that has turned with the material already.
inline void update(const Elastic& law, Mohr& stress, const Strain& increment,
                   double& /*plastic_strain*/) {
  const double grown = increment.xx + increment.yy;
  stress.centre += (law.lame + law.shear) * grown;
  stress.half += law.shear * (increment.xx - increment.yy);
  stress.zz += law.lame * grown;
  stress.xy += 2.0 * law.shear * increment.xy;
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
