// Drucker-Prager plasticity with a limit of the mean stress (de Souza Neto, Peric and Owen,
// Computational Methods for Plasticity, 2008, sections 6.4 and 8.3).
#pragma once

#include <cmath>

#include "../instruction_set.hpp"
#include "elastic.hpp"

namespace gimpslope {

/// The cone sqrt(J2) + eta p = k, p the mean stress, tension positive.
struct DruckerPrager {
  Elastic elastic;
  double eta;
  double k;           // xi c, Pa
  double flow;        // K etabar / (G + K eta etabar): mean stress lost per unit of overshoot
  double tension;     // largest mean stress, Pa
  double per_shear;   // 1 / (sqrt(3) G): equivalent plastic strain per sqrt(J2) returned
  double per_strain;  // 2 G + max(eta, 1) K: what a strain |xx| + |yy| + |xy| of 1 can at most add
                      // to sqrt(J2) + eta p and to p, Pa
};

inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Returns a trial stress to the cone, to the plane of the tension limit, or to the edge or apex
/// where they meet, and adds the deviatoric plastic strain, sqrt(2/3 de_p:de_p).
///
/// One formula serves all regimes: on the cone the return costs the pressure f K etabar /
/// (G + K eta etabar) and leaves sqrt(J2) = k - eta p (eq. 8.110 ff.); beyond the tension limit p
/// is cut back, and sqrt(J2) falls to the cone only if it was above (two-surface return of Koiter;
/// the apex, where the textbook formula divides by etabar, is the case tension = k / eta).
inline void return_to_surface(const DruckerPrager& law, Stress& s, double& plastic_strain) {
  const double trial_mean = (s.xx + s.yy + s.zz) * (1.0 / 3.0);
  const double xx = s.xx - trial_mean, yy = s.yy - trial_mean, zz = s.zz - trial_mean;
  const double trial = std::sqrt(0.5 * (xx * xx + yy * yy + zz * zz) + s.xy * s.xy);

  const double overshoot = trial + law.eta * trial_mean - law.k;
  const double returned = trial_mean - law.flow * (overshoot > 0.0 ? overshoot : 0.0);
  const double mean = returned < law.tension ? returned : law.tension;
  const double room = law.k - law.eta * mean;
  const double limit = room > 0.0 ? room : 0.0;
  const double root_j2 = trial < limit ? trial : limit;

  constexpr double tiny = 1e-300;  // keeps 0 / 0 from a stress without deviator
  const double scale = root_j2 / (trial > tiny ? trial : tiny);
  const bool yields = overshoot > 0.0 || trial_mean > law.tension;
  s.xx = yields ? mean + scale * xx : s.xx;  // which rounding would change otherwise
  s.yy = yields ? mean + scale * yy : s.yy;
  s.zz = yields ? mean + scale * zz : s.zz;
  s.xy *= scale;
  plastic_strain += law.per_shear * (trial - root_j2);
}

inline void update(const DruckerPrager& law, Stress& stress, const Strain& increment,
                   double& plastic_strain) {
  update(law.elastic, stress, increment, plastic_strain);
  return_to_surface(law, stress, plastic_strain);
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
