// Points, walls and methods as Python gives them.
#pragma once

#include <pybind11/stl.h>

#include <array>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bind.hpp"
#include "gimpslope/checks.hpp"
#include "gimpslope/instruction_set.hpp"
#include "gimpslope/method.hpp"
#include "gimpslope/wall.hpp"

using WallTuple = std::tuple<std::string, double, double>;  // kind, friction, position
using Choice = std::pair<std::string, double>;              // what a value means, the value

std::array<gimpslope::Wall, 4> walls_of(const std::array<WallTuple, 4>& given);
gimpslope::TimeStep time_step_of(const Choice& given);
gimpslope::Blend blend_of(const Choice& given);
gimpslope::VolumeUpdate volume_update_of(const std::string& given);

/// The fastest available set where the name is empty.
gimpslope::InstructionSet instruction_set_of(const std::string& given);

/// The arrays of the points, with their shapes checked; valid as long as the arrays are.
struct GivenPoints {
  GivenPoints(const Doubles& position, const Doubles& velocity, const Doubles& half_length,
              const Doubles& mass, const Doubles& volume, const py::array& material,
              const py::array* stone = nullptr);

  std::vector<std::int32_t> material, stone;
  gimpslope::InitialPoints points;
};
