// What a solver tells of its points, and what it lets others set.
#include <algorithm>
#include <cmath>
#include <string>

#include "checks.hpp"
#include "error.hpp"
#include "solver.hpp"

namespace gimpslope {
namespace {

/// Elastic energy a volume, J/m3.
double strain_energy(const Law& law, const Stress& s) {
  return 0.5 * product(compliance_of(law.drucker_prager.elastic), s, s);
}

Stress stress_of(const Points& p, int k) {
  const double* s = p.stress.data() + k;
  return {s[0], s[p.size], s[2 * p.size], s[3 * p.size]};
}

}  // namespace

Energies Solver::energies() const {
  Energies sum{};
  double fastest = 0.0;
  for (int k = 0; k < points_.size; ++k) {
    const double* m = points_.motion.data() + 4 * k;
    const double square = m[2] * m[2] + m[3] * m[3];
    fastest = std::max(fastest, square);
    sum.kinetic += 0.5 * points_.mass[k] * square;
    sum.potential -= points_.mass[k] * (gravity_.x * m[0] + gravity_.y * m[1]);
    sum.elastic +=
        points_.volume[k] * strain_energy(laws_[points_.material[k]], stress_of(points_, k));
  }
  sum.max_speed = std::sqrt(fastest);
  return sum;
}

double Solver::kinetic_energy() const {
  double sum = 0.0;
  for (int k = 0; k < points_.size; ++k) {
    const double* m = points_.motion.data() + 4 * k;
    sum += 0.5 * points_.mass[k] * (m[2] * m[2] + m[3] * m[3]);
  }
  return sum;
}

double Solver::release_stress() {
  double released = 0.0;
  for (int k = 0; k < points_.size; ++k) {
    const int material = points_.material[k];
    if (laws_[material].kind != LawKind::drucker_prager) continue;
    const Stress before = stress_of(points_, k);
    Stress after = before;
    return_to_surface(laws_[material].drucker_prager, after, points_.plastic_strain[k]);
    double* s = points_.stress.data() + k;
    s[0] = after.xx;
    s[points_.size] = after.yy;
    s[2 * points_.size] = after.zz;
    s[3 * points_.size] = after.xy;
    released += points_.volume[k] *
                (strain_energy(laws_[material], before) - strain_energy(laws_[material], after));
  }
  ledger_.plastic += released;
  return released;
}

Ledger Solver::ledger() const {
  require(method_.ledger, "method", "one without a ledger",
          "one that keeps a ledger, Method(ledger=True)");
  return ledger_;
}

FieldView Solver::field(const std::string& name) {
  Points& p = points_;
  if (name == "position") return {p.motion.data(), 4, 1, 2};
  if (name == "velocity") return {p.motion.data() + 2, 4, 1, 2};
  if (name == "stress") return {p.stress.data(), 1, p.size, 4};
  if (name == "volume") return {p.volume.data(), 1, 1, 1};
  if (name == "mass") return {p.mass.data(), 1, 1, 1};
  if (name == "plastic_strain") return {p.plastic_strain.data(), 1, 1, 1};
  if (name == "body_force") {
    keep_body_forces();
    return {p.body_force.data(), 2, 1, 2};
  }
  if (name == "half_length" && !p.half_length.empty()) return {p.half_length.data(), 2, 1, 2};
  if (name == "half_length" && method_.shape != ShapeKind::linear) return {&half_length_, 0, 0, 2};
  if (name == "deformation_gradient" && !p.deformation.empty())
    return {p.deformation.data(), 4, 1, 4};
  require(false, "field", name,
          "one of position, velocity, stress, volume, mass, plastic_strain, body_force, "
          "half_length (not with shape linear), deformation_gradient (with cpgimp stretch or "
          "deformation_diagonal)");
  return {};
}

/// Body forces take room, in points and nodes, from when one is first set or looked at.
void Solver::keep_body_forces() {
  if (!points_.body_force.empty()) return;
  points_.body_force.assign(2 * static_cast<std::size_t>(points_.size), 0.0);
  grid_.keep_body_forces();
  sorted_ = false;
}

std::vector<double> Solver::values(const std::string& name) {
  if (name == "body_force" && points_.body_force.empty())
    return std::vector<double>(2 * static_cast<std::size_t>(points_.size), 0.0);
  const FieldView f = field(name);
  std::vector<double> result(static_cast<std::size_t>(f.components) * points_.size);
  for (int k = 0; k < points_.size; ++k)
    for (int c = 0; c < f.components; ++c)
      result[static_cast<std::size_t>(f.components) * points_.number[k] + c] =
          f.data[k * f.point_stride + c * f.component_stride];
  return result;
}

void Solver::set_values(const std::string& name, std::span<const double> values) {
  const bool settable = name == "position" || name == "velocity" || name == "stress" ||
                        name == "volume" || name == "plastic_strain" || name == "body_force";
  require(settable, "field", name,
          "one of position, velocity, stress, volume, plastic_strain, body_force");
  check_values(values, static_cast<std::size_t>(field(name).components) * points_.size,
               name == "volume", name.c_str());
  if (name == "position") grid_.check_reach(values);
  if (name == "plastic_strain") {
    for (const double value : values)
      require(value >= 0.0, "plastic_strain", value, "zero or positive");
  }
  const FieldView f = field(name);
  for (int k = 0; k < points_.size; ++k)
    for (int c = 0; c < f.components; ++c)
      f.data[k * f.point_stride + c * f.component_stride] =
          values[static_cast<std::size_t>(f.components) * points_.number[k] + c];
  if (name != "body_force") nodes_ready_ = speeds_known_ = false;
  if (name == "position") sorted_ = false;
}

std::vector<std::int32_t> Solver::material_of_points() const {
  std::vector<std::int32_t> result(points_.size);
  for (int k = 0; k < points_.size; ++k) result[points_.number[k]] = points_.material[k];
  return result;
}

}  // namespace gimpslope
