// What the solver needs to know of a shape function, by its name or its index in the list.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace gimpslope {

/// What each shape function states of itself: see linear.hpp.
struct ShapeTraits {
  std::span<const char* const> names;
  int nodes;
  double widest, behind, variance;

  /// Second moment of the function averaged over a domain, m2.
  double second_moment(double cell, double half_length) const;
};

const ShapeTraits& traits(int shape);

/// Index of the shape function that goes by a name: of several, the first that takes domains of
/// `width` cells, or else the last. Refuses unknown names.
int find_shape(const std::string& name, double width = std::numeric_limits<double>::infinity());

/// Whether points have domains over which the function is averaged.
bool has_domains(const std::string& name);

/// All names, in the order of the list.
std::vector<std::string> shape_names();

}  // namespace gimpslope
