// Where every joule goes.
//
// A step takes a node from v-, the mean velocity of its points, to v', which the walls allow, and
// with the forces f and the walls' reactions to v+. Let vm = (v' + v+) / 2, dv = v+ - v', the
// impulse of the walls j = m dv - dt f, and w(s) the elastic energy a volume. Then
//
//   friction     m (v-^2 - v'^2) / 2 - j . vm, of components along a Coulomb wall; and the impulse
//                of soil that slips along a rigid body times the mean slip
//   impact       the same of all others, and of those that another wall stops
//   damping      -dt (local damping force) . vm, and what kinetic damping takes
//   external     dt (body force, less the part of gravity that a ramp holds back) . vm
//   transfer     m (v+^2 - v-^2) / 2 of the nodes less the points' gain of kinetic energy
//   rigidity     what rigid bodies take from the nodes they hold, as impact, less all they gain
//                but by gravity and body forces, less their friction along soil
//   plastic      V s : (plastic strain increment), with the stress s after the return
//   hypoelastic  -dV w(s before): the rate law stores energy a volume, and volumes change
//   integration  V w(ds) - dt (internal force - m g) . dv / 2
//
// summed over nodes, points and steps make kinetic + elastic + potential energy + all of these
// - external constant but for rounding. That follows from the step: the internal forces do the work
// dt f . v' = -sum V s : (strain increment), and gravity dt m g . v+. `integration` is what a
// finite step leaves over; it swings at first order in dt and vanishes with it.
//
// Where the stress is updated last, the forces of the stress s- before the step do their work at
// the velocity v* of the strain, which is v+ or, in MUSL, what the points bring back of it:
//
//   transfer     in addition dt (internal force) . (v* - v+)
//   integration  V w(ds) + dt (internal force + m g) . dv / 2
//                - (V s - (V s-)) : (strain increment)
//
// With XPIC the points change by v+ - v' and keep what walls hold of v-: m (v-^2 - v'^2) / 2 goes
// to transfer, where it comes back from, and not to friction or impact.
#pragma once

#include "instruction_set.hpp"

namespace gimpslope {

/// Sums since the clock was last set to zero, J/m.
struct Ledger {
  double plastic = 0.0, friction = 0.0, impact = 0.0, damping = 0.0;
  double transfer = 0.0, external = 0.0, hypoelastic = 0.0, integration = 0.0;
  double rigidity = 0.0;
};

inline namespace GIMPSLOPE_INSTRUCTION_SET {

inline void add(const Ledger& entry, Ledger& sum) {
  sum.plastic += entry.plastic;
  sum.friction += entry.friction;
  sum.impact += entry.impact;
  sum.damping += entry.damping;
  sum.transfer += entry.transfer;
  sum.external += entry.external;
  sum.hypoelastic += entry.hypoelastic;
  sum.integration += entry.integration;
  sum.rigidity += entry.rigidity;
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
