// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses the targets of a channel.
#include <algorithm>
#include <fnmatch.h>

#include "core/text.h"
#include "sim/scenario/parse/rcs_csv.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

/// Returns the class of a node's model as far as the scenario says it: its own, or that of a generated car or
/// quadrotor.
std::string class_of(const NodeConfig& node) {
  if (node.semantic_class) return *node.semantic_class;
  const auto* generated = node.model ? std::get_if<Generated>(&node.model->source) : nullptr;
  if (generated == nullptr) return "";
  return generated->kind == "car" ? "vehicle" : generated->kind == "quadrotor" ? "uav" : "";
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

TargetConfig parse_model(const Field& field, const FieldMap& map, RcsFiles& loaded) {
  TargetConfig target;
  target.where = field.where();
  map.exclude("tr38901", "table");
  map.exclude("tr38901", "tubes");
  map.exclude("table", "tubes");
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
  const Field file = map.require("table", "a table of scattering (or 'tubes' or 'tr38901')");
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
      const FieldMap of(item, {"nodes", "class", "tr38901", "table", "tubes"});
      TargetConfig target = parse_model(item, of, loaded);
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
