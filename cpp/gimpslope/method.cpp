#include "method.hpp"

namespace gimpslope {

double Blend::alpha(double dt, double cell, double half_length) const {
  switch (kind) {
    case Kind::viscosity:
      return value * dt / (cell * cell / 6.0 + half_length * half_length / 3.0);
    case Kind::relaxation_time:
      return dt / value;
    case Kind::alpha:
      break;
  }
  return value;
}

double Gravity::factor(double time) const { return time < ramp ? time / ramp : 1.0; }

}  // namespace gimpslope
