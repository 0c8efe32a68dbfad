// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks every generated mesh: it is finite, closed and wound outwards, and none of its faces lie in each
// other.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "scene/material/lossless.h"
#include "tests/scene/generator/soup.h"

namespace greatx::scene {
namespace {

std::vector<GenerateOptions> everything() {
  std::vector<GenerateOptions> list = {{.kind = "city", .seed = 1, .size_m = 300},
                                       {.kind = "city", .seed = 11, .size_m = 100},
                                       {.kind = "city", .seed = 5, .size_m = 480},
                                       {.kind = "country", .seed = 1, .size_m = 300},
                                       {.kind = "country", .seed = 9, .size_m = 160},
                                       {.kind = "country", .seed = 4, .size_m = 700},
                                       {.kind = "canyon", .seed = 1, .size_m = 300},
                                       {.kind = "canyon", .seed = 6, .size_m = 60},
                                       {.kind = "room"},
                                       {.kind = "mast"},
                                       {.kind = "car", .variant = "hatchback"},
                                       {.kind = "car", .variant = "van"},
                                       {.kind = "quadrotor", .variant = "small"},
                                       {.kind = "quadrotor", .variant = "medium"},
                                       {.kind = "quadrotor", .variant = "large"}};
  for (const char* kind : {"city", "country"})
    for (const char* season : {"spring", "autumn", "winter"})
      list.push_back({.kind = kind, .seed = 3, .size_m = 200, .variant = season});
  for (const char* kind : {"vehicle", "person"})
    for (const std::string& variant : generator_variants(kind))
      list.push_back({.kind = kind, .seed = 3, .variant = variant});
  return list;
}

class EveryKind : public ::testing::TestWithParam<GenerateOptions> {
 protected:
  EveryKind() : soup_(load_soup(GetParam())) {}
  Soup soup_;
};

TEST_P(EveryKind, TrianglesAreSound) {
  ASSERT_FALSE(soup_.triangles.empty());
  for (const SoupTriangle& t : soup_.triangles) {
    const std::string where = soup_.model.instances[t.instance].name;
    const dvec3 cross = glm::cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
    ASSERT_TRUE(std::isfinite(cross.x + cross.y + cross.z)) << where;
    ASSERT_GT(glm::length(cross), 1e-7) << where;
    for (const dvec3& n : t.normals) ASSERT_GT(glm::dot(n, t.normal()), 0.0) << where;
  }
}

TEST_P(EveryKind, NodesAreNamedAndClassified) {
  std::set<std::string> names;
  for (const ModelInstance& instance : soup_.model.instances) {
    EXPECT_NE(instance.semantic_class, SemanticClass::unlabeled) << instance.name;
    EXPECT_TRUE(names.insert(instance.name).second) << instance.name << " twice";
  }
  for (const std::string& note : soup_.model.notes) ADD_FAILURE() << note;
}

TEST_P(EveryKind, SolidsAreClosedAndLookOutwards) {
  std::vector<SoupTriangle> ground;
  for (uint32_t i = 0; i < soup_.model.instances.size(); ++i) {
    const ModelInstance& instance = soup_.model.instances[i];
    std::vector<SoupTriangle> triangles = soup_.of_instance(i);
    std::erase_if(triangles,
                  [&](const SoupTriangle& t) { return is_lossless(soup_.model.materials[t.material]); });
    switch (instance.semantic_class) {
      case SemanticClass::water:
        continue;  // a sheet between its banks
      case SemanticClass::ground:
      case SemanticClass::road:
      case SemanticClass::lane_marking:
      case SemanticClass::pavement:
        // These classes form one solid together (park paths are solids of their own).
        ground.insert(ground.end(), triangles.begin(), triangles.end());
        continue;
      default:
        EXPECT_EQ(open_edges(triangles), 0u) << instance.name;
        // A room is seen from inside.
        for (const double volume : part_volumes(triangles))
          EXPECT_GT(GetParam().kind == "room" ? -volume : volume, 0.0) << instance.name;
    }
  }
  EXPECT_EQ(open_edges(ground, true), 0u);
}

TEST_P(EveryKind, FoliageEnclosesVolumesOfItsOwn) {
  // Radio needs the interior of the crown alone, without the trunk inside it.
  size_t volumes = 0;
  for (uint32_t i = 0; i < soup_.model.instances.size(); ++i) {
    std::vector<SoupTriangle> foliage;
    for (const SoupTriangle& t : soup_.of_instance(i))
      if (soup_.model.materials[t.material].radio->foliage && !is_lossless(soup_.model.materials[t.material]))
        foliage.push_back(t);
    if (foliage.empty()) continue;
    const bool planter = soup_.model.instances[i].name.starts_with("planter");
    EXPECT_EQ(soup_.model.instances[i].semantic_class,
              planter ? SemanticClass::furniture : SemanticClass::vegetation);
    EXPECT_EQ(open_edges(foliage), 0u) << soup_.model.instances[i].name;
    ++volumes;
  }
  const bool grows = GetParam().kind == "city" || GetParam().kind == "country";
  EXPECT_EQ(volumes > 0, grows);
}

TEST_P(EveryKind, NoFaceLiesInAnother) {
  std::string first;
  EXPECT_LT(coplanar_overlap(soup_, &first), 1e-4) << first;
}

TEST_P(EveryKind, FlatFacesAreFlatToAMicrometre) {
  // Two triangles of one material that share an edge either lie in one plane, so that they merge into one
  // facet, or are clearly bent. Ground, plants, hedges, people, and the bodies of vehicles have free shapes
  // (RoadUsers tests the flat sides of vans, buses and lorries).
  using Corner = std::array<int64_t, 3>;
  const auto key = [](const dvec3& p) {
    return Corner{std::llround(p.x * 1e3), std::llround(p.y * 1e3), std::llround(p.z * 1e3)};
  };
  std::map<std::tuple<uint32_t, uint32_t, Corner, Corner>, std::vector<const SoupTriangle*>> edges;
  for (const SoupTriangle& t : soup_.triangles) {
    const SemanticClass c = soup_.model.instances[t.instance].semantic_class;
    if (soup_.model.materials[t.material].radio->foliage || c == SemanticClass::vegetation ||
        c == SemanticClass::person || c == SemanticClass::vehicle ||
        (GetParam().kind == "country" && c != SemanticClass::building))
      continue;
    for (size_t k = 0; k < 3; ++k) {
      const Corner a = key(t.local[k]), b = key(t.local[(k + 1) % 3]);
      edges[{t.instance, t.material, std::min(a, b), std::max(a, b)}].push_back(&t);
    }
  }
  for (const auto& [edge, triangles] : edges) {
    if (triangles.size() != 2) continue;
    const dvec3 n = triangles[0]->normal();
    if (glm::dot(n, triangles[1]->normal()) < 0.9998) continue;  // bent by more than a degree
    for (const dvec3& p : triangles[1]->corners)
      ASSERT_LT(std::abs(glm::dot(n, p - triangles[0]->corners[0])), 5e-5)
          << soup_.model.instances[triangles[0]->instance].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Generator, EveryKind, ::testing::ValuesIn(everything()), [](const auto& instance) {
  const GenerateOptions& o = instance.param;
  return o.kind + "_" + (o.variant.empty() ? std::to_string(static_cast<int>(o.size_m)) : o.variant) +
         "Seed" + std::to_string(o.seed);
});

}  // namespace
}  // namespace greatx::scene
