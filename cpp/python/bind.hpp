// One function a subject, each in a file of its own; names of options as Python gives them.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <initializer_list>
#include <span>
#include <sstream>
#include <string>
#include <utility>

#include "gimpslope/error.hpp"

namespace py = pybind11;

void bind_material(py::module_& m);
void bind_kernel(py::module_& m);
void bind_machine(py::module_& m);
void bind_plain(py::module_& m);
void bind_solver(py::module_& m);

/// The value that goes by `text`; refuses others with the list of names.
template <class Value>
Value parse(const char* parameter, const std::string& text,
            std::initializer_list<std::pair<const char*, Value>> names) {
  std::ostringstream rule;
  const char* separator = "one of ";
  for (const auto& [name, value] : names) {
    if (text == name) return value;
    rule << separator << name;
    separator = ", ";
  }
  gimpslope::refuse(parameter, text, rule.str());
}

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The values of an array of shape (n) or, with more than one component, (n, components).
inline std::span<const double> values_of(const Doubles& array, const char* parameter, py::ssize_t n,
                                         py::ssize_t components) {
  const bool vector = components == 1 && array.ndim() == 1;
  const bool matrix = components > 1 && array.ndim() == 2 && array.shape(1) == components;
  if (!(vector || matrix) || array.shape(0) != n) {
    std::ostringstream rule;
    rule << "an array of shape (" << n << ", ";
    if (components > 1) rule << components;
    rule << ")";
    gimpslope::refuse(parameter, "shape " + py::cast<std::string>(py::str(array.attr("shape"))),
                      rule.str());
  }
  return {array.data(), static_cast<std::size_t>(array.size())};
}

/// The number of points in an array that ought to have one row a point.
inline py::ssize_t rows_of(const py::array& array) { return array.ndim() > 0 ? array.shape(0) : 0; }
