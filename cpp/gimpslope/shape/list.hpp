// The shape functions that are compiled: the one place that names them all.
#pragma once

#include "gimp.hpp"
#include "linear.hpp"
#include "quadratic_bspline.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

template <class... Shape>
struct List {};

/// Of those that go by the same name, the one with narrower domains first.
using Shapes = List<Linear, Gimp, WideGimp, QuadraticBspline>;

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
