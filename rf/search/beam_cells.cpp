// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/beam_cells.h"

#include <algorithm>
#include <cmath>

namespace greatx::rf {
namespace {

/// Cells are cut until they are this many times smaller than what is not settled in them: a facet that nobody has seen
/// yet, the rectangle on a facet that has been seen.
constexpr double unseen_parts = 64.0, rectangle_parts = 16.0, finest_parts = 0x1p24;
constexpr uint32_t most_tries = 256;
/// Beyond so many, pairs are not compared: the cell is too large to settle anything anyway.
constexpr size_t most_for_shells = 64, most_for_contacts = 32, most_for_wedges = 24;

/// Slope halfway between two directions, by angle.
double bisect(double a, double b) {
  const double length_a = std::sqrt(1.0 + a * a), length_b = std::sqrt(1.0 + b * b);
  return (a * length_b + b * length_a) / (length_a + length_b);
}

}  // namespace

void BeamCells::settle(const BeamView& view, const BeamCellOptions& options, std::vector<BeamHit>& hits,
                       std::vector<uint32_t>& wedges) {
  view_ = &view;
  options_ = options;
  targets_.assign(view.facets().size() * (options.walls + 1), Target{});
  done_.assign(view.facets().size(), 0);
  now_.clear(), next_.clear();
  cells_before_ = cells_;
  look_at(view.beam().window, nullptr);
  while (!next_.cells.empty()) {
    std::swap(now_, next_);
    next_.clear();
    for (const Cell& cell : now_.cells) {
      const SlopeRect& rect = cell.rect;
      const double a = bisect(rect.min_a, rect.max_a), b = bisect(rect.min_b, rect.max_b);
      // Angles that the sides span, up to a common factor.
      const bool across = (rect.max_a - rect.min_a) * std::sqrt(1.0 + b * b) >=
                          (rect.max_b - rect.min_b) * std::sqrt(1.0 + a * a);
      SlopeRect first = rect, second = rect;
      if (across)
        first.max_a = second.min_a = a;
      else
        first.max_b = second.min_b = b;
      look_at(first, &cell);
      look_at(second, &cell);
    }
  }
  report(hits, wedges);
}

void BeamCells::look_at(const SlopeRect& rect, const Cell* parent) {
  ++cells_;
  const double roundings = 1e-14 * view_->longest_direction();
  here_.rect = rect;
  here_.a = 0.5 * (rect.min_a + rect.max_a), here_.b = 0.5 * (rect.min_b + rect.max_b);
  here_.half_a = 0.5 * (rect.max_a - rect.min_a) * (1.0 + 1e-9) + roundings;
  here_.half_b = 0.5 * (rect.max_b - rect.min_b) * (1.0 + 1e-9) + roundings;
  entries_.clear();
  edges_.clear();
  if (parent) {
    for (uint32_t i = parent->first_entry; i < parent->first_entry + parent->entry_count; ++i) {
      const Entry& from = now_.entries[i];
      inherit(from, std::span(now_.edges).subspan(from.first_edge, from.edge_count), parent);
    }
  } else {
    std::vector<uint32_t> all;
    for (uint32_t facet = 0; facet < view_->facets().size(); ++facet) {
      const ViewFacet& from = view_->facets()[facet];
      all.resize(from.edge_count);
      for (uint32_t i = 0; i < from.edge_count; ++i) all[i] = from.first_edge + i;
      Entry entry;
      entry.facet = facet;
      inherit(entry, all, nullptr);
    }
  }
  choose_sample();
  if (!find_presence(parent)) return;
  find_surfaces();
  drop_hidden();
  mark_seen();
  find_wedges();
  if (settled())
    take();
  else
    keep();
}

double BeamCells::half_range(const ViewFacet& facet) const {
  return std::abs(facet.na) * here_.half_a + std::abs(facet.nb) * here_.half_b;
}

bool BeamCells::touches(const ViewEdge& edge) const {
  if (edge.min_a > here_.a + here_.half_a || edge.max_a < here_.a - here_.half_a) return false;
  if (edge.min_b > here_.b + here_.half_b || edge.max_b < here_.b - here_.half_b) return false;
  const double from_line = edge.normal_a * here_.a + edge.normal_b * here_.b - edge.offset;
  return std::abs(from_line) <=
         std::abs(edge.normal_a) * here_.half_a + std::abs(edge.normal_b) * here_.half_b + edge.room;
}

bool BeamCells::near_sample(const ViewEdge& edge) const {
  if (edge.min_a > here_.sample_a || edge.max_a < here_.sample_a) return false;
  if (edge.min_b > here_.sample_b || edge.max_b < here_.sample_b) return false;
  return std::abs(edge.normal_a * here_.sample_a + edge.normal_b * here_.sample_b - edge.offset) <= edge.room;
}

/// Takes a facet of the parent's over if any of it can be in this cell.
void BeamCells::inherit(const Entry& from, std::span<const uint32_t> edges, const Cell*) {
  if (done_[from.facet]) return;
  const ViewFacet& facet = view_->facets()[from.facet];
  const double sum = facet.slope_sum(here_.a, here_.b), range = half_range(facet);
  if (facet.role == ViewFacet::Role::facet) {
    if ((sum + range) * facet.max_depth < facet.distance * (1.0 - 1e-9)) return;  // farther than any of it
    if ((sum - range) * view_->beam().near_m > facet.distance + facet.contact_m) return;  // behind the mirror
  }
  Entry entry = from;
  entry.first_edge = static_cast<uint32_t>(edges_.size());
  for (const uint32_t edge : edges)
    if (touches(view_->edges()[edge])) edges_.push_back(edge);
  entry.edge_count = static_cast<uint32_t>(edges_.size()) - entry.first_edge;
  if (facet.role == ViewFacet::Role::wedge && entry.edge_count == 0) return;
  if (!edges.empty()) entry.at_sample = unknown;  // its outline lies between the samples, perhaps
  entry.gone = false, entry.walls = 0;
  entry.stops = facet.role == ViewFacet::Role::facet && sum - range > 0.0 &&
                facet.distance - (sum + range) * view_->beam().near_m >= view_->room_m() &&
                view_->scene().facet(facet.scene_facet).body != options_.transparent_body;
  entries_.push_back(entry);
}

/// A ray of the cell that no edge is near, so that every facet knows whether it is hit; else the centre's.
void BeamCells::choose_sample() {
  static constexpr double tries[][2] = {
      {0.0, 0.0}, {0.31, 0.17}, {-0.23, 0.37}, {0.41, -0.29}, {-0.37, -0.19}};
  for (const auto& at : tries) {
    here_.sample_a = here_.a + at[0] * here_.half_a, here_.sample_b = here_.b + at[1] * here_.half_b;
    const bool clear = std::none_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
      if (facet_of(entry).role == ViewFacet::Role::wedge) return false;
      const auto edges = edges_of(entry);
      return std::any_of(edges.begin(), edges.end(),
                         [&](uint32_t edge) { return near_sample(view_->edges()[edge]); });
    });
    if (clear) return;
  }
  here_.sample_a = here_.a, here_.sample_b = here_.b;
}

