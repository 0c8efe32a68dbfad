// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/parts.h"

#include <algorithm>
#include <fnmatch.h>
#include <span>

#include <fmt/format.h>

namespace greatx::sim {

namespace {

void check_apart(const NodeConfig& node, const scene::Model& model, const std::vector<FoundPart>& parts) {
  for (size_t i = 0; i < parts.size(); ++i)
    for (size_t j = 0; j < parts.size(); ++j) {
      const uint32_t a = parts[i].placement.node, b = parts[j].placement.node;
      if (i == j || b < a || b >= model.nodes[a].end) continue;
      throw_user_error_at(parts[j].config->where,
                          "model.parts of node '{}': expected parts apart from each other, found '{}' {}",
                          node.name, model.nodes[b].name,
                          a == b ? "twice" : fmt::format("on '{}'", model.nodes[a].name));
    }
}

std::string unique_name(const std::string& wanted, std::span<const FoundPart> parts) {
  std::string name = wanted;
  for (size_t number = 2;
       std::ranges::any_of(parts, [&](const FoundPart& part) { return part.placement.name == name; });)
    name = fmt::format("{}_{}", wanted, number++);
  return name;
}

}  // namespace

std::vector<FoundPart> find_parts(const NodeConfig& node, const scene::Model& model) {
  std::vector<FoundPart> parts;
  for (const PartConfig& config : node.parts)
    for (const std::string& pattern : config.nodes) {
      const size_t before = parts.size();
      for (uint32_t i = 0; i < model.nodes.size(); ++i)
        if (const std::string& name = model.nodes[i].name; fnmatch(pattern.c_str(), name.c_str(), 0) == 0)
          parts.push_back({{name, i, config.axis}, &config});
      if (parts.size() == before)
        throw_user_error_at(config.where, "model.parts of node '{}': expected a node of {} ({}), found '{}'",
                            node.name, model.file.filename().string(), scene::node_names(model), pattern);
    }
  check_apart(node, model, parts);
  std::ranges::sort(parts, {}, [](const FoundPart& part) { return part.placement.node; });
  for (size_t i = 0; i < parts.size(); ++i)
    parts[i].placement.name =
        unique_name(model.nodes[parts[i].placement.node].name, std::span(parts).first(i));
  return parts;
}

}  // namespace greatx::sim
