// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Follows the delays of scatterers over a frame.
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/parallel.h"
#include "core/units.h"
#include "rf/atmosphere/path_attenuation.h"
#include "rf/radar/echoes/clutter_ends.h"
#include "rf/radar/echoes/echo_tracks.h"

namespace greatx::rf {
namespace {

constexpr size_t scatterer_chunk = 1024;
/// Scatterers that need more blocks than this become echoes with delays of their own.
constexpr uint32_t most_blocks = 8;

size_t chunks_of(size_t count) { return (count + scatterer_chunk - 1) / scatterer_chunk; }

/// The lengths of the ways over scatterers at a few times.
class Ways {
 public:
  Ways(const std::vector<Scatterer>& all, const FacetWorld& world, size_t bodies, const EchoMotion& motion,
       std::vector<double> times, uint32_t threads)
      : all_(all), world_(world), table_(motion, asked(bodies), std::move(times), threads) {}

  double length(size_t i, size_t time) const {
    const uint32_t body = world_.facet(all_[i].facet).body;
    const dvec3 at = body == 0 ? all_[i].point : table_.body(body, time).apply(carried_[i]);
    const dvec3& radar = table_.transmitter(time);
    if (all_[i].over == Scatterer::Over::none)
      return glm::distance(at, radar) + glm::distance(at, table_.receiver(time));
    const double over = glm::distance(at, image(all_[i].mirror, radar, time));
    return over + (all_[i].over == Scatterer::Over::both ? over : glm::distance(at, radar));
  }

 private:
  /// Returns the image of a point in a mirror at a time.
  dvec3 image(uint32_t mirror, const dvec3& point, size_t time) const {
    const PosedFacet& facet = world_.facet(mirror);
    if (facet.body == 0) return mirrored(facet, point);
    // The facet is known at the pose with which the scene was traced.
    const Pose &known = world_.motion(facet.body).pose, &then = table_.body(facet.body, time);
    const dvec3 there = known.apply(then.inverse().apply(point));
    return then.apply(known.inverse().apply(mirrored(facet, there)));
  }
  std::span<const bool> asked(size_t bodies) {
    asked_ = std::make_unique<bool[]>(bodies);
    for (const Scatterer& one : all_)
      if (one.over != Scatterer::Over::none) asked_[world_.facet(one.mirror).body] = true;
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

/// Returns the directions in which a way leaves the transmitter and comes back to the receiver.
struct Directions {
  dvec3 departure, arrival;
};
Directions directions_of(const Scatterer& one, const FacetWorld& world, const dvec3& from, const dvec3& to) {
  const dvec3 out = glm::normalize(one.point - from), home = glm::normalize(one.point - to);
  if (one.over == Scatterer::Over::none) return {out, home};
  const dvec3 over = mirrored_direction(world.facet(one.mirror), from, one.point);
  using Way = Scatterer::Over;
  return {one.over == Way::home ? out : over, one.over == Way::out ? home : over};
}

}  // namespace

void ClutterPatches::add_blocks(const std::vector<Scatterer>& all, const FacetWorld& world, const Ends& ends,
                                const EchoMotion& motion, PatchList& list) const {
  const uint32_t slots = static_cast<uint32_t>(motion.slot_start_s.size());
  const double frame_s = std::max(motion.frame_s(), options_.waveform.interval_s);
  const size_t count = all.size();
  for (auto* column : {&list.re, &list.im}) column->resize(count);
  list.departure.resize(count), list.instance.resize(count);
  const bool arrivals = !monostatic_ || std::any_of(all.begin(), all.end(), [](const Scatterer& one) {
    return one.over == Scatterer::Over::out || one.over == Scatterer::Over::home;
  });
  if (arrivals) list.arrival.resize(count);
  list.delay_s.resize(list.blocks * count), list.rate.resize(list.blocks * count);
  const double step_s = 0.25 * frame_s / list.blocks;
  std::vector<double> times;
  for (uint32_t block = 0; block < list.blocks; ++block)
    for (const double time :
         about(patch_block(options_.waveform, motion.first_slot, slots, list.blocks, block).middle_s, step_s))
      times.push_back(time);
  const Ways ways(all, world, scene_.bodies.size(), motion, std::move(times), options_.threads);
  parallel_for(chunks_of(count), options_.threads, [&](size_t chunk) {
    for (size_t i = chunk * scatterer_chunk; i < std::min(count, (chunk + 1) * scatterer_chunk); ++i) {
      const Scatterer& one = all[i];
      const Directions to = directions_of(one, world, ends.transmitter.position, ends.receiver.position);
      list.departure[i] = vec3(to.departure);
      if (arrivals) list.arrival[i] = vec3(to.arrival);
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
}

FoundPatches ClutterPatches::timed(std::vector<Scatterer> all, const FacetWorld& world, const Ends& ends,
                                   const EchoMotion& motion) const {
  const uint32_t slots = static_cast<uint32_t>(motion.slot_start_s.size());
  const double frame_s = std::max(motion.frame_s(), options_.waveform.interval_s);
  FoundPatches found;
  if (options_.scatterer_echoes) {
    found.fast = std::move(all);
    return found;
  }
  std::vector<uint32_t> blocks(all.size());
  {
    const double step_s = 0.5 * frame_s;
    const Ways ways(all, world, scene_.bodies.size(), motion,
                    about(motion.slot_start_s.front() + step_s, step_s), options_.threads);
    parallel_for(chunks_of(all.size()), options_.threads, [&](size_t chunk) {
      for (size_t i = chunk * scatterer_chunk; i < std::min(all.size(), (chunk + 1) * scatterer_chunk); ++i) {
        const Slopes at = slopes(ways, i, 0, step_s);
        blocks[i] = patch_blocks(options_.waveform, slots, std::abs(at.rate), std::abs(at.curvature_per_s));
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
  add_blocks(all, world, ends, motion, found.list);
  return found;
}

}  // namespace greatx::rf
