// What a solver tells of its points, and what it lets others set.
#include <algorithm>
#include <cmath>
#include <string>

#include "checks.hpp"
#include "error.hpp"
#include "shape/traits.hpp"
#include "solver.hpp"
#include "sweep/loops.hpp"

namespace gimpslope {
namespace {

/// Elastic energy a volume, J/m3.
double strain_energy(const Law& law, const Stress& s) {
  return 0.5 * product(compliance_of(law.drucker_prager.elastic), s, s);
}

Stress stress_of(const Points& p, int k) {
  return {p.stress[0][k], p.stress[1][k], p.stress[2][k], p.stress[3][k]};
}

}  // namespace

Energies Solver::energies() {
  if (!energies_known_) {
    kernel_.measure_energies(view_of(points().view()), gravity_.x, gravity_.y, reports_.data());
    energies_ = gather_energies();
    energies_known_ = true;
  }
  return energies_;
}

Energies Solver::gather_energies() const {
  Energies sum;
  for (const Report& report : reports_) {
    sum.kinetic += report.energies.kinetic;
    sum.potential += report.energies.potential;
    sum.elastic += report.energies.elastic;
    sum.max_speed = std::max(sum.max_speed, report.energies.max_speed);
  }
  sum.kinetic += bodies_.kinetic_energy();
  sum.potential += bodies_.potential_energy(gravity_.x, gravity_.y);
  sum.max_speed = std::max(std::sqrt(sum.max_speed), bodies_.largest_speed(points_));
  return sum;
}

double Solver::kinetic_energy() const {
  const Points& p = points();
  double sum = bodies_.kinetic_energy();
  for (int k = 0; k < p.size; ++k)
    if (laws_[p.material[k]].kind != LawKind::rigid)
      sum += 0.5 * p.mass[0][k] * squared_speed(p, k);
  return sum;
}

double Solver::release_stress() {
  Points& p = points();
  double released = 0.0;
  for (int k = 0; k < p.size; ++k) {
    const Law& law = laws_[p.material[k]];
    if (law.kind != LawKind::drucker_prager) continue;
    const Stress before = stress_of(p, k);
    Mohr circle = circle_of(before);
    if (!return_to_surface(law.drucker_prager, circle, p.plastic_strain[0][k])) continue;
    const Stress after = stress_of(circle);
    p.stress[0][k] = after.xx;
    p.stress[1][k] = after.yy;
    p.stress[2][k] = after.zz;
    p.stress[3][k] = after.xy;
    released += p.volume[0][k] * (strain_energy(law, before) - strain_energy(law, after));
  }
  single_loaded_ = energies_known_ = false;
  ledger_.plastic += released;
  return released;
}

Ledger Solver::ledger() const {
  require(method_.ledger, "method", "one without a ledger",
          "one that keeps a ledger, Method(ledger=True)");
  return ledger_;
}

FieldView Solver::field(const std::string& name) {
  const auto all = [](Field<double>& field) {
    return FieldView{field[0], 1, field.stride(), field.components()};
  };
  Points& p = points();
  if (name == "position") return all(p.position);
  if (name == "velocity") return all(p.velocity);
  if (name == "stress") return all(p.stress);
  if (name == "volume") return all(p.volume);
  if (name == "mass") return all(p.mass);
  if (name == "plastic_strain") return all(p.plastic_strain);
  if (name == "body_force") {
    keep_body_forces();
    return all(p.body_force);
  }
  if (name == "half_length" && !p.half_length.empty()) return all(p.half_length);
  if (name == "half_length" && has_domains(method_.shape)) return {&half_length_, 0, 0, 2};
  if (name == "deformation_gradient" && !p.deformation.empty()) return all(p.deformation);
  if (name == "affine" && !p.affine.empty()) return all(p.affine);
  refuse("field", name,
         "one of position, velocity, stress, volume, mass, plastic_strain, body_force, affine "
         "(with transfer apic), half_length (with ugimp and cpgimp), deformation_gradient (with "
         "cpgimp stretch or deformation_diagonal) with shape " +
             method_.shape);
}

FieldView Solver::watch(const std::string& name) {
  watched_ = true;
  return field(name);
}

/// Body forces take room, in points and nodes, from when one is first set or looked at.
void Solver::keep_body_forces() {
  if (!points().body_force.empty()) return;
  points().body_force = Field<double>(2, points().size);
  grid_.keep_body_forces();
  sorted_ = false;
}

template <class Out>
void Solver::copy_values(const std::string& name, std::span<Out> given) {
  if (name == "body_force" && points().body_force.empty()) {
    std::fill(given.begin(), given.end(), Out{});
    return;
  }
  const FieldView f = field(name);
  const std::int32_t* number = points_.number.data();
  together(*team_, [&](int thread) {
    const std::int64_t n = size();
    const auto begin = n * thread / threads(), end = n * (thread + 1) / threads();
    for (int c = 0; c < f.components; ++c) {
      const double* component = f.data + c * f.component_stride;
      Out* out = given.data() + c;
      for (std::int64_t k = begin; k < end; ++k)
        out[std::ptrdiff_t{f.components} * number[k]] =
            static_cast<Out>(component[k * f.point_stride]);
    }
  });
}

template void Solver::copy_values(const std::string& name, std::span<double> given);
template void Solver::copy_values(const std::string& name, std::span<float> given);

void Solver::set_values(const std::string& name, std::span<const double> values) {
  const bool settable = name == "position" || name == "velocity" || name == "stress" ||
                        name == "volume" || name == "plastic_strain" || name == "body_force" ||
                        name == "affine";
  require(settable, "field", name,
          "one of position, velocity, stress, volume, plastic_strain, body_force, affine");
  const int components =
      name == "body_force" ? 2 : field(name).components;  // before room is made for them
  check_values(values, static_cast<std::size_t>(components) * size(), name == "volume",
               name.c_str());
  if (name == "position") grid_.check_reach(values);
  if (name == "plastic_strain") {
    for (const double value : values)
      require(value >= 0.0, "plastic_strain", value, "zero or positive");
  }
  const FieldView f = field(name);
  for (int k = 0; k < size(); ++k)
    for (int c = 0; c < f.components; ++c)
      f.data[k * f.point_stride + c * f.component_stride] =
          values[static_cast<std::size_t>(f.components) * points_.number[k] + c];
  if (name == "velocity") {
    points_.affine.fill(0.0);  // that of the velocities before
    stopped_ = false;
  }
  if (name == "position") bodies_.take_shape(points_, half_length_, cell());
  if (name == "position" || name == "velocity") bodies_.take_motion(points_);
  single_loaded_ = energies_known_ = false;
  if (name != "body_force") nodes_ready_ = speeds_known_ = false;
  if (name == "position") sorted_ = false;
}

std::vector<std::int32_t> Solver::material_of_points() const {
  std::vector<std::int32_t> result(size());
  for (int k = 0; k < size(); ++k) result[points_.number[k]] = points_.material[k];
  return result;
}

}  // namespace gimpslope
