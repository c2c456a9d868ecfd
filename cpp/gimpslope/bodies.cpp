#include "bodies.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gimpslope {

Bodies::Bodies(std::span<const std::int32_t> number_of_point, int threads) : threads_(threads) {
  std::vector<std::int32_t> order(number_of_point.size());
  std::iota(order.begin(), order.end(), 0);
  std::erase_if(order, [&](std::int32_t k) { return number_of_point[k] < 0; });
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return number_of_point[a] < number_of_point[b];
  });
  for (const std::int32_t point : order) {
    if (numbers_.empty() || numbers_.back() != number_of_point[point]) {
      numbers_.push_back(number_of_point[point]);
      begin_.push_back(static_cast<std::int32_t>(given_.size()));
    }
    given_.push_back(point);
  }
  begin_.push_back(static_cast<std::int32_t>(given_.size()));
  const std::size_t points = given_.size(), bodies = numbers_.size();
  member_.resize(points);
  for (int c = 0; c < 2; ++c) {
    offset_[c].resize(points);
    half_length_[c].resize(points);
  }
  for (auto* values : {&mass_, &inertia_, &radius_, &friction_, &mutual_friction_})
    values->resize(bodies);
  states_.resize(bodies);
  reports_.resize(bodies);
  held_.resize(bodies);
  reaches_.resize(bodies);
  window_at_.resize(2 * bodies);
  // Each of the walls in two places, and other bodies as a rule at most once a point.
  contacts_.resize(8 * bodies + points);
}

void Bodies::find(const Points& points) {
  std::vector<std::int32_t> place(points.size);
  for (int k = 0; k < points.size; ++k) place[points.number[k]] = k;
  std::transform(given_.begin(), given_.end(), member_.begin(),
                 [&](std::int32_t point) { return place[point]; });
}

void Bodies::take_shape(const Points& points, double half_length, double cell) {
  if (empty()) return;
  find(points);
  const double* mass = points.mass[0];
  double largest = 0.0;   // of a body
  std::int32_t most = 0;  // points of one
  widest_ = 0.0;
  for (std::size_t b = 0; b < states_.size(); ++b) {
    const int begin = begin_[b], end = begin_[b + 1];
    most = std::max(most, end - begin);
    BodyState& state = states_[b];
    double sum[2] = {};
    mass_[b] = inertia_[b] = radius_[b] = state.angle = 0.0;
    for (int k = begin; k < end; ++k) {
      const int m = member_[k];
      mass_[b] += mass[m];
      for (int c = 0; c < 2; ++c) {
        sum[c] += mass[m] * points.position[c][m];
        const double own = points.half_length.empty() ? half_length : points.half_length[c][m];
        widest_ = std::max(widest_, 2.0 * own);
        half_length_[c][k] = own > 0.0 ? own : 0.5 * std::sqrt(points.volume[0][m]);
      }
    }
    for (int c = 0; c < 2; ++c) state.centre[c] = sum[c] / mass_[b];
    for (int k = begin; k < end; ++k) {
      double square = 0.0, own = 0.0;  // squared distances from the centre, and of half a side
      for (int c = 0; c < 2; ++c) {
        offset_[c][k] = points.position[c][member_[k]] - state.centre[c];
        square += offset_[c][k] * offset_[c][k];
        own += half_length_[c][k] * half_length_[c][k];
      }
      inertia_[b] += mass[member_[k]] * (square + own / 3.0);
      radius_[b] = std::max(radius_[b], std::sqrt(square) + std::sqrt(own));
    }
    largest = std::max(largest, radius_[b]);
  }
  near_.resize(6 * static_cast<std::size_t>(most));
  // Shape functions reach two cells beyond a domain at most.
  window_ = 2 * static_cast<int>(std::ceil(largest / cell)) + 6;
  const std::size_t size = static_cast<std::size_t>(window_) * window_;
  nodes_.resize(states_.size() * size);
  meetings_.assign(states_.size() * size, Meeting::apart);
  shares_.resize(3 * threads_ * size);
}

void Bodies::take_friction(const Points& points, const std::vector<Material>& materials) {
  for (std::size_t b = 0; b < states_.size(); ++b) {
    const Material& material = materials[points.material[member_[begin_[b]]]];
    friction_[b] = material.interface_coefficient();
    mutual_friction_[b] = material.mutual_coefficient();
  }
}

bool Bodies::slide_on_soil() const {
  return std::any_of(friction_.begin(), friction_.end(), [](double mu) { return mu >= 0.0; });
}

