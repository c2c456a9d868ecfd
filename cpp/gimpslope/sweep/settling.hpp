// The impulses between a rigid body and the soil that may slide along it, of which each depends on
// the motion that all of them lead to.
#pragma once

#include <cmath>

#include "body_terms.hpp"
#include "interface.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

constexpr double kRounding = 1e-12;  // of the motion, for which no other one is looked for
// Measured on random cases (runs_into_an_ellipse in the tests of the twin), with friction of 0.1
// and at most half the stone's mass at a node: none of 3,000 takes more than 7 steps; 0.7 and 3
// times its mass: 4 of 1,000 take more than 30, and then 5 rounds do; 1.7 and 300 times: 8 of 300
// do not settle with 80.
constexpr int kMostSettlings = 30, kFewestRounds = 5, kMostRounds = 80;

/// Solves a x = b for three unknowns, by Cramer's rule.
inline void solve3(const double (&a)[3][3], const double (&b)[3], double (&x)[3]) {
  const auto minor = [&](int i, int j, int k, int l) {
    return a[i][k] * a[j][l] - a[i][l] * a[j][k];
  };
  const double first[3] = {minor(1, 2, 1, 2), -minor(0, 2, 1, 2), minor(0, 1, 1, 2)};
  const double second[3] = {-minor(1, 2, 0, 2), minor(0, 2, 0, 2), -minor(0, 1, 0, 2)};
  const double third[3] = {minor(1, 2, 0, 1), -minor(0, 2, 0, 1), minor(0, 1, 0, 1)};
  double determinant = 0.0;
  for (int i = 0; i < 3; ++i) determinant += a[i][0] * first[i];
  x[0] = x[1] = x[2] = 0.0;
  for (int i = 0; i < 3; ++i) {
    x[0] += first[i] * b[i] / determinant;
    x[1] += second[i] * b[i] / determinant;
    x[2] += third[i] * b[i] / determinant;
  }
}

/// A body and the nodes that its soil may slide at, while the impulses between them are looked for.
struct Interface {
  HeldBody& held;
  BodyNode* nodes;
  int count;
  double mass, inertia, friction;
  double alone[3];       // motion (vx, vy, spin) of the body without the impulses
  double a[3][3], b[3];  // equations of the motion that the present meetings lead to

  Interface(const BodiesView& all, int body)
      : held(all.held[body]),
        nodes(all.nodes + static_cast<std::ptrdiff_t>(body) * all.window * all.window),
        count(all.reaches[body]),
        mass(all.mass[body]),
        inertia(all.inertia[body]),
        friction(all.friction[body]),
        alone{held.velocity[0] + held.taken[0] / mass, held.velocity[1] + held.taken[1] / mass,
              held.spin + held.taken_moment / inertia} {}

