// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/mesh/seasons.h"

#include <array>
#include <string_view>

namespace greatx::scene::generator {

namespace {

/// Colours of one kind of leaves in spring and in autumn. Those of autumn multiply a pale picture. Beside the
/// leaves of a crown stand sprays, which are a little lighter.
struct LeafColors {
  std::string_view name;  ///< behind "leaves_" and "sprays_"
  vec3 spring, autumn;
};
constexpr std::array<LeafColors, 6> leaf_colors{{
    {"green", {0.86f, 0.98f, 0.72f}, {0.62f, 0.4f, 0.05f}},   // linden and poplar turn yellow
    {"light", {0.98f, 1.0f, 0.6f}, {0.58f, 0.17f, 0.035f}},   // maple turns red
    {"olive", {0.9f, 0.92f, 0.62f}, {0.34f, 0.19f, 0.06f}},   // oak turns brown
    {"dark", {0.74f, 0.9f, 0.6f}, {0.46f, 0.3f, 0.06f}},      // plane
    {"copper", {0.8f, 0.34f, 0.34f}, {0.42f, 0.15f, 0.04f}},  // copper beech
    {"birch", {0.98f, 1.0f, 0.55f}, {0.66f, 0.46f, 0.06f}},
}};

/// Factors on the colour of grass and crops in spring, autumn and winter.
struct GroundColors {
  std::string_view name;
  vec3 spring, autumn, winter;
};
constexpr std::array<GroundColors, 10> ground_colors{{
    {"grass", {0.94f, 1.0f, 0.84f}, {0.94f, 0.86f, 0.7f}, {0.86f, 0.74f, 0.66f}},
    {"meadow", {0.9f, 1.0f, 0.8f}, {0.95f, 0.84f, 0.7f}, {0.88f, 0.74f, 0.64f}},
    {"verge", {0.92f, 1.0f, 0.8f}, {1.0f, 0.84f, 0.68f}, {0.9f, 0.74f, 0.68f}},
    {"grass_tuft", {0.95f, 1.0f, 0.8f}, {0.98f, 0.82f, 0.6f}, {0.92f, 0.72f, 0.58f}},
    // Grain is sown in autumn, is green in spring, and is cut in summer.
    {"wheat", {0.26f, 0.66f, 0.4f}, {0.8f, 0.9f, 1.2f}, {0.4f, 0.5f, 0.55f}},
    {"wheat_pale", {0.26f, 0.56f, 0.3f}, {0.74f, 0.74f, 0.8f}, {0.32f, 0.42f, 0.38f}},
    {"rapeseed", {1.0f, 1.0f, 1.0f}, {0.4f, 0.3f, 1.2f}, {0.3f, 0.36f, 1.0f}},
    {"crop", {1.3f, 1.15f, 1.1f}, {1.8f, 0.85f, 1.2f}, {1.5f, 0.6f, 1.2f}},
    {"crop_dark", {1.5f, 1.3f, 1.2f}, {2.0f, 0.9f, 1.2f}, {2.2f, 0.8f, 1.4f}},
    {"crop_young", {1.0f, 1.1f, 1.0f}, {0.95f, 0.7f, 0.9f}, {0.95f, 0.6f, 0.9f}},
}};

void turn_leaves(MaterialSpec& spec, Season season) {
  const bool body = spec.name.starts_with("leaves_");
  if (!body && !spec.name.starts_with("sprays_")) return;
  for (const LeafColors& leaves : leaf_colors) {
    if (spec.name.substr(7) != leaves.name) continue;
    if (season == Season::spring) spec.color = body ? 0.92f * leaves.spring : leaves.spring;
    if (season == Season::autumn) {
      spec.color = body ? 0.9f * leaves.autumn : leaves.autumn;
      spec.texture = body ? "leaves_pale" : "leaf_sprays_pale";
    }
    if (season == Season::winter) {
      spec.color = leaves.name == "birch" ? vec3(0.34f, 0.24f, 0.2f) : vec3(0.36f, 0.31f, 0.26f);
      spec.texture = body ? "twigs" : "twig_sprays";
    }
  }
}

}  // namespace

const std::vector<std::string>& season_names() {
  static const std::vector<std::string> names{"summer", "spring", "autumn", "winter"};
  return names;
}

std::vector<MaterialSpec> seasonal_library(Season season) {
  std::vector<MaterialSpec> library = material_library();
  if (season == Season::summer) return library;
  for (MaterialSpec& spec : library) {
    turn_leaves(spec, season);
    for (const GroundColors& ground : ground_colors)
      if (spec.name == ground.name)
        spec.color *= season == Season::spring   ? ground.spring
                      : season == Season::autumn ? ground.autumn
                                                 : ground.winter;
  }
  return library;
}

}  // namespace greatx::scene::generator
