// Compiled once for each instruction set: see CMakeLists.txt. Nothing outside this file may be
// compiled with instructions that the processor might lack.
#include "kernel.hpp"

#include "scheme/usf.hpp"
#include "shape/gimp.hpp"
#include "shape/linear.hpp"
#include "sweep/speeds.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {
namespace {

template <template <class, bool, class> class Scheme, class Real>
Kernel<Real> with_basis(Basis basis) {
  const auto of = []<class Combination>(Combination) -> Kernel<Real> {
    return {&Combination::prepare, &Combination::step, &measure_speeds<Real>};
  };
  switch (basis) {
    case Basis::linear:
      return of(Scheme<Linear, false, Real>{});
    case Basis::gimp_common:
      return of(Scheme<Gimp, false, Real>{});
    case Basis::gimp_own:
      return of(Scheme<Gimp, true, Real>{});
    case Basis::gimp_wide:
      break;
  }
  return of(Scheme<WideGimp, true, Real>{});
}

}  // namespace

/// The list of combinations that are built.
template <class Real>
Kernel<Real> kernel(SchemeKind scheme, Basis basis) {
  switch (scheme) {
    case SchemeKind::usf:
      break;
  }
  return with_basis<Usf, Real>(basis);
}

template Kernel<double> kernel(SchemeKind scheme, Basis basis);
template Kernel<float> kernel(SchemeKind scheme, Basis basis);

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
