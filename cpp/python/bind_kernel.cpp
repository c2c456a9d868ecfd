#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "bind.hpp"
#include "gimpslope/instruction_set.hpp"
#include "gimpslope/probe.hpp"

using namespace gimpslope;

namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

void check_shape(const Doubles& array, const char* parameter, py::ssize_t columns) {
  const bool matrix = array.ndim() == 2 && array.shape(1) == columns;
  require(matrix, parameter, py::cast<std::string>(py::str(array.attr("shape"))),
          ("an array of shape (n, " + std::to_string(columns) + ")").c_str());
}

py::tuple evaluate_shape(const std::string& shape, const Doubles& position,
                         const Doubles& half_length, double cell, std::array<double, 2> origin) {
  check_shape(position, "position", 2);
  check_shape(half_length, "half_length", 2);
  require(position.shape(0) == half_length.shape(0), "half_length", half_length.shape(0),
          "as many rows as position");
  const auto kind = parse<ShapeKind>(
      "shape", shape,
      {{"linear", ShapeKind::linear}, {"ugimp", ShapeKind::ugimp}, {"cpgimp", ShapeKind::cpgimp}});
  const py::ssize_t n = position.shape(0);
  const std::size_t count = static_cast<std::size_t>(n);
  const ShapeValues found = shape_functions(kind, {position.data(), 2 * count},
                                            {half_length.data(), 2 * count}, cell, origin);
  const py::ssize_t nodes = found.nodes;
  py::array_t<std::int64_t> index({n, nodes, py::ssize_t{2}});
  py::array_t<double> value({n, nodes}), gradient({n, nodes, py::ssize_t{2}});
  std::copy(found.index.begin(), found.index.end(), index.mutable_data());
  std::copy(found.value.begin(), found.value.end(), value.mutable_data());
  std::copy(found.gradient.begin(), found.gradient.end(), gradient.mutable_data());
  return py::make_tuple(index, value, gradient);
}

py::tuple return_stress(const Material& material, const Doubles& stress) {
  check_shape(stress, "stress", 4);
  const py::ssize_t n = stress.shape(0);
  py::array_t<double> returned({n, py::ssize_t{4}}), plastic_strain(n);
  std::copy_n(stress.data(), 4 * n, returned.mutable_data());
  std::fill_n(plastic_strain.mutable_data(), n, 0.0);
  const auto count = static_cast<std::size_t>(n);
  return_mapping(material, {returned.mutable_data(), 4 * count},
                 {plastic_strain.mutable_data(), count});
  return py::make_tuple(returned, plastic_strain);
}

}  // namespace

void bind_kernel(py::module_& m) {
  m.def("instruction_sets", [] {
    std::vector<std::string> names;
    for (const InstructionSet set : available_instruction_sets()) names.emplace_back(name(set));
    return names;
  });
  m.def("openmp", [] {
#ifdef _OPENMP
    return true;
#else
    return false;
#endif
  });
  m.def("shape_functions", &evaluate_shape, py::arg("shape"), py::arg("position"),
        py::arg("half_length"), py::arg("cell"), py::arg("origin"));
  m.def("return_mapping", &return_stress, py::arg("material"), py::arg("stress"));
}
