// What the kernel throws: std::invalid_argument for refused parameters, Diverged for a failed run.
#pragma once

#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>

namespace gimpslope {

/// A run whose state is no longer finite, or whose points move faster than the grid can follow.
struct Diverged : std::runtime_error {
  Diverged(const std::string& message, std::int64_t step, double time, std::int64_t point)
      : std::runtime_error(message), step(step), time(time), point(point) {}
  std::int64_t step;
  double time;
  std::int64_t point;
};

/// A number as messages show it.
inline std::string text(double value) {
  std::ostringstream shown;
  shown << value;
  return shown.str();
}

/// Refuses a parameter: names it, what is allowed, and its value.
template <class Value>
[[noreturn]] void refuse(const char* parameter, const Value& value, const std::string& rule) {
  std::ostringstream message;
  message.precision(12);
  message << parameter << " must be " << rule << ", got " << value;
  throw std::invalid_argument(message.str());
}

template <class Value>
void require(bool allowed, const char* parameter, const Value& value, const char* rule) {
  if (!allowed) refuse(parameter, value, rule);
}

}  // namespace gimpslope
