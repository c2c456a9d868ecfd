// What a block of points does between its nodes before and after it moves.
#pragma once

#include "affine.hpp"
#include "bodies.hpp"
#include "energies.hpp"
#include "loops.hpp"
#include "move.hpp"
#include "speeds.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Mass and momentum of a block, with that of its affine motion where there is one.
template <class Shape, class Real>
void bring_momentum(const View<Real>& view, int begin, int n,
                    const Weights<Shape, Need::values>& weights) {
  scatter_momentum(view, begin, n, weights);
  if (view.points.affine[0] != nullptr) scatter_affine(view, begin, n, weights);
}

/// The same for a block at its new place, and its volume where it may slide along rigid bodies.
template <class Shape, bool kOwnDomain, class Real>
void bring_block(const View<Real>& view, int begin, int n, Weights<Shape, Need::values>& weights) {
  evaluate<Shape, kOwnDomain>(view, begin, n, weights);
  bring_momentum(view, begin, n, weights);
  if (view.grid.soil == nullptr) return;
  Weights<Shape, Need::gradients> gradients;
  evaluate<Shape, kOwnDomain>(view, begin, n, gradients);
  scatter_soil(view, begin, n, gradients);
}

/// What the nodes add to the motion of a block, and their affine motion where it is kept.
template <class Shape, class Real>
void take_change(const View<Real>& view, int begin, int n,
                 const Weights<Shape, Need::values>& weights, Change& change) {
  gather_change(view, n, weights, change);
  if (view.points.affine[0] != nullptr) gather_affine(view, begin, n, weights);
}

/// Mass and momentum of all points at cleared nodes.
template <class Shape, bool kOwnDomain, class Real>
void bring_all(const View<Real>& view) {
  together(*view.team, [&](int thread) {
    for_each_slab(view, thread, [&](int slab) {
      for_each_block(view, slab, [&](const Block& block) {
        if (is_rigid(view, block)) return;
        Weights<Shape, Need::values> weights;
        bring_block<Shape, kOwnDomain>(view, block.begin, block.end - block.begin, weights);
      });
    });
  });
}

/// New domains of a block that has moved, mass and momentum at its new nodes, and what is asked of
/// its motion.
template <class Shape, bool kOwnDomain, class Real>
void settle_block(const View<Real>& view, const StepInput& input, const Block& block,
                  Weights<Shape, Need::values>& weights, Report& report) {
  const int begin = block.begin, n = block.end - block.begin;
  if (view.domain_update != DomainUpdate::none) resize_domains(view, begin, n, report);
  if (report.lost >= 0) return;
  bring_block<Shape, kOwnDomain>(view, begin, n, weights);
  if (input.wants_speeds) add_wave_speed(view, block, report.speeds);
  if constexpr (!PointsView<Real>::relative)
    if (input.wants_energies)
      add_energy_of_motion(view, block, input.full_gravity_x, input.full_gravity_y,
                           report.energies);
}

template <class Shape, bool kOwnDomain, class Real>
void move_block(const View<Real>& view, const StepInput& input, const Block& block,
                Report& report) {
  const int begin = block.begin, n = block.end - block.begin;
  Weights<Shape, Need::values> weights;
  evaluate<Shape, kOwnDomain>(view, begin, n, weights);
  Change change;
  take_change(view, begin, n, weights, change);
  move_points(view, begin, n, input.alpha, change, report);
  if (report.lost >= 0) return;
  settle_block<Shape, kOwnDomain>(view, input, block, weights, report);
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
