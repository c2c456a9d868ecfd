// How cpGIMP domains follow the deformation (Wallstedt and Guilkey 2008; Charlton, Coombs and
// Augarde 2017, section 3).
#pragma once

#include <cmath>

#include "view.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// New half-lengths of the n points from `begin` on. The reference is the initial half-length; for
/// the jacobian, divided by the root of the initial volume.
inline void update_domains(const View& view, int begin, int n) {
  const PointsView& p = view.points;
  double* half_length = p.half_length + 2 * begin;
  const double* reference = p.domain_reference + 2 * begin;
  const double* deformation = p.deformation + 4 * begin;
  switch (view.domain_update) {
    case DomainUpdate::none:
      return;
    case DomainUpdate::jacobian:
      for (int k = 0; k < n; ++k) {
        const double root = std::sqrt(p.volume[begin + k]);
        half_length[2 * k] = reference[2 * k] * root;
        half_length[2 * k + 1] = reference[2 * k + 1] * root;
      }
      return;
    case DomainUpdate::stretch:
      for (int k = 0; k < n; ++k) {
        // Polar decomposition in 2D: U = (C + J I) / sqrt(tr C + 2 J), C = F^T F.
        const double* f = deformation + 4 * k;
        const double jacobian = std::fabs(f[0] * f[3] - f[1] * f[2]);
        const double cxx = f[0] * f[0] + f[2] * f[2], cyy = f[1] * f[1] + f[3] * f[3];
        const double divisor = std::sqrt(cxx + cyy + 2.0 * jacobian);
        half_length[2 * k] = reference[2 * k] * (cxx + jacobian) / divisor;
        half_length[2 * k + 1] = reference[2 * k + 1] * (cyy + jacobian) / divisor;
      }
      return;
    case DomainUpdate::deformation_diagonal:
      for (int k = 0; k < n; ++k) {
        half_length[2 * k] = reference[2 * k] * deformation[4 * k];
        half_length[2 * k + 1] = reference[2 * k + 1] * deformation[4 * k + 3];
      }
      return;
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