/// Which outlines the sample is in, and so which facets cover the cell or have none of it. False: the cell is outside of
/// the mirror.
bool BeamCells::find_presence(const Cell*) {
  size_t kept = 0;
  for (size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    const ViewFacet& facet = facet_of(entry);
    if (facet.role != ViewFacet::Role::wedge) {
      const auto edges = edges_of(entry);
      const double sum = facet.slope_sum(here_.sample_a, here_.sample_b);
      const bool met = sum > 0.0 && facet.distance + facet.contact_m >= sum * view_->beam().near_m;
      if (!met)
        entry.at_sample = unknown;
      else if (std::any_of(edges.begin(), edges.end(),
                           [&](uint32_t edge) { return near_sample(view_->edges()[edge]); }))
        entry.at_sample = unknown;
      else if (entry.at_sample == unknown)
        entry.at_sample = view_->contains(facet, here_.sample_a, here_.sample_b) ? present : absent;
      if (edges.empty() && entry.at_sample == absent) {
        if (facet.role == ViewFacet::Role::mirror) return false;
        continue;
      }
      if (facet.role == ViewFacet::Role::mirror && edges.empty() && entry.at_sample == present) continue;
      entry.covers = entry.stops && edges.empty() && entry.at_sample == present;
    }
    if (kept != i) entries_[kept] = entry;
    ++kept;
  }
  entries_.resize(kept);
  return true;
}

