// The passes over the active nodes of a step: before their forces are known, and after.
#pragma once

#include <cmath>

#include "../tensor.hpp"
#include "../view.hpp"
#include "../wall.hpp"
#include "accounts.hpp"
#include "loops.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Calls visit(side, outward, normal, tangential) for each wall that node (column, row) lies on or
/// beyond, in the order left, right, bottom, top.
template <class Visit>
void for_each_wall(const GridView& g, int column, int row, Pair& v, Visit visit) {
  if (column <= g.wall[left]) visit(left, -1.0, v[0], v[1]);
  if (column >= g.wall[right]) visit(right, 1.0, v[0], v[1]);
  if (row <= g.wall[bottom]) visit(bottom, -1.0, v[1], v[0]);
  if (row >= g.wall[top]) visit(top, 1.0, v[1], v[0]);
}

/// Calls inner(node) for the active nodes of a row that no wall touches, wall(node, column) for the
/// others.
template <class Inner, class AtWall>
[[gnu::always_inline]] inline void for_each_node(const GridView& g, int row, Inner inner,
                                                 AtWall wall) {
  const NodeRange range = g.active[row];
  const bool whole = row <= g.wall[bottom] || row >= g.wall[top];
  const int after_left = g.wall[left] + 1;
  int from = whole || after_left > range.end ? range.end : after_left;
  if (from < range.begin) from = range.begin;
  int to = whole || g.wall[right] > range.end ? range.end : g.wall[right];
  if (to < from) to = from;
  const int start = row * g.stride;
  for (int i = range.begin; i < from; ++i) wall(start + i, i);
  for (int i = from; i < to; ++i) inner(start + i);
  for (int i = to; i < range.end; ++i) wall(start + i, i);
}

/// Mean velocity of the points at a node (paper eq. 20), of {m, m, m vx, m vy}.
inline Pair velocity_of(const double* momentum) {
  const double inverse = momentum[0] > 0.0 ? 1.0 / momentum[0] : 0.0;
  return inverse * pair(momentum + 2);
}

/// The velocity that walls leave a node, by its last motion.
inline Pair within_walls(const GridView& g, int column, int row, int node, Pair v) {
  const double* moved = g.update + 4 * node;
  for_each_wall(g, column, row, v,
                [&](Side side, double outward, double& normal, double& tangential) {
                  const int axis = side == bottom || side == top;
                  constrain(g.kind[side], outward, moved[axis] == 0.0, moved[1 - axis] == 0.0,
                            normal, tangential);
                });
  return v;
}

inline void show_velocity(const GridView& g, int node, const Pair& v) {
  quad(g.velocity + 4 * node) = Quad{v[0], v[0], v[1], v[1]};
}

/// Velocity of the nodes of a row within the walls; begins the row's ledger where one is kept. Of a
/// copy of the grid's view the compiler knows that no store to a node changes it.
template <bool kPlain>
void start_nodes(const GridView& grid, int row, Ledger* ledger) {
  GridView g = grid;
  if constexpr (kPlain) g.cells = nullptr;
  if (ledger != nullptr) *ledger = {};
  const auto set = [&](int node, const Pair& v) {
    show_velocity(g, node, v);
    if (g.cells != nullptr) quad(g.cells + 4 * node) = Quad{};
  };
  for_each_node(
      g, row, [&](int node) { set(node, velocity_of(g.momentum + 4 * node)); },
      [&](int node, int column) {
        const Pair raw = velocity_of(g.momentum + 4 * node);
        const Pair v = within_walls(g, column, row, node, raw);
        if (ledger != nullptr) {
          const double half_mass = 0.5 * g.momentum[4 * node];
          for (int c = 0; c < 2; ++c) {
            const double taken = half_mass * (raw[c] - v[c]) * (raw[c] + v[c]);
            if (g.terms != nullptr) {
              ledger->transfer += taken;
            } else {
              add_wall(g, column, row, c, v[c] == 0.0, taken, *ledger);
            }
          }
        }
        set(node, v);
      });
}

