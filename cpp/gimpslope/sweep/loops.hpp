// Loops that a team takes together.
#pragma once

#include "../team.hpp"
#include "../view.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Runs work(thread) on every thread of the team.
template <class Work>
void together(Team& team, Work work) {
  team.run([](void* context, int thread) { (*static_cast<Work*>(context))(thread); }, &work);
}

/// Runs work(slab) for every `stride`-th slab from `first` on: those of the thread's own share, so
/// that their points stay in its cache from sweep to sweep, then what others have left of theirs.
template <class Work, class Real>
void take_slabs(const View<Real>& view, int thread, int first, int stride, Work work) {
  const int threads = view.team->size();
  for (int k = 0; k < threads; ++k) {
    const int owner = (thread + k) % threads;
    const int begin = view.shares[owner], end = view.shares[owner + 1];
    const int skipped = ((first - begin) % stride + stride) % stride;
    for (int slab; (slab = begin + skipped + stride * view.team->claim(owner)) < end;) work(slab);
  }
  view.team->barrier();
}

/// Runs work(slab) for all slabs, even ones first and odd ones after, so that no two that run at
/// the same time reach the same node. Called by all threads of a team.
template <class Work, class Real>
void for_each_slab(const View<Real>& view, int thread, Work work) {
  for (int parity = 0; parity < 2; ++parity) take_slabs(view, thread, parity, 2, work);
}

/// Runs work(row) for all rows of nodes. Called by all threads of a team.
template <class Work, class Real>
void for_each_row(const View<Real>& view, int thread, Work work) {
  take_slabs(view, thread, 0, 1, [&](int slab) {
    for (int row = view.slabs[slab].first_row; row < view.slabs[slab].end_row; ++row) work(row);
  });
}

/// Runs work(block) for the blocks of a slab.
template <class Work, class Real>
void for_each_block(const View<Real>& view, int slab, Work work) {
  for (int b = view.slabs[slab].begin; b < view.slabs[slab].end; ++b) work(view.blocks[b]);
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
