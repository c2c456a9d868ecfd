// Update stress last (Sulsky, Chen and Schreyer 1994; Bardenhagen 2002): the strain of a
// step comes from the velocities that the nodes have come to, and nothing smooths those of a node
// that holds little mass.
#pragma once

#include "../sweep/motion.hpp"
#include "../sweep/nodes.hpp"
#include "../sweep/null_space.hpp"
#include "../sweep/stress_last.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

template <class Shape, bool kOwnDomain, class Real>
struct Usl {
  static void prepare(const View<Real>& view) { bring_all<Shape, kOwnDomain>(view); }

  static void step(const View<Real>& view, const StepInput& input, Report* reports) {
    together(*view.team, [&](int thread) {
      Stopwatch watch(thread == 0 ? view.seconds : nullptr);
      start_rows(view, thread);
      sum_terms<Shape, kOwnDomain>(view, input.order, thread);
      watch.lap(&Seconds::nodes);
      bring_forces<Shape, kOwnDomain>(view, thread);
      watch.lap(&Seconds::stress);
      finish_rows<Afterwards::shown>(view, input, thread);
      add_terms(view, thread);
      watch.lap(&Seconds::nodes);
      average_strains<Shape, kOwnDomain>(view, thread);
      for_each_slab(view, thread, [&](int slab) {
        Report report;
        for_each_block(view, slab, [&](const Block& block) {
          if (report.lost >= 0) return;
          strain_block<Shape, kOwnDomain>(view, input, block, report);
          move_block<Shape, kOwnDomain>(view, input, block, report);
        });
        reports[slab] = report;
      });
      watch.lap(&Seconds::move);
    });
  }
};

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
