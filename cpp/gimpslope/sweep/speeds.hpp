// The largest speeds in a scene, for the Courant number.
#pragma once

#include "../view.hpp"
#include "loops.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

template <class Real>
double largest_specific_volume(int n, const Real* volume, const Real* mass) {
  double largest = 0.0;
#pragma omp simd reduction(max : largest)
  for (int k = 0; k < n; ++k) {
    const double ratio = static_cast<double>(volume[k]) / mass[k];
    largest = ratio > largest ? ratio : largest;
  }
  return largest;
}

/// Squared point and wave speeds, c^2 = (K + 4G/3) V / m, of a block. A block that cannot hold the
/// largest wave speed is spared its divisions.
template <class Real>
void add_speeds(const View<Real>& view, const Block& block, Speeds& largest) {
  const PointsView<Real>& p = view.points;
  const int begin = block.begin, n = block.end - block.begin;
  const Real *vx = p.vx + begin, *vy = p.vy + begin;
  const Real *volume = p.volume + begin, *mass = p.mass + begin;
  double point = 0.0, most = 0.0, least = mass[0];
#pragma omp simd reduction(max : point, most) reduction(min : least)
  for (int k = 0; k < n; ++k) {
    const double x = vx[k], y = vy[k];
    const double square = x * x + y * y;
    point = square > point ? square : point;
    most = volume[k] > most ? volume[k] : most;
    least = mass[k] < least ? mass[k] : least;
  }
  largest.point = point > largest.point ? point : largest.point;
  const double modulus = view.laws[block.material].wave_modulus;
  if (modulus * (most / least) <= largest.wave) return;
  const double wave = modulus * largest_specific_volume(n, volume, mass);
  largest.wave = wave > largest.wave ? wave : largest.wave;
}

/// The speeds of all points, in the report of each slab.
template <class Real>
void measure_speeds(const View<Real>& view, Report* reports) {
  together(*view.team, [&](int thread) {
    for_each_slab(view, thread, [&](int slab) {
      Speeds speeds;
      for_each_block(view, slab, [&](const Block& block) { add_speeds(view, block, speeds); });
      reports[slab].speeds = speeds;
    });
  });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
