#include "points.hpp"

#include <algorithm>
#include <numeric>

namespace gimpslope {
namespace {

template <int kWidth, class T>
void permute(T* data, const std::vector<std::int32_t>& order, Buffer<T>& scratch) {
  T* sorted = scratch.data();
  for (std::size_t k = 0; k < order.size(); ++k)
    for (int c = 0; c < kWidth; ++c) sorted[kWidth * k + c] = data[kWidth * order[k] + c];
  std::copy_n(sorted, kWidth * order.size(), data);
}

}  // namespace

Points::Points(int n, bool own_domains, bool with_deformation)
    : size(n),
      motion(4 * n),
      stress(4 * n),
      volume(n),
      mass(n),
      plastic_strain(n),
      half_length(own_domains ? 2 * n : 0),
      domain_reference(own_domains ? 2 * n : 0),
      deformation(with_deformation ? 4 * n : 0),
      material(n),
      number(n),
      scratch_(4 * n),
      integer_scratch_(n) {
  std::iota(number.begin(), number.end(), 0);
  for (std::size_t k = 0; k < deformation.size(); k += 4) deformation[k] = deformation[k + 3] = 1.0;
}

void Points::reorder(const std::vector<std::int32_t>& order) {
  permute<4>(motion.data(), order, scratch_);
  for (int c = 0; c < 4; ++c) permute<1>(stress.data() + c * size, order, scratch_);
  for (Buffer<double>* scalar : {&volume, &mass, &plastic_strain})
    permute<1>(scalar->data(), order, scratch_);
  for (Buffer<double>* pair : {&half_length, &domain_reference, &body_force})
    if (!pair->empty()) permute<2>(pair->data(), order, scratch_);
  if (!deformation.empty()) permute<4>(deformation.data(), order, scratch_);
  permute<1>(material.data(), order, integer_scratch_);
  permute<1>(number.data(), order, integer_scratch_);
}

PointsView Points::view() {
  const auto optional = [](Buffer<double>& b) {
    return b.empty() ? nullptr : b.data();
  };
  return {motion.data(),
          stress.data(),
          stress.data() + size,
          stress.data() + 2 * size,
          stress.data() + 3 * size,
          volume.data(),
          plastic_strain.data(),
          mass.data(),
          optional(half_length),
          optional(domain_reference),
          optional(deformation),
          optional(body_force)};
}

std::int64_t Points::bytes() const {
  std::int64_t total = sizeof(std::int32_t) *
                       (material.capacity() + number.capacity() + integer_scratch_.capacity());
  for (const Buffer<double>* b : {&motion, &stress, &volume, &mass, &plastic_strain, &half_length,
                                  &domain_reference, &deformation, &body_force, &scratch_})
    total += sizeof(double) * b->capacity();
  return total;
}

}  // namespace gimpslope
