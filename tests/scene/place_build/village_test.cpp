// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Builds the village of assets/examples/places/village from its files, and measures the glTF that comes out
// against the plan in make_village.py.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/geodesy.h"
#include "core/units.h"
#include "scene/check/check.h"
#include "scene/gltf/model.h"
#include "scene/place/assemble/build_place.h"
#include "scene/place/source/source.h"

namespace greatx::scene::place::test {
namespace {

using TriangleOf = std::array<dvec3, 3>;

/// What all tests look at, made once.
struct Village {
  PlaceConfig config;
  PlaceInput input;
  BuiltPlace built;
  Model model;
  std::map<std::string, std::vector<TriangleOf>> triangles;  ///< by name of the node, in the scene's frame

  Village() {
    config = load_place_config(GREATX_VILLAGE "/village.yaml");
    input = read_place(config);
    built = build_place(input, config);
    model = load_model("village.glb", built.glb, {});
    for (const ModelInstance& instance : model.instances)
      for (const ModelPrimitive& primitive : model.meshes[instance.mesh].primitives)
        for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
          TriangleOf triangle;
          for (size_t k = 0; k < 3; ++k)
            triangle[k] = dvec3(instance.model_from_mesh *
                                dvec4(dvec3(primitive.positions[primitive.indices[i + k]]), 1.0));
          triangles[instance.name].push_back(triangle);
        }
  }
};
const Village& village() {
  static const Village made;
  return made;
}

dvec3 cross_of(const TriangleOf& t) { return glm::cross(t[1] - t[0], t[2] - t[0]); }

/// The area from above of the faces that look up.
double area_from_above(const std::vector<TriangleOf>& triangles) {
  double sum = 0.0;
  for (const TriangleOf& t : triangles) sum += std::max(0.0, 0.5 * cross_of(t).z);
  return sum;
}

const Building& building(const std::string& use) {
  const auto found = std::ranges::find(village().built.buildings, use, &Building::use);
  if (found == village().built.buildings.end()) throw std::runtime_error("no building of the kind " + use);
  return *found;
}
std::string node_of(const Building& building) {
  std::string name = "building_" + building.id;
  std::ranges::replace(name, '/', '_');
  return name;
}
const std::vector<TriangleOf>& faces_of(const std::string& use) {
  return village().triangles.at(node_of(building(use)));
}
dvec2 heights(const std::vector<TriangleOf>& triangles) {
  dvec2 range(1e300, -1e300);
  for (const TriangleOf& t : triangles)
    for (const dvec3& p : t) range = {std::min(range.x, p.z), std::max(range.y, p.z)};
  return range;
}
size_t count(const std::string& topic) {
  return static_cast<size_t>(std::ranges::count(village().built.report.findings, topic, &Finding::topic));
}

TEST(PlaceVillage, AllOfThePlanIsThere) {
  const PlaceReport& report = village().built.report;
  std::map<std::string, size_t> uses;
  for (const Building& building : village().built.buildings) ++uses[building.use];
  EXPECT_EQ(uses["church"], 1u);
  EXPECT_EQ(uses["terrace"], 7u);
  EXPECT_EQ(uses["school"], 1u);
  EXPECT_EQ(uses["water_tower"], 1u);
  EXPECT_EQ(uses["house"] + uses["detached"] + uses["bungalow"], 54u);
  EXPECT_EQ(report.buildings, village().built.buildings.size());
  EXPECT_EQ(report.courts, 1u);
  EXPECT_EQ(building("church").parts.size(), 4u);
  EXPECT_EQ(building("water_tower").parts.size(), 2u);
  EXPECT_EQ(village().built.ground.bridges.size(), 1u);
  EXPECT_TRUE(village().triangles.contains("bridge_way_102"));
  // Tags of the map that make one object each.
  std::map<std::string, size_t> asked;
  for (const Feature& feature : village().input.features)
    if (feature.point)
      for (const char* key : {"amenity", "highway", "man_made"})
        if (const std::string* value = feature.tag(key)) ++asked[*value];
  EXPECT_EQ(asked["bench"], 5u);
  EXPECT_EQ(report.objects.at("bench"), asked["bench"]);
  EXPECT_EQ(report.objects.at("bin"), asked["waste_basket"]);
  EXPECT_EQ(report.objects.at("mast"), asked["mast"]);
  EXPECT_EQ(report.objects.at("street_lamp"), asked["street_lamp"]);
  EXPECT_EQ(village().model.lights.size(), asked["street_lamp"]);
  EXPECT_GT(asked["street_lamp"], 30u);
  for (const char* cover : {"road", "path", "water", "wood", "grass", "farmland", "meadow", "parking",
                            "square", "pitch", "scrub", "residential"})
    EXPECT_GT(report.cover_m2.at(cover), 50.0) << cover;
}

TEST(PlaceVillage, FootprintsAgreeWithThePlanWithinATenthOfAPercent) {
  // Sizes in make_village.py. Positions in the file are multiples of 1e-7 degrees, 1 cm.
  EXPECT_NEAR(area_from_above(faces_of("school")), 44.0 * 34.0 - 20.0 * 13.0, 0.001 * 1236.0);
  EXPECT_NEAR(area_from_above(faces_of("supermarket")), 36.0 * 24.0, 0.001 * 864.0);
  EXPECT_NEAR(area_from_above(faces_of("office")), 26.0 * 13.0, 0.001 * 338.0);
  double all = 0.0;
  for (const Building& building : village().built.buildings) {
    const double built = area_from_above(village().triangles.at(node_of(building)));
    all += built;
    if (building.parts.size() == 1) {
      EXPECT_NEAR(built, building.plan_area_m2, 0.001 * building.plan_area_m2) << building.id;
    }
  }
  const PlaceReport& report = village().built.report;
  EXPECT_NEAR(report.built_area_m2, report.source_area_m2, 0.001 * report.source_area_m2);
  // The shaft of the water tower lies below its tank, and adds nothing from above.
  EXPECT_NEAR(all, report.built_area_m2, 0.001 * all);
}

TEST(PlaceVillage, HeightsAreThoseOfTheTags) {
  const auto above_ground = [](const std::string& use) {
    return heights(faces_of(use)).y - building(use).ground_z;
  };
  EXPECT_NEAR(above_ground("church"), 31.0, 1e-3);
  EXPECT_NEAR(above_ground("school"), 6.0, 1e-3);  // 2 storeys of 3 m
  EXPECT_NEAR(above_ground("supermarket"), 6.5, 1e-3);
  EXPECT_NEAR(above_ground("office"), 15.0, 1e-3);
  EXPECT_NEAR(above_ground("barn"), 9.0, 1e-3);
  EXPECT_NEAR(above_ground("water_tower"), 24.0, 1e-3);
  // The canopy above the church's door and the roof of a carport have undersides.
  const auto lowest_underside = [](const std::string& use, double at_least) {
    double lowest = 1e300;
    for (const TriangleOf& t : faces_of(use))
      if (glm::normalize(cross_of(t)).z < -0.99)
        if (const double z = t[0].z - building(use).ground_z; z > at_least) lowest = std::min(lowest, z);
    return lowest;
  };
  EXPECT_NEAR(lowest_underside("church", 1.0), 3.2, 1e-3);
  EXPECT_NEAR(lowest_underside("water_tower", 1.0), 15.0, 1e-3);
  EXPECT_NEAR(lowest_underside("carport", 1.0), 2.3, 1e-3);
}

TEST(PlaceVillage, VolumesAreThoseOfPrismsAndRoofs) {
  const PlaceReport& report = village().built.report;
  EXPECT_NEAR(report.built_volume_m3, report.source_volume_m3, 0.001 * report.source_volume_m3);
  for (const Building& building : village().built.buildings) {
    double own = 0.0;
    for (const TriangleOf& t : village().triangles.at(node_of(building)))
      own += 0.5 * cross_of(t).z * std::max(0.0, (t[0].z + t[1].z + t[2].z) / 3.0 - building.ground_z);
    EXPECT_NEAR(own, building.plan_volume_m3, 0.001 * building.plan_volume_m3)
        << building.use << " " << building.id;
  }
  // A closed form: prism and gable of the barn, by the divergence theorem above its lowest ground.
  double volume = 0.0;
  for (const TriangleOf& t : faces_of("barn")) {
    const double z = (t[0].z + t[1].z + t[2].z) / 3.0 - building("barn").ground_z;
    if (z > 0.0) volume += 0.5 * cross_of(t).z * z;
  }
  EXPECT_NEAR(volume, 12.0 * 24.0 * (4.5 + 4.5 / 2.0), 0.001 * 12.0 * 24.0 * 6.75);
}

TEST(PlaceVillage, TheGroundIsWithinItsBoundAtEverySample) {
  // Triangles of the ground in cells of 8 m.
  constexpr double cell_m = 8.0;
  std::map<std::pair<int, int>, std::vector<TriangleOf>> cells;
  const auto cell = [](double v) { return static_cast<int>(std::floor(v / cell_m)); };
  for (const auto& [name, triangles] : village().triangles) {
    if (!name.starts_with("ground_")) continue;
    for (const TriangleOf& t : triangles) {
      Box box;
      for (const dvec3& p : t) box.add(dvec2(p));
      for (int y = cell(box.low.y); y <= cell(box.high.y); ++y)
        for (int x = cell(box.low.x); x <= cell(box.high.x); ++x) cells[{x, y}].push_back(t);
    }
  }
  const Box rectangle = village().built.report.rectangle.grown(-0.01);
  size_t samples = 0;
  for (const HeightGrid& grid : village().input.terrain.grids())
    for (const dvec3& sample : grid.samples) {
      if (!rectangle.holds(dvec2(sample))) continue;
      ++samples;
      double off = 1e300;
      for (const TriangleOf& t : cells[{cell(sample.x), cell(sample.y)}]) {
        const dvec3 n = cross_of(t);
        bool inside = true;
        for (size_t i = 0; i < 3; ++i) {
          const dvec2 edge(t[(i + 1) % 3] - t[i]), to(sample - t[i]);
          inside = inside && edge.x * to.y - edge.y * to.x > -1e-6;
        }
        if (inside) off = std::abs(t[0].z - glm::dot(dvec2(n), dvec2(sample - t[0])) / n.z - sample.z);
        if (inside) break;
      }
      ASSERT_LE(off, village().config.ground.error_m + 1e-3) << sample.x << " " << sample.y;
    }
  EXPECT_GT(samples, 25'000u);
  EXPECT_LE(village().built.report.terrain_error_m, village().config.ground.error_m);
  EXPECT_EQ(village().built.report.ground_filled, 0u);
}

TEST(PlaceVillage, TheSceneHasNoFaults) {
  LoadOptions options;
  options.keep_faults = true;
  const SceneFaults faults = check_scene(load_model("village.glb", village().built.glb, options));
  for (const SceneFault& fault : faults.faults)
    EXPECT_NE(fault.severity, FaultSeverity::fault) << fault.kind << ": " << fault.count;
  EXPECT_GT(faults.figures.rays, 10'000u);
  EXPECT_EQ(faults.figures.rays_out, 0u);
  EXPECT_EQ(faults.find("t_junction"), nullptr);
}

TEST(PlaceVillage, PartyWallsAreThereOnce) {
  // Six walls between seven houses. Each is a face of one of the two houses.
  size_t party = 0;
  for (const Building& building : village().built.buildings) {
    if (building.use != "terrace") continue;
    for (const ModelInstance& instance : village().model.instances)
      if (instance.name == node_of(building))
        for (const ModelPrimitive& primitive : village().model.meshes[instance.mesh].primitives)
          if (village().model.materials[primitive.material].name == "blind_brick")
            party += primitive.indices.size() / 3;
  }
  EXPECT_GE(party, 6u * 2u);
  LoadOptions options;
  options.keep_faults = true;
  const SceneFaults faults = check_scene(load_model("village.glb", village().built.glb, options));
  EXPECT_EQ(faults.find("coincident"), nullptr);
  if (const SceneFault* touching = faults.find("back_to_back")) {
    for (const FaultPlace& place : touching->places)
      EXPECT_FALSE(place.object.starts_with("building_") && place.other.starts_with("building_"))
          << place.object << " " << place.other;
  }
}

TEST(PlaceVillage, TheGltfKnowsWhereItIs) {
  ASSERT_TRUE(village().model.georeference.has_value());
  const Georeference& reference = *village().model.georeference;
  EXPECT_EQ(reference, village().input.reference);
  EXPECT_NEAR(reference.origin.latitude_deg, -42.7312, 1.1e-5);
  EXPECT_NEAR(reference.origin.longitude_deg, 146.9475, 1.1e-5);
  EXPECT_EQ(reference.undulation_m, -3.6);
  EXPECT_EQ(reference.vertical_datum, "AHD");
  // 183.7 m above the datum by the formula of make_village.py.
  EXPECT_NEAR(reference.origin.height_m - reference.undulation_m, 183.7, 0.051);
  // The apex of the church's tower: its middle is 7 m west and 46 m north of the plan's origin.
  const LocalFrame frame(reference);
  const dvec3 tower = frame.local_of_datum({-42.7312 + 46.0 / 111087.5, 146.9475 - 7.0 / 81895.5, 0.0});
  dvec3 apex(0.0, 0.0, -1e300);
  for (const TriangleOf& t : faces_of("church"))
    for (const dvec3& p : t)
      if (p.z > apex.z) apex = p;
  EXPECT_NEAR(apex.x, tower.x, 0.015);
  EXPECT_NEAR(apex.y, tower.y, 0.015);
}

TEST(PlaceVillage, TheBridgeSpansTheWater) {
  const std::vector<TriangleOf>& deck = village().triangles.at("bridge_way_102");
  const dvec2 z = heights(deck);
  double lowest_water = 1e300;
  for (const TriangleOf& t : village().triangles.at("ground_water"))
    for (const dvec3& p : t)
      if (std::abs(p.x - 90.0) < 8.0) lowest_water = std::min(lowest_water, p.z);
  // One layer has 5 m of clearance between the road and the lowest ground below it.
  EXPECT_GE(z.y, lowest_water + 5.0);
  EXPECT_EQ(count("bridge_raised"), 0u);  // the river lies deep enough
}

TEST(PlaceVillage, AssumptionsAreListed) {
  // Kinds 3 and 7 of make_village.py have no roof, kind 3 has no height either.
  EXPECT_GE(count("height_assumed"), 5u);
  EXPECT_GE(count("roof_assumed"), count("height_assumed"));
  EXPECT_EQ(village().built.report.heights.at("assumed"), count("height_assumed"));
  EXPECT_EQ(count("tree_in_building"), 0u);
  EXPECT_EQ(count("buildings_overlap"), 0u);
  EXPECT_EQ(count("value_not_understood"), 0u);
}

TEST(PlaceVillage, TwoBuildsAreEqualToTheByte) {
  const PlaceConfig config = load_place_config(GREATX_VILLAGE "/village.yaml");
  const BuiltPlace again = build_place(read_place(config), config);
  EXPECT_TRUE(std::ranges::equal(again.glb, village().built.glb));
}

}  // namespace
}  // namespace greatx::scene::place::test
