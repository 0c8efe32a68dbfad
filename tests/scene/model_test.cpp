// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/model.h"

#include "tests/scene/gltf_writer.h"
#include "tests/scene/png.h"

namespace greatx::scene {
namespace {

using test::GltfWriter;
using test::has_note;
using test::json;
using test::TemporaryFolder;

dvec3 placed(const ModelInstance& instance, const dvec3& point) {
  return dvec3(instance.model_from_mesh * dvec4(point, 1.0));
}

void expect_near(const dvec3& actual, const dvec3& expected, double tolerance = 1e-12) {
  EXPECT_NEAR(glm::distance(actual, expected), 0.0, tolerance)
      << actual.x << ' ' << actual.y << ' ' << actual.z << " instead of " << expected.x << ' ' << expected.y
      << ' ' << expected.z;
}

TEST(Model, YUpBecomesZUp) {
  GltfWriter writer;
  writer.add_triangles("wall", test::unit_quad(), test::quad_indices(), writer.itu_material());
  const Model model = writer.load();
  ASSERT_EQ(model.instances.size(), 1u);
  // The axes are x east, y north = -z, z up = y.
  expect_near(placed(model.instances[0], {1, 0, 0}), {1, 0, 0});
  expect_near(placed(model.instances[0], {0, 1, 0}), {0, 0, 1});
  expect_near(placed(model.instances[0], {0, 0, 1}), {0, -1, 0});
}

TEST(Model, HierarchyInDoublePrecision) {
  GltfWriter writer;
  const int material = writer.itu_material();
  const int leaf = writer.add_triangles("leaf", test::unit_quad(), test::quad_indices(), material);
  writer.document["nodes"][static_cast<size_t>(leaf)]["scale"] = {2, 3, -4};
  writer.document["scenes"][0]["nodes"] = json::array();
  // A quarter turn about y takes x to -z. A matrix moves by 5e5 m; a translation adds 1 mm.
  const int turned = writer.append("nodes", {{"rotation", {0, 0.70710678118654752, 0, 0.70710678118654752}},
                                             {"translation", {0, 0, 0.001}},
                                             {"children", {leaf}}});
  writer.root({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 500000, 10, 0, 1}}, {"children", {turned}}});
  const Model model = writer.load();
  ASSERT_EQ(model.instances.size(), 1u);
  // (1, 1, 1) -> scaled (2, 3, -4) -> turned (-4, 3, -2) -> moved (499996, 13, -1.999) -> z up.
  expect_near(placed(model.instances[0], {1, 1, 1}), {499996, 1.999, 13}, 1e-9);
}

TEST(Model, OneMeshPlacedTwice) {
  GltfWriter writer;
  writer.add_triangles("one", test::unit_quad(), test::quad_indices(), writer.itu_material());
  writer.root({{"name", "two"}, {"mesh", 0}, {"translation", {5, 0, 0}}});
  const Model model = writer.load();
  EXPECT_EQ(model.meshes.size(), 1u);
  ASSERT_EQ(model.instances.size(), 2u);
  EXPECT_EQ(model.instances[1].name, "two");
  expect_near(placed(model.instances[1], {0, 0, 0}), {5, 0, 0});
}

TEST(Model, MissingIndicesNormalsAndUvs) {
  GltfWriter writer;
  const int positions = writer.vec3s({vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)});
  const json primitive = {{"attributes", {{"POSITION", positions}}}, {"material", writer.itu_material()}};
  writer.root({{"mesh", writer.mesh("soup", json::array({primitive}))}});
  const Model model = writer.load();
  const ModelPrimitive& read = model.meshes.at(0).primitives.at(0);
  EXPECT_EQ(read.indices, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_TRUE(read.normals.empty());
  EXPECT_TRUE(read.uvs.empty());
  EXPECT_EQ(model.instances[0].name, "soup");  // an unnamed node takes its mesh's name
}

std::vector<uint32_t> unrolled(int mode) {
  GltfWriter writer;
  const int positions =
      writer.vec3s({vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(1, 2, 0), vec3(-1, 2, 0)});
  const json primitive = {
      {"attributes", {{"POSITION", positions}}}, {"material", writer.itu_material()}, {"mode", mode}};
  writer.root({{"mesh", writer.mesh("strip", json::array({primitive}))}});
  return writer.load().meshes.at(0).primitives.at(0).indices;
}

