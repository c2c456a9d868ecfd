// Quadratic B-splines: three boxes one cell wide, convolved, whose derivatives do not jump where a
// point crosses into another cell (Steffen, Kirby and Berzins 2008, doi 10.1002/nme.2360).
#pragma once

#include "../instruction_set.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

struct QuadraticBspline {
  static constexpr const char* names[] = {"quadratic_bspline"};
  static constexpr int nodes = 3;
  static constexpr double widest = 0.0;
  static constexpr double behind = 0.5;
  static constexpr double variance = 3.0;

  static void evaluate(double room, double /*width*/, double /*inverse*/, double (&w)[nodes],
                       double (&d)[nodes]) {
    const double xi = 1.0 - room;
    w[0] = 0.5 * room * room;
    w[2] = 0.5 * xi * xi;
    w[1] = 1.0 - w[0] - w[2];
    d[0] = -room;
    d[1] = room - xi;
    d[2] = xi;
  }

  /// Values, which add up to one, and derivatives where the first node lies one cell beyond a wall
  /// on the left (`low`), or the last one beyond a wall on the right (`high`). That node goes on in
  /// line with the two before it, so that motion that is linear up to the wall is met, and the
  /// wall's own node alone moves what touches the wall (Steffen, Wallstedt, Guilkey, Kirby and
  /// Berzins 2008, CMES 31, 107, modified boundary functions). That leaves hats in the half cell at
  /// the wall; a point beyond the wall moves with the wall's node.
  static void at_walls(double room, bool low, bool high, double (&w)[nodes], double (&d)[nodes]) {
    const double inside = low ? 0.5 - room : room - 0.5;
    const double t = inside > 0.0 ? inside : 0.0, slope = inside < 0.0 ? 0.0 : 1.0;
    const bool either = low || high;
    w[0] = low ? 0.0 : (high ? t : w[0]);
    w[1] = either ? 1.0 - t : w[1];
    w[2] = low ? t : (high ? 0.0 : w[2]);
    d[0] = low ? 0.0 : (high ? -slope : d[0]);
    d[1] = low ? -slope : (high ? slope : d[1]);
    d[2] = low ? slope : (high ? 0.0 : d[2]);
  }
};

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
