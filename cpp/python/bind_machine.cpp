#include "bind.hpp"
#include "bind_method.hpp"
#include "gimpslope/machine.hpp"

using namespace gimpslope;

void bind_machine(py::module_& m) {
  py::class_<Machine>(m, "Machine", "Loops that show what this machine can do at most.")
      .def(py::init([](int threads, std::int64_t bytes, const std::string& instruction_set) {
             return new Machine(threads, bytes, instruction_set_of(instruction_set));
           }),
           py::kw_only(), py::arg("threads"), py::arg("bytes"), py::arg("instruction_set") = "")
      .def("multiply_add", &Machine::multiply_add, py::arg("rounds"),
           py::call_guard<py::gil_scoped_release>())
      .def("read", &Machine::read, py::arg("passes"), py::call_guard<py::gil_scoped_release>());
}
