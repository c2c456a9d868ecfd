// What a solver refuses to be given; all of these throw std::invalid_argument.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "material/material.hpp"
#include "method.hpp"

namespace gimpslope {

/// The points as they are given: vectors {x, y} one after the other, in SI units.
struct InitialPoints {
  std::span<const double> position, velocity, half_length;
  std::span<const double> mass, volume;
  std::span<const std::int32_t> material;
  std::span<const std::int32_t> stone;  // number of that a point is in, or negative; empty: of none
};

/// Refuses arrays of the wrong length and values that are not finite or, where asked, not positive.
void check_values(std::span<const double> values, std::size_t count, bool positive,
                  const char* parameter);

void check(const InitialPoints& points, const std::vector<Material>& materials,
           const std::string& shape);
void check(const Method& method);

}  // namespace gimpslope
