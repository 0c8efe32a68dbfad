// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/build/build.h"

#include <cmath>
#include <set>

#include "core/units.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/png.h"

namespace greatx::scene {
namespace {

using test::expect_user_error;
using test::GltfWriter;
using test::has_note;
using test::json;

ModelPlacement placement_of(const Model& model, const std::string& name = "") {
  ModelPlacement placement;
  placement.name = name;
  placement.model = &model;
  return placement;
}

/// Returns options with the origin at zero, so that local = world.
BuildOptions at_zero() {
  BuildOptions options;
  options.origin = dvec3(0.0);
  return options;
}

Scene build_one(const GltfWriter& writer, const BuildOptions& options = at_zero()) {
  const Model model = writer.load();
  return build_scene({placement_of(model)}, options);
}

/// Writes a quad in the file's axes.
GltfWriter quad(const std::vector<vec3>& corners = test::unit_quad()) {
  GltfWriter writer;
  writer.add_triangles("wall", corners, test::quad_indices(), writer.itu_material());
  return writer;
}

/// Writes a closed box from (0, 0, 0) to (1, 1, 1), wound outwards, 12 triangles on 8 vertices, in the file's
/// axes.
GltfWriter box() {
  const std::vector<vec3> corners = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0),
                                     vec3(0, 0, 1), vec3(1, 0, 1), vec3(1, 1, 1), vec3(0, 1, 1)};
  GltfWriter writer;
  writer.add_triangles("box", corners, {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                        3, 7, 6, 3, 6, 2, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5},
                       writer.itu_material());
  return writer;
}

dvec3 geometric_normal(const Scene& scene, size_t triangle) {
  const dvec3 a(scene.positions[scene.indices[triangle * 3]]);
  const dvec3 b(scene.positions[scene.indices[triangle * 3 + 1]]);
  const dvec3 c(scene.positions[scene.indices[triangle * 3 + 2]]);
  return glm::normalize(glm::cross(b - a, c - a));
}

/// Returns six times the volume that the triangles enclose. It is positive if they are wound outwards.
double enclosed(const Scene& scene) {
  double sum = 0.0;
  for (const FacetTriangle& triangle : scene.facet_triangles) {
    sum += glm::dot(triangle.corners[0], glm::cross(triangle.corners[1], triangle.corners[2]));
  }
  return sum;
}

void expect_consistent(const Scene& scene) {
  ASSERT_EQ(scene.normals.size(), scene.positions.size());
  ASSERT_EQ(scene.tangents.size(), scene.positions.size());
  ASSERT_EQ(scene.uvs.size(), scene.positions.size());
  ASSERT_EQ(scene.facet_of_triangle.size(), scene.triangle_count());
  ASSERT_EQ(scene.facet_triangles.size(), scene.triangle_count());
  uint32_t next_index = 0, next_triangle = 0, body = 0, next_primitive = 0;
  for (const Body& entry : scene.bodies) {
    EXPECT_EQ(entry.first_primitive, next_primitive);
    next_primitive += entry.primitive_count;
  }
  EXPECT_EQ(next_primitive, scene.primitives.size());
  for (const Primitive& primitive : scene.primitives) {
    EXPECT_EQ(primitive.first_index, next_index);
    EXPECT_EQ(primitive.index_count % 3, 0u);
    next_index += primitive.index_count;
    EXPECT_GE(scene.instances.at(primitive.instance).body, body);
    body = scene.instances[primitive.instance].body;
    EXPECT_LT(primitive.material, scene.materials.size());
  }
  EXPECT_EQ(next_index, scene.indices.size());
  for (const uint32_t index : scene.indices) ASSERT_LT(index, scene.positions.size());
  uint32_t facet_body = 0;
  for (const Facet& facet : scene.facets) {
    EXPECT_EQ(facet.first_triangle, next_triangle);
    next_triangle += facet.triangle_count;
    EXPECT_GE(facet.body, facet_body);
    facet_body = facet.body;
    EXPECT_NEAR(glm::length(facet.normal), 1.0, 1e-12);
    for (uint32_t index = facet.first_triangle; index < next_triangle; ++index) {
      const auto& corners = scene.facet_triangles[index].corners;
      for (const dvec3& corner : corners) EXPECT_NEAR(glm::dot(facet.normal, corner), facet.offset, 1e-4);
      EXPECT_GT(glm::dot(facet.normal, glm::cross(corners[1] - corners[0], corners[2] - corners[0])), 0.0);
    }
  }
  for (const vec3& normal : scene.normals) EXPECT_NEAR(glm::length(normal), 1.0f, 1e-5f);
  std::set<std::string> names;
  for (const Instance& instance : scene.instances)
    EXPECT_TRUE(names.insert(instance.name).second) << instance.name;
}

