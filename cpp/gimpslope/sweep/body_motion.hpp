// How a rigid body moves: what it takes up with the nodes it holds, and what it hands on to its
// points and theirs.
#pragma once

#include <cmath>

#include "../travel.hpp"
#include "body_terms.hpp"
#include "held_nodes.hpp"
#include "settling.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// A body after the forces: with its nodes as one rigid body that has their momentum, or, where
/// soil may slide along it, alone, with what the nodes take from it.
inline void take_forces(const View<double>& view, const StepInput& input, int body) {
  const BodiesView& all = *view.bodies;
  const BodyState& state = all.state[body];
  BodyNode* nodes = all.nodes + static_cast<std::ptrdiff_t>(body) * all.window * all.window;
  double mass = all.mass[body], inertia = all.inertia[body], centre[2] = {};
  double momentum[2] = {mass * state.velocity[0], mass * state.velocity[1]};
  double turn = inertia * state.spin;  // angular momentum about the centre of the body alone
  const BodyForce given = body_force_on(view, body);
  double around[2] = {}, around_moment = 0.0;  // forces of nodes that move with the body
  const bool slides = all.friction[body] >= 0.0;
  double force[2] = {}, moment = given.moment;
  for (int c = 0; c < 2; ++c)
    force[c] = given.force[c] + mass * (c == 0 ? input.gravity_x : input.gravity_y);
  for (int k = 0; k < all.reaches[body]; ++k) {
    BodyNode& node = nodes[k];
    const NodeStep<double> s = forces_on<double>(view.grid, node.node, input);
    keep(s, node);
    const Pair raw = pair_of(s.raw), all_forces(s.total(0), s.total(1));
    const Pair pull = all_forces - pair_of(s.damping), brought = s.mass * raw;
    if (slides) {
      node.damped = node.meeting == Meeting::apart;
      set(node.free, raw + input.dt * s.inverse_mass * (node.damped ? all_forces : pull));
      if (!node.damped) {  // of the whole, for damping
        for (int c = 0; c < 2; ++c) around[c] += pull[c];
        around_moment += cross(node.arm, pull);
      }
      continue;
    }
    mass += s.mass;
    inertia += s.mass * (node.arm[0] * node.arm[0] + node.arm[1] * node.arm[1]);
    for (int c = 0; c < 2; ++c) {
      centre[c] += s.mass * node.arm[c];
      momentum[c] += brought[c];
      force[c] += pull[c];
    }
    turn += cross(node.arm, brought);
    moment += cross(node.arm, pull);
  }
  // Local damping is of the whole, which has come to rest when its forces cancel.
  HeldBody& held = all.held[body];
  const auto against = [&](double forcing, double motion) {
    return -input.local_damping * std::fabs(forcing) * ((motion > 0.0) - (motion < 0.0));
  };
  for (int c = 0; c < 2; ++c) {
    held.damping[c] = against(force[c] + around[c], state.velocity[c]);
    momentum[c] += input.dt * (force[c] + held.damping[c]);
  }
  held.damping_moment = against(moment + around_moment, state.spin);
  turn += input.dt * (moment + held.damping_moment);
  held.mass = mass;
  for (int c = 0; c < 2; ++c) {
    held.centre[c] = centre[c] / mass;
    held.velocity[c] = momentum[c] / mass;
  }
  held.inertia =
      inertia - mass * (held.centre[0] * held.centre[0] + held.centre[1] * held.centre[1]);
  held.spin = (turn - cross(held.centre, Pair(momentum[0], momentum[1]))) / held.inertia;
  held.taken[0] = held.taken[1] = held.taken_moment = held.unsettled = 0.0;
  held.touches = false;
  if (slides) settle_nodes(all, body);
}

/// Energy that friction takes at a node: its impulse along the surface times the slip, which is the
/// mean of those before and after the forces.
inline double friction_at(const View<double>& view, int body, const BodyNode& node,
                          const Pair& after) {
  if (node.meeting != Meeting::slipping) return 0.0;
  const BodyState& state = view.bodies->state[body];
  const HeldBody& held = view.bodies->held[body];
  const Pair tangent(-node.normal[1], node.normal[0]), taken(node.taken[0], node.taken[1]);
  const Pair of_body = velocity_at(state.velocity, state.spin, node.arm) +
                       velocity_at(held.velocity, held.spin, node.arm);
  const Pair slip = 0.5 * (Pair(node.before[0], node.before[1]) + after - of_body);
  return -(taken * tangent).sum() * (slip * tangent).sum();
}