  /// The impulses that the nodes take from a body that moves so, and the equations; whether they
  /// meet it and slip as they did before.
  bool answer(const double (&motion)[3]) {
    const double inert[3] = {mass, mass, inertia};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) a[i][j] = i == j ? inert[i] : 0.0;
      b[i] = inert[i] * alone[i];
    }
    held.taken[0] = held.taken[1] = held.taken_moment = 0.0;
    bool same = true;
    for (int k = 0; k < count; ++k) {
      BodyNode& node = nodes[k];
      const Pair off = Pair(node.free[0], node.free[1]) - velocity_at(motion, motion[2], node.arm);
      const Meeting meeting = meeting_of(node, off, friction);
      const double slip = cross(node.normal, off) > 0.0 ? 1.0 : -1.0;
      same = same && meeting == node.meeting && (meeting != Meeting::slipping || slip == node.slip);
      node.meeting = meeting;
      node.slip = slip;
      const Answer m = answer_of(node, friction);
      set(node.taken, -m.of(off));
      const Pair taken(node.taken[0], node.taken[1]);
      for (int c = 0; c < 2; ++c) held.taken[c] += taken[c];
      held.taken_moment += cross(node.arm, taken);
      add_answer(m, node);
    }
    for (int c = 0; c < 2; ++c) held.velocity[c] = alone[c] - held.taken[c] / mass;
    held.spin = alone[2] - held.taken_moment / inertia;
    return same;
  }

  /// Adds what a node answers to the equations.
  void add_answer(const Answer& m, const BodyNode& node) {
    const Pair at_rest = m.of(Pair(node.free[0], node.free[1]));
    const Pair turn = m.of(Pair(-node.arm[1], node.arm[0]));
    const double left = node.arm[0] * m.yx - node.arm[1] * m.xx;
    const double up = node.arm[0] * m.yy - node.arm[1] * m.xy;
    const double rows[3][3] = {
        {m.xx, m.xy, turn[0]}, {m.yx, m.yy, turn[1]}, {left, up, cross(node.arm, turn)}};
    const double right[3] = {at_rest[0], at_rest[1], cross(node.arm, at_rest)};
    for (int i = 0; i < 3; ++i) {
      b[i] += right[i];
      for (int j = 0; j < 3; ++j) a[i][j] += rows[i][j];
    }
  }

  /// Twice the kinetic energy of the body with a motion, (m/s)^2 kg/m.
  double energy_of(double x, double y, double spin) const {
    return mass * (x * x + y * y) + inertia * spin * spin;
  }

  /// That of the difference between a motion and the one which its impulses lead to.
  double unsettled(const double (&motion)[3]) const {
    return energy_of(motion[0] - held.velocity[0], motion[1] - held.velocity[1],
                     motion[2] - held.spin);
  }

  /// That of the body and the soil at its nodes, without the impulses.
  double energy_alone() const {
    double sum = energy_of(alone[0], alone[1], alone[2]);
    for (int k = 0; k < count; ++k)
      sum += nodes[k].mass * Pair(nodes[k].free[0], nodes[k].free[1]).square().sum();
    return sum;
  }

  /// Forgets all impulses.
  void reset() {
    for (int k = 0; k < count; ++k) set(nodes[k].taken, Pair::Zero());
    held.taken[0] = held.taken[1] = held.taken_moment = 0.0;
    for (int c = 0; c < 2; ++c) held.velocity[c] = alone[c];
    held.spin = alone[2];
  }

  /// Gives a node another impulse.
  void give(BodyNode& node, const Pair& impulse) {
    const Pair more = impulse - Pair(node.taken[0], node.taken[1]);
    const double moment = cross(node.arm, more);
    set(node.taken, impulse);
    for (int c = 0; c < 2; ++c) {
      held.taken[c] += more[c];
      held.velocity[c] -= more[c] / mass;
    }
    held.taken_moment += moment;
    held.spin -= moment / inertia;
  }
};

/// Newton's method on a function that is linear as long as meetings and directions of slip stay:
/// the motion tells how the soil meets the body, and the impulses, linear in it, what it is. A step
/// is halved as long as it leaves more than there was. Whether the motion was found, which it is
/// not where a body is much lighter than the soil around it.
inline bool settle_at_once(Interface& between) {
  const HeldBody& held = between.held;
  double now[3] = {held.velocity[0], held.velocity[1], held.spin};
  double start[3] = {}, step[3] = {}, share = 1.0, least = 0.0;
  const double nothing = kRounding * kRounding * between.energy_alone();
  for (int settling = 0; settling < kMostSettlings; ++settling) {
    const bool same = between.answer(now);
    const double left = between.unsettled(now);
    if (left <= nothing || (settling > 0 && share == 1.0 && same)) return true;
    if (settling == 0 || left < least) {
      double target[3];
      solve3(between.a, between.b, target);
      least = left;
      share = 1.0;
      for (int i = 0; i < 3; ++i) {
        start[i] = now[i];
        step[i] = target[i] - now[i];
      }
    } else {
      share *= 0.5;
    }
    for (int i = 0; i < 3; ++i) now[i] = start[i] + share * step[i];
  }
  return false;
}

