// The passes over the active nodes of a step: before their forces are known, and after.
#pragma once

#include <type_traits>

#include "../view.hpp"
#include "../wall.hpp"
#include "accounts.hpp"
#include "lanes.hpp"
#include "loops.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Calls visit(side, outward, normal, tangential) for each wall that node (column, row) lies on or
/// beyond, in the order left, right, bottom, top.
template <class Visit>
void for_each_wall(const GridView& g, int column, int row, Two<double>& v, Visit visit) {
  if (column <= g.wall[left]) visit(left, -1.0, v[0], v[1]);
  if (column >= g.wall[right]) visit(right, 1.0, v[0], v[1]);
  if (row <= g.wall[bottom]) visit(bottom, -1.0, v[1], v[0]);
  if (row >= g.wall[top]) visit(top, 1.0, v[1], v[0]);
}

/// Calls inner(V, node) for the active nodes of a row that no wall touches, for four at a time as
/// long as there are four, and wall(node, column) for the others.
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
  int i = from;
  for (; i + 4 <= to; i += 4) inner(Quad{}, start + i);
  for (; i < to; ++i) inner(double{}, start + i);
  for (i = to; i < range.end; ++i) wall(start + i, i);
}

/// Mean velocity of the points at nodes (paper eq. 20), of {m, m, m vx, m vy}.
template <class V>
[[gnu::always_inline]] inline Two<V> velocity_of(const double* momentum) {
  const Components<V> m = load<V>(momentum);
  const V inverse = inverse_of(m[0]);
  return {{inverse * m[2], inverse * m[3]}};
}

/// The velocity that walls leave a node, by its last motion.
inline Two<double> within_walls(const GridView& g, int column, int row, int node, Two<double> v) {
  const double* moved = g.update + 4 * node;
  for_each_wall(g, column, row, v,
                [&](Side side, double outward, double& normal, double& tangential) {
                  const int axis = side == bottom || side == top;
                  constrain(g.kind[side], outward, moved[axis] == 0.0, moved[1 - axis] == 0.0,
                            normal, tangential);
                });
  return v;
}

template <class V>
[[gnu::always_inline]] inline void show_velocity(const GridView& g, int node, const Two<V>& v) {
  store<V>({{v[0], v[0], v[1], v[1]}}, g.velocity + 4 * node);
}

