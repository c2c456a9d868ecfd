// The largest speeds in a scene, for the Courant number.
#pragma once

#include "../view.hpp"
#include "loops.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Squared point and wave speeds, c^2 = (K + 4G/3) V / m, of a block.
inline void add_speeds(const View& view, const Block& block, Speeds& largest) {
  const PointsView& p = view.points;
  double point = 0.0, specific_volume = 0.0;
#pragma omp simd reduction(max : point, specific_volume)
  for (int k = block.begin; k < block.end; ++k) {
    const double vx = p.motion[4 * k + 2], vy = p.motion[4 * k + 3];
    const double square = vx * vx + vy * vy;
    point = square > point ? square : point;
    const double ratio = p.volume[k] / p.mass[k];
    specific_volume = ratio > specific_volume ? ratio : specific_volume;
  }
  const double wave = view.laws[block.material].wave_modulus * specific_volume;
  largest.point = point > largest.point ? point : largest.point;
  largest.wave = wave > largest.wave ? wave : largest.wave;
}

/// The speeds of all points, in the report of each slab.
inline void measure_speeds(const View& view, Report* reports) {
  together(*view.team, [&] {
    for_each_slab(view, [&](int slab) {
      Speeds speeds;
      for_each_block(view, slab, [&](const Block& block) { add_speeds(view, block, speeds); });
      reports[slab].speeds = speeds;
    });
  });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
