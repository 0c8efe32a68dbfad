// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/clutter_patches.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/units.h"
#include "rf/radar/echoes/clutter_ends.h"
#include "rf/radar/echoes/surface_bounce.h"
#include "rf/radar/echoes/tube_beam.h"
#include "rf/radar/signal/lanes.h"
#include "rf/surface/incidence.h"

namespace greatx::rf {
namespace {

constexpr size_t part_chunk = 64;
constexpr double scatterers_in_a_cell = 4.0;
/// Over a mirror, where clutter is weaker than beside it, statistics of a coarser lattice will do.
constexpr double mirrored_in_a_cell = 1.0;
constexpr double least_slope = 0.2;  ///< cosine of the steepest grazing angle that still counts for a cell

uint64_t mixed(uint64_t value) { return mix64(value + 0x9e3779b97f4a7c15ull); }

double share_of(uint64_t bits) { return (double(bits & 0xffffffffu) + 0.5) * 0x1.0p-32; }

/// Returns a circular Gaussian number of mean power 1.
std::complex<float> gaussian(uint64_t bits) {
  float re, im;
  complex_normal(static_cast<float>(share_of(bits)), static_cast<float>(share_of(bits >> 32)), re, im);
  return {re, im};
}

/// Turns an axis across the wave that comes along `out` into one across that which leaves against `home`:
/// what sends to the receiver within an uneven facet are the places that are mirrors for both ends. Their
/// normal is halfway between both, whatever the normal of the facet is. An axis stays itself if both ends are
/// one.
dvec3 mirrored_axis(const dvec3& axis, const dvec3& out, const dvec3& home) {
  const dvec3 halfway = out + home;  // both have a part against the normal of the facet, so it is not 0
  return axis - 2.0 * glm::dot(halfway, axis) / glm::dot(halfway, halfway) * halfway;
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

void ClutterParts::add(uint32_t tube, uint32_t facet, uint32_t mirror, const Polygon& piece) {
  parts.push_back({tube, facet, mirror, static_cast<uint32_t>(corners.size()), piece.size()});
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

ClutterPatches::ClutterPatches(const scene::Scene& scene, const RadioSurfaces& surfaces,
                               const EchoOptions& options, const EchoEnd& transmitter,
                               const EchoEnd* receiver)
    : scene_(scene),
      options_(options),
      table_(scene, surfaces, receiver != nullptr),
      surfaces_(surfaces),
      transmitter_pattern_(transmitter.pattern),
      receiver_pattern_(receiver != nullptr ? receiver->pattern : transmitter.pattern),
      transmitter_slant_(transmitter.slant),
      receiver_slant_(receiver != nullptr ? receiver->slant : transmitter.slant),
      monostatic_(receiver == nullptr),
      wavelength_m_(surfaces.wavelength_m()),
      side_m_(options.diffuse_patch_m > 0.0 ? options.diffuse_patch_m
                                            : 0.25 * speed_of_light / options.waveform.bandwidth_hz()) {
  GREATX_CHECK(!options.scatterer_echoes || !monostatic_, "scatterers are echoes of two ends");
  if (!options.scatterer_echoes) cells_.emplace(options, transmitter.pattern, transmitter.slant);
  if (options.diffuse_instances.empty()) return;
  asked_.assign(scene.instances.size(), false);
  for (const uint32_t instance : options.diffuse_instances) asked_.at(instance) = true;
}

Complex ClutterPatches::amplitude(const PosedFacet& facet, const Leg& out, const Leg& home, double side,
                                  uint64_t draw) const {
  const double towards = glm::dot(out.in, facet.normal);
  const bool from_front = towards < 0.0;
  const dvec3 normal = from_front ? facet.normal : -facet.normal;
  const dvec3 h_out = s_axis(out.in, normal), v_out = glm::cross(out.in, h_out);
  const Complex sent_h = out.field.along(h_out), sent_v = out.field.along(v_out);
  Complex heard_h = sent_h, heard_v = sent_v;
  ClutterTable::Roots root;
  if (!monostatic_ && table_.has_lobe(facet.material)) {
    root = table_.lobe(facet.material, from_front, out.in, -home.in, normal);
    heard_h = home.field.along(mirrored_axis(h_out, out.in, home.in));
    heard_v = home.field.along(mirrored_axis(v_out, out.in, home.in));
  } else {
    double sine = std::abs(towards);
    if (&home != &out) {
      sine = 0.5 * (sine + std::abs(glm::dot(home.in, normal)));
      const dvec3 h_home = s_axis(home.in, normal);
      heard_h = home.field.along(h_home), heard_v = home.field.along(glm::cross(home.in, h_home));
    }
    root = table_.at(facet.material, from_front, sine);
  }
  const Complex co = double(root.hh) * sent_h * heard_h + double(root.vv) * sent_v * heard_v,
                cross = double(root.hv) * (sent_h * heard_v + sent_v * heard_h);
  const std::complex<float> g = gaussian(mixed(draw + 1)), g_cross = gaussian(mixed(draw + 2));
  const double scale = wavelength_m_ * side / (std::pow(4.0 * pi, 1.5) * out.length_m * home.length_m);
  return scale * (Complex(g) * co + Complex(g_cross) * cross);
}

ClutterPatches::Cell ClutterPatches::cell_at(const PosedFacet& facet, const dvec2& place, const dvec3& out,
                                             const dvec3& home) const {
  const dvec3 point = point_of(facet, place), there = point - out, back = point - home;
  Cell cell;
  cell.out_m = glm::length(there), cell.home_m = glm::length(back);
  const double sine_out = glm::dot(there, facet.normal) / cell.out_m,
               sine_home = glm::dot(back, facet.normal) / cell.home_m;
  cell.sine = 0.5 * (std::abs(sine_out) + std::abs(sine_home));
  // The mean of both distances changes along the surface by the mean of both unit vectors on it.
  const dvec3 slope = 0.5 * (there / cell.out_m + back / cell.home_m);
  const double along = std::sqrt(
      std::max(0.0, glm::dot(slope, slope) - 0.25 * (sine_out + sine_home) * (sine_out + sine_home)));
  cell.depth_m = options_.waveform.range_bin_m() / std::max(least_slope, along);
  return cell;
}

double ClutterPatches::side_of(const PosedFacet& facet, const Polygon& piece, const dvec3& out,
                               const dvec3& home, double in_a_cell, const Ends& ends) const {
  if (options_.diffuse_patch_m > 0.0) return side_m_;
  const Cell cell = cell_at(facet, piece.centroid(), out, home);
  const double width = std::min(cell.out_m, cell.home_m) * ends.cell_rad,
               wanted = std::sqrt(cell.depth_m * width / in_a_cell);
  return wanted > side_m_ ? side_m_ * std::exp2(std::nearbyint(std::log2(wanted / side_m_))) : side_m_;
}

template <typename Share>
bool ClutterPatches::hidden(const PosedFacet& facet, const Polygon& piece, const dvec3& out,
                            const dvec3& home, const Ends& ends, const Share& share) const {
  if (options_.hidden_floor_m2 == 0.0) return false;
  const bool from_front = facet.distance(out) > 0.0;
  for (uint32_t i = 0; i < piece.size(); ++i) {
    const Cell cell = cell_at(facet, piece[i], out, home);
    const ClutterTable::Roots root = table_.at(facet.material, from_front, cell.sine);
    const double strongest = std::max({root.hh, root.vv, root.hv}), way = cell.out_m * cell.home_m,
                 area = cell.depth_m * std::max(cell.out_m, cell.home_m) * ends.cell_rad;
    if (share(point_of(facet, piece[i])) * strongest * strongest * area >
        options_.hidden_floor_m2 * way * way)
      return false;
  }
  return true;
}

template <typename Take>
void ClutterPatches::spread(uint32_t index, const Polygon& piece, double side, const FacetWorld& world,
                            std::vector<Scatterer>& out, const Take& take) const {
  const PosedFacet& facet = world.facet(index);
  const Outline outline(piece);
  const uint64_t key = mixed(options_.seed ^ mixed(index ^ mixed(std::bit_cast<uint64_t>(side))));
  const size_t expected = out.size() + static_cast<size_t>(piece.area() / (side * side)) + 1;
  if (expected > out.capacity()) out.reserve(expected + expected / 2);
  const auto last_row = static_cast<int64_t>(std::floor(outline.high.y / side));
  for (auto row = static_cast<int64_t>(std::floor(outline.low.y / side)); row <= last_row; ++row) {
    const dvec2 reach = outline.reach(double(row) * side, double(row + 1) * side);
    const auto last = static_cast<int64_t>(std::floor(reach.y / side));
    for (auto column = static_cast<int64_t>(std::floor(reach.x / side)); column <= last; ++column) {
      const uint64_t draw = mixed(key ^ (static_cast<uint64_t>(row) << 32 | static_cast<uint32_t>(column)));
      const dvec2 place = side * dvec2(double(column) + share_of(draw), double(row) + share_of(draw >> 32));
      if (outline.has(place)) take(point_of(facet, place), draw);
    }
  }
}

void ClutterPatches::cover(const ClutterParts::Part& part, const Polygon& piece, const FacetWorld& world,
                           const Ends& ends, std::vector<Scatterer>& out) const {
  const PosedFacet& facet = world.facet(part.facet);
  const dvec3 &from = ends.transmitter.position, &to = ends.receiver.position;
  if (hidden(facet, piece, from, to, ends, [](const dvec3&) { return 1.0; })) return;
  const double side = side_of(facet, piece, from, to, scatterers_in_a_cell, ends);
  uint32_t tube = part.tube;
  CellField field;
  if (cells_ && tube != ClutterParts::of_a_beam) field = cells_->turned(tube, ends.turn);
  spread(part.facet, piece, side, world, out, [&](const dvec3& point, uint64_t draw) {
    if (cells_ && part.tube == ClutterParts::of_a_beam) {  // a long facet may reach over several cells
      const uint32_t at = ends.sight.grid.tube_at(point - from);
      if (at == RayGrid::outside) return;
      if (at != tube) tube = at, field = cells_->turned(at, ends.turn);
    }
    Leg there(from, point);
    there.field = cells_ ? field.towards(there.in) : field_towards(*ends.sender, there.in);
    Complex sent;
    if (ends.element) {
      Leg home(to, point);
      home.field = field_towards(*ends.element, home.in);
      sent = amplitude(facet, there, home, side, draw);
    } else {
      sent = amplitude(facet, there, there, side, draw);
    }
    out.push_back({sent, point, part.facet, ClutterParts::no_mirror, Scatterer::Over::none});
  });
}

/// Holds a mirror and the image of the radar that it shows.
struct ClutterPatches::Over {
  const PosedFacet& mirror;
  dvec3 radar, image;
  const RadioSurfaces& surfaces;
  const EchoOptions& options;

  /// Returns the wave that seems to come from the image. `field` is that of the tube which met the mirror.
  Leg leg(const dvec3& point, const CellField& field) const {
    Leg leg(image, point);
    const dvec3 departure = mirrored_direction(mirror, radar, point);
    const SurfaceBounce at = bounce_of(surfaces, mirror, field.towards(departure), departure);
    leg.field = at.reflected;
    leg.field.scale(coherent_share(surfaces, options, mirror.material, at.cosine));
    return leg;
  }
  /// Returns the share of the power that the mirror leaves to the stronger polarization.
  double share(const dvec3& point) const {
    const double towards = glm::dot(mirrored_direction(mirror, radar, point), mirror.normal),
                 cosine = std::min(1.0, std::abs(towards));
    const ReflectionCoefficients fresnel = surfaces.reflect(mirror.material, towards < 0.0, cosine);
    const double kept = coherent_share(surfaces, options, mirror.material, cosine);
    return kept * kept * std::max(std::norm(fresnel.r_te), std::norm(fresnel.r_tm));
  }
};

void ClutterPatches::cover_over(const ClutterParts::Part& part, const Polygon& piece, const FacetWorld& world,
                                const Ends& ends, std::vector<Scatterer>& out) const {
  using Way = Scatterer::Over;
  const PosedFacet& facet = world.facet(part.facet);
  const dvec3& radar = ends.transmitter.position;
  const Over over{world.facet(part.mirror), radar, mirrored(world.facet(part.mirror), radar), surfaces_,
                  options_};
  const bool both = options_.max_bounces >= mirror_bounces &&
                    !hidden(facet, piece, over.image, over.image, ends, [&](const dvec3& point) {
                      const double once = over.share(point);
                      return once * once;
                    });
  const bool once =
      facet.distance(over.image) * facet.distance(radar) > 0.0 &&
      !hidden(facet, piece, over.image, radar, ends, [&](const dvec3& point) { return over.share(point); });
  if (!both && !once) return;
  const double side = side_of(facet, piece, over.image, once ? radar : over.image, mirrored_in_a_cell, ends);
  const CellField field = cells_->turned(part.tube, ends.turn);
  uint32_t direct_tube = RayGrid::outside;
  CellField direct_field;
  spread(part.facet, piece, side, world, out, [&](const dvec3& point, uint64_t draw) {
    const Leg there = over.leg(point, field);
    if (both)
      out.push_back({amplitude(facet, there, there, side, draw), point, part.facet, part.mirror, Way::both});
    if (!once) return;
    const uint32_t tube = ends.sight.grid.tube_at(point - radar);
    if (tube == RayGrid::outside) return;
    const dvec3 lit = facet.distance(radar) > 0.0 ? facet.normal : -facet.normal;
    if (!ends.sight.tracer.clear(ends.sight.view, EchoTracer::lifted(point, lit), radar, part.facet)) return;
    if (tube != direct_tube) direct_tube = tube, direct_field = cells_->turned(tube, ends.turn);
    Leg home(radar, point);
    home.field = direct_field.towards(home.in);
    // The way out directly and home over the mirror is the reciprocal of this one.
    const Complex sent = amplitude(facet, there, home, side, draw);
    out.push_back({sent, point, part.facet, part.mirror, Way::out});
    out.push_back({sent, point, part.facet, part.mirror, Way::home});
  });
}

std::vector<Scatterer> ClutterPatches::scatterers(const ClutterParts& parts, const FacetWorld& world,
                                                  const Ends& ends) const {
  std::vector<std::vector<Scatterer>> found((parts.parts.size() + part_chunk - 1) / part_chunk);
  parallel_for(found.size(), options_.threads, [&](size_t chunk) {
    for (size_t i = chunk * part_chunk; i < std::min(parts.parts.size(), (chunk + 1) * part_chunk); ++i) {
      const ClutterParts::Part& part = parts.parts[i];
      if (part.mirror == ClutterParts::no_mirror)
        cover(part, parts.piece(part), world, ends, found[chunk]);
      else
        cover_over(part, parts.piece(part), world, ends, found[chunk]);
    }
  });
  size_t count = 0;
  for (const auto& some : found) count += some.size();
  std::vector<Scatterer> all;
  all.reserve(count);
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
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

FoundPatches ClutterPatches::find(const ClutterParts& parts, const FacetWorld& world,
                                  const ClutterSight& sight, const Pose& transmitter, const Pose& receiver,
                                  const EchoMotion& motion) const {
  Ends ends{transmitter, receiver, sight, glm::mat3_cast(transmitter.orientation), 0.0, {}, {}};
  ends.cell_rad = cell_rad(motion);
  if (!cells_)
    ends.sender.emplace(transmitter_pattern_, std::span(&transmitter_slant_, 1), transmitter.orientation);
  if (!monostatic_)
    ends.element.emplace(receiver_pattern_, std::span(&receiver_slant_, 1), receiver.orientation);
  return timed(scatterers(parts, world, ends), world, ends, motion);
}

}  // namespace greatx::rf
