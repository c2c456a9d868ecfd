// Rigid bodies: stones whose points move as one.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "points.hpp"
#include "view.hpp"

namespace gimpslope {

/// Steps in which the iterations for impulses ended before these stayed, and how far the last
/// change of a speed moves a body in one of them at most, and in all, m.
struct Unsettled {
  std::int64_t steps = 0;
  double largest = 0.0, sum = 0.0;
};

/// The bodies of a scene. Their points are among all others but take no part in the sweeps: a body
/// is where its centre and angle say, and moves them. Whatever sums over points does so in the
/// order in which they were given, so that nothing depends on threads or on how they are sorted.
class Bodies {
 public:
  Bodies() = default;

  /// Points with the same number make a body, those with a negative one none; bodies are in the
  /// order of their numbers.
  Bodies(std::span<const std::int32_t> number_of_point, int threads);

  bool empty() const { return numbers_.empty(); }
  const std::vector<std::int32_t>& numbers() const { return numbers_; }
  const std::vector<BodyState>& states() const { return states_; }
  const std::vector<BodyReport>& reports() const { return reports_; }

  /// Takes mass, centre and shape of each from its points, which have half-lengths of their own or
  /// a common one; its angle is then 0.
  void take_shape(const Points& points, double half_length, double cell);

  /// Takes the friction of each from the material of its points.
  void take_friction(const Points& points, const std::vector<Material>& materials);

  /// Whether soil may slide along one of them.
  bool slide_on_soil() const;

  /// Gives each body the momentum and angular momentum of its points, and them its motion.
  void take_motion(Points& points);

  /// Ends all motion; what that takes counts as an impulse.
  void stop();

  void reset_impulses();

  double kinetic_energy() const;                                      // J/m
  double potential_energy(double gravity_x, double gravity_y) const;  // J/m
  double momentum() const;                           // sum of sizes, angular ones over radii, N s/m
  double largest_speed(const Points& points) const;  // of a point, m/s

  /// What the sweeps see, for points as they lie in storage, a grid of so many nodes, and bodies
  /// whose points go no farther than `travel` before the next view, m.
  BodiesView view(const Points& points, std::size_t nodes, double travel);

  double widest() const { return widest_; }  // domain of a point, which all keep, m

  /// Whether bodies have met in more places than there is room for.
  bool contacts_missed() const { return contacts_missed_; }

  /// Counts a step whose impulses have not settled, where that moves a body by more than `nothing`.
  void count_unsettled(double dt, double nothing);

  /// Since the impulses were last reset: those of the soil that slides along bodies, and those
  /// where bodies touch each other or walls.
  const Unsettled& interfaces_unsettled() const { return interfaces_unsettled_; }
  const Unsettled& contacts_unsettled() const { return contacts_unsettled_; }

  std::int64_t bytes() const;

 private:
  void find(const Points& points);
  void find_pairs(double within);

  std::vector<std::int32_t> numbers_;
  std::vector<std::int32_t> begin_;   // of each body's points in
  std::vector<std::int32_t> given_;   // points in the order they came in,
  std::vector<std::int32_t> member_;  // and where they are in storage
  std::array<std::vector<double>, 2> offset_, half_length_;
  std::vector<double> mass_, inertia_, radius_, friction_, mutual_friction_;
  std::vector<BodyState> states_;
  std::vector<BodyReport> reports_;
  std::vector<HeldBody> held_;
  std::vector<BodyNode> nodes_;
  std::vector<std::int32_t> reaches_, owner_;
  std::vector<double> shares_, near_;
  std::vector<Meeting> meetings_;
  std::vector<std::int32_t> window_at_, pairs_;  // two each
  std::vector<Contact> contacts_;
  int contact_count_ = 0, window_ = 0, threads_ = 1;
  bool contacts_missed_ = false;
  double contacts_left_ = 0.0;  // of the last step
  Unsettled interfaces_unsettled_, contacts_unsettled_;
  double widest_ = 0.0;
};

}  // namespace gimpslope
