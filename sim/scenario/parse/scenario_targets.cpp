// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses the targets of a channel.
#include <algorithm>
#include <cmath>
#include <fnmatch.h>

#include "core/text.h"
#include "core/units.h"
#include "sim/scenario/parse/rcs_csv.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

/// Returns the class of a node's model as far as the scenario says it: its own, or that of a generated
/// vehicle, person or quadrotor.
std::string class_of(const NodeConfig& node) {
  if (node.semantic_class) return *node.semantic_class;
  const auto* generated = node.model ? std::get_if<Generated>(&node.model->source) : nullptr;
  if (generated == nullptr) return "";
  if (generated->kind == "car" || generated->kind == "vehicle") return "vehicle";
  if (generated->kind == "person") return "person";
  return generated->kind == "quadrotor" ? "uav" : "";
}

/// Adds the nodes with a model whose names match, in the order of the scenario.
void add_matching(const Field& field, const std::vector<NodeConfig>& nodes, std::vector<uint32_t>& found) {
  const std::string pattern = field.text();
  bool any = false;
  std::vector<std::string> names;
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].model) names.push_back(nodes[i].name);
    if (fnmatch(pattern.c_str(), nodes[i].name.c_str(), 0) != 0) continue;
    if (!nodes[i].model && pattern == nodes[i].name)
      field.fail("a node with a model", fmt::format("'{}', which has none and so no surface", pattern));
    if (!nodes[i].model) continue;
    any = true;
    found.push_back(i);
  }
  if (!any)
    field.fail("the name of a node with a model, or a pattern of such",
               fmt::format("unknown '{}'{}", pattern, suggestion(pattern, names)));
}

std::vector<uint32_t> nodes_of(const FieldMap& map, const std::vector<NodeConfig>& nodes) {
  map.exclude("nodes", "class");
  std::vector<uint32_t> found;
  if (const auto f = map.find("class")) {
    const std::string wanted = parse_semantic_class(*f);
    for (uint32_t i = 0; i < nodes.size(); ++i)
      if (nodes[i].model && class_of(nodes[i]) == wanted) found.push_back(i);
    if (found.empty())
      f->fail("the class of a node's model (its 'class', or a generated car or quadrotor)",
              fmt::format("'{}', which no node has", wanted));
    return found;
  }
  const Field names = map.require("nodes", "the name of a node with a model, or a list (or 'class')");
  if (!names.is_list())
    add_matching(names, nodes, found);
  else
    for (const Field& item : names.list("names", 1)) add_matching(item, nodes, found);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Parses an end that a panel is steered to.
SurfaceEnd parse_surface_end(const Field& field, const std::vector<NodeConfig>& nodes) {
  SurfaceEnd end;
  if (field.is_scalar()) {
    end.antenna = field.text();
    const auto place = find_sensor(nodes, end.antenna);
    if (!place || !std::holds_alternative<AntennaConfig>(nodes[place->node].sensors[place->sensor].config))
      field.fail("an antenna as node/sensor, or [azimuth_deg, elevation_deg]",
                 fmt::format("'{}'", end.antenna));
    return end;
  }
  const std::vector<Field> angles = field.list("angles", 2);
  if (angles.size() != 2)
    field.fail("[azimuth_deg, elevation_deg] in the panel's frame", fmt::format("{} numbers", angles.size()));
  const double azimuth = radians(angles[0].between(-90.0, 90.0)),
               elevation = radians(angles[1].between(-90.0, 90.0));
  end.direction = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                   std::sin(elevation)};
  return end;
}

