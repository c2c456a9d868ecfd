// The condition at one side of the domain, applied to every node on or beyond it.
#pragma once

#include <cmath>

#include "instruction_set.hpp"

namespace gimpslope {

enum class WallKind { free, roller, fixed, coulomb };

struct Wall {
  WallKind kind = WallKind::free;
  double friction = 0.0;  // Coulomb coefficient
  double position = 0.0;  // m; x of the left and right wall, y of the bottom and top wall
};

/// Motion of a node that carried no mass in the step before: next to nothing, but neither held nor
/// stuck, which is exactly zero.
constexpr double kNoMotion = 1e-300;

enum Side { left, right, bottom, top };

inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Velocity of a node at a wall before the strain step: no motion through a roller or fixed wall,
/// none into a Coulomb wall, none off one against which the node was held in the step before, and
/// none along it where friction held it there. Whether it comes off or slips is for the forces to
/// tell: a node at rest swings a little to and fro, and a strain from motions that the wall does
/// not allow would add energy in every swing. `outward` is +1 where the wall lies towards larger
/// coordinates.
inline void constrain(WallKind kind, double outward, bool held, bool stuck, double& normal,
                      double& tangential) {
  if (kind == WallKind::coulomb) {
    if (held || outward * normal > 0.0) normal = 0.0;
    if (held && stuck) tangential = 0.0;
  } else if (kind != WallKind::free) {
    normal = 0.0;
    if (kind == WallKind::fixed) tangential = 0.0;
  }
}

/// Updated velocity of a node at a wall. A Coulomb wall takes the velocity that presses into it
/// and, as friction impulse, at most mu times as much from the tangential one.
inline void react(WallKind kind, double mu, double outward, double& normal, double& tangential) {
  if (kind == WallKind::coulomb && outward * normal > 0.0) {
    const double speed = std::fabs(tangential), stopped = mu * std::fabs(normal);
    tangential *= speed > stopped ? 1.0 - stopped / speed : 0.0;
  }
  constrain(kind, outward, false, false, normal, tangential);
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
