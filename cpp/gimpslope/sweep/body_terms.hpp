// What the steps of a rigid body have in common.
#pragma once

#include <cmath>

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

inline NodeStep step_of(const BodyNode& node) {
  NodeStep s;
  s.mass = node.mass;
  s.inverse_mass = 1.0 / node.mass;
  s.internal = Pair(node.internal[0], node.internal[1]);
  s.weight = Pair(node.weight[0], node.weight[1]);
  s.acting = s.internal + s.weight;
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

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