/// Is all of `facet` that the cell may hold behind the plane of `cover`, by more than `room` metres?
bool BeamCells::in_front(const ViewFacet& cover, const ViewFacet& facet, double room) const {
  const double rounding = view_->rounding_m();
  const double sum = cover.slope_sum(here_.a, here_.b), range = half_range(cover);
  const double reach = cover.distance + rounding + room;
  if ((sum - range) * facet.min_depth > reach * (1.0 + 1e-12)) return true;
  const double distance = facet.distance - rounding;
  if (distance <= 0.0) return false;
  // depth of facet / depth of cover, both affine over the cell: least at a corner
  const double center = sum * distance - facet.slope_sum(here_.a, here_.b) * reach;
  const double spread = std::abs(cover.na * distance - facet.na * reach) * here_.half_a +
                        std::abs(cover.nb * distance - facet.nb * reach) * here_.half_b;
  const double roundings = 1e-14 * view_->longest_direction() * (distance + reach);
  return center - spread > roundings;
}

/// Will both be counted as walls passed by every path that passes them in this cell? Not walls in one plane or next to
/// each other, which crossings take for one (shaders/rf/crossings.comp.glsl).
bool BeamCells::apart(const ViewFacet& first, const ViewFacet& second) const {
  const BeamScene& scene = view_->scene();
  const BeamFacet &a = scene.facet(first.scene_facet), &b = scene.facet(second.scene_facet);
  const double room = view_->room_m() + 1e-5 * scene.largest_coordinate();
  if (std::abs(glm::dot(a.normal, b.normal)) > 0.99) {
    if (std::abs(glm::dot(a.normal, b.reference) - a.offset) < room) return false;
    if (std::abs(glm::dot(b.normal, a.reference) - b.offset) < room) return false;
  }
  return in_front(first, second, room);
}

void BeamCells::find_surfaces() {
  surfaces_.clear();
  members_.clear();
  const auto inverse_depth = [&](const Entry& entry) {
    const ViewFacet& facet = facet_of(entry);
    return facet.slope_sum(here_.sample_a, here_.sample_b) / facet.distance;
  };
  for (uint32_t i = 0; i < entries_.size(); ++i) {
    if (!entries_[i].covers) continue;
    surfaces_.push_back({static_cast<uint32_t>(members_.size()), 1, inverse_depth(entries_[i]),
                         facet_of(entries_[i]).kind == FacetKind::opaque});
    members_.push_back(i);
  }
  if (entries_.size() <= most_for_shells) {
    visited_.assign(entries_.size(), 0);
    for (uint32_t i = 0; i < entries_.size(); ++i) {
      const Entry& entry = entries_[i];
      if (visited_[i] || entry.covers || !entry.stops || entry.at_sample != present) continue;
      const size_t before = surfaces_.size();
      grow_shell(i);
      if (surfaces_.size() > before) surfaces_.back().inverse_depth = inverse_depth(entry);
    }
  }
  std::stable_sort(surfaces_.begin(), surfaces_.end(),
                   [](const Surface& a, const Surface& b) { return a.inverse_depth > b.inverse_depth; });
}

/// Facets that share an edge cover the cell together: from `start` on, each edge that may touch the cell needs a
/// neighbour on its other side. Where all of them have one, the number of facets that a ray of the cell meets is odd or
/// even all over the cell (only edges change it, two facets at a time), and if it is odd, no ray misses them all. That
/// also holds for the mesh itself, whose corners may be off the planes.
void BeamCells::grow_shell(uint32_t start) {
  const uint32_t first = static_cast<uint32_t>(members_.size());
  const auto add = [&](uint32_t member) {
    if (std::find(members_.begin() + first, members_.end(), member) == members_.end())
      members_.push_back(member);
  };
  const auto neighbour = [&](uint32_t member, const ViewEdge& edge) {
    for (uint32_t i = 0; i < entries_.size(); ++i) {
      const Entry& other = entries_[i];
      if (i == member || !other.stops || other.at_sample == unknown || !facet_of(other).regular) continue;
      for (const uint32_t index : edges_of(other)) {
        const ViewEdge& shared = view_->edges()[index];
        if (shared.edge == edge.edge && shared.left != edge.left) return i;
      }
    }
    return ~0u;
  };
  add(start);
  bool closed = facet_of(entries_[start]).regular;
  for (uint32_t at = first; closed && at < members_.size(); ++at) {
    const uint32_t member = members_[at];
    for (const uint32_t index : edges_of(entries_[member])) {
      const uint32_t other = neighbour(member, view_->edges()[index]);
      closed = other != ~0u;
      if (!closed) break;
      add(other);
    }
  }
  uint32_t met = 0;
  bool opaque = true;
  for (uint32_t at = first; at < members_.size(); ++at) {
    visited_[members_[at]] = 1;
    met += entries_[members_[at]].at_sample == present;
    opaque = opaque && facet_of(entries_[members_[at]]).kind == FacetKind::opaque;
  }
  if (closed && met % 2 == 1)
    surfaces_.push_back({first, static_cast<uint32_t>(members_.size()) - first, 0.0, opaque});
  else
    members_.resize(first);
}

