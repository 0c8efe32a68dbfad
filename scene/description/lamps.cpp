// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/lamps.h"

#include <array>
#include <map>
#include <string_view>

namespace greatx::scene {
namespace {

constexpr std::array<const char*, 6> role_names{"red", "amber", "green", "stop", "left", "right"};
constexpr std::string_view role_prefix = "switched_";

}  // namespace

const char* name_of(LampRole role) { return role_names[static_cast<size_t>(role)]; }

std::optional<LampRole> lamp_role(const Material& material) {
  std::string_view name = material.name;
  if (!name.starts_with(role_prefix)) return std::nullopt;
  name.remove_prefix(role_prefix.size());
  for (size_t i = 0; i < role_names.size(); ++i)
    if (name == role_names[i]) return static_cast<LampRole>(i);
  return std::nullopt;
}

SwitchedLamps switched_lamps(const Scene& scene) {
  std::vector<std::optional<LampRole>> roles;
  for (const Material& material : scene.materials) roles.push_back(lamp_role(material));
  SwitchedLamps result;
  result.of_primitive.resize(scene.primitives.size(), 0);
  std::map<std::pair<uint32_t, LampRole>, uint32_t> known;
  for (size_t i = 0; i < scene.primitives.size(); ++i) {
    const Primitive& primitive = scene.primitives[i];
    const std::optional<LampRole>& role = roles[primitive.material];
    if (!role) continue;
    const auto [entry, is_new] =
        known.try_emplace({primitive.instance, *role}, static_cast<uint32_t>(result.lamps.size() + 1));
    if (is_new) result.lamps.push_back({primitive.instance, *role});
    result.of_primitive[i] = entry->second;
  }
  return result;
}

std::string name_of(const Scene& scene, const SwitchedLamp& lamp) {
  return scene.instances[lamp.instance].name + "/" + name_of(lamp.role);
}

}  // namespace greatx::scene
