// The nodes of a block of points with their shape functions.
#pragma once

#include <cmath>

#include "../tensor.hpp"
#include "../view.hpp"
#include "../wall.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

enum class Need { values, gradients };  // gradients: values and derivatives

/// Shape functions of the points of a block along both axes, one array a node. Derivatives are
/// times the cell size. The points are made up to a multiple of four with the last one again.
template <class Shape, Need kNeed>
struct Weights;

template <class Shape>
struct Weights<Shape, Need::values> {
  alignas(kCacheLine) int first[kBlock];  // index of the lower left node
  double x[Shape::nodes][kBlock], y[Shape::nodes][kBlock];

  double value_x(int i, int k) const { return x[i][k]; }
  double value_y(int j, int k) const { return y[j][k]; }
  void set_x(int i, int k, double value, double /*derivative*/) { x[i][k] = value; }
  void set_y(int j, int k, double value, double /*derivative*/) { y[j][k] = value; }
  void copy_point(int from, int to) {
    first[to] = first[from];
    for (int i = 0; i < Shape::nodes; ++i) {
      x[i][to] = x[i][from];
      y[i][to] = y[i][from];
    }
  }

  /// Weights of points k to k + 3: those along x come by shuffles, those along y by loads, to keep
  /// both units of the processor busy.
  struct FourPoints {
    const Weights& all;
    const int first;
    Quad along[Shape::nodes];
    [[gnu::always_inline]] Quad x(int i, int m) const { return spread(along[i], m); }
    [[gnu::always_inline]] double y(int j, int m) const { return all.y[j][first + m]; }
  };
  [[gnu::always_inline]] FourPoints four(int k) const {
    FourPoints w{*this, k, {}};
#pragma GCC unroll 8
    for (int i = 0; i < Shape::nodes; ++i) w.along[i] = quad(x[i] + k);
    return w;
  }
};

/// {derivative, value} along x and {value, derivative} along y, so that their products are those
/// that a gradient takes. The second node has what the others leave, for values add up to one and
/// derivatives to zero: an addition costs less than a place in memory.
template <class Shape>
struct Weights<Shape, Need::gradients> {
  static_assert(Shape::nodes >= 2);
  static constexpr int kRest = 1, kOthers = Shape::nodes - 1;

  alignas(kCacheLine) int first[kBlock];
  double x[kOthers][2 * kBlock], y[kOthers][2 * kBlock];

  [[gnu::always_inline]] double value_x(int i, int k) const {
    return kept_or_rest(i, 1.0, [&](int place) { return x[place][2 * k + 1]; });
  }
  [[gnu::always_inline]] double value_y(int j, int k) const {
    return kept_or_rest(j, 1.0, [&](int place) { return y[place][2 * k]; });
  }
  /// The pair twice.
  [[gnu::always_inline]] Quad pairs_x(int i, int k) const {
    return kept_or_rest(i, kSumX, [&](int place) { return twice(x[place] + 2 * k); });
  }
  [[gnu::always_inline]] Quad pairs_y(int j, int k) const {
    return kept_or_rest(j, kSumY, [&](int place) { return twice(y[place] + 2 * k); });
  }
  void set_x(int i, int k, double value, double derivative) {
    if (i == kRest) return;
    x[place_of(i)][2 * k] = derivative;
    x[place_of(i)][2 * k + 1] = value;
  }
  void set_y(int j, int k, double value, double derivative) {
    if (j == kRest) return;
    y[place_of(j)][2 * k] = value;
    y[place_of(j)][2 * k + 1] = derivative;
  }
  void copy_point(int from, int to) {
    first[to] = first[from];
    for (int i = 0; i < kOthers; ++i)
      for (int c = 0; c < 2; ++c) {
        x[i][2 * to + c] = x[i][2 * from + c];
        y[i][2 * to + c] = y[i][2 * from + c];
      }
  }

  /// Pairs of points k to k + 3, along x by loads and along y by shuffles.
  struct FourPoints {
    const Weights& all;
    const int first;
    Quad up[Shape::nodes][2];
    [[gnu::always_inline]] Quad x(int i, int m) const { return all.pairs_x(i, first + m); }
    [[gnu::always_inline]] Quad y(int j, int m) const { return spread_pair(up[j][m / 2], m % 2); }
  };
  [[gnu::always_inline]] FourPoints four(int k) const {
    FourPoints w{*this, k, {}};
#pragma GCC unroll 8
    for (int j = 0; j < Shape::nodes; ++j)
#pragma GCC unroll 8
      for (int m = 0; m < 2; ++m)
        w.up[j][m] =
            kept_or_rest(j, kSumY, [&](int place) { return quad(y[place] + 2 * k + 4 * m); });
    return w;
  }

