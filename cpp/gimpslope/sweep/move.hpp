// Second sweep over the points of a step: velocity, place and domain, then mass and momentum at the
// nodes for the next step.
#pragma once

#include <cmath>

#include "../domain.hpp"
#include "../travel.hpp"
#include "accounts.hpp"
#include "gather.hpp"
#include "scatter.hpp"
#include "weights.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// What the nodes add to the places and velocities of the points of a block.
struct Change {
  alignas(kCacheLine) double x[kBlock], y[kBlock], vx[kBlock], vy[kBlock];
  double farthest;  // of the displacements along either axis, m
  double all;       // sum of all sizes: NaN if any change is
};

/// Sum of S update (paper eq. 26).
template <class Shape, class Real>
void gather_change(const View<Real>& view, int n, const Weights<Shape, Need::values>& weights,
                   Change& change) {
  Quad farthest{}, all{};
  gather_block<Shape>(view.grid.update, view.grid.stride, n, weights,
                      [&](int k, const Quad(&sums)[4]) {
                        const Quad x = absolute(sums[0]), y = absolute(sums[1]);
                        farthest = larger(larger(x, y), farthest);
                        all += (x + y) + (absolute(sums[2]) + absolute(sums[3]));
                        quad(change.x + k) = sums[0];
                        quad(change.y + k) = sums[1];
                        quad(change.vx + k) = sums[2];
                        quad(change.vy + k) = sums[3];
                      });
  change.farthest = change.all = 0.0;
  for (int m = 0; m < 4; ++m) {
    change.farthest = farthest[m] > change.farthest ? farthest[m] : change.farthest;
    change.all += all[m];
  }
}

constexpr double kHuge = 1e300;

/// The first of the points whose change is not finite or takes it too far.
inline int first_too_far(int n, double per_cell, const Change& change) {
  for (int k = 0; k < n; ++k) {
    const bool near = per_cell * std::fabs(change.x[k]) <= kFarthestStep &&
                      per_cell * std::fabs(change.y[k]) <= kFarthestStep;
    if (!near || !(std::fabs(change.vx[k]) + std::fabs(change.vy[k]) <= kHuge)) return k;
  }
  return n - 1;
}

/// New places, and velocities (1 - alpha) v + change, the largest of which is reported. The points
/// of a block move together or, if one of them would go too far, not at all.
template <class Real>
void move_points(const View<Real>& view, int begin, int n, double alpha, const Change& change,
                 Report& report) {
  const double per_cell = 1.0 / view.grid.cell;
  const double travel = per_cell * change.farthest;
  if (!(travel <= kFarthestStep && change.all <= kHuge)) {
    report.lost = begin + first_too_far(n, per_cell, change);
    return;
  }
  report.travel = travel > report.travel ? travel : report.travel;
  const PointsView<Real>& p = view.points;
  Real *px = p.x + begin, *py = p.y + begin, *vx = p.vx + begin, *vy = p.vy + begin;
  const double keep = 1.0 - alpha;
  if (view.ledger != nullptr)
    report.ledger.transfer -= kinetic_gain(p, begin, n, keep, change.vx, change.vy);
  double fastest = report.speeds.point;
#pragma omp simd reduction(max : fastest)
  for (int k = 0; k < n; ++k) {
    px[k] += change.x[k];
    py[k] += change.y[k];
    vx[k] = keep * vx[k] + change.vx[k];
    vy[k] = keep * vy[k] + change.vy[k];
    const double x = vx[k], y = vy[k];
    const double square = x * x + y * y;
    fastest = square > fastest ? square : fastest;
  }
  report.speeds.point = fastest;
}

/// How the half-lengths of a block changed along one axis.
struct Growth {
  double largest = 0.0;                  // change of a half-length, m, either way
  double narrowest = 0.0, widest = 0.0;  // half-length, m
  bool known = false;                    // none is NaN
};

template <class Real>
Growth growth_of(int n, const double* before, const Real* after) {
  double largest = 0.0, narrowest = after[0], widest = 0.0, sum = 0.0;
#pragma omp simd reduction(max : largest, widest) reduction(min : narrowest) reduction(+ : sum)
  for (int k = 0; k < n; ++k) {
    const double change = std::fabs(after[k] - before[k]);
    largest = change > largest ? change : largest;
    narrowest = after[k] < narrowest ? after[k] : narrowest;
    widest = after[k] > widest ? after[k] : widest;
    sum += after[k];
  }
  return {largest, narrowest, widest, sum <= kHuge};
}

/// New domains, how far their edges moved, and the widest one.
template <class Real>
void resize_domains(const View<Real>& view, int begin, int n, Report& report) {
  const double per_cell = 1.0 / view.grid.cell;
  double before[2][kBlock];
  for (int c = 0; c < 2; ++c)
    for (int k = 0; k < n; ++k) before[c][k] = view.points.half_length[c][begin + k];
  update_domains(view, begin, n);
  for (int c = 0; c < 2; ++c) {
    const Real* after = view.points.half_length[c] + begin;
    const Growth growth = growth_of(n, before[c], after);
    const double farthest = (kFarthestStep - report.travel) / per_cell;
    if (!(growth.known && growth.narrowest > 0.0 && growth.largest <= farthest)) {
      int k = 0;
      while (k < n - 1 && after[k] > 0.0 && std::fabs(after[k] - before[c][k]) <= farthest) ++k;
      report.lost = begin + k;
      return;
    }
    const double change = per_cell * growth.largest, width = 2.0 * per_cell * growth.widest;
    report.growth = change > report.growth ? change : report.growth;
    report.width = width > report.width ? width : report.width;
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
