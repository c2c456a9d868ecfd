// Compiled once for each instruction set, as kernel.cpp is, so that both have the same processor.
#include <cmath>

#include "plain.hpp"
#include "rotation.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {
namespace {

/// GIMP along one axis (paper eq. 15-16): the hat averaged over [x - l, x + l], l <= h / 2.
void weights(double distance, double l, double h, double& value, double& slope) {
  const double d = std::fabs(distance);
  const double side = distance < 0.0 ? -1.0 : 1.0;
  if (d < l) {
    value = 1.0 - (d * d + l * l) / (2.0 * h * l);
    slope = -distance / (h * l);
  } else if (d < h - l) {
    value = 1.0 - d / h;
    slope = -side / h;
  } else if (d < h + l) {
    value = (h + l - d) * (h + l - d) / (4.0 * h * l);
    slope = -side * (h + l - d) / (2.0 * h * l);
  } else {
    value = slope = 0.0;
  }
}

/// False for a point whose nodes are not all on the grid.
bool find_nodes(const PlainView& g, PlainPoint& p) {
  const double l = g.half_length, h = g.cell;
  p.column = static_cast<int>(std::floor((p.x - l - g.left) / h));
  p.row = static_cast<int>(std::floor((p.y - l - g.bottom) / h));
  if (p.column < 0 || p.row < 0 || p.column + 2 >= g.columns || p.row + 2 >= g.rows) return false;
  for (int i = 0; i < 3; ++i) {
    weights(p.x - g.left - (p.column + i) * h, l, h, p.wx[i], p.dx[i]);
    weights(p.y - g.bottom - (p.row + i) * h, l, h, p.wy[i], p.dy[i]);
  }
  return true;
}

PlainNode& node_of(const PlainView& g, const PlainPoint& p, int i, int j) {
  return g.nodes[(p.row + j) * g.columns + p.column + i];
}

/// Calls visit(side, outward, normal, tangential) for the walls that a node is on or beyond.
template <class Visit>
void for_each_wall(const PlainView& g, int column, int row, double& vx, double& vy, Visit visit) {
  if (column <= g.wall[left]) visit(left, -1.0, vx, vy);
  if (column >= g.wall[right]) visit(right, 1.0, vx, vy);
  if (row <= g.wall[bottom]) visit(bottom, -1.0, vy, vx);
  if (row >= g.wall[top]) visit(top, 1.0, vy, vx);
}

void deform(const PlainView& g, PlainPoint& p, double dt) {
  double xx = 0.0, xy = 0.0, yx = 0.0, yy = 0.0;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const PlainNode& node = node_of(g, p, i, j);
      const double sx = p.dx[i] * p.wy[j], sy = p.wx[i] * p.dy[j];
      xx += sx * node.vx;
      xy += sy * node.vx;
      yx += sx * node.vy;
      yy += sy * node.vy;
    }
  }
  const Strain strain{dt * xx, dt * yy, 0.5 * dt * (xy + yx)};
  const double grown = strain.xx + strain.yy;
  p.volume *= g.volume_update == VolumeUpdate::linear ? 1.0 + grown : std::exp(grown);
  const double turn = dt * (yx - xy);
  Mohr circle = turned(circle_of({p.sxx, p.syy, p.szz, p.sxy}), std::cos(turn), std::sin(turn));
  with_constants(g.laws[p.material],
                 [&](const auto& law) { update(law, circle, strain, p.plastic_strain); });
  const Stress after = stress_of(circle);
  p.sxx = after.xx;
  p.syy = after.yy;
  p.szz = after.zz;
  p.sxy = after.xy;
}

}  // namespace

/// One step; false if a point has left the grid.
bool plain_step(const PlainView& g, double dt, double alpha) {
  for (int k = 0; k < g.columns * g.rows; ++k) {
    PlainNode& node = g.nodes[k];
    node.mass = node.px = node.py = node.fx = node.fy = 0.0;
  }
  for (int k = 0; k < g.size; ++k) {
    PlainPoint& p = g.points[k];
    if (!find_nodes(g, p)) return false;
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        PlainNode& node = node_of(g, p, i, j);
        const double mass = p.mass * p.wx[i] * p.wy[j];
        node.mass += mass;
        node.px += mass * p.vx;
        node.py += mass * p.vy;
      }
    }
  }
  for (int row = 0; row < g.rows; ++row) {
    for (int column = 0; column < g.columns; ++column) {
      PlainNode& node = g.nodes[row * g.columns + column];
      if (node.mass == 0.0) continue;
      node.vx = node.px / node.mass;
      node.vy = node.py / node.mass;
      for_each_wall(g, column, row, node.vx, node.vy,
                    [&](Side side, double outward, double& normal, double& tangential) {
                      const bool x = side == left || side == right;
                      const bool held = (x ? node.ux : node.uy) == 0.0;
                      const bool stuck = (x ? node.uy : node.ux) == 0.0;
                      constrain(g.kind[side], outward, held, stuck, normal, tangential);
                    });
    }
  }
  for (int k = 0; k < g.size; ++k) {
    PlainPoint& p = g.points[k];
    deform(g, p, dt);
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        PlainNode& node = node_of(g, p, i, j);
        const double sx = p.volume * p.dx[i] * p.wy[j], sy = p.volume * p.wx[i] * p.dy[j];
        node.fx -= p.sxx * sx + p.sxy * sy;
        node.fy -= p.sxy * sx + p.syy * sy;
      }
    }
  }
  for (int row = 0; row < g.rows; ++row) {
    for (int column = 0; column < g.columns; ++column) {
      PlainNode& node = g.nodes[row * g.columns + column];
      node.ux = node.uy = kNoMotion;
      if (node.mass == 0.0) continue;
      node.ux = (node.px + dt * (node.fx + node.mass * g.gravity_x)) / node.mass;
      node.uy = (node.py + dt * (node.fy + node.mass * g.gravity_y)) / node.mass;
      for_each_wall(g, column, row, node.ux, node.uy,
                    [&](Side side, double outward, double& normal, double& tangential) {
                      react(g.kind[side], g.friction[side], outward, normal, tangential);
                    });
    }
  }
  for (int k = 0; k < g.size; ++k) {
    PlainPoint& p = g.points[k];
    double ux = 0.0, uy = 0.0, change_x = 0.0, change_y = 0.0;
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        const PlainNode& node = node_of(g, p, i, j);
        if (node.mass == 0.0) continue;
        const double s = p.wx[i] * p.wy[j];
        ux += s * node.ux;
        uy += s * node.uy;
        change_x += s * (node.ux - node.px / node.mass);
        change_y += s * (node.uy - node.py / node.mass);
      }
    }
    p.vx = alpha * ux + (1.0 - alpha) * (p.vx + change_x);
    p.vy = alpha * uy + (1.0 - alpha) * (p.vy + change_y);
    p.x += dt * ux;
    p.y += dt * uy;
  }
  return true;
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
