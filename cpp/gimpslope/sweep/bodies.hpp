// Rigid bodies in a step, in a velocity field of their own.
//
// A body holds the nodes up to some way outside of its edge, by the share of their cells that it
// fills: they move with it, and soil sticks to it there. In other nodes it takes no part, so that
// it acts as large as it is, and bodies that are near each other do not stick together. Body and
// held nodes make one rigid body that keeps their momentum and angular momentum and takes up the
// forces of the soil at the nodes. It is then kept from running into walls and other bodies by
// impulses at the places where they meet, found by sequential iteration (Catto 2005, Iterative
// dynamics with temporal coherence): along walls with their friction, between bodies without.
#pragma once

#include <cmath>

#include "../travel.hpp"
#include "accounts.hpp"
#include "loops.hpp"
#include "nodes.hpp"
#include "weights.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Share of a cell from which on a body holds its node; where it is small, of its largest share. Of
/// a flat edge those are held up to e^(-1/2) cells away, with a share of (1 - e^(-1/2))^2 / 2: soil
/// that is strained between the edge, a part s of a cell away from the first free line of nodes,
/// and the next such line is too soft or too stiff by turns as s goes from 0 to 1, and right in the
/// mean.
constexpr double kHeldShare = 0.0774;
constexpr int kContactSweeps = 30;

template <class Real>
bool is_rigid(const View<Real>& view, const Block& block) {
  return view.bodies != nullptr && view.laws[block.material].kind == LawKind::rigid;
}

/// Calls act(body) for the bodies of a thread.
template <class Real, class Act>
void for_each_body(const View<Real>& view, int thread, Act act) {
  for (int body = thread; body < view.bodies->count; body += view.team->size()) act(body);
}

/// Velocity of the place at an arm from the centre of a moving body.
inline Pair velocity_at(const double* velocity, double spin, const double* arm) {
  return {velocity[0] - spin * arm[1], velocity[1] + spin * arm[0]};
}

inline double cross(const double* arm, const Pair& v) { return arm[0] * v[1] - arm[1] * v[0]; }

/// The nodes that a body reaches, with its share of their cells.
template <class Shape, bool kOwnDomain>
void reach_nodes(const View<double>& view, int thread, int body) {
  const BodiesView& all = *view.bodies;
  const GridView& g = view.grid;
  const BodyState& state = all.state[body];
  const int width = all.window, size = width * width;
  double* shares = all.shares + thread * size;
  for (int k = 0; k < size; ++k) shares[k] = 0.0;
  const double per_cell = 1.0 / g.cell, per_area = per_cell * per_cell;
  const int left =
      static_cast<int>(std::floor((state.centre[0] - all.radius[body] - g.left) * per_cell)) - 2;
  const int bottom =
      static_cast<int>(std::floor((state.centre[1] - all.radius[body] - g.bottom) * per_cell)) - 2;

  alignas(kCacheLine) double x[kBlock], y[kBlock], lx[kBlock], ly[kBlock];
  View<double> local = view;  // of some points of the body, one after the other
  local.points.x = x;
  local.points.y = y;
  local.points.half_length[0] = lx;
  local.points.half_length[1] = ly;
  const double cosine = std::cos(state.angle), sine = std::sin(state.angle);
  Weights<Shape, Need::values> weights;
  for (int begin = all.begin[body]; begin < all.begin[body + 1]; begin += kBlock) {
    const int left_over = all.begin[body + 1] - begin, n = left_over < kBlock ? left_over : kBlock;
    for (int k = 0; k < n; ++k) {
      const double ox = all.offset[0][begin + k], oy = all.offset[1][begin + k];
      x[k] = state.centre[0] + cosine * ox - sine * oy;
      y[k] = state.centre[1] + sine * ox + cosine * oy;
      lx[k] = all.half_length[0][begin + k];
      ly[k] = all.half_length[1][begin + k];
    }
    evaluate<Shape, kOwnDomain>(local, 0, n, weights);
    for (int k = 0; k < n; ++k) {
      const int row = weights.first[k] / g.stride, column = weights.first[k] - row * g.stride;
      double* first = shares + (row - bottom) * width + column - left;
      const double share = all.volume[begin + k] * per_area;
      for (int j = 0; j < Shape::nodes; ++j)
        for (int i = 0; i < Shape::nodes; ++i)
          first[j * width + i] += share * weights.value_x(i, k) * weights.value_y(j, k);
    }
  }
  double most = 0.0;
  for (int k = 0; k < size; ++k) most = shares[k] > most ? shares[k] : most;
  const double least = kHeldShare * (most < 1.0 ? most : 1.0);
  BodyNode* nodes = all.nodes + static_cast<std::ptrdiff_t>(body) * size;
  int count = 0;
  for (int j = 0; j < width; ++j) {
    for (int i = 0; i < width; ++i) {
      const double share = shares[j * width + i];
      if (share == 0.0) continue;
      const int row = bottom + j, column = left + i;
      BodyNode& node = nodes[count++];
      node.node = row * g.stride + column;
      node.share = share;
      node.arm[0] = g.left + column * g.cell - state.centre[0];
      node.arm[1] = g.bottom + row * g.cell - state.centre[1];
      // At a wall the wall rules; where there is no soil there is nothing to hold.
      const bool at_wall = column <= g.wall[Side::left] || column >= g.wall[Side::right] ||
                           row <= g.wall[Side::bottom] || row >= g.wall[Side::top];
      node.held = share >= least && !at_wall && g.momentum[4 * node.node] > 0.0;
    }
  }
  all.reaches[body] = count;
}

