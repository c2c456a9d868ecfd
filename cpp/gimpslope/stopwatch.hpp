// Where the time of a solver's steps goes.
#pragma once

#include "instruction_set.hpp"

namespace gimpslope {

/// Seconds since the solver was made: sweeps over the points, passes over the nodes, sorting.
struct Seconds {
  double stress = 0.0, move = 0.0, nodes = 0.0, sort = 0.0;
};

/// Seconds on a clock that only runs forward.
double now();

inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Books the time from lap to lap; does nothing on a thread that has no book.
class Stopwatch {
 public:
  explicit Stopwatch(Seconds* book) : book_(book), last_(book != nullptr ? now() : 0.0) {}

  void lap(double Seconds::* entry) {
    if (book_ == nullptr) return;
    const double time = now();
    book_->*entry += time - last_;
    last_ = time;
  }

 private:
  Seconds* book_;
  double last_;
};

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
