// Rigid bodies: stones whose points move as one.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "points.hpp"
#include "view.hpp"

namespace gimpslope {

/// The bodies of a scene. Their points are among all others; a body sums over them in the order in
/// which they were given, so that nothing depends on threads or on how points are sorted.
class Bodies {
 public:
  Bodies() = default;

  /// Points with the same number make a body, those with a negative one none; bodies are in the
  /// order of their numbers.
  explicit Bodies(std::span<const std::int32_t> number_of_point);

  bool empty() const { return numbers_.empty(); }
  const std::vector<std::int32_t>& numbers() const { return numbers_; }
  const std::vector<BodyState>& states() const { return states_; }
  const std::vector<BodyReport>& reports() const { return reports_; }

  /// Looks up where their points are in storage.
  void find(const Points& points);

  /// Takes mass, centre and shape of each from its points; its angle is then 0.
  void take_shape(const Points& points);

  /// Gives each body the momentum and angular momentum of its points, and them its motion.
  void make_rigid(Points& points);

  void reset_impulses();

  BodiesView view();
  std::int64_t bytes() const;

 private:
  std::vector<std::int32_t> numbers_;
  std::vector<std::int32_t> begin_;   // of each body's points in
  std::vector<std::int32_t> given_;   // points in the order they came in,
  std::vector<std::int32_t> member_;  // and where they are in storage
  std::vector<double> offset_[2];
  std::vector<double> mass_, inertia_;
  std::vector<BodyState> states_;
  std::vector<BodyReport> reports_;
  std::array<std::vector<double>, 4> exchange_;
};

}  // namespace gimpslope
