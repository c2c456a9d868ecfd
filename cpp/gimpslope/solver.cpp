#include "solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <utility>

#include "error.hpp"

namespace gimpslope {
namespace {

constexpr int kStepsBetweenSorts = 50;
constexpr double kFastest = 1000.0;          // speed of a point, in wave speeds
constexpr double kTravelBetweenSorts = 0.5;  // cells; see kFarthestStep

/// The points share one half-length unless they were given different ones, follow the deformation,
/// or are wider than the common basis reaches.
bool own_domains(const InitialPoints& points, const Method& method, double cell) {
  if (method.shape == ShapeKind::linear) return false;
  const auto& l = points.half_length;
  return method.shape == ShapeKind::cpgimp || 2.0 * l.front() / cell > widest(Basis::gimp_common) ||
         std::any_of(l.begin(), l.end(), [&](double value) { return value != l.front(); });
}

bool keeps_deformation(const Method& method) {
  return method.domain_update == DomainUpdate::stretch ||
         method.domain_update == DomainUpdate::deformation_diagonal;
}

void check_values(std::span<const double> values, std::size_t count, bool positive,
                  const char* parameter) {
  require(values.size() == count, parameter, std::to_string(values.size()) + " values",
          (std::to_string(count) + " values").c_str());
  for (const double value : values) {
    require(std::isfinite(value), parameter, value, "finite");
    require(!positive || value > 0.0, parameter, value, "positive");
  }
}

void check(const InitialPoints& p, std::size_t materials, const Method& method) {
  const std::size_t n = p.position.size() / 2;
  require(n > 0 && n < (1u << 29), "position", std::to_string(n) + " points", "1 to 2^29 points");
  check_values(p.position, 2 * n, false, "position");
  check_values(p.velocity, 2 * n, false, "velocity");
  check_values(p.half_length, 2 * n, method.shape != ShapeKind::linear, "half_length");
  check_values(p.mass, n, true, "mass");
  check_values(p.volume, n, true, "volume");
  require(p.material.size() == n, "material", std::to_string(p.material.size()) + " values",
          (std::to_string(n) + " values").c_str());
  const std::string rule = "an index into the " + std::to_string(materials) + " materials";
  for (const int m : p.material)
    require(m >= 0 && static_cast<std::size_t>(m) < materials, "material", m, rule.c_str());
}

/// Room for the points, once they are known to be sound.
Points room_for(const InitialPoints& given, std::size_t materials, const Method& method,
                double cell) {
  check(given, materials, method);
  return Points(static_cast<int>(given.mass.size()), own_domains(given, method, cell),
                keeps_deformation(method));
}

const Method& checked(const Method& m) {
  const bool follows = m.domain_update != DomainUpdate::none;
  require((m.shape == ShapeKind::cpgimp) == follows, "domain_update", follows ? "given" : "none",
          "jacobian, stretch or deformation_diagonal with shape cpgimp, none with any other");
  const double b = m.blend.value;
  switch (m.blend.kind) {
    case Blend::Kind::alpha:
      require(b >= 0.0 && b <= 1.0, "alpha", b, "in [0, 1]");
      break;
    case Blend::Kind::viscosity:
      require(b >= 0.0 && std::isfinite(b), "viscosity", b, "zero or positive and finite, in m2/s");
      break;
    case Blend::Kind::relaxation_time:
      require(b > 0.0 && std::isfinite(b), "relaxation_time", b, "positive and finite, in s");
      break;
  }
  require(m.threads >= 1 && m.threads <= 1024, "threads", m.threads, "in [1, 1024]");
  return m;
}

std::vector<Law> laws_of(const std::vector<Material>& materials) {
  std::vector<Law> laws;
  for (const Material& material : materials) {
    material.check();
    laws.push_back(law(material));
  }
  return laws;
}

/// Elastic energy per volume, J/m3.
double strain_energy(const Material& m, const Stress& s) {
  const double mean = (s.xx + s.yy + s.zz) / 3.0;
  const double xx = s.xx - mean, yy = s.yy - mean, zz = s.zz - mean;
  const double j2 = 0.5 * (xx * xx + yy * yy + zz * zz) + s.xy * s.xy;
  return mean * mean / (2.0 * m.bulk_modulus()) + j2 / (2.0 * m.shear_modulus());
}

Stress stress_of(const Points& p, int k) {
  const double* s = p.stress.data() + k;
  return {s[0], s[p.size], s[2 * p.size], s[3 * p.size]};
}

}  // namespace

Solver::Solver(const InitialPoints& given, std::vector<Material> materials, double cell,
               std::array<double, 2> origin, const std::array<Wall, 4>& walls, const Method& method,
               InstructionSet instruction_set)
    : method_(checked(method)),
      instruction_set_(instruction_set),
      team_(std::make_unique<Team>(method.threads)),
      materials_(std::move(materials)),
      laws_(laws_of(materials_)),
      grid_(cell, origin[0], origin[1], walls),
      points_(room_for(given, laws_.size(), method, cell)) {
  fill(given);
  choose_kernel();
  set_time_step(method.time_step);
  prepare();
  alpha_of(time_step());
}

void Solver::fill(const InitialPoints& given) {
  for (int k = 0; k < points_.size; ++k) {
    for (int c = 0; c < 2; ++c) {
      points_.motion[4 * k + c] = given.position[2 * k + c];
      points_.motion[4 * k + 2 + c] = given.velocity[2 * k + c];
    }
    points_.mass[k] = given.mass[k];
    points_.volume[k] = given.volume[k];
    points_.material[k] = given.material[k];
  }
  if (method_.shape == ShapeKind::linear) return;
  const auto& l = given.half_length;
  half_length_ = std::accumulate(l.begin(), l.end(), 0.0) / static_cast<double>(l.size());
  width_ = 2.0 * *std::max_element(l.begin(), l.end()) / grid_.cell();
  if (points_.half_length.empty()) {
    half_length_ = l.front();
    return;
  }
  for (std::size_t k = 0; k < l.size(); ++k) {
    const bool jacobian = method_.domain_update == DomainUpdate::jacobian;
    points_.half_length[k] = l[k];
    points_.domain_reference[k] = jacobian ? l[k] / std::sqrt(given.volume[k / 2]) : l[k];
  }
}

/// The narrowest compiled basis that holds the widest domain.
void Solver::choose_kernel() {
  if (method_.shape == ShapeKind::linear) {
    basis_ = Basis::linear;
  } else if (points_.half_length.empty()) {
    basis_ = Basis::gimp_common;
  } else {
    basis_ = width_ <= widest(Basis::gimp_own) ? Basis::gimp_own : Basis::gimp_wide;
  }
  constexpr double rounding = 1.0 + 1e-12;
  require(width_ <= widest(basis_) * rounding || basis_ == Basis::linear, "half_length",
          0.5 * width_ * grid_.cell(), "at most 1.5 cells");
  kernel_ = find_kernel(instruction_set_, method_.scheme, basis_);
  sorted_ = nodes_ready_ = false;
}

void Solver::advance(std::int64_t steps) {
  require(steps >= 0, "steps", steps, "zero or positive");
  for (std::int64_t k = 0; k < steps; ++k) step(time_step());
}

bool Solver::advance_to(double time, std::int64_t most) {
  require(std::isfinite(time), "time", time, "finite, in s");
  constexpr double rounding = 1e-9;  // of a step
  for (std::int64_t k = 0; time_ < time; ++k) {
    const double dt = time_step(), left = time - time_;
    if (left <= rounding * dt) {
      time_ = time;
    } else if (k == most) {
      return false;
    } else {
      const bool shorten = method_.time_step.kind == TimeStep::Kind::courant && left < 2.0 * dt;
      step(shorten ? left / std::ceil(left / dt) : dt);
    }
  }
  return true;
}

void Solver::prepare() {
  if (!sorted_) {
    const int nodes = method_.shape == ShapeKind::cpgimp ? reach(Basis::gimp_wide) : reach(basis_);
    try {
      layout_ = arrange(points_, grid_, half_length_, nodes, static_cast<int>(laws_.size()));
    } catch (const std::invalid_argument& scattered) {
      if (steps_ == 0) throw;
      std::ostringstream message;
      message << "step " << steps_ << ", t = " << time_ << " s: " << scattered.what();
      throw Diverged(message.str(), steps_, time_, -1);
    }
    reports_.resize(layout_.slabs.size());
    travel_ = 0.0;
    steps_since_sort_ = 0;
    sorted_ = true;
    nodes_ready_ = false;
  }
  if (!nodes_ready_) {
    grid_.clear();
    kernel_.prepare(view());
    nodes_ready_ = true;
  }
}

void Solver::step(double dt) {
  prepare();
  const double share = alpha_of(dt);
  const double factor = gravity_.factor(time_ + dt);
  const bool courant = method_.time_step.kind == TimeStep::Kind::courant;
  kernel_.step(view(),
               {dt, share, gravity_.x * factor, gravity_.y * factor, damping_.local, courant},
               reports_.data());

  Report all;
  for (const Report& report : reports_) {
    all.travel = std::max(all.travel, report.travel);
    all.growth = std::max(all.growth, report.growth);
    all.width = std::max(all.width, report.width);
    if (report.lost >= 0) fail(report.lost, dt);
  }
  speeds_known_ = false;
  if (courant) gather_speeds();
  time_ += dt;
  ++steps_;
  travel_ += all.travel + all.growth;
  if (++steps_since_sort_ >= kStepsBetweenSorts || travel_ > kTravelBetweenSorts) sorted_ = false;
  if (method_.domain_update != DomainUpdate::none) follow_width(all.width);
  if (damping_.kinetic) damp_at_peak();
}

/// A point was refused its move: says which, and what is likely to have happened.
void Solver::fail(int lost, double dt) {
  sorted_ = nodes_ready_ = speeds_known_ = false;
  const double* motion = points_.motion.data() + 4 * lost;
  const Stress s = stress_of(points_, lost);
  const bool finite = std::isfinite(s.xx + s.yy + s.zz + s.xy + points_.volume[lost]);
  const double stable = stable_time_step();
  std::ostringstream message;
  message.precision(6);
  message << "step " << steps_ + 1 << ", t = " << time_ + dt << " s: point " << points_.number[lost]
          << " at (" << motion[0] << ", " << motion[1] << ") m "
          << (finite ? "would move or grow by more than half a cell in one step"
                     : "has a stress that is not finite")
          << "; likely cause: ";
  if (dt > stable) {
    message << "the time step of " << dt << " s is above the stable limit of " << stable << " s";
  } else {
    message << "speeds beyond the wave speed, an inverted domain, or points too far apart to share "
               "nodes (time step "
            << dt << " s, stable limit " << stable << " s)";
  }
  throw Diverged(message.str(), steps_ + 1, time_ + dt, points_.number[lost]);
}

/// Changes to the basis that the widest domain needs.
void Solver::follow_width(double width) {
  width_ = width;
  if (width_ > widest(Basis::gimp_wide)) {
    const auto& l = points_.half_length;
    const auto point = (std::max_element(l.begin(), l.end()) - l.begin()) / 2;
    std::ostringstream message;
    message << "step " << steps_ << ", t = " << time_ << " s: the domain of point "
            << points_.number[point] << " is " << width_
            << " cells wide, of 3 allowed; likely cause: shear or extension that domain_update "
               "stretch or deformation_diagonal follows without bound (jacobian does not)";
    throw Diverged(message.str(), steps_, time_, points_.number[point]);
  }
  const Basis needed = width_ > widest(Basis::gimp_own) ? Basis::gimp_wide : Basis::gimp_own;
  if (needed != basis_) choose_kernel();
}

void Solver::damp_at_peak() {
  const double kinetic = energies().kinetic;
  if (kinetic >= last_kinetic_) {
    last_kinetic_ = kinetic;
    return;
  }
  for (int k = 0; k < points_.size; ++k)
    points_.motion[4 * k + 2] = points_.motion[4 * k + 3] = 0.0;
  last_kinetic_ = 0.0;
  nodes_ready_ = speeds_known_ = false;
}

void Solver::set_gravity(const Gravity& gravity) {
  for (const double g : {gravity.x, gravity.y})
    require(std::isfinite(g), "gravity", g, "finite, in m/s2");
  require(gravity.ramp >= 0.0 && std::isfinite(gravity.ramp), "ramp", gravity.ramp,
          "zero or positive and finite, in s");
  gravity_ = gravity;
}

void Solver::set_damping(const Damping& damping) {
  require(damping.local >= 0.0 && damping.local < 1.0, "local", damping.local, "in [0, 1)");
  damping_ = damping;
  last_kinetic_ = 0.0;
}

void Solver::set_time_step(const TimeStep& step) {
  check_step(step, materials_);
  method_.time_step = step;
}

void Solver::check_step(const TimeStep& step, const std::vector<Material>& materials) const {
  const bool fixed = step.kind == TimeStep::Kind::fixed;
  const char* name = fixed ? "time_step" : "courant";
  require(step.value > 0.0 && std::isfinite(step.value), name, step.value, "positive and finite");
  if (fixed) alpha_of(step.value);
  const double limit = fixed ? stable_time_step_of(materials) : kCourantLimit;
  if (method_.allow_unstable || step.value <= limit) return;
  std::ostringstream rule;
  rule.precision(6);
  rule << "at most " << limit << (fixed ? " s" : "")
       << ", the stable limit of this scene, unless allow_unstable is set";
  refuse(name, step.value, rule.str());
}

void Solver::set_materials(std::vector<Material> materials) {
  require(materials.size() == materials_.size(), "materials",
          std::to_string(materials.size()) + " materials",
          ("a list of " + std::to_string(materials_.size())).c_str());
  std::vector<Law> laws = laws_of(materials);
  if (stable_time_step_of(materials) < stable_time_step()) check_step(method_.time_step, materials);
  laws_ = std::move(laws);
  materials_ = std::move(materials);
  speeds_known_ = false;
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
    released += points_.volume[k] * (strain_energy(materials_[material], before) -
                                     strain_energy(materials_[material], after));
  }
  return released;
}

