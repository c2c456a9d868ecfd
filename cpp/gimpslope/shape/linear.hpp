// Linear hat functions: the original material point method, a point without extent (paper eq. 8).
#pragma once

#include "../instruction_set.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

struct Linear {
  static constexpr int nodes = 2;          // a direction
  static constexpr bool extended = false;  // points have no half-length
  static constexpr double widest = 0.0;    // largest domain width, cells

  /// Values w and derivatives d (times the cell size) at the nodes of a point `xi` cells to the
  /// right of the first one.
  static void evaluate(double xi, double /*width*/, double /*inverse*/, double (&w)[nodes],
                       double (&d)[nodes]) {
    w[0] = 1.0 - xi;
    w[1] = xi;
    d[0] = -1.0;
    d[1] = 1.0;
  }
};

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
