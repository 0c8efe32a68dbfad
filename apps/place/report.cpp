// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/place/report.h"

#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace greatx::apps {

namespace {

using scene::place::Finding;
using scene::place::PlaceReport;

constexpr size_t shown_objects = 5;

const char* name_of(Finding::Kind kind) {
  constexpr const char* names[] = {"repaired", "left out", "assumed", "doubtful"};
  return names[static_cast<size_t>(kind)];
}

struct Topic {
  Finding::Kind kind;
  std::vector<const Finding*> findings;
};

/// Findings by topic, in the order of their first one.
std::vector<std::pair<std::string, Topic>> topics_of(const PlaceReport& report) {
  std::vector<std::pair<std::string, Topic>> topics;
  std::map<std::string, size_t> index;
  for (const Finding& finding : report.findings) {
    const auto [found, is_new] = index.try_emplace(finding.topic, topics.size());
    if (is_new) topics.push_back({finding.topic, {finding.kind, {}}});
    topics[found->second].second.findings.push_back(&finding);
  }
  return topics;
}

double percent_off(double built, double source) {
  return source > 0.0 ? 100.0 * (built - source) / source : 0.0;
}

/// The lines of numbers that text and Markdown share.
std::vector<std::string> lines_of(const PlaceReport& report, const LoadedPlace& loaded) {
  std::vector<std::string> lines;
  const dvec2 size = report.rectangle.high - report.rectangle.low;
  const Georeference& frame = report.reference;
  lines.push_back(
      fmt::format("{:.0f} m x {:.0f} m about {:.6f}, {:.6f}, {:.1f} m above the ellipsoid of WGS 84", size.x,
                  size.y, frame.origin.latitude_deg, frame.origin.longitude_deg, frame.origin.height_m));
  lines.push_back(fmt::format("{} buildings of {} parts with {} courts; {} triangles, {} facets",
                              report.buildings, report.parts, report.courts, report.triangles,
                              loaded.facets));
  std::vector<std::string> heights;
  for (const auto& [from, count] : report.heights) heights.push_back(fmt::format("{} by {}", count, from));
  lines.push_back(fmt::format("heights: {}", fmt::join(heights, ", ")));
  lines.push_back(fmt::format("footprints: {:.1f} m^2 of {:.1f} m^2 in the sources ({:+.3f} %)",
                              report.built_area_m2, report.source_area_m2,
                              percent_off(report.built_area_m2, report.source_area_m2)));
  lines.push_back(fmt::format("volumes: {:.1f} m^3 of {:.1f} m^3 ({:+.3f} %)", report.built_volume_m3,
                              report.source_volume_m3,
                              percent_off(report.built_volume_m3, report.source_volume_m3)));
  lines.push_back(
      fmt::format("outlines: no corner is off by more than {:.3f} m in plan, heights that nearly agree moved "
                  "by at most {:.3f} m",
                  report.most_moved_m, report.most_welded_m));
  if (report.terrain_samples > 0)
    lines.push_back(fmt::format("terrain: at most {:.3f} m off at {} samples", report.terrain_error_m,
                                report.terrain_samples));
  else
    lines.push_back("terrain: level, as there is no source of heights");
  std::vector<std::string> objects;
  for (const auto& [kind, count] : report.objects) objects.push_back(fmt::format("{} {}", count, kind));
  using enum scene::FaultSeverity;
  std::vector<std::string> kinds;
  for (const scene::SceneFault& entry : loaded.check.faults)
    kinds.push_back(fmt::format("{} {}", entry.count, entry.kind));
  lines.push_back(fmt::format("scene check: {} faults, {} doubts{}{}", loaded.check.count(fault),
                              loaded.check.count(doubt), kinds.empty() ? "" : ": ", fmt::join(kinds, ", ")));
  if (!objects.empty()) lines.push_back(fmt::format("objects: {}", fmt::join(objects, ", ")));
  return lines;
}

}  // namespace

