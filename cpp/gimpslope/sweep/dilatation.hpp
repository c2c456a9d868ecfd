// The stress sweep with volume strains averaged over cells, against the locking of nearly
// incompressible motion: the mean dilatation of B-bar (Hughes 1980) over the points of a cell in
// place of the Gauss points of an element. The forces take the averaged in-plane mean stress, so
// that they do just the work of the averaged strains.
#pragma once

#include "stress.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// The sums of the cell that the place of point k, counted from `begin`, lies in.
template <class Real>
double* cell_of(const View<Real>& view, int begin, int k) {
  const GridView& g = view.grid;
  constexpr bool relative = PointsView<Real>::relative;
  const double left = relative ? 0.0 : g.left, bottom = relative ? 0.0 : g.bottom;
  const int column = static_cast<int>((view.points.x[begin + k] - left) / g.cell);
  const int row = static_cast<int>((view.points.y[begin + k] - bottom) / g.cell);
  return g.cells + 4 * (row * g.stride + column + (relative ? view.points.home[begin + k] : 0));
}

/// First of three sweeps: volumes and their rates to the cells.
template <class Shape, bool kOwnDomain, class Real>
void dilatation_block(const View<Real>& view, const Block& block) {
  const int begin = block.begin, n = block.end - block.begin;
  Weights<Shape, Need::gradients> weights;
  Gradient gradient;
  evaluate<Shape, kOwnDomain>(view, begin, n, weights);
  gather_gradient(view, n, weights, gradient);
  for (int k = 0; k < n; ++k) {
    const double volume = view.points.volume[begin + k];
    double* cell = cell_of(view, begin, k);
    cell[0] += volume;
    cell[1] += volume * (gradient.vx_x[k] + gradient.vy_y[k]);
  }
}

/// Mean stresses to the cells.
template <class Real>
void mean_stress_block(const View<Real>& view, const Block& block) {
  const PointsView<Real>& p = view.points;
  for (int k = 0; k < block.end - block.begin; ++k) {
    const double volume = p.volume[block.begin + k];
    const double xx = p.stress_xx[block.begin + k], yy = p.stress_yy[block.begin + k];
    double* cell = cell_of(view, block.begin, k);
    cell[2] += 0.5 * volume * (xx + yy);
    cell[3] += volume;
  }
}

/// Stresses from the averaged strains.
template <class Shape, bool kOwnDomain, class Real>
void averaged_strain_block(const View<Real>& view, const StepInput& input, const Block& block,
                           Ledger& ledger) {
  const int begin = block.begin, n = block.end - block.begin;
  Weights<Shape, Need::gradients> weights;
  Gradient gradient;
  evaluate<Shape, kOwnDomain>(view, begin, n, weights);
  gather_gradient(view, n, weights, gradient);
  for (int k = 0; k < n; ++k) {
    const double* cell = cell_of(view, begin, k);
    const double own = gradient.vx_x[k] + gradient.vy_y[k];
    const double change = 0.5 * (cell[1] / cell[0] - own);
    gradient.vx_x[k] += change;
    gradient.vy_y[k] += change;
  }
  deform_block(view, input, block, gradient, ledger);
}

/// Second: stresses from the averaged strains, and mean stresses to the cells.
template <class Shape, bool kOwnDomain, class Real>
void averaged_stress_block(const View<Real>& view, const StepInput& input, const Block& block,
                           Ledger& ledger) {
  averaged_strain_block<Shape, kOwnDomain>(view, input, block, ledger);
  mean_stress_block(view, block);
}

/// Third: forces of the stresses with their averaged mean.
template <class Shape, bool kOwnDomain, class Real>
void averaged_force_block(const View<Real>& view, const Block& block) {
  const int begin = block.begin, n = block.end - block.begin;
  Weights<Shape, Need::gradients> weights;
  evaluate<Shape, kOwnDomain>(view, begin, n, weights);
  scatter_stress(view, begin, n, weights, [&](PointForces& forces) {
    for (int k = 0; k < n; ++k) {
      const double* cell = cell_of(view, begin, k);
      const double mean = -view.points.volume[begin + k] / view.grid.cell * (cell[2] / cell[3]);
      const double change = mean - 0.5 * (forces.xx[k] + forces.yy[k]);
      forces.xx[k] += change;
      forces.yy[k] += change;
    }
  });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