/// The forces on a node, and its velocities but for the one after the step.
inline NodeStep forces_on(const GridView& g, int node, const StepInput& step) {
  const double* m = g.momentum + 4 * node;
  const double* f = g.force + 4 * node;
  const double* shown = g.velocity + 4 * node;
  NodeStep s;
  s.mass = m[0];
  s.inverse_mass = m[0] > 0.0 ? 1.0 / m[0] : 0.0;
  s.raw = s.inverse_mass * pair(m + 2);
  s.before = Pair(shown[0], shown[2]);
  s.internal = Pair(f[0] + f[1], f[2] + f[3]);
  const Pair gravity(step.gravity_x, step.gravity_y);
  s.acting = s.internal + m[0] * gravity;
  s.weight = another(m[0]) * gravity;  // else the sum rounds by whether the weight is needed too
  s.full_weight = m[0] * Pair(step.full_gravity_x, step.full_gravity_y);
  s.body = Pair::Zero();
  if (g.body != nullptr) s.body = pair(g.body + 4 * node);
  s.damping = Pair::Zero();
  if (step.local_damping != 0.0)
    s.damping = -step.local_damping * (s.acting + s.body).abs() * s.before.sign();
  return s;
}

/// What is left of a step at the nodes for a scheme that strains afterwards: their new velocity is
/// shown, or their forces are kept.
enum class Afterwards { none, shown, forces_kept };

/// Momentum of the nodes of a row (paper eq. 13) with the walls' reactions, and what a point takes
/// from it: dt v and alpha v + (1 - alpha) times the change of v. Clears mass, momentum and forces,
/// and adds to the row's ledger where one is kept.
template <bool kPlain, bool kLedger, Afterwards kAfterwards>
void finish_nodes(const GridView& grid, int row, const StepInput& input, Ledger* ledger) {
  GridView g = grid;  // see start_nodes
  StepInput step = input;
  if constexpr (kPlain) {
    g.body = g.soil = nullptr;
    step.local_damping = 0.0;
  }
  const auto advance = [&](NodeStep& s) {
    s.after = s.raw + step.dt * s.inverse_mass * s.total();
  };
  const auto set = [&](int node, const NodeStep& s) {
    const Pair moved = step.dt * s.after, gained = s.after - (1.0 - step.alpha) * s.raw;
    quad(g.update + 4 * node) = Quad{moved[0], moved[1], gained[0], gained[1]};
    quad(g.momentum + 4 * node) = Quad{};
    if constexpr (kAfterwards != Afterwards::forces_kept) quad(g.force + 4 * node) = Quad{};
    if constexpr (kAfterwards == Afterwards::shown) show_velocity(g, node, s.after);
    if (g.body != nullptr) quad(g.body + 4 * node) = Quad{};
    if (g.soil != nullptr) quad(g.soil + 4 * node) = Quad{};
  };
  for_each_node(
      g, row,
      [&](int node) {
        NodeStep s = forces_on(g, node, step);
        advance(s);
        if constexpr (kLedger) add_node(s, step.dt, *ledger, kAfterwards != Afterwards::none);
        set(node, s);
      },
      [&](int node, int column) {
        NodeStep s = forces_on(g, node, step);
        advance(s);
        for_each_wall(g, column, row, s.after,
                      [&](Side side, double outward, double& normal, double& tangential) {
                        react(g.kind[side], g.friction[side], outward, normal, tangential);
                      });
        if (s.mass == 0.0) s.after[0] = s.after[1] = kNoMotion;
        if constexpr (kLedger) {
          add_node(s, step.dt, *ledger, kAfterwards != Afterwards::none);
          for (int c = 0; c < 2; ++c)
            add_wall(g, column, row, c, s.before[c] == 0.0 || s.after[c] == 0.0,
                     taken_by_walls(s, step.dt, c), *ledger);
        }
        set(node, s);
      });
}

/// A row of nodes at the start of a step, with its ledger.
template <class Real>
void start_row(const View<Real>& view, int row) {
  if (view.ledger == nullptr && view.grid.cells == nullptr) {
    start_nodes<true>(view.grid, row, nullptr);
  } else {
    start_nodes<false>(view.grid, row, view.ledger != nullptr ? view.ledger + row : nullptr);
  }
}

template <class Real>
void start_rows(const View<Real>& view, int thread) {
  for_each_row(view, thread, [&](int row) { start_row(view, row); });
}

template <Afterwards kAfterwards, class Real>
void finish_row(const View<Real>& view, const StepInput& input, int row) {
  if (view.ledger != nullptr) {
    finish_nodes<false, true, kAfterwards>(view.grid, row, input, view.ledger + row);
  } else if (view.grid.body != nullptr || view.grid.soil != nullptr || input.local_damping != 0.0) {
    finish_nodes<false, false, kAfterwards>(view.grid, row, input, nullptr);
  } else {
    finish_nodes<true, false, kAfterwards>(view.grid, row, input, nullptr);
  }
}

template <Afterwards kAfterwards, class Real>
void finish_rows(const View<Real>& view, const StepInput& input, int thread) {
  for_each_row(view, thread, [&](int row) { finish_row<kAfterwards>(view, input, row); });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
