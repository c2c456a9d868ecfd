// The two passes over the active nodes of a USF step.
#pragma once

#include <cmath>

#include "../tensor.hpp"
#include "../view.hpp"
#include "../wall.hpp"
#include "accounts.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Calls visit(side, outward, normal, tangential) for each wall that node (column, row) lies on or
/// beyond, in the order left, right, bottom, top.
template <class Visit>
void for_each_wall(const GridView& g, int column, int row, double* v, Visit visit) {
  if (column <= g.wall[left]) visit(left, -1.0, v[0], v[1]);
  if (column >= g.wall[right]) visit(right, 1.0, v[0], v[1]);
  if (row <= g.wall[bottom]) visit(bottom, -1.0, v[1], v[0]);
  if (row >= g.wall[top]) visit(top, 1.0, v[1], v[0]);
}

/// Calls inner(node) for the active nodes of a row that no wall touches, wall(node, column) for the
/// others.
template <class Inner, class AtWall>
void for_each_node(const GridView& g, int row, Inner inner, AtWall wall) {
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

/// Velocity of the nodes of a row (paper eq. 20) within the walls; clears the forces, and begins
/// the row's ledger where one is kept.
inline void start_nodes(const GridView& g, int row, Ledger* ledger) {
  if (ledger != nullptr) *ledger = {};
  const auto velocity = [&](int node, double* v) {
    const double* m = g.momentum + 4 * node;
    const double inverse = m[0] > 0.0 ? 1.0 / m[0] : 0.0;
    v[0] = inverse * m[2];
    v[1] = inverse * m[3];
  };
  const auto set = [&](int node, const double* v) {
    quad(g.velocity + 4 * node) = Quad(v[0], v[0], v[1], v[1]);
    quad(g.force + 4 * node).setZero();
    if (g.cells != nullptr) quad(g.cells + 4 * node).setZero();
  };
  for_each_node(
      g, row,
      [&](int node) {
        double v[2];
        velocity(node, v);
        set(node, v);
      },
      [&](int node, int column) {
        double v[2];
        velocity(node, v);
        const double raw[2] = {v[0], v[1]};
        const double* moved = g.update + 4 * node;  // in the step before
        for_each_wall(g, column, row, v,
                      [&](Side side, double outward, double& normal, double& tangential) {
                        const int axis = side == bottom || side == top;
                        constrain(g.kind[side], outward, moved[axis] == 0.0, moved[1 - axis] == 0.0,
                                  normal, tangential);
                      });
        if (ledger != nullptr) {
          const double half_mass = 0.5 * g.momentum[4 * node];
          for (int c = 0; c < 2; ++c)
            add_wall(g, column, row, c, v[c] == 0.0, half_mass * (raw[c] - v[c]) * (raw[c] + v[c]),
                     *ledger);
        }
        set(node, v);
      });
}

/// The forces on a node, and its velocities but for the one after the step.
inline NodeStep forces_on(const GridView& g, int node, const StepInput& step) {
  const double* m = g.momentum + 4 * node;
  const double* f = g.force + 4 * node;
  const double* shown = g.velocity + 4 * node;
  const double gravity[2] = {step.gravity_x, step.gravity_y};
  const double full_gravity[2] = {step.full_gravity_x, step.full_gravity_y};
  const double inverse = m[0] > 0.0 ? 1.0 / m[0] : 0.0;
  NodeStep s;
  s.mass = m[0];
  s.inverse_mass = inverse;
  for (int c = 0; c < 2; ++c) {
    s.raw[c] = inverse * m[2 + c];
    s.before[c] = shown[2 * c];
    s.internal[c] = f[2 * c] + f[2 * c + 1];
    s.weight[c] = m[0] * gravity[c];
    s.full_weight[c] = m[0] * full_gravity[c];
    s.body[c] = g.body != nullptr ? g.body[4 * node + c] : 0.0;
    const double unbalanced = s.internal[c] + s.weight[c] + s.body[c];
    const double sign = (s.before[c] > 0.0 ? 1.0 : 0.0) - (s.before[c] < 0.0 ? 1.0 : 0.0);
    s.damping[c] = -step.local_damping * std::fabs(unbalanced) * sign;
  }
  return s;
}

/// Momentum of the nodes of a row (paper eq. 13) with the walls' reactions, and what a point takes
/// from it: dt v and alpha v + (1 - alpha) times the change of v. Clears mass and momentum, and
/// adds to the row's ledger where one is kept.
template <bool kLedger>
void finish_nodes(const GridView& g, int row, const StepInput& step, Ledger* ledger) {
  const auto advance = [&](NodeStep& s) {
    for (int c = 0; c < 2; ++c) s.after[c] = s.raw[c] + step.dt * s.inverse_mass * s.total(c);
  };
  const auto set = [&](int node, const NodeStep& s) {
    const double flip = 1.0 - step.alpha;
    quad(g.update + 4 * node) = Quad(step.dt * s.after[0], step.dt * s.after[1],
                                     s.after[0] - flip * s.raw[0], s.after[1] - flip * s.raw[1]);
    quad(g.momentum + 4 * node).setZero();
    if (g.body != nullptr) quad(g.body + 4 * node).setZero();
  };
  for_each_node(
      g, row,
      [&](int node) {
        NodeStep s = forces_on(g, node, step);
        advance(s);
        if constexpr (kLedger) add_node(s, step.dt, *ledger);
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
          add_node(s, step.dt, *ledger);
          for (int c = 0; c < 2; ++c)
            add_wall(g, column, row, c, s.before[c] == 0.0 || s.after[c] == 0.0,
                     taken_by_walls(s, step.dt, c), *ledger);
        }
        set(node, s);
      });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
