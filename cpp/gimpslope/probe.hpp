// Single pieces of the kernel, for tests and teaching.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "material/material.hpp"
#include "method.hpp"

namespace gimpslope {

/// Shape functions of n points at `nodes` nodes each: column and row of a node from the origin, the
/// value, and the gradient {x, y} in 1/m.
struct ShapeValues {
  int nodes;
  std::vector<std::int64_t> index;
  std::vector<double> value, gradient;
};

/// `position` and `half_length` hold {x, y} of each point, m.
ShapeValues shape_functions(const std::string& shape, std::span<const double> position,
                            std::span<const double> half_length, double cell,
                            std::array<double, 2> origin);

/// Returns stresses {xx, yy, zz, xy}, Pa, to the yield surface in place and adds the equivalent
/// plastic strain.
void return_mapping(const Material& material, std::span<double> stress,
                    std::span<double> plastic_strain);

/// Takes stresses through `steps` steps of dt under velocity gradients {xx, xy, yx, yy}, 1/s, that
/// stay as they are: exact rotation, elastic trial, return (paper eq. 24-25), as in a sweep.
void update_stress(const Material& material, std::span<const double> velocity_gradient, double dt,
                   std::int64_t steps, std::span<double> stress, std::span<double> plastic_strain);

}  // namespace gimpslope
