// Numbers of one node, a double, or of four nodes that follow one another in a row, in the lanes of
// a quad: what is written for `V` holds for both.
#pragma once

#include "../tensor.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// How many nodes V has numbers of.
template <class V>
constexpr int kLanes = sizeof(V) / sizeof(double);

/// The four numbers that a node keeps together.
template <class V>
struct Components {
  V of[4];
  const V& operator[](int c) const { return of[c]; }
};

/// A vector in the plane at each node.
template <class V>
struct Two {
  V of[2];
  V& operator[](int c) { return of[c]; }
  const V& operator[](int c) const { return of[c]; }
};

/// What the nodes from a place in a field on keep.
template <class V>
[[gnu::always_inline]] inline Components<V> load(const double* place) {
  if constexpr (kLanes<V> == 1) {
    return {{place[0], place[1], place[2], place[3]}};
  } else {
    Components<V> nodes{{quad(place), quad(place + 4), quad(place + 8), quad(place + 12)}};
    transpose(nodes.of);
    return nodes;
  }
}

template <class V>
[[gnu::always_inline]] inline void store(Components<V> nodes, double* place) {
  if constexpr (kLanes<V> == 1) {
    quad(place) = Quad{nodes[0], nodes[1], nodes[2], nodes[3]};
  } else {
    transpose(nodes.of);
#pragma GCC unroll 4
    for (int m = 0; m < 4; ++m) quad(place + 4 * m) = nodes[m];
  }
}

template <class V>
[[gnu::always_inline]] inline void clear(double* place) {
#pragma GCC unroll 4
  for (int m = 0; m < kLanes<V>; ++m) quad(place + 4 * m) = Quad{};
}

/// 1 / m, or zero of a node without mass.
[[gnu::always_inline]] inline double inverse_of(double m) { return m > 0.0 ? 1.0 / m : 0.0; }
[[gnu::always_inline]] inline Quad inverse_of(Quad m) { return m > Quad{} ? 1.0 / m : Quad{}; }

/// 1, -1 or zero.
[[gnu::always_inline]] inline double sign_of(double x) { return (x > 0.0) - (x < 0.0); }
[[gnu::always_inline]] inline Quad sign_of(Quad x) {
  const Quad one = Quad{} + 1.0;
  return (x > Quad{} ? one : Quad{}) - (x < Quad{} ? one : Quad{});
}

/// Sum over the nodes.
[[gnu::always_inline]] inline double sum_of_lanes(double x) { return x; }
[[gnu::always_inline]] inline double sum_of_lanes(Quad x) { return (x[0] + x[2]) + (x[1] + x[3]); }

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