TEST(BuildScene, FlatNormalsWhereTheFileHasNone) {
  const Scene scene = build_one(box());
  expect_consistent(scene);
  EXPECT_EQ(scene.positions.size(), 36u);  // vertices are not shared
  for (size_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
    for (size_t corner = 0; corner < 3; ++corner) {
      const dvec3 normal(scene.normals[scene.indices[triangle * 3 + corner]]);
      EXPECT_NEAR(glm::distance(normal, geometric_normal(scene, triangle)), 0.0, 1e-6);
    }
  }
  EXPECT_EQ(scene.facets.size(), 6u);
  EXPECT_GT(enclosed(scene), 0.0);
  EXPECT_TRUE(has_note(scene.notes, "1 primitives without normals got flat ones"));
  EXPECT_EQ(scene.bounds.min, dvec3(0, -1, 0));
  EXPECT_EQ(scene.bounds.max, dvec3(1, 0, 1));
}

TEST(BuildScene, OriginIsTheCentreInWholeMetres) {
  const Model model = quad({vec3(10, 0, 0), vec3(14.4f, 0, 0), vec3(14.4f, 3, 0), vec3(10, 3, 0)}).load();
  ModelPlacement placement = placement_of(model);
  placement.pose.position = dvec3(500000.0, 5400000.0, 35.0);
  const Scene scene = build_scene({placement}, {});
  EXPECT_EQ(scene.origin, dvec3(500012.0, 5400000.0, 37.0));
  const dvec3 far_end(500014.4, 5400000.0, 38.0);
  EXPECT_NEAR(glm::distance(scene.to_local(far_end), dvec3(2.4, 0.0, 1.0)), 0.0, 1e-9);
  EXPECT_NEAR(scene.bounds.max.x, 2.4, 1e-6);
}

TEST(BuildScene, EmptySceneIsAWorldWithNothingInIt) {
  const Scene scene = build_scene({}, {});
  ASSERT_EQ(scene.bodies.size(), 1u);
  EXPECT_EQ(scene.bodies[0].name, "static");
  EXPECT_TRUE(scene.bounds.empty());
  EXPECT_EQ(scene.hash.size(), 64u);
  EXPECT_EQ(scene.body_index("static"), 0u);
  EXPECT_THROW(scene.body_index("car"), ContractError);
}

TEST(BuildScene, MovingBodiesKeepTheirOwnFrame) {
  const Model ground = quad().load(), car = box().load();
  ModelPlacement moving = placement_of(car, "car");
  moving.moving = true;
  moving.scale = dvec3(2.0);
  moving.pose.position = dvec3(0.0, 0.0, 0.5);  // in the body's frame, whatever the origin
  moving.semantic_class = SemanticClass::vehicle;
  ModelPlacement second = moving;
  second.name = "taxi";
  const Scene scene = build_scene({moving, placement_of(ground, "ground"), second}, {});
  expect_consistent(scene);
  ASSERT_EQ(scene.bodies.size(), 3u);
  EXPECT_EQ(scene.body_index("car"), 1u);
  EXPECT_EQ(scene.body_index("taxi"), 2u);
  EXPECT_EQ(scene.bodies[1].bounds.min, dvec3(0, -2, 0.5));
  EXPECT_EQ(scene.bodies[1].bounds.max, dvec3(2, 0, 2.5));
  EXPECT_EQ(scene.bounds.size(), dvec3(1, 0, 1));  // of the static world alone
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.instances[0].name, "ground/wall");
  EXPECT_EQ(scene.instances[1].name, "car/box");
  EXPECT_EQ(scene.instances[1].semantic_class, SemanticClass::vehicle);
  EXPECT_EQ(scene.facets.size(), 1u + 6u + 6u);
  EXPECT_EQ(scene.facets.back().body, 2u);
  EXPECT_EQ(scene.materials.size(), 1u);  // equal materials are merged
  second.name = "car";
  expect_user_error([&] { build_scene({moving, second}, {}); }, {"moving object 'car'"});
  second.name = "";
  expect_user_error([&] { build_scene({second}, {}); }, {"expected a name"});
}

