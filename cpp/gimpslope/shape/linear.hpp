// Linear hat functions: the original material point method, a point without extent (paper eq. 8).
#pragma once

#include "../instruction_set.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

struct Linear {
  static constexpr const char* names[] = {"linear"};  // of Method(shape=...)
  static constexpr int nodes = 2;                     // a direction
  static constexpr double widest = 0.0;    // domain of a point, in cells; 0 where it has none
  static constexpr double behind = 0.0;    // cells from the point back to where its nodes begin
  static constexpr double variance = 2.0;  // second moment, in those of a box one cell wide

  /// Values w and derivatives d (times the cell size) at the nodes of a point that lies
  /// 1 - room + behind cells to the right of the first one, 0 < room <= 1. Values add up to one
  /// and derivatives to zero: from this the sweeps take those of the second node.
  static void evaluate(double room, double /*width*/, double /*inverse*/, double (&w)[nodes],
                       double (&d)[nodes]) {
    w[0] = room;
    w[1] = 1.0 - room;
    d[0] = -1.0;
    d[1] = 1.0;
  }
};

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
