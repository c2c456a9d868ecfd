// Update stress first (paper section "Time integration scheme"): the strain of a step comes from
// the velocities at its start.
#pragma once

#include "../sweep/bodies.hpp"
#include "../sweep/dilatation.hpp"
#include "../sweep/energies.hpp"
#include "../sweep/loops.hpp"
#include "../sweep/move.hpp"
#include "../sweep/nodes.hpp"
#include "../sweep/speeds.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

template <class Shape, bool kOwnDomain, class Real>
struct Usf {
  static void prepare(const View<Real>& view) {
    together(*view.team, [&](int thread) {
      for_each_slab(view, thread, [&](int slab) {
        for_each_block(view, slab, [&](const Block& block) {
          if (is_rigid(view, block)) return;
          scatter_block(view, block.begin, block.end - block.begin);
        });
      });
    });
  }

  static void step(const View<Real>& view, const StepInput& input, Report* reports) {
    together(*view.team, [&](int thread) {
      Stopwatch watch(thread == 0 ? view.seconds : nullptr);
      for_each_row(view, thread, [&](int row) {
        start_nodes(view.grid, row, view.ledger != nullptr ? view.ledger + row : nullptr);
      });
      with_bodies(view, [&](const auto& doubles) {
        hold_nodes_of_bodies<Shape, kOwnDomain>(doubles, thread);
      });
      watch.lap(&Seconds::nodes);
      update_stresses(view, thread, input, reports);
      watch.lap(&Seconds::stress);
      with_bodies(view,
                  [&](const auto& doubles) { take_forces_of_bodies(doubles, input, thread); });
      for_each_row(view, thread, [&](int row) {
        if (view.ledger != nullptr) {
          finish_nodes<true>(view.grid, row, input, view.ledger + row);
        } else {
          finish_nodes<false>(view.grid, row, input, nullptr);
        }
      });
      with_bodies(view, [&](const auto& doubles) { move_bodies(doubles, input, thread); });
      watch.lap(&Seconds::nodes);
      for_each_slab(view, thread, [&](int slab) {
        Report report;
        report.ledger = reports[slab].ledger;
        report.energies = reports[slab].energies;
        for_each_block(view, slab, [&](const Block& block) {
          if (report.lost < 0 && !is_rigid(view, block)) move_block(view, input, block, report);
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

  static void update_stresses(const View<Real>& view, int thread, const StepInput& input,
                              Report* reports) {
    const bool averaged = view.grid.cells != nullptr;
    if (averaged) {
      for_each_slab(view, thread, [&](int slab) {
        for_each_block(view, slab, [&](const Block& block) {
          if (!is_rigid(view, block)) dilatation_block<Shape, kOwnDomain>(view, block);
        });
      });
    }
    for_each_slab(view, thread, [&](int slab) {
      Ledger ledger;
      Energies energies;
      for_each_block(view, slab, [&](const Block& block) {
        if (is_rigid(view, block)) return;
        if (averaged) {
          averaged_stress_block<Shape, kOwnDomain>(view, input, block, ledger);
        } else {
          stress_block<Shape, kOwnDomain>(view, input, block, ledger);
        }
        if constexpr (!PointsView<Real>::relative)
          if (input.wants_energies) add_elastic_energy(view, block, energies);
      });
      reports[slab].ledger = ledger;
      reports[slab].energies = energies;
    });
    if (averaged) {
      for_each_slab(view, thread, [&](int slab) {
        for_each_block(view, slab, [&](const Block& block) {
          if (!is_rigid(view, block)) averaged_force_block<Shape, kOwnDomain>(view, block);
        });
      });
    }
  }

  /// What the nodes need to know of points for the next step.
  static void scatter_block(const View<Real>& view, int begin, int n) {
    if (view.grid.soil == nullptr) {
      Weights<Shape, Need::values> weights;
      evaluate<Shape, kOwnDomain>(view, begin, n, weights);
      scatter_momentum(view, begin, n, weights);
    } else {
      Weights<Shape, Need::gradients> weights;
      evaluate<Shape, kOwnDomain>(view, begin, n, weights);
      scatter_momentum(view, begin, n, weights);
      scatter_soil(view, begin, n, weights);
    }
  }

  static void move_block(const View<Real>& view, const StepInput& input, const Block& block,
                         Report& report) {
    const int begin = block.begin, n = block.end - block.begin;
    Weights<Shape, Need::values> weights;
    evaluate<Shape, kOwnDomain>(view, begin, n, weights);
    Change change;
    gather_change(view, n, weights, change);
    move_points(view, begin, n, input.alpha, change, report);
    if (report.lost >= 0) return;
    if (view.domain_update != DomainUpdate::none) resize_domains(view, begin, n, report);
    if (report.lost >= 0) return;
    scatter_block(view, begin, n);
    if (input.wants_speeds) add_speeds(view, block, report.speeds);
    if constexpr (!PointsView<Real>::relative)
      if (input.wants_energies)
        add_energy_of_motion(view, block, input.full_gravity_x, input.full_gravity_y,
                             report.energies);
  }
};

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
