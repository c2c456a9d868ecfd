// The two passes over the active nodes of a USF step.
#pragma once

#include <cmath>

#include "../tensor.hpp"
#include "../view.hpp"
#include "../wall.hpp"

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

/// Velocity of the nodes of a row (paper eq. 20) within the walls; clears the forces.
inline void start_nodes(const GridView& g, int row) {
  const auto velocity = [&](int node, double* v) {
    const double* m = g.momentum + 4 * node;
    const double inverse = m[0] > 0.0 ? 1.0 / m[0] : 0.0;
    v[0] = inverse * m[2];
    v[1] = inverse * m[3];
  };
  const auto set = [&](int node, const double* v) {
    quad(g.velocity + 4 * node) = Quad(v[0], v[0], v[1], v[1]);
    quad(g.force + 4 * node).setZero();
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
        const double* moved = g.update + 4 * node;  // in the step before
        for_each_wall(g, column, row, v,
                      [&](Side side, double outward, double& normal, double& tangential) {
                        const int axis = side == bottom || side == top;
                        constrain(g.kind[side], outward, moved[axis] == 0.0, moved[1 - axis] == 0.0,
                                  normal, tangential);
                      });
        set(node, v);
      });
}

/// Momentum of the nodes of a row (paper eq. 13) with the walls' reactions, and what a point takes
/// from it: dt v and alpha v + (1 - alpha) times the change of v. Clears mass and momentum.
inline void finish_nodes(const GridView& g, int row, const StepInput& step) {
  const auto advance = [&](int node, double* before, double* v) {
    const double* m = g.momentum + 4 * node;
    const double* f = g.force + 4 * node;
    const double* shown = g.velocity + 4 * node;
    const double inverse = m[0] > 0.0 ? 1.0 / m[0] : 0.0;
    double fx = f[0] + f[1] + m[0] * step.gravity_x;
    double fy = f[2] + f[3] + m[0] * step.gravity_y;
    if (g.body != nullptr) {
      fx += g.body[4 * node];
      fy += g.body[4 * node + 1];
    }
    const auto sign = [](double x) {
      return (x > 0.0 ? 1.0 : 0.0) - (x < 0.0 ? 1.0 : 0.0);
    };
    fx -= step.local_damping * std::fabs(fx) * sign(shown[0]);
    fy -= step.local_damping * std::fabs(fy) * sign(shown[2]);
    before[0] = inverse * m[2];
    before[1] = inverse * m[3];
    v[0] = before[0] + step.dt * inverse * fx;
    v[1] = before[1] + step.dt * inverse * fy;
  };
  const auto set = [&](int node, const double* before, const double* v) {
    const double flip = 1.0 - step.alpha;
    quad(g.update + 4 * node) =
        Quad(step.dt * v[0], step.dt * v[1], v[0] - flip * before[0], v[1] - flip * before[1]);
    quad(g.momentum + 4 * node).setZero();
    if (g.body != nullptr) quad(g.body + 4 * node).setZero();
  };
  for_each_node(
      g, row,
      [&](int node) {
        double before[2], v[2];
        advance(node, before, v);
        set(node, before, v);
      },
      [&](int node, int column) {
        double before[2], v[2];
        advance(node, before, v);
        for_each_wall(g, column, row, v,
                      [&](Side side, double outward, double& normal, double& tangential) {
                        react(g.kind[side], g.friction[side], outward, normal, tangential);
                      });
        if (g.momentum[4 * node] == 0.0) v[0] = v[1] = kNoMotion;
        set(node, before, v);
      });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