/// The impulse that a node takes if all others stay, and with it the node's meeting. Where soil
/// runs in, the impulse p along the normal and r across it ends that: out + nn p + nt r = 0. On
/// this line the slip grows with r, by tt - nt^2 / nn > 0, and at r = 0 it is within the cone |r|
/// <= mu p. So the slip is zero within the cone, or against the friction where the line leaves it:
/// soil that does not slip either way sticks, and where rounding cannot tell both impulses are the
/// same.
inline Pair impulse_alone(const Interface& between, BodyNode& node) {
  const bool welded = node.meeting == Meeting::welded;
  const Pair normal = welded ? Pair(1.0, 0.0) : Pair(node.normal[0], node.normal[1]);
  const Pair tangent(-normal[1], normal[0]), own(node.taken[0], node.taken[1]);
  const double turn[2] = {cross(node.arm, normal), cross(node.arm, tangent)};
  const double light = 1.0 / node.mass + 1.0 / between.mass, spun = 1.0 / between.inertia;
  const double nn = light + spun * turn[0] * turn[0], tt = light + spun * turn[1] * turn[1];
  const double nt = spun * turn[0] * turn[1];  // speed along one from an impulse along the other
  const HeldBody& held = between.held;
  const double motion[3] = {held.velocity[0] + own[0] / between.mass,
                            held.velocity[1] + own[1] / between.mass,
                            held.spin + cross(node.arm, own) / between.inertia};
  const Pair off = Pair(node.free[0], node.free[1]) - velocity_at(motion, motion[2], node.arm);
  const double out = (off * normal).sum(), along = (off * tangent).sum();
  const double pushed = (nt * along - tt * out) / (nn * tt - nt * nt);
  const double rubbed = (nt * out - nn * along) / (nn * tt - nt * nt);
  const Pair sticking = pushed * normal + rubbed * tangent;
  if (welded) return sticking;
  if (out >= 0.0) {
    node.meeting = Meeting::apart;
    return Pair::Zero();
  }
  for (const double slip : {1.0, -1.0}) {  // of the soil; friction is against it
    const double rough = -slip * between.friction, gain = nn + rough * nt;
    const double stopping = -out / gain;
    if (gain <= 0.0 || slip * (along + stopping * (nt + rough * tt)) <= 0.0) continue;
    node.meeting = Meeting::slipping;
    node.slip = slip;
    return stopping * normal + rough * stopping * tangent;
  }
  node.meeting = Meeting::stuck;
  return sticking;
}

/// The impulses of one node after the other, a number of times (as Catto 2005 has it for bodies
/// that touch), none of which adds energy: from none at all, for those of a search at once that
/// failed may have added some. What is left is the change by the last round, m/s.
inline void settle_in_turn(Interface& between, int rounds) {
  HeldBody& held = between.held;
  between.reset();
  const double nothing = kRounding * kRounding * between.energy_alone();
  for (int round = 0; round < rounds; ++round) {
    const double before[3] = {held.velocity[0], held.velocity[1], held.spin};
    for (int k = 0; k < between.count; ++k)
      between.give(between.nodes[k], impulse_alone(between, between.nodes[k]));
    const double left = between.unsettled(before);
    held.unsettled = left <= nothing ? 0.0 : std::sqrt(left / between.mass);
  }
}

/// The impulses between a body and the soil at its nodes, and its velocity with them: at once, from
/// as near as it takes; if all that fails, in turn.
inline void settle_nodes(const BodiesView& all, int body) {
  Interface between(all, body);
  HeldBody& held = all.held[body];
  bool settled = settle_at_once(between);
  for (int rounds = kFewestRounds; !settled && rounds <= kMostRounds; rounds *= 2) {
    settle_in_turn(between, rounds);
    settled = held.unsettled == 0.0 || settle_at_once(between);
  }
  if (settled)
    held.unsettled = 0.0;
  else
    settle_in_turn(between, kMostRounds);
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
