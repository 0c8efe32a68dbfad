// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay/path_story.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "draw/paths/facts.h"
#include "view/overlay/record_arrays.h"

namespace greatx::view {

namespace {

const char* verb_of(rf::InteractionType type) {
  switch (type) {
    case rf::InteractionType::none:
      return "passes";
    case rf::InteractionType::reflection:
      return "is reflected at";
    case rf::InteractionType::transmission:
      return "goes through";
    case rf::InteractionType::diffraction:
      return "is diffracted at an edge of";
    case rf::InteractionType::scattering:
      return "is scattered at";
    case rf::InteractionType::target:
      return "is sent on by the target";
  }
  return "passes";
}

/// Half of the angle by which the path turns back: by the law of reflection, that from the normal.
std::optional<double> reflection_angle(const dvec3& before, const dvec3& at, const dvec3& after) {
  const dvec3 back = before - at, on = after - at;
  const double lengths = glm::length(back) * glm::length(on);
  if (!(lengths > 0.0)) return {};
  return 0.5 * std::acos(std::clamp(glm::dot(back, on) / lengths, -1.0, 1.0));
}

/// Column `name` of ids as on disk, [paths, depth]; empty if the record has none.
std::span<const uint32_t> ids_of(const RecordArrays& record, const PathArrays& arrays, const char* name) {
  return record.has(name) ? record.get<uint32_t>(name, {arrays.count, arrays.depth})
                          : std::span<const uint32_t>();
}

void add_stops(PathStory& story, const RecordTables& tables, const RecordArrays& record,
               const PathArrays& arrays, size_t i, const rf::Path& path) {
  const std::span<const uint32_t> facets = ids_of(record, arrays, "facet"),
                                  elements = ids_of(record, arrays, "element");
  const auto depth = static_cast<size_t>(arrays.depth);
  const size_t count = path.interactions.size();
  const auto index = [](std::span<const uint32_t> ids, size_t at) {
    return ids.empty() || ids[at] == 0 ? std::nullopt : std::optional(ids[at] - 1);
  };
  for (size_t k = 0; k < count; ++k) {
    const size_t cell = i * depth + k;
    PathStop stop;
    stop.type = path.interactions[k].type;
    stop.at = path.vertices[k];
    const dvec3 before = k == 0 ? story.start : path.vertices[k - 1],
                after = k + 1 == count ? story.end : path.vertices[k + 1];
    stop.leg_m = glm::distance(before, stop.at);
    stop.object = tables.instance_name(arrays.object[cell]);
    stop.material = tables.material_name(arrays.material[cell]);
    stop.facet = index(facets, cell);
    stop.element = index(elements, cell);
    if (stop.type == rf::InteractionType::reflection) stop.angle = reflection_angle(before, stop.at, after);
    story.stops.push_back(std::move(stop));
  }
  story.last_leg_m = glm::distance(count == 0 ? story.start : path.vertices.back(), story.end);
}

/// Whether the row's link is one of the channel, which a damaged record need not say.
bool is_of(const ChannelFacts& channel, int32_t rx, int32_t tx) {
  return rx >= 0 && tx >= 0 && static_cast<size_t>(rx) < channel.receivers.size() &&
         static_cast<size_t>(tx) < channel.transmitters.size();
}

std::string stop_words(const PathStop& stop) {
  std::string what = stop.material;
  if (stop.angle)
    what += fmt::format(", {:.1f} deg from the {}", degrees(*stop.angle),
                        stop.type == rf::InteractionType::diffraction ? "edge" : "normal");
  if (stop.loss_db) what += fmt::format(", {:.1f} dB", -*stop.loss_db);
  if (!stop.more.empty()) what += ", " + stop.more;
  return fmt::format("after {:.2f} m {} {} ({})", stop.leg_m, verb_of(stop.type), stop.object, what);
}

}  // namespace

std::optional<PathStory> path_story(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                                    const NodePoses& poses, uint64_t row_id) {
  const SensorFacts& facts = tables.facts(spec);
  if (!facts.channel) throw_user_error("{}: expected the metadata of a channel", spec.name);
  const ChannelFacts& channel = *facts.channel;
  const RecordArrays checked(spec, record);
  if (row_id == 0 || !checked.has("id")) return {};
  const PathArrays arrays = path_arrays(checked, spec);
  for (size_t i = 0; i < static_cast<size_t>(arrays.count); ++i) {
    if (!is_of(channel, arrays.rx[i], arrays.tx[i])) continue;
    const auto rx = static_cast<size_t>(arrays.rx[i]), tx = static_cast<size_t>(arrays.tx[i]);
    if (path_row_id(arrays.id[i], rx * channel.transmitters.size() + tx) != row_id) continue;
    const Place &from = channel.transmitters[tx].place, &to = channel.receivers[rx].place;
    const std::optional<Pose> start = poses.world_from(from), end = poses.world_from(to);
    if (!start || !end) return {};
    const rf::Path path = path_of(checked, arrays, i);
    PathStory story;
    story.row_id = row_id;
    story.id = arrays.id[i];
    story.chain = apps::chain_of(path);
    story.from = printable(from.name);
    story.to = printable(to.name);
    story.start = start->position;
    story.end = end->position;
    story.length_m = path.length_m;
    story.delay_s = path.delay_s;
    story.doppler_hz = path.doppler_hz;
    story.wavelength_m = speed_of_light / channel.carrier_hz;
    story.gain_db = apps::gain_db(apps::path_gain(path, channel.carrier_hz));
    story.free_space_db = decibels(std::pow(story.wavelength_m / (4.0 * pi * path.length_m), 2.0));
    story.departure = {arrays.departure[2 * i], arrays.departure[2 * i + 1]};
    story.arrival = {arrays.arrival[2 * i], arrays.arrival[2 * i + 1]};
    if (checked.has("foliage")) story.foliage_m = checked.finite<double>("foliage", {arrays.count})[i];
    add_stops(story, tables, checked, arrays, i, path);
    return story;
  }
  return {};
}

std::vector<std::string> words_of(const PathStory& story) {
  const auto angles = [](const dvec2& zenith_azimuth) {
    return fmt::format("azimuth {:.1f} deg, elevation {:.1f} deg", degrees(zenith_azimuth.y),
                       90.0 - degrees(zenith_azimuth.x));
  };
  std::vector<std::string> words{fmt::format("leaves {} at {}", story.from, angles(story.departure))};
  for (const PathStop& stop : story.stops) words.push_back(stop_words(stop));
  const double excess_db = story.free_space_db - story.gain_db;
  words.push_back(fmt::format(
      "after {:.2f} m reaches {} from {}: {:.2f} m in all ({:.2f} ns), {:.1f} dB, which is {:.1f} dB {} free "
      "space over that length; Doppler {:+.1f} Hz",
      story.last_leg_m, story.to, angles(story.arrival), story.length_m, 1e9 * story.delay_s, story.gain_db,
      std::abs(excess_db), excess_db >= 0.0 ? "below" : "above", story.doppler_hz));
  if (story.foliage_m && *story.foliage_m > 0.0)
    words.back() += fmt::format("; {:.2f} m of it inside foliage", *story.foliage_m);
  return words;
}

}  // namespace greatx::view
