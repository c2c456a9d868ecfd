// The largest stable time step.
#pragma once

#include "material/material.hpp"
#include "method.hpp"

namespace gimpslope {

/// Largest Courant number c dt / h at which a step is stable, for a domain `width` cells wide.
///
/// The frequencies of the assembled points lie below those of the single point (Irons and Treharne
/// 1971): omega^2 <= (c/h)^2 B / (1 - poisson) in plane strain, where B = max over the place of a
/// point of sum_I S_I'^2 / S_I along one axis. For GIMP B = 4/r + 1/(1 - r/2), r = min(width, 1);
/// dt = 2 / omega. A linear hat has no such bound: B = 4, the classic Courant condition, is taken.
double courant_limit(ShapeKind shape, double width, double poisson);

}  // namespace gimpslope
