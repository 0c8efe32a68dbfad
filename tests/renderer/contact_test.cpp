// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds contact occlusion against the share of the hemisphere that a box hides.
#include "renderer/light/contact.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"
#include "shaders/shared/contact.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

/// Returns the share of the hemisphere over n, weighted by the cosine, whose rays from p meet a box, by a
/// product rule.
double counted_share(const dvec3& p, const dvec3& n, const dvec3& half_size) {
  const dvec3 up = std::abs(n.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
  const dvec3 x = glm::normalize(glm::cross(up, n)), y = glm::cross(n, x);
  constexpr int rings = 160, sectors = 320;
  int met = 0;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sectors; ++k) {
      const double level = std::sqrt((i + 0.5) / rings), phi = 2.0 * pi * (k + 0.5) / sectors;
      const dvec3 d =
          x * (level * std::cos(phi)) + y * (level * std::sin(phi)) + n * std::sqrt(1.0 - (i + 0.5) / rings);
      double enter = 0.0, leave = 1e300;
      for (int axis = 0; axis < 3; ++axis) {
        const double a = (-half_size[axis] - p[axis]) / d[axis], b = (half_size[axis] - p[axis]) / d[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
      }
      met += enter < leave;
    }
  return double(met) / (rings * sectors);
}

TEST(Contact, ShareOfABoxOverAPlaneIsItsFormFactor) {
  const dvec3 half_size(2.2, 0.9, 0.7);
  // The plane lies below the box, at its lowest face or lower.
  for (const dvec3& p : {dvec3(0, 1.2, -0.7), dvec3(0, 0.91, -0.7), dvec3(3, 2, -0.7), dvec3(0.3, 0.2, -0.9),
                         dvec3(-2.5, -1.0, -1.2), dvec3(0, 4, -0.7)}) {
    const double expected = counted_share(p, {0, 0, 1}, half_size);
    EXPECT_NEAR(shared::box_share(vec3(p), vec3(0, 0, 1), vec3(half_size)), expected, 0.005)
        << p.x << " " << p.y << " " << p.z;
  }
}

TEST(Contact, ShareSeenFromAWallIsCutAtItsHorizon) {
  // A box that reaches behind the wall's plane: its corners there are raised, which is not exact.
  const dvec3 half_size(1.0, 0.5, 0.8), n(0, 1, 0);
  for (const dvec3& p : {dvec3(0, -1.5, 0.2), dvec3(1.5, -0.2, 0.0), dvec3(2.0, 0.1, 0.4)}) {
    const double expected = counted_share(p, n, half_size);
    EXPECT_NEAR(shared::box_share(vec3(p), vec3(n), vec3(half_size)), expected, 0.04) << p.x << " " << p.y;
  }
}

TEST(Contact, WhatTurnsAwayAndWhatIsFarSeesNothing) {
  const vec3 half_size(1.0f, 1.0f, 1.0f);
  EXPECT_NEAR(shared::box_share({0, -3, 0}, {0, -1, 0}, half_size), 0.0f, 1e-4f);
  EXPECT_NEAR(shared::box_share({0, 0, 1.5}, {0, 0, 1}, half_size), 0.0f, 1e-4f);
  EXPECT_EQ(shared::contact_window({0, 6.1f, 0}, half_size, 5.0f), 0.0f);
  EXPECT_EQ(shared::contact_window({0, 2.0f, 0}, half_size, 5.0f), 1.0f);
}

/// A board of 2 m x 1 m that stands across x, and a rotor over it, as a body with a part.
TinyScene board_with_rotor() {
  TinyScene tiny;
  tiny.quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0});
  const uint32_t body = tiny.body("board");
  tiny.object("board", body).box({-0.1, -1, 0}, {0.1, 1, 1});
  return tiny;
}

