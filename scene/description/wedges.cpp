// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/wedges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "core/error.h"
#include "core/units.h"
#include "scene/description/triangle_tree.h"

namespace greatx::scene {

/// Describes a piece of an edge with the same facets from end to end. The exterior opens from facet_0 by the
/// right hand about a to b.
struct EdgePiece {
  dvec3 a, b;
  uint32_t facet_0 = no_facet, facet_n = no_facet;
  dvec3 tangent_0{0.0}, tangent_n{0.0};
  double gap = 2.0 * pi;  ///< the exterior angle
  double length() const { return glm::distance(a, b); }
};

namespace {

using Piece = EdgePiece;

/// Facets whose directions around an edge differ by less than this are in the same place.
constexpr double same_direction_rad = 1e-4;

auto key(const dvec3& point) { return std::tuple(point.x, point.y, point.z); }

/// Describes a side of a facet's triangle across which no other triangle of the facet continues.
struct Side {
  dvec3 a, b;  ///< whether the triangle is on the left of a to b, seen from the facet's front
  bool left;   ///< of a to b, seen from the facet's front: the side of the triangle
};

std::vector<Side> outline(const Scene& scene, const Facet& facet) {
  std::vector<Side> sides;
  for (uint32_t t = facet.first_triangle; t < facet.first_triangle + facet.triangle_count; ++t) {
    const dvec3* corners = scene.facet_triangles[t].corners;
    for (int k = 0; k < 3; ++k) {
      dvec3 a = corners[k], b = corners[(k + 1) % 3];
      if (key(b) < key(a)) std::swap(a, b);
      const dvec3 turn = glm::cross(b - a, corners[(k + 2) % 3] - a);
      sides.push_back({a, b, glm::dot(turn, facet.normal) > 0.0});
    }
  }
  const auto edge = [](const Side& side) { return std::tuple(key(side.a), key(side.b)); };
  std::sort(sides.begin(), sides.end(), [&](const Side& left, const Side& right) {
    return std::tuple(edge(left), left.left) < std::tuple(edge(right), right.left);
  });
  std::vector<Side> kept;
  for (size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && edge(sides[end]) == edge(sides[begin])) ++end;
    if (sides[begin].left == sides[end - 1].left) kept.push_back(sides[begin]);
  }
  return kept;
}

/// Describes the part of an edge on which a triangle lies, and the sides of the edge to which it goes off.
struct Contact {
  double from = 0.0, to = 0.0;  ///< metres from the edge's start
  uint32_t facet = 0;
  dvec3 tangent{0.0};  ///< unit, in the facet, perpendicular to the edge
  bool along_tangent = false, against_tangent = false;
};

/// Returns the part of the edge between start and end that lies on the outline of the triangle or inside the
/// triangle.
std::optional<Contact> contact_of(const FacetTriangle& triangle, uint32_t index, const Facet& facet,
                                  const dvec3& start, const dvec3& edge, double length, double weld) {
  const dvec3 across = glm::cross(facet.normal, edge);
  if (glm::length(across) < 0.5) return std::nullopt;
  Contact contact{.from = 1e300, .to = -1e300, .facet = index, .tangent = glm::normalize(across)};
  std::array<double, 3> t{}, v{};
  for (int k = 0; k < 3; ++k) {
    t[k] = glm::dot(triangle.corners[k] - start, edge);
    v[k] = glm::dot(triangle.corners[k] - start, contact.tangent);
    if (std::abs(v[k]) <= weld) v[k] = 0.0;
  }
  const auto reach = [&](double at) {
    contact.from = std::min(contact.from, at);
    contact.to = std::max(contact.to, at);
  };
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (v[k] == 0.0) reach(t[k]);
    if (v[k] * v[next] < 0.0) reach(t[k] + (t[next] - t[k]) * (v[k] / (v[k] - v[next])));
    contact.along_tangent = contact.along_tangent || v[k] > 0.0;
    contact.against_tangent = contact.against_tangent || v[k] < 0.0;
  }
  contact.from = std::max(contact.from, 0.0);
  contact.to = std::min(contact.to, length);
  if (contact.to - contact.from <= weld) return std::nullopt;
  // Both ends must lie in the facet's plane; corners may be off it by a weld.
  for (const double at : {contact.from, contact.to}) {
    if (std::abs(glm::dot(facet.normal, start + at * edge) - facet.offset) > 2.0 * weld) return std::nullopt;
  }
  return contact;
}

