#include "layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "error.hpp"
#include "travel.hpp"

namespace gimpslope {
namespace {

/// The cell at a distance of so many `cells` from the origin; `position` is for the error.
std::int32_t cell_at(double cells, double position) {
  constexpr double farthest = 1e9;
  require(std::abs(cells) < farthest, "position", position, "within 1e9 cells of the origin");
  const auto cell = static_cast<std::int32_t>(cells);
  return cell - (cells < cell);
}

/// The cell of each point's first node.
std::vector<Cell> first_cells(const Points& points, const Grid& grid, double behind,
                              double half_length) {
  std::vector<Cell> cells(points.size);
  const bool own = !points.half_length.empty();
  const double per_cell = 1.0 / grid.cell();
  for (int k = 0; k < points.size; ++k) {
    const double x = points.position[0][k], y = points.position[1][k];
    const double lx = own ? points.half_length[0][k] : half_length;
    const double ly = own ? points.half_length[1][k] : half_length;
    cells[k] = {cell_at((x - lx - grid.x()) * per_cell - behind, x),
                cell_at((y - ly - grid.y()) * per_cell - behind, y)};
  }
  return cells;
}

/// Stable counting sort of `order` by the key of each point, which lies in [0, keys).
void sort_by(std::vector<std::int32_t>& order, int keys, const std::vector<std::int32_t>& key) {
  std::vector<std::int32_t> place(keys + 1, 0), sorted(order.size());
  for (const std::int32_t value : key) ++place[value + 1];
  std::partial_sum(place.begin(), place.end(), place.begin());
  for (const std::int32_t point : order) sorted[place[key[point]]++] = point;
  order.swap(sorted);
}

/// Parts the points of each cell into fours, a pair and a single one, and brings the fours of a row
/// before its pairs and these before the single ones: points that share their nodes come in runs of
/// one length, and the processor foresees where a run ends.
template <class SameRow, class SameCell>
void part_cells(std::vector<std::int32_t>& order, SameRow same_row, SameCell same_cell) {
  std::vector<std::int32_t> parted, pairs, singles;
  parted.reserve(order.size());
  for (std::size_t row = 0, k = 0; row < order.size(); row = k) {
    pairs.clear();
    singles.clear();
    while (k < order.size() && same_row(order[row], order[k])) {
      std::size_t end = k + 1;
      while (end < order.size() && same_cell(order[k], order[end])) ++end;
      for (; end - k >= 4; k += 4) parted.insert(parted.end(), &order[k], &order[k] + 4);
      if (end - k >= 2) {
        pairs.insert(pairs.end(), &order[k], &order[k] + 2);
        k += 2;
      }
      if (k < end) singles.push_back(order[k++]);
    }
    parted.insert(parted.end(), pairs.begin(), pairs.end());
    parted.insert(parted.end(), singles.begin(), singles.end());
  }
  order.swap(parted);
}

/// Makes the nodes active that points in these cells can reach before the next sort.
void activate_reached(const std::vector<Cell>& cells, Cell low, Cell high, int reach, Grid& grid) {
  const NodeRange none{high.column - low.column + 1, -1};
  std::vector<NodeRange> columns(high.row - low.row + 1, none);  // of cells, both included
  for (const Cell& cell : cells) {
    NodeRange& range = columns[cell.row - low.row];
    range = {std::min(range.begin, cell.column - low.column),
             std::max(range.end, cell.column - low.column)};
  }
  const int beyond = reach + 2 * kMargin;  // first nodes lie the margin into the window
  for (int row = 0; row < static_cast<int>(columns.size()); ++row) {
    if (columns[row].end < 0) continue;
    for (int j = 0; j < beyond; ++j)
      grid.activate(row + j, {columns[row].begin, columns[row].end + beyond});
  }
}

/// Shares of neighbouring slabs with about as many points for each thread. They begin with an even
/// slab, so that the only one that waits for another share waits for what that begins with.
void share_out(Layout& layout, int threads) {
  const auto slabs = static_cast<std::int32_t>(layout.slabs.size());
  const auto size = [&](std::int32_t slab) -> std::int64_t {
    const Slab& of = layout.slabs[slab];
    return of.begin == of.end ? 0 : layout.blocks[of.end - 1].end - layout.blocks[of.begin].begin;
  };
  const std::int64_t points = layout.blocks.back().end;
  std::int64_t before = 0;  // points of the slabs that have been given
  std::int32_t end = 0;
  for (int thread = 0; thread < threads; ++thread) {
    const std::int32_t begin = end;
    const std::int64_t due = points * (thread + 1) / threads;
    while (end < slabs && (end % 2 == 1 || before + size(end) / 2 <= due)) before += size(end++);
    layout.shares.push_back(begin);
    for (const int parity : {0, 1})
      for (std::int32_t slab = begin; slab < end; ++slab)
        if (slab % 2 == parity) layout.shared.push_back(slab);
  }
  layout.shares.push_back(slabs);
}

}  // namespace

Layout arrange(Points& points, Grid& grid, const ShapeTraits& shape, double half_length,
               int materials, int threads) {
  const int reach = shape.nodes;
  std::vector<Cell> cells = first_cells(points, grid, shape.behind, half_length);
  Cell low = cells.front(), high = cells.front();
  for (const Cell& cell : cells) {
    low = {std::min(low.column, cell.column), std::min(low.row, cell.row)};
    high = {std::max(high.column, cell.column), std::max(high.row, cell.row)};
  }

  grid.fit({low.column - kMargin, low.row - kMargin},
           {high.column + reach - 1 + kMargin, high.row + reach - 1 + kMargin});

  // By column, then by slab, material and row: the rows of a slab once for each material, so that
  // blocks of one material are long.
  const int rows = slab_rows(reach), slabs = (high.row - low.row) / rows + 1;
  std::vector<std::int32_t> order(points.size), key(points.size);
  std::iota(order.begin(), order.end(), 0);
  for (int k = 0; k < points.size; ++k) key[k] = cells[k].column - low.column;
  sort_by(order, high.column - low.column + 1, key);
  for (int k = 0; k < points.size; ++k) {
    const int row = cells[k].row - low.row, slab = row / rows;
    key[k] = (slab * materials + points.material[k]) * rows + row % rows;
  }
  sort_by(order, slabs * materials * rows, key);
  const auto same_row = [&](std::int32_t a, std::int32_t b) {
    return key[a] == key[b];
  };
  part_cells(order, same_row, [&](std::int32_t a, std::int32_t b) {
    return cells[a].column == cells[b].column && same_row(a, b);
  });

  // Blocks begin on cache lines where they can, which full ones of kBlock points do.
  constexpr int kLine = kCacheLine / sizeof(double);
  static_assert(kBlock % kLine == 0);
  Layout layout;
  int next = 0;  // first row of the next slab
  for (int k = 0; k < points.size; ++k) {
    const std::int32_t point = order[k], material = points.material[point];
    const int row = cells[point].row - low.row;
    const bool new_slab = row >= next;
    if (new_slab || layout.blocks.back().material != material ||
        (k - layout.blocks.back().begin > kBlock - kLine && k % kLine == 0)) {
      const auto block = static_cast<std::int32_t>(layout.blocks.size());
      for (; next <= row; next += rows) layout.slabs.push_back({block, block, next, next + rows});
      layout.blocks.push_back({k, k, material});
    }
    layout.blocks.back().end = k + 1;
    layout.slabs.back().end = static_cast<std::int32_t>(layout.blocks.size());
  }
  activate_reached(cells, low, high, reach, grid);
  layout.slabs.back().end_row = grid.rows();
  share_out(layout, threads);
  points.reorder(order);
  return layout;
}

}  // namespace gimpslope
