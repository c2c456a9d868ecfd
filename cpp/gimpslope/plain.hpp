// The same step as a plain loop over points and nodes: what the kernel's speed is measured against,
// and a second witness of its results. uGIMP with one half-length, update stress first; gravity at
// once, no damping. Nothing is sorted, blocked or threaded here.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "checks.hpp"
#include "instruction_set.hpp"
#include "material/material.hpp"
#include "method.hpp"
#include "wall.hpp"

namespace gimpslope {

struct PlainPoint {
  double x, y, vx, vy;
  double mass, volume;
  double sxx, syy, szz, sxy, plastic_strain;
  int material;
  int column, row;                    // of the first of its 3 x 3 nodes
  double wx[3], wy[3], dx[3], dy[3];  // weights and their derivatives
};

struct PlainNode {
  double mass, px, py, fx, fy;
  double vx, vy;  // within the walls, for the strains
  double ux, uy;  // after the step
};

/// What the step sees: plain pointers, for it is compiled once for each instruction set.
struct PlainView {
  PlainPoint* points;
  int size;
  PlainNode* nodes;
  int columns, rows;
  double left, bottom, cell, half_length;
  const Law* laws;
  WallKind kind[4];
  double friction[4];
  int wall[4];  // the last (left, bottom) or first (right, top) node on or beyond a wall
  VolumeUpdate volume_update;
  double gravity_x, gravity_y;
};

class Plain {
 public:
  /// The grid reaches `margin` cells beyond the points as they are given.
  Plain(const InitialPoints& points, const std::vector<Material>& materials, double cell,
        std::array<double, 2> origin, const std::array<Wall, 4>& walls, const Method& method,
        std::array<double, 2> gravity, int margin, InstructionSet instruction_set);

  /// Takes `steps` steps; std::runtime_error when a point leaves the grid.
  void advance(std::int64_t steps);

  /// A field by its name in Solver, in the order the points were given.
  std::vector<double> values(const std::string& name) const;
  double time() const { return time_; }
  int size() const { return static_cast<int>(points_.size()); }

 private:
  PlainView view();
  double time_step() const;

  Method method_;
  std::vector<Law> laws_;
  std::vector<PlainPoint> points_;
  std::vector<PlainNode> nodes_;
  PlainView view_{};
  double time_ = 0.0;
  bool (*step_)(const PlainView& view, double dt, double alpha);
};

}  // namespace gimpslope
