// How a solver says that it cannot go on, and why.
#include <algorithm>
#include <cmath>
#include <string>

#include "error.hpp"
#include "shape/traits.hpp"
#include "solver.hpp"
#include "travel.hpp"

namespace gimpslope {

/// Ends the run: part of a step may have been taken, and no other one can follow.
void Solver::fail(const std::string& what, std::int64_t point) {
  failure_ = "step " + std::to_string(steps_ + 1) + " from t = " + text(time_) + " s: " + what;
  throw Diverged(failure_, steps_ + 1, time_, point);
}

/// A point was refused its move: says which, and what is likely to have happened.
void Solver::fail_at(int lost, double dt) {
  const Points& p = points();
  const double x = p.position[0][lost], y = p.position[1][lost];
  const double farthest = kFarthestStep * cell();
  const int fastest = fastest_near(lost);
  const double own = std::sqrt(squared_speed(p, lost)),
               speed = std::sqrt(squared_speed(p, fastest));
  bool finite = std::isfinite(p.volume[0][lost]);
  for (int c = 0; c < 4; ++c) finite = finite && std::isfinite(p.stress[c][lost]);
  std::string cause = "an inverted domain, or points too far apart to share nodes";
  if (own * dt > farthest) {
    cause = "its speed of " + text(own) + " m/s";
  } else if (dt > stable_at_sort_) {
    cause = "the time step of " + text(dt) + " s is above the stable limit of " +
            text(stable_at_sort_) + " s";
  } else if (speed * dt > farthest) {
    cause = "the speed of point " + std::to_string(p.number[fastest]) + " near it, " + text(speed) +
            " m/s";
  }
  fail("point " + std::to_string(points_.number[lost]) + " at (" + text(x) + ", " + text(y) +
           ") m " +
           (finite ? "would move or grow by more than half a cell in one step"
                   : "has a stress that is not finite") +
           "; likely cause: " + cause,
       points_.number[lost]);
}

/// The widest domain is wider than any basis holds.
void Solver::fail_too_wide(double allowed) {
  const auto wider = [&](int a, int b) {
    const Field<double>& l = points().half_length;
    return std::max(l[0][a], l[1][a]) < std::max(l[0][b], l[1][b]);
  };
  int point = 0;
  for (int k = 1; k < size(); ++k)
    if (wider(point, k)) point = k;
  fail("the domain of point " + std::to_string(points_.number[point]) + " is " + text(width_) +
           " cells wide, of " + text(allowed) +
           " allowed; likely cause: shear or extension that domain_update stretch or "
           "deformation_diagonal follows without bound, or soil that came apart",
       points_.number[point]);
}

int Solver::fastest_point() const {
  const Points& p = points();
  int fastest = 0;
  for (int k = 1; k < p.size; ++k)
    if (squared_speed(p, k) > squared_speed(p, fastest)) fastest = k;
  return fastest;
}

/// Of the points that can share nodes with one.
int Solver::fastest_near(int point) const {
  const Points& p = points();
  const double reach = traits(basis_.shape).nodes * grid_.cell();
  int fastest = point;
  for (int k = 0; k < p.size; ++k) {
    const bool near = std::abs(p.position[0][k] - p.position[0][point]) < reach &&
                      std::abs(p.position[1][k] - p.position[1][point]) < reach;
    if (near && squared_speed(p, k) > squared_speed(p, fastest)) fastest = k;
  }
  return fastest;
}

}  // namespace gimpslope
