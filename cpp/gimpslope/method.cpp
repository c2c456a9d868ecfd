#include "method.hpp"

namespace gimpslope {

double Blend::alpha(double dt, double second_moment) const {
  switch (kind) {
    case Kind::viscosity:
      return value * dt / second_moment;
    case Kind::relaxation_time:
      return dt / value;
    case Kind::alpha:
      break;
  }
  return value;
}

double Gravity::factor(double time) const { return time < ramp ? time / ramp : 1.0; }

}  // namespace gimpslope
