// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/draw_list.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/surface/closed_bodies.h"
#include "renderer/surface/pane_color.h"
#include "tests/support/tiny_scene.h"

namespace greatx::render {
namespace {

using test::TinyScene;

void add_box(TinyScene& scene, const std::string& name, const dvec3& at, double size, uint32_t body = 0) {
  scene.object(name, body).box(at - dvec3(0.5 * size), at + dvec3(0.5 * size));
}

DrawList list_of(const scene::Scene& scene, std::optional<uint32_t> excluded = {}) {
  return {scene,
          std::vector<bool>(scene.bodies.size(), true),
          closed_instances(scene),
          excluded,
          true,
          pane_materials(scene)};
}

TEST(DrawList, WhatStandsTogetherSharesADraw) {
  TinyScene tiny;
  add_box(tiny, "pole", {0, 0, 0}, 1.0);
  add_box(tiny, "lamp", {2, 0, 0}, 0.5);
  add_box(tiny, "far pole", {30, 0, 0}, 1.0);
  add_box(tiny, "house", {60, 0, 0}, 20.0);
  add_box(tiny, "its roof", {60, 0, 1}, 19.0);
  const scene::Scene scene = tiny.build();
  const DrawList list = list_of(scene);
  ASSERT_EQ(list.still().size(), 3u) << "pole and lamp, far pole, house and roof";
  EXPECT_EQ(list.still()[0].primitive, 0u);
  EXPECT_EQ(list.still()[1].primitive, 2u);
  EXPECT_EQ(list.still()[2].primitive, 3u);
  EXPECT_TRUE(list.moving().empty());
}

TEST(DrawList, BodiesAreApartAndAPartOfTheExcludedOneIsLeftOut) {
  TinyScene tiny;
  const uint32_t car = tiny.body("car"), van = tiny.body("van");
  add_box(tiny, "ground", {0, 0, -2}, 1.0);
  add_box(tiny, "car", {0, 0, 0}, 2.0, car);
  add_box(tiny, "car's roof", {20, 0, 0}, 1.0, car);
  add_box(tiny, "van", {0, 0, 0}, 2.0, van);
  const scene::Scene scene = tiny.build();
  const DrawList list = list_of(scene);
  EXPECT_EQ(list.still().size(), 1u);
  ASSERT_EQ(list.moving().size(), 2u) << "all of a body moves together, so no size limits it";
  EXPECT_EQ(list.moving()[0].body, car);
  EXPECT_EQ(list.moving()[1].body, van);
  EXPECT_TRUE(list.any_closed());
  const DrawList without = list_of(scene, van);
  ASSERT_EQ(without.moving().size(), 1u);
  EXPECT_EQ(without.moving()[0].body, car);
}

/// Every triangle is drawn once, within its sphere, and no sphere is larger than the rule allows.
TEST(DrawList, GlazedPiecesAreSplitIntoPanesAndTheRest) {
  TinyScene tiny;
  scene::Material glass;
  glass.name = "glass";
  glass.pbr.metallic = 0.0f;
  glass.pbr.roughness = 0.1f;
  glass.pbr.transmission = 0.9f;
  const uint32_t pane = tiny.material_as(glass), van = tiny.body("van");
  add_box(tiny, "post", {0, 0, 0}, 1.0);
  tiny.object("window", 0, pane).box({1, 0, 0}, {1.5, 1, 1});
  add_box(tiny, "door", {2, 0, 0}, 0.5);
  add_box(tiny, "hood", {0, 0, 0}, 1.0, van);
  tiny.object("screen", van, pane).box({0, 0, 0}, {1, 1, 1});
  const scene::Scene scene = tiny.build();
  const DrawList list = list_of(scene);
  ASSERT_EQ(list.still().size(), 1u);
  ASSERT_EQ(list.moving().size(), 1u);
  EXPECT_EQ(list.panes().size(), 2u);
  EXPECT_EQ(list.rests().size(), 3u);
  for (const DrawPiece* piece : {&list.still()[0], &list.moving()[0]}) {
    uint32_t indices = 0;
    for (const uint32_t i : piece->panes) indices += list.panes()[i].index_count;
    for (const uint32_t i : piece->rests) {
      EXPECT_FALSE(list.rests()[i].closed);
      EXPECT_EQ(list.rests()[i].body, piece->body);
      indices += list.rests()[i].index_count;
    }
    EXPECT_EQ(indices, piece->index_count);
  }
  const std::vector<Pose> poses(scene.bodies.size());
  std::vector<uint32_t> order{0};
  EXPECT_TRUE(take_glazed(order, list.still(), poses, {50, 0, 0}, 40.0).empty());
  EXPECT_EQ(order.size(), 1u);
  EXPECT_EQ(take_glazed(order, list.still(), poses, {50, 0, 0}, 50.0).size(), 1u);
  EXPECT_TRUE(order.empty());
}

TEST(DrawList, EveryTriangleIsInOnePieceAndItsSphere) {
  TinyScene tiny;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-40.0, 40.0), edge(0.2, 12.0);
  double largest = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double size = edge(random);
    add_box(tiny, "box", {place(random), place(random), 0.2 * place(random)}, size);
    largest = std::max(largest, size);
  }
  const scene::Scene scene = tiny.build();
  const DrawList list = list_of(scene);
  std::vector<int> drawn(scene.indices.size(), 0);
  for (const DrawPiece& piece : list.still()) {
    EXPECT_LE(piece.radius(), std::max(4.0, 1.2 * largest * std::sqrt(3.0) / 2.0));
    for (uint32_t i = piece.first_index; i < piece.first_index + piece.index_count; ++i) {
      ++drawn[i];
      const dvec3 vertex(scene.positions[scene.indices[i]]);
      EXPECT_LE(glm::distance(vertex, piece.center()), piece.radius() + 1e-6);
    }
  }
  EXPECT_THAT(drawn, testing::Each(1));
  EXPECT_LT(list.still().size(), 200u);
}

}  // namespace
}  // namespace greatx::render