/// Velocity of the nodes of a row within the walls; begins the row's ledger where one is kept. Of a
/// copy of the grid's view the compiler knows that no store to a node changes it. With kBare
/// strains are not averaged over cells.
template <bool kBare>
void start_nodes(const GridView& grid, int row, Ledger* ledger) {
  GridView g = grid;
  if constexpr (kBare) g.cells = nullptr;
  if (ledger != nullptr) *ledger = {};
  const auto set = [&]<class V>(int node, const Two<V>& v) {
    show_velocity(g, node, v);
    if (g.cells != nullptr) clear<V>(g.cells + 4 * node);
  };
  for_each_node(
      g, row, [&]<class V>(V, int node) { set(node, velocity_of<V>(g.momentum + 4 * node)); },
      [&](int node, int column) {
        const Two<double> raw = velocity_of<double>(g.momentum + 4 * node);
        const Two<double> v = within_walls(g, column, row, node, raw);
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

/// The forces on nodes, and their velocities but for the one after the step.
template <class V>
[[gnu::always_inline]] inline NodeStep<V> forces_on(const GridView& g, int node,
                                                    const StepInput& step) {
  const Components<V> m = load<V>(g.momentum + 4 * node), f = load<V>(g.force + 4 * node);
  const Components<V> shown = load<V>(g.velocity + 4 * node);
  const double gravity[2] = {step.gravity_x, step.gravity_y};
  NodeStep<V> s;
  s.mass = m[0];
  s.inverse_mass = inverse_of(m[0]);
  for (int c = 0; c < 2; ++c) {
    s.raw[c] = s.inverse_mass * m[2 + c];
    s.before[c] = shown[2 * c];
    s.internal[c] = f[2 * c] + f[2 * c + 1];
    s.acting[c] = s.internal[c] + s.mass * gravity[c];
    s.body[c] = s.damping[c] = V{};
  }
  if (g.body != nullptr) {
    const Components<V> body = load<V>(g.body + 4 * node);
    for (int c = 0; c < 2; ++c) s.body[c] = body[c];
  }
  if (step.local_damping != 0.0)
    for (int c = 0; c < 2; ++c)
      s.damping[c] = -step.local_damping * absolute(s.acting[c] + s.body[c]) * sign_of(s.before[c]);
  return s;
}

/// What is left of a step at the nodes for a scheme that strains afterwards: their new velocity is
/// shown, or their forces are kept.
enum class Afterwards { none, shown, forces_kept };

/// Momentum of the nodes of a row (paper eq. 13) with the walls' reactions, and what a point takes
/// from it: dt v and alpha v + (1 - alpha) times the change of v. Clears mass, momentum and forces,
/// and adds to the row's ledger where one is kept. With kBare there are no body forces, no soil
/// along rigid bodies and no local damping.
template <bool kBare, bool kLedger, Afterwards kAfterwards>
void finish_nodes(const GridView& grid, int row, const StepInput& input, Ledger* ledger) {
  GridView g = grid;  // see start_nodes
  StepInput step = input;
  if constexpr (kBare) {
    g.body = g.soil = nullptr;
    step.local_damping = 0.0;
  }
  const auto stepped = [&]<class V>(V, int node) {
    NodeStep<V> s = forces_on<V>(g, node, step);
    for (int c = 0; c < 2; ++c) s.after[c] = s.raw[c] + step.dt * s.inverse_mass * s.total(c);
    return s;
  };
  NodeWork<Quad> of_fours;
  NodeWork<double> of_others;
  const auto works = [&]<class V>(V) -> NodeWork<V>& {
    if constexpr (kLanes<V> == 1) {
      return of_others;
    } else {
      return of_fours;
    }
  };
  const auto set = [&]<class V>(int node, const NodeStep<V>& s) {
    V moved[2], gained[2];
    for (int c = 0; c < 2; ++c) {
      moved[c] = step.dt * s.after[c];
      gained[c] = s.after[c] - (1.0 - step.alpha) * s.raw[c];
    }
    store<V>({{moved[0], moved[1], gained[0], gained[1]}}, g.update + 4 * node);
    clear<V>(g.momentum + 4 * node);
    if constexpr (kAfterwards != Afterwards::forces_kept) clear<V>(g.force + 4 * node);
    if constexpr (kAfterwards == Afterwards::shown) show_velocity(g, node, s.after);
    if (g.body != nullptr) clear<V>(g.body + 4 * node);
    if (g.soil != nullptr) clear<V>(g.soil + 4 * node);
  };
  for_each_node(
      g, row,
      [&]<class V>(V lanes, int node) {
        const NodeStep<V> s = stepped(lanes, node);
        if constexpr (kLedger) add_nodes(s, step, works(lanes), kAfterwards != Afterwards::none);
        set(node, s);
      },
      [&](int node, int column) {
        NodeStep<double> s = stepped(double{}, node);
        for_each_wall(g, column, row, s.after,
                      [&](Side side, double outward, double& normal, double& tangential) {
                        react(g.kind[side], g.friction[side], outward, normal, tangential);
                      });
        if (s.mass == 0.0) s.after[0] = s.after[1] = kNoMotion;
        if constexpr (kLedger) {
          add_nodes(s, step, of_others, kAfterwards != Afterwards::none);
          for (int c = 0; c < 2; ++c)
            add_wall(g, column, row, c, s.before[c] == 0.0 || s.after[c] == 0.0,
                     taken_by_walls(s, step.dt, c), *ledger);
        }
        set(node, s);
      });
  if constexpr (kLedger) {
    add(of_fours, *ledger);
    add(of_others, *ledger);
  }
}

/// A row of nodes at the start of a step, with its ledger.
template <class Real>
void start_row(const View<Real>& view, int row) {
  Ledger* ledger = view.ledger != nullptr ? view.ledger + row : nullptr;
  if (view.grid.cells == nullptr) {
    start_nodes<true>(view.grid, row, ledger);
  } else {
    start_nodes<false>(view.grid, row, ledger);
  }
}

template <class Real>
void start_rows(const View<Real>& view, int thread) {
  for_each_row(view, thread, [&](int row) { start_row(view, row); });
}

template <Afterwards kAfterwards, class Real>
void finish_row(const View<Real>& view, const StepInput& input, int row) {
  const auto finish = [&]<bool kBare>(std::bool_constant<kBare>) {
    if (view.ledger != nullptr) {
      finish_nodes<kBare, true, kAfterwards>(view.grid, row, input, view.ledger + row);
    } else {
      finish_nodes<kBare, false, kAfterwards>(view.grid, row, input, nullptr);
    }
  };
  if (view.grid.body == nullptr && view.grid.soil == nullptr && input.local_damping == 0.0) {
    finish(std::true_type{});
  } else {
    finish(std::false_type{});
  }
}

template <Afterwards kAfterwards, class Real>
void finish_rows(const View<Real>& view, const StepInput& input, int thread) {
  for_each_row(view, thread, [&](int row) { finish_row<kAfterwards>(view, input, row); });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