nlohmann::json json_of(const PlaceReport& report, const LoadedPlace& loaded) {
  nlohmann::json json;
  json["name"] = report.name;
  json["georeference"] = {{"latitude_deg", report.reference.origin.latitude_deg},
                          {"longitude_deg", report.reference.origin.longitude_deg},
                          {"height_m", report.reference.origin.height_m},
                          {"undulation_m", report.reference.undulation_m},
                          {"vertical_datum", report.reference.vertical_datum}};
  json["rectangle_m"] = {report.rectangle.low.x, report.rectangle.low.y, report.rectangle.high.x,
                         report.rectangle.high.y};
  json["buildings"] = {{"count", report.buildings},
                       {"parts", report.parts},
                       {"courts", report.courts},
                       {"heights", report.heights},
                       {"source_area_m2", report.source_area_m2},
                       {"built_area_m2", report.built_area_m2},
                       {"source_volume_m3", report.source_volume_m3},
                       {"built_volume_m3", report.built_volume_m3},
                       {"most_welded_m", report.most_welded_m},
                       {"most_moved_m", report.most_moved_m}};
  json["triangles"] = report.triangles_by_kind;
  json["facets"] = loaded.facets;
  nlohmann::json check = nlohmann::json::object();
  for (const scene::SceneFault& entry : loaded.check.faults) check[entry.kind] = entry.count;
  json["scene_check"] = {{"faults", loaded.check.count(scene::FaultSeverity::fault)},
                         {"doubts", loaded.check.count(scene::FaultSeverity::doubt)},
                         {"rays", loaded.check.figures.rays},
                         {"rays_out", loaded.check.figures.rays_out},
                         {"kinds", check}};
  json["ground_m2"] = report.cover_m2;
  json["objects"] = report.objects;
  json["terrain"] = {{"samples", report.terrain_samples},
                     {"largest_error_m", report.terrain_error_m},
                     {"corners_without_data", report.ground_filled}};
  json["findings"] = nlohmann::json::array();
  for (const Finding& finding : report.findings)
    json["findings"].push_back({{"kind", name_of(finding.kind)},
                                {"topic", finding.topic},
                                {"object", finding.object},
                                {"detail", finding.detail}});
  json["materials"] = nlohmann::json::object();
  for (const auto& [material_class, names] : report.materials) json["materials"][material_class] = names;
  json["licences"] = report.licences;
  return json;
}

std::string markdown_of(const PlaceReport& report, const LoadedPlace& loaded) {
  std::string text = fmt::format("# {}\n\n", report.name);
  for (const std::string& line : lines_of(report, loaded)) text += fmt::format("- {}\n", line);
  text += "\n![sources and scene from above](plan.png)\n\n## Ground\n\n| cover | m^2 |\n|---|---|\n";
  for (const auto& [cover, size] : report.cover_m2) text += fmt::format("| {} | {:.0f} |\n", cover, size);
  text += "\n## Findings\n";
  const auto topics = topics_of(report);
  if (topics.empty()) text += "\nThere are none.\n";
  for (const auto& [name, topic] : topics) {
    text += fmt::format("\n**{}** ({}, {})\n\n", name, topic.findings.size(), name_of(topic.kind));
    for (size_t i = 0; i < std::min(shown_objects, topic.findings.size()); ++i)
      text += fmt::format("- {}: {}\n", topic.findings[i]->object, topic.findings[i]->detail);
    if (topic.findings.size() > shown_objects)
      text += fmt::format("- and {} more in report.json\n", topic.findings.size() - shown_objects);
  }
  text += "\n## Materials\n\n| class | materials |\n|---|---|\n";
  for (const auto& [material_class, names] : report.materials)
    text += fmt::format("| {} | {} |\n", material_class, fmt::join(names, ", "));
  text += "\n## Licences\n\n";
  if (report.licences.empty()) text += "The sources state none.\n";
  for (const std::string& licence : report.licences) text += fmt::format("- {}\n", licence);
  return text;
}

std::string summary_of(const PlaceReport& report, const LoadedPlace& loaded) {
  std::string text;
  for (const std::string& line : lines_of(report, loaded)) text += fmt::format("  {}\n", line);
  for (const auto& [name, topic] : topics_of(report)) {
    const Finding& first = *topic.findings.front();
    text += fmt::format("  {}: {} x {} ({}: {})\n", name_of(topic.kind), topic.findings.size(), name,
                        first.object, first.detail);
  }
  return text;
}

}  // namespace greatx::apps
