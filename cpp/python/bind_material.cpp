#include <pybind11/stl.h>

#include <cmath>
#include <optional>

#include "bind.hpp"
#include "gimpslope/material/material.hpp"

using namespace gimpslope;

void bind_material(py::module_& m) {
  py::class_<Material>(m, "Material", "Density, elasticity and strength of a material.")
      .def(py::init([](double density, double young, double poisson, const std::string& law,
                       double friction, double cohesion, double dilation, const std::string& cone,
                       double tension_cutoff, std::optional<double> interface_friction,
                       double mutual_friction) {
             Material material{
                 density,
                 young,
                 poisson,
                 parse<LawKind>("law", law,
                                {{"elastic", LawKind::elastic},
                                 {"drucker_prager", LawKind::drucker_prager},
                                 {"rigid", LawKind::rigid}}),
                 friction,
                 cohesion,
                 dilation,
                 parse<Cone>("cone", cone,
                             {{"outer", Cone::outer},
                              {"inner", Cone::inner},
                              {"plane_strain_associated", Cone::plane_strain_associated},
                              {"plane_strain", Cone::plane_strain}}),
                 tension_cutoff,
                 interface_friction,
                 mutual_friction};
             material.check();
             return material;
           }),
           py::arg("density"), py::arg("young") = NAN, py::arg("poisson") = NAN,
           py::arg("law") = "elastic", py::arg("friction") = 0.0, py::arg("cohesion") = 0.0,
           py::arg("dilation") = 0.0, py::arg("cone") = "plane_strain_associated",
           py::arg("tension_cutoff") = INFINITY, py::arg("interface_friction") = py::none(),
           py::arg("mutual_friction") = 0.0)
      .def_property_readonly("bulk_modulus", &Material::bulk_modulus)
      .def_property_readonly("shear_modulus", &Material::shear_modulus)
      .def_property_readonly(
          "wave_speed", [](const Material& m) { return std::sqrt(m.wave_modulus() / m.density); })
      .def_property_readonly("tension_limit", &tension_limit)
      .def_property_readonly("cone_coefficients", [](const Material& m) {
        const ConeCoefficients c = cone_coefficients(m);
        return py::make_tuple(c.friction, c.cohesion, c.dilation);
      });
}
