// The state of a scene and its stepping: the one type the outside sees of the kernel, besides
// parameters.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bodies.hpp"
#include "buffer.hpp"
#include "checks.hpp"
#include "grid.hpp"
#include "kernel.hpp"
#include "layout.hpp"
#include "ledger.hpp"
#include "material/material.hpp"
#include "method.hpp"
#include "points.hpp"
#include "team.hpp"
#include "wall.hpp"

namespace gimpslope {

/// A property of the points in storage order: component c of point k is at
/// data[k * point_stride + c * component_stride].
struct FieldView {
  double* data;
  std::ptrdiff_t point_stride, component_stride;
  int components;
};

/// Energies and ledger at one time.
struct Row {
  double time;
  std::int64_t steps;
  Energies energies;
  Ledger ledger;
  std::vector<BodyState> bodies;
};

class Solver {
 public:
  Solver(const InitialPoints& points, std::vector<Material> materials, double cell,
         std::array<double, 2> origin, const std::array<Wall, 4>& walls, const Method& method,
         InstructionSet instruction_set);

  /// Takes `steps` steps; throws Diverged.
  void advance(std::int64_t steps);

  /// Steps until `time`, at most `most` steps; with a Courant number the last two are shortened to
  /// end there. True when the time is reached.
  bool advance_to(double time, std::int64_t most);

  /// Steps to each of the times in turn, which grow, at most `most` steps in all, and adds a row
  /// for each; times that are not ahead have none. True when the last time is reached.
  bool advance_through(std::span<const double> times, std::int64_t most, std::vector<Row>& rows);

  void set_gravity(const Gravity& gravity);
  void set_damping(const Damping& damping);
  void stop();  // ends all motion, which counts as damping
  void set_time_step(const TimeStep& step);
  void set_materials(std::vector<Material> materials);

  /// Returns all stresses to the yield surfaces; gives the elastic energy released, J/m.
  double release_stress();

  /// Time and steps start anew at zero, and so do the plastic strain and the ledger.
  void reset_clock();

  Energies energies();
  Ledger ledger() const;  // of a method that keeps one

  /// Forces that were left when kinetic damping last stopped all motion: the sum of their sizes at
  /// the nodes and on rigid bodies, with the moments on these over their radii, N/m. Infinite
  /// before that.
  double unbalanced_force() const { return unbalanced_force_; }

  /// Fields by name: position, velocity, stress (xx, yy, zz, xy), volume, mass, plastic_strain,
  /// body_force, half_length, and deformation_gradient (xx, xy, yx, yy) where the method keeps it.
  FieldView field(const std::string& name);

  /// A field that shows the present state after every call, in single precision too.
  FieldView watch(const std::string& name);

  /// A field of `components` components a point, in the order the points were given.
  template <class Out>
  void copy_values(const std::string& name, std::span<Out> given);
  void set_values(const std::string& name, std::span<const double> values);
  std::vector<std::int32_t> material_of_points() const;
  std::span<const std::int32_t> numbers() const { return points_.number; }

  /// Rigid bodies, and the numbers of the stones that they are.
  const Bodies& bodies() const { return bodies_; }

  double time() const { return time_; }
  std::int64_t steps() const { return steps_; }
  int size() const { return points_.size; }
  double cell() const { return grid_.cell(); }
  int threads() const { return method_.threads; }
  bool keeps_ledger() const { return method_.ledger; }
  InstructionSet instruction_set() const { return instruction_set_; }
  double time_step();                                                          // the next one, s
  double stable_time_step() const { return stable_time_step_of(materials_); }  // at present, s
  double alpha() { return alpha_of(time_step()); }  // share of PIC in the next step
  std::int64_t bytes() const;
  const Seconds& seconds() const { return seconds_; }

 private:
  void fill(const InitialPoints& given);
  void choose_kernel();
  template <class Act>
  void with_kernel(Act act);
  template <class Real>
  View<Real> view_of(const PointsView<Real>& points);
  Points& points();
  const Points& points() const;
  Bodies bodies_of(const InitialPoints& given) const;
  void forget_known();
  bool go_on_to(double time, std::int64_t most);
  void prepare();
  void step(double dt, double whole, bool wants_energies = false);
  [[noreturn]] void fail(const std::string& what, std::int64_t point);
  [[noreturn]] void fail_at(int lost, double dt);
  void follow_width(double width);
  [[noreturn]] void fail_too_wide(double allowed);
  void keep_body_forces();
  void damp_at_peak();
  double force_from_rest(double dt);
  void check_step(const TimeStep& step, const std::vector<Material>& materials) const;
  double stable_time_step_of(const std::vector<Material>& materials) const;
  double alpha_of(double dt) const;
  void check_alpha(double dt) const;
  double kinetic_energy() const;
  void gather_speeds();
  Energies gather_energies() const;
  int fastest_point() const;  // its index
  int fastest_near(int point) const;

  Method method_;
  InstructionSet instruction_set_;
  std::unique_ptr<Team> team_;
  std::vector<Material> materials_;
  std::vector<Law> laws_;
  Grid grid_;
  mutable Points points_;
  std::unique_ptr<SinglePoints> single_;  // where the points are stepped in single precision
  bool single_loaded_ = false;            // it holds the state of the points,
  mutable bool single_ahead_ = false;     // or a later one
  bool watched_ = false;                  // which then is given back after every call
  Bodies bodies_;
  BodiesView bodies_view_{};
  Layout layout_;
  std::vector<Known> known_;    // of each block
  Buffer<Gradient> gradients_;  // of each block, where volume strains are averaged
  Basis basis_;
  Kernel<double> kernel_{};
  Kernel<float> single_kernel_{};
  Gravity gravity_;
  Damping damping_;
  std::vector<Report> reports_;      // of each slab
  std::vector<Ledger> ledger_rows_;  // of each row of nodes, in one step
  Ledger ledger_;
  Seconds seconds_;
  Speeds speeds_;  // the largest of all points
  bool speeds_known_ = false;
  Energies energies_;  // of the last step that was asked for them
  bool energies_known_ = false;
  double half_length_ = 0.0;  // of all points where they are alike, otherwise their mean, m
  double width_ = 0.0;        // of the widest domain, cells
  double time_ = 0.0;
  double time_carry_ = 0.0;      // what the sum of the steps has lost by rounding, s
  double stable_at_sort_ = 0.0;  // stable step when the points were last sorted, s
  std::string failure_;          // why no step can follow
  std::int64_t steps_ = 0;
  double last_kinetic_ = 0.0;
  bool stopped_ = false;  // by kinetic damping, after the last step
  double unbalanced_force_ = std::numeric_limits<double>::infinity();
  double travel_ = 0.0;  // since the last sort, at most, cells
  int steps_since_sort_ = 0;
  bool sorted_ = false;
  bool nodes_ready_ = false;  // mass and momentum at the nodes are those of the points
};

}  // namespace gimpslope