/// Describes a facet that goes off from the edge.
struct Direction {
  double angle;  ///< about the edge, by the right hand
  uint32_t facet;
  dvec3 tangent;
};

/// Returns the gap that is wider than pi, if there is one, with the facets beside it.
std::optional<Piece> widest_gap(std::vector<Direction>& around, const dvec3& a, const dvec3& b, double flat) {
  std::sort(around.begin(), around.end(), [](const Direction& x, const Direction& y) {
    return std::tuple(x.angle, x.facet) < std::tuple(y.angle, y.facet);
  });
  const size_t count = around.size();
  const auto turn = [&](size_t from, size_t to) {  // angle from one direction to a later one
    const double angle = around[to].angle - around[from].angle;
    return to > from ? angle : angle + 2.0 * pi;
  };
  size_t last = count - 1;  // the direction before the gap
  for (size_t i = 0; i < count; ++i)
    if (turn(i, (i + 1) % count) > turn(last, (last + 1) % count)) last = i;
  const size_t first = (last + 1) % count;
  const double gap = turn(last, first);
  if (gap <= pi + flat) return std::nullopt;
  // Of the directions that are equal within rounding, the lowest facet counts.
  const Direction *before = &around[last], *after = &around[first];
  for (size_t i = 0; i < count; ++i) {
    const Direction& other = around[(first + i) % count];
    const double from_first = std::remainder(other.angle - around[first].angle, 2.0 * pi);
    const double to_last = std::remainder(other.angle - around[last].angle, 2.0 * pi);
    if (std::abs(from_first) <= same_direction_rad && other.facet < after->facet) after = &other;
    if (std::abs(to_last) <= same_direction_rad && other.facet < before->facet) before = &other;
  }
  if (2.0 * pi - gap <= same_direction_rad)
    return Piece{a, b, before->facet, no_facet, before->tangent, dvec3(0.0), gap};
  if (before->facet <= after->facet)
    return Piece{a, b, before->facet, after->facet, before->tangent, after->tangent, gap};
  return Piece{b, a, after->facet, before->facet, after->tangent, before->tangent, gap};
}

/// Finds the edges of one body.
class EdgeFinder {
 public:
  EdgeFinder(const Scene& scene, const WedgeOptions& options, const std::vector<uint32_t>& facets)
      : scene_(scene),
        options_(options),
        facets_(facets),
        triangles_(triangles_of(scene, facets, facet_of_)),
        tree_(triangles_) {}

  std::vector<Piece> pieces() {
    std::vector<Piece> found;
    for (const Side& side : sides()) along(side.a, side.b, found);
    return found;
  }

 private:
  /// Returns the sides of all outlines. A side that several facets share appears once, since the facets along
  /// it are the same for each of them. Processing it for each facet would take quadratic time around an edge
  /// of very many facets.
  std::vector<Side> sides() const {
    std::vector<Side> all;
    for (const uint32_t facet : facets_)
      for (const Side& side : outline(scene_, scene_.facets[facet])) all.push_back(side);
    std::vector<size_t> order(all.size());
    std::iota(order.begin(), order.end(), size_t{0});
    const auto edge = [&](size_t index) { return std::tuple(key(all[index].a), key(all[index].b)); };
    std::sort(order.begin(), order.end(),
              [&](size_t x, size_t y) { return std::tuple(edge(x), x) < std::tuple(edge(y), y); });
    std::vector<bool> again(all.size());
    for (size_t i = 1; i < order.size(); ++i) again[order[i]] = edge(order[i]) == edge(order[i - 1]);
    std::vector<Side> once;
    for (size_t i = 0; i < all.size(); ++i)
      if (!again[i]) once.push_back(all[i]);
    return once;
  }

  static std::vector<FacetTriangle> triangles_of(const Scene& scene, const std::vector<uint32_t>& facets,
                                                 std::vector<uint32_t>& facet_of) {
    std::vector<FacetTriangle> triangles;
    for (const uint32_t facet : facets) {
      const Facet& entry = scene.facets[facet];
      for (uint32_t t = entry.first_triangle; t < entry.first_triangle + entry.triangle_count; ++t) {
        triangles.push_back(scene.facet_triangles[t]);
        facet_of.push_back(facet);
      }
    }
    return triangles;
  }

