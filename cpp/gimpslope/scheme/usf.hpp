// Update stress first (paper section "Time integration scheme"): the strain of a step comes from
// the velocities at its start.
#pragma once

#include "../sweep/move.hpp"
#include "../sweep/nodes.hpp"
#include "../sweep/stress.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Runs work(slab) for all slabs, even ones first and odd ones after, so that no two that run at
/// the same time reach the same node. Called by all threads of a team.
template <class Work>
void for_each_slab(const View& view, Work work) {
  for (int parity = 0; parity < 2; ++parity) {
#pragma omp for schedule(dynamic, 1)
    for (int slab = parity; slab < view.slab_count; slab += 2) work(slab);
  }
}

template <class Work>
void for_each_row(const View& view, Work work) {
#pragma omp for schedule(static)
  for (int row = 0; row < view.grid.rows; ++row) work(row);
}

template <class Shape, bool kOwnDomain>
struct Usf {
  static void prepare(const View& view) {
#pragma omp parallel num_threads(view.threads) if (view.threads > 1)
    for_each_slab(view, [&](int slab) {
      for (int b = view.slabs[slab].begin; b < view.slabs[slab].end; ++b) {
        const Block& block = view.blocks[b];
        Weights<Shape> weights;
        evaluate<Shape, kOwnDomain>(view, block.begin, block.end - block.begin, weights);
        scatter_momentum(view, block.begin, block.end - block.begin, weights);
      }
    });
  }

  static void step(const View& view, const StepInput& input, Report* reports) {
#pragma omp parallel num_threads(view.threads) if (view.threads > 1)
    {
      for_each_row(view, [&](int row) { start_nodes(view.grid, row); });
      for_each_slab(view, [&](int slab) {
        for (int b = view.slabs[slab].begin; b < view.slabs[slab].end; ++b)
          stress_block<Shape, kOwnDomain>(view, input, view.blocks[b]);
      });
      for_each_row(view, [&](int row) { finish_nodes(view.grid, row, input); });
      for_each_slab(view, [&](int slab) {
        Report report;
        for (int b = view.slabs[slab].begin; b < view.slabs[slab].end && report.lost < 0; ++b)
          move_block(view, input, view.blocks[b], report);
        reports[slab] = report;
      });
    }
  }

 private:
  static void move_block(const View& view, const StepInput& input, const Block& block,
                         Report& report) {
    const int begin = block.begin, n = block.end - block.begin;
    Weights<Shape> weights;
    evaluate<Shape, kOwnDomain>(view, begin, n, weights);
    move_points(view, begin, n, input.alpha, weights, report);
    if (view.domain_update != DomainUpdate::none) resize_domains(view, begin, n, report);
    if (report.lost >= 0) return;
    evaluate<Shape, kOwnDomain>(view, begin, n, weights);
    scatter_momentum(view, begin, n, weights);
  }
};

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
