#include "checks.hpp"

#include <cmath>
#include <string>

#include "error.hpp"
#include "shape/traits.hpp"

namespace gimpslope {

void check_values(std::span<const double> values, std::size_t count, bool positive,
                  const char* parameter) {
  require(values.size() == count, parameter, std::to_string(values.size()) + " values",
          (std::to_string(count) + " values").c_str());
  for (const double value : values) {
    require(std::isfinite(value), parameter, value, "finite");
    require(!positive || value > 0.0, parameter, value, "positive");
  }
}

void check(const InitialPoints& p, const std::vector<Material>& materials,
           const std::string& shape) {
  const std::size_t n = p.position.size() / 2;
  require(n > 0 && n < (1u << 29), "position", std::to_string(n) + " points", "1 to 2^29 points");
  check_values(p.position, 2 * n, false, "position");
  check_values(p.velocity, 2 * n, false, "velocity");
  check_values(p.half_length, 2 * n, has_domains(shape), "half_length");
  check_values(p.mass, n, true, "mass");
  check_values(p.volume, n, true, "volume");
  require(p.material.size() == n, "material", std::to_string(p.material.size()) + " values",
          (std::to_string(n) + " values").c_str());
  const std::string rule = "an index into the " + std::to_string(materials.size()) + " materials";
  for (const int m : p.material)
    require(m >= 0 && static_cast<std::size_t>(m) < materials.size(), "material", m, rule.c_str());
  require(p.stone.empty() || p.stone.size() == n, "stone",
          std::to_string(p.stone.size()) + " values", (std::to_string(n) + " values").c_str());
  for (std::size_t k = 0; k < n; ++k)
    if (const int number = p.stone.empty() ? -1 : p.stone[k]; number < 0)
      require(materials[p.material[k]].law != LawKind::rigid, "stone", number,
              "the number of a stone where the material is rigid");
}

void check(const Method& m) {
  find_shape(m.shape);  // refuses unknown names
  const bool follows = m.domain_update != DomainUpdate::none;
  require((m.shape == "cpgimp") == follows, "domain_update", follows ? "given" : "none",
          "jacobian, stretch or deformation_diagonal with shape cpgimp, none with any other");
  const double b = m.blend.value;
  switch (m.blend.kind) {
    case Blend::Kind::alpha:
      require(b >= 0.0 && b <= 1.0, "alpha", b, "in [0, 1]");
      break;
    case Blend::Kind::viscosity:
      require(b >= 0.0 && std::isfinite(b), "viscosity", b, "zero or positive and finite, in m2/s");
      break;
    case Blend::Kind::relaxation_time:
      require(b > 0.0 && std::isfinite(b), "relaxation_time", b, "positive and finite, in s");
      break;
  }
  const bool blended = m.transfer == Transfer::flip;
  require(blended || (m.blend.kind == Blend::Kind::alpha && b == 1.0), "blend", b,
          "alpha 1 with any transfer but flip");
  require(m.transfer != Transfer::apic || m.shape != "linear", "transfer", "apic",
          "flip or xpic with shape linear, whose second moment vanishes at the nodes");
  const std::string orders = "in [1, " + std::to_string(kHighestOrder) + "]";
  require(m.order >= 1 && m.order <= kHighestOrder, "order", m.order, orders.c_str());
  require(m.order == 1 || m.transfer == Transfer::xpic, "order", m.order,
          "1 with any transfer but xpic");
  require(m.threads >= 1 && m.threads <= 1024, "threads", m.threads, "in [1, 1024]");
}

}  // namespace gimpslope
