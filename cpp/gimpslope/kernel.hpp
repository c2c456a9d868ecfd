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
};

/// Shape functions as compiled: GIMP with one half-length for all points or one for each, and with
/// domains wider than a cell.
enum class Basis { linear, gimp_common, gimp_own, gimp_wide };

/// Nodes a direction that a point reaches, and the widest domain allowed, in cells.
int reach(Basis basis);
double widest(Basis basis);

template <class Real>
Kernel<Real> find_kernel(InstructionSet set, SchemeKind scheme, Basis basis);

}  // namespace gimpslope
