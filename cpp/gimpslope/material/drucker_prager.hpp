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
  double flow;        // K etabar / (G + K eta etabar) >= 0: mean stress lost per unit of overshoot
  double tension;     // largest mean stress, Pa; eta times it is at most k
  double per_shear;   // 1 / (sqrt(3) G): equivalent plastic strain per sqrt(J2) returned
  double per_strain;  // 2 G + max(eta, 1) K: what a strain |xx| + |yy| + |xy| of 1 can at most add
                      // to sqrt(J2) + eta p and to p, Pa
};

inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Returns a trial stress to the cone, to the plane of the tension limit, or to the edge or apex
/// where they meet, and adds the deviatoric plastic strain, sqrt(2/3 de_p:de_p). Whether it was
/// outside of these: one that was not keeps its bits.
///
/// One formula serves all regimes: on the cone the return costs the pressure f K etabar /
/// (G + K eta etabar) and leaves sqrt(J2) = k - eta p (eq. 8.110 ff.); beyond the tension limit p
/// is cut back, and sqrt(J2) falls to the cone only if it was above (two-surface return of Koiter;
/// the apex, where the textbook formula divides by etabar, is the case tension = k / eta). The
/// smaller of two is all the branching: the flow is not negative, so that the mean stress on the
/// cone is below that of the trial just where that overshoots.
inline bool return_to_surface(const DruckerPrager& law, Mohr& s, double& plastic_strain) {
  const double common = common_deviator(s), trial_mean = s.centre - common;
  const double trial = root_j2(s);

  const double overshoot = trial + (law.eta * trial_mean - law.k);
  const double mean_on_cone = trial_mean - law.flow * overshoot;
  const double returned = mean_on_cone < trial_mean ? mean_on_cone : trial_mean;
  const double mean = returned < law.tension ? returned : law.tension;
  const double limit = law.k - law.eta * mean;
  const double root = trial < limit ? trial : limit;

  constexpr double tiny = 1e-300;  // keeps 0 / 0 from a stress without deviator; no other feels it
  const double scale = root / (trial + tiny);
  const bool yields = overshoot > 0.0 || trial_mean > law.tension;
  s.centre = yields ? mean + scale * common : s.centre;  // which rounding would change otherwise
  s.zz = yields ? mean - 2.0 * scale * common : s.zz;
  s.half_difference *= scale;
  s.xy *= scale;
  plastic_strain += law.per_shear * (trial - root);
  return yields;
}

inline void update(const DruckerPrager& law, Mohr& circle, const Strain& increment,
                   double& plastic_strain) {
  update(law.elastic, circle, increment, plastic_strain);
  return_to_surface(law, circle, plastic_strain);
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
