// Modified update stress last (Sulsky, Zhou and Schreyer 1995): the points take their new
// velocities first, and bring them to the nodes where they still are; the strain comes from these.
#pragma once

#include "../sweep/motion.hpp"
#include "../sweep/nodes.hpp"
#include "../sweep/null_space.hpp"
#include "../sweep/renew.hpp"
#include "../sweep/stress_last.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

template <class Shape, bool kOwnDomain, class Real>
struct Musl {
  static void prepare(const View<Real>& view) { bring_all<Shape, kOwnDomain>(view); }

  static void step(const View<Real>& view, const StepInput& input, Report* reports) {
    together(*view.team, [&](int thread) {
      Stopwatch watch(thread == 0 ? view.seconds : nullptr);
      start_rows(view, thread);
      sum_terms<Shape, kOwnDomain>(view, input.order, thread);
      watch.lap(&Seconds::nodes);
      bring_forces<Shape, kOwnDomain>(view, thread);
      watch.lap(&Seconds::stress);
      finish_rows<Afterwards::forces_kept>(view, input, thread);
      add_terms(view, thread);
      watch.lap(&Seconds::nodes);
      for_each_slab(view, thread, [&](int slab) {
        Report report;
        for_each_block(view, slab, [&](const Block& block) {
          if (report.lost < 0) hasten_block(view, input, block, report);
        });
        reports[slab] = report;
      });
      watch.lap(&Seconds::move);
      for_each_row(view, thread, [&](int row) {
        renew_nodes(view.grid, row, input, view.ledger != nullptr ? view.ledger + row : nullptr);
      });
      watch.lap(&Seconds::nodes);
      average_strains<Shape, kOwnDomain>(view, thread);
      for_each_slab(view, thread, [&](int slab) {
        Report report = reports[slab];
        for_each_block(view, slab, [&](const Block& block) {
          if (report.lost >= 0) return;
          strain_block<Shape, kOwnDomain>(view, input, block, report);
          displace_block(view, input, block, report);
        });
        reports[slab] = report;
      });
      watch.lap(&Seconds::move);
    });
  }

 private:
  /// New velocities, and their momentum at the nodes where the points still are.
  static void hasten_block(const View<Real>& view, const StepInput& input, const Block& block,
                           Report& report) {
    const int begin = block.begin, n = block.end - block.begin;
    Weights<Shape, Need::values> weights;
    evaluate<Shape, kOwnDomain>(view, begin, n, weights);
    Change change;
    take_change(view, begin, n, weights, change);
    for (int k = 0; k < n; ++k) change.x[k] = change.y[k] = 0.0;
    change.farthest = 0.0;
    move_points(view, begin, n, input.alpha, change, report);
    if (report.lost < 0) bring_momentum(view, begin, n, weights);
  }

  /// New places, with the velocities that the points have already.
  static void displace_block(const View<Real>& view, const StepInput& input, const Block& block,
                             Report& report) {
    const int begin = block.begin, n = block.end - block.begin;
    Weights<Shape, Need::values> weights;
    evaluate<Shape, kOwnDomain>(view, begin, n, weights);
    Change change;
    gather_change(view, n, weights, change);
    for (int k = 0; k < n; ++k) change.vx[k] = change.vy[k] = 0.0;
    move_points(view, begin, n, 0.0, change, report);
    if (report.lost < 0) settle_block<Shape, kOwnDomain>(view, input, block, weights, report);
  }
};

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
