#include "grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "error.hpp"

namespace gimpslope {
namespace {

constexpr const char* kSideNames[] = {"left wall", "right wall", "bottom wall", "top wall"};

}  // namespace

Grid::Grid(double cell, double x, double y, const std::array<Wall, 4>& walls)
    : cell_(cell), x_(x), y_(y), walls_(walls) {
  require(std::isfinite(cell) && cell > 0.0, "cell", cell, "positive and finite, in m");
  for (const double coordinate : {x, y})
    require(std::isfinite(coordinate), "origin", coordinate, "finite, in m");
  for (const Side side : {left, right, bottom, top}) {
    const Wall& wall = walls[side];
    const bool low = side == left || side == bottom;
    if (wall.kind == WallKind::free) {
      wall_node_[side] = low ? std::numeric_limits<std::int32_t>::min() / 2
                             : std::numeric_limits<std::int32_t>::max() / 2;
      continue;
    }
    require(wall.friction >= 0.0 && std::isfinite(wall.friction), "friction", wall.friction,
            "zero or positive and finite at a wall");
    const double line = (wall.position - (side == left || side == right ? x : y)) / cell;
    require(std::abs(line) < 1e9 && std::abs(line - std::round(line)) < 1e-6, kSideNames[side],
            wall.position, "on a grid line, a whole number of cells from the origin, in m");
    wall_node_[side] = static_cast<std::int32_t>(std::lround(line));
  }
  for (const Side low : {left, bottom}) {
    const Side high = low == left ? right : top;
    require(wall_node_[low] < wall_node_[high], kSideNames[high], walls[high].position,
            "beyond the opposite wall");
  }
}

void Grid::check_size(std::int64_t columns, std::int64_t rows) {
  constexpr std::int64_t most = std::int64_t{1} << 25;  // nodes; 4 GiB
  require(columns <= most && rows <= most && columns * rows <= most, "position",
          std::to_string(columns) + " x " + std::to_string(rows),
          "spread over at most 2^25 cells; with this cell size the points cover too wide a box");
}

void Grid::check_reach(std::span<const double> position) const {
  double low[2] = {position[0], position[1]}, high[2] = {position[0], position[1]};
  for (std::size_t k = 0; k < position.size(); ++k) {
    low[k % 2] = std::min(low[k % 2], position[k]);
    high[k % 2] = std::max(high[k % 2], position[k]);
  }
  const double origin[2] = {x_, y_};
  constexpr double farthest = 1e9;
  for (int axis = 0; axis < 2; ++axis) {
    for (const double end : {low[axis], high[axis]})
      require(std::abs(end - origin[axis]) / cell_ < farthest, "position", end,
              "within 1e9 cells of the origin");
  }
  check_size(static_cast<std::int64_t>((high[0] - low[0]) / cell_),
             static_cast<std::int64_t>((high[1] - low[1]) / cell_));
}

void Grid::fit(Cell low, Cell high) {
  const std::int64_t columns = std::int64_t{high.column} - low.column + 1;
  const std::int64_t rows = std::int64_t{high.row} - low.row + 1;
  check_size(columns, rows);
  Buffer<double> update(4 * columns * rows, kNoMotion);
  keep(update, low, high);
  update_.swap(update);
  low_ = low;
  columns_ = static_cast<int>(columns);
  rows_ = static_cast<int>(rows);
  active_.assign(rows, {columns_, 0});
  for (Buffer<double>* field : {&momentum_, &velocity_, &force_})
    field->assign(4 * columns * rows, 0.0);
  if (keeps_body_forces_) body_.assign(4 * columns * rows, 0.0);
  if (keeps_cells_) cells_.assign(4 * columns * rows, 0.0);
  if (keeps_soil_) soil_.assign(4 * columns * rows, 0.0);
  if (keeps_terms_)
    for (Buffer<double>* field : {&terms_, &spread_}) field->assign(4 * columns * rows, 0.0);
}

void Grid::keep(Buffer<double>& update, Cell low, Cell high) const {
  for (int row = 0; row < rows_; ++row) {
    const std::int64_t to_row = std::int64_t{low_.row} + row - low.row;
    const int begin = std::max(active_[row].begin, low.column - low_.column);
    const int end = std::min(active_[row].end, high.column - low_.column + 1);
    if (to_row < 0 || to_row > high.row - low.row || begin >= end) continue;
    const std::int64_t columns = std::int64_t{high.column} - low.column + 1;
    std::copy(update_.begin() + 4 * (std::int64_t{row} * columns_ + begin),
              update_.begin() + 4 * (std::int64_t{row} * columns_ + end),
              update.begin() + 4 * (to_row * columns + low_.column + begin - low.column));
  }
}

void Grid::activate(int row, NodeRange columns) {
  active_[row].begin = std::min(active_[row].begin, columns.begin);
  active_[row].end = std::max(active_[row].end, columns.end);
}

void Grid::clear() {
  for (Buffer<double>* field : {&momentum_, &soil_}) std::fill(field->begin(), field->end(), 0.0);
}

GridView Grid::view() {
  GridView view{cell_,
                x_ + low_.column * cell_,
                y_ + low_.row * cell_,
                low_.column,
                low_.row,
                columns_,
                rows_,
                active_.data(),
                momentum_.data(),
                velocity_.data(),
                force_.data(),
                update_.data(),
                body_.empty() ? nullptr : body_.data(),
                cells_.empty() ? nullptr : cells_.data(),
                soil_.empty() ? nullptr : soil_.data(),
                terms_.empty() ? nullptr : terms_.data(),
                spread_.empty() ? nullptr : spread_.data(),
                {},
                {},
                {}};
  for (const Side side : {left, right, bottom, top}) {
    const int base = side == left || side == right ? low_.column : low_.row;
    view.kind[side] = walls_[side].kind;
    view.friction[side] = walls_[side].friction;
    view.wall[side] = wall_node_[side] - base;
  }
  return view;
}

std::int64_t Grid::bytes() const {
  std::int64_t total = active_.capacity() * sizeof(NodeRange);
  for (const Buffer<double>* field :
       {&momentum_, &velocity_, &force_, &update_, &body_, &cells_, &soil_, &terms_, &spread_})
    total += sizeof(double) * field->capacity();
  return total;
}

}  // namespace gimpslope
