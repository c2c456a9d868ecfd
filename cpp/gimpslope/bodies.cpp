#include "bodies.hpp"

#include <algorithm>
#include <numeric>

namespace gimpslope {

Bodies::Bodies(std::span<const std::int32_t> number_of_point) {
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
  member_.resize(given_.size());
  for (auto& offset : offset_) offset.resize(given_.size());
  mass_.resize(numbers_.size());
  inertia_.resize(numbers_.size());
  states_.resize(numbers_.size());
  reports_.resize(numbers_.size());
  for (auto& values : exchange_) values.resize(number_of_point.size());
}

void Bodies::find(const Points& points) {
  std::vector<std::int32_t> place(points.size);
  for (int k = 0; k < points.size; ++k) place[points.number[k]] = k;
  std::transform(given_.begin(), given_.end(), member_.begin(),
                 [&](std::int32_t point) { return place[point]; });
}

void Bodies::take_shape(const Points& points) {
  find(points);
  const double* mass = points.mass[0];
  for (std::size_t b = 0; b < states_.size(); ++b) {
    BodyState& state = states_[b];
    double sum[2] = {}, inertia = 0.0;
    mass_[b] = 0.0;
    for (int k = begin_[b]; k < begin_[b + 1]; ++k) {
      mass_[b] += mass[member_[k]];
      for (int c = 0; c < 2; ++c) sum[c] += mass[member_[k]] * points.position[c][member_[k]];
    }
    for (int c = 0; c < 2; ++c) {
      state.centre[c] = sum[c] / mass_[b];
      for (int k = begin_[b]; k < begin_[b + 1]; ++k) {
        offset_[c][k] = points.position[c][member_[k]] - state.centre[c];
        inertia += mass[member_[k]] * offset_[c][k] * offset_[c][k];
      }
    }
    inertia_[b] = inertia;
    state.angle = 0.0;
  }
}

void Bodies::make_rigid(Points& points) {
  const double* mass = points.mass[0];
  double *vx = points.velocity[0], *vy = points.velocity[1];
  for (std::size_t b = 0; b < states_.size(); ++b) {
    BodyState& state = states_[b];
    double px = 0.0, py = 0.0, turn = 0.0;
    const auto from_centre = [&](int c, int k) {
      return points.position[c][member_[k]] - state.centre[c];
    };
    for (int k = begin_[b]; k < begin_[b + 1]; ++k) {
      const int m = member_[k];
      px += mass[m] * vx[m];
      py += mass[m] * vy[m];
      turn += mass[m] * (from_centre(0, k) * vy[m] - from_centre(1, k) * vx[m]);
    }
    state.velocity[0] = px / mass_[b];
    state.velocity[1] = py / mass_[b];
    state.spin = inertia_[b] > 0.0 ? turn / inertia_[b] : 0.0;
    for (int k = begin_[b]; k < begin_[b + 1]; ++k) {
      vx[member_[k]] = state.velocity[0] - state.spin * from_centre(1, k);
      vy[member_[k]] = state.velocity[1] + state.spin * from_centre(0, k);
    }
  }
}

void Bodies::reset_impulses() {
  for (BodyState& state : states_)
    state.impulse[0] = state.impulse[1] = state.angular_impulse = 0.0;
}

BodiesView Bodies::view() {
  return {static_cast<int>(states_.size()),
          begin_.data(),
          member_.data(),
          {offset_[0].data(), offset_[1].data()},
          mass_.data(),
          inertia_.data(),
          states_.data(),
          reports_.data(),
          {exchange_[0].data(), exchange_[1].data(), exchange_[2].data(), exchange_[3].data()}};
}

std::int64_t Bodies::bytes() const {
  std::int64_t total = sizeof(std::int32_t) * (given_.capacity() + member_.capacity()) +
                       sizeof(double) * (offset_[0].capacity() + offset_[1].capacity());
  for (const auto& values : exchange_) total += sizeof(double) * values.capacity();
  return total;
}

}  // namespace gimpslope
