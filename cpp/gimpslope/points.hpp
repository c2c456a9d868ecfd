// The material points: one array a component of each property, kept sorted by cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "buffer.hpp"
#include "view.hpp"

namespace gimpslope {

/// One property of all points: all first components, then all second ones, and so on, each from a
/// cache line on.
class Field {
 public:
  Field() = default;
  Field(int components, int points);

  bool empty() const { return components_ == 0; }
  int components() const { return components_; }
  std::ptrdiff_t stride() const { return stride_; }  // from one component to the next
  double* operator[](int component) { return values_.data() + component * stride_; }
  const double* operator[](int component) const { return values_.data() + component * stride_; }
  void fill(double value) { values_.assign(values_.size(), value); }
  std::int64_t bytes() const { return sizeof(double) * values_.capacity(); }

 private:
  int components_ = 0;
  std::ptrdiff_t stride_ = 0;
  Buffer<double> values_;
};

struct Points {
  /// Room for n points without state; a method whose domains are alike has no half-lengths, one
  /// that does not update them by F no deformation.
  Points(int n, bool own_domains, bool deformation);

  int size;
  Field position, velocity;  // x, y
  Field stress;              // xx, yy, zz, xy
  Field volume, mass, plastic_strain;
  Field half_length;       // x, y
  Field domain_reference;  // x, y
  Field deformation;       // xx, xy, yx, yy
  Field body_force;        // x, y, m/s2; empty until one is given
  Buffer<std::int32_t> material;
  Buffer<std::int32_t> number;  // place of the point in the order in which it was given

  /// The point at order[k] comes to place k. Arrays stay where they are in memory.
  void reorder(const std::vector<std::int32_t>& order);

  PointsView view();
  std::int64_t bytes() const;

 private:
  Buffer<double> scratch_;
  Buffer<std::int32_t> integer_scratch_;
};

}  // namespace gimpslope