/// Adds a contact of two bodies at a node where they overlap, or to one that there is.
inline void add_overlap(const BodiesView& all, int a, const BodyNode& of_a, int b,
                        const BodyNode& of_b) {
  int k = 0;
  while (k < *all.contact_count && !(all.contacts[k].body == a && all.contacts[k].other == b)) ++k;
  if (k == all.contact_room) return;
  Contact& contact = all.contacts[k];
  if (k == *all.contact_count) {
    ++*all.contact_count;
    contact = {};
    contact.body = a;
    contact.other = b;
  }
  const double weight = of_a.share * of_b.share;
  contact.weight += weight;
  for (int c = 0; c < 2; ++c) contact.place[c] += weight * (all.state[a].centre[c] + of_a.arm[c]);
}

/// Gives each node that several bodies reach to the one with the largest share, and finds where
/// bodies overlap. By one thread, in the order of the bodies.
inline void share_nodes(const BodiesView& all) {
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(all.window) * all.window;
  *all.contact_count = 0;
  for (int body = 0; body < all.count; ++body) {
    BodyNode* nodes = all.nodes + body * size;
    for (int k = 0; k < all.reaches[body]; ++k) {
      std::int32_t& owner = all.owner[nodes[k].node];
      if (owner < 0) {
        owner = static_cast<std::int32_t>(body * size + k);
        continue;
      }
      BodyNode& before = all.nodes[owner];
      if (before.share + nodes[k].share > 1.0)
        add_overlap(all, static_cast<int>(owner / size), before, body, nodes[k]);
      if (before.share < nodes[k].share) {
        before.held = false;
        owner = static_cast<std::int32_t>(body * size + k);
      } else {
        nodes[k].held = false;
      }
    }
  }
  for (int k = 0; k < *all.contact_count; ++k) {
    Contact& contact = all.contacts[k];
    const double *a = all.state[contact.body].centre, *b = all.state[contact.other].centre;
    const double between = std::hypot(a[0] - b[0], a[1] - b[1]);
    for (int c = 0; c < 2; ++c) {
      contact.place[c] /= contact.weight;
      contact.normal[c] = between > 0.0 ? (a[c] - b[c]) / between : 0.0;
    }
  }
  for (int body = 0; body < all.count; ++body)
    for (int k = 0; k < all.reaches[body]; ++k) all.owner[all.nodes[body * size + k].node] = -1;
}

