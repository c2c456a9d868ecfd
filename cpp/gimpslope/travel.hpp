// How far points may travel between two sorts, and what is laid out for it.
#pragma once

namespace gimpslope {

/// Farthest that an edge of a domain may move in one step, cells.
constexpr double kFarthestStep = 0.5;

/// Points are sorted again once an edge may have moved this far, cells.
constexpr double kTravelBetweenSorts = 0.5;

/// Cells around the points that slabs and active nodes are laid out for.
constexpr int kMargin = 1;
static_assert(kFarthestStep + kTravelBetweenSorts <= kMargin);

/// Rows of cells in a slab.
constexpr int kSlabRows = 6;

/// Nodes a direction that a point reaches at most. Two slabs with one between them share no node.
constexpr int kWidestReach = 5;
static_assert(2 * kSlabRows - kMargin > kSlabRows - 1 + kMargin + kWidestReach - 1);

}  // namespace gimpslope