void BeamCells::drop_hidden() {
  const auto members = [&](const Surface& surface) {
    return std::span(members_).subspan(surface.first, surface.count);
  };
  const auto all_in_front = [&](const Surface& surface, uint32_t index) {
    const ViewFacet& facet = facet_of(entries_[index]);
    for (const uint32_t member : members(surface)) {
      const ViewFacet& cover = facet_of(entries_[member]);
      if (member == index) return false;
      if (cover.scene_facet == facet.wedge_faces[0] || cover.scene_facet == facet.wedge_faces[1])
        return false;
      if (in_front(cover, facet, view_->room_m())) continue;
      // Beside a common edge nothing is well behind; what is there lies within a strip that the tolerance makes.
      if (options_.edge_strips || facet.role != ViewFacet::Role::facet) return false;
      if (!in_front(cover, facet, 0.0)) return false;
      if (!view_->scene().meet_at_an_angle(cover.scene_facet, facet.scene_facet)) return false;
    }
    return true;
  };
  const auto all_apart = [&](const Surface& first, const Surface& second) {
    for (const uint32_t a : members(first))
      for (const uint32_t b : members(second))
        if (a == b || !apart(facet_of(entries_[a]), facet_of(entries_[b]))) return false;
    return true;
  };
  std::vector<const Surface*> counted;
  for (const Surface& surface : surfaces_) {
    const auto in_it = members(surface);
    if (std::all_of(in_it.begin(), in_it.end(), [&](uint32_t member) { return entries_[member].gone; }))
      continue;
    const bool stops = surface.opaque || options_.walls == 0;
    const bool counts = !stops && std::all_of(counted.begin(), counted.end(), [&](const Surface* other) {
      return all_apart(*other, surface);
    });
    if (counts) counted.push_back(&surface);
    if (!stops && !counts) continue;
    for (uint32_t i = 0; i < entries_.size(); ++i) {
      Entry& entry = entries_[i];
      if (entry.gone || facet_of(entry).role == ViewFacet::Role::mirror || !all_in_front(surface, i))
        continue;
      if (stops || ++entry.walls > options_.walls) entry.gone = true;
    }
  }
  if (options_.edge_strips || entries_.size() > most_for_contacts) return;
  for (Entry& entry : entries_)
    if (!entry.gone && facet_of(entry).role == ViewFacet::Role::facet && hidden_at_contact(entry))
      entry.gone = true;
}

/// What the sample's ray meets first is there, and no smaller cell will prove otherwise.
void BeamCells::mark_seen() {
  struct Met {
    uint32_t entry;
    double depth;
  };
  std::vector<Met> met;
  for (uint32_t i = 0; i < entries_.size(); ++i) {
    const ViewFacet& facet = facet_of(entries_[i]);
    if (facet.role == ViewFacet::Role::mirror && entries_[i].at_sample != present) return;
    if (facet.role == ViewFacet::Role::facet && entries_[i].at_sample == present)
      met.push_back({i, facet.distance / facet.slope_sum(here_.sample_a, here_.sample_b)});
  }
  std::sort(met.begin(), met.end(), [](const Met& a, const Met& b) {
    return a.depth != b.depth ? a.depth < b.depth : a.entry < b.entry;
  });
  uint32_t walls = 0;
  double last = -1e300;
  for (const Met& one : met) {
    const Entry& entry = entries_[one.entry];
    if (!entry.gone && walls <= entry.walls) target(entry).seen = true;
    if (!entry.stops) continue;
    if (facet_of(entry).kind == FacetKind::opaque || options_.walls == 0) return;
    if (one.depth > last + view_->room_m() && ++walls > options_.walls) return;
    last = one.depth;
  }
}

