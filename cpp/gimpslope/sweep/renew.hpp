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
  const auto set = [&]<class V>(int node, const Two<V>& v) {
    if (ledger != nullptr) {
      const Components<V> f = load<V>(g.force + 4 * node), moved = load<V>(g.update + 4 * node);
      for (int c = 0; c < 2; ++c)
        ledger->transfer += sum_of_lanes((f[2 * c] + f[2 * c + 1]) * (step.dt * v[c] - moved[c]));
    }
    show_velocity(g, node, v);
    clear<V>(g.momentum + 4 * node);
    clear<V>(g.force + 4 * node);
  };
  for_each_node(
      g, row, [&]<class V>(V, int node) { set(node, velocity_of<V>(g.momentum + 4 * node)); },
      [&](int node, int column) {
        const Two<double> raw = velocity_of<double>(g.momentum + 4 * node);
        set(node, within_walls(g, column, row, node, raw));
      });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
