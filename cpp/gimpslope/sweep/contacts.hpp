// Where rigid bodies meet walls, and the impulses that keep them from running into these and each
// other: by sequential iteration (Catto 2005, Iterative dynamics with temporal coherence).
#pragma once

#include <cmath>

#include "../travel.hpp"
#include "../view.hpp"
#include "body_terms.hpp"
#include "settling.hpp"
#include "stone_contacts.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

// Measured: blocks on each other settle in 25 sweeps where they are three, 209 where ten, 676 where
// twenty.
constexpr int kFewestSweeps = 30, kMostSweeps = 300;

/// Contacts of a body with a wall: its nearest place to either side of its centre, so that it can
/// neither run into it nor turn into it.
inline void add_wall_contacts(const View<double>& view, const StepInput& input, int body,
                              Side side) {
  const BodiesView& all = *view.bodies;
  const GridView& g = view.grid;
  if (g.kind[side] == WallKind::free) return;
  const bool level = side == Side::bottom || side == Side::top;
  const int axis = level ? 1 : 0;
  const double outward = side == Side::right || side == Side::top ? 1.0 : -1.0;
  const double wall = (level ? g.bottom : g.left) + g.wall[side] * g.cell;
  const BodyState& state = all.state[body];
  const double away = outward * (wall - state.centre[axis]);
  if (away - all.radius[body] > g.cell) return;
  const double cosine = std::cos(state.angle), sine = std::sin(state.angle);
  constexpr double kSpread = 1e-3;  // of two places as near the one farther out counts
  double nearest[2] = {2.0 * g.cell, 2.0 * g.cell}, gaps[2] = {}, arms[2][2] = {};
  for (int k = all.begin[body]; k < all.begin[body + 1]; ++k) {
    const double ox = all.offset[0][k], oy = all.offset[1][k];
    double arm[2] = {cosine * ox - sine * oy, sine * ox + cosine * oy};
    const double side_ways = arm[1 - axis] > 0.0 ? 1.0 : -1.0;
    arm[axis] += outward * all.half_length[axis][k];
    arm[1 - axis] += side_ways * all.half_length[1 - axis][k];
    const double gap = away - outward * arm[axis], along = arm[1 - axis];
    const int half = along > 0.0;
    const double rank = gap - kSpread * std::fabs(along);
    if (rank >= nearest[half]) continue;
    nearest[half] = rank;
    gaps[half] = gap;
    arms[half][0] = arm[0];
    arms[half][1] = arm[1];
  }
  for (int half = 0; half < 2; ++half) {
    if (nearest[half] >= 2.0 * g.cell) continue;
    if (*all.contact_count == all.contact_room) {
      *all.contacts_missed = true;
      continue;
    }
    Contact& contact = all.contacts[(*all.contact_count)++];
    contact = {};
    contact.body = body;
    contact.other = -1;
    contact.normal[axis] = -outward;
    for (int c = 0; c < 2; ++c) contact.place[c] = state.centre[c] + arms[half][c];
    contact.closing = gaps[half] > 0.0 ? gaps[half] / input.dt : 0.0;  // not thrown out of it
    contact.friction = g.kind[side] == WallKind::fixed ? 1e300 : g.friction[side];
  }
}

/// An impulse on a body at an arm from the centre of it and its nodes.
inline void push(HeldBody& body, const double* arm, const Pair& impulse) {
  for (int c = 0; c < 2; ++c) body.velocity[c] += impulse[c] / body.mass;
  body.spin += cross(arm, impulse) / body.inertia;
}

/// The impulses at one contact that end what its bodies do there; by how much they change a speed,
/// m/s.
inline double resolve_one(const BodiesView& all, Contact& contact) {
  HeldBody* bodies[2] = {&all.held[contact.body],
                         contact.other < 0 ? nullptr : &all.held[contact.other]};
  const double* places[2] = {all.state[contact.body].centre,
                             contact.other < 0 ? nullptr : all.state[contact.other].centre};
  double arm[2][2] = {};
  for (int side = 0; side < 2 && bodies[side] != nullptr; ++side)
    for (int c = 0; c < 2; ++c)
      arm[side][c] = contact.place[c] - places[side][c] - bodies[side]->centre[c];
  const auto along = [&](const Pair& direction) {  // speed, and what a unit impulse adds to it
    double speed = 0.0, gain = 0.0;
    for (int side = 0; side < 2 && bodies[side] != nullptr; ++side) {
      const HeldBody& b = *bodies[side];
      const double moment = cross(arm[side], direction);
      const Pair v = velocity_at(b.velocity, b.spin, arm[side]);
      speed += (side == 0 ? 1.0 : -1.0) * (v * direction).sum();
      gain += 1.0 / b.mass + moment * moment / b.inertia;
    }
    return Pair(speed, gain);
  };
  const auto apply = [&](const Pair& impulse) {
    push(*bodies[0], arm[0], impulse);
    if (bodies[1] != nullptr) push(*bodies[1], arm[1], -impulse);
  };
  const Pair normal(contact.normal[0], contact.normal[1]);
  const Pair tangent(-normal[1], normal[0]);
  const Pair closing = along(normal);
  double pushed = contact.pushed - (closing[0] + contact.closing) / closing[1];
  pushed = pushed > 0.0 ? pushed : 0.0;
  apply((pushed - contact.pushed) * normal);
  const double parted = std::fabs(pushed - contact.pushed) * closing[1];
  contact.pushed = pushed;
  if (contact.friction == 0.0) return parted;
  const Pair sliding = along(tangent);
  const double most = contact.friction * contact.pushed;
  double rubbed = contact.rubbed - sliding[0] / sliding[1];
  if (contact.pushed == 0.0) rubbed = 0.0;
  rubbed = rubbed > most ? most : (rubbed < -most ? -most : rubbed);
  apply((rubbed - contact.rubbed) * tangent);
  const double slowed = std::fabs(rubbed - contact.rubbed) * sliding[1];
  contact.rubbed = rubbed;
  return parted > slowed ? parted : slowed;
}

/// Impulses at contacts, by which no body runs into what it touches: as many sweeps as do as a
/// rule, and more while the last one has moved a body, which light ones in heavy soil take.
inline void resolve_contacts(const View<double>& view, const StepInput& input) {
  const BodiesView& all = *view.bodies;
  *all.contact_count = 0;
  add_stone_contacts(view, input);
  for (int body = 0; body < all.count; ++body)
    for (const Side side : {Side::left, Side::right, Side::bottom, Side::top})
      add_wall_contacts(view, input, body, side);
  for (int k = 0; k < *all.contact_count; ++k) {
    const Contact& contact = all.contacts[k];
    all.held[contact.body].touches = true;
    if (contact.other >= 0) all.held[contact.other].touches = true;
  }
  const double still = kStill * view.grid.cell / input.dt;
  double& last = *all.contacts_unsettled;
  last = 0.0;
  for (int sweep = 0; sweep < kFewestSweeps || (last > still && sweep < kMostSweeps); ++sweep) {
    for (int body = 0; sweep > 0 && body < all.count; ++body)
      if (all.held[body].touches && all.friction[body] >= 0.0) settle_nodes(all, body);
    last = 0.0;
    for (int k = 0; k < *all.contact_count; ++k) {
      const double change = resolve_one(all, all.contacts[k]);
      last = change > last ? change : last;
    }
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
