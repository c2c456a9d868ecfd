// First sweep over the points of a USF step: velocity gradient, volume, stress, internal force.
#pragma once

#include <cmath>

#include "../material/material.hpp"
#include "../rotation.hpp"
#include "accounts.hpp"
#include "gather.hpp"
#include "scatter.hpp"
#include "weights.hpp"
#include "yielding.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Velocity gradient (paper eq. 21-22).
template <class Shape, class Real>
void gather_gradient(const View<Real>& view, int n, const Weights<Shape, Need::gradients>& weights,
                     Gradient& gradient) {
  gather_block<Shape>(view.grid.velocity, view.grid.stride, n, weights,
                      [&](int k, const Quad(&sums)[4]) {
                        quad(gradient.vx_x + k) = sums[0];
                        quad(gradient.vx_y + k) = sums[1];
                        quad(gradient.vy_x + k) = sums[2];
                        quad(gradient.vy_y + k) = sums[3];
                      });
}

/// F <- (I + L dt) F.
template <class Real>
void update_deformation(const View<Real>& view, int begin, int n, const Gradient& l, double dt) {
  const double factor = dt / view.grid.cell;
  Real* const* f = view.points.deformation;
  Real *xx = f[0] + begin, *xy = f[1] + begin, *yx = f[2] + begin, *yy = f[3] + begin;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    const double fxx = xx[k], fxy = xy[k], fyx = yx[k], fyy = yy[k];
    xx[k] += factor * (l.vx_x[k] * fxx + l.vx_y[k] * fyx);
    xy[k] += factor * (l.vx_x[k] * fxy + l.vx_y[k] * fyy);
    yx[k] += factor * (l.vy_x[k] * fxx + l.vy_y[k] * fyx);
    yy[k] += factor * (l.vy_x[k] * fxy + l.vy_y[k] * fyy);
  }
}

/// Strain increments, volumes and rotations. The loop takes all angles for tiny, as those of stable
/// steps are; larger ones are done again.
template <class Real>
void strain(const View<Real>& view, int begin, int n, double dt, const Gradient& l, Strains& s) {
  const double factor = dt / view.grid.cell;
  const bool linear = view.volume_update == VolumeUpdate::linear;
  const double share = linear ? 1.0 : 0.0;
  Real* volume = view.points.volume + begin;
  double turned = 0.0, strained = 0.0, most = 0.0;
#pragma omp simd reduction(max : turned, strained, most)
  for (int k = 0; k < n; ++k) {
    const double xx = factor * l.vx_x[k], yy = factor * l.vy_y[k];
    const double xy = 0.5 * factor * (l.vx_y[k] + l.vy_x[k]);
    const double turn = factor * (l.vy_x[k] - l.vx_y[k]);
    s.xx[k] = xx;
    s.yy[k] = yy;
    s.xy[k] = xy;
    tiny_rotation(turn, s.cosine[k], s.sine[k]);
    volume[k] *= 1.0 + share * (xx + yy);
    most = volume[k] > most ? volume[k] : most;
    const double angle = std::fabs(turn), size = std::fabs(xx) + std::fabs(yy) + std::fabs(xy);
    turned = angle > turned ? angle : turned;
    strained = size > strained ? size : strained;
  }
  s.largest = strained;
  s.most_volume = most;
  if (turned > kTinyAngle)
    for (int k = 0; k < n; ++k)
      rotation(factor * (l.vy_x[k] - l.vx_y[k]), turned, s.cosine[k], s.sine[k]);
  if (!linear) {
    s.most_volume = 0.0;
    for (int k = 0; k < n; ++k) {
      volume[k] *= std::exp(s.xx[k] + s.yy[k]);
      s.most_volume = volume[k] > s.most_volume ? volume[k] : s.most_volume;
    }
  }
}

