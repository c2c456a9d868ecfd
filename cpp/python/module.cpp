#include "bind.hpp"

PYBIND11_MODULE(_core, m) {
  m.doc() = "The compiled kernel of gimpslope.";
  bind_material(m);
  bind_kernel(m);
  bind_solver(m);
  bind_plain(m);
  bind_machine(m);
}
