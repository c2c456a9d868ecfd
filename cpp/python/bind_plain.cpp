#include <pybind11/stl.h>

#include <memory>

#include "bind.hpp"
#include "bind_method.hpp"
#include "gimpslope/plain.hpp"

using namespace gimpslope;

void bind_plain(py::module_& m) {
  py::class_<Plain>(m, "Plain", "The same step as a plain loop over points and nodes.")
      .def(py::init([](const Doubles& position, const Doubles& velocity, const Doubles& half_length,
                       const Doubles& mass, const Doubles& volume, const py::array& material,
                       const std::vector<Material>& materials, double cell,
                       std::array<double, 2> origin, const std::array<WallTuple, 4>& walls,
                       const Choice& blended, const Choice& step, const std::string& volume_update,
                       std::array<double, 2> gravity, int margin,
                       const std::string& instruction_set) {
             Method method;
             method.blend = blend_of(blended);
             method.time_step = time_step_of(step);
             method.volume_update = volume_update_of(volume_update);
             const GivenPoints given(position, velocity, half_length, mass, volume, material);
             return std::make_unique<Plain>(given.points, materials, cell, origin, walls_of(walls),
                                            method, gravity, margin,
                                            instruction_set_of(instruction_set));
           }),
           py::arg("position"), py::arg("velocity"), py::arg("half_length"), py::arg("mass"),
           py::arg("volume"), py::arg("material"), py::arg("materials"), py::kw_only(),
           py::arg("cell"), py::arg("origin"), py::arg("walls"), py::arg("blend"),
           py::arg("time_step"), py::arg("volume_update") = "linear", py::arg("gravity"),
           py::arg("margin"), py::arg("instruction_set") = "")
      .def("advance", &Plain::advance, py::arg("steps"), py::call_guard<py::gil_scoped_release>())
      .def("get",
           [](const Plain& plain, const std::string& name) {
             const std::vector<double> found = plain.values(name);
             const auto n = static_cast<py::ssize_t>(plain.size());
             const auto columns = static_cast<py::ssize_t>(found.size()) / n;
             std::vector<py::ssize_t> shape{n};
             if (columns > 1) shape.push_back(columns);
             return py::array_t<double>(shape, found.data());
           })
      .def_property_readonly("time", &Plain::time);
}
