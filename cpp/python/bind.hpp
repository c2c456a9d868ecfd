// One function a subject, each in a file of its own; names of options as Python gives them.
#pragma once

#include <pybind11/pybind11.h>

#include <initializer_list>
#include <sstream>
#include <string>
#include <utility>

#include "gimpslope/error.hpp"

namespace py = pybind11;

void bind_material(py::module_& m);
void bind_kernel(py::module_& m);
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