/// Puts the held nodes at the velocity of their body, before the soil is strained.
inline void hold_nodes(const View<double>& view, int body) {
  const BodiesView& all = *view.bodies;
  BodyNode* nodes = all.nodes + static_cast<std::ptrdiff_t>(body) * all.window * all.window;
  int count = 0;
  for (int k = 0; k < all.reaches[body]; ++k)
    if (nodes[k].held) nodes[count++] = nodes[k];
  all.reaches[body] = count;
  for (int k = 0; k < count; ++k) {
    const Pair v = velocity_at(all.state[body].velocity, all.state[body].spin, nodes[k].arm);
    quad(view.grid.velocity + 4 * nodes[k].node) = Quad{v[0], v[0], v[1], v[1]};
  }
}

/// First part of a step: which nodes each body holds, and their velocity.
template <class Shape, bool kOwnDomain>
void hold_nodes_of_bodies(const View<double>& view, int thread) {
  for_each_body(view, thread,
                [&](int body) { reach_nodes<Shape, kOwnDomain>(view, thread, body); });
  view.team->barrier();
  if (thread == 0) share_nodes(*view.bodies);
  view.team->barrier();
  for_each_body(view, thread, [&](int body) { hold_nodes(view, body); });
  view.team->barrier();
}

inline void set(double* two, const Pair& value) {
  two[0] = value[0];
  two[1] = value[1];
}

inline NodeStep step_of(const BodyNode& node) {
  NodeStep s;
  s.mass = node.mass;
  s.inverse_mass = 1.0 / node.mass;
  s.internal = Pair(node.internal[0], node.internal[1]);
  s.weight = Pair(node.weight[0], node.weight[1]);
  s.body = Pair(node.body[0], node.body[1]);
  s.damping = Pair(node.damping[0], node.damping[1]);
  s.full_weight = Pair(node.full_weight[0], node.full_weight[1]);
  s.raw = Pair(node.raw[0], node.raw[1]);
  s.before = Pair(node.before[0], node.before[1]);
  return s;
}

/// Sum of the body forces of a body's points, and their moment about its centre, per metre.
struct BodyForce {
  double force[2] = {}, moment = 0.0;
};

inline BodyForce body_force_on(const View<double>& view, int body) {
  const BodiesView& all = *view.bodies;
  const PointsView<double>& p = view.points;
  BodyForce sum;
  if (p.body_force[0] == nullptr) return sum;
  for (int k = all.begin[body]; k < all.begin[body + 1]; ++k) {
    const int m = all.member[k];
    const double arm[2] = {p.x[m] - all.state[body].centre[0], p.y[m] - all.state[body].centre[1]};
    const Pair force = p.mass[m] * Pair(p.body_force[0][m], p.body_force[1][m]);
    for (int c = 0; c < 2; ++c) sum.force[c] += force[c];
    sum.moment += cross(arm, force);
  }
  return sum;
}

/// A body and its nodes as one rigid body that has their momentum after the forces.
inline void take_forces(const View<double>& view, const StepInput& input, int body) {
  const BodiesView& all = *view.bodies;
  const BodyState& state = all.state[body];
  BodyNode* nodes = all.nodes + static_cast<std::ptrdiff_t>(body) * all.window * all.window;
  double mass = all.mass[body], inertia = all.inertia[body], centre[2] = {};
  double momentum[2] = {mass * state.velocity[0], mass * state.velocity[1]};
  double turn = inertia * state.spin;  // angular momentum about the centre of the body alone
  const BodyForce given = body_force_on(view, body);
  double force[2] = {}, moment = given.moment;
  for (int c = 0; c < 2; ++c)
    force[c] = given.force[c] + mass * (c == 0 ? input.gravity_x : input.gravity_y);
  for (int k = 0; k < all.reaches[body]; ++k) {
    BodyNode& node = nodes[k];
    const NodeStep s = forces_on(view.grid, node.node, input);
    node.mass = s.mass;
    set(node.internal, s.internal);
    set(node.weight, s.weight);
    set(node.body, s.body);
    set(node.damping, s.damping);
    set(node.full_weight, s.full_weight);
    set(node.raw, s.raw);
    set(node.before, s.before);
    const Pair pull = s.total() - s.damping, brought = s.mass * s.raw;
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
    held.damping[c] = against(force[c], state.velocity[c]);
    momentum[c] += input.dt * (force[c] + held.damping[c]);
  }
  held.damping_moment = against(moment, state.spin);
  turn += input.dt * (moment + held.damping_moment);
  held.mass = mass;
  for (int c = 0; c < 2; ++c) {
    held.centre[c] = centre[c] / mass;
    held.velocity[c] = momentum[c] / mass;
  }
  held.inertia =
      inertia - mass * (held.centre[0] * held.centre[0] + held.centre[1] * held.centre[1]);
  held.spin = (turn - cross(held.centre, Pair(momentum[0], momentum[1]))) / held.inertia;
}

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
    if (nearest[half] >= 2.0 * g.cell || *all.contact_count == all.contact_room) continue;
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

