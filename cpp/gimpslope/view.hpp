// What the sweeps see of a solver: plain pointers, so that the code of every instruction set shares
// nothing but data with the rest.
#pragma once

#include <cstdint>

#include "buffer.hpp"
#include "ledger.hpp"
#include "material/material.hpp"
#include "method.hpp"
#include "stopwatch.hpp"
#include "wall.hpp"

namespace gimpslope {

class Team;

/// Consecutive points of one material that a sweep takes through its short loops while they stay in
/// the first-level cache.
struct Block {
  std::int32_t begin, end;
  std::int32_t material;
};
constexpr int kBlock = 64;

/// Consecutive blocks whose points start in the same few rows of cells, and its share of the rows
/// of nodes.
struct Slab {
  std::int32_t begin, end;
  std::int32_t first_row, end_row;
};

/// One value a point and component, in storage order. In single precision the places are counted
/// from the node `home` of each point, which is near, so that they do not lose digits to their
/// distance from the origin. Half-lengths and their reference, the rows of
/// the deformation gradient, those of the affine motion, and body forces (a unit of mass) are
/// null where there is no need of them.
template <class Real>
struct PointsView {
  static constexpr bool relative = sizeof(Real) < sizeof(double);

  Real *x, *y, *vx, *vy;
  Real *stress_xx, *stress_yy, *stress_zz, *stress_xy;
  Real *volume, *plastic_strain;
  const Real* mass;
  Real* half_length[2];
  const Real* domain_reference[2];
  Real* deformation[4];
  Real* affine[4];
  const Real* body_force[2];
  const std::int32_t* home;  // null where places are absolute
};

/// Active nodes of a row: [begin, end).
struct NodeRange {
  std::int32_t begin, end;
};

/// Four doubles a node. `momentum` {m, m, m vx, m vy}, `velocity` {vx, vx, vy, vy} and `force`
/// {fx, fx, fy, fy} (the sum of each pair is the force) are laid out so that one multiplication by
/// {S,x S S,x S} serves both components; `update` {dt vx, dt vy, bx, by} is what a point adds to
/// its motion. `body` {bx, by, -, -}, the points' body forces, is null until there are any;
/// `cells` {V, V h tr(L) before, V (sxx + syy) / 2, V after the stress update}, sums over the
/// points in the cell to the upper right of the node, is null unless they are averaged. `soil`
/// {V h dS/dx, V h dS/dy, V S, -}, the volume of deformable points at the node and its gradient, is
/// null unless they may slide along a rigid body. `terms` {u, sum of u} and `spread` {S+ S u before
/// it is divided by the mass, -, -} are those of XPIC, null without.
struct GridView {
  double cell;
  double left, bottom;       // coordinates of node 0
  std::int32_t column, row;  // of node 0, from the origin of the grid
  int stride;                // nodes from one row to the next
  int rows;
  const NodeRange* active;  // of each row
  double *momentum, *velocity, *force, *update, *body, *cells, *soil, *terms, *spread;
  WallKind kind[4];
  double friction[4];
  int wall[4];  // the last (left, bottom) or first (right, top) node on or beyond a wall
};

/// A rigid body: where it is, and what has become of it since the clock was last set to zero.
struct BodyState {
  double centre[2], angle;             // m; radians, counter-clockwise, since its points were given
  double velocity[2], spin;            // m/s; radians a second
  double impulse[2], angular_impulse;  // of all but gravity, N s/m; N m s/m, about the centre
};

/// How soil at a node meets a body that it may slide along; `welded` where there is no telling
/// which way the surface faces.
enum class Meeting : std::uint8_t { apart, slipping, stuck, welded };

/// A node that a body reaches, and what it is in a step where the body holds it; vectors {x, y}.
struct BodyNode {
  std::int32_t node;
  bool held;
  double share;                   // of its cell that the body fills
  double arm[2];                  // from the body's centre, m
  double mass;                    // of the soil, kg/m
  double raw[2], before[2];       // velocity of the soil, and with the body, m/s
  double internal[2], acting[2];  // forces, N/m
  double body[2], damping[2];
  // Where soil may slide along the body:
  double slope[2];   // down which the share falls, a cell
  double normal[2];  // of the body's surface, outwards
  double free[2];    // velocity of the soil after the forces, as if there were no body, m/s
  double taken[2];   // impulse that the soil takes from the body, N s/m
  double slip;       // its direction along the surface, 1 or -1, of soil that slips
  Meeting meeting;   // in the step before, then in this one
  bool damped;       // alone, not with the body
};

/// A body with the nodes it holds, as one: its centre seen from that of the body alone. One that
/// soil may slide along is alone, and its velocity includes what the nodes have taken from it.
struct HeldBody {
  double mass, inertia;  // kg/m; kg m
  double centre[2];      // m
  double velocity[2], spin;
  double damping[2], damping_moment;  // N/m; N m/m
  double taken[2], taken_moment;      // by the nodes; N s/m; N m s/m
  double unsettled;                   // change of its speed when they were last looked for, m/s
  bool touches;                       // a wall or another body
};

/// What a body reports of a step.
struct BodyReport {
  double travel = 0.0;     // largest displacement of a point, m
  double speed = 0.0;      // of the fastest point, m/s
  Ledger ledger;           // entries of its own and of its nodes
  std::int32_t lost = -1;  // storage index of a point that it would move too far
};

/// Where a body meets a wall or, if `other` is not negative, another body.
struct Contact {
  std::int32_t body, other;
  double normal[2];       // from the wall or the other body
  double place[2];        // m
  double closing;         // speed that would close the gap in the step, m/s
  double friction;        // coefficient; infinite where the wall holds what touches it
  double pushed, rubbed;  // impulses, N s/m
};

/// Rigid bodies. Body b has the points [begin[b], begin[b + 1]) of these arrays, and reaches at
/// most window^2 nodes: nodes[b window^2] and so on, `reaches[b]` of them.
struct BodiesView {
  int count;
  const std::int32_t* begin;
  const std::int32_t* member;                // storage index of a point
  const double *offset[2], *half_length[2];  // from the centre at angle 0, m; m
  const double *mass, *inertia, *radius;     // of a body: kg/m; kg m; m
  const double* friction;                    // coefficient along soil; negative where that sticks
  const double* mutual_friction;             // coefficient along other bodies
  BodyState* state;
  BodyReport* reports;
  HeldBody* held;
  BodyNode* nodes;
  std::int32_t* reaches;
  int window;
  double* shares;             // and slopes, 3 window^2 for each thread
  std::int32_t* owner;        // of each node of the grid: a place in `nodes`, -1 between steps
  const std::int32_t* pairs;  // of bodies that may meet before the next sort
  int pair_count;
  double* near;             // room for x, y and half-length of points of two bodies,
  int near_room;            // so many of each
  Meeting* meetings;        // in the step before: window^2 of each body,
  std::int32_t* window_at;  // column and row of the first of these, from the grid's origin
  Contact* contacts;
  int contact_room;
  int* contact_count;
  bool* contacts_missed;       // for want of room
  double* contacts_unsettled;  // largest change of a speed in the last sweep, m/s
};

/// What is known of the points of a block, so that not all need be looked at in each step; zeros
/// where it is not.
struct Known {
  double margin = 0.0;                       // from yield, see sweep/yielding.hpp
  double most_volume = 0.0;                  // after the last strain, m2
  double least_mass = 0.0, most_mass = 0.0;  // kg/m
};

/// h times the velocity gradient of the points of a block.
struct Gradient {
  alignas(kCacheLine) double vx_x[kBlock], vx_y[kBlock], vy_x[kBlock], vy_y[kBlock];
};

/// What a step works on. The points are kept in double or single precision; the grid, and all
/// that is computed on the way, is in double.
template <class Real>
struct View {
  PointsView<Real> points;
  GridView grid;
  const Block* blocks;
  Known* known;         // of each block
  Gradient* gradients;  // of each block, null unless volume strains are averaged
  const Slab* slabs;
  int slab_count;
  const std::int32_t* shared;  // slabs by thread, even ones first: see for_each_slab
  const std::int32_t* shares;  // those of thread t from shares[t] on
  const Law* laws;             // of each material
  double half_length;          // of all points alike, where points.half_length is null
  DomainUpdate domain_update;
  VolumeUpdate volume_update;
  const BodiesView* bodies;  // null where there are none
  Team* team;
  Ledger* ledger;  // of each row of nodes; null where none is kept
  Seconds* seconds;
};

struct StepInput {
  double dt, alpha;
  double gravity_x, gravity_y;            // that acts
  double full_gravity_x, full_gravity_y;  // at the end of its ramp
  double local_damping;
  int order;         // of XPIC
  bool stress_last;  // forces come from the stress before the step
  bool wants_speeds, wants_energies;
};

/// Largest squared speed, and largest squared wave speed.
struct Speeds {
  double point = 0.0, wave = 0.0;
};

/// Energies in J per metre of thickness; the potential is zero at the origin of the coordinates,
/// under full gravity.
struct Energies {
  double kinetic = 0.0, potential = 0.0, elastic = 0.0;
  double max_speed = 0.0;  // m/s; in the report of a slab its square
};

/// What a slab reports of a step. Maxima do not depend on the order of the slabs.
struct Report {
  double travel = 0.0;     // largest displacement of a point, cells
  double growth = 0.0;     // largest change of a half-length, cells; the two add up at an edge
  double width = 0.0;      // largest domain width, cells
  Ledger ledger;           // the points' entries, where one is kept
  Speeds speeds;           // after the step, where asked for
  Energies energies;       // where asked for
  std::int32_t lost = -1;  // storage index of a point that moved or grew beyond the limit
};

}  // namespace gimpslope
