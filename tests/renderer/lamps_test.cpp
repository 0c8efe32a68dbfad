// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/lamps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "shaders/shared/camera.h"

namespace greatx::test {
namespace {

render::CameraView view_of(uint32_t width = 640, uint32_t height = 480) {
  const render::PinholeView pinhole{width, height, 320.0, 320.0, 0.5 * width, 0.5 * height};
  return {pinhole,
          0.1,
          {{3, -2, 20}, orientation_from_yaw_pitch_roll(0.4, 0.3, 0.1)},
          render::SunFrame::of({0, 0, 1}),
          1.0};
}

float as_float(uint32_t word) { return std::bit_cast<float>(word); }

/// Returns the lamps (first quadruples of their records) that a pixel at p looks up, as
/// shaders/camera/lamps.glsl does.
std::set<uint32_t> lamps_at(const std::vector<uint32_t>& words, const render::CameraView& view,
                            const dvec3& p) {
  const vec3 q(p);
  const float depth = std::max(glm::dot(view.constants.forward, q), 1e-3f);
  const float x = glm::dot(view.constants.clip_x, q) / depth * 0.5f + 0.5f;
  const float y = glm::dot(view.constants.clip_y, q) / depth * 0.5f + 0.5f;
  const auto clamped = [](float v, float last) { return static_cast<uint32_t>(std::clamp(v, 0.0f, last)); };
  const uint32_t column = clamped(x * as_float(words[shared::lamps_across_word]),
                                  as_float(words[shared::lamps_last_column_word]));
  const uint32_t row =
      clamped(y * as_float(words[shared::lamps_down_word]), as_float(words[shared::lamps_last_row_word]));
  const uint32_t slice = clamped(shared::lamp_slices_per_octave * std::log2(depth) + shared::lamp_slice_of_1m,
                                 float(shared::lamp_slices - 1));
  const uint32_t cluster =
      shared::lamps_header_words +
      2 * ((slice * words[shared::lamps_rows_word] + row) * words[shared::lamps_columns_word] + column);
  std::set<uint32_t> lamps;
  for (uint32_t i = 0; i < words[cluster + 1]; ++i) lamps.insert(words[words[cluster] + i]);
  return lamps;
}

std::vector<scene::PunctualLight> random_lamps(size_t count) {
  RandomStream random(7, 1, 0);
  std::vector<scene::PunctualLight> lamps;
  for (size_t i = 0; i < count; ++i) {
    scene::PunctualLight lamp;
    lamp.type = i % 3 == 0 ? scene::PunctualLight::Type::point : scene::PunctualLight::Type::spot;
    lamp.position = {200.0 * random.uniform() - 60.0, 160.0 * random.uniform() - 80.0,
                     30.0 * random.uniform()};
    lamp.direction =
        glm::normalize(dvec3(random.uniform() - 0.5, random.uniform() - 0.5, -0.2 - random.uniform()));
    lamp.range_m = float(2.0 + 30.0 * random.uniform());
    lamp.inner_cone = 0.1f;
    lamp.outer_cone = float(0.2 + 1.3 * random.uniform());
    lamp.intensity = 500.0f;
    lamps.push_back(lamp);
  }
  return lamps;
}

TEST(Lamps, NoPointMissesALampThatReachesIt) {
  const render::CameraView view = view_of();
  const std::vector<scene::PunctualLight> lamps = random_lamps(300);
  const std::vector<Pose> bodies(1);
  render::LampCounts counts;
  const std::vector<uint32_t> words = render::cluster_lamps(view, lamps, bodies, counts);
  RandomStream random(7, 2, 0);
  size_t reached = 0;
  for (int k = 0; k < 20000; ++k) {
    // The points lie in the picture; their distances are distributed logarithmically.
    const double depth = std::exp2(9.0 * random.uniform() - 1.0);
    const dvec3 p = depth * (view.forward + view.right * (2.0 * random.uniform() - 1.0) +
                             view.down * (1.5 * random.uniform() - 0.75));
    const std::set<uint32_t> found = lamps_at(words, view, p);
    for (const scene::PunctualLight& lamp : lamps) {
      const dvec3 to = p - (lamp.position - view.eye);
      if (glm::length(to) >= lamp.range_m) continue;
      const bool in_cone = lamp.type != scene::PunctualLight::Type::spot ||
                           glm::dot(glm::normalize(to), lamp.direction) > std::cos(double(lamp.outer_cone));
      if (!in_cone) continue;
      ++reached;
      const bool there = std::any_of(found.begin(), found.end(), [&](uint32_t quad) {
        const size_t word = size_t{4} * quad;
        const vec3 position(as_float(words[word]), as_float(words[word + 1]), as_float(words[word + 2]));
        return position == vec3(lamp.position - view.eye);
      });
      ASSERT_TRUE(there) << "depth " << depth;
    }
  }
  EXPECT_GT(reached, 1000u);  // the test is not empty
}

TEST(Lamps, CostFollowsWhatIsSeenNotWhatIsPlaced) {
  const render::CameraView view = view_of();
  const std::vector<Pose> bodies(1);
  render::LampCounts few, many;
  std::vector<scene::PunctualLight> lamps = random_lamps(50);
  render::cluster_lamps(view, lamps, bodies, few);
  for (size_t i = 0; i < 1000; ++i) {  // all behind the camera
    scene::PunctualLight lamp;
    lamp.position = view.eye - view.forward * (100.0 + double(i));
    lamp.range_m = 40.0f;
    lamps.push_back(lamp);
  }
  render::cluster_lamps(view, lamps, bodies, many);
  EXPECT_GT(few.seen, 10u);
  EXPECT_EQ(many.seen, few.seen);
  EXPECT_EQ(many.entries, few.entries);
}

TEST(Lamps, DirectionalOnesAreEverywhereAndUnlimitedOnesEndWhereTheyLightNothing) {
  const render::CameraView view = view_of(64, 64);
  const std::vector<Pose> bodies(1);
  scene::PunctualLight sun;
  sun.type = scene::PunctualLight::Type::directional;
  render::LampCounts counts;
  const std::vector<uint32_t> words = render::cluster_lamps(view, {&sun, 1}, bodies, counts);
  EXPECT_EQ(counts.entries, 2u * 2u * shared::lamp_slices);
  EXPECT_EQ(lamps_at(words, view, view.forward * 5000.0).size(), 1u);
  scene::PunctualLight bulb;
  bulb.intensity = 100.0f;
  EXPECT_NEAR(bulb.intensity / std::pow(render::lamp_reach(bulb), 2.0), render::lamp_least_lux, 1e-9);
}

TEST(Lamps, HardCaseN64NoLamp) {
  render::LampCounts counts;
  const render::CameraView view = view_of();
  const std::vector<uint32_t> words = render::cluster_lamps(view, {}, std::vector<Pose>(1), counts);
  EXPECT_EQ(counts.seen, 0u);
  EXPECT_TRUE(lamps_at(words, view, view.forward * 10.0).empty());
}

}  // namespace
}  // namespace greatx::test
