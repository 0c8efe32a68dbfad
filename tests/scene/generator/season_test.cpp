// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the seasons: what stands stays where it stands, crowns are bare in winter, and leaves lie on the
// ground in autumn.
#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "scene/generator/mesh/seasons.h"
#include "scene/generator/objects/trees.h"
#include "scene/generator/paint/textures.h"
#include "scene/material/lossless.h"
#include "tests/scene/generator/soup.h"

namespace greatx::scene {
namespace {

using generator::Season;

Soup load_season(const std::string& kind, const std::string& season) {
  return load_soup({.kind = kind, .seed = 7, .size_m = 200, .variant = season});
}

std::string texture_of(const Soup& soup, const std::string& material) {
  for (const Material& m : soup.model.materials)
    if (m.name == material) return soup.model.textures[static_cast<size_t>(m.pbr.base_color_texture)].name;
  return "no such material";
}

/// Returns the volume within the triangles of a mesh that are of this material.
double volume_of(const generator::MeshBuilder& mesh, const std::string& material) {
  double volume = 0.0;
  for (const generator::PrimitiveData& part : mesh.primitives()) {
    if (part.material != generator::material(material)) continue;
    for (size_t i = 0; i < part.indices.size(); i += 3) {
      const dvec3 a(part.positions[part.indices[i]]), b(part.positions[part.indices[i + 1]]),
          c(part.positions[part.indices[i + 2]]);
      volume += glm::dot(a, glm::cross(b, c)) / 6.0;
    }
  }
  return volume;
}

size_t triangles_of(const generator::MeshBuilder& mesh) {
  size_t count = 0;
  for (const generator::PrimitiveData& part : mesh.primitives()) count += part.indices.size() / 3;
  return count;
}

TEST(Seasons, EverythingButLeavesStandsAsInSummer) {
  for (const char* kind : {"city", "country"}) {
    const Soup summer = load_season(kind, "summer");
    for (const char* season : {"spring", "autumn", "winter"}) {
      const Soup other = load_season(kind, season);
      std::map<std::string, dmat4> places;
      for (const ModelInstance& i : other.model.instances) places[i.name] = i.model_from_mesh;
      size_t leaves = 0;
      for (const ModelInstance& i : other.model.instances) leaves += i.name.starts_with("leaves_");
      EXPECT_EQ(other.model.instances.size(), summer.model.instances.size() + leaves) << kind << season;
      EXPECT_EQ(leaves > 10, season == std::string("autumn")) << kind << ' ' << season << ": " << leaves;
      for (const ModelInstance& i : summer.model.instances) {
        ASSERT_TRUE(places.contains(i.name)) << i.name;
        EXPECT_EQ(places.at(i.name), i.model_from_mesh) << i.name;
      }
    }
  }
}

TEST(Seasons, ABareCrownTakesAFifthLess) {
  for (int kind = 0; kind < generator::tree_species; ++kind)
    for (const int shape : {0, 1})
      for (const double clear : {0.0, 5.3}) {
        const auto leafy = generator::make_tree(kind, shape, clear);
        const auto bare = generator::make_tree(kind, shape, clear, Season::winter);
        double in_leaf = 0.0, leafless = 0.0;
        for (const char* leaves : {"leaves_green", "leaves_light", "leaves_olive", "leaves_dark",
                                   "leaves_copper", "leaves_birch"}) {
          in_leaf += volume_of(leafy, leaves);
          leafless += volume_of(bare, leaves);
        }
        ASSERT_GT(in_leaf, 5.0);
        // Each chord through the middle is 1/1.2 as long. Corners are whole millimetres.
        EXPECT_NEAR(std::cbrt(leafless / in_leaf), 1.0 / 1.2, 5e-4) << kind;
        EXPECT_EQ(volume_of(leafy, "boughs"), 0.0);
        EXPECT_GT(volume_of(bare, "boughs"), 0.01) << kind;
        // Ten boughs of three sides, each with a foot.
        EXPECT_EQ(triangles_of(bare), triangles_of(leafy) + 40) << kind;
      }
}

TEST(Seasons, RadioMeetsTheSameMaterialsInAllSeasons) {
  const std::vector<generator::MaterialSpec> summer = generator::seasonal_library(Season::summer);
  ASSERT_EQ(summer.size(), generator::material_library().size());
  for (const Season season : {Season::spring, Season::autumn, Season::winter}) {
    const std::vector<generator::MaterialSpec> other = generator::seasonal_library(season);
    ASSERT_EQ(other.size(), summer.size());
    std::set<std::string> changed;
    for (size_t i = 0; i < summer.size(); ++i) {
      EXPECT_EQ(other[i].name, summer[i].name);
      EXPECT_EQ(other[i].radio, summer[i].radio) << summer[i].name;
      for (int k = 0; k < 3; ++k) EXPECT_LE(other[i].color[k], 1.0f) << summer[i].name;
      if (other[i].color != summer[i].color || other[i].texture != summer[i].texture)
        changed.insert(summer[i].name);
    }
    // Every broad-leaved species changes, and no conifer, hedge or bark does.
    for (const char* name : {"green", "light", "olive", "dark", "copper", "birch"})
      EXPECT_TRUE(changed.contains(std::string("leaves_") + name) &&
                  changed.contains(std::string("sprays_") + name))
          << name;
    for (const char* name : {"needles", "sprays_needles", "needles_pine", "hedge", "sprays_hedge", "bark"})
      EXPECT_FALSE(changed.contains(name)) << name;
  }
}

TEST(Seasons, CrownsAreBareInWinterAndConifersGreen) {
  const Soup soup = load_season("country", "winter");
  EXPECT_EQ(texture_of(soup, "leaves_olive"), "twigs");
  EXPECT_EQ(texture_of(soup, "sprays_olive"), "twig_sprays");
  EXPECT_EQ(texture_of(soup, "needles"), "leaves");
  EXPECT_EQ(texture_of(load_season("country", "autumn"), "leaves_olive"), "leaves_pale");
  // One sees through a bare crown: between a twelfth and a third of the pictures is wood.
  for (const char* name : {"twigs", "twig_sprays"}) {
    const std::vector<uint8_t> alpha = generator::make_texture(name).alpha;
    const double wood =
        static_cast<double>(std::ranges::count(alpha, 255)) / static_cast<double>(alpha.size());
    EXPECT_GT(wood, 1.0 / 12.0) << name;
    EXPECT_LT(wood, 1.0 / 3.0) << name;
  }
}

TEST(Seasons, FallenLeavesLieOnTheGroundAndAreUnseenByRadio) {
  const Soup soup = load_season("city", "autumn");
  size_t faces = 0;
  for (const SoupTriangle& t : soup.triangles) {
    if (!soup.model.instances[t.instance].name.starts_with("leaves_")) continue;
    ++faces;
    EXPECT_TRUE(is_lossless(soup.model.materials[t.material])) << soup.model.materials[t.material].name;
    for (const dvec3& corner : t.corners) {
      EXPECT_GE(corner.z, 0.009);
      EXPECT_LE(corner.z, 0.185);
    }
  }
  EXPECT_GT(faces, 40u);
}

}  // namespace
}  // namespace greatx::scene
