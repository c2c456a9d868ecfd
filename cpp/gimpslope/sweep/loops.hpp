// Loops that a team takes together.
#pragma once

#include "../team.hpp"
#include "../view.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Runs work() on every thread of the team.
template <class Work>
void together(Team& team, Work work) {
  team.run([](void* context) { (*static_cast<Work*>(context))(); }, &work);
}

/// Runs work(slab) for all slabs, even ones first and odd ones after, so that no two that run at
/// the same time reach the same node. Called by all threads of a team.
template <class Work>
void for_each_slab(const View& view, Work work) {
  for (int parity = 0; parity < 2; ++parity) {
    for (int slab; (slab = 2 * view.team->claim() + parity) < view.slab_count;) work(slab);
    view.team->barrier();
  }
}

/// Runs work(block) for the blocks of a slab.
template <class Work>
void for_each_block(const View& view, int slab, Work work) {
  for (int b = view.slabs[slab].begin; b < view.slabs[slab].end; ++b) work(view.blocks[b]);
}

/// Runs work(row) for all rows of nodes, a few at a time. Called by all threads of a team.
template <class Work>
void for_each_row(const View& view, Work work) {
  constexpr int few = 8;
  for (int begin; (begin = few * view.team->claim()) < view.grid.rows;) {
    const int end = begin + few < view.grid.rows ? begin + few : view.grid.rows;
    for (int row = begin; row < end; ++row) work(row);
  }
  view.team->barrier();
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
