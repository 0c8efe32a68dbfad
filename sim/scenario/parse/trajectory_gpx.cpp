// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/trajectory_gpx.h"

#include <cmath>
#include <string>

#include "sim/scenario/limits.h"
#include "sim/scenario/parse/csv.h"
#include "sim/scenario/parse/xml_text.h"

namespace greatx::sim {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const size_t first = text.find_first_not_of(blanks);
  return first == text.npos ? std::string_view()
                            : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

WayPoint parse_track_point(const pugi::xml_node& node, const SourceLocation& where, const WayPointLog& log,
                           LogTimes& times) {
  const auto fail_as = [&](const char* what) {
    return [&where, what](const std::string& expected, const std::string& found) {
      throw_user_error_at(where, "<trkpt>: {}: expected {}, found {}", what, expected, found);
    };
  };
  const auto number = [&](const char* what, std::string_view text) {
    const std::optional<double> value = csv_number(text);
    if (!value || !(std::abs(*value) <= most_position_m))
      fail_as(what)("a number", text.empty() ? "none" : fmt::format("'{}'", text));
    return value.value_or(0.0);
  };
  const Geodetic place{number("lat", trimmed(node.attribute("lat").value())),
                       number("lon", trimmed(node.attribute("lon").value())),
                       number("ele", trimmed(node.child_value("ele")))};
  WayPoint point;
  point.time_s = times.next(trimmed(node.child_value("time")), fail_as("time"));
  point.position_m = log.earth.local(place, fail_as("position"));
  return point;
}

}  // namespace

std::vector<WayPoint> parse_gpx(std::string_view text, const std::string& name, const WayPointLog& log) {
  XmlLines lines(text, name);
  const pugi::xml_document document = parse_xml(text, lines);
  const pugi::xml_node root = document.child("gpx"), track = root.child("trk");
  if (!root) throw_user_error("{}: expected the root element <gpx>: not a GPX file", name);
  if (!track) throw_user_error("{}: expected a track (<trk>), found none", name);
  if (const pugi::xml_node second = track.next_sibling("trk"))
    throw_user_error_at(lines.where(second.offset_debug()),
                        "<gpx>: expected one track (<trk>), found a second");
  std::vector<WayPoint> points;
  LogTimes times(log);
  for (const pugi::xml_node& segment : track.children("trkseg"))
    for (const pugi::xml_node& point : segment.children("trkpt"))
      points.push_back(parse_track_point(point, lines.where(point.offset_debug()), log, times));
  if (points.empty()) throw_user_error("{}: expected one track point (<trkpt>) or more, found none", name);
  return points;
}

std::vector<WayPoint> load_gpx(const std::filesystem::path& file, const WayPointLog& log) {
  return parse_gpx(read_csv_file(file, "track points (GPX)"), file.string(), log);
}

}  // namespace greatx::sim
