#include "bind_method.hpp"

#include <algorithm>

using namespace gimpslope;

namespace {

/// Whole numbers of points; those with a fraction are refused, not cut.
std::vector<std::int32_t> indices_of(const py::array& given, const char* name, py::ssize_t n) {
  const char kind = given.dtype().kind();
  if (given.ndim() != 1 || given.shape(0) != n || (kind != 'i' && kind != 'u')) {
    refuse(
        name,
        py::cast<std::string>(py::str("{} of shape {}").format(given.dtype(), given.attr("shape"))),
        "an array of whole numbers of shape (" + std::to_string(n) + ", )");
  }
  const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> wide(given);
  std::vector<std::int32_t> result(static_cast<std::size_t>(n));
  for (py::ssize_t k = 0; k < n; ++k)
    result[k] = static_cast<std::int32_t>(std::clamp<std::int64_t>(wide.at(k), -1, INT32_MAX));
  return result;
}

Wall wall(const WallTuple& given) {
  const auto& [kind, friction, position] = given;
  return {parse<WallKind>("wall", kind,
                          {{"free", WallKind::free},
                           {"roller", WallKind::roller},
                           {"fixed", WallKind::fixed},
                           {"coulomb", WallKind::coulomb}}),
          friction, position};
}

}  // namespace

std::array<Wall, 4> walls_of(const std::array<WallTuple, 4>& given) {
  return {wall(given[0]), wall(given[1]), wall(given[2]), wall(given[3])};
}

TimeStep time_step_of(const Choice& given) {
  return {parse<TimeStep::Kind>(
              "time_step", given.first,
              {{"fixed", TimeStep::Kind::fixed}, {"courant", TimeStep::Kind::courant}}),
          given.second};
}

Blend blend_of(const Choice& given) {
  return {parse<Blend::Kind>("blend", given.first,
                             {{"alpha", Blend::Kind::alpha},
                              {"viscosity", Blend::Kind::viscosity},
                              {"relaxation_time", Blend::Kind::relaxation_time}}),
          given.second};
}

VolumeUpdate volume_update_of(const std::string& given) {
  return parse<VolumeUpdate>(
      "volume_update", given,
      {{"linear", VolumeUpdate::linear}, {"exponential", VolumeUpdate::exponential}});
}

InstructionSet instruction_set_of(const std::string& given) {
  return given.empty() ? available_instruction_sets().back() : parse_instruction_set(given);
}

GivenPoints::GivenPoints(const Doubles& position, const Doubles& velocity,
                         const Doubles& half_length, const Doubles& mass, const Doubles& volume,
                         const py::array& given_material, const py::array* given_stone) {
  const py::ssize_t n = rows_of(position);
  points = {values_of(position, "position", n, 2),
            values_of(velocity, "velocity", n, 2),
            values_of(half_length, "half_length", n, 2),
            values_of(mass, "mass", n, 1),
            values_of(volume, "volume", n, 1),
            {},
            {}};
  material = indices_of(given_material, "material", n);
  stone = given_stone != nullptr ? indices_of(*given_stone, "stone", n)
                                 : std::vector<std::int32_t>(n, -1);
  points.material = material;
  points.stone = stone;
}