 private:
  static constexpr Quad kSumX{0.0, 1.0, 0.0, 1.0}, kSumY{1.0, 0.0, 1.0, 0.0};

  static constexpr int place_of(int node) { return node < kRest ? node : node - 1; }

  /// What of(place) says for a node that has a place, or what all others leave of the `sum`.
  template <class Number, class Of>
  [[gnu::always_inline]] static Number kept_or_rest(int node, Number sum, Of of) {
    if (node != kRest) return of(place_of(node));
#pragma GCC unroll 8
    for (int k = 0; k < kOthers; ++k) sum -= of(k);
    return sum;
  }
};

/// A shape function that is another one beside walls.
template <class Shape>
concept ChangesAtWalls = requires { &Shape::at_walls; };

/// The whole part of a number of cells.
[[gnu::always_inline]] inline double whole(double cells) {
#if defined(__SSE2__) && !defined(__SSE4_1__)
  return static_cast<int>(cells);  // std::trunc is a call there, of which no loop is vectorised
#else
  return std::trunc(cells);
#endif
}

/// Shape functions of the n points from `begin` on. With kOwnDomain each point has its own
/// half-lengths, otherwise all share one.
template <class Shape, bool kOwnDomain, Need kNeed, class Real>
void evaluate(const View<Real>& view, int begin, int n, Weights<Shape, kNeed>& out) {
  const GridView& grid = view.grid;
  const Real* px = view.points.x + begin;
  const Real* py = view.points.y + begin;
  const Real* lx = kOwnDomain ? view.points.half_length[0] + begin : nullptr;
  const Real* ly = kOwnDomain ? view.points.half_length[1] + begin : nullptr;
  const double per_cell = 1.0 / grid.cell;
  constexpr bool relative = PointsView<Real>::relative;
  const std::int32_t* home = relative ? view.points.home + begin : nullptr;
  const double origin_x = (relative ? 0.0 : grid.left * per_cell) + Shape::behind;
  const double origin_y = (relative ? 0.0 : grid.bottom * per_cell) + Shape::behind;
  const double stride = grid.stride;
  const double common = Shape::widest > 0.0 ? 2.0 * view.half_length * per_cell : 0.0;
  const double common_inverse = Shape::widest > 0.0 ? 1.0 / common : 0.0;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    double width_x = common, width_y = common;
    double inverse_x = common_inverse, inverse_y = common_inverse;
    if constexpr (kOwnDomain) {
      width_x = 2.0 * lx[k] * per_cell;
      width_y = 2.0 * ly[k] * per_cell;
      inverse_x = 1.0 / width_x;
      inverse_y = 1.0 / width_y;
    }
    const double left = origin_x + 0.5 * width_x, below = origin_y + 0.5 * width_y;
    // Of the second node. Positions are scaled twice, for additions are what runs out.
    const double column = whole(px[k] * per_cell - (left - 1.0));
    const double row = whole(py[k] * per_cell - (below - 1.0));
    const double room_x = column - (px[k] * per_cell - left);
    const double room_y = row - (py[k] * per_cell - below);
    out.first[k] = static_cast<int>(row * stride + column) - (grid.stride + 1);  // exact: < 2^53
    if constexpr (relative) out.first[k] += home[k];

    double w[Shape::nodes], d[Shape::nodes];
    Shape::evaluate(room_x, width_x, inverse_x, w, d);
    if constexpr (ChangesAtWalls<Shape>) {
      const int i = static_cast<int>(column) - 1 + (relative ? home[k] % grid.stride : 0);
      Shape::at_walls(room_x, i == grid.wall[Side::left] - 1,
                      i + Shape::nodes - 2 == grid.wall[Side::right], w, d);
    }
    for (int i = 0; i < Shape::nodes; ++i) out.set_x(i, k, w[i], d[i]);
    Shape::evaluate(room_y, width_y, inverse_y, w, d);
    if constexpr (ChangesAtWalls<Shape>) {
      const int j = static_cast<int>(row) - 1 + (relative ? home[k] / grid.stride : 0);
      Shape::at_walls(room_y, j == grid.wall[Side::bottom] - 1,
                      j + Shape::nodes - 2 == grid.wall[Side::top], w, d);
    }
    for (int j = 0; j < Shape::nodes; ++j) out.set_y(j, k, w[j], d[j]);
  }
  for (int k = n; k % 4 != 0; ++k) out.copy_point(n - 1, k);
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
