#include "solver.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "checks.hpp"
#include "error.hpp"
#include "ledger.hpp"
#include "shape/traits.hpp"
#include "travel.hpp"

namespace gimpslope {
namespace {

constexpr int kStepsBetweenSorts = 100;
constexpr double kFastest = 1000.0;  // speed of a point, in wave speeds

/// The points share one half-length unless they were given different ones, follow the deformation,
/// or are too wide to be shared.
bool own_domains(const InitialPoints& points, const Method& method, double cell) {
  if (!has_domains(method.shape)) return false;
  const auto& l = points.half_length;
  return method.domain_update != DomainUpdate::none || 2.0 * l.front() / cell > kWidestCommon ||
         std::any_of(l.begin(), l.end(), [&](double value) { return value != l.front(); });
}

bool keeps_deformation(const Method& method) {
  return method.domain_update == DomainUpdate::stretch ||
         method.domain_update == DomainUpdate::deformation_diagonal;
}

/// Room for the points, once they are known to be sound.
Points room_for(const InitialPoints& given, const std::vector<Material>& materials,
                const Method& method, double cell) {
  check(given, materials, method.shape);
  return Points(static_cast<int>(given.mass.size()), own_domains(given, method, cell),
                keeps_deformation(method), method.transfer == Transfer::apic);
}

}  // namespace

Solver::Solver(const InitialPoints& given, std::vector<Material> materials, double cell,
               std::array<double, 2> origin, const std::array<Wall, 4>& walls, const Method& method,
               InstructionSet instruction_set)
    : method_((check(method), method)),
      instruction_set_(instruction_set),
      team_(std::make_unique<Team>(method.threads)),
      materials_(std::move(materials)),
      laws_(laws_of(materials_)),
      grid_(cell, origin[0], origin[1], walls),
      points_(room_for(given, materials_, method, cell)),
      bodies_(bodies_of(given)) {
  fill(given);
  bodies_.take_shape(points_, half_length_, cell);
  bodies_.take_motion(points_);
  bodies_.take_friction(points_, materials_);
  if (bodies_.slide_on_soil()) grid_.keep_soil();
  if (method_.volumetric_strain == VolumetricStrain::cell_average) grid_.keep_cells();
  if (method_.transfer == Transfer::xpic && method_.order > 1) grid_.keep_terms();
  if (method_.precision == Precision::single) single_ = std::make_unique<SinglePoints>();
  choose_kernel();
  prepare();
  set_time_step(method.time_step);
}

void Solver::fill(const InitialPoints& given) {
  for (int k = 0; k < points_.size; ++k) {
    for (int c = 0; c < 2; ++c) {
      points_.position[c][k] = given.position[2 * k + c];
      points_.velocity[c][k] = given.velocity[2 * k + c];
    }
    points_.mass[0][k] = given.mass[k];
    points_.volume[0][k] = given.volume[k];
    points_.material[k] = given.material[k];
  }
  if (!has_domains(method_.shape)) return;
  const auto& l = given.half_length;
  half_length_ = std::accumulate(l.begin(), l.end(), 0.0) / static_cast<double>(l.size());
  width_ = 2.0 * *std::max_element(l.begin(), l.end()) / grid_.cell();
  if (points_.half_length.empty()) {
    half_length_ = l.front();
    return;
  }
  const bool jacobian = method_.domain_update == DomainUpdate::jacobian;
  for (int k = 0; k < points_.size; ++k) {
    for (int c = 0; c < 2; ++c) {
      const double own = l[2 * k + c];
      points_.half_length[c][k] = own;
      points_.domain_reference[c][k] = jacobian ? own / std::sqrt(given.volume[k]) : own;
    }
  }
}

/// The stones of rigid material.
Bodies Solver::bodies_of(const InitialPoints& given) const {
  const auto is_rigid = [](const Material& material) {
    return material.law == LawKind::rigid;
  };
  if (std::none_of(materials_.begin(), materials_.end(), is_rigid)) return {};
  std::vector<std::int32_t> body(given.stone.begin(), given.stone.end());
  std::vector<std::int32_t> deformable;  // stones
  for (std::size_t k = 0; k < body.size(); ++k) {
    if (is_rigid(materials_[given.material[k]])) continue;
    deformable.push_back(body[k]);
    body[k] = -1;
  }
  std::sort(deformable.begin(), deformable.end());
  for (const std::int32_t number : body)
    require(number < 0 || !std::binary_search(deformable.begin(), deformable.end(), number),
            "stone", number, "a stone of one material where that is rigid");
  require(method_.precision == Precision::double_, "precision", "single",
          "double with rigid stones");
  require(method_.transfer == Transfer::flip, "transfer",
          method_.transfer == Transfer::apic ? "apic" : "xpic", "flip with rigid stones");
  require(method_.scheme == SchemeKind::usf, "scheme",
          method_.scheme == SchemeKind::usl ? "usl" : "musl", "usf with rigid stones");
  return Bodies(body, method_.threads);
}

/// The narrowest compiled basis that holds the widest domain.
void Solver::choose_kernel() {
  basis_ = {find_shape(method_.shape, width_), !points_.half_length.empty()};
  const double allowed = traits(basis_.shape).widest;
  constexpr double rounding = 1.0 + 1e-12;
  require(width_ <= allowed * rounding, "half_length", 0.5 * width_ * grid_.cell(),
          ("at most " + text(0.5 * allowed) + " cells").c_str());
  kernel_ = find_kernel<double>(instruction_set_, method_.scheme, basis_);
  single_kernel_ = find_kernel<float>(instruction_set_, method_.scheme, basis_);
  sorted_ = nodes_ready_ = false;
}

void Solver::advance(std::int64_t steps) {
  require(steps >= 0, "steps", steps, "zero or positive");
  forget_known();
  for (std::int64_t k = 0; k < steps; ++k) {
    const double dt = time_step();
    step(dt, dt);
  }
  if (watched_) points();
}

bool Solver::advance_to(double time, std::int64_t most) {
  forget_known();
  return go_on_to(time, most);
}

/// `advance_to` while what is known of the blocks still holds.
bool Solver::go_on_to(double time, std::int64_t most) {
  require(std::isfinite(time), "time", time, "finite, in s");
  constexpr double rounding = 1e-6;  // of a step
  for (std::int64_t k = 0; time_ < time; ++k) {
    const double dt = time_step(), left = time - time_;
    if (left <= rounding * dt) {
      time_ = time;
      time_carry_ = 0.0;
    } else if (k == most) {
      break;
    } else {
      const bool shorten = method_.time_step.kind == TimeStep::Kind::courant && left < 2.0 * dt;
      const double share = shorten ? left / std::ceil(left / dt) : dt;
      step(share, dt, time_ + share >= time - rounding * dt);
    }
  }
  if (watched_) points();
  return time_ >= time;
}

bool Solver::advance_through(std::span<const double> times, std::int64_t most,
                             std::vector<Row>& rows) {
  const std::int64_t last = steps_ + most;
  forget_known();
  for (const double time : times) {
    if (time <= time_) continue;
    if (!go_on_to(time, last - steps_)) return false;
    rows.push_back({time_, steps_, energies(), ledger_, bodies_.states()});
  }
  return true;
}

/// What was known of blocks is not any more: there are others, or stresses, volumes and materials
/// may have been set.
void Solver::forget_known() { known_.assign(layout_.blocks.size(), {}); }

/// Calls act(kernel, view) for the precision in which the points are stepped.
template <class Act>
void Solver::with_kernel(Act act) {
  if (single_) {
    act(single_kernel_, view_of(single_->view()));
  } else {
    act(kernel_, view_of(points_.view()));
  }
}

template <class Real>
View<Real> Solver::view_of(const PointsView<Real>& points) {
  return {points,
          grid_.view(),
          layout_.blocks.data(),
          known_.data(),
          gradients_.data(),
          layout_.slabs.data(),
          static_cast<int>(layout_.slabs.size()),
          layout_.shared.data(),
          layout_.shares.data(),
          laws_.data(),
          half_length_,
          method_.domain_update,
          method_.volume_update,
          bodies_.empty() ? nullptr : &bodies_view_,
          team_.get(),
          method_.ledger ? ledger_rows_.data() : nullptr,
          &seconds_};
}

template View<double> Solver::view_of(const PointsView<double>& points);

void Solver::prepare() {
  if (!sorted_) {
    Stopwatch watch(&seconds_);
    const bool follows = method_.domain_update != DomainUpdate::none;
    const int shape = follows ? find_shape(method_.shape) : basis_.shape;
    try {
      layout_ = arrange(points(), grid_, traits(shape), half_length_,
                        static_cast<int>(laws_.size()), method_.threads);
    } catch (const std::invalid_argument& scattered) {
      if (steps_ == 0) throw;
      fail(scattered.what(), -1);
    }
    stable_at_sort_ = stable_time_step();
    reports_.resize(layout_.slabs.size());
    team_->resize(static_cast<int>(layout_.slabs.size()));
    forget_known();
    if (method_.ledger) ledger_rows_.resize(grid_.rows());
    if (grid_.view().cells != nullptr) gradients_.resize(layout_.blocks.size());
    if (!bodies_.empty()) {
      const GridView grid = grid_.view();
      bodies_view_ = bodies_.view(
          points_, static_cast<std::size_t>(grid.stride) * static_cast<std::size_t>(grid.rows),
          (kTravelBetweenSorts + kFarthestStep) * grid_.cell());
    }
    travel_ = 0.0;
    steps_since_sort_ = 0;
    sorted_ = true;
    nodes_ready_ = single_loaded_ = false;
    watch.lap(&Seconds::sort);
  }
  if (single_ && !single_loaded_) {
    const ShapeTraits& widest = traits(find_shape(method_.shape));
    single_->load(points(), grid_.view(), 0.5 * widest.widest + widest.behind + kMargin);
    single_loaded_ = true;
  }
  if (!nodes_ready_) {
    grid_.clear();
    with_kernel([](const auto& kernel, const auto& view) { kernel.prepare(view); });
    nodes_ready_ = true;
  }
}

/// A step of dt, which may be shorter than the `whole` one: its PIC share is less in proportion, so
/// that the times at which a run is looked at do not change how it is damped.
void Solver::step(double dt, double whole, bool wants_energies) {
  if (!failure_.empty()) throw Diverged(failure_, steps_ + 1, time_, -1);
  prepare();
  energies_known_ = false;
  const bool blended = method_.transfer == Transfer::flip;
  const double share = blended ? alpha_of(whole) * (dt / whole) : 1.0;
  if (!(share <= 1.0))
    fail("the step of " + text(dt) + " s is too long for the velocity blend", -1);
  const double factor = gravity_.factor(time_ + dt);
  const bool courant = method_.time_step.kind == TimeStep::Kind::courant;
  const StepInput input{dt,
                        share,
                        gravity_.x * factor,
                        gravity_.y * factor,
                        gravity_.x,
                        gravity_.y,
                        damping_.local,
                        method_.order,
                        method_.scheme != SchemeKind::usf,
                        courant,
                        wants_energies};
  with_kernel(
      [&](const auto& kernel, const auto& view) { kernel.step(view, input, reports_.data()); });
  single_ahead_ = single_ != nullptr;
  if (std::exchange(stopped_, false)) unbalanced_force_ = force_from_rest(dt);

  Report all;
  for (const Report& report : reports_) {
    all.travel = std::max(all.travel, report.travel);
    all.growth = std::max(all.growth, report.growth);
    all.width = std::max(all.width, report.width);
    if (report.lost >= 0) fail_at(report.lost, dt);
  }
  for (const BodyReport& report : bodies_.reports()) {
    all.travel = std::max(all.travel, report.travel / grid_.cell());
    if (method_.ledger) add(report.ledger, ledger_);
    if (report.lost >= 0) fail_at(report.lost, dt);
  }
  if (bodies_.contacts_missed()) fail("rigid stones overlap in more places than can be told", -1);
  bodies_.count_unsettled(dt, kStill * grid_.cell());
  if (method_.ledger) {
    for (const Report& report : reports_) add(report.ledger, ledger_);
    for (const Ledger& row : ledger_rows_) add(row, ledger_);
  }
  if (wants_energies && !single_) {
    energies_ = gather_energies();
    energies_known_ = true;
  }
  speeds_known_ = false;
  if (courant) gather_speeds();
  const double added = dt - time_carry_, later = time_ + added;  // Kahan's sum
  time_carry_ = (later - time_) - added;
  time_ = later;
  ++steps_;
  travel_ += all.travel + all.growth;
  if (++steps_since_sort_ >= kStepsBetweenSorts || travel_ > kTravelBetweenSorts) sorted_ = false;
  if (method_.domain_update != DomainUpdate::none)
    follow_width(std::max(all.width, bodies_.widest() / grid_.cell()));
  if (damping_.kinetic) damp_at_peak();
}

/// Changes to the basis that the widest domain needs.
void Solver::follow_width(double width) {
  width_ = width;
  const double allowed = traits(find_shape(method_.shape)).widest;
  if (width_ > allowed) fail_too_wide(allowed);
  if (find_shape(method_.shape, width_) != basis_.shape) choose_kernel();
}

void Solver::damp_at_peak() {
  const double kinetic = kinetic_energy();
  if (kinetic >= last_kinetic_) {
    last_kinetic_ = kinetic;
    return;
  }
  stop();
  stopped_ = true;
}

/// After a step of dt from rest: what the forces made of it, a reaction of the walls included. The
/// step has moved the nodes' mass by next to nothing.
double Solver::force_from_rest(double dt) {
  const GridView g = grid_.view();
  double sum = 0.0;
  for (int row = 0; row < g.rows; ++row)
    for (int i = g.active[row].begin; i < g.active[row].end; ++i) {
      const std::ptrdiff_t node = 4 * (static_cast<std::ptrdiff_t>(row) * g.stride + i);
      sum += g.momentum[node] * std::hypot(g.update[node], g.update[node + 1]) / (dt * dt);
    }
  return sum + bodies_.momentum() / dt;
}

double Solver::time_step() {
  if (method_.time_step.kind == TimeStep::Kind::fixed) return method_.time_step.value;
  prepare();
  if (!speeds_known_) {
    with_kernel([&](const auto& kernel, const auto& view) {
      kernel.measure_speeds(view, reports_.data());
    });
    gather_speeds();
  }
  const double wave = std::sqrt(speeds_.wave), point = std::sqrt(speeds_.point);
  if (point > kFastest * wave) {
    fail("a point moves at " + text(point) + " m/s, more than " + text(kFastest) +
             " times the wave speed of " + text(wave) +
             " m/s; likely cause: a given velocity, or a force on a point without mass around it",
         points_.number[fastest_point()]);
  }
  return method_.time_step.value * grid_.cell() / (wave + point);
}

void Solver::gather_speeds() {
  speeds_ = {};
  for (const Report& report : reports_) {
    speeds_.point = std::max(speeds_.point, report.speeds.point);
    speeds_.wave = std::max(speeds_.wave, report.speeds.wave);
  }
  for (const BodyReport& report : bodies_.reports())
    speeds_.point = std::max(speeds_.point, report.speed * report.speed);
  speeds_known_ = true;
}

std::int64_t Solver::bytes() const {
  return points_.bytes() + bodies_.bytes() + (single_ ? single_->bytes() : 0) + grid_.bytes() +
         layout_.blocks.capacity() * (sizeof(Block) + sizeof(Known)) +
         gradients_.capacity() * sizeof(Gradient);
}

/// The points as they are now.
const Points& Solver::points() const {
  if (single_ahead_) single_->store(points_, method_.domain_update != DomainUpdate::none);
  single_ahead_ = false;
  return points_;
}

Points& Solver::points() {
  std::as_const(*this).points();
  return points_;
}

}  // namespace gimpslope
