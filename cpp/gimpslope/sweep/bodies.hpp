// Rigid bodies in a step. Their points take part in the exchange of momentum with the nodes as all
// others do; a body has the momentum and angular momentum of its points, and moves them as one.
//
// Angular momentum is taken at the nodes: the share of a point in node n is m S (xn - c) x vn, and
// not m S (xp - c) x vn, so that a body alone on the grid turns on for ever, and what one body
// gives to its surroundings is what they take.
#pragma once

#include <cmath>

#include "energies.hpp"
#include "loops.hpp"
#include "move.hpp"
#include "speeds.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

template <class Real>
bool is_rigid(const View<Real>& view, const Block& block) {
  return view.bodies != nullptr && view.laws[block.material].kind == LawKind::rigid;
}

/// Moments about each point of a block of what its nodes add to its place and velocity.
template <class Shape, class Real>
void gather_moments(const View<Real>& view, int begin, int n,
                    const Weights<Shape, Need::values>& weights) {
  const double h = view.grid.cell;
  for (int k = 0; k < n; ++k) {
    double x = 0.0, y = 0.0;  // of the point from its first node: shape functions keep places
    for (int i = 1; i < Shape::nodes; ++i) x += i * weights.value_x(i, k);
    for (int j = 1; j < Shape::nodes; ++j) y += j * weights.value_y(j, k);
    const double* first = view.grid.update + 4 * weights.first[k];
    const Quad by_x = gather<Shape>(
        first, view.grid.stride, [&](int i) { return (i - x) * weights.value_x(i, k); },
        [&](int j) { return weights.value_y(j, k); });
    const Quad by_y = gather<Shape>(
        first, view.grid.stride, [&](int i) { return weights.value_x(i, k); },
        [&](int j) { return (j - y) * weights.value_y(j, k); });
    view.bodies->exchange[2][begin + k] = h * (by_x[1] - by_y[0]);
    view.bodies->exchange[3][begin + k] = h * (by_x[3] - by_y[2]);
  }
}

/// Velocities of the points of a block as if they were free; their displacements are kept.
template <class Shape, bool kOwnDomain, class Real>
void exchange_block(const View<Real>& view, const StepInput& input, const Block& block,
                    Report& report) {
  const int begin = block.begin, n = block.end - block.begin;
  Weights<Shape, Need::values> weights;
  evaluate<Shape, kOwnDomain>(view, begin, n, weights);
  Change change{};
  gather_change(view, n, weights, change);
  if (!go_near(view, begin, n, change, report)) return;
  gather_moments(view, begin, n, weights);
  const double keep = 1.0 - input.alpha;
  book_gain(view, begin, n, keep, change, report);
  for (int k = 0; k < n; ++k) {
    view.points.vx[begin + k] = keep * view.points.vx[begin + k] + change.vx[k];
    view.points.vy[begin + k] = keep * view.points.vy[begin + k] + change.vy[k];
    view.bodies->exchange[0][begin + k] = change.x[k];
    view.bodies->exchange[1][begin + k] = change.y[k];
  }
}