  void along(const dvec3& a, const dvec3& b, std::vector<Piece>& found) {
    const double length = glm::distance(a, b), weld = options_.weld_distance_m;
    if (length <= weld) return;
    const dvec3 edge = (b - a) / length;
    near_.clear();
    tree_.near_segment(a, b, 2.0 * weld, near_);
    contacts_.clear();
    std::vector<double>& cuts = cuts_;
    cuts.assign({0.0, length});
    for (const uint32_t triangle : near_) {
      const uint32_t facet = facet_of_[triangle];
      const auto contact =
          contact_of(triangles_[triangle], facet, scene_.facets[facet], a, edge, length, weld);
      if (!contact) continue;
      contacts_.push_back(*contact);
      for (const double cut : {contact->from, contact->to})
        if (cut > weld && cut < length - weld) cuts.push_back(cut);
    }
    std::sort(cuts.begin(), cuts.end());
    double from = 0.0;
    for (const double to : cuts) {
      if (to - from <= weld) continue;
      const auto at = [&](double distance) {
        return distance == 0.0 ? a : distance == length ? b : a + distance * edge;
      };
      if (const auto piece = judge(at(from), at(to), edge, 0.5 * (from + to))) found.push_back(*piece);
      from = to;
    }
  }

  std::optional<Piece> judge(const dvec3& a, const dvec3& b, const dvec3& edge, double middle) {
    const dvec3 seed = std::abs(edge.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 x = glm::normalize(glm::cross(edge, seed)), y = glm::cross(edge, x);
    around_.clear();
    for (const Contact& contact : contacts_) {
      if (middle < contact.from || middle > contact.to) continue;
      for (const double sign : {1.0, -1.0}) {
        if (!(sign > 0.0 ? contact.along_tangent : contact.against_tangent)) continue;
        const dvec3 tangent = sign * contact.tangent;
        around_.push_back({std::atan2(glm::dot(tangent, y), glm::dot(tangent, x)), contact.facet, tangent});
      }
    }
    if (around_.empty()) return std::nullopt;  // a facet without area
    const auto piece = widest_gap(around_, a, b, options_.flat_angle_rad);
    if (piece && piece->facet_n == no_facet && !options_.free_edges) return std::nullopt;
    return piece;
  }

  const Scene& scene_;
  const WedgeOptions& options_;
  const std::vector<uint32_t>& facets_;
  std::vector<uint32_t> facet_of_;  ///< [triangles_]
  std::vector<FacetTriangle> triangles_;
  TriangleTree tree_;
  std::vector<uint32_t> near_;
  std::vector<Contact> contacts_;
  std::vector<double> cuts_;
  std::vector<Direction> around_;
};

/// Returns `direction` turned into the facet's plane, perpendicular to the edge.
dvec3 tangent_in(const Facet& facet, const dvec3& edge, const dvec3& direction) {
  const dvec3 tangent = glm::normalize(glm::cross(facet.normal, edge));
  return glm::dot(tangent, direction) < 0.0 ? -tangent : tangent;
}

Wedge make_wedge(const Scene& scene, const Piece& piece, dvec3 a, dvec3 b) {
  const Facet& facet_0 = scene.facets[piece.facet_0];
  dvec3 edge = glm::normalize(b - a);
  Wedge wedge;
  wedge.tangent_0 = tangent_in(facet_0, edge, piece.tangent_0);
  if (piece.facet_n == no_facet) {
    // Face 0 is the front: the exterior begins on the side to which the facet's normal points.
    if (glm::dot(glm::cross(edge, wedge.tangent_0), facet_0.normal) < 0.0) {
      std::swap(a, b);
      edge = -edge;
    }
  } else {
    const dvec3 tangent_n = tangent_in(scene.facets[piece.facet_n], edge, piece.tangent_n);
    const dvec3 normal = glm::cross(edge, wedge.tangent_0);
    const double angle = std::atan2(glm::dot(tangent_n, normal), glm::dot(tangent_n, wedge.tangent_0));
    wedge.n = std::min((angle < 1.0 ? angle + 2.0 * pi : angle) / pi, 2.0);
  }
  wedge.a = a;
  wedge.b = b;
  wedge.normal_0 = glm::cross(edge, wedge.tangent_0);
  wedge.facet_0 = piece.facet_0;
  wedge.facet_n = piece.facet_n;
  wedge.body = facet_0.body;
  return wedge;
}

/// Joins pieces between the same facets into straight runs.
class Joiner {
 public:
  Joiner(const Scene& scene, const WedgeOptions& options) : scene_(scene), options_(options) {}

