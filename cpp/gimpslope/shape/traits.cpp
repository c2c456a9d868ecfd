#include "traits.hpp"

#include <algorithm>
#include <array>

#include "../error.hpp"
#include "list.hpp"

namespace gimpslope {
namespace {

template <class... Shape>
constexpr std::array<ShapeTraits, sizeof...(Shape)> table(List<Shape...>) {
  return {{{Shape::names, Shape::nodes, Shape::widest, Shape::behind, Shape::variance}...}};
}

constexpr auto kTable = table(Shapes{});

}  // namespace

/// Variances of functions that follow one another add up; that of a box of width w is w^2 / 12.
double ShapeTraits::second_moment(double cell, double half_length) const {
  return variance * cell * cell / 12.0 + half_length * half_length / 3.0;
}

const ShapeTraits& traits(int shape) { return kTable[shape]; }

int find_shape(const std::string& name, double width) {
  int found = -1;
  for (int shape = 0; shape < static_cast<int>(kTable.size()); ++shape) {
    if (std::ranges::count(kTable[shape].names, name) == 0) continue;
    found = shape;
    if (width <= kTable[shape].widest) break;
  }
  if (found >= 0) return found;
  std::string rule;
  for (const std::string& known : shape_names()) rule += (rule.empty() ? "one of " : ", ") + known;
  refuse("shape", name, rule);
}

bool has_domains(const std::string& name) { return traits(find_shape(name)).widest > 0.0; }

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (const ShapeTraits& shape : kTable) {
    for (const char* name : shape.names)
      if (std::ranges::count(names, name) == 0) names.emplace_back(name);
  }
  return names;
}

}  // namespace gimpslope
