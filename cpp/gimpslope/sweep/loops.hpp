// Loops that a team takes together.
#pragma once

#include <array>

#include "../team.hpp"
#include "../view.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Runs work(thread) on every thread of the team.
template <class Work>
void together(Team& team, Work work) {
  team.run([](void* context, int thread) { (*static_cast<Work*>(context))(thread); }, &work);
}

/// Runs work(slab) for all slabs: those of the thread's own share, so that their points stay in its
/// cache from sweep to sweep, then what others have left of theirs. Called by all threads of a
/// team.
template <class Work, class Real>
void take_slabs(const View<Real>& view, int thread, Work work) {
  const int threads = view.team->size();
  for (int k = 0; k < threads; ++k) {
    const int owner = (thread + k) % threads;
    const int begin = view.shares[owner], end = view.shares[owner + 1];
    for (int next; (next = begin + view.team->claim(owner)) < end;) work(view.shared[next]);
  }
  view.team->barrier();
}

/// The same where work reaches nodes, with rows(begin, end) for all rows of these before any point
/// does: an even slab reaches its own rows and those of the next one, and no other even one reaches
/// these. An odd slab waits for the even ones beside it, so that no two that run at the same time
/// reach the same node, and each node is reached in one order. No wait is for ever: a thread waits
/// only once its own even slabs, which come first in its share, are all taken, so that those nobody
/// has taken yet belong to a thread that does not wait.
template <class Rows, class Work, class Real>
void for_each_slab(const View<Real>& view, int thread, Rows rows, Work work) {
  const int last = view.slab_count - 1;
  take_slabs(view, thread, [&](int slab) {
    if (slab % 2 == 0) {
      const int beyond = slab < last ? slab + 1 : slab;
      rows(view.slabs[slab].first_row, view.slabs[beyond].end_row);
      work(slab);
      view.team->finish(slab);
    } else {
      view.team->await(slab - 1);
      if (slab < last) view.team->await(slab + 1);
      work(slab);
    }
  });
}

template <class Work, class Real>
void for_each_slab(const View<Real>& view, int thread, Work work) {
  for_each_slab(view, thread, [](int, int) {}, work);
}

/// Runs work(row) for all rows of nodes. Called by all threads of a team.
template <class Work, class Real>
void for_each_row(const View<Real>& view, int thread, Work work) {
  take_slabs(view, thread, [&](int slab) {
    for (int row = view.slabs[slab].first_row; row < view.slabs[slab].end_row; ++row) work(row);
  });
}

/// Runs work(block) for the blocks of a slab.
template <class Work, class Real>
void for_each_block(const View<Real>& view, int slab, Work work) {
  for (int b = view.slabs[slab].begin; b < view.slabs[slab].end; ++b) work(view.blocks[b]);
}

/// Blocks whose points fit into the last cache of most processors, 20 MB with their nodes.
constexpr int kBlocksInCache = 2048;

/// The same; beyond that many blocks these properties of the next one's points are asked for
/// meanwhile: they come from memory, from more places than the processor follows by itself.
template <class Properties, class Work, class Real>
void for_each_block(const View<Real>& view, int slab, const Properties& needed, Work work) {
  constexpr int line = kCacheLine / sizeof(Real), to_second_cache = 2;
  const bool far = view.slabs[view.slab_count - 1].end > kBlocksInCache;
  for (int b = view.slabs[slab].begin; b < view.slabs[slab].end; ++b) {
    if (far && b + 1 < view.slabs[slab].end)
      for (const Real* property : needed)
        for (int k = view.blocks[b + 1].begin; k < view.blocks[b + 1].end; k += line)
          __builtin_prefetch(property + k, 1, to_second_cache);
    work(view.blocks[b]);
  }
}

/// What the first sweep of a step and the second one read of every point.
template <class Real>
std::array<const Real*, 8> strained(const PointsView<Real>& p) {
  return {p.x, p.y, p.volume, p.stress_xx, p.stress_yy, p.stress_zz, p.stress_xy, p.plastic_strain};
}

template <class Real>
std::array<const Real*, 5> moved(const PointsView<Real>& p) {
  return {p.x, p.y, p.vx, p.vy, p.mass};
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
