// The small fixed-size arrays in which a point meets its nodes.
#pragma once

#include <Eigen/Core>

#include "instruction_set.hpp"

#if !EIGEN_VERSION_AT_LEAST(3, 4, 0)
#error "gimpslope needs Eigen 3.4 or newer"
#endif

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Four doubles that are loaded, multiplied and added as one: what a node or a point keeps
/// together.
using Quad = Eigen::Array<double, 4, 1>;

inline Eigen::Map<const Quad, Eigen::Aligned32> quad(const double* four) {
  return Eigen::Map<const Quad, Eigen::Aligned32>(four);
}

inline Eigen::Map<Quad, Eigen::Aligned32> quad(double* four) {
  return Eigen::Map<Quad, Eigen::Aligned32>(four);
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
