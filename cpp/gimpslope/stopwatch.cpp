#include "stopwatch.hpp"

#include <chrono>

namespace gimpslope {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace gimpslope
