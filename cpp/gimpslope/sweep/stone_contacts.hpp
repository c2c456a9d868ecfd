// Where rigid bodies meet each other: points of one that are as near those of the other as both are
// wide, with the normal of the line that parts the two best.
#pragma once

#include <cmath>

#include "../view.hpp"
#include "body_terms.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {

constexpr double kSeen = 0.1;      // gap at which a contact begins to be watched, cells
constexpr double kSurround = 1.5;  // distance of the points that tell a normal, cells

/// Some points of a body.
struct Crowd {
  double *x, *y, *half;
  int count = 0;

  /// The point that lies farthest along a direction, among those within `reach` of a place.
  int farthest(const Pair& direction, const Pair& place, double reach) const {
    int best = -1;
    double most = 0.0;
    for (int k = 0; k < count; ++k) {
      const double dx = x[k] - place[0], dy = y[k] - place[1];
      const double along = dx * direction[0] + dy * direction[1];
      if (dx * dx + dy * dy > reach * reach || (best >= 0 && along <= most)) continue;
      best = k;
      most = along;
    }
    return best;
  }
  /// The point nearest to a place, -1 where there is none.
  int nearest_to(const Pair& place) const {
    int nearest = -1;
    double least = 0.0;
    for (int k = 0; k < count; ++k) {
      const double dx = place[0] - x[k], dy = place[1] - y[k], square = dx * dx + dy * dy;
      if (nearest >= 0 && square >= least) continue;
      nearest = k;
      least = square;
    }
    return nearest;
  }

  Pair at(int k) const { return {x[k], y[k]}; }
};

/// Points of a body within a distance of a place, in the order in which they were given.
inline void gather_crowd(const View<double>& view, int body, const double* place, double within,
                         Crowd& crowd) {
  const BodiesView& all = *view.bodies;
  crowd.count = 0;
  for (int k = all.begin[body]; k < all.begin[body + 1]; ++k) {
    const int m = all.member[k];
    const double dx = view.points.x[m] - place[0], dy = view.points.y[m] - place[1];
    if (dx * dx + dy * dy > within * within) continue;
    crowd.x[crowd.count] = view.points.x[m];
    crowd.y[crowd.count] = view.points.y[m];
    crowd.half[crowd.count] = std::sqrt(all.half_length[0][k] * all.half_length[1][k]);
    ++crowd.count;
  }
}

/// The place nearest to the origin on the line from p to q.
inline Pair nearest_on(const Pair& p, const Pair& q) {
  const Pair along = q - p;
  const double square = along.square().sum();
  const double t = square > 0.0 ? -(p * along).sum() / square : 0.0;
  return p + (t < 0.0 ? 0.0 : (t > 1.0 ? 1.0 : t)) * along;
}

/// Whether the origin lies within a triangle.
inline bool surround_origin(const Pair& p, const Pair& q, const Pair& r) {
  const auto side = [](const Pair& from, const Pair& to) {
    return from[0] * to[1] - from[1] * to[0];
  };
  const double a = side(p, q), b = side(q, r), c = side(r, p);
  return (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0);
}

/// From b to a, the shortest line between the convex hulls of the points of both around a place
/// (Gilbert, Johnson and Keerthi 1988), which is normal to the line that parts them with the widest
/// margin; zero where they overlap. Starts with a line between two of them; each line is shorter
/// than the one before, and there is a finite number of them.
inline Pair shortest_between(const Crowd& a, const Crowd& b, const Pair& place, double reach,
                             Pair line) {
  Pair first = line, second = line;
  for (;;) {
    const Pair tip = a.at(a.farthest(-line, place, reach)) - b.at(b.farthest(line, place, reach));
    const double square = line.square().sum();
    if (square - (line * tip).sum() <= 1e-12 * square) return line;
    if (surround_origin(first, second, tip)) return Pair::Zero();
    const Pair one = nearest_on(first, tip), other = nearest_on(second, tip);
    const bool take_first = one.square().sum() <= other.square().sum();
    (take_first ? second : first) = tip;
    const Pair shorter = take_first ? one : other;
    if (!(shorter.square().sum() < square)) return line;  // but for rounding
    line = shorter;
  }
}

/// Contacts of two bodies: at each point of the first that nearly touches one of the second.
inline void meet(const View<double>& view, const StepInput& input, int body, int other, Crowd& a,
                 Crowd& b) {
  const BodiesView& all = *view.bodies;
  const double seen = kSeen * view.grid.cell, reach = kSurround * view.grid.cell;
  const double *centre = all.state[body].centre, *opposite = all.state[other].centre;
  if (std::hypot(centre[0] - opposite[0], centre[1] - opposite[1]) >
      all.radius[body] + all.radius[other] + seen)
    return;
  gather_crowd(view, body, opposite, all.radius[other] + reach, a);
  gather_crowd(view, other, centre, all.radius[body] + reach, b);
  for (int k = 0; k < a.count; ++k) {
    const int nearest = b.nearest_to(a.at(k));
    if (nearest < 0) continue;
    const double both = a.half[k] + b.half[nearest];
    const double least = (a.at(k) - b.at(nearest)).square().sum();
    if (least > (both + seen) * (both + seen) + both * both) continue;
    const Pair between = a.at(k) - b.at(nearest), place = 0.5 * (a.at(k) + b.at(nearest));
    // Wide enough for these two, however far apart the points of a stone are.
    const double around = reach * reach > least ? reach : std::sqrt(least);
    Pair line = shortest_between(a, b, place, around, between);
    if (line.square().sum() == 0.0) line = Pair(centre[0] - opposite[0], centre[1] - opposite[1]);
    const double length = std::hypot(line[0], line[1]);
    if (length == 0.0) continue;
    const Pair normal = (1.0 / length) * line;
    const double gap = (between * normal).sum() - both;
    const double aside = std::fabs(between[1] * normal[0] - between[0] * normal[1]);
    if (gap > seen || aside > both) continue;
    if (*all.contact_count == all.contact_room) {
      *all.contacts_missed = true;
      return;
    }
    Contact& contact = all.contacts[(*all.contact_count)++];
    contact = {};
    contact.body = body;
    contact.other = other;
    set(contact.normal, normal);
    set(contact.place, place);
    contact.closing = gap > 0.0 ? gap / input.dt : 0.0;  // not thrown apart
    const double mine = all.mutual_friction[body], its = all.mutual_friction[other];
    contact.friction = mine < its ? mine : its;
  }
}

/// Contacts of all bodies with each other.
inline void add_stone_contacts(const View<double>& view, const StepInput& input) {
  const BodiesView& all = *view.bodies;
  double* room[6];
  for (int k = 0; k < 6; ++k) room[k] = all.near + static_cast<std::ptrdiff_t>(k) * all.near_room;
  Crowd a{room[0], room[1], room[2]}, b{room[3], room[4], room[5]};
  for (int k = 0; k < all.pair_count; ++k)
    meet(view, input, all.pairs[2 * k], all.pairs[2 * k + 1], a, b);
}

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
