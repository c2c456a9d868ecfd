// What can be set between the steps of a solver, and what of it is refused.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "error.hpp"
#include "shape/traits.hpp"
#include "solver.hpp"

namespace gimpslope {

void Solver::set_gravity(const Gravity& gravity) {
  for (const double g : {gravity.x, gravity.y})
    require(std::isfinite(g), "gravity", g, "finite, in m/s2");
  require(gravity.ramp >= 0.0 && std::isfinite(gravity.ramp), "ramp", gravity.ramp,
          "zero or positive and finite, in s");
  gravity_ = gravity;
  energies_known_ = false;
}

void Solver::set_damping(const Damping& damping) {
  require(damping.local >= 0.0 && damping.local < 1.0, "local", damping.local, "in [0, 1)");
  damping_ = damping;
  last_kinetic_ = 0.0;
  stopped_ = false;
  unbalanced_force_ = std::numeric_limits<double>::infinity();
}

void Solver::stop() {
  ledger_.damping += kinetic_energy();
  points().velocity.fill(0.0);
  points().affine.fill(0.0);
  bodies_.stop();
  single_loaded_ = false;
  last_kinetic_ = 0.0;
  nodes_ready_ = speeds_known_ = energies_known_ = false;
}

void Solver::set_time_step(const TimeStep& step) {
  check_step(step, materials_);
  const TimeStep before = std::exchange(method_.time_step, step);
  try {
    check_alpha(time_step());
  } catch (const std::invalid_argument&) {
    method_.time_step = before;
    throw;
  }
}

void Solver::check_step(const TimeStep& step, const std::vector<Material>& materials) const {
  const bool fixed = step.kind == TimeStep::Kind::fixed;
  require(fixed || std::isfinite(stable_time_step_of(materials)), "courant", step.value,
          "given with a deformable material; of rigid stones alone, a fixed time_step");
  const char* name = fixed ? "time_step" : "courant";
  require(step.value > 0.0 && std::isfinite(step.value), name, step.value, "positive and finite");
  const double limit = fixed ? stable_time_step_of(materials) : kCourantLimit;
  if (method_.allow_unstable || step.value <= limit) return;
  refuse(name, step.value,
         "at most " + text(limit) + (fixed ? " s" : "") +
             ", the stable limit of this scene, unless allow_unstable is set");
}

void Solver::set_materials(std::vector<Material> materials) {
  require(materials.size() == materials_.size(), "materials",
          std::to_string(materials.size()) + " materials",
          ("a list of " + std::to_string(materials_.size())).c_str());
  std::vector<Law> laws = laws_of(materials);
  for (std::size_t m = 0; m < laws.size(); ++m)
    require((laws[m].kind == LawKind::rigid) == (laws_[m].kind == LawKind::rigid) &&
                (laws[m].kind != LawKind::rigid ||
                 (materials[m].density == materials_[m].density &&
                  materials[m].interface_friction == materials_[m].interface_friction &&
                  materials[m].mutual_friction == materials_[m].mutual_friction)),
            "materials", "number " + std::to_string(m),
            "rigid where it was, with the density and friction that it had, and only there");
  // The same stiffness stays accepted, however the density has changed since the step was given.
  if (stable_time_step_of(materials) < stable_time_step()) check_step(method_.time_step, materials);
  laws_ = std::move(laws);
  materials_ = std::move(materials);
  speeds_known_ = energies_known_ = false;
}

void Solver::reset_clock() {
  time_ = time_carry_ = 0.0;
  steps_ = 0;
  ledger_ = {};
  bodies_.reset_impulses();
  points().plastic_strain.fill(0.0);
  single_loaded_ = false;
}

double Solver::stable_time_step_of(const std::vector<Material>& materials) const {
  const Points& p = points();
  double fastest = 0.0;
  for (int k = 0; k < p.size; ++k)
    fastest =
        std::max(fastest, materials[p.material[k]].wave_modulus() * p.volume[0][k] / p.mass[0][k]);
  return kCourantLimit * grid_.cell() / std::sqrt(fastest);
}

double Solver::alpha_of(double dt) const {
  const ShapeTraits& shape = traits(basis_.shape);
  return method_.blend.alpha(dt, shape.second_moment(grid_.cell(), half_length_));
}

void Solver::check_alpha(double dt) const {
  const double alpha = alpha_of(dt);
  if (alpha <= 1.0) return;
  const bool viscosity = method_.blend.kind == Blend::Kind::viscosity;
  const double limit = viscosity ? method_.blend.value / alpha : dt;
  refuse(viscosity ? "viscosity" : "relaxation_time", method_.blend.value,
         (viscosity ? "at most " : "at least ") + text(limit) + (viscosity ? " m2/s" : " s") +
             " at a step of " + text(dt) + " s, where the PIC share of a step reaches 1");
}

}  // namespace gimpslope