void Bodies::take_motion(Points& points) {
  if (empty()) return;
  find(points);
  const double* mass = points.mass[0];
  double *vx = points.velocity[0], *vy = points.velocity[1];
  for (std::size_t b = 0; b < states_.size(); ++b) {
    BodyState& state = states_[b];
    double px = 0.0, py = 0.0, turn = 0.0, of_places = 0.0;
    const auto arm = [&](int c, int k) {
      return points.position[c][member_[k]] - state.centre[c];
    };
    for (int k = begin_[b]; k < begin_[b + 1]; ++k) {
      const int m = member_[k];
      px += mass[m] * vx[m];
      py += mass[m] * vy[m];
      turn += mass[m] * (arm(0, k) * vy[m] - arm(1, k) * vx[m]);
      of_places += mass[m] * (arm(0, k) * arm(0, k) + arm(1, k) * arm(1, k));
    }
    state.velocity[0] = px / mass_[b];
    state.velocity[1] = py / mass_[b];
    state.spin = of_places > 0.0 ? turn / of_places : 0.0;
    reports_[b].speed = 0.0;  // until the next step; points are looked at before that
    for (int k = begin_[b]; k < begin_[b + 1]; ++k) {
      vx[member_[k]] = state.velocity[0] - state.spin * arm(1, k);
      vy[member_[k]] = state.velocity[1] + state.spin * arm(0, k);
    }
  }
}

void Bodies::stop() {
  for (std::size_t b = 0; b < states_.size(); ++b) {
    BodyState& state = states_[b];
    for (int c = 0; c < 2; ++c) {
      state.impulse[c] -= mass_[b] * state.velocity[c];
      state.velocity[c] = 0.0;
    }
    state.angular_impulse -= inertia_[b] * state.spin;
    state.spin = 0.0;
    reports_[b].speed = 0.0;
  }
}

void Bodies::reset_impulses() {
  for (BodyState& state : states_)
    state.impulse[0] = state.impulse[1] = state.angular_impulse = 0.0;
  interfaces_unsettled_ = contacts_unsettled_ = {};
}

void Bodies::count_unsettled(double dt, double nothing) {
  const auto count = [&](Unsettled& all, double speed) {
    const double moved = dt * speed;
    if (!(moved > nothing)) return;
    ++all.steps;
    all.largest = std::max(all.largest, moved);
    all.sum += moved;
  };
  double left = 0.0;
  for (const HeldBody& held : held_) left = std::max(left, held.unsettled);
  count(interfaces_unsettled_, left);
  count(contacts_unsettled_, contacts_left_);
}

double Bodies::kinetic_energy() const {
  double sum = 0.0;
  for (std::size_t b = 0; b < states_.size(); ++b) {
    const BodyState& s = states_[b];
    const double square = s.velocity[0] * s.velocity[0] + s.velocity[1] * s.velocity[1];
    sum += 0.5 * (mass_[b] * square + inertia_[b] * s.spin * s.spin);
  }
  return sum;
}

double Bodies::potential_energy(double gravity_x, double gravity_y) const {
  double sum = 0.0;
  for (std::size_t b = 0; b < states_.size(); ++b)
    sum -= mass_[b] * (gravity_x * states_[b].centre[0] + gravity_y * states_[b].centre[1]);
  return sum;
}

double Bodies::momentum() const {
  double sum = 0.0;
  for (std::size_t b = 0; b < states_.size(); ++b)
    sum += mass_[b] * std::hypot(states_[b].velocity[0], states_[b].velocity[1]) +
           inertia_[b] * std::abs(states_[b].spin) / radius_[b];
  return sum;
}

double Bodies::largest_speed(const Points& points) const {
  double square = 0.0;
  for (const int m : member_) square = std::max(square, squared_speed(points, m));
  return std::sqrt(square);
}

/// Bodies whose circles come so near each other, in order.
void Bodies::find_pairs(double within) {
  pairs_.clear();
  for (std::int32_t a = 0; a < static_cast<std::int32_t>(states_.size()); ++a) {
    for (std::int32_t b = a + 1; b < static_cast<std::int32_t>(states_.size()); ++b) {
      const double *p = states_[a].centre, *q = states_[b].centre;
      if (std::hypot(p[0] - q[0], p[1] - q[1]) < radius_[a] + radius_[b] + within)
        pairs_.insert(pairs_.end(), {a, b});
    }
  }
}

BodiesView Bodies::view(const Points& points, std::size_t nodes, double travel) {
  find(points);
  find_pairs(2.0 * travel);
  owner_.assign(nodes, -1);
  return {static_cast<int>(states_.size()),
          begin_.data(),
          member_.data(),
          {offset_[0].data(), offset_[1].data()},
          {half_length_[0].data(), half_length_[1].data()},
          mass_.data(),
          inertia_.data(),
          radius_.data(),
          friction_.data(),
          mutual_friction_.data(),
          states_.data(),
          reports_.data(),
          held_.data(),
          nodes_.data(),
          reaches_.data(),
          window_,
          shares_.data(),
          owner_.data(),
          pairs_.data(),
          static_cast<int>(pairs_.size() / 2),
          near_.data(),
          static_cast<int>(near_.size() / 6),
          meetings_.data(),
          window_at_.data(),
          contacts_.data(),
          static_cast<int>(contacts_.size()),
          &contact_count_,
          &contacts_missed_,
          &contacts_left_};
}

std::int64_t Bodies::bytes() const {
  return sizeof(double) * (4 * given_.size() + shares_.size() + near_.size()) +
         sizeof(BodyNode) * nodes_.size() + sizeof(Meeting) * meetings_.size() +
         sizeof(Contact) * contacts_.size() +
         sizeof(std::int32_t) * (2 * given_.size() + owner_.size() + pairs_.capacity());
}

}  // namespace gimpslope
