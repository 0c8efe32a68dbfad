// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/draw_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/camera/pane_groups.h"
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
          {insides(scene), std::vector<bool>(scene.bodies.size(), true), closed_instances(scene)},
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

scene::Material clear_glass() {
  scene::Material glass;
  glass.name = "glass";
  glass.pbr.metallic = 0.0f;
  glass.pbr.roughness = 0.1f;
  glass.pbr.transmission = 0.9f;
  return glass;
}

/// What panes hide as long as they count as solid is drawn with the rest behind panes, and not by the piece.
TEST(DrawList, InsidesAreDrawnBehindPanesAlone) {
  for (const bool moves : {false, true}) {
    TinyScene tiny;
    const uint32_t body = moves ? tiny.body("car") : 0, paint = tiny.material_as({}),
                   seat = tiny.material_as({}), pane = tiny.material_as(clear_glass());
    tiny.object("car", body, paint).open_box({-2, -1, 0}, {2, 1, 1});
    tiny.object("roof", body, pane).quad({-2, -1, 1}, {2, -1, 1}, {2, 1, 1}, {-2, 1, 1});
    tiny.object("seat", body, seat).quad({-1, -0.9, 0.5}, {1, -0.9, 0.5}, {1, 0.9, 0.5}, {-1, 0.9, 0.5});
    scene::Scene scene = tiny.build();
    for (scene::Primitive& primitive : scene.primitives) primitive.instance = 0;
    const ClosedSurfaces surfaces = closed_surfaces(scene);
    ASSERT_EQ(surfaces.insides, (std::vector<bool>{false, false, true}));
    const DrawList list{scene, surfaces, {}, true, pane_materials(scene)};
    const std::span<const DrawPiece> pieces = moves ? list.moving() : list.still();
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_TRUE(pieces[0].closed);
    EXPECT_EQ(pieces[0].index_count, 36u);
    ASSERT_EQ(pieces[0].rests.size(), 2u);
    EXPECT_EQ(list.rests()[pieces[0].rests[1]].first_index, 36u);
    // Cameras whose panes are solid draw everything in one piece, which is closed but for what it hides.
    const DrawList solid{scene, surfaces, {}, true, {}};
    const std::span<const DrawPiece> whole = moves ? solid.moving() : solid.still();
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_TRUE(whole[0].closed);
    EXPECT_EQ(whole[0].index_count, 42u);
  }
}

/// Every triangle is drawn once, within its sphere, and no sphere is larger than the rule allows.
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

/// Returns the view of a camera 64 pixels high that looks along x.
CameraView view_of(const dvec3& eye) {
  return {{100, 64, 50.0, 50.0, 49.0, 33.0}, 0.05, Pose{eye, {}}, SunFrame::of({0, 0, 1}), 1.0};
}

TEST(PaneGroups, HoldEveryPixelThatAPaneTouches) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-6.0, 6.0), ahead(-1.0, 12.0), share(0.0, 1.0);
  size_t outside = 0;
  for (int i = 0; i < 200; ++i) {
    TinyScene tiny;
    const uint32_t body = tiny.body("pane");
    std::array<dvec3, 3> corners;
    for (dvec3& corner : corners) corner = {ahead(random), place(random), place(random)};
    tiny.object("pane", body).triangle(corners[0], corners[1], corners[2]);
    const scene::Scene scene = tiny.build();
    const std::vector<Pose> poses{Pose{}, Pose{{0.5, 0.2, -0.3}, {}}};
    const CameraView view = view_of({-0.4, 0.3, 0.1});
    const std::vector<DrawPiece> panes{{0, 3, body, 0}};
    const std::vector<uint32_t> groups = pane_groups(scene, panes, std::vector<uint32_t>{0}, poses, view);
    EXPECT_TRUE(std::ranges::is_sorted(groups));
    for (int k = 0; k < 500; ++k) {
      double u = share(random), v = share(random);
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      const dvec3 p =
          poses[1].apply(corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0])) -
          view.eye;
      if (p.x < 0.05) continue;
      const double column = 49.0 - 50.0 * p.y / p.x, row = 33.0 - 50.0 * p.z / p.x;
      if (column < 0.0 || column >= 100.0 || row < 0.0 || row >= 64.0) continue;
      const uint32_t group = static_cast<uint32_t>(column) / 8 | static_cast<uint32_t>(row) / 8 << 16;
      ASSERT_TRUE(std::ranges::binary_search(groups, group)) << i << ": " << column << ", " << row;
    }
    outside += 13 * 8 - groups.size();
  }
  EXPECT_GT(outside, 200u * 13 * 8 / 4);
}

TEST(PaneGroups, OfManyTrianglesAreThoseOfTheirBox) {
  TinyScene tiny;
  const uint32_t body = tiny.body("panes");
  tiny.object("panes", body);
  for (int i = 0; i < 600; ++i) {
    const double x = 10.0 + 0.01 * i, y = -1.0 + 0.003 * i;
    tiny.triangle({x, y, -1}, {x, y + 0.1, -1}, {x, y, 0.5});
  }
  const scene::Scene scene = tiny.build();
  std::vector<DrawPiece> pieces{{0, 1800, body, 0}};
  pieces[0].bounds = scene.instances[0].bounds;
  const std::vector<Pose> poses(2);
  const std::vector<uint32_t> boxed =
      pane_groups(scene, pieces, std::vector<uint32_t>{0}, poses, view_of({}));
  std::vector<DrawPiece> halves{{0, 900, body, 0}, {900, 900, body, 0}};
  for (const uint32_t group : pane_groups(scene, halves, std::vector<uint32_t>{1, 0}, poses, view_of({})))
    EXPECT_TRUE(std::ranges::binary_search(boxed, group));
  EXPECT_LT(boxed.size(), 20u);
  EXPECT_EQ(all_groups(100, 60).size(), 13u * 8);
}

}  // namespace
}  // namespace greatx::render