void Solver::reset_clock() {
  time_ = 0.0;
  steps_ = 0;
  std::fill(points_.plastic_strain.begin(), points_.plastic_strain.end(), 0.0);
}

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
        points_.volume[k] * strain_energy(materials_[points_.material[k]], stress_of(points_, k));
  }
  sum.max_speed = std::sqrt(fastest);
  return sum;
}

double Solver::time_step() {
  if (method_.time_step.kind == TimeStep::Kind::fixed) return method_.time_step.value;
  prepare();
  if (!speeds_known_) {
    kernel_.measure_speeds(view(), reports_.data());
    gather_speeds();
  }
  const double wave = std::sqrt(speeds_.wave), point = std::sqrt(speeds_.point);
  if (point > kFastest * wave) {
    std::ostringstream message;
    message << "step " << steps_ + 1 << ", t = " << time_ << " s: a point moves at " << point
            << " m/s, more than " << kFastest << " times the wave speed of " << wave
            << " m/s; likely cause: a given velocity, or a force on a point without mass around it";
    throw Diverged(message.str(), steps_ + 1, time_, fastest_point());
  }
  return method_.time_step.value * grid_.cell() / (wave + point);
}

void Solver::gather_speeds() {
  speeds_ = {};
  for (const Report& report : reports_) {
    speeds_.point = std::max(speeds_.point, report.speeds.point);
    speeds_.wave = std::max(speeds_.wave, report.speeds.wave);
  }
  speeds_known_ = true;
}

