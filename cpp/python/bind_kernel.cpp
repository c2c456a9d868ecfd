#include <pybind11/stl.h>

#include <algorithm>

#include "bind.hpp"
#include "gimpslope/instruction_set.hpp"
#include "gimpslope/probe.hpp"
#include "gimpslope/shape/traits.hpp"
#include "gimpslope/team.hpp"

using namespace gimpslope;

namespace {

py::tuple evaluate_shape(const std::string& shape, const Doubles& position,
                         const Doubles& half_length, double cell, std::array<double, 2> origin) {
  const py::ssize_t n = rows_of(position);
  const ShapeValues found =
      shape_functions(shape, values_of(position, "position", n, 2),
                      values_of(half_length, "half_length", n, 2), cell, origin);
  const py::ssize_t nodes = found.nodes;
  py::array_t<std::int64_t> index({n, nodes, py::ssize_t{2}});
  py::array_t<double> value({n, nodes}), gradient({n, nodes, py::ssize_t{2}});
  std::copy(found.index.begin(), found.index.end(), index.mutable_data());
  std::copy(found.value.begin(), found.value.end(), value.mutable_data());
  std::copy(found.gradient.begin(), found.gradient.end(), gradient.mutable_data());
  return py::make_tuple(index, value, gradient);
}

py::tuple return_stress(const Material& material, const Doubles& stress) {
  const py::ssize_t n = rows_of(stress);
  values_of(stress, "stress", n, 4);
  py::array_t<double> returned({n, py::ssize_t{4}}), plastic_strain(n);
  std::copy_n(stress.data(), 4 * n, returned.mutable_data());
  std::fill_n(plastic_strain.mutable_data(), n, 0.0);
  const auto count = static_cast<std::size_t>(n);
  return_mapping(material, {returned.mutable_data(), 4 * count},
                 {plastic_strain.mutable_data(), count});
  return py::make_tuple(returned, plastic_strain);
}

py::tuple deform_stress(const Material& material, const Doubles& stress,
                        const Doubles& velocity_gradient, double time_step, std::int64_t steps) {
  const py::ssize_t n = rows_of(stress);
  values_of(stress, "stress", n, 4);
  const auto gradients = values_of(velocity_gradient, "velocity_gradient", n, 4);
  py::array_t<double> updated({n, py::ssize_t{4}}), plastic_strain(n);
  std::copy_n(stress.data(), 4 * n, updated.mutable_data());
  std::fill_n(plastic_strain.mutable_data(), n, 0.0);
  const auto count = static_cast<std::size_t>(n);
  update_stress(material, gradients, time_step, steps, {updated.mutable_data(), 4 * count},
                {plastic_strain.mutable_data(), count});
  return py::make_tuple(updated, plastic_strain);
}

}  // namespace

void bind_kernel(py::module_& m) {
  m.attr("courant_limit") = kCourantLimit;
  m.attr("highest_order") = kHighestOrder;
  m.attr("has_threads") = has_threads();
  m.def("instruction_sets", [] {
    std::vector<std::string> names;
    for (const InstructionSet set : available_instruction_sets()) names.emplace_back(name(set));
    return names;
  });
  m.def("shapes", &shape_names);
  m.def("shape_functions", &evaluate_shape, py::arg("shape"), py::arg("position"),
        py::arg("half_length"), py::arg("cell"), py::arg("origin"));
  m.def("return_mapping", &return_stress, py::arg("material"), py::arg("stress"));
  m.def("update_stress", &deform_stress, py::arg("material"), py::arg("stress"),
        py::arg("velocity_gradient"), py::arg("time_step"), py::arg("steps") = 1);
}
