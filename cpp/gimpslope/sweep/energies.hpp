// The energies of the points: by a sweep of its own, or on the way in a step, where the points are
// in the cache already.
#pragma once

#include "../material/material.hpp"
#include "../view.hpp"
#include "loops.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Adds the elastic energy of a block.
inline void add_elastic_energy(const View<double>& view, const Block& block, Energies& sum) {
  const PointsView<double>& p = view.points;
  const int begin = block.begin, n = block.end - block.begin;
  const double *xx = p.stress_xx + begin, *yy = p.stress_yy + begin;
  const double *zz = p.stress_zz + begin, *xy = p.stress_xy + begin;
  const double* volume = p.volume + begin;
  const Compliance compliance = compliance_of(view.laws[block.material].drucker_prager.elastic);
  double elastic = 0.0;
#pragma omp simd reduction(+ : elastic)
  for (int k = 0; k < n; ++k) {
    const Stress stress{xx[k], yy[k], zz[k], xy[k]};
    elastic += 0.5 * volume[k] * product(compliance, stress, stress);
  }
  sum.elastic += elastic;
}

/// Adds the kinetic and potential energy of a block, and puts the square of its largest speed in
/// place of the speed.
inline void add_energy_of_motion(const View<double>& view, const Block& block, double gravity_x,
                                 double gravity_y, Energies& sum) {
  const PointsView<double>& p = view.points;
  const int begin = block.begin, n = block.end - block.begin;
  const double *x = p.x + begin, *y = p.y + begin, *vx = p.vx + begin, *vy = p.vy + begin;
  const double* mass = p.mass + begin;
  double kinetic = 0.0, potential = 0.0, fastest = sum.max_speed;
#pragma omp simd reduction(+ : kinetic, potential) reduction(max : fastest)
  for (int k = 0; k < n; ++k) {
    const double square = vx[k] * vx[k] + vy[k] * vy[k];
    fastest = square > fastest ? square : fastest;
    kinetic += 0.5 * mass[k] * square;
    potential -= mass[k] * (gravity_x * x[k] + gravity_y * y[k]);
  }
  sum.kinetic += kinetic;
  sum.potential += potential;
  sum.max_speed = fastest;
}

/// The energies of all points, in the report of each slab.
inline void measure_energies(const View<double>& view, double gravity_x, double gravity_y,
                             Report* reports) {
  together(*view.team, [&](int thread) {
    take_slabs(view, thread, [&](int slab) {
      Energies sum;
      for_each_block(view, slab, [&](const Block& block) {
        if (view.laws[block.material].kind == LawKind::rigid) return;
        add_elastic_energy(view, block, sum);
        add_energy_of_motion(view, block, gravity_x, gravity_y, sum);
      });
      reports[slab].energies = sum;
    });
  });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