TEST(Contact, BoxesHoldBodiesAndTheSharesThatTheyFill) {
  TinyScene tiny = board_with_rotor();
  const uint32_t half = tiny.body("half");
  // A triangle fills half of its side, and nothing of the others.
  tiny.object("half", half).triangle({0, 0, 0}, {0, 2, 0}, {0, 0, 2});
  const std::vector<render::ContactBox> boxes = render::contact_boxes(tiny.build());
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_NEAR(boxes[0].opacity, 1.0, 1e-9);
  EXPECT_NEAR(boxes[0].center.z, 0.5, 1e-6);
  EXPECT_NEAR(boxes[0].half_size.y, 1.0, 1e-6);
  EXPECT_NEAR(boxes[1].opacity, 0.5, 0.03);
  for (const render::ContactBox& box : boxes) {
    // Beyond its reach a box hides at most contact_least_share of level ground.
    const dvec3 p(box.half_size.x + box.reach, 0.0, -box.half_size.z);
    EXPECT_LT(shared::box_share(vec3(p), vec3(0, 0, 1), vec3(box.half_size)), render::contact_least_share);
    EXPECT_GT(box.reach, 0.5);
  }
}

TEST(Contact, GroundBesideABodyIsAsDarkAsTheFormFactorSays) {
  TinyScene tiny = board_with_rotor();
  render::Lighting lighting = plain_light();
  lighting.sun_illuminance_lux = 0.0;
  lighting.sky_model = render::SkyModel::uniform;
  render::CameraEffects effects = lambertian();
  render::CameraDesc desc = plain_camera(65);
  const Pose above = look({5.0, 0, 4.0}, 0, 90);
  const std::vector<Pose> moving{Pose{{6.2, 0, 0}, dquat(1, 0, 0, 0)}};
  const render::CameraImages without = CameraRig(tiny.build(), lighting, desc, effects).shoot(above, moving);
  effects.contact_occlusion = true;
  const render::CameraImages with = CameraRig(tiny.build(), lighting, desc, effects).shoot(above, moving);
  int compared = 0;
  for (uint32_t row = 0; row < desc.height; row += 8)
    for (uint32_t column = 0; column < desc.width; column += 8) {
      const size_t i = size_t{row} * desc.width + column;
      if (with.instance[i] != 1) {
        EXPECT_EQ(with.rgb[3 * i], without.rgb[3 * i]) << "a body hides nothing from itself";
        continue;
      }
      const dvec3 ray = above.rotate(pixel_ray(desc, column, row));
      const dvec3 p = above.position + ray * (above.position.z / -ray.z) - dvec3(6.2, 0, 0.5);
      const double share = counted_share(p, {0, 0, 1}, {0.1, 1, 0.5});
      EXPECT_NEAR(luminance_at(with, i) / luminance_at(without, i), 1.0 - share, 0.015)
          << column << " " << row;
      ++compared;
    }
  EXPECT_GT(compared, 40);
}

/// Returns the boxes that the shader looks at from a place, by their numbers.
std::vector<uint32_t> boxes_at(const std::vector<uint32_t>& words, const dvec2& place) {
  const auto real = [&](uint32_t at) { return double(std::bit_cast<float>(words[at])); };
  const dvec2 corner(real(shared::contact_corner_word), real(shared::contact_corner_word + 1));
  const dvec2 cell = (place - corner) * real(shared::contact_inverse_word);
  const uint32_t columns = words[shared::contact_columns_word], rows = words[shared::contact_rows_word];
  if (cell.x < 0.0 || cell.y < 0.0 || cell.x >= columns || cell.y >= rows) return {};
  const size_t at = shared::contact_header_words +
                    2 * (static_cast<size_t>(cell.y) * columns + static_cast<size_t>(cell.x));
  // The boxes stand behind all lists.
  uint32_t entries = 0;
  for (size_t i = 0; i < size_t{columns} * rows; ++i)
    entries += words[shared::contact_header_words + 2 * i + 1];
  const uint32_t lists = shared::contact_header_words + 2 * columns * rows;
  const uint32_t first = (lists + entries + 3) / 4;
  std::vector<uint32_t> found;
  for (uint32_t k = 0; k < words[at + 1]; ++k)
    found.push_back((words[words[at] + k] - first) / shared::contact_box_quads);
  return found;
}