/// Places and velocities of a body and its points.
template <class Real>
void move_body(const View<Real>& view, const StepInput& input, int body) {
  const BodiesView& all = *view.bodies;
  const PointsView<Real>& p = view.points;
  const int begin = all.begin[body], end = all.begin[body + 1];
  BodyState& state = all.state[body];
  double momentum[2] = {}, moved[2] = {}, turned = 0.0, kinetic = 0.0;
  double of_points = 0.0, angular_momentum = 0.0;  // taken at the points, and at the nodes
  for (int k = begin; k < end; ++k) {
    const int m = all.member[k];
    const double mass = p.mass[m], vx = p.vx[m], vy = p.vy[m];
    const double x = p.x[m] - state.centre[0], y = p.y[m] - state.centre[1];
    const double dx = all.exchange[0][m], dy = all.exchange[1][m];
    momentum[0] += mass * vx;
    momentum[1] += mass * vy;
    of_points += mass * (x * vy - y * vx);
    angular_momentum += mass * all.exchange[3][m];
    moved[0] += mass * dx;
    moved[1] += mass * dy;
    turned += mass * (x * dy - y * dx + all.exchange[2][m]);
    kinetic += 0.5 * mass * (vx * vx + vy * vy);
  }
  const double mass = all.mass[body], inertia = all.inertia[body];
  const double per_mass = 1.0 / mass, per_inertia = inertia > 0.0 ? 1.0 / inertia : 0.0;
  const double vx = per_mass * momentum[0], vy = per_mass * momentum[1];
  const double spin_of_points = per_inertia * of_points;
  const double spin = per_inertia * (of_points + angular_momentum);
  state.impulse[0] += mass * (vx - state.velocity[0] - input.dt * input.gravity_x);
  state.impulse[1] += mass * (vy - state.velocity[1] - input.dt * input.gravity_y);
  state.angular_impulse += inertia * (spin - state.spin);
  state.velocity[0] = vx;
  state.velocity[1] = vy;
  state.spin = spin;
  state.centre[0] += per_mass * moved[0];
  state.centre[1] += per_mass * moved[1];
  state.angle += per_inertia * turned;

  const double cosine = std::cos(state.angle), sine = std::sin(state.angle);
  BodyReport report;
  report.loss =
      kinetic - 0.5 * (mass * (vx * vx + vy * vy) + inertia * spin_of_points * spin_of_points);
  report.gain = 0.5 * inertia * (spin - spin_of_points) * (spin + spin_of_points);
  for (int k = begin; k < end; ++k) {
    const int m = all.member[k];
    const double ox = all.offset[0][k], oy = all.offset[1][k];
    const double x = cosine * ox - sine * oy, y = sine * ox + cosine * oy;
    const double new_x = state.centre[0] + x, new_y = state.centre[1] + y;
    const double dx = std::fabs(new_x - p.x[m]), dy = std::fabs(new_y - p.y[m]);
    const double farther = dx > dy ? dx : dy;
    report.travel = farther > report.travel ? farther : report.travel;
    if (!(farther <= kFarthestStep * view.grid.cell)) report.lost = m;
    p.x[m] = new_x;
    p.y[m] = new_y;
    p.vx[m] = vx - spin * y;
    p.vy[m] = vy + spin * x;
  }
  all.reports[body] = report;
}

/// Widest domain of the points of a block, which keep theirs.
template <class Real>
void add_width(const View<Real>& view, const Block& block, Report& report) {
  for (int c = 0; c < 2; ++c)
    for (int k = block.begin; k < block.end; ++k) {
      const double width = 2.0 * view.points.half_length[c][k] / view.grid.cell;
      report.width = width > report.width ? width : report.width;
    }
}

/// Moves the bodies, then brings mass and momentum of their points to the nodes. Called by all
/// threads of a team, after the exchange of all blocks.
template <class Shape, bool kOwnDomain, class Real>
void move_bodies(const View<Real>& view, const StepInput& input, int thread, Report* reports) {
  for (int body = thread; body < view.bodies->count; body += view.team->size())
    move_body(view, input, body);
  view.team->barrier();
  for_each_slab(view, thread, [&](int slab) {
    for_each_block(view, slab, [&](const Block& block) {
      if (!is_rigid(view, block)) return;
      const int begin = block.begin, n = block.end - block.begin;
      if (view.domain_update != DomainUpdate::none) add_width(view, block, reports[slab]);
      Weights<Shape, Need::values> weights;
      evaluate<Shape, kOwnDomain>(view, begin, n, weights);
      scatter_momentum(view, begin, n, weights);
      if (input.wants_speeds) add_speeds(view, block, reports[slab].speeds);
      if constexpr (!PointsView<Real>::relative)
        if (input.wants_energies)
          add_energy_of_motion(view, block, input.full_gravity_x, input.full_gravity_y,
                               reports[slab].energies);
    });
  });
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
