#include "material.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "../error.hpp"

namespace gimpslope {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Mean stress at the apex, c cot(phi); infinite for a material without friction.
double apex(const Material& m) {
  return m.friction > 0.0 ? m.cohesion / std::tan(m.friction * kDegree) : kInfinity;
}

std::string in_range(double most, const char* unit) {
  std::ostringstream rule;
  rule << "in [0, " << most << "] " << unit;
  return rule.str();
}

}  // namespace

double Material::bulk_modulus() const { return young / (3.0 * (1.0 - 2.0 * poisson)); }
double Material::shear_modulus() const { return young / (2.0 * (1.0 + poisson)); }
double Material::wave_modulus() const {
  return law == LawKind::rigid ? 0.0 : bulk_modulus() + 4.0 / 3.0 * shear_modulus();
}

double Material::interface_coefficient() const {
  return interface_friction ? std::tan(*interface_friction * kDegree) : -1.0;
}
double Material::mutual_coefficient() const { return std::tan(mutual_friction * kDegree); }

void Material::check() const {
  require(density > 0.0 && density < kInfinity, "density", density,
          "positive and finite, in kg/m3");
  if (law == LawKind::rigid) {
    const auto require_angle = [](const char* name, double angle) {
      require(angle >= 0.0 && angle < 90.0, name, angle, "in [0, 90), in degrees");
    };
    require_angle("friction", interface_friction.value_or(0.0));
    require_angle("mutual_friction", mutual_friction);
    return;
  }
  require(young > 0.0 && young < kInfinity, "young", young, "positive and finite, in Pa");
  require(poisson > -1.0 && poisson < 0.5, "poisson", poisson, "in (-1, 0.5)");
  if (law == LawKind::elastic) return;
  require(friction >= 0.0 && friction < 90.0, "friction", friction, "in [0, 90), in degrees");
  require(cohesion >= 0.0 && cohesion < kInfinity, "cohesion", cohesion,
          "zero or positive and finite, in Pa");
  require(friction > 0.0 || cohesion > 0.0, "cohesion", cohesion,
          "positive where friction is 0, or the material has no strength");
  require(dilation >= 0.0 && dilation <= friction, "dilation", dilation,
          in_range(friction, "degrees, at most the friction angle").c_str());
  require(tension_cutoff == kInfinity ||
              (tension_cutoff >= 0.0 && tension_cutoff <= apex(*this) * (1.0 + 1e-12)),
          "tension_cutoff", tension_cutoff,
          in_range(apex(*this), "Pa, at most c cot(phi)").c_str());
}

double tension_limit(const Material& m) { return std::min(m.tension_cutoff, apex(m)); }

ConeCoefficients cone_coefficients(const Material& m) {
  const double root3 = std::sqrt(3.0);
  const double sine = std::sin(m.friction * kDegree), cosine = std::cos(m.friction * kDegree);
  const double flow = std::sin(m.dilation * kDegree);
  // de Souza Neto et al. eq. 6.122 (outer edges) and 6.123 (inner edges).
  const auto edges = [&](double sign) -> ConeCoefficients {
    const double divisor = root3 * (3.0 - sign * sine);
    return {6.0 * sine / divisor, 6.0 * cosine / divisor,
            6.0 * flow / (root3 * (3.0 - sign * flow))};
  };
  // Collapse in plane strain: without plastic strain out of plane s_zz = -2/3 etabar sqrt(J2), and
  // Mohr-Coulomb written in sqrt(J2) and p is this cone. psi = phi gives eq. 6.124; psi = 0 gives
  // eta = sin(phi), xi = cos(phi).
  const auto dilation_of = [](double s) {
    return 3.0 * s / std::sqrt(9.0 + 3.0 * s * s);
  };
  const auto plane_strain = [&](double flow_of_match) -> ConeCoefficients {
    const double match = dilation_of(flow_of_match);
    const double divisor = std::sqrt(1.0 - match * match / 3.0) + match * sine / 3.0;
    return {sine / divisor, cosine / divisor, dilation_of(flow)};
  };
  switch (m.cone) {
    case Cone::outer:
      return edges(1.0);
    case Cone::inner:
      return edges(-1.0);
    case Cone::plane_strain_associated:
      return plane_strain(sine);
    case Cone::plane_strain:
      break;
  }
  return plane_strain(flow);
}

Law law(const Material& m) {
  const double bulk = m.bulk_modulus(), shear = m.shear_modulus();
  Law result{m.law, m.wave_modulus(), {}};
  if (m.law == LawKind::rigid) return result;
  DruckerPrager& constants = result.drucker_prager;
  constants.elastic = {bulk - 2.0 / 3.0 * shear, shear};
  if (m.law == LawKind::elastic) return result;
  const ConeCoefficients cone = cone_coefficients(m);
  constants.eta = cone.friction;
  constants.k = cone.cohesion * m.cohesion;
  constants.flow = bulk * cone.dilation / (shear + bulk * cone.friction * cone.dilation);
  constexpr double below = 1.0 - std::numeric_limits<double>::epsilon();
  constants.tension = std::min(tension_limit(m), below * (constants.k / constants.eta));
  constants.per_shear = 1.0 / (std::sqrt(3.0) * shear);
  constants.per_strain = 2.0 * shear + std::max(constants.eta, 1.0) * bulk;
  return result;
}

std::vector<Law> laws_of(const std::vector<Material>& materials) {
  std::vector<Law> laws;
  for (const Material& material : materials) {
    material.check();
    laws.push_back(law(material));
  }
  return laws;
}

}  // namespace gimpslope
