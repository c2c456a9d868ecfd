#include "stability.hpp"

#include <algorithm>
#include <cmath>

namespace gimpslope {

double courant_limit(ShapeKind shape, double width, double poisson) {
  const double r = std::min(width, 1.0);
  const double bound = shape == ShapeKind::linear ? 4.0 : 4.0 / r + 1.0 / (1.0 - 0.5 * r);
  return 2.0 / std::sqrt(bound / (1.0 - poisson));
}

}  // namespace gimpslope
