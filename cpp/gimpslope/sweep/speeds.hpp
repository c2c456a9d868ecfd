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

template <class Real>
void know_masses(int n, const Real* mass, Known& known) {
  double least = mass[0], most = mass[0];
#pragma omp simd reduction(min : least) reduction(max : most)
  for (int k = 0; k < n; ++k) {
    least = mass[k] < least ? mass[k] : least;
    most = mass[k] > most ? mass[k] : most;
  }
  known.least_mass = least;
  known.most_mass = most;
}

/// Squared wave speed, c^2 = (K + 4G/3) V / m, of a block that this step has strained. Points alike
/// in mass are spared their divisions, and so is a block that cannot hold the largest, unless by
/// rounding.
template <class Real>
void add_wave_speed(const View<Real>& view, const Block& block, Speeds& largest) {
  const int begin = block.begin, n = block.end - block.begin;
  const Real *volume = view.points.volume + begin, *mass = view.points.mass + begin;
  const double modulus = view.laws[block.material].wave_modulus;
  Known& known = view.known[&block - view.blocks];
  if (known.least_mass == 0.0) know_masses(n, mass, known);
  if (modulus * known.most_volume <= largest.wave * known.least_mass) return;
  const double specific = known.least_mass == known.most_mass
                              ? known.most_volume / known.least_mass
                              : largest_specific_volume(n, volume, mass);
  const double wave = modulus * specific;
  largest.wave = wave > largest.wave ? wave : largest.wave;
}

/// Squared point and wave speeds of a block of which nothing need be known.
template <class Real>
void add_speeds(const View<Real>& view, const Block& block, Speeds& largest) {
  const PointsView<Real>& p = view.points;
  const int begin = block.begin, n = block.end - block.begin;
  for (int k = begin; k < block.end; ++k) {
    const double x = p.vx[k], y = p.vy[k];
    const double square = x * x + y * y;
    largest.point = square > largest.point ? square : largest.point;
  }
  const double wave = view.laws[block.material].wave_modulus *
                      largest_specific_volume(n, p.volume + begin, p.mass + begin);
  largest.wave = wave > largest.wave ? wave : largest.wave;
}

/// The speeds of all points, in the report of each slab.
template <class Real>
void measure_speeds(const View<Real>& view, Report* reports) {
  together(*view.team, [&](int thread) {
    take_slabs(view, thread, [&](int slab) {
      Speeds speeds;
      for_each_block(view, slab, [&](const Block& block) { add_speeds(view, block, speeds); });
      reports[slab].speeds = speeds;
    });
  });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
