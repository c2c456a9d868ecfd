// How a scene is stepped: shape function, scheme, velocity blend, time step, loading.
#pragma once

#include <string>

namespace gimpslope {

/// Order of the sub-steps: stress first, stress last, or stress last from velocities that have gone
/// through the points and back.
enum class SchemeKind { usf, usl, musl };

/// How points take their velocities from the nodes: by the blend of PIC and FLIP, by APIC, or by
/// XPIC of some order.
enum class Transfer { flip, apic, xpic };

/// Highest order of XPIC: each costs a sweep over the points.
constexpr int kHighestOrder = 100;

/// How the half-lengths of a cpGIMP domain follow the deformation.
enum class DomainUpdate { none, jacobian, stretch, deformation_diagonal };

/// V *= 1 + tr(d) dt (paper eq. 23), or V *= exp(tr(d) dt).
enum class VolumeUpdate { linear, exponential };

/// Volume strain of a point: its own, or the mean of the points in its cell, against the locking of
/// nearly incompressible motion.
enum class VolumetricStrain { point, cell_average };

/// In which the points are kept; the grid, and what is computed on the way, is in double.
enum class Precision { double_, single };

/// Share of PIC in the velocity update (paper eq. 26: 0 is FLIP, 1 is PIC), given a step, as a
/// kinematic viscosity in m2/s, or as a relaxation time in s. The last two do not depend on the
/// step.
struct Blend {
  enum class Kind { alpha, viscosity, relaxation_time };
  Kind kind = Kind::alpha;
  double value = 0.0;

  /// Projecting a velocity field onto the grid and back damps it as a viscosity of
  /// alpha m / dt does, m being the second moment of the shape function: for the hat averaged over
  /// a domain of half-length l, h^2 (1/6 + l^2/(3 h^2)).
  double alpha(double dt, double second_moment) const;
};

/// Largest stable Courant number c dt / h. Contiguous domains add up to bilinear finite elements
/// with lumped masses, whose frequencies in plane strain are at most omega = 2 c / h, and dt = 2 /
/// omega. Nodes with little mass at a free edge are stiffer, but their motion is taken anew from
/// the points at every step; for linear hats this is the classic condition. Tests run both at the
/// limit.
constexpr double kCourantLimit = 1.0;

/// A fixed step in s, or the Courant number C of dt = C h / (c + |v|).
struct TimeStep {
  enum class Kind { fixed, courant };
  Kind kind = Kind::courant;
  double value = 0.4;
};

/// Acceleration in m/s2 that grows linearly over `ramp` seconds; 0 applies it at once.
struct Gravity {
  double x = 0.0;
  double y = 0.0;
  double ramp = 0.0;

  double factor(double time) const;
};

/// Local: force opposed to each node's velocity, in parts of its unbalanced force (Cundall).
/// Kinetic: all velocities are set to zero whenever the kinetic energy has passed a peak.
struct Damping {
  double local = 0.0;
  bool kinetic = false;
};

struct Method {
  std::string shape = "ugimp";  // one of shape_names()
  SchemeKind scheme = SchemeKind::usf;
  DomainUpdate domain_update = DomainUpdate::none;
  VolumeUpdate volume_update = VolumeUpdate::linear;
  VolumetricStrain volumetric_strain = VolumetricStrain::point;
  Transfer transfer = Transfer::flip;
  int order = 1;  // of XPIC
  Blend blend;    // of PIC and FLIP; PIC with any other transfer
  TimeStep time_step;
  Precision precision = Precision::double_;
  int threads = 1;
  bool allow_unstable = false;
  bool ledger = false;  // keep account of every joule
};

}  // namespace gimpslope
