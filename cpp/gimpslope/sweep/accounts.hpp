// Entries of the ledger that nodes and points make: see ledger.hpp.
#pragma once

#include "../ledger.hpp"
#include "../rotation.hpp"
#include "../view.hpp"
#include "lanes.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Books what walls take from a component, 0 or 1, of a node's motion, which they may have
/// `stopped`: as friction where a Coulomb wall lies along it and no other wall can have stopped it.
inline void add_wall(const GridView& g, int column, int row, int component, bool stopped,
                     double taken, Ledger& sum) {
  bool rubs = false, hits = false;
  const auto look = [&](Side side, bool touched) {
    if (!touched || g.kind[side] == WallKind::free) return;
    const bool normal = (side == left || side == right) == (component == 0);
    if (normal || g.kind[side] == WallKind::fixed) hits = hits || stopped;
    if (!normal && g.kind[side] == WallKind::coulomb) rubs = true;
  };
  look(left, column <= g.wall[left]);
  look(right, column >= g.wall[right]);
  look(bottom, row <= g.wall[bottom]);
  look(top, row >= g.wall[top]);
  (rubs && !hits ? sum.friction : sum.impact) += taken;
}

/// The forces and velocities of nodes in a step.
template <class V>
struct NodeStep {
  V mass, inverse_mass;
  Two<V> internal, acting, body, damping;  // acting: internal forces and the gravity that acts
  Two<V> raw, before, after;               // v-, v', v+

  V total(int c) const { return acting[c] + body[c] + damping[c]; }
};

/// Sums of what steps do at nodes, J/m.
template <class V>
struct NodeWork {
  V damping{}, external{}, integration{}, transfer{};
};

/// What a step does at nodes. With `stress_last` the internal forces do their work at the velocity
/// after the step.
template <class V>
[[gnu::always_inline]] inline void add_nodes(const NodeStep<V>& s, const StepInput& step,
                                             NodeWork<V>& sum, bool stress_last = false) {
  const double acts[2] = {step.gravity_x, step.gravity_y};
  const double full[2] = {step.full_gravity_x, step.full_gravity_y};
  for (int c = 0; c < 2; ++c) {
    const V middle = 0.5 * (s.before[c] + s.after[c]), change = s.after[c] - s.before[c];
    const V held_back = s.mass * (full[c] - acts[c]);  // by a ramp
    const V late = stress_last ? -s.internal[c] : s.internal[c];
    sum.damping -= step.dt * s.damping[c] * middle;
    sum.external += step.dt * (s.body[c] - held_back) * middle;
    sum.integration -= 0.5 * step.dt * (late - s.mass * full[c]) * change;
    sum.transfer += 0.5 * s.mass * (s.after[c] - s.raw[c]) * (s.after[c] + s.raw[c]);
  }
}

template <class V>
void add(const NodeWork<V>& work, Ledger& sum) {
  sum.damping += sum_of_lanes(work.damping);
  sum.external += sum_of_lanes(work.external);
  sum.integration += sum_of_lanes(work.integration);
  sum.transfer += sum_of_lanes(work.transfer);
}

/// Energy that the reactions of the walls take from a component of a node's motion.
inline double taken_by_walls(const NodeStep<double>& s, double dt, int c) {
  const double impulse = s.mass * (s.after[c] - s.before[c]) - dt * s.total(c);
  return -impulse * 0.5 * (s.before[c] + s.after[c]);
}

/// Gain of kinetic energy of n points whose velocity becomes keep v + change.
template <class Real>
double kinetic_gain(const PointsView<Real>& p, int begin, int n, double keep,
                    const double* change_x, const double* change_y) {
  const Real *px = p.vx + begin, *py = p.vy + begin, *mass = p.mass + begin;
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (int k = 0; k < n; ++k) {
    const double vx = px[k], vy = py[k];
    const double ux = keep * vx + change_x[k], uy = keep * vy + change_y[k];
    sum += 0.5 * mass[k] * ((ux - vx) * (ux + vx) + (uy - vy) * (uy + vy));
  }
  return sum;
}

/// The points of a block before their stresses are updated.
struct StressBefore {
  double xx[kBlock], yy[kBlock], zz[kBlock], xy[kBlock], volume[kBlock];
};

template <class Real>
void remember(const View<Real>& view, int begin, int n, StressBefore& before) {
  const PointsView<Real>& p = view.points;
  for (int k = 0; k < n; ++k) {
    before.xx[k] = p.stress_xx[begin + k];
    before.yy[k] = p.stress_yy[begin + k];
    before.zz[k] = p.stress_zz[begin + k];
    before.xy[k] = p.stress_xy[begin + k];
    before.volume[k] = p.volume[begin + k];
  }
}

/// Plastic work and residues of n points whose stress has turned by the rotation and
/// taken the strain increments of `s`.
template <class Strains, class Real>
void add_stress_work(const View<Real>& view, int begin, int n, const Elastic& law, const Strains& s,
                     const StressBefore& before, Ledger& sum) {
  const PointsView<Real>& p = view.points;
  const Real* sxx = p.stress_xx + begin;
  const Real* syy = p.stress_yy + begin;
  const Real* szz = p.stress_zz + begin;
  const Real* sxy = p.stress_xy + begin;
  const Real* volume = p.volume + begin;
  const Compliance compliance = compliance_of(law);
  double plastic = 0.0, hypoelastic = 0.0, integration = 0.0;
#pragma omp simd reduction(+ : plastic, hypoelastic, integration)
  for (int k = 0; k < n; ++k) {
    const Stress after{sxx[k], syy[k], szz[k], sxy[k]};
    const Stress old =
        stress_of(turned(circle_of({before.xx[k], before.yy[k], before.zz[k], before.xy[k]}),
                         s.cosine[k], s.sine[k]));
    const Stress change{after.xx - old.xx, after.yy - old.yy, after.zz - old.zz, after.xy - old.xy};
    const double work = after.xx * s.xx[k] + after.yy * s.yy[k] + 2.0 * after.xy * s.xy[k];
    plastic += volume[k] * (work - product(compliance, after, change));
    hypoelastic -= 0.5 * (volume[k] - before.volume[k]) * product(compliance, old, old);
    integration += 0.5 * volume[k] * product(compliance, change, change);
  }
  sum.plastic += plastic;
  sum.hypoelastic += hypoelastic;
  sum.integration += integration;
}

/// Work that n points take up with their stress after the step, less that which the forces of their
/// stress before it did.
template <class Strains, class Real>
void add_work_of_old_forces(const View<Real>& view, int begin, int n, const Strains& s,
                            const StressBefore& before, Ledger& sum) {
  const PointsView<Real>& p = view.points;
  double more = 0.0;
  for (int k = 0; k < n; ++k) {
    const int m = begin + k;
    const double after =
        p.stress_xx[m] * s.xx[k] + p.stress_yy[m] * s.yy[k] + 2.0 * p.stress_xy[m] * s.xy[k];
    const double old =
        before.xx[k] * s.xx[k] + before.yy[k] * s.yy[k] + 2.0 * before.xy[k] * s.xy[k];
    more += p.volume[m] * after - before.volume[k] * old;
  }
  sum.integration -= more;
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
