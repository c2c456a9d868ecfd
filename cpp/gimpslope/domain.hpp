// How cpGIMP domains follow the deformation (Wallstedt and Guilkey 2008; Charlton, Coombs and
// Augarde 2017, section 3).
#pragma once

#include <cmath>

#include "view.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// New half-lengths of the n points from `begin` on. The reference is the initial half-length; for
/// the jacobian, divided by the root of the initial volume.
template <class Real>
void update_domains(const View<Real>& view, int begin, int n) {
  const PointsView<Real>& p = view.points;
  Real *lx = p.half_length[0] + begin, *ly = p.half_length[1] + begin;
  const Real *reference_x = p.domain_reference[0] + begin,
             *reference_y = p.domain_reference[1] + begin;
  const Real* volume = p.volume + begin;
  switch (view.domain_update) {
    case DomainUpdate::none:
      return;
    case DomainUpdate::jacobian:
#pragma omp simd
      for (int k = 0; k < n; ++k) {
        const double root = std::sqrt(static_cast<double>(volume[k]));
        lx[k] = reference_x[k] * root;
        ly[k] = reference_y[k] * root;
      }
      return;
    case DomainUpdate::stretch: {
      const Real *fxx = p.deformation[0] + begin, *fxy = p.deformation[1] + begin;
      const Real *fyx = p.deformation[2] + begin, *fyy = p.deformation[3] + begin;
#pragma omp simd
      for (int k = 0; k < n; ++k) {
        // Polar decomposition in 2D: U = (C + J I) / sqrt(tr C + 2 J), C = F^T F.
        const double xx = fxx[k], xy = fxy[k], yx = fyx[k], yy = fyy[k];
        const double jacobian = std::fabs(xx * yy - xy * yx);
        const double cxx = xx * xx + yx * yx, cyy = xy * xy + yy * yy;
        const double divisor = std::sqrt(cxx + cyy + 2.0 * jacobian);
        lx[k] = reference_x[k] * (cxx + jacobian) / divisor;
        ly[k] = reference_y[k] * (cyy + jacobian) / divisor;
      }
      return;
    }
    case DomainUpdate::deformation_diagonal: {
      const Real *fxx = p.deformation[0] + begin, *fyy = p.deformation[3] + begin;
#pragma omp simd
      for (int k = 0; k < n; ++k) {
        lx[k] = reference_x[k] * static_cast<double>(fxx[k]);
        ly[k] = reference_y[k] * static_cast<double>(fyy[k]);
      }
      return;
    }
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
