// The order of the points in memory: slabs of cell rows, blocks of one material, active nodes.
#pragma once

#include <vector>

#include "grid.hpp"
#include "points.hpp"
#include "shape/traits.hpp"
#include "view.hpp"

namespace gimpslope {

struct Layout {
  std::vector<Block> blocks;
  std::vector<Slab> slabs;
  std::vector<std::int32_t> shared;  // slabs by thread, even ones first: see for_each_slab
  std::vector<std::int32_t> shares;  // where in `shared` those of each thread begin, and its end
};

/// Sorts the points by slab, material and row of their first node, and each row by column, first
/// all that make fours of a cell, then pairs, then single ones. Fits the grid's window
/// to them with a margin, and marks the nodes that they can reach before the next sort.
/// `half_length` holds for points without their own.
Layout arrange(Points& points, Grid& grid, const ShapeTraits& shape, double half_length,
               int materials, int threads);

}  // namespace gimpslope
