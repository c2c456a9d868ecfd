// The nodes of a MUSL step a second time, with the momentum that the points' new velocities bring
// to them (Sulsky, Zhou and Schreyer 1995).
#pragma once

#include "nodes.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Velocity of the nodes of a row, by which the points are strained. Clears mass, momentum and
/// forces. What the forces do at this velocity and not at the one after the step is lost on the way
/// through the points: it goes to `transfer` in the row's ledger where one is kept.
inline void renew_nodes(const GridView& g, int row, const StepInput& step, Ledger* ledger) {
  const auto set = [&](int node, const Pair& v) {
    if (ledger != nullptr) {
      const double* f = g.force + 4 * node;
      const Pair later = step.dt * v - pair(g.update + 4 * node);
      ledger->transfer += (f[0] + f[1]) * later[0] + (f[2] + f[3]) * later[1];
    }
    show_velocity(g, node, v);
    quad(g.momentum + 4 * node) = Quad{};
    quad(g.force + 4 * node) = Quad{};
  };
  for_each_node(
      g, row, [&](int node) { set(node, velocity_of(g.momentum + 4 * node)); },
      [&](int node, int column) {
        set(node, within_walls(g, column, row, node, velocity_of(g.momentum + 4 * node)));
      });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
