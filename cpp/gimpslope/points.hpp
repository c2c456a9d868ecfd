// The material points: one array a property, kept sorted by cell.
#pragma once

#include <cstdint>
#include <vector>

#include "buffer.hpp"
#include "view.hpp"

namespace gimpslope {

struct Points {
  /// Room for n points without state; a method whose domains are alike has no half-lengths, one
  /// that does not update them by F no deformation.
  Points(int n, bool own_domains, bool deformation);

  int size;
  Buffer<double> motion;  // x, y, vx, vy
  Buffer<double> stress;  // all xx, then all yy, zz, xy
  Buffer<double> volume, mass, plastic_strain;
  Buffer<double> half_length;       // x, y
  Buffer<double> domain_reference;  // x, y
  Buffer<double> deformation;       // xx, xy, yx, yy
  Buffer<double> body_force;        // x, y, m/s2; empty until one is given
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
