// The background grid: a window of nodes that follows the mass, so that no point can leave it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "buffer.hpp"
#include "view.hpp"
#include "wall.hpp"

namespace gimpslope {

/// Cells from the anchor of the grid, which may be negative.
struct Cell {
  std::int32_t column, row;
};

class Grid {
 public:
  /// Grid lines run through (x, y); walls lie on grid lines.
  Grid(double cell, double x, double y, const std::array<Wall, 4>& walls);

  double cell() const { return cell_; }
  double x() const { return x_; }
  double y() const { return y_; }
  int rows() const { return rows_; }

  /// Refuses positions {x, y} that no window can hold.
  void check_reach(std::span<const double> position) const;

  /// Makes the window hold the nodes from `low` to `high`, both included, and clears it but for the
  /// last motion of its nodes, by which walls know what they hold.
  void fit(Cell low, Cell high);

  /// Makes room for body forces at the nodes, for sums over cells, for the volume of soil, or for
  /// the terms of XPIC, from the next `fit` on.
  void keep_body_forces() { keeps_body_forces_ = true; }
  void keep_cells() { keeps_cells_ = true; }
  void keep_soil() { keeps_soil_ = true; }
  void keep_terms() { keeps_terms_ = true; }

  /// Declares the nodes `columns` of the window's `row` active, beside those that are already.
  void activate(int row, NodeRange columns);

  void clear();
  GridView view();
  std::int64_t bytes() const;

 private:
  static void check_size(std::int64_t columns, std::int64_t rows);
  void keep(Buffer<double>& update, Cell low, Cell high) const;

  double cell_, x_, y_;
  std::array<Wall, 4> walls_;
  std::array<std::int32_t, 4> wall_node_;  // from the anchor
  Cell low_{0, 0};
  int columns_ = 0, rows_ = 0;
  std::vector<NodeRange> active_;
  bool keeps_body_forces_ = false, keeps_cells_ = false, keeps_soil_ = false, keeps_terms_ = false;
  Buffer<double> momentum_, velocity_, force_, update_, body_, cells_, soil_, terms_, spread_;
};

}  // namespace gimpslope
