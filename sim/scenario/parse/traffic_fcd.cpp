// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/traffic_fcd.h"

#include <cmath>

#include "core/units.h"
#include "sim/scenario/limits.h"
#include "sim/scenario/parse/csv.h"
#include "sim/scenario/parse/xml_text.h"

namespace greatx::sim {
namespace {

double number_of(const pugi::xml_node& node, const char* attribute, const SourceLocation& where, double most,
                 std::optional<double> missing = std::nullopt) {
  const pugi::xml_attribute found = node.attribute(attribute);
  if (!found && missing) return *missing;
  const std::optional<double> value = csv_number(found.value());
  if (!value || !(std::abs(*value) <= most))
    throw_user_error_at(where, "<{}>: {}: expected a number from {} to {}, found {}", node.name(), attribute,
                        -most, most, found ? fmt::format("'{}'", found.value()) : "none");
  return *value;
}

/// Words in the types of SUMO and of its vehicle classes, and the variants that look like them.
struct TypeWord {
  const char* word;
  const char* variant;
};
constexpr TypeWord type_words[] = {{"double", "double_decker"},
                                   {"coach", "coach"},
                                   {"bus", "city_bus"},
                                   {"tram", "tram"},
                                   {"rail", "tram"},
                                   {"trailer", "articulated_lorry"},
                                   {"truck", "lorry"},
                                   {"lorry", "lorry"},
                                   {"delivery", "panel_van"},
                                   {"van", "van"},
                                   {"taxi", "taxi"},
                                   {"emergency", "ambulance"},
                                   {"fire", "fire_engine"},
                                   {"moped", "scooter"},
                                   {"scooter", "scooter"},
                                   {"motorcycle", "motorcycle"},
                                   {"bicycle", "bicycle"},
                                   {"bike", "bicycle"},
                                   {"suv", "suv"},
                                   {"estate", "estate"},
                                   {"hatchback", "hatchback"},
                                   {"child", "child"},
                                   {"woman", "woman"},
                                   {"elder", "elder"}};

const TrafficVariant* find_variant(const std::string& name) {
  for (const TrafficVariant& variant : traffic_variants())
    if (name == variant.name) return &variant;
  return nullptr;
}

/// Chooses what a track looks like: as the scenario says, by a word in its type, or the most common one.
void choose_variant(RecordedTrack& track, const std::string& type, bool person, const TrackOptions& options) {
  track.variant = person ? "man" : "compact";
  const std::string small = lower_case(type);
  for (const TypeWord& word : type_words) {
    const TrafficVariant* variant = find_variant(word.variant);
    if (variant == nullptr || (variant->kind == TrafficMember::Kind::pedestrian) != person) continue;
    if (small.find(word.word) == std::string::npos) continue;
    track.variant = word.variant;
    break;
  }
  if (const auto found = options.types.find(type); found != options.types.end())
    track.variant = found->second;
  track.kind = find_variant(track.variant)->kind;
}

/// Collects the tracks of a file by their ids.
class TrackList {
 public:
  RecordedTrack& at(const std::string& id, bool person, const SourceLocation& where) {
    const auto [entry, is_new] = index_.try_emplace({person, id}, tracks_.size());
    if (is_new) {
      tracks_.emplace_back();
      tracks_.back().id = id;
      tracks_.back().where = where;
    }
    return tracks_[entry->second];
  }
  std::vector<RecordedTrack> take() { return std::move(tracks_); }

