// What the steps of a rigid body have in common.
#pragma once

#include <cstddef>

#include "accounts.hpp"
#include "nodes.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Velocity of the place at an arm from the centre of a moving body.
inline Pair velocity_at(const double* velocity, double spin, const double* arm) {
  return {velocity[0] - spin * arm[1], velocity[1] + spin * arm[0]};
}

inline double cross(const double* arm, const Pair& v) { return arm[0] * v[1] - arm[1] * v[0]; }

inline void set(double* two, const Pair& value) {
  two[0] = value[0];
  two[1] = value[1];
}

inline Pair pair_of(const Two<double>& v) { return {v[0], v[1]}; }

template <std::size_t kCount>
void copy(const double (&from)[kCount], double (&to)[kCount]) {
  for (std::size_t c = 0; c < kCount; ++c) to[c] = from[c];
}

/// Keeps the forces on a node, and its velocities, for when it is released.
inline void keep(const NodeStep<double>& s, BodyNode& node) {
  node.mass = s.mass;
  copy(s.internal.of, node.internal);
  copy(s.acting.of, node.acting);
  copy(s.body.of, node.body);
  copy(s.damping.of, node.damping);
  copy(s.raw.of, node.raw);
  copy(s.before.of, node.before);
}

inline NodeStep<double> kept(const BodyNode& node) {
  NodeStep<double> s;
  s.mass = node.mass;
  s.inverse_mass = 1.0 / node.mass;
  copy(node.internal, s.internal.of);
  copy(node.acting, s.acting.of);
  copy(node.body, s.body.of);
  copy(node.damping, s.damping.of);
  copy(node.raw, s.raw.of);
  copy(node.before, s.before.of);
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

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
