// How far points may travel between two sorts, and what is laid out for it.
#pragma once

namespace gimpslope {

/// Farthest that an edge of a domain may move in one step, cells.
constexpr double kFarthestStep = 0.5;

/// Cells in a step that nobody will miss: a tenth of a cell in a hundred thousand steps.
constexpr double kStill = 1e-6;

/// Points are sorted again once an edge may have moved this far, cells.
constexpr double kTravelBetweenSorts = 0.49;

/// Cells around the points that slabs and active nodes are laid out for.
constexpr int kMargin = 1;
static_assert(kFarthestStep + kTravelBetweenSorts < kMargin);  // with room for rounding

/// Rows of cells in a slab whose points reach that many nodes a direction: as few as will do for
/// two slabs with one between them to share no node. The last row that the first slab reaches is
/// then rows - 1 + kMargin + reach - 1, the first one of the other 2 rows - kMargin.
constexpr int slab_rows(int reach) { return reach + 2 * kMargin - 1; }

}  // namespace gimpslope