 private:
  std::map<std::pair<bool, std::string>, size_t> index_;
  std::vector<RecordedTrack> tracks_;
};

}  // namespace

std::vector<RecordedTrack> parse_fcd(std::string_view text, const std::string& name,
                                     const TrackOptions& options) {
  XmlLines lines(text, name);
  const pugi::xml_document document = parse_xml(text, lines);
  const pugi::xml_node root = document.child("fcd-export");
  if (!root) throw_user_error("{}: expected the root element <fcd-export>: not floating-car data", name);
  TrackList tracks;
  double before_s = 0.0, step_s = 0.0;
  bool first = true;
  for (const pugi::xml_node& moment : root.children("timestep")) {
    const SourceLocation at = lines.where(moment.offset_debug());
    const double file_s = number_of(moment, "time", at, most_time_s);
    if (!first && !(file_s > before_s))
      throw_user_error_at(at, "<timestep>: time: expected a time after {}, found {}", before_s, file_s);
    step_s = first ? 0.0 : file_s - before_s;
    const double last_s = before_s - options.start_s;
    before_s = file_s;
    const double time_s = file_s - options.start_s;
    for (const pugi::xml_node& one : moment.children()) {
      const bool person = std::string_view(one.name()) == "person";
      if (!person && std::string_view(one.name()) != "vehicle") continue;
      const SourceLocation where = lines.where(one.offset_debug());
      const std::string id = one.attribute("id").value();
      if (id.empty()) throw_user_error_at(where, "<{}>: id: expected a name, found none", one.name());
      RecordedTrack& track = tracks.at(id, person, where);
      if (track.stretches.empty()) choose_variant(track, one.attribute("type").value(), person, options);
      const double angle = radians(90.0 - number_of(one, "angle", where, most_angle_deg, 90.0));
      dvec3 place(number_of(one, "x", where, most_position_m), number_of(one, "y", where, most_position_m),
                  number_of(one, "z", where, most_position_m, 0.0));
      // From the front of a vehicle back to its middle.
      place -= 0.5 * find_variant(track.variant)->length_m * dvec3(std::cos(angle), std::sin(angle), 0.0);
      const bool goes_on = !track.stretches.empty() && !first &&
                           track.stretches.back().points.back().time_s >= last_s - 0.5 * step_s - 1e-9;
      if (!goes_on) track.stretches.emplace_back();
      std::vector<WayPoint>& points = track.stretches.back().points;
      if (!points.empty() && points.back().time_s >= time_s)
        throw_user_error_at(where, "<{}>: id: expected each once in a time step, found a second '{}'",
                            one.name(), id);
      points.push_back({time_s, place + options.offset_m, orientation_from_yaw_pitch_roll(angle, 0.0, 0.0)});
    }
    first = false;
  }
  std::vector<RecordedTrack> list = tracks.take();
  if (list.empty()) throw_user_error("{}: expected one <vehicle> or <person> or more, found none", name);
  return list;
}

std::vector<RecordedTrack> parse_xosc(std::string_view text, const std::string& name,
                                      const TrackOptions& options) {
  XmlLines lines(text, name);
  const pugi::xml_document document = parse_xml(text, lines);
  if (!document.child("OpenSCENARIO")) throw_user_error("{}: expected the root element <OpenSCENARIO>", name);
  std::vector<RecordedTrack> tracks;
  for (const pugi::xpath_node& found : document.select_nodes("//Trajectory[.//Polyline]")) {
    const pugi::xml_node trajectory = found.node();
    RecordedTrack track;
    track.where = lines.where(trajectory.offset_debug());
    track.id = trajectory.attribute("name").value();
    if (track.id.empty()) throw_user_error_at(track.where, "<Trajectory>: name: expected a name, found none");
    choose_variant(track, track.id, false, options);
    WayPointTrajectory stretch;
    for (const pugi::xpath_node& item : trajectory.select_nodes(".//Polyline/Vertex")) {
      const pugi::xml_node vertex = item.node();
      const SourceLocation where = lines.where(vertex.offset_debug());
      const pugi::xml_node position = vertex.child("Position").child("WorldPosition");
      if (!position) throw_user_error_at(where, "<Vertex>: expected a <WorldPosition>, found none");
      const double time_s = number_of(vertex, "time", where, most_time_s) - options.start_s;
      if (!stretch.points.empty() && !(time_s > stretch.points.back().time_s))
        throw_user_error_at(where, "<Vertex>: time: expected a time after the one before");
      const double heading = number_of(position, "h", where, most_angle_deg, 0.0);
      constexpr double axle_m = 1.4;
      dvec3 place(number_of(position, "x", where, most_position_m),
                  number_of(position, "y", where, most_position_m),
                  number_of(position, "z", where, most_position_m, 0.0));
      place += axle_m * dvec3(std::cos(heading), std::sin(heading), 0.0) + options.offset_m;
      stretch.points.push_back({time_s, place, orientation_from_yaw_pitch_roll(heading, 0.0, 0.0)});
    }
    if (stretch.points.empty())
      throw_user_error_at(track.where, "<Trajectory>: expected one <Vertex> or more, found none");
    track.stretches.push_back(std::move(stretch));
    tracks.push_back(std::move(track));
  }
  if (tracks.empty()) throw_user_error("{}: expected a <Trajectory> with a <Polyline>, found none", name);
  return tracks;
}

}  // namespace greatx::sim
