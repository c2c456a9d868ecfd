// The compiled combinations of scheme, shape function and domain, for each instruction set.
#pragma once

#include "instruction_set.hpp"
#include "view.hpp"

namespace gimpslope {

/// One combination. `prepare` brings mass and momentum of the points to cleared nodes; `step` takes
/// one step from there and leaves the nodes prepared for the next. `reports` has one entry a
/// slab.
template <class Real>
struct Kernel {
  void (*prepare)(const View<Real>& view);
  void (*step)(const View<Real>& view, const StepInput& input, Report* reports);
  void (*measure_speeds)(const View<Real>& view, Report* reports);
  void (*measure_energies)(const View<double>& view, double gravity_x, double gravity_y,
                           Report* reports);
};

/// A shape function, by its index in the list, with one domain for all points or one for each.
struct Basis {
  int shape = 0;
  bool own_domain = false;
};

/// Widest domain that points share, in cells; of wider ones each point keeps its own.
constexpr double kWidestCommon = 1.0;

template <class Real>
Kernel<Real> find_kernel(InstructionSet set, SchemeKind scheme, Basis basis);

}  // namespace gimpslope
