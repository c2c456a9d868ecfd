// Compiled once for each instruction set: see CMakeLists.txt. Nothing outside this file may be
// compiled with instructions that the processor might lack.
#include "kernel.hpp"

#include "scheme/musl.hpp"
#include "scheme/usf.hpp"
#include "scheme/usl.hpp"
#include "shape/list.hpp"
#include "sweep/energies.hpp"
#include "sweep/speeds.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {
namespace {

template <class Real, class Combination>
Kernel<Real> of() {
  return {&Combination::prepare, &Combination::step, &measure_speeds<Real>, &measure_energies};
}

/// Points share domains up to a certain width, have their own beyond it, or have none.
template <template <class, bool, class> class Scheme, class Real, class Shape>
Kernel<Real> with_domain(bool own) {
  constexpr bool extended = Shape::widest > 0.0;
  if constexpr (extended && Shape::widest <= kWidestCommon) {
    return own ? of<Real, Scheme<Shape, true, Real>>() : of<Real, Scheme<Shape, false, Real>>();
  } else {
    return of<Real, Scheme<Shape, extended, Real>>();
  }
}

template <template <class, bool, class> class Scheme, class Real, class... Shape>
Kernel<Real> with_basis(Basis basis, List<Shape...>) {
  constexpr Kernel<Real> (*of_shape[])(bool own) = {&with_domain<Scheme, Real, Shape>...};
  return of_shape[basis.shape](basis.own_domain);
}

}  // namespace

/// The list of combinations that are built.
template <class Real>
Kernel<Real> kernel(SchemeKind scheme, Basis basis) {
  switch (scheme) {
    case SchemeKind::usl:
      return with_basis<Usl, Real>(basis, Shapes{});
    case SchemeKind::musl:
      return with_basis<Musl, Real>(basis, Shapes{});
    case SchemeKind::usf:
      break;
  }
  return with_basis<Usf, Real>(basis, Shapes{});
}

template Kernel<double> kernel(SchemeKind scheme, Basis basis);
template Kernel<float> kernel(SchemeKind scheme, Basis basis);

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