int Solver::fastest_point() const {
  const auto square = [&](int k) {
    const double* m = points_.motion.data() + 4 * k;
    return m[2] * m[2] + m[3] * m[3];
  };
  int fastest = 0;
  for (int k = 1; k < points_.size; ++k)
    if (square(k) > square(fastest)) fastest = k;
  return points_.number[fastest];
}

double Solver::stable_time_step_of(const std::vector<Material>& materials) const {
  double fastest = 0.0;
  for (int k = 0; k < points_.size; ++k)
    fastest = std::max(fastest, materials[points_.material[k]].wave_modulus() * points_.volume[k] /
                                    points_.mass[k]);
  return kCourantLimit * grid_.cell() / std::sqrt(fastest);
}

double Solver::alpha_of(double dt) const {
  const double alpha = method_.blend.alpha(dt, grid_.cell(), half_length_);
  if (alpha <= 1.0) return alpha;
  const bool viscosity = method_.blend.kind == Blend::Kind::viscosity;
  std::ostringstream rule;
  rule << (viscosity ? "at most " : "at least ") << (viscosity ? method_.blend.value / alpha : dt)
       << (viscosity ? " m2/s" : " s") << " at a step of " << dt
       << " s, where the PIC share of a step reaches 1";
  refuse(viscosity ? "viscosity" : "relaxation_time", method_.blend.value, rule.str());
}