/// Stress after the step: turned by the exact rotation, then the law (paper eq. 24-25).
template <class Constants, class Real>
void update_stress(const View<Real>& view, int begin, int n, const Constants& law,
                   const Strains& s) {
  const PointsView<Real>& p = view.points;
  Real* xx = p.stress_xx + begin;
  Real* yy = p.stress_yy + begin;
  Real* zz = p.stress_zz + begin;
  Real* xy = p.stress_xy + begin;
  Real* plastic_strain = p.plastic_strain + begin;
  const Constants constants = law;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    Mohr circle = turned(circle_of({xx[k], yy[k], zz[k], xy[k]}), s.cosine[k], s.sine[k]);
    double strain = plastic_strain[k];
    update(constants, circle, {s.xx[k], s.yy[k], s.xy[k]}, strain);
    const Stress after = stress_of(circle);
    xx[k] = after.xx;
    yy[k] = after.yy;
    zz[k] = after.zz;
    xy[k] = after.xy;
    plastic_strain[k] = strain;
  }
}

/// Stress after the step by the law of a block, or by its elastic part where no point can yield:
/// with the same bits.
template <class Real>
void apply_law(const View<Real>& view, const Block& block, const Law& law, const Strains& strains) {
  const int begin = block.begin, n = block.end - block.begin;
  const DruckerPrager& plastic = law.drucker_prager;
  double& margin = view.known[&block - view.blocks].margin;
  if (law.kind != LawKind::drucker_prager || !may_yield(plastic, strains, margin)) {
    update_stress(view, begin, n, plastic.elastic, strains);
    return;
  }
  update_stress(view, begin, n, plastic, strains);
  if (margin == kUnknown) margin = yield_margin(plastic, view.points, begin, n);
}

/// Forces at the nodes: body forces, and those of the stresses, after change(k, xx, yy) has put
/// others in place of -V / h times the normal stresses of points k to k + 3.
template <class Shape, class Real, class Change>
[[gnu::always_inline]] inline void scatter_stress(const View<Real>& view, int begin, int n,
                                                  const Weights<Shape, Need::gradients>& weights,
                                                  Change change) {
  const PointsView<Real>& p = view.points;
  const Real *volume = p.volume + begin, *stress_xx = p.stress_xx + begin;
  const Real *stress_yy = p.stress_yy + begin, *stress_xy = p.stress_xy + begin;
  const double per_cell = -1.0 / view.grid.cell;
  PointQuads forces;
  by_fours(n, [&](int k, auto count) {
    const Quad factor = per_cell * four(volume + k, count);
    Quad xx = factor * four(stress_xx + k, count), yy = factor * four(stress_yy + k, count);
    const Quad xy = factor * four(stress_xy + k, count);
    change(k, xx, yy);
    forces.put(k, {xx, xy, xy, yy});
  });
  scatter_forces(view, n, weights, forces);
  if (p.body_force[0] != nullptr) scatter_body_forces(view, begin, n, weights);
}

/// Volume, deformation and stress of a block after its strain increments.
template <class Real>
void deform_block(const View<Real>& view, const StepInput& input, const Block& block,
                  const Gradient& gradient, Ledger& ledger) {
  const int begin = block.begin, n = block.end - block.begin;
  const Law& law = view.laws[block.material];
  Strains strains;
  StressBefore before;
  if (view.ledger != nullptr) remember(view, begin, n, before);
  if (view.points.deformation[0] != nullptr) update_deformation(view, begin, n, gradient, input.dt);
  strain(view, begin, n, input.dt, gradient, strains);
  view.known[&block - view.blocks].most_volume = strains.most_volume;
  apply_law(view, block, law, strains);
  if (view.ledger != nullptr)
    add_stress_work(view, begin, n, law.drucker_prager.elastic, strains, before, ledger);
  if (view.ledger != nullptr && input.stress_last)
    add_work_of_old_forces(view, begin, n, strains, before, ledger);
}

template <class Shape, bool kOwnDomain, class Real>
void stress_block(const View<Real>& view, const StepInput& input, const Block& block,
                  Ledger& ledger) {
  const int begin = block.begin, n = block.end - block.begin;
  Weights<Shape, Need::gradients> weights;
  Gradient gradient;
  evaluate<Shape, kOwnDomain>(view, begin, n, weights);
  gather_gradient(view, n, weights, gradient);
  deform_block(view, input, block, gradient, ledger);
  scatter_stress(view, begin, n, weights, [](int, Quad&, Quad&) {});
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
