#include "plain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "error.hpp"
#include "shape/traits.hpp"

namespace gimpslope {

inline namespace generic {
bool plain_step(const PlainView& view, double dt, double alpha);
}
#ifdef GIMPSLOPE_X86
namespace x86_64_v3 {
bool plain_step(const PlainView& view, double dt, double alpha);
}
namespace x86_64_v4 {
bool plain_step(const PlainView& view, double dt, double alpha);
}
#endif

namespace {

using Step = bool (*)(const PlainView& view, double dt, double alpha);

Step find_step(InstructionSet set) {
  switch (set) {
#ifdef GIMPSLOPE_X86
    case InstructionSet::x86_64_v3:
      return &x86_64_v3::plain_step;
    case InstructionSet::x86_64_v4:
      return &x86_64_v4::plain_step;
#endif
    default:
      return &generic::plain_step;
  }
}

}  // namespace

Plain::Plain(const InitialPoints& given, const std::vector<Material>& materials, double cell,
             std::array<double, 2> origin, const std::array<Wall, 4>& walls, const Method& method,
             std::array<double, 2> gravity, int margin, InstructionSet instruction_set)
    : method_(method), step_(find_step(instruction_set)) {
  for (const Material& material : materials)
    require(material.law != LawKind::rigid, "materials", "a rigid one",
            "deformable in the plain loop");
  check(given, materials, method.shape);
  check(method);
  require(method.shape == "ugimp", "shape", method.shape, "ugimp in the plain loop");
  require(method.volumetric_strain == VolumetricStrain::point, "volumetric_strain", "cell_average",
          "point in the plain loop");
  require(margin >= 2, "margin", margin, "at least 2 cells");
  for (const Material& material : materials) laws_.push_back(law(material));
  double low[2] = {given.position[0], given.position[1]}, high[2] = {low[0], low[1]};
  for (std::size_t k = 0; k < given.mass.size(); ++k) {
    PlainPoint p{};
    p.x = given.position[2 * k];
    p.y = given.position[2 * k + 1];
    p.vx = given.velocity[2 * k];
    p.vy = given.velocity[2 * k + 1];
    p.mass = given.mass[k];
    p.volume = given.volume[k];
    p.material = given.material[k];
    points_.push_back(p);
    for (int c = 0; c < 2; ++c) {
      low[c] = std::min(low[c], given.position[2 * k + c]);
      high[c] = std::max(high[c], given.position[2 * k + c]);
      require(given.half_length[2 * k + c] == given.half_length[0], "half_length",
              given.half_length[2 * k + c], "the same for all points in the plain loop");
    }
  }
  require(given.half_length[0] <= 0.5 * cell, "half_length", given.half_length[0],
          "at most half a cell in the plain loop");
  int first[2], count[2];
  for (int c = 0; c < 2; ++c) {
    first[c] = static_cast<int>(std::floor((low[c] - origin[c]) / cell)) - margin;
    count[c] = static_cast<int>(std::ceil((high[c] - origin[c]) / cell)) + margin - first[c] + 1;
  }
  nodes_.assign(static_cast<std::size_t>(count[0]) * count[1], PlainNode{});
  for (PlainNode& node : nodes_) node.ux = node.uy = kNoMotion;
  view_.columns = count[0];
  view_.rows = count[1];
  view_.left = origin[0] + first[0] * cell;
  view_.bottom = origin[1] + first[1] * cell;
  view_.cell = cell;
  view_.half_length = given.half_length[0];
  view_.volume_update = method.volume_update;
  view_.gravity_x = gravity[0];
  view_.gravity_y = gravity[1];
  for (const Side side : {left, right, bottom, top}) {
    const int axis = side == bottom || side == top;
    const bool low_side = side == left || side == bottom;
    constexpr int far = std::numeric_limits<int>::max() / 2;
    view_.kind[side] = walls[side].kind;
    view_.friction[side] = walls[side].friction;
    view_.wall[side] =
        walls[side].kind == WallKind::free
            ? (low_side ? -far : far)
            : static_cast<int>(std::lround((walls[side].position - origin[axis]) / cell)) -
                  first[axis];
  }
}

PlainView Plain::view() {
  PlainView view = view_;
  view.points = points_.data();
  view.size = size();
  view.nodes = nodes_.data();
  view.laws = laws_.data();
  return view;
}

double Plain::time_step() const {
  if (method_.time_step.kind == TimeStep::Kind::fixed) return method_.time_step.value;
  double wave = 0.0, point = 0.0;
  for (const PlainPoint& p : points_) {
    wave = std::max(wave, laws_[p.material].wave_modulus * p.volume / p.mass);
    point = std::max(point, p.vx * p.vx + p.vy * p.vy);
  }
  return method_.time_step.value * view_.cell / (std::sqrt(wave) + std::sqrt(point));
}

void Plain::advance(std::int64_t steps) {
  require(steps >= 0, "steps", steps, "zero or positive");
  const double moment =
      traits(find_shape(method_.shape)).second_moment(view_.cell, view_.half_length);
  for (std::int64_t k = 0; k < steps; ++k) {
    const double dt = time_step();
    const double alpha = method_.blend.alpha(dt, moment);
    if (!step_(view(), dt, alpha))
      throw std::runtime_error("a point has left the grid of the plain loop; give a larger margin");
    time_ += dt;
  }
}

std::vector<double> Plain::values(const std::string& name) const {
  std::vector<double> result;
  for (const PlainPoint& p : points_) {
    if (name == "position") {
      result.insert(result.end(), {p.x, p.y});
    } else if (name == "velocity") {
      result.insert(result.end(), {p.vx, p.vy});
    } else if (name == "stress") {
      result.insert(result.end(), {p.sxx, p.syy, p.szz, p.sxy});
    } else if (name == "volume") {
      result.push_back(p.volume);
    } else if (name == "plastic_strain") {
      result.push_back(p.plastic_strain);
    } else {
      refuse("field", name, "one of position, velocity, stress, volume, plastic_strain");
    }
  }
  return result;
}

}  // namespace gimpslope
