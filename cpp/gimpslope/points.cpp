#include "points.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gimpslope {
namespace {

template <class T>
void permute(T* data, const std::vector<std::int32_t>& order, Buffer<T>& scratch) {
  T* sorted = scratch.data();
  for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = data[order[k]];
  std::copy_n(sorted, order.size(), data);
}

template <class Real>
std::ptrdiff_t whole_lines(std::ptrdiff_t n) {
  constexpr std::ptrdiff_t line = kCacheLine / sizeof(Real);
  return (n + line - 1) / line * line;
}

}  // namespace

template <class Real>
Field<Real>::Field(int components, int points)
    : components_(components), stride_(whole_lines<Real>(points)), values_(components * stride_) {}

template <class Real>
std::array<Field<Real>*, 11> State<Real>::fields() {
  return {&position,    &velocity,         &stress,      &volume, &mass,      &plastic_strain,
          &half_length, &domain_reference, &deformation, &affine, &body_force};
}

template <class Real>
std::array<const Field<Real>*, 11> State<Real>::fields() const {
  return {&position,    &velocity,         &stress,      &volume, &mass,      &plastic_strain,
          &half_length, &domain_reference, &deformation, &affine, &body_force};
}

template <class Real>
PointsView<Real> State<Real>::view() {
  return {position[0],
          position[1],
          velocity[0],
          velocity[1],
          stress[0],
          stress[1],
          stress[2],
          stress[3],
          volume[0],
          plastic_strain[0],
          mass[0],
          {half_length[0], half_length[1]},
          {domain_reference[0], domain_reference[1]},
          {deformation[0], deformation[1], deformation[2], deformation[3]},
          {affine[0], affine[1], affine[2], affine[3]},
          {body_force[0], body_force[1]},
          nullptr};
}

template <class Real>
std::int64_t State<Real>::bytes() const {
  std::int64_t total = 0;
  for (const Field<Real>* field : fields()) total += field->bytes();
  return total;
}

template class Field<double>;
template class Field<float>;
template struct State<double>;
template struct State<float>;

Points::Points(int n, bool own_domains, bool with_deformation, bool with_affine)
    : size(n), material(n), number(n), scratch_(n), integer_scratch_(n) {
  for (Field<double>* pair : {&position, &velocity}) *pair = Field<double>(2, n);
  stress = Field<double>(4, n);
  for (Field<double>* scalar : {&volume, &mass, &plastic_strain}) *scalar = Field<double>(1, n);
  if (own_domains) half_length = domain_reference = Field<double>(2, n);
  if (with_deformation) {
    deformation = Field<double>(4, n);
    std::fill_n(deformation[0], n, 1.0);
    std::fill_n(deformation[3], n, 1.0);
  }
  if (with_affine) affine = Field<double>(4, n);
  std::iota(number.begin(), number.end(), 0);
}

void Points::reorder(const std::vector<std::int32_t>& order) {
  for (Field<double>* field : fields())
    for (int c = 0; c < field->components(); ++c) permute((*field)[c], order, scratch_);
  permute(material.data(), order, integer_scratch_);
  permute(number.data(), order, integer_scratch_);
}

std::int64_t Points::bytes() const {
  return State::bytes() + sizeof(double) * scratch_.capacity() +
         sizeof(std::int32_t) *
             (material.capacity() + number.capacity() + integer_scratch_.capacity());
}

void SinglePoints::load(const Points& points, const GridView& window, double reach) {
  const int n = points.size;
  origin_[0] = window.left;
  origin_[1] = window.bottom;
  cell_ = window.cell;
  stride_ = window.stride;
  home_.resize(n);
  const int back = static_cast<int>(std::ceil(reach));
  for (int k = 0; k < n; ++k) {
    const int column = static_cast<int>((points.position[0][k] - origin_[0]) / cell_) - back;
    const int row = static_cast<int>((points.position[1][k] - origin_[1]) / cell_) - back;
    home_[k] = std::max(row, 0) * stride_ + std::max(column, 0);
  }
  const auto from = points.fields();
  const auto to = state_.fields();
  for (std::size_t f = 0; f < from.size(); ++f) {
    if (to[f]->components() != from[f]->components())
      *to[f] = Field<float>(from[f]->components(), n);
    for (int c = 0; c < from[f]->components(); ++c) std::copy_n((*from[f])[c], n, (*to[f])[c]);
  }
  for (int axis = 0; axis < 2; ++axis)
    for (int k = 0; k < n; ++k)
      state_.position[axis][k] = static_cast<float>(points.position[axis][k] - node(axis, k));
}

void SinglePoints::store(Points& points, bool domains_follow) const {
  const auto copy = [&](const Field<float>& from, Field<double>& to) {
    for (int c = 0; c < from.components(); ++c) std::copy_n(from[c], points.size, to[c]);
  };
  copy(state_.position, points.position);
  copy(state_.velocity, points.velocity);
  copy(state_.stress, points.stress);
  copy(state_.volume, points.volume);
  copy(state_.plastic_strain, points.plastic_strain);
  copy(state_.deformation, points.deformation);
  copy(state_.affine, points.affine);
  if (domains_follow) copy(state_.half_length, points.half_length);
  for (int axis = 0; axis < 2; ++axis)
    for (int k = 0; k < points.size; ++k) points.position[axis][k] += node(axis, k);
}

double SinglePoints::node(int axis, int k) const {
  const int line = axis == 0 ? home_[k] % stride_ : home_[k] / stride_;
  return origin_[axis] + line * cell_;
}

PointsView<float> SinglePoints::view() {
  PointsView<float> view = state_.view();
  view.home = home_.data();
  return view;
}

std::int64_t SinglePoints::bytes() const {
  return state_.bytes() + sizeof(std::int32_t) * home_.capacity();
}

}  // namespace gimpslope