  void join(std::vector<Piece> pieces, std::vector<Wedge>& wedges) {
    // The longest piece determines the line best.
    std::sort(pieces.begin(), pieces.end(), [](const Piece& x, const Piece& y) {
      return std::tuple(-x.length(), key(x.a), key(x.b)) < std::tuple(-y.length(), key(y.a), key(y.b));
    });
    while (!pieces.empty()) {
      const Piece lead = pieces.front();
      const dvec3 line = direction(lead);
      std::vector<Piece> same, rest;
      for (const Piece& piece : pieces) (on_line(piece, lead, line) ? same : rest).push_back(piece);
      runs(lead, line, same, wedges);
      pieces = std::move(rest);
    }
  }
  uint64_t too_short() const { return too_short_; }

 private:
  /// Returns the line that both planes have in common. It is more exact than the line of a short piece. The
  /// result is empty if the planes are almost parallel.
  std::optional<dvec3> common_line(const Piece& piece) const {
    const dvec3 line = glm::cross(scene_.facets[piece.facet_0].normal, scene_.facets[piece.facet_n].normal);
    if (glm::length(line) < 1e-2) return std::nullopt;
    return glm::normalize(glm::dot(line, piece.b - piece.a) < 0.0 ? -line : line);
  }
  dvec3 direction(const Piece& piece) const {
    const auto line = piece.facet_n == no_facet ? std::nullopt : common_line(piece);
    return line ? *line : glm::normalize(piece.b - piece.a);
  }

  bool on_line(const Piece& piece, const Piece& lead, const dvec3& line) const {
    if (glm::dot(piece.b - piece.a, line) < 0.5 * piece.length()) return false;
    if (glm::dot(piece.tangent_0, lead.tangent_0) < 0.5) return false;
    if (lead.facet_n != no_facet && common_line(lead)) return true;  // the planes have no other line
    const auto near = [&](const dvec3& point) {
      return glm::length(glm::cross(point - lead.a, line)) <= 2.0 * options_.weld_distance_m;
    };
    return near(piece.a) && near(piece.b);
  }

  void runs(const Piece& lead, const dvec3& line, std::vector<Piece>& pieces, std::vector<Wedge>& wedges) {
    const auto at = [&](const dvec3& point) { return glm::dot(point - lead.a, line); };
    std::sort(pieces.begin(), pieces.end(), [&](const Piece& x, const Piece& y) {
      return std::tuple(at(x.a), key(x.a), key(x.b)) < std::tuple(at(y.a), key(y.a), key(y.b));
    });
    for (size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
      dvec3 b = pieces[begin].b;
      for (end = begin + 1; end < pieces.size() && at(pieces[end].a) <= at(b) + options_.weld_distance_m;
           ++end)
        if (std::tuple(at(pieces[end].b), key(pieces[end].b)) > std::tuple(at(b), key(b))) b = pieces[end].b;
      if (glm::distance(pieces[begin].a, b) < options_.min_length_m) {
        ++too_short_;
      } else {
        wedges.push_back(make_wedge(scene_, lead, pieces[begin].a, b));
      }
    }
  }

  const Scene& scene_;
  const WedgeOptions& options_;
  uint64_t too_short_ = 0;
};

std::vector<std::vector<uint32_t>> facets_of_bodies(const Scene& scene) {
  std::vector<std::vector<uint32_t>> of_body(scene.bodies.size());
  for (uint32_t facet = 0; facet < scene.facets.size(); ++facet)
    of_body.at(scene.facets[facet].body).push_back(facet);
  return of_body;
}

void check(const WedgeOptions& options) {
  GREATX_CHECK(options.weld_distance_m > 0.0 && options.flat_angle_rad >= 0.0 && options.min_length_m >= 0.0,
               "weld {} m, flat {} rad, shortest {} m", options.weld_distance_m, options.flat_angle_rad,
               options.min_length_m);
}

/// Returns the pieces of the edges of one body, by pairs of facets.
std::vector<Piece> pieces_of_body(const Scene& scene, const WedgeOptions& options,
                                  const std::vector<uint32_t>& facets) {
  std::vector<Piece> pieces = EdgeFinder(scene, options, facets).pieces();
  std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& x, const Piece& y) {
    return std::tuple(x.facet_0, x.facet_n) < std::tuple(y.facet_0, y.facet_n);
  });
  return pieces;
}