/// Impulses at contacts, by which no body runs into what it touches.
inline void resolve_contacts(const View<double>& view, const StepInput& input) {
  const BodiesView& all = *view.bodies;
  for (int body = 0; body < all.count; ++body)
    for (const Side side : {Side::left, Side::right, Side::bottom, Side::top})
      add_wall_contacts(view, input, body, side);
  for (int sweep = 0; sweep < kContactSweeps; ++sweep) {
    for (int k = 0; k < *all.contact_count; ++k) {
      Contact& contact = all.contacts[k];
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
      const double pushed = contact.pushed - (closing[0] + contact.closing) / closing[1];
      const double whole = pushed > 0.0 ? pushed : 0.0;
      apply((whole - contact.pushed) * normal);
      contact.pushed = whole;
      if (contact.friction == 0.0) continue;
      const Pair sliding = along(tangent);
      const double most = contact.friction * contact.pushed;
      double rubbed = contact.rubbed - sliding[0] / sliding[1];
      if (contact.pushed == 0.0) rubbed = 0.0;
      rubbed = rubbed > most ? most : (rubbed < -most ? -most : rubbed);
      apply((rubbed - contact.rubbed) * tangent);
      contact.rubbed = rubbed;
    }
  }
}

/// What held nodes do to their points, and the ledger of the body and its nodes: see ledger.hpp.
inline void release_nodes(const View<double>& view, const StepInput& input, int body,
                          Ledger& ledger) {
  const BodiesView& all = *view.bodies;
  const HeldBody& held = all.held[body];
  const BodyNode* nodes = all.nodes + static_cast<std::ptrdiff_t>(body) * all.window * all.window;
  for (int k = 0; k < all.reaches[body]; ++k) {
    const BodyNode& node = nodes[k];
    const double arm[2] = {node.arm[0] - held.centre[0], node.arm[1] - held.centre[1]};
    NodeStep s = step_of(node);
    const Pair held_velocity = velocity_at(held.velocity, held.spin, arm);
    const Pair moved = input.dt * held_velocity;
    const Pair gained = held_velocity - (1.0 - input.alpha) * s.raw;
    quad(view.grid.update + 4 * node.node) = Quad{moved[0], moved[1], gained[0], gained[1]};
    if (view.ledger == nullptr) continue;
    Ledger free;  // as it was booked
    s.after = s.raw + input.dt * s.inverse_mass * s.total();
    add_node(s, input.dt, free);
    ledger.damping -= free.damping;
    ledger.external -= free.external;
    ledger.integration -= free.integration;
    ledger.transfer -= free.transfer;
    s.damping = Pair::Zero();
    s.after = held_velocity;
    add_node(s, input.dt, ledger);
    for (int c = 0; c < 2; ++c)
      ledger.rigidity += taken_by_walls(s, input.dt, c) +
                         0.5 * s.mass * (s.raw[c] - s.before[c]) * (s.raw[c] + s.before[c]);
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

/// Second part, once the soil's forces are known and before the nodes are finished.
inline void take_forces_of_bodies(const View<double>& view, const StepInput& input, int thread) {
  for_each_body(view, thread, [&](int body) { take_forces(view, input, body); });
  view.team->barrier();
  if (thread == 0) resolve_contacts(view, input);
  view.team->barrier();
}

/// Third part, between the nodes and their points.
inline void move_bodies(const View<double>& view, const StepInput& input, int thread) {
  for_each_body(view, thread, [&](int body) { move_body(view, input, body); });
  view.team->barrier();
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
