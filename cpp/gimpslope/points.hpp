// The material points: one array a component of each property, kept sorted by cell.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "buffer.hpp"
#include "view.hpp"

namespace gimpslope {

/// One property of all points: all first components, then all second ones, and so on, each from a
/// cache line on.
template <class Real>
class Field {
 public:
  Field() = default;
  Field(int components, int points);

  bool empty() const { return components_ == 0; }
  int components() const { return components_; }
  std::ptrdiff_t stride() const { return stride_; }  // from one component to the next
  Real* operator[](int component) { return values_.data() + component * stride_; }
  const Real* operator[](int component) const { return values_.data() + component * stride_; }
  void fill(Real value) { values_.assign(values_.size(), value); }
  std::int64_t bytes() const { return sizeof(Real) * values_.capacity(); }

 private:
  int components_ = 0;
  std::ptrdiff_t stride_ = 0;
  Buffer<Real> values_;
};

/// What a step reads and writes of each point.
template <class Real>
struct State {
  Field<Real> position, velocity;  // x, y
  Field<Real> stress;              // xx, yy, zz, xy
  Field<Real> volume, mass, plastic_strain;
  Field<Real> half_length;       // x, y; empty where all are alike
  Field<Real> domain_reference;  // x, y; as half_length
  Field<Real> deformation;       // xx, xy, yx, yy; empty where no domain follows it
  Field<Real> affine;            // xx, xy, yx, yy, m2/s; empty but with APIC
  Field<Real> body_force;        // x, y, m/s2; empty until one is given

  std::array<Field<Real>*, 11> fields();
  std::array<const Field<Real>*, 11> fields() const;
  PointsView<Real> view();
  std::int64_t bytes() const;
};

struct Points : State<double> {
  /// Room for n points without state; a method whose domains are alike has no half-lengths, one
  /// that does not update them by F no deformation, one but APIC no affine motion.
  Points(int n, bool own_domains, bool deformation, bool affine);

  int size;
  Buffer<std::int32_t> material;
  Buffer<std::int32_t> number;  // place of the point in the order in which it was given

  /// The point at order[k] comes to place k. Arrays stay where they are in memory.
  void reorder(const std::vector<std::int32_t>& order);

  std::int64_t bytes() const;

 private:
  Buffer<double> scratch_;
  Buffer<std::int32_t> integer_scratch_;
};

/// m2/s2
inline double squared_speed(const Points& points, int k) {
  const double vx = points.velocity[0][k], vy = points.velocity[1][k];
  return vx * vx + vy * vy;
}

/// The state of points in single precision while they are stepped. Places are counted from a node
/// near each point, so that they keep their digits far from the origin.
class SinglePoints {
 public:
  /// Takes the state of points in a window of nodes; domains reach up to `reach` cells to the left
  /// of a point and below it before the next load.
  void load(const Points& points, const GridView& window, double reach);

  /// Gives back what steps change, domains where they `follow` the deformation.
  void store(Points& points, bool domains_follow) const;

  PointsView<float> view();
  std::int64_t bytes() const;

 private:
  double node(int axis, int k) const;  // coordinate of the node of point k, m

  State<float> state_;
  Buffer<std::int32_t> home_;  // index of the node
  double origin_[2], cell_;
  int stride_;
};

}  // namespace gimpslope
