// The stress sweep with volume strains averaged over cells, against the locking of nearly
// incompressible motion: the mean dilatation of B-bar (Hughes 1980) over the points of a cell in
// place of the Gauss points of an element. The forces take the averaged in-plane mean stress, so
// that they do just the work of the averaged strains.
#pragma once

#include "stress.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Of each point of a block, the cell that it lies in, by its node.
struct CellPlaces {
  alignas(kCacheLine) std::int32_t of[kBlock];
};

template <class Real>
void find_cells(const View<Real>& view, int begin, int n, CellPlaces& places) {
  const GridView& g = view.grid;
  constexpr bool relative = PointsView<Real>::relative;
  const double left = relative ? 0.0 : g.left, bottom = relative ? 0.0 : g.bottom;
  const double per_cell = 1.0 / g.cell;
  const int stride = g.stride;
  const Real *x = view.points.x + begin, *y = view.points.y + begin;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    const int column = static_cast<int>((x[k] - left) * per_cell);
    const int row = static_cast<int>((y[k] - bottom) * per_cell);
    places.of[k] = row * stride + column;
  }
  if constexpr (relative)
    for (int k = 0; k < n; ++k) places.of[k] += view.points.home[begin + k];
}

/// Adds two values a point to the sums of its cell, those of points in a row in the same cell at
/// once.
inline void add_to_cells(double* sums, int n, const CellPlaces& places, const double* first,
                         const double* second) {
  for (int k = 0; k < n;) {
    const std::ptrdiff_t place = places.of[k];
    double a = 0.0, b = 0.0;
    for (; k < n && places.of[k] == place; ++k) {
      a += first[k];
      b += second[k];
    }
    double* of_cell = sums + 4 * place;
    of_cell[0] += a;
    of_cell[1] += b;
  }
}

/// First of three sweeps: velocity gradients, which are kept, volumes and their rates to the cells.
template <class Shape, bool kOwnDomain, class Real>
void dilatation_block(const View<Real>& view, const Block& block) {
  const int begin = block.begin, n = block.end - block.begin;
  Weights<Shape, Need::gradients> weights;
  Gradient& gradient = view.gradients[&block - view.blocks];
  CellPlaces places;
  alignas(kCacheLine) double volume[kBlock], rate[kBlock];
  evaluate<Shape, kOwnDomain>(view, begin, n, weights);
  gather_gradient(view, n, weights, gradient);
  find_cells(view, begin, n, places);
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    volume[k] = view.points.volume[begin + k];
    rate[k] = volume[k] * (gradient.vx_x[k] + gradient.vy_y[k]);
  }
  add_to_cells(view.grid.cells, n, places, volume, rate);
}

/// Mean stresses to the cells.
template <class Real>
void mean_stress_block(const View<Real>& view, const Block& block) {
  const PointsView<Real>& p = view.points;
  const int begin = block.begin, n = block.end - block.begin;
  CellPlaces places;
  alignas(kCacheLine) double mean[kBlock], volume[kBlock];
  find_cells(view, begin, n, places);
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    volume[k] = p.volume[begin + k];
    mean[k] = 0.5 * volume[k] * (double{p.stress_xx[begin + k]} + double{p.stress_yy[begin + k]});
  }
  add_to_cells(view.grid.cells + 2, n, places, mean, volume);
}

/// Stresses from the averaged strains.
template <class Real>
void averaged_strain_block(const View<Real>& view, const StepInput& input, const Block& block,
                           Ledger& ledger) {
  const int begin = block.begin, n = block.end - block.begin;
  Gradient& gradient = view.gradients[&block - view.blocks];
  CellPlaces places;
  find_cells(view, begin, n, places);
  const double* cells = view.grid.cells;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    const double* cell = cells + 4 * std::ptrdiff_t{places.of[k]};
    const double own = gradient.vx_x[k] + gradient.vy_y[k];
    const double change = 0.5 * (cell[1] / cell[0] - own);
    gradient.vx_x[k] += change;
    gradient.vy_y[k] += change;
  }
  deform_block(view, input, block, gradient, ledger);
}

/// Second: stresses from the averaged strains, and mean stresses to the cells.
template <class Real>
void averaged_stress_block(const View<Real>& view, const StepInput& input, const Block& block,
                           Ledger& ledger) {
  averaged_strain_block(view, input, block, ledger);
  mean_stress_block(view, block);
}

/// Third: forces of the stresses with their averaged mean.
template <class Shape, bool kOwnDomain, class Real>
void averaged_force_block(const View<Real>& view, const Block& block) {
  const int begin = block.begin, n = block.end - block.begin;
  Weights<Shape, Need::gradients> weights;
  evaluate<Shape, kOwnDomain>(view, begin, n, weights);
  CellPlaces places;
  find_cells(view, begin, n, places);
  const double* cells = view.grid.cells;
  const Real* volume = view.points.volume + begin;
  const double per_cell = -1.0 / view.grid.cell;
  alignas(kCacheLine) double mean[kBlock];
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    const double* cell = cells + 4 * std::ptrdiff_t{places.of[k]};
    mean[k] = per_cell * volume[k] * (cell[2] / cell[3]);
  }
  for (int k = n; k % 4 != 0; ++k) mean[k] = 0.0;
  scatter_stress(view, begin, n, weights, [&](int k, Quad& xx, Quad& yy) {
    const Quad change = quad(mean + k) - 0.5 * (xx + yy);
    xx += change;
    yy += change;
  });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