/// What held nodes do to their points, and the ledger of the body and its nodes: see ledger.hpp.
inline void release_nodes(const View<double>& view, const StepInput& input, int body,
                          Ledger& ledger) {
  const BodiesView& all = *view.bodies;
  const HeldBody& held = all.held[body];
  const BodyNode* nodes = all.nodes + static_cast<std::ptrdiff_t>(body) * all.window * all.window;
  const bool slides = all.friction[body] >= 0.0;
  for (int k = 0; k < all.reaches[body]; ++k) {
    const BodyNode& node = nodes[k];
    const double arm[2] = {node.arm[0] - held.centre[0], node.arm[1] - held.centre[1]};
    NodeStep<double> s = kept(node);
    const Pair raw = pair_of(s.raw);
    Pair held_velocity = velocity_at(held.velocity, held.spin, arm);
    if (slides)
      held_velocity =
          Pair(node.free[0], node.free[1]) + s.inverse_mass * Pair(node.taken[0], node.taken[1]);
    const Pair moved = input.dt * held_velocity;
    const Pair gained = held_velocity - (1.0 - input.alpha) * raw;
    quad(view.grid.update + 4 * node.node) = Quad{moved[0], moved[1], gained[0], gained[1]};
    if (view.ledger == nullptr) continue;
    NodeWork<double> free, held_work;  // as it was booked, and as it is
    for (int c = 0; c < 2; ++c) s.after[c] = s.raw[c] + input.dt * s.inverse_mass * s.total(c);
    add_nodes(s, input, free);
    ledger.damping -= free.damping;
    ledger.external -= free.external;
    ledger.integration -= free.integration;
    ledger.transfer -= free.transfer;
    if (!slides || !node.damped) s.damping = {};
    set(s.after.of, held_velocity);
    add_nodes(s, input, held_work);
    add(held_work, ledger);
    for (int c = 0; c < 2; ++c)
      ledger.rigidity += taken_by_walls(s, input.dt, c) +
                         0.5 * s.mass * (s.raw[c] - s.before[c]) * (s.raw[c] + s.before[c]);
    if (!slides) continue;
    const double rubbed = friction_at(view, body, node, held_velocity);
    ledger.friction += rubbed;
    ledger.rigidity -= rubbed;
  }
}

/// New motion and place of a body and its points.
inline void move_body(const View<double>& view, const StepInput& input, int body) {
  const BodiesView& all = *view.bodies;
  const PointsView<double>& p = view.points;
  const HeldBody& held = all.held[body];
  BodyState& state = all.state[body];
  BodyReport report;
  release_nodes(view, input, body, report.ledger);
  if (all.friction[body] >= 0.0) remember_meetings(view, body);

  const double mass = all.mass[body], inertia = all.inertia[body];
  const double to_centre[2] = {-held.centre[0], -held.centre[1]};
  const Pair velocity = velocity_at(held.velocity, held.spin, to_centre);
  const Pair before(state.velocity[0], state.velocity[1]);
  const Pair gravity(input.gravity_x, input.gravity_y);
  const Pair full_gravity(input.full_gravity_x, input.full_gravity_y);
  const Pair moved = input.dt * velocity;
  const BodyForce given = body_force_on(view, body);
  const auto work_of = [&](const double* force, double moment) {
    return force[0] * moved[0] + force[1] * moved[1] + moment * input.dt * held.spin;
  };
  const double work = work_of(given.force, given.moment);
  const double damped = work_of(held.damping, held.damping_moment);
  const Pair impulse = mass * (velocity - before - input.dt * gravity);
  for (int c = 0; c < 2; ++c) {
    state.impulse[c] += impulse[c];
    state.centre[c] += moved[c];
    state.velocity[c] = velocity[c];
  }
  state.angular_impulse += inertia * (held.spin - state.spin);
  // All that the body gains but by gravity and body forces is taken from its surroundings.
  const double gain = 0.5 * mass * ((velocity - before) * (velocity + before)).sum() +
                      0.5 * inertia * (held.spin - state.spin) * (held.spin + state.spin) -
                      mass * (gravity * moved).sum() - work - damped;
  report.ledger.damping -= damped;
  report.ledger.rigidity -= gain;
  report.ledger.external += work + mass * ((gravity - full_gravity) * moved).sum();
  state.spin = held.spin;
  state.angle += input.dt * held.spin;

  const double cosine = std::cos(state.angle), sine = std::sin(state.angle);
  double fastest = 0.0;
  for (int k = all.begin[body]; k < all.begin[body + 1]; ++k) {
    const int m = all.member[k];
    const double ox = all.offset[0][k], oy = all.offset[1][k];
    const double arm[2] = {cosine * ox - sine * oy, sine * ox + cosine * oy};
    const double x = state.centre[0] + arm[0], y = state.centre[1] + arm[1];
    const double dx = std::fabs(x - p.x[m]), dy = std::fabs(y - p.y[m]);
    const double farther = dx > dy ? dx : dy;
    report.travel = farther > report.travel ? farther : report.travel;
    if (!(farther <= kFarthestStep * view.grid.cell)) report.lost = m;
    const Pair v = velocity_at(state.velocity, state.spin, arm);
    const double square = v.square().sum();
    fastest = square > fastest ? square : fastest;
    p.x[m] = x;
    p.y[m] = y;
    p.vx[m] = v[0];
    p.vy[m] = v[1];
  }
  report.speed = std::sqrt(fastest);
  all.reports[body] = report;
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
