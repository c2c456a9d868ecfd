// Generalized interpolation (paper eq. 14-16; Bardenhagen and Kober 2004): the hat function
// averaged over the domain [x - l, x + l] of a point. With the initial l it is uGIMP, with a
// current l cpGIMP.
#pragma once

#include <cmath>

#include "../instruction_set.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Domains up to one cell wide, which reach three nodes.
struct Gimp {
  static constexpr const char* names[] = {"ugimp", "cpgimp"};
  static constexpr int nodes = 3;
  static constexpr double widest = 1.0;
  static constexpr double behind = 0.0;    // from the left edge of the domain
  static constexpr double variance = 2.0;  // of the hat, before it is averaged

  /// Values w and derivatives d (times the cell size); `room` cells from the left edge of the
  /// domain to the second node; the domain is `width` = 2 l / h cells wide, `inverse` = 1 / width.
  /// Free of branches and of cancellation: a and b are the parts of the domain in the first and the
  /// second cell, and a node's value is the area below its hat over them.
  static void evaluate(double room, double width, double inverse, double (&w)[nodes],
                       double (&d)[nodes]) {
    const double a = room < width ? room : width;
    const double b = width - a;
    d[0] = a * -inverse;
    d[2] = b * inverse;
    d[1] = a * inverse - d[2];
    w[0] = 0.5 * inverse * (a * (2.0 * room - a));
    w[2] = 0.5 * inverse * (b * b);
    w[1] = 1.0 - w[0] - w[2];
  }
};

/// Domains up to three cells wide, which reach five nodes: a cpGIMP domain after strong extension.
struct WideGimp {
  static constexpr auto& names = Gimp::names;
  static constexpr int nodes = 5;
  static constexpr double widest = 3.0;
  static constexpr double behind = Gimp::behind;
  static constexpr double variance = Gimp::variance;

  static void evaluate(double room, double width, double inverse, double (&w)[nodes],
                       double (&d)[nodes]) {
    const double left = 1.0 - room, right = left + width;  // edges, in cells from the first node
    for (int i = 0; i < nodes; ++i) {
      w[i] = (area(right - i) - area(left - i)) * inverse;
      d[i] = (hat(right - i) - hat(left - i)) * inverse;
    }
  }

 private:
  static double hat(double s) { return std::fabs(s) < 1.0 ? 1.0 - std::fabs(s) : 0.0; }
  /// Integral of the hat function up to s.
  static double area(double s) {
    const double c = s < -1.0 ? -1.0 : (s > 1.0 ? 1.0 : s);
    return 0.5 + c - 0.5 * c * std::fabs(c);
  }
};

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
