// Second sweep over the points of a step: velocity, place and domain, then mass and momentum at the
// nodes for the next step.
#pragma once

#include <cmath>

#include "../domain.hpp"
#include "../travel.hpp"
#include "accounts.hpp"
#include "scatter.hpp"
#include "weights.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

constexpr double kHuge = 1e300;

/// The first of the points whose change is not finite or takes it too far.
inline int first_too_far(int n, double per_cell, const double* change) {
  for (int k = 0; k < n; ++k) {
    const double* c = change + 4 * k;
    const bool near =
        per_cell * std::fabs(c[0]) <= kFarthestStep && per_cell * std::fabs(c[1]) <= kFarthestStep;
    if (!near || !(std::fabs(c[2]) + std::fabs(c[3]) <= kHuge)) return k;
  }
  return n - 1;
}

/// Velocity (paper eq. 26) and place: motion = {x, y, (1-alpha) vx, (1-alpha) vy} + sum S update.
/// The points of a block move together or, if one of them would go too far, not at all.
template <class Shape>
void move_points(const View& view, int begin, int n, double alpha, const Weights<Shape>& weights,
                 Report& report) {
  const double* update = view.grid.update;
  const int stride = view.grid.stride;
  const Quad keep(1.0, 1.0, 1.0 - alpha, 1.0 - alpha);
  double* motion = view.points.motion + 4 * begin;
  alignas(64) double change[4 * kBlock];
  Quad largest = Quad::Zero(), sum_of_all = Quad::Zero();  // the sum is NaN if any change is
  for (int k = 0; k < n; ++k) {
    const double* first = update + 4 * weights.first[k];
    Quad sum = Quad::Zero();
    for (int j = 0; j < Shape::nodes; ++j) {
      const double* row = first + 4 * j * stride;
      Quad along = quad(row) * weights.x[0][k];
      for (int i = 1; i < Shape::nodes; ++i) along += quad(row + 4 * i) * weights.x[i][k];
      sum += along * weights.y[j][k];
    }
    quad(change + 4 * k) = sum;
    largest = largest.max(sum.abs());
    sum_of_all += sum;
  }
  const double per_cell = 1.0 / view.grid.cell;
  const double travel = per_cell * (largest[0] > largest[1] ? largest[0] : largest[1]);
  if (!(travel <= kFarthestStep && std::fabs(sum_of_all.sum()) <= kHuge)) {
    report.lost = begin + first_too_far(n, per_cell, change);
    return;
  }
  report.travel = travel > report.travel ? travel : report.travel;
  if (view.ledger != nullptr) {
    report.ledger.transfer -=
        kinetic_gain(n, view.points.mass + begin, motion, change, 1.0 - alpha);
  }
  for (int k = 0; k < n; ++k)
    quad(motion + 4 * k) = keep * quad(motion + 4 * k) + quad(change + 4 * k);
}

/// New domains, how far their edges moved, and the widest one.
inline void resize_domains(const View& view, int begin, int n, Report& report) {
  double* half_length = view.points.half_length + 2 * begin;
  const double per_cell = 1.0 / view.grid.cell;
  double before[2 * kBlock];
  for (int k = 0; k < 2 * n; ++k) before[k] = half_length[k];
  update_domains(view, begin, n);
  for (int k = 0; k < 2 * n; ++k) {
    const double change = per_cell * std::fabs(half_length[k] - before[k]);
    const double width = 2.0 * per_cell * half_length[k];
    if (!(width > 0.0 && report.travel + change <= kFarthestStep)) {
      report.lost = begin + k / 2;
      return;
    }
    report.growth = change > report.growth ? change : report.growth;
    report.width = width > report.width ? width : report.width;
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