/// Wedges that are in sight at one point need no proof any more.
void BeamCells::find_wedges() {
  if (entries_.size() > most_for_wedges) return;
  for (Entry& entry : entries_) {
    const ViewFacet& wedge = facet_of(entry);
    if (wedge.role != ViewFacet::Role::wedge || entry.gone) continue;
    const ViewEdge& edge = view_->edges()[edges_of(entry)[0]];
    // The middle of what is in the cell.
    dvec2 from = edge.ends[0], to = edge.ends[1];
    const auto cut = [&](auto side) {
      const double at_from = side(from), at_to = side(to);
      if (at_from < 0.0 && at_to < 0.0) return false;
      if (at_from < 0.0)
        from = from + at_from / (at_from - at_to) * (to - from);
      else if (at_to < 0.0)
        to = from + at_from / (at_from - at_to) * (to - from);
      return true;
    };
    if (!cut([&](const dvec2& x) { return x.x - here_.rect.min_a; }) ||
        !cut([&](const dvec2& x) { return here_.rect.max_a - x.x; }) ||
        !cut([&](const dvec2& x) { return x.y - here_.rect.min_b; }) ||
        !cut([&](const dvec2& x) { return here_.rect.max_b - x.y; }))
      continue;
    const dvec2 middle = 0.5 * (from + to);
    const double inverse_depth = wedge.slope_sum(middle.x, middle.y) / wedge.distance;
    uint32_t walls = 0;
    bool blocked = false;
    for (const Entry& other : entries_) {
      const ViewFacet& facet = facet_of(other);
      if (facet.role == ViewFacet::Role::mirror)
        blocked = blocked || !view_->contains(facet, middle.x, middle.y);
      if (facet.role != ViewFacet::Role::facet || blocked) continue;
      if (facet.scene_facet == wedge.wedge_faces[0] || facet.scene_facet == wedge.wedge_faces[1]) continue;
      if (facet.slope_sum(middle.x, middle.y) <= inverse_depth * facet.distance) continue;
      if (!view_->contains(facet, middle.x, middle.y)) continue;
      blocked = facet.kind == FacetKind::opaque || ++walls > options_.walls;
    }
    if (blocked) continue;
    targets_[entry.facet * (options_.walls + 1)].used = true;
    done_[entry.facet] = 1;
    entry.gone = true;
  }
}

bool BeamCells::fine(const ViewFacet& facet, double parts) const {
  return parts * std::max(here_.half_a, here_.half_b) * 2.0 <= facet.extent;
}

bool BeamCells::settled() {
  if (cells_ - cells_before_ >= options_.most_cells) return true;
  size_t left = 0;
  bool partly_outside = false;
  for (const Entry& entry : entries_) {
    left += !entry.gone && facet_of(entry).role != ViewFacet::Role::mirror;
    partly_outside = partly_outside || facet_of(entry).role == ViewFacet::Role::mirror;
  }
  if (left == 0 || (left == 1 && !partly_outside)) return true;
  for (const Entry& entry : entries_) {
    const ViewFacet& facet = facet_of(entry);
    if (entry.gone || facet.role == ViewFacet::Role::mirror) continue;
    Target& known = target(entry);
    if (!known.seen && !fine(facet, unseen_parts)) return false;
    if (!known.seen && known.tries < most_tries && !fine(facet, finest_parts)) {
      ++known.tries;
      return false;
    }
    if (known.seen && options_.tight && !fine(facet, rectangle_parts)) {
      BeamHit window;
      if (!project(facet, window)) continue;
      if (window.min_a < known.min_a || window.max_a > known.max_a || window.min_b < known.min_b ||
          window.max_b > known.max_b)
        return false;
    }
  }
  return true;
}

void BeamCells::take() {
  for (const Entry& entry : entries_) {
    const ViewFacet& facet = facet_of(entry);
    if (entry.gone || facet.role == ViewFacet::Role::mirror) continue;
    Target& known = target(entry);
    if (facet.role == ViewFacet::Role::wedge) {
      known.used = true;
      done_[entry.facet] = 1;
      continue;
    }
    BeamHit window;
    if (!project(facet, window)) continue;
    known.used = true;
    known.min_a = std::min(known.min_a, window.min_a), known.max_a = std::max(known.max_a, window.max_a);
    known.min_b = std::min(known.min_b, window.min_b), known.max_b = std::max(known.max_b, window.max_b);
  }
}

/// The cell is to be cut: its lists go to the next generation.
void BeamCells::keep() {
  Cell cell{here_.rect, here_.sample_a, here_.sample_b, static_cast<uint32_t>(next_.entries.size()), 0};
  for (const Entry& entry : entries_) {
    if (entry.gone) continue;
    Entry kept = entry;
    kept.first_edge = static_cast<uint32_t>(next_.edges.size());
    const auto edges = edges_of(entry);
    next_.edges.insert(next_.edges.end(), edges.begin(), edges.end());
    next_.entries.push_back(kept);
  }
  cell.entry_count = static_cast<uint32_t>(next_.entries.size()) - cell.first_entry;
  next_.cells.push_back(cell);
}

