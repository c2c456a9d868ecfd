// Loops that show what a processor can do at most, compiled once for each instruction set.
#pragma once

#include <cstdint>

namespace gimpslope {

/// They start from `sum` or put their results there, so that no compiler leaves them out.
struct MachineLoops {
  /// Rounds of multiply-adds in double precision that do not wait for each other; the number of
  /// their floating-point operations, two each.
  std::int64_t (*multiply_add)(std::int64_t rounds, double& sum);
  /// Reads `lines` cache lines from `values` on.
  void (*read)(const double* values, std::int64_t lines, double& sum);
};

constexpr int kDoublesOfLine = 8;

}  // namespace gimpslope
