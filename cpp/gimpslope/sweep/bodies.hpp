// Rigid bodies in a step, in a velocity field of their own.
//
// A body holds the nodes up to some way outside of its edge, by the share of their cells that it
// fills. In other nodes it takes no part, so that it acts as large as it is, and bodies that are
// near each other do not stick together. Where soil sticks to it, body and held nodes make one
// rigid body that keeps their momentum and angular momentum and takes up the forces of the soil at
// the nodes; where soil may slide along it, the nodes keep their own motion and take impulses from
// it (interface.hpp). It is then kept from running into walls and other bodies by impulses at the
// places where they meet.
#pragma once

#include "body_motion.hpp"
#include "contacts.hpp"
#include "held_nodes.hpp"
#include "loops.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

template <class Real>
bool is_rigid(const View<Real>& view, const Block& block) {
  return view.bodies != nullptr && view.laws[block.material].kind == LawKind::rigid;
}

/// Calls act(body) for the bodies of a thread.
template <class Real, class Act>
void for_each_body(const View<Real>& view, int thread, Act act) {
  for (int body = thread; body < view.bodies->count; body += view.team->size()) act(body);
}

/// First part of a step: which nodes each body holds, and their velocity.
template <class Shape, bool kOwnDomain>
void hold_nodes_of_bodies(const View<double>& view, int thread) {
  for_each_body(view, thread,
                [&](int body) { reach_nodes<Shape, kOwnDomain>(view, thread, body); });
  view.team->barrier();
  if (thread == 0) share_nodes(*view.bodies);
  view.team->barrier();
  for_each_body(view, thread, [&](int body) { hold_nodes(view, body); });
  view.team->barrier();
}

/// Second part, once the soil's forces are known and before the nodes are finished.
inline void take_forces_of_bodies(const View<double>& view, const StepInput& input, int thread) {
  for_each_body(view, thread, [&](int body) { take_forces(view, input, body); });
  view.team->barrier();
  if (thread == 0) resolve_contacts(view, input);
  view.team->barrier();
}

/// Third part, between the nodes and their points.
inline void move_bodies(const View<double>& view, const StepInput& input, int thread) {
  for_each_body(view, thread, [&](int body) { move_body(view, input, body); });
  view.team->barrier();
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