TEST(BuildScene, InstanceNamesAreUnique) {
  GltfWriter writer = quad();
  writer.root({{"name", "wall"}, {"mesh", 0}, {"translation", {2, 0, 0}}});
  const Model model = writer.load();
  const Scene scene = build_scene({placement_of(model), placement_of(model), placement_of(model, "a")}, {});
  std::vector<std::string> names;
  for (const Instance& instance : scene.instances) names.push_back(instance.name);
  EXPECT_EQ(names, (std::vector<std::string>{"wall", "wall_2", "wall_3", "wall_4", "a/wall", "a/wall_2"}));
}

TEST(BuildScene, PoseAndScaleOfAPlacement) {
  const Model model = quad().load();
  ModelPlacement placement = placement_of(model);
  placement.pose.position = dvec3(10, 20, 30);
  placement.pose.orientation = orientation_from_yaw_pitch_roll(pi / 2, 0, 0);
  placement.scale = dvec3(2, 1, 3);
  const Scene scene = build_scene({placement}, at_zero());
  // East 0...2 turns to north, up is 0...3.
  EXPECT_NEAR(glm::distance(scene.bounds.min, dvec3(10, 20, 30)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(scene.bounds.max, dvec3(10, 22, 33)), 0.0, 1e-12);
  ModelPlacement bad = placement;
  bad.scale.y = 0.0;
  expect_user_error([&] { build_scene({bad}, {}); }, {"scale", "test.glb"});
  bad = placement;
  bad.pose.position.x = std::nan("");
  expect_user_error([&] { build_scene({bad}, {}); }, {"not finite"});
}

TEST(BuildScene, TransformsThatOverflowAreRefusedByName) {
  GltfWriter writer = quad();
  writer.document["nodes"][0]["scale"] = {1e30, 1e30, 1e30};
  writer.append("nodes", {{"children", {0}}, {"scale", {1e30, 1e30, 1e30}}});
  writer.document["scenes"][0]["nodes"] = {1};
  const Model model = writer.load();
  expect_user_error([&] { build_scene({placement_of(model)}, at_zero()); },
                    {"test.glb: mesh 'wall', placed as 'wall'", "vertex 1", "finite"});
}

TEST(BuildScene, TexturesAndMaterialsAreSharedAcrossModels) {
  const auto textured = [](const std::string& name, const std::vector<uint8_t>& pixel) {
    GltfWriter writer;
    writer.append("images",
                  {{"uri", "data:image/png;base64," + test::base64(test::encode_png(1, 1, pixel))}});
    writer.append("textures", {{"source", 0}});
    const int material =
        writer.material({{"name", name}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    writer.add_triangles("wall", test::unit_quad(), test::quad_indices(), material);
    return writer.load();
  };
  const Model first = textured("itu_wood", {1, 2, 3, 255}), second = textured("itu_wood", {1, 2, 3, 255});
  const Model other = textured("itu_brick", {1, 2, 3, 255}), painted = textured("itu_wood", {9, 2, 3, 255});
  const Scene scene =
      build_scene({placement_of(first, "a"), placement_of(second, "b"), placement_of(first, "c"),
                   placement_of(other, "d"), placement_of(painted, "e")},
                  {});
  EXPECT_EQ(scene.textures.size(), 2u);
  ASSERT_EQ(scene.materials.size(), 3u);
  EXPECT_EQ(scene.materials[1].name, "itu_brick");
  EXPECT_EQ(scene.materials[1].pbr.base_color_texture, 0);
  EXPECT_EQ(scene.materials[2].pbr.base_color_texture, 1);
  EXPECT_EQ(scene.primitives[2].material, 0u);
}

TEST(BuildScene, LightsMoveWithTheirPlacement) {
  GltfWriter writer = quad();
  writer.document["extensions"] = {
      {"KHR_lights_punctual", {{"lights", {{{"type", "spot"}, {"spot", json::object()}}}}}}};
  writer.root({{"name", "lamp"},
               {"translation", {1, 2, 0}},
               {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const Model model = writer.load();
  ModelPlacement placement = placement_of(model, "post");
  placement.pose.position = dvec3(5e5, 0, 0);
  placement.pose.orientation = orientation_from_yaw_pitch_roll(pi / 2, 0, 0);
  BuildOptions options;
  options.origin = dvec3(5e5, 0, 0);
  ModelPlacement moving = placement;
  moving.moving = true;
  moving.name = "car";
  moving.pose = Pose();
  const Scene scene = build_scene({placement, moving}, options);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].name, "post/lamp");
  EXPECT_NEAR(glm::distance(scene.lights[0].position, dvec3(0, 1, 2)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(scene.lights[0].direction, dvec3(-1, 0, 0)), 0.0, 1e-12);  // north turned left
  EXPECT_EQ(scene.lights[1].body, 1u);
  EXPECT_NEAR(glm::distance(scene.lights[1].position, dvec3(1, 0, 2)), 0.0, 1e-12);
}

/// Builds a quad that carries a normal map. `uvs` are in the order of unit_quad().
Scene normal_mapped(const std::vector<vec2>& uvs, bool mirrored_scale = false, bool given = false) {
  GltfWriter writer;
  writer.append("images", {{"uri", "data:image/png;base64," +
                                       test::base64(test::encode_png(1, 1, {128, 128, 255, 255}))}});
  writer.append("textures", {{"source", 0}});
  const int material = writer.material({{"name", "itu_wood"}, {"normalTexture", {{"index", 0}}}});
  json attributes = {{"POSITION", writer.vec3s(test::unit_quad())},
                     {"NORMAL", writer.vec3s(std::vector<vec3>(4, vec3(0, 0, 1)))}};
  if (!uvs.empty()) attributes["TEXCOORD_0"] = writer.vec2s(uvs);
  if (given) attributes["TANGENT"] = writer.vec4s(std::vector<vec4>(4, vec4(0, 1, 0, 1)));
  const json primitive = {{"attributes", attributes},
                          {"indices", writer.indices32(test::quad_indices())},
                          {"material", material}};
  json node = {{"name", "wall"}, {"mesh", writer.mesh("wall", json::array({primitive}))}};
  if (mirrored_scale) node["scale"] = {-1, 1, 1};
  writer.root(node);
  return build_one(writer);
}

TEST(BuildScene, TangentsPointAlongU) {
  // The picture is upright on the wall: u east, v down.
  const Scene scene = normal_mapped({vec2(0, 1), vec2(1, 1), vec2(1, 0), vec2(0, 0)});
  expect_consistent(scene);
  for (const vec4& tangent : scene.tangents)
    EXPECT_NEAR(glm::distance(tangent, vec4(1, 0, 0, 1)), 0.0f, 1e-6f);
  // glTF 2.0, section 3.7.2.1: bitangent = cross(normal, tangent) * w, up the picture.
  const vec3 bitangent = glm::cross(scene.normals[0], vec3(scene.tangents[0])) * scene.tangents[0].w;
  EXPECT_NEAR(glm::distance(bitangent, vec3(0, 0, 1)), 0.0f, 1e-6f);
  // Now the picture is mirrored left to right.
  for (const vec4& tangent : normal_mapped({vec2(1, 1), vec2(0, 1), vec2(0, 0), vec2(1, 0)}).tangents) {
    EXPECT_NEAR(glm::distance(tangent, vec4(-1, 0, 0, -1)), 0.0f, 1e-6f);
  }
}

TEST(BuildScene, VerticesBetweenMirroredTrianglesAreDoubled) {
  // The second triangle (0, 2, 3) has a mirrored map.
  const Scene scene = normal_mapped({vec2(0, 0), vec2(1, 0), vec2(1, -1), vec2(1, 0)});
  expect_consistent(scene);
  EXPECT_EQ(scene.positions.size(), 6u);
  for (size_t index = 0; index < 3; ++index) EXPECT_EQ(scene.tangents[scene.indices[index]].w, 1.0f);
  for (size_t index = 3; index < 6; ++index) EXPECT_EQ(scene.tangents[scene.indices[index]].w, -1.0f);
  EXPECT_EQ(scene.facets.size(), 1u);  // tangents do not affect facets
}

TEST(BuildScene, GivenTangentsFollowTheTransform) {
  const std::vector<vec2> uvs = {vec2(0, 1), vec2(1, 1), vec2(1, 0), vec2(0, 0)};
  for (const vec4& tangent : normal_mapped(uvs, false, true).tangents) EXPECT_EQ(tangent, vec4(0, 0, 1, 1));
  for (const vec4& tangent : normal_mapped(uvs, true, true).tangents) EXPECT_EQ(tangent, vec4(0, 0, 1, -1));
}

TEST(BuildScene, NormalMapWithoutUvsIsFiniteAndNoted) {
  const Scene scene = normal_mapped({});
  for (const vec4& tangent : scene.tangents) {
    EXPECT_NEAR(glm::length(vec3(tangent)), 1.0f, 1e-6f);
    EXPECT_NEAR(glm::dot(vec3(tangent), scene.normals[0]), 0.0f, 1e-6f);
  }
  EXPECT_TRUE(has_note(scene.notes, "normal map have no texture coordinates"));
}

TEST(BuildScene, TangentsAreZeroWithoutANormalMap) {
  for (const vec4& tangent : build_one(quad()).tangents) EXPECT_EQ(tangent, vec4(0.0f));
}

TEST(BuildScene, HashCoversWhatReachesASensor) {
  const GltfWriter plain = quad();
  const std::string hash = build_one(plain).hash;
  EXPECT_EQ(hash, build_one(plain).hash);
  GltfWriter changed = quad();
  changed.document["nodes"][0]["translation"] = {0, 0, 1e-3};
  EXPECT_NE(hash, build_one(changed).hash);
  changed = quad();
  changed.document["materials"][0]["name"] = "itu_brick";
  EXPECT_NE(hash, build_one(changed).hash);
  changed = quad();
  changed.document["materials"][0]["pbrMetallicRoughness"] = {{"roughnessFactor", 0.5}};
  EXPECT_NE(hash, build_one(changed).hash);
  changed = quad();
  changed.document["nodes"][0]["name"] = "other wall";
  EXPECT_NE(hash, build_one(changed).hash);
  BuildOptions moved = at_zero();
  moved.origin = dvec3(1, 0, 0);
  EXPECT_NE(hash, build_one(plain, moved).hash);
}

// ------------------------------------------------------------------------------------------------ facets

/// Writes `columns` x `rows` cells of a metre, two triangles each, in the plane y = 0 of the file (z = 0 of
/// the world). `lift` moves vertices off the plane.
GltfWriter grid(uint32_t columns, uint32_t rows, const std::function<float(uint32_t, uint32_t)>& lift) {
  std::vector<vec3> positions;
  std::vector<uint32_t> indices;
  for (uint32_t row = 0; row <= rows; ++row) {
    for (uint32_t column = 0; column <= columns; ++column) {
      positions.emplace_back(static_cast<float>(column), lift(column, row), -static_cast<float>(row));
    }
  }
  for (uint32_t row = 0; row < rows; ++row) {
    for (uint32_t column = 0; column < columns; ++column) {
      const uint32_t corner = row * (columns + 1) + column;
      indices.insert(indices.end(), {corner, corner + 1, corner + columns + 2, corner, corner + columns + 2,
                                     corner + columns + 1});
    }
  }
  GltfWriter writer;
  writer.add_triangles("ground", positions, indices, writer.itu_material());
  return writer;
}

TEST(HardCase, N18_TheDiagonalOfAQuadMakesOneFacet) {
  const Scene scene = build_one(quad());
  ASSERT_EQ(scene.facets.size(), 1u);
  EXPECT_EQ(scene.facets[0].triangle_count, 2u);
  EXPECT_NEAR(glm::distance(scene.facets[0].normal, dvec3(0, -1, 0)), 0.0, 1e-15);  // +z of the file is south
  EXPECT_EQ(scene.facet_of_triangle, (std::vector<uint32_t>{0, 0}));
}

TEST(HardCase, N18_ATessellatedWallMakesOneFacet) {
  const Scene scene = build_one(grid(40, 30, [](uint32_t, uint32_t) { return 0.0f; }));
  expect_consistent(scene);
  ASSERT_EQ(scene.facets.size(), 1u);
  EXPECT_EQ(scene.facets[0].triangle_count, 2400u);
  EXPECT_EQ(scene.facets[0].normal, dvec3(0, 0, 1));
}

TEST(HardCase, N22_APlaneAtTheEdgeOfAnyBinIsNotSplit) {
  // The offsets lie on the rounding edge of every decimal grid, and a jitter below the tolerance crosses this
  // edge.
  for (const float offset : {0.0f, 0.5e-4f, 1e-4f, 0.5e-3f, 0.5f, 1.0f, 12.345f}) {
    const auto jitter = [&](uint32_t column, uint32_t row) {
      return offset + ((column + row) % 2 ? 4e-5f : -4e-5f);
    };
    BuildOptions options = at_zero();
    options.coplanar_angle_rad = 1e-3;
    const Scene scene = build_one(grid(10, 10, jitter), options);
    EXPECT_EQ(scene.facets.size(), 1u) << offset;
    expect_consistent(scene);
  }
  // Walls are tilted so that their normals straddle bins of direction.
  for (int step = -5; step <= 5; ++step) {
    const double angle = pi / 4 + step * 1e-5;
    ModelPlacement placement;
    const Model model = grid(4, 4, [](uint32_t, uint32_t) { return 0.0f; }).load();
    placement.model = &model;
    placement.pose.orientation = orientation_from_yaw_pitch_roll(angle, angle, 0);
    EXPECT_EQ(build_scene({placement}, at_zero()).facets.size(), 1u);
  }
}

TEST(Facets, WhatIsFurtherOffThanTheDistanceStaysApart) {
  // A shallow fold rises by 1 mm per metre on the right half.
  const auto fold = [](uint32_t column, uint32_t) {
    return column > 5 ? static_cast<float>(column - 5) * 1e-3f : 0.0f;
  };
  const Scene scene = build_one(grid(10, 4, fold));
  expect_consistent(scene);
  EXPECT_EQ(scene.facets.size(), 2u);
  // A facet must not follow a curve whose neighbours agree within the angle. Every corner keeps the distance.
  BuildOptions loose = at_zero();
  loose.coplanar_angle_rad = 0.1;
  const auto curve = [](uint32_t column, uint32_t) { return static_cast<float>(column * column) * 1e-5f; };
  const Scene curved = build_one(grid(30, 2, curve), loose);
  expect_consistent(curved);
  EXPECT_GT(curved.facets.size(), 3u);
}

TEST(Facets, OppositeSidesAndOtherMaterialsStayApart) {
  std::vector<vec3> positions = test::unit_quad();
  GltfWriter back_to_back;
  back_to_back.add_triangles("sheet", positions, {0, 1, 2, 0, 2, 3, 2, 1, 0, 3, 2, 0},
                             back_to_back.itu_material());
  const Scene sheet = build_one(back_to_back);
  ASSERT_EQ(sheet.facets.size(), 2u);
  EXPECT_EQ(sheet.facets[0].normal, -sheet.facets[1].normal);

  GltfWriter two;
  const int position = two.vec3s(positions);
  const auto primitive = [&](const std::vector<uint32_t>& indices, int material) {
    return json{{"attributes", {{"POSITION", position}}},
                {"indices", two.indices32(indices)},
                {"material", material}};
  };
  const int concrete = two.itu_material("itu_concrete"), glass = two.itu_material("itu_glass");
  two.root(
      {{"mesh", two.mesh("m", json::array({primitive({0, 1, 2}, concrete), primitive({0, 2, 3}, glass)}))}});
  EXPECT_EQ(build_one(two).facets.size(), 2u);
  two.document["meshes"][0]["primitives"][1]["material"] = concrete;
  const Scene merged = build_one(two);
  EXPECT_EQ(merged.primitives.size(), 2u);
  EXPECT_EQ(merged.facets.size(), 1u);  // across primitives of one material
}

TEST(Facets, UnconnectedCoplanarTrianglesStayApart) {
  std::vector<vec3> positions = test::unit_quad();
  for (const vec3& corner : test::unit_quad()) positions.push_back(corner + vec3(5, 0, 0));
  GltfWriter writer;
  writer.add_triangles("m", positions, {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}, writer.itu_material());
  EXPECT_EQ(build_one(writer).facets.size(), 2u);
}

TEST(Facets, ASliverOfAWallJoinsIt) {
  // A 100 m wall lies far from its file's origin, where fp32 corners tilt a 2 cm strip. The merge allows for
  // this noise.
  std::vector<vec3> positions;
  const double turn = 0.3;
  const auto wall = [&](double along, double up) {
    positions.emplace_back(static_cast<float>(4000.0 + along * std::cos(turn)), static_cast<float>(up),
                           static_cast<float>(3000.0 + along * std::sin(turn)));
  };
  for (const double along : {0.0, 33.3, 33.302, 71.7, 100.0}) wall(along, 0.0), wall(along, 9.9);
  std::vector<uint32_t> indices;
  for (uint32_t strip = 0; strip < 4; ++strip) {
    const uint32_t corner = strip * 2;
    indices.insert(indices.end(), {corner, corner + 2, corner + 3, corner, corner + 3, corner + 1});
  }
  GltfWriter writer;
  writer.add_triangles("wall", positions, indices, writer.itu_material());
  BuildOptions options = at_zero();
  options.coplanar_distance_m = 1e-3;  // fp32 at 5 km: half a millimetre
  EXPECT_EQ(build_one(writer, options).facets.size(), 1u);
}

// ------------------------------------------------------------------------------------------------ hard cases

TEST(HardCase, N04_DegenerateTrianglesNeverReachTheScene) {
  std::vector<vec3> positions = test::unit_quad();
  positions.emplace_back(0.25f, 0.25f, 0.0f);  // on the diagonal 0–2
  GltfWriter writer;
  writer.add_triangles("wall", positions, {0, 1, 2, 0, 4, 2, 0, 2, 3}, writer.itu_material());
  const Scene scene = build_one(writer);
  expect_consistent(scene);
  EXPECT_EQ(scene.triangle_count(), 2u);
  for (const vec3& normal : scene.normals) EXPECT_TRUE(std::isfinite(normal.x + normal.y + normal.z));
}

TEST(HardCase, N05_SliversOnAClosedMeshStayInTheMesh) {
  // The front of the box has a strip 1e-4 m wide.
  const std::vector<vec3> positions = {vec3(0, 0, 0), vec3(0.5f, 0, 0), vec3(0.5001f, 0, 0), vec3(1, 0, 0),
                                       vec3(0, 1, 0), vec3(0.5f, 1, 0), vec3(0.5001f, 1, 0), vec3(1, 1, 0)};
  GltfWriter writer;
  writer.add_triangles("front", positions, {0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6},
                       writer.itu_material());
  const Scene scene = build_one(writer);
  expect_consistent(scene);
  EXPECT_EQ(scene.triangle_count(), 6u);
  EXPECT_EQ(scene.facets.size(), 1u);
}

TEST(HardCase, N07_ShiftedToUtmEqualsUnshifted) {
  GltfWriter writer = box();
  writer.document["nodes"][0]["rotation"] = {0, std::sin(0.2), 0, std::cos(0.2)};
  writer.document["nodes"][0]["translation"] = {12.3, 0.1, -7.7};
  const Model model = writer.load();
  // The scene moves to the same place by the placement's pose and by a parent node.
  const dvec3 utm(500000.0, 500000.0, 100.0);
  GltfWriter nodes = writer;
  const int top = nodes.append("nodes", {{"children", {0}}, {"translation", {utm.x, utm.z, -utm.y}}});
  nodes.document["scenes"][0]["nodes"] = {top};
  const Model node_model = nodes.load();
  ModelPlacement turned = placement_of(model, "a");
  turned.pose.orientation = orientation_from_yaw_pitch_roll(0.4, 0.1, -0.2);
  turned.pose.position = dvec3(3.25, -8.5, 1.125);
  ModelPlacement shifted = turned;
  shifted.pose.position += utm;
  const Scene near = build_scene({placement_of(model, "b"), turned}, {});
  ModelPlacement other = placement_of(model, "b");
  other.pose.position = utm;
  const Scene by_pose = build_scene({other, shifted}, {});
  const Scene by_node = build_scene({placement_of(node_model, "b"), shifted}, {});
  for (const Scene* far : {&by_pose, &by_node}) {
    EXPECT_EQ(far->origin, near.origin + utm);
    EXPECT_EQ(far->indices, near.indices);
    ASSERT_EQ(far->facet_triangles.size(), near.facet_triangles.size());
    ASSERT_EQ(far->facets.size(), near.facets.size());
    for (size_t index = 0; index < near.facet_triangles.size(); ++index) {
      for (int corner = 0; corner < 3; ++corner) {
        EXPECT_LE(glm::distance(far->facet_triangles[index].corners[corner],
                                near.facet_triangles[index].corners[corner]),
                  1e-9);
      }
    }
    for (size_t index = 0; index < near.facets.size(); ++index) {
      EXPECT_LE(glm::distance(far->facets[index].normal, near.facets[index].normal), 1e-9);
      EXPECT_NEAR(far->facets[index].offset, near.facets[index].offset, 1e-9);
    }
    for (size_t index = 0; index < near.positions.size(); ++index) {
      EXPECT_LE(glm::distance(far->positions[index], near.positions[index]), 2e-6f);  // one fp32 step at 16 m
    }
  }
  // A shift by the pose with numbers that fp64 holds exactly gives the same bits.
  EXPECT_EQ(by_pose.positions, near.positions);
}

TEST(HardCase, N07_TheOriginOfAHalfMetreCentreDoesNotFlip) {
  const Model model = quad().load();  // centre at x = 0.5, z = 0.5
  for (const double shift : {0.0, 0.1, 0.7, 500000.0, 499999.7, 4999999.9}) {
    ModelPlacement placement = placement_of(model);
    placement.pose.position = dvec3(shift, 0, 0);
    const Scene scene = build_scene({placement}, {});
    EXPECT_LE(std::abs(scene.origin.x - (shift + 0.5)), 0.5 + 1e-6);
    EXPECT_EQ(scene.origin.x, std::floor(scene.origin.x));
    EXPECT_EQ(scene.origin.z, 1.0);
  }
}

TEST(HardCase, N08_ATinyPartBesideALargeTileKeepsItsBounds) {
  const Model tile =
      quad({vec3(-5000, 0, 5000), vec3(5000, 0, 5000), vec3(5000, 0, -5000), vec3(-5000, 0, -5000)}).load();
  const Model part = box().load();
  ModelPlacement small = placement_of(part, "bolt");
  small.scale = dvec3(1e-4);
  small.pose.position = dvec3(1.5, 2.5, 3.5);
  const Scene scene = build_scene({placement_of(tile, "tile"), small}, {});
  expect_consistent(scene);
  EXPECT_EQ(scene.bounds.size().x, 10000.0);
  const Bounds& bounds = scene.instances.at(1).bounds;
  EXPECT_NEAR(bounds.size().x, 1e-4, 1e-12);
  EXPECT_NEAR(bounds.size().z, 1e-4, 1e-12);
  EXPECT_EQ(scene.facets.size(), 1u + 6u);  // no edge is shorter than the tolerance: six sides
  EXPECT_FALSE(has_note(scene.notes, "too small for fp32"));
  // Where fp32 cannot resolve the part any more, the loader notes it.
  small.pose.position = dvec3(4900.0, 4900.0, 0.0);
  EXPECT_TRUE(has_note(build_scene({placement_of(tile, "tile"), small}, {}).notes, "too small for fp32"));
}

TEST(HardCase, N14_NegativeScaleMendsWindingAndNormals) {
  for (const dvec3& scale :
       {dvec3(-1, 1, 1), dvec3(1, -2, 1), dvec3(-1, -1, -3), dvec3(-1, -1, 1), dvec3(2, 3, 0.5)}) {
    GltfWriter writer = box();
    writer.document["nodes"][0]["scale"] = {scale.x, scale.y, scale.z};
    const Scene by_node = build_one(writer);
    expect_consistent(by_node);
    EXPECT_NEAR(enclosed(by_node), 6.0 * std::abs(scale.x * scale.y * scale.z), 1e-9);
    const Model model = box().load();
    ModelPlacement placement = placement_of(model);
    placement.scale = scale;
    EXPECT_NEAR(enclosed(build_scene({placement}, at_zero())), 6.0 * std::abs(scale.x * scale.y * scale.z),
                1e-9);
  }
}

TEST(HardCase, N14_NonUniformScaleTurnsNormalsByTheInverseTranspose) {
  // A smooth-shaded slope has the plane's own normal. After any scale it must still have the plane's normal.
  const vec3 slope_normal = glm::normalize(vec3(-1, 1, 0));
  for (const dvec3& scale : {dvec3(4, 1, 1), dvec3(-4, 1, 1), dvec3(1, -0.25, 2), dvec3(-1, -1, -1)}) {
    GltfWriter writer;
    const json primitive = {{"attributes",
                             {{"POSITION", writer.vec3s({vec3(0, 0, 0), vec3(0, 0, 1), vec3(1, 1, 0)})},
                              {"NORMAL", writer.vec3s(std::vector<vec3>(3, slope_normal))}}},
                            {"material", writer.itu_material()}};
    writer.root(
        {{"mesh", writer.mesh("slope", json::array({primitive}))}, {"scale", {scale.x, scale.y, scale.z}}});
    const Scene scene = build_one(writer);
    expect_consistent(scene);
    EXPECT_NEAR(glm::distance(dvec3(scene.normals[0]), geometric_normal(scene, 0)), 0.0, 1e-6)
        << scale.x << ' ' << scale.y << ' ' << scale.z;
  }
}

}  // namespace
}  // namespace greatx::scene
