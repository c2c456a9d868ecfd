// Update stress first (paper section "Time integration scheme"): the strain of a step comes from
// the velocities at its start.
#pragma once

#include "../sweep/bodies.hpp"
#include "../sweep/dilatation.hpp"
#include "../sweep/energies.hpp"
#include "../sweep/loops.hpp"
#include "../sweep/motion.hpp"
#include "../sweep/nodes.hpp"
#include "../sweep/null_space.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

template <class Shape, bool kOwnDomain, class Real>
struct Usf {
  static void prepare(const View<Real>& view) { bring_all<Shape, kOwnDomain>(view); }

  static void step(const View<Real>& view, const StepInput& input, Report* reports) {
    together(*view.team, [&](int thread) {
      Stopwatch watch(thread == 0 ? view.seconds : nullptr);
      // Bodies and XPIC need all nodes at once; else each row waits for the sweep that takes it.
      const bool apart = view.bodies != nullptr || view.grid.terms != nullptr;
      if (apart) {
        start_rows(view, thread);
        sum_terms<Shape, kOwnDomain>(view, input.order, thread);
        with_bodies(view, [&](const auto& doubles) {
          hold_nodes_of_bodies<Shape, kOwnDomain>(doubles, thread);
        });
        watch.lap(&Seconds::nodes);
      }
      const auto start = [&](int begin, int end) {
        if (apart) return;
        watch.lap(&Seconds::stress);
        for (int row = begin; row < end; ++row) start_row(view, row);
        watch.lap(&Seconds::nodes);
      };
      update_stresses(view, thread, input, reports, start);
      watch.lap(&Seconds::stress);
      if (apart) {
        with_bodies(view,
                    [&](const auto& doubles) { take_forces_of_bodies(doubles, input, thread); });
        finish_rows<Afterwards::none>(view, input, thread);
        add_terms(view, thread);
        with_bodies(view, [&](const auto& doubles) { move_bodies(doubles, input, thread); });
        watch.lap(&Seconds::nodes);
      }
      const auto finish = [&](int begin, int end) {
        if (apart) return;
        watch.lap(&Seconds::move);
        for (int row = begin; row < end; ++row) finish_row<Afterwards::none>(view, input, row);
        watch.lap(&Seconds::nodes);
      };
      for_each_slab(view, thread, finish, [&](int slab) {
        Report report;
        report.ledger = reports[slab].ledger;
        report.energies = reports[slab].energies;
        for_each_block(view, slab, moved(view.points), [&](const Block& block) {
          if (report.lost < 0 && !is_rigid(view, block))
            move_block<Shape, kOwnDomain>(view, input, block, report);
        });
        reports[slab] = report;
      });
      watch.lap(&Seconds::move);
    });
  }

 private:
  /// Calls act(view) where there are bodies, which are in double precision only.
  template <class Act>
  static void with_bodies(const View<Real>& view, Act act) {
    if constexpr (!PointsView<Real>::relative)
      if (view.bodies != nullptr) act(view);
  }

  /// `start` brings rows of nodes to what the first sweep takes from them.
  template <class Start>
  static void update_stresses(const View<Real>& view, int thread, const StepInput& input,
                              Report* reports, Start start) {
    const bool averaged = view.grid.cells != nullptr;
    const auto stresses = [&](int slab) {
      Ledger ledger;
      Energies energies;
      for_each_block(view, slab, strained(view.points), [&](const Block& block) {
        if (is_rigid(view, block)) return;
        if (averaged) {
          averaged_stress_block(view, input, block, ledger);
        } else {
          stress_block<Shape, kOwnDomain>(view, input, block, ledger);
        }
        if constexpr (!PointsView<Real>::relative)
          if (input.wants_energies) add_elastic_energy(view, block, energies);
      });
      reports[slab].ledger = ledger;
      reports[slab].energies = energies;
    };
    if (!averaged) {
      for_each_slab(view, thread, start, stresses);
      return;
    }
    for_each_slab(view, thread, start, [&](int slab) {
      for_each_block(view, slab, [&](const Block& block) {
        if (!is_rigid(view, block)) dilatation_block<Shape, kOwnDomain>(view, block);
      });
    });
    for_each_slab(view, thread, stresses);
    for_each_slab(view, thread, [&](int slab) {
      for_each_block(view, slab, strained(view.points), [&](const Block& block) {
        if (!is_rigid(view, block)) averaged_force_block<Shape, kOwnDomain>(view, block);
      });
    });
  }
};

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
