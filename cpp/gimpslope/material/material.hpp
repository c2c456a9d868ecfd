// A material as an engineer gives it, and the constants of its law.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "drucker_prager.hpp"
#include "elastic.hpp"

namespace gimpslope {

enum class LawKind { elastic, drucker_prager, rigid };

/// The Drucker-Prager cones that go by one friction angle: through the outer or inner corners of
/// the Mohr-Coulomb pyramid, or giving its collapse load in plane strain, with associated flow or
/// with the dilation angle of the material.
enum class Cone { outer, inner, plane_strain_associated, plane_strain };

struct Material {
  double density;        // kg/m3, at the start
  double young = 0.0;    // Pa; of a rigid one not asked for
  double poisson = 0.0;  // likewise
  LawKind law = LawKind::elastic;
  double friction = 0.0;  // degrees
  double cohesion = 0.0;  // Pa
  double dilation = 0.0;  // degrees
  Cone cone = Cone::plane_strain_associated;
  double tension_cutoff = std::numeric_limits<double>::infinity();  // Pa, of the mean stress

  std::optional<double> interface_friction;  // degrees, of a rigid one; none: soil sticks to it
  double mutual_friction = 0.0;              // degrees, of rigid ones along each other

  double interface_coefficient() const;  // of friction along soil, negative where that sticks
  double mutual_coefficient() const;     // of friction along other rigid ones

  double bulk_modulus() const;   // Pa
  double shear_modulus() const;  // Pa
  double wave_modulus() const;   // Pa; of uniaxial strain, K + 4G/3; of a rigid one 0, for no
                                 // wave in it limits the step

  /// Refuses values out of range with std::invalid_argument.
  void check() const;
};

/// sqrt(J2) + friction p = cohesion c; plastic flow dilates by `dilation` times its multiplier.
struct ConeCoefficients {
  double friction, cohesion, dilation;
};

ConeCoefficients cone_coefficients(const Material& material);

/// Largest mean stress the material can carry, Pa: the cut-off, or the apex of the cone c cot(phi).
double tension_limit(const Material& material);

/// What the sweeps need of a material.
struct Law {
  LawKind kind;
  double wave_modulus;
  DruckerPrager drucker_prager;  // of an elastic material, its elastic part alone
};

Law law(const Material& material);

/// The laws of materials, which are checked first.
std::vector<Law> laws_of(const std::vector<Material>& materials);

inline namespace GIMPSLOPE_INSTRUCTION_SET {

/// Calls act(constants) with the constants of the law that a deformable material follows: the one
/// place that tells these apart.
template <class Act>
void with_constants(const Law& law, Act act) {
  switch (law.kind) {
    case LawKind::elastic:
      act(law.drucker_prager.elastic);
      return;
    case LawKind::drucker_prager:
      act(law.drucker_prager);
      return;
    case LawKind::rigid:
      return;
  }
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET

}  // namespace gimpslope
