// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/clutter_patches.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/units.h"
#include "rf/atmosphere/path_attenuation.h"
#include "rf/radar/echoes/echo_tracks.h"
#include "rf/radar/echoes/tube_beam.h"
#include "rf/radar/signal/lanes.h"
#include "rf/surface/incidence.h"

namespace greatx::rf {
namespace {

constexpr size_t part_chunk = 64, scatterer_chunk = 1024;
/// Scatterers that need more blocks than this become echoes with delays of their own.
constexpr uint32_t most_blocks = 8;
constexpr double scatterers_in_a_cell = 4.0;
constexpr double least_slope = 0.2;  ///< cosine of the steepest grazing angle that still counts for a cell

uint64_t mixed(uint64_t value) { return mix64(value + 0x9e3779b97f4a7c15ull); }

double share_of(uint64_t bits) { return (double(bits & 0xffffffffu) + 0.5) * 0x1.0p-32; }

/// Returns a circular Gaussian number of mean power 1.
std::complex<float> gaussian(uint64_t bits) {
  float re, im;
  complex_normal(static_cast<float>(share_of(bits)), static_cast<float>(share_of(bits >> 32)), re, im);
  return {re, im};
}

/// Holds the sides of a polygon, for testing many points.
struct Outline {
  std::array<HalfPlane, Polygon::capacity> sides;
  uint32_t count = 0;
  dvec2 low{1e300}, high{-1e300};
  explicit Outline(const Polygon& polygon) : count(polygon.size()) {
    for (uint32_t i = 0; i < count; ++i) {
      sides[i] = polygon.inside(i);
      low = glm::min(low, polygon[i]), high = glm::max(high, polygon[i]);
    }
  }
  bool has(const dvec2& p) const {
    for (uint32_t i = 0; i < count; ++i)
      if (sides[i].at(p) < 0.0) return false;
    return true;
  }
  /// Returns the range of x that the polygon may have where y is in [from, to].
  dvec2 reach(double from, double to) const {
    double least = low.x, most = high.x;
    for (uint32_t i = 0; i < count; ++i) {
      const dvec2& n = sides[i].normal;
      if (n.x == 0.0) continue;
      // n.x x >= -offset - n.y y for some y of the strip.
      const double bound = -sides[i].offset - std::max(n.y * from, n.y * to);
      if (n.x > 0.0)
        least = std::max(least, bound / n.x);
      else
        most = std::min(most, bound / n.x);
    }
    return {least, most};
  }
};

}  // namespace

void ClutterParts::add(uint32_t tube, uint32_t facet, const Polygon& piece) {
  parts.push_back({tube, facet, static_cast<uint32_t>(corners.size()), piece.size()});
  for (uint32_t i = 0; i < piece.size(); ++i) corners.push_back(piece[i]);
}

void ClutterParts::append(const ClutterParts& more) {
  const uint32_t shift = static_cast<uint32_t>(corners.size());
  corners.insert(corners.end(), more.corners.begin(), more.corners.end());
  for (Part part : more.parts) {
    part.first += shift;
    parts.push_back(part);
  }
}

struct ClutterPatches::Ends {
  Pose transmitter, receiver;
  dmat3 turn{1.0};                       ///< local axes from those of the transmitter
  double cell_rad = 0.1;                 ///< width of a resolution cell
  std::optional<TurnedElement> element;  ///< the receiver's; empty if it is the transmitter's
};

ClutterPatches::ClutterPatches(const scene::Scene& scene, const RadioSurfaces& surfaces,
                               const EchoOptions& options, const EchoEnd& transmitter,
                               const EchoEnd* receiver)
    : scene_(scene),
      options_(options),
      table_(scene, surfaces),
      cells_(options, transmitter.pattern, transmitter.slant),
      receiver_pattern_(receiver != nullptr ? receiver->pattern : transmitter.pattern),
      receiver_slant_(receiver != nullptr ? receiver->slant : transmitter.slant),
      monostatic_(receiver == nullptr),
      wavelength_m_(surfaces.wavelength_m()),
      side_m_(options.diffuse_patch_m > 0.0 ? options.diffuse_patch_m
                                            : 0.25 * speed_of_light / options.waveform.bandwidth_hz()) {}

Complex ClutterPatches::amplitude(const PosedFacet& facet, const dvec3& point, double side,
                                  const CellField& field, const Ends& ends, uint64_t draw) const {
  const dvec3 arm = point - ends.transmitter.position;
  const double before = glm::length(arm);
  const dvec3 in = arm / before;
  const double towards = glm::dot(in, facet.normal);
  const dvec3 normal = towards < 0.0 ? facet.normal : -facet.normal;
  const dvec3 h_in = s_axis(in, normal), v_in = glm::cross(in, h_in);
  const FieldVector sent = field.towards(in);
  double after = before, sine = std::abs(towards);
  dvec3 home = in, h_out = h_in, v_out = v_in;
  FieldVector heard = sent;
  if (ends.element) {
    const dvec3 back = point - ends.receiver.position;
    after = glm::length(back);
    home = back / after;
    sine = 0.5 * (sine + std::abs(glm::dot(home, normal)));
    h_out = s_axis(home, normal), v_out = glm::cross(home, h_out);
    heard = field_towards(*ends.element, home);
  }
  const ClutterTable::Roots root = table_.at(facet.material, towards < 0.0, sine);
  const Complex sent_h = sent.along(h_in), sent_v = sent.along(v_in), heard_h = heard.along(h_out),
                heard_v = heard.along(v_out);
  const Complex co = double(root.hh) * sent_h * heard_h + double(root.vv) * sent_v * heard_v,
                cross = double(root.hv) * (sent_h * heard_v + sent_v * heard_h);
  const std::complex<float> g = gaussian(mixed(draw + 1)), g_cross = gaussian(mixed(draw + 2));
  const double scale = wavelength_m_ * side / (std::pow(4.0 * pi, 1.5) * before * after);
  return scale * (Complex(g) * co + Complex(g_cross) * cross);
}

ClutterPatches::Cell ClutterPatches::cell_at(const PosedFacet& facet, const dvec2& place,
                                             const Ends& ends) const {
  const dvec3 arm = point_of(facet, place) - ends.transmitter.position;
  Cell cell;
  cell.distance = glm::length(arm);
  cell.sine = std::abs(glm::dot(arm, facet.normal)) / cell.distance;
  const double slope = std::max(least_slope, std::sqrt(std::max(0.0, 1.0 - cell.sine * cell.sine)));
  cell.area = options_.waveform.range_bin_m() / slope * cell.distance * ends.cell_rad;
  return cell;
}

double ClutterPatches::side_of(const PosedFacet& facet, const Polygon& piece, const Ends& ends) const {
  if (options_.diffuse_patch_m > 0.0) return side_m_;
  const double wanted = std::sqrt(cell_at(facet, piece.centroid(), ends).area / scatterers_in_a_cell);
  return wanted > side_m_ ? side_m_ * std::exp2(std::nearbyint(std::log2(wanted / side_m_))) : side_m_;
}

bool ClutterPatches::hidden(const PosedFacet& facet, const Polygon& piece, const Ends& ends) const {
  if (options_.hidden_floor_m2 == 0.0) return false;
  for (uint32_t i = 0; i < piece.size(); ++i) {
    const Cell cell = cell_at(facet, piece[i], ends);
    const double back = glm::distance(point_of(facet, piece[i]), ends.receiver.position);
    const bool from_front = facet.distance(ends.transmitter.position) > 0.0;
    const ClutterTable::Roots root = table_.at(facet.material, from_front, cell.sine);
    const double strongest = std::max({root.hh, root.vv, root.hv});
    const double way = cell.distance * back;
    if (strongest * strongest * cell.area > options_.hidden_floor_m2 * way * way) return false;
  }
  return true;
}

void ClutterPatches::cover(uint32_t tube, uint32_t index, const Polygon& piece, const FacetWorld& world,
                           const Ends& ends, std::vector<Scatterer>& out) const {
  const PosedFacet& facet = world.facet(index);
  if (hidden(facet, piece, ends)) return;
  const Outline outline(piece);
  const double side = side_of(facet, piece, ends);
  const uint64_t key = mixed(options_.seed ^ mixed(index ^ mixed(std::bit_cast<uint64_t>(side))));
  const CellField field = cells_.turned(tube, ends.turn);
  const size_t expected = out.size() + static_cast<size_t>(piece.area() / (side * side)) + 1;
  if (expected > out.capacity()) out.reserve(expected + expected / 2);
  const auto last_row = static_cast<int64_t>(std::floor(outline.high.y / side));
  for (auto row = static_cast<int64_t>(std::floor(outline.low.y / side)); row <= last_row; ++row) {
    const dvec2 reach = outline.reach(double(row) * side, double(row + 1) * side);
    const auto last = static_cast<int64_t>(std::floor(reach.y / side));
    for (auto column = static_cast<int64_t>(std::floor(reach.x / side)); column <= last; ++column) {
      const uint64_t draw = mixed(key ^ (static_cast<uint64_t>(row) << 32 | static_cast<uint32_t>(column)));
      const dvec2 place = side * dvec2(double(column) + share_of(draw), double(row) + share_of(draw >> 32));
      if (!outline.has(place)) continue;
      Scatterer& one = out.emplace_back();
      one.point = point_of(facet, place);
      one.facet = index;
      one.amplitude = amplitude(facet, one.point, side, field, ends, draw);
    }
  }
}

std::vector<Scatterer> ClutterPatches::scatterers(const ClutterParts& parts, const FacetWorld& world,
                                                  const Ends& ends) const {
  std::vector<std::vector<Scatterer>> found((parts.parts.size() + part_chunk - 1) / part_chunk);
  parallel_for(found.size(), options_.threads, [&](size_t chunk) {
    for (size_t i = chunk * part_chunk; i < std::min(parts.parts.size(), (chunk + 1) * part_chunk); ++i) {
      const ClutterParts::Part& part = parts.parts[i];
      cover(part.tube, part.facet, parts.piece(part), world, ends, found[chunk]);
    }
  });
  size_t count = 0;
  for (const auto& some : found) count += some.size();
  std::vector<Scatterer> all;
  all.reserve(count);
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

namespace {

/// The lengths of the ways over scatterers at a few times.
class Ways {
 public:
  Ways(const std::vector<Scatterer>& all, const FacetWorld& world, size_t bodies, const EchoMotion& motion,
       std::vector<double> times)
      : all_(all), world_(world), table_(motion, asked(bodies), std::move(times)) {}

  double length(size_t i, size_t time) const {
    const uint32_t body = world_.facet(all_[i].facet).body;
    const dvec3 at = body == 0 ? all_[i].point : table_.body(body, time).apply(carried_[i]);
    return glm::distance(at, table_.transmitter(time)) + glm::distance(at, table_.receiver(time));
  }

 private:
  std::span<const bool> asked(size_t bodies) {
    asked_ = std::make_unique<bool[]>(bodies);
    for (size_t i = 0; i < all_.size(); ++i)
      if (const uint32_t body = world_.facet(all_[i].facet).body; body != 0) {
        if (carried_.empty()) carried_.resize(all_.size());
        carried_[i] = world_.motion(body).pose.inverse().apply(all_[i].point);
        asked_[body] = true;
      }
    return {asked_.get(), bodies};
  }

  const std::vector<Scatterer>& all_;
  const FacetWorld& world_;
  std::unique_ptr<bool[]> asked_;
  std::vector<dvec3> carried_;  ///< places in the frames of the bodies; empty if nothing moves
  PoseTable table_;
};

/// Returns rate and curvature of the delay in the middle of three times that are `step_s` apart.
struct Slopes {
  double delay_s, rate, curvature_per_s;
};
Slopes slopes(const Ways& ways, size_t i, size_t first, double step_s) {
  const double before = ways.length(i, first), now = ways.length(i, first + 1),
               after = ways.length(i, first + 2);
  return {now / speed_of_light, (after - before) / (2.0 * step_s * speed_of_light),
          (after - 2.0 * now + before) / (step_s * step_s * speed_of_light)};
}

std::vector<double> about(double middle_s, double step_s) {
  return {middle_s - step_s, middle_s, middle_s + step_s};
}

}  // namespace

FoundPatches ClutterPatches::timed(std::vector<Scatterer> all, const FacetWorld& world, const Ends& ends,
                                   const EchoMotion& motion) const {
  const RadarWaveform& w = options_.waveform;
  const uint32_t slots = static_cast<uint32_t>(motion.slot_start_s.size());
  const double frame_s = std::max(motion.frame_s(), w.interval_s);
  const auto chunks = [](size_t count) { return (count + scatterer_chunk - 1) / scatterer_chunk; };
  FoundPatches found;
  std::vector<uint32_t> blocks(all.size());
  {
    const double step_s = 0.5 * frame_s;
    const Ways ways(all, world, scene_.bodies.size(), motion,
                    about(motion.slot_start_s.front() + step_s, step_s));
    parallel_for(chunks(all.size()), options_.threads, [&](size_t chunk) {
      for (size_t i = chunk * scatterer_chunk; i < std::min(all.size(), (chunk + 1) * scatterer_chunk); ++i) {
        const Slopes at = slopes(ways, i, 0, step_s);
        blocks[i] = patch_blocks(w, slots, std::abs(at.rate), std::abs(at.curvature_per_s));
      }
    });
  }
  size_t kept = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    if (blocks[i] > most_blocks) {
      found.fast.push_back(all[i]);
      continue;
    }
    found.list.blocks = std::max(found.list.blocks, blocks[i]);
    all[kept++] = all[i];
  }
  all.resize(kept);
  PatchList& list = found.list;
  const size_t count = all.size();
  for (auto* column : {&list.re, &list.im}) column->resize(count);
  list.departure.resize(count), list.instance.resize(count);
  if (!monostatic_) list.arrival.resize(count);
  list.delay_s.resize(list.blocks * count), list.rate.resize(list.blocks * count);
  const double step_s = 0.25 * frame_s / list.blocks;
  std::vector<double> times;
  for (uint32_t block = 0; block < list.blocks; ++block)
    for (const double time :
         about(patch_block(w, motion.first_slot, slots, list.blocks, block).middle_s, step_s))
      times.push_back(time);
  const Ways ways(all, world, scene_.bodies.size(), motion, std::move(times));
  parallel_for(chunks(count), options_.threads, [&](size_t chunk) {
    for (size_t i = chunk * scatterer_chunk; i < std::min(count, (chunk + 1) * scatterer_chunk); ++i) {
      const Scatterer& one = all[i];
      list.departure[i] = vec3(glm::normalize(one.point - ends.transmitter.position));
      if (!monostatic_) list.arrival[i] = vec3(glm::normalize(one.point - ends.receiver.position));
      list.instance[i] = scene_.facets[one.facet].instance + 1;
      for (uint32_t block = 0; block < list.blocks; ++block) {
        const Slopes at = slopes(ways, i, 3 * size_t{block}, step_s);
        list.delay_s[block * count + i] = at.delay_s;
        list.rate[block * count + i] = at.rate;
      }
      const double air = rf::amplitude(options_.air_db_per_km, speed_of_light * list.delay_s[i]);
      list.re[i] = static_cast<float>(air * one.amplitude.real());
      list.im[i] = static_cast<float>(air * one.amplitude.imag());
    }
  });
  return found;
}

/// Returns the width of a resolution cell across the range: that of the beam, or that which the Doppler
/// frequencies of a moving radar resolve beside its course.
double ClutterPatches::cell_rad(const EchoMotion& motion) const {
  const double frame_s = motion.frame_s(), begin_s = motion.slot_start_s.front();
  const double moved = frame_s > 0.0 ? glm::distance(motion.transmitter(begin_s + frame_s).position,
                                                     motion.transmitter(begin_s).position)
                                     : 0.0;
  return std::min(options_.beam_rad, 0.5 * wavelength_m_ / std::max(moved, 1e-12));
}

FoundPatches ClutterPatches::find(const ClutterParts& parts, const FacetWorld& world, const Pose& transmitter,
                                  const Pose& receiver, const EchoMotion& motion) const {
  Ends ends{transmitter, receiver, glm::mat3_cast(transmitter.orientation), 0.0, std::nullopt};
  ends.cell_rad = cell_rad(motion);
  if (!monostatic_)
    ends.element.emplace(receiver_pattern_, std::span(&receiver_slant_, 1), receiver.orientation);
  return timed(scatterers(parts, world, ends), world, ends, motion);
}

}  // namespace greatx::rf