/// Appends the wedges that the wanted ones of `pieces` make.
template <typename Wanted>
void join_pieces(const std::vector<Piece>& pieces, const Wanted& wanted, Joiner& joiner,
                 std::vector<Wedge>& wedges) {
  std::vector<Piece> of_pair;
  const auto end_pair = [&] {
    if (!of_pair.empty()) joiner.join(std::move(of_pair), wedges);
    of_pair.clear();
  };
  for (const Piece& piece : pieces) {
    if (!wanted(piece)) continue;
    if (!of_pair.empty() &&
        (of_pair.front().facet_0 != piece.facet_0 || of_pair.front().facet_n != piece.facet_n))
      end_pair();
    of_pair.push_back(piece);
  }
  end_pair();
}

}  // namespace

struct EdgeSurvey::Pieces {
  std::vector<std::vector<EdgePiece>> of_bodies;
};

EdgeSurvey::EdgeSurvey(const Scene& scene, const WedgeOptions& least)
    : scene_(&scene), least_(least), pieces_(std::make_unique<Pieces>()) {
  check(least);
  for (const std::vector<uint32_t>& facets : facets_of_bodies(scene))
    pieces_->of_bodies.push_back(pieces_of_body(scene, least, facets));
}

EdgeSurvey::~EdgeSurvey() = default;

bool EdgeSurvey::covers(const WedgeOptions& options) const {
  return (least_.free_edges || !options.free_edges) && options.flat_angle_rad >= least_.flat_angle_rad &&
         options.weld_distance_m == least_.weld_distance_m;
}

std::vector<Wedge> EdgeSurvey::wedges(const WedgeOptions& options, uint64_t* too_short) const {
  check(options);
  GREATX_CHECK(
      covers(options), "wedges with a flat angle of {} rad and a weld of {} m of a survey with {}, {}",
      options.flat_angle_rad, options.weld_distance_m, least_.flat_angle_rad, least_.weld_distance_m);
  const auto wanted = [&](const Piece& piece) {
    return piece.gap > pi + options.flat_angle_rad && (options.free_edges || piece.facet_n != no_facet);
  };
  std::vector<Wedge> wedges;
  Joiner joiner(*scene_, options);
  for (const std::vector<Piece>& pieces : pieces_->of_bodies) join_pieces(pieces, wanted, joiner, wedges);
  std::sort(wedges.begin(), wedges.end(), [](const Wedge& x, const Wedge& y) {
    return std::tuple(x.body, x.facet_0, x.facet_n, key(x.a), key(x.b)) <
           std::tuple(y.body, y.facet_0, y.facet_n, key(y.a), key(y.b));
  });
  if (too_short) *too_short = joiner.too_short();
  return wedges;
}

std::vector<Wedge> find_wedges(const Scene& scene, const WedgeOptions& options, uint64_t* too_short,
                               const EdgeSurvey* known) {
  if (known != nullptr && known->covers(options)) return known->wedges(options, too_short);
  return EdgeSurvey(scene, options).wedges(options, too_short);
}

bool any_wedge(const Scene& scene, const WedgeOptions& options,
               const std::function<bool(const Wedge&)>& wanted) {
  check(options);
  std::vector<std::vector<uint32_t>> bodies = facets_of_bodies(scene);
  std::ranges::stable_sort(bodies, {}, &std::vector<uint32_t>::size);
  Joiner joiner(scene, options);
  return std::ranges::any_of(bodies, [&](const std::vector<uint32_t>& facets) {
    std::vector<Wedge> wedges;
    join_pieces(
        pieces_of_body(scene, options, facets), [](const Piece&) { return true; }, joiner, wedges);
    return std::ranges::any_of(wedges, wanted);
  });
}

}  // namespace greatx::scene
