#include "points.hpp"

#include <algorithm>
#include <numeric>

namespace gimpslope {
namespace {

template <class T>
void permute(T* data, const std::vector<std::int32_t>& order, Buffer<T>& scratch) {
  T* sorted = scratch.data();
  for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = data[order[k]];
  std::copy_n(sorted, order.size(), data);
}

std::ptrdiff_t whole_lines(std::ptrdiff_t n) {
  constexpr std::ptrdiff_t line = kCacheLine / sizeof(double);
  return (n + line - 1) / line * line;
}

}  // namespace

Field::Field(int components, int points)
    : components_(components), stride_(whole_lines(points)), values_(components * stride_) {}

Points::Points(int n, bool own_domains, bool with_deformation)
    : size(n),
      position(2, n),
      velocity(2, n),
      stress(4, n),
      volume(1, n),
      mass(1, n),
      plastic_strain(1, n),
      material(n),
      number(n),
      scratch_(n),
      integer_scratch_(n) {
  if (own_domains) half_length = domain_reference = Field(2, n);
  if (with_deformation) {
    deformation = Field(4, n);
    std::fill_n(deformation[0], n, 1.0);
    std::fill_n(deformation[3], n, 1.0);
  }
  std::iota(number.begin(), number.end(), 0);
}

void Points::reorder(const std::vector<std::int32_t>& order) {
  for (Field* field : {&position, &velocity, &stress, &volume, &mass, &plastic_strain, &half_length,
                       &domain_reference, &deformation, &body_force}) {
    for (int c = 0; c < field->components(); ++c) permute((*field)[c], order, scratch_);
  }
  permute(material.data(), order, integer_scratch_);
  permute(number.data(), order, integer_scratch_);
}

PointsView Points::view() {
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
          half_length[0],
          half_length[1],
          domain_reference[0],
          domain_reference[1],
          {deformation[0], deformation[1], deformation[2], deformation[3]},
          {body_force[0], body_force[1]}};
}

std::int64_t Points::bytes() const {
  std::int64_t total = sizeof(std::int32_t) *
                       (material.capacity() + number.capacity() + integer_scratch_.capacity());
  for (const Field* field : {&position, &velocity, &stress, &volume, &mass, &plastic_strain,
                             &half_length, &domain_reference, &deformation, &body_force})
    total += field->bytes();
  return total + sizeof(double) * scratch_.capacity();
}

}  // namespace gimpslope