TEST(Contact, ACellListsEveryBoxThatMayHideSomethingThereAndFewOthers) {
  RandomStream random(3, 7);
  std::vector<render::ContactBox> boxes(60);
  std::vector<Pose> poses(boxes.size() + 1);
  for (uint32_t i = 0; i < boxes.size(); ++i) {
    boxes[i].body = boxes[i].last_part = i + 1;
    boxes[i].half_size = {random.uniform(0.1, 6.0), random.uniform(0.1, 1.5), random.uniform(0.1, 2.0)};
    boxes[i].center = {random.uniform(-1, 1), 0.2, 0.5};
    boxes[i].reach = random.uniform(0.5, 8.0);
    // Every third one is turned about all axes.
    const double tilt = i % 3 == 0 ? 1.5 : 0.0;
    poses[i + 1] = {{random.uniform(-60, 60), random.uniform(-60, 60), random.uniform(0, 3)},
                    orientation_from_yaw_pitch_roll(random.uniform(-3, 3), random.uniform(-1, 1) * tilt,
                                                    random.uniform(-1, 1) * tilt)};
  }
  const std::vector<uint32_t> words = render::contact_words(boxes, poses);
  size_t listed = 0, near = 0, in_squares = 0;
  const auto real = [&](uint32_t at) { return double(std::bit_cast<float>(words[at])); };
  const dvec2 corner(real(shared::contact_corner_word), real(shared::contact_corner_word + 1));
  const auto cell_of = [&](const dvec2& place) {
    return glm::floor((place - corner) * real(shared::contact_inverse_word));
  };
  for (int k = 0; k < 20000; ++k) {
    const dvec3 p(random.uniform(-70, 70), random.uniform(-70, 70), random.uniform(-1, 6));
    const std::vector<uint32_t> found = boxes_at(words, dvec2(p));
    EXPECT_TRUE(std::ranges::is_sorted(found));
    listed += found.size();
    for (uint32_t i = 0; i < boxes.size(); ++i) {
      const dvec3 q = poses[i + 1].inverse().apply(p) - boxes[i].center;
      const bool counts =
          shared::contact_window(vec3(q), vec3(boxes[i].half_size), float(boxes[i].reach)) > 0.0f;
      EXPECT_TRUE(!counts || std::ranges::binary_search(found, i)) << i;
      near += counts;
      // The cells of the square around the ball that holds the box and its reach.
      const dvec2 middle(poses[i + 1].apply(boxes[i].center)), cell = cell_of(dvec2(p));
      const double radius = glm::length(boxes[i].half_size) + boxes[i].reach;
      const dvec2 low = cell_of(middle - radius), high = cell_of(middle + radius);
      in_squares += cell.x >= low.x && cell.y >= low.y && cell.x <= high.x && cell.y <= high.y;
    }
  }
  EXPECT_GT(near, 5000u);
  EXPECT_LT(double(listed), 0.85 * double(in_squares));
}

TEST(Contact, FarFromEveryBodyNoByteChanges) {
  TinyScene tiny = board_with_rotor();
  render::CameraEffects effects = lambertian();
  const Pose above = look({-30.0, 0, 4.0}, 0, 90);
  const std::vector<Pose> moving{Pose{{6.2, 0, 0}, dquat(1, 0, 0, 0)}};
  const auto shoot = [&] {
    return CameraRig(tiny.build(), plain_light(), plain_camera(32), effects).shoot(above, moving);
  };
  const render::CameraImages without = shoot();
  effects.contact_occlusion = true;
  EXPECT_EQ(shoot().hdr, without.hdr);
}

}  // namespace
}  // namespace greatx::test
