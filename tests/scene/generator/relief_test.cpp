// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks normal maps: they match the heights from which they are made, and they have the right orientation
// where they are used.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "scene/build/build.h"
#include "scene/generator/paint/texture_painter.h"
#include "tests/scene/generator/soup.h"

namespace greatx::scene {
namespace {

/// Returns the normal of a texel as glTF reads it, unit up to rounding.
dvec3 normal_of(const generator::Raster& raster, uint32_t x, uint32_t y) {
  const uint8_t* const rgb = raster.rgb.data() + 3 * (y * raster.width + x);
  return dvec3(rgb[0], rgb[1], rgb[2]) / 127.5 - 1.0;
}

TEST(Relief, ARampLeansAgainstItsRise) {
  // The ramp rises by one pixel in four along the columns and by half of that along the rows: z = x / 4 + y /
  // 8, with y down the picture.
  generator::TexturePainter painter(64, 64, {});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) painter.raise(x, y, x + 1, y + 1, 4 * x + 2 * y);
  const generator::Raster raster = painter.maps().normal;
  ASSERT_EQ(raster.rgb.size(), 3u * 64 * 64);
  // The normal is perpendicular to (1, 0, 1/4) and, since +y is up the picture, to (0, -1, 1/8).
  const dvec3 expected = glm::normalize(dvec3(-0.25, 0.125, 1.0));
  for (uint32_t y = 1; y < 63; ++y)  // heights wrap around at the rim
    for (uint32_t x = 1; x < 63; ++x) {
      const dvec3 n = normal_of(raster, x, y);
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(n[k], expected[k], 0.51 / 127.5) << x << " " << y;
    }
}

TEST(Relief, FurrowsAreWhatTheColourShows) {
  // Compares the mean slope of each of the eight pixels of a row with its colour: low pixels are dark.
  const generator::TextureMaps maps = generator::make_texture("crop");
  std::array<double, 8> slope{}, color{}, count{};
  for (uint32_t y = 0; y < 512; ++y) {
    if (y % 256 >= 38 && y % 256 < 64) continue;  // wheel tracks
    for (uint32_t x = 0; x < 512; ++x) {
      const dvec3 n = normal_of(maps.normal, x, y);
      slope[y % 8] += n.y / n.z;
      color[y % 8] += maps.color.rgb[3 * (y * 512 + x)];
      ++count[y % 8];
    }
  }
  for (size_t i = 0; i < 8; ++i) slope[i] /= count[i], color[i] /= count[i];
  // Heights change by 5/16 per pixel. The clods average out.
  for (const size_t crest_or_bottom : {0, 4}) EXPECT_NEAR(slope[crest_or_bottom], 0.0, 0.015);
  for (const size_t falling : {1, 2, 3}) EXPECT_NEAR(slope[falling], -5.0 / 16.0, 0.015) << falling;
  for (const size_t rising : {5, 6, 7}) EXPECT_NEAR(slope[rising], 5.0 / 16.0, 0.015) << rising;
  EXPECT_NEAR(color[0] - color[4], 20.0, 3.0);
}

TEST(Relief, TheCountryHasItAndTheCityDoesNot) {
  for (const Material& m : load_soup({.kind = "city", .seed = 1, .size_m = 300}).model.materials)
    EXPECT_LT(m.pbr.normal_texture, 0) << m.name << ": a third texture costs every pixel of the city";
  std::set<std::string> names;
  for (const Material& m : load_soup({.kind = "country", .seed = 11, .size_m = 400}).model.materials)
    if (m.pbr.normal_texture >= 0) names.insert(m.name);
  EXPECT_EQ(names, (std::set<std::string>{"farm_tiles", "ploughed_soil"}));
}

TEST(Relief, TangentsFollowTheGroundAndTheRoofs) {
  const Soup soup = load_soup({.kind = "country", .seed = 11, .size_m = 400});
  const Scene scene = build_scene({{.name = "", .model = &soup.model, .pose = {}}}, {.name = "country"});
  size_t tiles = 0, soil = 0;
  for (const Primitive& primitive : scene.primitives) {
    const std::string& name = scene.materials[primitive.material].name;
    const bool roof = name == "farm_tiles";
    if (!roof && name != "ploughed_soil") continue;
    for (uint32_t i = primitive.first_index; i < primitive.first_index + primitive.index_count; ++i) {
      const uint32_t vertex = scene.indices[i];
      const vec3 normal = scene.normals[vertex], tangent = vec3(scene.tangents[vertex]);
      ASSERT_NEAR(glm::length(tangent), 1.0f, 1e-5f);
      ASSERT_NEAR(glm::dot(normal, tangent), 0.0f, 1e-5f);
      ASSERT_EQ(scene.tangents[vertex].w, 1.0f) << name << ": no picture is seen from behind";
      const vec3 up_the_picture = glm::cross(normal, tangent);
      // Pitches: the top of the picture is towards the ridge.
      if (roof && normal.z > 0.3f && normal.z < 0.9f) {
        ASSERT_NEAR(up_the_picture.z, std::sqrt(1.0f - normal.z * normal.z), 1e-3f);
        ++tiles;
      }
      if (!roof) ++soil;
    }
  }
  EXPECT_GE(tiles, 24u);
  EXPECT_GE(soil, 100u);
}

}  // namespace
}  // namespace greatx::scene
