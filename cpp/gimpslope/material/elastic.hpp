// Linear elasticity in plane strain: the increment of the Jaumann rate (paper eq. 24-25).
#pragma once

#include "../instruction_set.hpp"

namespace gimpslope {

/// Cauchy stress in plane strain, Pa, tension positive.
struct Stress {
  double xx, yy, zz, xy;
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

/// Adds the elastic increment to a stress that has turned with the material already.
inline void update(const Elastic& law, Stress& stress, const Strain& increment,
                   double& /*plastic_strain*/) {
  const double volumetric = law.lame * (increment.xx + increment.yy);
  stress.xx += volumetric + 2.0 * law.shear * increment.xx;
  stress.yy += volumetric + 2.0 * law.shear * increment.yy;
  stress.zz += volumetric;
  stress.xy += 2.0 * law.shear * increment.xy;
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