TargetSurface parse_surface(const Field& field, const std::vector<NodeConfig>& nodes) {
  const FieldMap map(field, {"rows", "columns", "row_spacing_wl", "column_spacing_wl", "amplitude",
                             "phase_deg", "phases_deg", "steer", "bits"});
  map.exclude("phase_deg", "phases_deg");
  map.exclude("phase_deg", "steer");
  map.exclude("phases_deg", "steer");
  TargetSurface surface;
  if (const auto f = map.find("rows")) surface.rows = f->integer32(1, 256);
  if (const auto f = map.find("columns")) surface.columns = f->integer32(1, 256);
  if (const auto f = map.find("row_spacing_wl")) surface.row_spacing_wl = f->between(0.05, 0.5);
  if (const auto f = map.find("column_spacing_wl")) surface.column_spacing_wl = f->between(0.05, 0.5);
  if (const auto f = map.find("amplitude")) surface.amplitude = f->between(0.0, 1.0);
  if (const auto f = map.find("bits")) surface.bits = f->integer32(0, 8);
  if (const auto f = map.find("phase_deg")) surface.phase = radians(f->between(-360.0, 360.0));
  if (const auto f = map.find("phases_deg")) {
    for (const Field& item : f->list("phases", 1))
      surface.phases.push_back(radians(item.between(-360.0, 360.0)));
    if (surface.phases.size() != size_t{surface.rows} * surface.columns)
      f->fail(fmt::format("{} phases, one for each of {} x {} elements", surface.rows * surface.columns,
                          surface.rows, surface.columns),
              fmt::format("{}", surface.phases.size()));
  }
  if (const auto f = map.find("steer")) {
    const FieldMap ends(*f, {"from", "to"});
    const auto end = [&](const char* key) {
      return parse_surface_end(
          ends.require(key, "an antenna as node/sensor, or [azimuth_deg, elevation_deg]"), nodes);
    };
    surface.steer = {end("from"), end("to")};
  }
  return surface;
}

TargetConfig parse_model(const Field& field, const FieldMap& map, const std::vector<NodeConfig>& nodes,
                         RcsFiles& loaded) {
  TargetConfig target;
  target.where = field.where();
  map.exclude("tr38901", "table");
  map.exclude("tr38901", "tubes");
  map.exclude("table", "tubes");
  for (const char* other : {"tr38901", "table", "tubes"}) map.exclude(other, "surface");
  if (const auto f = map.find("surface")) {
    target.model = parse_surface(*f, nodes);
    return target;
  }
  if (const auto f = map.find("tr38901")) {
    target.model = static_cast<rf::Tr38901Kind>(f->choice(std::span(rf::tr38901_kinds)));
    return target;
  }
  if (const auto f = map.find("tubes")) {
    const FieldMap of(*f, {"width_m", "budget", "max_bounces"});
    TargetTubes tubes;
    if (const auto g = of.find("width_m")) tubes.tube_m = g->positive(1e-4, 1e4);
    if (const auto g = of.find("budget")) tubes.budget = g->integer32(0, 4'000'000);
    if (const auto g = of.find("max_bounces")) tubes.max_bounces = g->integer32(1, 6);
    target.model = tubes;
    return target;
  }
  const Field file = map.require("table", "a table of scattering (or 'tubes', 'tr38901' or 'surface')");
  const std::filesystem::path path = file.file();
  auto [at, fresh] = loaded.try_emplace(path);
  if (fresh) at->second = load_rcs_csv(path);
  target.model = at->second;
  return target;
}

}  // namespace

void parse_targets(const FieldMap& map, const std::vector<NodeConfig>& nodes, RcsFiles& loaded,
                   ChannelConfig& channel) {
  if (const auto f = map.find("targets"))
    for (const Field& item : f->list("targets", 1)) {
      const FieldMap of(item, {"nodes", "class", "tr38901", "table", "tubes", "surface"});
      TargetConfig target = parse_model(item, of, nodes, loaded);
      for (const uint32_t node : nodes_of(of, nodes)) {
        target.node = node;
        if (std::ranges::any_of(channel.targets, [&](const TargetConfig& t) { return t.node == node; }))
          item.fail("every node once", fmt::format("a second target '{}'", nodes[node].name));
        channel.targets.push_back(target);
      }
    }
  if (const auto f = map.find("legs")) {
    if (channel.targets.empty()) f->fail("'targets' beside it", "none");
    const FieldMap of(*f, {"max_depth", "max_transmissions"});
    if (const auto g = of.find("max_depth")) channel.legs.max_depth = g->integer32(0, 8);
    if (const auto g = of.find("max_transmissions"))
      channel.legs.max_transmissions = g->integer32(0, ChannelConfig::most_walls);
  }
}

}  // namespace greatx::sim
