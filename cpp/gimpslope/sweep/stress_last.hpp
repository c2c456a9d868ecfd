// The two parts of a step that updates the stress last: forces of the stress before the step, and
// strains by the velocities that the nodes have come to.
#pragma once

#include "dilatation.hpp"
#include "energies.hpp"
#include "loops.hpp"
#include "stress.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

template <class Shape, bool kOwnDomain, class Real>
void force_block(const View<Real>& view, const Block& block) {
  const int begin = block.begin, n = block.end - block.begin;
  Weights<Shape, Need::gradients> weights;
  evaluate<Shape, kOwnDomain>(view, begin, n, weights);
  scatter_stress(view, begin, n, weights, [](int, Quad&, Quad&) {});
}

/// Forces at the nodes.
template <class Shape, bool kOwnDomain, class Real>
void bring_forces(const View<Real>& view, int thread) {
  const bool averaged = view.grid.cells != nullptr;
  if (averaged) {
    for_each_slab(view, thread, [&](int slab) {
      for_each_block(view, slab, [&](const Block& block) { mean_stress_block(view, block); });
    });
  }
  for_each_slab(view, thread, [&](int slab) {
    for_each_block(view, slab, [&](const Block& block) {
      if (averaged) {
        averaged_force_block<Shape, kOwnDomain>(view, block);
      } else {
        force_block<Shape, kOwnDomain>(view, block);
      }
    });
  });
}

/// What strains averaged over cells need before any point is strained.
template <class Shape, bool kOwnDomain, class Real>
void average_strains(const View<Real>& view, int thread) {
  if (view.grid.cells == nullptr) return;
  for_each_slab(view, thread, [&](int slab) {
    for_each_block(view, slab,
                   [&](const Block& block) { dilatation_block<Shape, kOwnDomain>(view, block); });
  });
}

template <class Shape, bool kOwnDomain, class Real>
void strain_block(const View<Real>& view, const StepInput& input, const Block& block,
                  Report& report) {
  if (view.grid.cells != nullptr) {
    averaged_strain_block(view, input, block, report.ledger);
  } else {
    const int begin = block.begin, n = block.end - block.begin;
    Weights<Shape, Need::gradients> weights;
    Gradient gradient;
    evaluate<Shape, kOwnDomain>(view, begin, n, weights);
    gather_gradient(view, n, weights, gradient);
    deform_block(view, input, block, gradient, report.ledger);
  }
  if constexpr (!PointsView<Real>::relative)
    if (input.wants_energies) add_elastic_energy(view, block, report.energies);
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