/// The rectangle around the cell's projection onto a facet, within the facet's own; false: the cell has none of it.
bool BeamCells::project(const ViewFacet& view, BeamHit& window) const {
  const BeamFacet& facet = view_->scene().facet(view.scene_facet);
  const Beam& beam = view_->beam();
  window.min_a = window.min_b = 1e300, window.max_a = window.max_b = -1e300;
  // The facet's own depths, as bounds of its sums.
  const double least = view.distance / view.max_depth * (1.0 - 1e-9);
  double most = view.distance / view.min_depth * (1.0 + 1e-9);
  if (beam.near_m > 0.0) most = std::min(most, (view.distance + view.contact_m) / beam.near_m);
  dvec2 polygon[8] = {{here_.a - here_.half_a, here_.b - here_.half_b},
                      {here_.a + here_.half_a, here_.b - here_.half_b},
                      {here_.a + here_.half_a, here_.b + here_.half_b},
                      {here_.a - here_.half_a, here_.b + here_.half_b}};
  int count = 4;
  const auto cut = [&](double sign, double bound) {
    dvec2 kept[8];
    int kept_count = 0;
    for (int i = 0; i < count; ++i) {
      const dvec2 &from = polygon[i], &to = polygon[(i + 1) % count];
      const double at_from = sign * (view.slope_sum(from.x, from.y) - bound);
      const double at_to = sign * (view.slope_sum(to.x, to.y) - bound);
      if (at_from >= 0.0) kept[kept_count++] = from;
      if ((at_from < 0.0) != (at_to < 0.0))
        kept[kept_count++] = from + at_from / (at_from - at_to) * (to - from);
    }
    std::copy(kept, kept + kept_count, polygon);
    count = kept_count;
  };
  cut(1.0, least);
  cut(-1.0, most);
  if (count == 0) return false;
  const double apex_a = glm::dot(facet.axis_a, beam.apex) - facet.offset_a;
  const double apex_b = glm::dot(facet.axis_b, beam.apex) - facet.offset_b;
  double farthest = 0.0;
  for (int i = 0; i < count; ++i) {
    const dvec3 direction = polygon[i].x * beam.right + polygon[i].y * beam.up + beam.forward;
    const double depth = view.distance / std::clamp(view.slope_sum(polygon[i].x, polygon[i].y), least, most);
    const double a = apex_a + depth * glm::dot(facet.axis_a, direction);
    const double b = apex_b + depth * glm::dot(facet.axis_b, direction);
    farthest = std::max(farthest, depth * glm::length(direction));
    window.min_a = std::min(window.min_a, a), window.max_a = std::max(window.max_a, a);
    window.min_b = std::min(window.min_b, b), window.max_b = std::max(window.max_b, b);
  }
  const double border = 2.0 * facet.tolerance_m + view_->rounding_m();
  const double room = border + farthest * (4.0 * view_->rounding_m() / view.distance + 1e-13);
  window.min_a = std::max(window.min_a - room, facet.min_a - border);
  window.max_a = std::min(window.max_a + room, facet.max_a + border);
  window.min_b = std::max(window.min_b - room, facet.min_b - border);
  window.max_b = std::min(window.max_b + room, facet.max_b + border);
  return window.min_a <= window.max_a && window.min_b <= window.max_b;
}

void BeamCells::report(std::vector<BeamHit>& hits, std::vector<uint32_t>& wedges) const {
  const size_t first_wedge = wedges.size();
  const uint32_t levels = options_.walls + 1;
  for (uint32_t i = 0; i < view_->facets().size(); ++i) {
    const ViewFacet& facet = view_->facets()[i];
    for (uint32_t walls = 0; walls < levels; ++walls) {
      const Target& known = targets_[i * levels + walls];
      if (!known.used) continue;
      if (facet.role == ViewFacet::Role::wedge)
        wedges.push_back(facet.scene_facet);
      else
        hits.push_back({facet.scene_facet, walls, known.min_a, known.max_a, known.min_b, known.max_b});
    }
  }
  std::sort(wedges.begin() + static_cast<ptrdiff_t>(first_wedge), wedges.end());
  wedges.erase(std::unique(wedges.begin() + static_cast<ptrdiff_t>(first_wedge), wedges.end()), wedges.end());
}

}  // namespace greatx::rf
