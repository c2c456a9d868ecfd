#include "probe.hpp"

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "rotation.hpp"
#include "shape/list.hpp"
#include "shape/traits.hpp"

namespace gimpslope {
namespace {

template <class Shape>
ShapeValues evaluate_all(std::span<const double> position, std::span<const double> half_length,
                         double cell, std::array<double, 2> origin) {
  constexpr int nodes = Shape::nodes;
  ShapeValues result{nodes * nodes, {}, {}, {}};
  for (std::size_t k = 0; k < position.size(); k += 2) {
    std::int64_t first[2];
    double w[2][nodes], d[2][nodes];
    for (int axis = 0; axis < 2; ++axis) {
      const double width = Shape::widest > 0.0 ? 2.0 * half_length[k + axis] / cell : 0.0;
      const double edge = (position[k + axis] - origin[axis]) / cell - 0.5 * width - Shape::behind;
      first[axis] = static_cast<std::int64_t>(std::floor(edge));
      const double room = static_cast<double>(first[axis] + 1) - edge;
      Shape::evaluate(room, width, 1.0 / width, w[axis], d[axis]);
    }
    for (int j = 0; j < nodes; ++j) {
      for (int i = 0; i < nodes; ++i) {
        result.index.insert(result.index.end(), {first[0] + i, first[1] + j});
        result.value.push_back(w[0][i] * w[1][j]);
        result.gradient.insert(result.gradient.end(),
                               {d[0][i] * w[1][j] / cell, w[0][i] * d[1][j] / cell});
      }
    }
  }
  return result;
}

template <class... Shape>
auto evaluation(int shape, List<Shape...>) {
  constexpr auto evaluate = std::array{&evaluate_all<Shape>...};
  return evaluate[shape];
}

}  // namespace

ShapeValues shape_functions(const std::string& shape, std::span<const double> position,
                            std::span<const double> half_length, double cell,
                            std::array<double, 2> origin) {
  require(cell > 0.0 && std::isfinite(cell), "cell", cell, "positive and finite, in m");
  for (const double x : origin) require(std::isfinite(x), "origin", x, "finite, in m");
  for (const double x : position)
    require(std::abs(x) / cell < 1e9, "position", x, "finite and within 1e9 cells of zero, in m");
  const double allowed = traits(find_shape(shape)).widest;
  double width = 0.0;
  if (allowed > 0.0) {
    const std::string rule = "positive and at most " + text(0.5 * allowed) + " cells, in m";
    for (const double l : half_length) {
      require(l > 0.0 && 2.0 * l / cell <= allowed * (1.0 + 1e-12), "half_length", l, rule.c_str());
      width = std::max(width, 2.0 * l / cell);
    }
  }
  const auto evaluate = evaluation(find_shape(shape, width), Shapes{});
  return evaluate(position, half_length, cell, origin);
}

void return_mapping(const Material& material, std::span<double> stress,
                    std::span<double> plastic_strain) {
  require(material.law == LawKind::drucker_prager, "material", "elastic",
          "of the law drucker_prager");
  const DruckerPrager constants = law(material).drucker_prager;
  for (std::size_t k = 0; k < plastic_strain.size(); ++k) {
    double* s = stress.data() + 4 * k;
    Mohr circle = circle_of({s[0], s[1], s[2], s[3]});
    if (!return_to_surface(constants, circle, plastic_strain[k])) continue;
    const Stress point = stress_of(circle);
    s[0] = point.xx;
    s[1] = point.yy;
    s[2] = point.zz;
    s[3] = point.xy;
  }
}

void update_stress(const Material& material, std::span<const double> velocity_gradient, double dt,
                   std::int64_t steps, std::span<double> stress, std::span<double> plastic_strain) {
  const Law of_material = law(material);
  const auto deform = [&](const double* l, Stress& point, double& plastic) {
    const double turn = dt * (l[2] - l[1]);
    double cosine, sine;
    rotation(turn, std::abs(turn), cosine, sine);
    const Strain increment{dt * l[0], dt * l[3], 0.5 * dt * (l[1] + l[2])};
    with_constants(of_material, [&](const auto& constants) {
      for (std::int64_t step = 0; step < steps; ++step) {
        Mohr circle = turned(circle_of(point), cosine, sine);
        update(constants, circle, increment, plastic);
        point = stress_of(circle);
      }
    });
  };
  for (std::size_t k = 0; k < plastic_strain.size(); ++k) {
    double* s = stress.data() + 4 * k;
    Stress point{s[0], s[1], s[2], s[3]};
    deform(velocity_gradient.data() + 4 * k, point, plastic_strain[k]);
    s[0] = point.xx;
    s[1] = point.yy;
    s[2] = point.zz;
    s[3] = point.xy;
  }
}

}  // namespace gimpslope