FieldView Solver::field(const std::string& name) {
  Points& p = points_;
  if (name == "position") return {p.motion.data(), 4, 1, 2};
  if (name == "velocity") return {p.motion.data() + 2, 4, 1, 2};
  if (name == "stress") return {p.stress.data(), 1, p.size, 4};
  if (name == "volume") return {p.volume.data(), 1, 1, 1};
  if (name == "mass") return {p.mass.data(), 1, 1, 1};
  if (name == "plastic_strain") return {p.plastic_strain.data(), 1, 1, 1};
  if (name == "half_length" && !p.half_length.empty()) return {p.half_length.data(), 2, 1, 2};
  if (name == "half_length" && method_.shape != ShapeKind::linear) return {&half_length_, 0, 0, 2};
  if (name == "deformation_gradient" && !p.deformation.empty())
    return {p.deformation.data(), 4, 1, 4};
  require(false, "field", name,
          "one of position, velocity, stress, volume, mass, plastic_strain, half_length (not with "
          "shape linear), deformation_gradient (with cpgimp stretch or deformation_diagonal)");
  return {};
}

std::vector<double> Solver::values(const std::string& name) {
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
                        name == "volume" || name == "plastic_strain";
  require(settable, "field", name, "one of position, velocity, stress, volume, plastic_strain");
  const FieldView f = field(name);
  check_values(values, static_cast<std::size_t>(f.components) * points_.size, name == "volume",
               name.c_str());
  for (int k = 0; k < points_.size; ++k)
    for (int c = 0; c < f.components; ++c)
      f.data[k * f.point_stride + c * f.component_stride] =
          values[static_cast<std::size_t>(f.components) * points_.number[k] + c];
  nodes_ready_ = speeds_known_ = false;
  if (name == "position") sorted_ = false;
}

std::vector<std::int32_t> Solver::material_of_points() const {
  std::vector<std::int32_t> result(points_.size);
  for (int k = 0; k < points_.size; ++k) result[points_.number[k]] = points_.material[k];
  return result;
}

std::int64_t Solver::bytes() const {
  return points_.bytes() + grid_.bytes() + layout_.blocks.capacity() * sizeof(Block);
}

View Solver::view() {
  return {points_.view(),
          grid_.view(),
          layout_.blocks.data(),
          layout_.slabs.data(),
          static_cast<int>(layout_.slabs.size()),
          laws_.data(),
          half_length_,
          method_.domain_update,
          method_.volume_update,
          team_.get()};
}

}  // namespace gimpslope
