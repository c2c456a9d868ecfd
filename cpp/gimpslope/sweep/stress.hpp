// First sweep over the points of a USF step: velocity gradient, volume, stress, internal force.
#pragma once

#include <cmath>

#include "../material/material.hpp"
#include "../rotation.hpp"
#include "accounts.hpp"
#include "scatter.hpp"
#include "weights.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// What the short loops over a block hand to each other.
struct Strains {
  alignas(64) double gradient[4 * kBlock];  // h {dvx/dx, dvx/dy, dvy/dx, dvy/dy}
  double xx[kBlock], yy[kBlock], xy[kBlock];
  double turn[kBlock], cosine[kBlock], sine[kBlock];  // of twice the angle
};

/// Velocity gradient (paper eq. 21-22).
template <class Shape>
void gather_gradient(const View& view, int n, const Weights<Shape>& weights, double* gradient) {
  const double* velocity = view.grid.velocity;
  const int stride = view.grid.stride;
  for (int k = 0; k < n; ++k) {
    Quad x[Shape::nodes];
    for (int i = 0; i < Shape::nodes; ++i)
      x[i] = Quad(weights.dx[i][k], weights.x[i][k], weights.dx[i][k], weights.x[i][k]);
    const double* first = velocity + 4 * weights.first[k];
    Quad sum = Quad::Zero();
    for (int j = 0; j < Shape::nodes; ++j) {
      const double* row = first + 4 * j * stride;
      Quad along = x[0] * quad(row);
      for (int i = 1; i < Shape::nodes; ++i) along += x[i] * quad(row + 4 * i);
      sum += along * Quad(weights.y[j][k], weights.dy[j][k], weights.y[j][k], weights.dy[j][k]);
    }
    quad(gradient + 4 * k) = sum;
  }
}

/// F <- (I + L dt) F.
inline void update_deformation(int n, const double* gradient, double factor, double* deformation) {
  for (int k = 0; k < n; ++k) {
    const double* l = gradient + 4 * k;
    double* f = deformation + 4 * k;
    const double xx = f[0], xy = f[1], yx = f[2], yy = f[3];
    f[0] += factor * (l[0] * xx + l[1] * yx);
    f[1] += factor * (l[0] * xy + l[1] * yy);
    f[2] += factor * (l[2] * xx + l[3] * yx);
    f[3] += factor * (l[2] * xy + l[3] * yy);
  }
}

/// Strain increments, volumes, and the angle of the rotation.
inline void update_volume(const View& view, int begin, int n, double dt, Strains& s) {
  const double factor = dt / view.grid.cell;
  double* volume = view.points.volume + begin;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    s.xx[k] = factor * s.gradient[4 * k];
    s.yy[k] = factor * s.gradient[4 * k + 3];
    s.xy[k] = 0.5 * factor * (s.gradient[4 * k + 1] + s.gradient[4 * k + 2]);
    s.turn[k] = factor * (s.gradient[4 * k + 2] - s.gradient[4 * k + 1]);
  }
  if (view.volume_update == VolumeUpdate::linear) {
#pragma omp simd
    for (int k = 0; k < n; ++k) volume[k] *= 1.0 + (s.xx[k] + s.yy[k]);
  } else {
    for (int k = 0; k < n; ++k) volume[k] *= std::exp(s.xx[k] + s.yy[k]);
  }
}

/// Stress after the step: turned by the exact rotation, then the law (paper eq. 24-25).
template <class Constants>
void update_stress(const View& view, int begin, int n, const Constants& law, const Strains& s) {
  const PointsView& p = view.points;
  double* xx = p.stress_xx + begin;
  double* yy = p.stress_yy + begin;
  double* zz = p.stress_zz + begin;
  double* xy = p.stress_xy + begin;
  double* plastic_strain = p.plastic_strain + begin;
  const Constants constants = law;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    Stress stress = turned({xx[k], yy[k], zz[k], xy[k]}, s.cosine[k], s.sine[k]);
    double strain = plastic_strain[k];
    update(constants, stress, {s.xx[k], s.yy[k], s.xy[k]}, strain);
    xx[k] = stress.xx;
    yy[k] = stress.yy;
    zz[k] = stress.zz;
    xy[k] = stress.xy;
    plastic_strain[k] = strain;
  }
}

inline void point_forces(const View& view, int begin, int n, double* forces) {
  const PointsView& p = view.points;
  const double per_cell = -1.0 / view.grid.cell;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    const double volume = per_cell * p.volume[begin + k];
    const double shear = volume * p.stress_xy[begin + k];
    forces[4 * k] = volume * p.stress_xx[begin + k];
    forces[4 * k + 1] = shear;
    forces[4 * k + 2] = shear;
    forces[4 * k + 3] = volume * p.stress_yy[begin + k];
  }
}

/// Volume, deformation and stress of a block after its strain increments.
inline void deform_block(const View& view, const StepInput& input, const Block& block,
                         Strains& strains, Ledger& ledger) {
  const int begin = block.begin, n = block.end - block.begin;
  const Law& law = view.laws[block.material];
  StressBefore before;
  if (view.ledger != nullptr) remember(view, begin, n, before);
  if (view.points.deformation != nullptr) {
    update_deformation(n, strains.gradient, input.dt / view.grid.cell,
                       view.points.deformation + 4 * begin);
  }
  update_volume(view, begin, n, input.dt, strains);
  rotation(n, strains.turn, strains.cosine, strains.sine);
  with_constants(law,
                 [&](const auto& constants) { update_stress(view, begin, n, constants, strains); });
  if (view.ledger != nullptr)
    add_stress_work(view, begin, n, law.drucker_prager.elastic, strains, before, ledger);
}

template <class Shape, bool kOwnDomain>
void stress_block(const View& view, const StepInput& input, const Block& block, Ledger& ledger) {
  const int begin = block.begin, n = block.end - block.begin;
  Weights<Shape> weights;
  Strains strains;
  evaluate<Shape, kOwnDomain, Need::gradients>(view, begin, n, weights);
  gather_gradient(view, n, weights, strains.gradient);
  deform_block(view, input, block, strains, ledger);
  point_forces(view, begin, n, strains.gradient);
  scatter_forces(view, n, weights, strains.gradient);
  if (view.points.body_force != nullptr) scatter_body_forces(view, begin, n, weights);
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