TEST(Model, StripsAndFansKeepTheirWinding) {
  // glTF 2.0, section 3.7.2.1: strip p_i = {v_i, v_(i+1+i%2), v_(i+2-i%2)}, fan p_i = {v_(i+1), v_(i+2),
  // v_0}.
  EXPECT_EQ(unrolled(5), (std::vector<uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  EXPECT_EQ(unrolled(6), (std::vector<uint32_t>{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST(Model, PointsAndLinesAreSkippedWithANote) {
  GltfWriter writer;
  writer.add_triangles("wall", test::unit_quad(), test::quad_indices(), writer.itu_material());
  const int positions = writer.vec3s(test::unit_quad());
  const json lines = {{"attributes", {{"POSITION", positions}}}, {"mode", 1}};
  writer.root({{"mesh", writer.mesh("wires", json::array({lines, lines}))}});
  const Model model = writer.load();
  EXPECT_EQ(model.instances.size(), 1u);
  EXPECT_TRUE(has_note(model.notes, "mesh 'wires': 2 primitives of points or lines are skipped"));
}

TEST(Model, IndexTypes) {
  for (const int type : {5121, 5123, 5125}) {
    GltfWriter writer;
    const int indices = type == 5121   ? writer.indices8({0, 1, 2})
                        : type == 5123 ? writer.indices16({0, 1, 2})
                                       : writer.indices32({0, 1, 2});
    const json primitive = {{"attributes", {{"POSITION", writer.vec3s(test::unit_quad())}}},
                            {"indices", indices},
                            {"material", writer.itu_material()}};
    writer.root({{"mesh", writer.mesh("m", json::array({primitive}))}});
    EXPECT_EQ(writer.load().meshes.at(0).primitives.at(0).indices, (std::vector<uint32_t>{0, 1, 2})) << type;
  }
}

TEST(Model, NormalizedIntegersAndStrides) {
  GltfWriter writer;
  // UVs are normalized unsigned shorts, interleaved with four other bytes.
  const std::vector<uint16_t> uv_values = {0, 65535, 7, 7, 65535, 0, 7, 7, 32768, 16384, 7, 7};
  const int uvs = writer.accessor(uv_values, "VEC2", 5123, 3);
  writer.document["accessors"][static_cast<size_t>(uvs)]["normalized"] = true;
  writer.document["bufferViews"].back()["byteStride"] = 8;
  // Normals are normalized signed bytes. -128 is clamped to -1.
  const std::vector<int8_t> normal_values = {0, 0, 127, 0, 0, 0, -128, 0, 0, 127, 0, 0};
  const int normals = writer.accessor(normal_values, "VEC3", 5120, 3);
  writer.document["accessors"][static_cast<size_t>(normals)]["normalized"] = true;
  writer.document["bufferViews"].back()["byteStride"] = 4;
  const int positions = writer.vec3s({vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)});
  const json primitive = {{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}}},
                          {"material", writer.itu_material()}};
  writer.root({{"mesh", writer.mesh("m", json::array({primitive}))}});
  const Model model = writer.load();
  const ModelPrimitive& read = model.meshes.at(0).primitives.at(0);
  EXPECT_EQ(read.uvs.at(0), vec2(0.0f, 1.0f));
  EXPECT_EQ(read.uvs.at(1), vec2(1.0f, 0.0f));
  EXPECT_EQ(read.uvs.at(2), vec2(32768.0f / 65535.0f, 16384.0f / 65535.0f));
  EXPECT_EQ(read.normals.at(0), vec3(0, 0, 1));
  EXPECT_EQ(read.normals.at(1), vec3(0, 0, -1));
  EXPECT_EQ(read.normals.at(2), vec3(0, 1, 0));
}

TEST(Model, SparseAccessor) {
  for (const bool dense : {true, false}) {
    GltfWriter writer;
    int positions = 0;
    if (dense) {
      positions = writer.vec3s({vec3(0, 0, 0), vec3(1, 0, 0), vec3(9, 9, 9)});
    } else {
      positions = writer.append("accessors", {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    }
    const std::vector<uint16_t> where = {1, 2};
    const std::vector<vec3> values = {vec3(2, 0, 0), vec3(0, 2, 0)};
    const auto bytes_of = [](const auto& list) {
      return std::span(reinterpret_cast<const unsigned char*>(list.data()), list.size() * sizeof(list[0]));
    };
    writer.document["accessors"][static_cast<size_t>(positions)]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", writer.view(bytes_of(where))}, {"componentType", 5123}}},
        {"values", {{"bufferView", writer.view(bytes_of(values))}}}};
    const json primitive = {{"attributes", {{"POSITION", positions}}}, {"material", writer.itu_material()}};
    writer.root({{"mesh", writer.mesh("m", json::array({primitive}))}});
    const Model model = writer.load();
    EXPECT_EQ(model.meshes.at(0).primitives.at(0).positions,
              (std::vector<vec3>{vec3(0, 0, 0), vec3(2, 0, 0), vec3(0, 2, 0)}));
  }
}

TEST(Model, MaterialFactorsAndAlpha) {
  GltfWriter writer;
  const auto add = [&](json fields) {
    fields["name"] =
        fmt::format("itu_concrete.{:03}", writer.document.value("materials", json::array()).size());
    writer.add_triangles("m", test::unit_quad(), test::quad_indices(), writer.material(fields));
  };
  add({{"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.25}, {"roughnessFactor", 0.75}}},
       {"emissiveFactor", {0.5, 0.25, 1.0}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8.0}}}}},
       {"doubleSided", true}});
  add({{"alphaMode", "MASK"}, {"alphaCutoff", 0.3}});
  add({{"alphaMode", "BLEND"}});
  add({{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.25}}}}});
  add({{"alphaMode", "BLEND"},
       {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.25}}}},
       {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}}}}});
  const Model model = writer.load();
  ASSERT_EQ(model.materials.size(), 5u);
  const PbrMaterial& first = model.materials[0].pbr;
  EXPECT_EQ(first.base_color, vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(first.metallic, 0.25f);
  EXPECT_EQ(first.roughness, 0.75f);
  EXPECT_EQ(first.emissive, vec3(4.0f, 2.0f, 8.0f));
  EXPECT_TRUE(first.double_sided);
  EXPECT_EQ(first.alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(model.materials[1].pbr.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(model.materials[1].pbr.alpha_cutoff, 0.3f);
  EXPECT_FALSE(model.materials[1].pbr.double_sided);
  EXPECT_EQ(model.materials[2].pbr.alpha_mode, AlphaMode::opaque);
  EXPECT_TRUE(has_note(model.notes, "BLEND is treated as OPAQUE"));
  EXPECT_EQ(first.transmission, 0.0f);  // alpha of an opaque material is ignored
  EXPECT_EQ(model.materials[2].pbr.transmission, 0.0f);
  EXPECT_EQ(model.materials[3].pbr.transmission, 0.75f);
  EXPECT_EQ(model.materials[4].pbr.transmission, 0.5f);
  for (const json& factor : {json(1.5), json(-0.1), json("half")}) {
    GltfWriter bad;
    bad.add_triangles(
        "m", test::unit_quad(), test::quad_indices(),
        bad.material({{"name", "itu_glass"},
                      {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", factor}}}}}}));
    EXPECT_THROW(bad.load(), UserError) << factor;
  }
}

/// Writes a textured quad with the image `image`.
GltfWriter textured(json image) {
  GltfWriter writer;
  writer.append("images", std::move(image));
  writer.append("samplers", {{"wrapS", 33071}, {"wrapT", 10497}});
  writer.append("textures", {{"source", 0}, {"sampler", 0}});
  writer.append("textures", {{"source", 0}});
  const int material =
      writer.material({{"name", "itu_wood"},
                       {"pbrMetallicRoughness",
                        {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}},
                       {"normalTexture", {{"index", 1}, {"scale", 0.5}}},
                       {"emissiveTexture", {{"index", 0}}},
                       {"alphaMode", "BLEND"}});
  writer.add_triangles("wall", test::unit_quad(), test::quad_indices(), material);
  return writer;
}

void expect_textures(const Model& model) {
  ASSERT_EQ(model.textures.size(), 2u);  // once as colour, once as data
  const PbrMaterial& pbr = model.materials.at(0).pbr;
  EXPECT_EQ(pbr.base_color_texture, pbr.emissive_texture);
  EXPECT_EQ(pbr.metallic_roughness_texture, pbr.normal_texture);
  EXPECT_NE(pbr.base_color_texture, pbr.normal_texture);
  EXPECT_EQ(pbr.normal_scale, 0.5f);
  const Texture& color = model.textures.at(static_cast<size_t>(pbr.base_color_texture));
  EXPECT_TRUE(color.srgb);
  EXPECT_FALSE(color.repeat_u);
  EXPECT_TRUE(color.repeat_v);
  const Texture& data = model.textures.at(static_cast<size_t>(pbr.normal_texture));
  EXPECT_FALSE(data.srgb);
  EXPECT_TRUE(data.repeat_u);
  EXPECT_EQ(color.width, 2u);
  EXPECT_EQ(color.height, 1u);
  EXPECT_EQ(color.rgba, (std::vector<uint8_t>{255, 0, 0, 255, 0, 128, 255, 64}));
  EXPECT_EQ(pbr.alpha_mode, AlphaMode::mask);
  EXPECT_TRUE(has_note(model.notes, "BLEND is treated as MASK"));
}

const std::vector<uint8_t> two_pixels = {255, 0, 0, 255, 0, 128, 255, 64};

TEST(Model, TexturesFromABufferView) {
  const std::vector<unsigned char> png = test::encode_png(2, 1, two_pixels);
  GltfWriter writer = textured({{"mimeType", "image/png"}});
  writer.document["images"][0]["bufferView"] = writer.view(png);
  expect_textures(writer.load());
}

TEST(Model, TexturesFromADataUri) {
  const std::string uri = "data:image/png;base64," + test::base64(test::encode_png(2, 1, two_pixels));
  expect_textures(textured({{"uri", uri}}).load());
}

TEST(Model, GltfWithExternalFiles) {
  const TemporaryFolder folder;
  folder.write("maps/wall picture+1.png", test::encode_png(2, 1, two_pixels));
  GltfWriter writer = textured({{"uri", "maps/wall%20picture+1.png"}});
  auto padded = writer.binary;
  padded.resize(padded.size() + 3);  // files may be longer than the buffer declares
  folder.write("street.bin", padded);
  writer.document["buffers"] = json::array({{{"byteLength", writer.binary.size()}, {"uri", "./street.bin"}}});
  const Model model = load_model(folder.write("street.gltf", writer.document.dump(2)), {});
  expect_textures(model);
  EXPECT_EQ(model.meshes.at(0).primitives.at(0).positions, test::unit_quad());
  EXPECT_EQ(model.file, folder.path / "street.gltf");
}

TEST(Model, GlbWithAnExternalImage) {
  const TemporaryFolder folder;
  folder.write("wall.png", test::encode_png(2, 1, two_pixels));
  expect_textures(load_model(folder.write("wall.glb", textured({{"uri", "wall.png"}}).glb()), {}));
}

TEST(Model, SecondUvSetIsReadWhereTheMaterialAsksForIt) {
  GltfWriter writer;
  writer.append("images",
                {{"uri", "data:image/png;base64," + test::base64(test::encode_png(2, 1, two_pixels))}});
  writer.append("textures", {{"source", 0}});
  const int material =
      writer.material({{"name", "itu_wood"},
                       {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}});
  const json primitive = {{"attributes",
                           {{"POSITION", writer.vec3s({vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)})},
                            {"TEXCOORD_0", writer.vec2s({vec2(9, 9), vec2(9, 9), vec2(9, 9)})},
                            {"TEXCOORD_1", writer.vec2s({vec2(0, 0), vec2(1, 0), vec2(0, 1)})}}},
                          {"material", material}};
  writer.root({{"mesh", writer.mesh("m", json::array({primitive}))}});
  EXPECT_EQ(writer.load().meshes.at(0).primitives.at(0).uvs.at(1), vec2(1, 0));
}

TEST(Model, PunctualLights) {
  GltfWriter writer;
  writer.add_triangles("wall", test::unit_quad(), test::quad_indices(), writer.itu_material());
  writer.document["extensions"] = {{"KHR_lights_punctual",
                                    {{"lights",
                                      {{{"type", "spot"},
                                        {"name", "bulb"},
                                        {"color", {1.0, 0.5, 0.25}},
                                        {"intensity", 120.0},
                                        {"range", 15.0},
                                        {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
                                       {{"type", "directional"}, {"intensity", 3.0}}}}}}};
  // A quarter turn about x, backwards, makes -z of the node point down (-y).
  const double half = 0.70710678118654752;
  writer.root({{"name", "lamp"},
               {"translation", {1, 6, 2}},
               {"rotation", {-half, 0, 0, half}},
               {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  writer.root({{"name", "sun"}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  const Model model = writer.load();
  ASSERT_EQ(model.lights.size(), 2u);
  const PunctualLight& spot = model.lights[0];
  EXPECT_EQ(spot.type, PunctualLight::Type::spot);
  EXPECT_EQ(spot.name, "bulb");
  expect_near(spot.position, {1, -2, 6});
  expect_near(spot.direction, {0, 0, -1});
  EXPECT_EQ(spot.color, vec3(1.0f, 0.5f, 0.25f));
  EXPECT_EQ(spot.intensity, 120.0f);
  EXPECT_EQ(spot.range_m, 15.0f);
  EXPECT_EQ(spot.inner_cone, 0.25f);
  EXPECT_EQ(spot.outer_cone, 0.5f);
  EXPECT_EQ(spot.beam, PunctualLight::Beam::cone);
  EXPECT_EQ(model.lights[1].type, PunctualLight::Type::directional);
  EXPECT_EQ(model.lights[1].name, "sun");
  expect_near(model.lights[1].direction, {0, 1, 0});  // -z is north
}

TEST(Model, ALightMayHaveAPassingBeam) {
  const auto load = [](const char* type, const json& beam) {
    GltfWriter writer;
    writer.add_triangles("wall", test::unit_quad(), test::quad_indices(), writer.itu_material());
    writer.document["extensions"] = {
        {"KHR_lights_punctual",
         {{"lights", {{{"type", type}, {"spot", json::object()}, {"extras", {{"greatx_beam", beam}}}}}}}}};
    writer.root({{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    return writer.load().lights.at(0);
  };
  EXPECT_EQ(load("spot", "passing").beam, PunctualLight::Beam::passing);
  for (const auto& [type, beam] :
       std::vector<std::pair<const char*, json>>{{"spot", "driving"}, {"spot", 1}, {"point", "passing"}}) {
    try {
      load(type, beam);
      FAIL() << "no error of " << type << " " << beam;
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("light 'lamp': extras.greatx_beam: expected"));
    }
  }
}

SemanticClass class_named(const std::string& name) {
  GltfWriter writer;
  writer.add_triangles(name, test::unit_quad(), test::quad_indices(), writer.itu_material());
  return writer.load().instances.at(0).semantic_class;
}

TEST(Model, SemanticClassFromNames) {
  using enum SemanticClass;
  EXPECT_EQ(class_named("building_H_withoutBase"), building);
  EXPECT_EQ(class_named("road_junction"), road);
  EXPECT_EQ(class_named("Plane"), ground);
  EXPECT_EQ(class_named("bush"), vegetation);
  EXPECT_EQ(class_named("Trees.012"), vegetation);
  EXPECT_EQ(class_named("car_taxi_wheel_front_left"), vehicle);
  EXPECT_EQ(class_named("hatchback"), vehicle);
  EXPECT_EQ(class_named("StreetLamp_3"), street_lamp);
  EXPECT_EQ(class_named("street_lamp"), street_lamp);
  EXPECT_EQ(class_named("uav-small"), uav);
  EXPECT_EQ(class_named("element_001-itu_marble"), building);
  EXPECT_EQ(class_named("HSBC-itu_metal"), building);
  EXPECT_EQ(class_named("cardboard"), unlabeled);
}

TEST(Model, SemanticClassFromExtrasAndParents) {
  GltfWriter writer;
  const int material = writer.itu_material();
  const auto leaf = static_cast<size_t>(
      writer.add_triangles("Cube.001", test::unit_quad(), test::quad_indices(), material));
  writer.document["scenes"][0]["nodes"] = json::array();
  writer.root({{"name", "thing"}, {"extras", {{"greatx_class", "mast"}}}, {"children", {leaf}}});
  EXPECT_EQ(writer.load().instances.at(0).semantic_class, SemanticClass::mast);
  writer.document["nodes"][leaf]["extras"] = {{"greatx_class", "roof"}};  // the nearer class wins
  EXPECT_EQ(writer.load().instances.at(0).semantic_class, SemanticClass::roof);
  writer.document["nodes"][leaf]["extras"] = {{"greatx_class", "castle"}};
  test::expect_user_error([&] { writer.load(); }, {"node 'Cube.001'", "castle", "building"});
}

TEST(Model, UnlabeledObjectsAreNoted) {
  GltfWriter writer;
  writer.add_triangles("Cube.001", test::unit_quad(), test::quad_indices(), writer.itu_material());
  EXPECT_TRUE(has_note(writer.load().notes, "1 objects have no semantic class"));
}

TEST(Model, WhatIsNotLoadedIsNoted) {
  GltfWriter writer;
  writer.add_triangles("wall", test::unit_quad(), test::quad_indices(), writer.itu_material());
  writer.mesh("spare", json::array({{{"attributes", {{"POSITION", 0}}}}}));
  writer.document["extensionsUsed"] = {"KHR_texture_transform", "GREATX_radio_material"};
  writer.document["nodes"][0]["skin"] = 0;
  const Model model = writer.load();
  EXPECT_TRUE(has_note(model.notes, "1 meshes are placed by no node"));
  EXPECT_TRUE(has_note(model.notes, "ignored: KHR_texture_transform"));
  EXPECT_TRUE(has_note(model.notes, "skin is ignored"));
}

}  // namespace
}  // namespace greatx::scene
