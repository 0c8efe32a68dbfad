// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks files that are broken, by accident or on purpose. Each is refused with a message that names file and
// mesh.
#include <cmath>
#include <limits>

#include "tests/scene/gltf_writer.h"
#include "tests/scene/png.h"

namespace greatx::scene {
namespace {

using test::expect_user_error;
using test::GltfWriter;
using test::has_note;
using test::json;
using test::TemporaryFolder;

GltfWriter itu_quad(const std::string& name = "wall") {
  GltfWriter writer;
  writer.add_triangles(name, test::unit_quad(), test::quad_indices(), writer.itu_material());
  return writer;
}

/// Expects that loading a good file after `change` fails with a message that contains `parts`.
void refuse(const std::function<void(GltfWriter&)>& change, std::vector<std::string> parts) {
  GltfWriter writer = itu_quad();
  EXPECT_NO_THROW(writer.load());
  change(writer);
  parts.emplace_back("test.glb");
  expect_user_error([&] { writer.load(); }, parts);
}

TEST(HostileFile, MissingEmptyAndForeign) {
  const TemporaryFolder folder;
  expect_user_error([&] { load_model(folder.path / "none.glb", {}); }, {"none.glb", "does not exist"});
  expect_user_error([&] { load_model(folder.path, {}); }, {"not a regular file"});
  expect_user_error([&] { load_model(folder.write("empty.gltf", ""), {}); }, {"empty.gltf", "empty"});
  expect_user_error([&] { load_model(folder.write("x.gltf", "{\"asset\": "), {}); },
                    {"x.gltf", "not valid JSON", "line 1"});
  expect_user_error([&] { load_model(folder.write("list.gltf", "[1, 2]"), {}); }, {"not an object"});
  expect_user_error([&] { load_model(folder.write("old.gltf", "{\"asset\": {\"version\": \"1.0\"}}"), {}); },
                    {"asset.version '1.0'"});
  expect_user_error([&] { load_model(folder.write("odd.gltf", "{\"asset\": {\"version\": 2}}"), {}); },
                    {"asset.version '2'"});
  expect_user_error([&] { load_model(folder.write("none.gltf", "{\"asset\": {\"version\": \"2.0\"}}"), {}); },
                    {"none.gltf", "places no mesh"});
  const std::string deep = "{\"asset\": {\"version\": \"2.0\"}, \"extras\": " + std::string(100000, '[') +
                           std::string(100000, ']') + "}";
  expect_user_error([&] { load_model(folder.write("deep.gltf", deep), {}); }, {"nested deeper"});
}

TEST(HostileFile, EveryTruncationOfAGlbIsRefused) {
  const std::vector<unsigned char> whole = itu_quad().glb();
  for (size_t size = 0; size < whole.size(); ++size) {
    const std::vector<unsigned char> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    expect_user_error([&] { GltfWriter::load_bytes(part); }, {"test.glb"});
  }
}

TEST(HostileFile, GlbHeadersThatLie) {
  const auto with_word = [](size_t offset, uint32_t word) {
    std::vector<unsigned char> bytes = itu_quad().glb();
    std::memcpy(bytes.data() + offset, &word, 4);
    return bytes;
  };
  expect_user_error([&] { GltfWriter::load_bytes(with_word(4, 1)); }, {"version 1"});
  expect_user_error([&] { GltfWriter::load_bytes(with_word(8, 0xFFFFFFFF)); },
                    {"truncated .glb", "4294967295"});
  expect_user_error([&] { GltfWriter::load_bytes(with_word(12, 0xFFFFFFF0)); },
                    {"truncated .glb", "chunk at byte 12"});
  expect_user_error([&] { GltfWriter::load_bytes(with_word(16, 0x004E4942)); }, {"first chunk is not JSON"});
}

TEST(HostileFile, UrisStayInTheFolder) {
  const TemporaryFolder folder;
  const std::filesystem::path inside = folder.path / "asset";
  GltfWriter writer = itu_quad();
  folder.write("secret.bin", writer.binary);
  folder.write("asset/wall.bin", writer.binary);
  std::filesystem::create_symlink(folder.path / "secret.bin", inside / "link.bin");
  std::filesystem::create_directory_symlink(folder.path, inside / "up");
  std::filesystem::create_symlink(inside / "wall.bin", inside / "good_link.bin");
  const auto load_uri = [&](const std::string& uri) {
    writer.document["buffers"] = json::array({{{"byteLength", writer.binary.size()}, {"uri", uri}}});
    return load_model(folder.write("asset/wall.gltf", writer.document.dump()), {});
  };
  for (const char* good : {"wall.bin", "./wall.bin", "%77all.bin", "good_link.bin"}) {
    EXPECT_NO_THROW(load_uri(good)) << good;
  }
  const std::string absolute = (folder.path / "secret.bin").string();
  for (const std::string& bad : {std::string("../secret.bin"),
                                 std::string("x/../../secret.bin"),
                                 std::string("%2e%2e/secret.bin"),
                                 std::string("..%2Fsecret.bin"),
                                 std::string("%2E%2E%2Fsecret.bin"),
                                 std::string("..\\secret.bin"),
                                 std::string("..%5csecret.bin"),
                                 absolute,
                                 std::string("%2F") + absolute.substr(1),
                                 "file://" + absolute,
                                 "file:" + absolute,
                                 std::string("http://localhost/wall.bin"),
                                 std::string("https://localhost/wall.bin"),
                                 std::string("//localhost/wall.bin"),
                                 std::string("C:\\wall.bin"),
                                 std::string("C:wall.bin"),
                                 std::string("~/wall.bin"),
                                 std::string("link.bin"),
                                 std::string("up/secret.bin"),
                                 std::string("wall.bin%00"),
                                 std::string("wall%2"),
                                 std::string("%zzwall.bin"),
                                 std::string("")}) {
    expect_user_error([&] { load_uri(bad); }, {"wall.gltf", "buffer 0"});
  }
  // Escapes are decoded once only: the URI names a file called "%2e%2e", which does not exist.
  expect_user_error([&] { load_uri("%252e%252e/secret.bin"); }, {"cannot be opened"});
  expect_user_error([&] { load_uri("none.bin"); }, {"wall.gltf", "none.bin", "cannot be opened"});
  std::filesystem::create_directory(inside / "folder.bin");
  expect_user_error([&] { load_uri("folder.bin"); }, {"not a regular file"});
  expect_user_error([&] { load_uri("data:text/html;base64,AAAA"); }, {"buffer 0", "data URI"});
}

TEST(HostileFile, ImageUrisStayInTheFolderToo) {
  const TemporaryFolder folder;
  folder.write("secret.png", test::encode_png(1, 1, {1, 2, 3, 4}));
  GltfWriter writer = itu_quad();
  writer.append("images", {{"uri", "../secret.png"}});
  std::filesystem::create_directory(folder.path / "asset");
  expect_user_error([&] { load_model(folder.write("asset/wall.glb", writer.glb()), {}); },
                    {"wall.glb", "image 0", "'..'"});
}

TEST(HostileFile, AssetsInMemoryHaveNoFolder) {
  refuse([](GltfWriter& writer) { writer.append("images", {{"uri", "wall.png"}}); }, {"image 0", "embedded"});
}

TEST(HostileFile, BufferViewsAndAccessorsOutOfRange) {
  const auto change = [](const char* list, size_t index, const char* key, json value,
                         std::vector<std::string> parts) {
    parts.emplace_back("mesh 'wall'");
    refuse([&](GltfWriter& writer) { writer.document[list][index][key] = value; }, parts);
  };
  constexpr uint64_t huge = std::numeric_limits<uint64_t>::max();
  // View and accessor 0 are the positions (4 x 12 bytes), 1 the indices (6 x 4).
  change("accessors", 0, "count", 5, {"accessor 0", "exceed buffer view 0"});
  change("accessors", 0, "count", huge, {"accessor 0", "exceed"});
  change("accessors", 0, "count", huge / 12 + 1, {"accessor 0", "exceed"});
  change("accessors", 0, "byteOffset", 4, {"accessor 0", "exceed"});
  change("accessors", 0, "byteOffset", huge, {"accessor 0", "exceed"});
  change("accessors", 0, "bufferView", 7, {"buffer view 7 does not exist"});
  change("accessors", 0, "type", "VEC2", {"expected VEC3"});
  change("accessors", 0, "componentType", 5130, {"component type 5130"});
  change("accessors", 1, "type", "VEC2", {"expected SCALAR"});
  change("accessors", 1, "componentType", 5126, {"component type 5126", "5121, 5123, 5125"});
  change("accessors", 1, "count", 7, {"accessor 1", "exceed"});
  change("accessors", 1, "count", 5, {"5 corners"});
  change("bufferViews", 0, "byteLength", huge, {"buffer view 0", "exceeds its buffer"});
  change("bufferViews", 0, "byteOffset", huge - 10, {"buffer view 0", "exceeds its buffer"});
  change("bufferViews", 0, "buffer", 3, {"buffer 3"});
  change("bufferViews", 0, "byteStride", 8, {"byteStride 8"});
  change("bufferViews", 0, "byteStride", 252, {"exceed"});
  const auto primitive = [](const char* key, json value, std::vector<std::string> parts) {
    parts.emplace_back("mesh 'wall', primitive 0");
    refuse([&](GltfWriter& writer) { writer.document["meshes"][0]["primitives"][0][key] = value; }, parts);
  };
  primitive("material", 4, {"material 4 does not exist"});
  primitive("mode", 9, {"mode 9"});
  primitive("attributes", {{"POSITION", 9}}, {"accessor 9 does not exist"});
  primitive("attributes", {{"NORMAL", 0}}, {"no POSITION"});
  primitive("attributes", {{"POSITION", 0}, {"NORMAL", 9}}, {"NORMAL", "accessor 9"});
}

TEST(HostileFile, SparseOutOfRange) {
  const auto change = [](json sparse, std::vector<std::string> parts) {
    refuse([&](GltfWriter& writer) { writer.document["accessors"][0]["sparse"] = sparse; }, parts);
  };
  const auto sparse = [](int count, int indices_view, int type, int values_view) {
    return json{{"count", count},
                {"indices", {{"bufferView", indices_view}, {"componentType", type}}},
                {"values", {{"bufferView", values_view}}}};
  };
  change(sparse(0, 1, 5125, 0), {"mesh 'wall'", "sparse count 0"});
  change(sparse(-3, 1, 5125, 0), {"accessors[0].sparse.count", "-3"});
  change(sparse(5, 1, 5125, 0), {"sparse count 5"});
  change(sparse(4, 9, 5125, 0), {"sparse indices", "buffer view 9"});
  change(sparse(4, 1, 5125, 9), {"sparse values", "buffer view 9"});
  change(sparse(4, 1, 5126, 0), {"sparse indices", "component type 5126"});
  change(sparse(4, 0, 5125, 0), {"sparse index 1065353216 is out of range"});
  refuse(
      [](GltfWriter& writer) {
        writer.document["accessors"][0] = {
            {"componentType", 5126}, {"count", uint64_t{1} << 60}, {"type", "VEC3"}};
      },
      {"mesh 'wall'", "without a buffer view"});
}

TEST(HostileFile, IndexOutOfRange) {
  GltfWriter writer;
  writer.add_triangles("roof", test::unit_quad(), {0, 1, 4}, writer.itu_material());
  expect_user_error([&] { writer.load(); },
                    {"test.glb: mesh 'roof', primitive 0", "index 4 at position 2", "4 vertices"});
}

TEST(HostileFile, EmptyMeshes) {
  refuse([](GltfWriter& writer) { writer.document["meshes"][0]["primitives"] = json::array(); },
         {"mesh 'wall' is empty"});
  refuse([](GltfWriter& writer) { writer.document["accessors"][0]["count"] = 0; },
         {"mesh 'wall'", "no vertices"});
  refuse([](GltfWriter& writer) { writer.document["accessors"][1]["count"] = 0; },
         {"mesh 'wall'", "0 corners"});
  refuse([](GltfWriter& writer) { writer.document["scenes"][0]["nodes"] = json::array(); },
         {"places no mesh"});
}

TEST(HostileFile, NodesThatDoNotMakeATree) {
  refuse([](GltfWriter& writer) { writer.document["nodes"][0]["children"] = {0}; }, {"node 'wall'", "cycle"});
  refuse(
      [](GltfWriter& writer) {
        writer.append("nodes", {{"name", "a"}, {"children", {2}}});
        writer.append("nodes", {{"name", "b"}, {"children", {1}}});
        writer.document["scenes"][0]["nodes"] = {0, 1};
      },
      {"node 'a'", "cycle"});
  refuse(
      [](GltfWriter& writer) {
        writer.append("nodes", {{"name", "a"}, {"children", {1}}});
        writer.document.erase("scenes");
        writer.document.erase("scene");
        writer.document["nodes"][0]["children"] = {0};
      },
      {"cycle"});
  refuse([](GltfWriter& writer) { writer.document["scenes"][0]["nodes"] = {0, 0}; }, {"reached twice"});
  refuse([](GltfWriter& writer) { writer.document["nodes"][0]["children"] = {5}; },
         {"node 5 does not exist"});
  refuse([](GltfWriter& writer) { writer.document["nodes"][0]["children"] = {-2}; },
         {"nodes[0].children", "[-2]"});
  refuse([](GltfWriter& writer) { writer.document["nodes"][0]["mesh"] = 3; }, {"node 'wall'", "mesh 3"});
  refuse([](GltfWriter& writer) { writer.document["scene"] = 2; }, {"scene 2 does not exist"});
}

TEST(HostileFile, AHundredThousandNodesDeep) {
  GltfWriter writer = itu_quad();
  json& nodes = writer.document["nodes"];
  for (int index = 1; index <= 100000; ++index) nodes.push_back({{"children", {index == 1 ? 0 : index - 1}}});
  writer.document["scenes"][0]["nodes"] = {100000};
  EXPECT_EQ(writer.load().instances.size(), 1u);
}

TEST(HostileFile, TransformsThatAreNone) {
  const auto change = [](const char* key, json value, std::vector<std::string> parts) {
    parts.emplace_back("node 'wall'");
    refuse([&](GltfWriter& writer) { writer.document["nodes"][0][key] = value; }, parts);
  };
  change("scale", {1, 0, 1}, {"singular"});
  change("scale", {1, 1}, {"scale", "expected 3"});
  change("rotation", {0, 0, 0, 0}, {"unit quaternion"});
  change("translation", {1, 2, 3, 4}, {"translation", "expected 3"});
  change("matrix", {1, 0, 0, 0}, {"matrix", "expected 16"});
  change("matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, {"not affine"});
}

TEST(HostileFile, Images) {
  const auto textured = [](const std::vector<unsigned char>& bytes) {
    GltfWriter writer;
    writer.append("images", {{"bufferView", writer.view(bytes)}, {"mimeType", "image/png"}});
    writer.append("textures", {{"source", 0}});
    const int material = writer.material(
        {{"name", "itu_wood"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    writer.add_triangles("wall", test::unit_quad(), test::quad_indices(), material);
    return writer;
  };
  const std::vector<unsigned char> png = test::encode_png(1, 1, {1, 2, 3, 4});
  EXPECT_NO_THROW(textured(png).load());
  GltfWriter broken = textured(png);
  broken.document["bufferViews"][0]["byteLength"] = 4000;
  expect_user_error([&] { broken.load(); }, {"test.glb", "image 0", "exceeds buffer 0"});
  broken.document["bufferViews"][0] = {{"buffer", 8}, {"byteLength", 4}};
  expect_user_error([&] { broken.load(); }, {"image 0"});
  broken = textured(png);
  broken.document["images"][0]["bufferView"] = 77;
  expect_user_error([&] { broken.load(); }, {"image 0", "out of range"});
  broken = textured(png);
  broken.document["textures"][0]["source"] = 5;
  expect_user_error([&] { broken.load(); }, {"material 'itu_wood', baseColorTexture", "source 5"});
  broken = textured(png);
  broken.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 5;
  expect_user_error([&] { broken.load(); }, {"material 'itu_wood'", "texture 5"});
  expect_user_error(
      [&] {
        textured({png.begin(), png.end() - 20}).load();
      },
      {"material 'itu_wood'", "PNG or JPEG"});
  expect_user_error([&] { textured({'G', 'I', 'F', '8'}).load(); }, {"PNG or JPEG"});
  std::vector<unsigned char> wide = png;
  wide[16] = 0x7F;  // a picture two thousand million pixels wide
  expect_user_error([&] { textured(wide).load(); }, {"16384"});
}

TEST(HostileFile, MaterialsAndLightsOutOfRange) {
  const auto material = [](json fields, std::vector<std::string> parts) {
    parts.emplace_back("material 'itu_concrete'");
    fields["name"] = "itu_concrete";
    refuse([&](GltfWriter& writer) { writer.document["materials"][0] = fields; }, parts);
  };
  material({{"pbrMetallicRoughness", {{"roughnessFactor", 1.5}}}}, {"roughnessFactor", "1.5"});
  const auto refuse_field = [](const char* key, json value, const std::string& part) {
    refuse([&](GltfWriter& writer) { writer.document["materials"][0][key] = value; }, {part});
  };
  refuse_field("pbrMetallicRoughness", {{"baseColorFactor", {1, 1}}}, "baseColorFactor");
  refuse_field("pbrMetallicRoughness", {{"metallicFactor", "shiny"}},
               "materials[0].pbrMetallicRoughness.metallicFactor: expected a number, found \"shiny\"");
  refuse_field("doubleSided", 1, "materials[0].doubleSided: expected true or false");
  refuse_field("emissiveFactor", {1, 1}, "emissiveFactor");
  material({{"alphaMode", "FOGGY"}}, {"FOGGY"});
  material({{"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", -1}}}}}},
           {"emissiveStrength"});
  refuse(
      [](GltfWriter& writer) {
        writer.document["nodes"][0]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
      },
      {"node 'wall'", "light 0 does not exist"});
}

TEST(HostileFile, RequiredExtensionsThatAreNotSupported) {
  refuse([](GltfWriter& writer) { writer.document["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
         {"KHR_draco_mesh_compression", "not supported"});
}

TEST(HostileFile, AnyJsonValueAnywhereIsSurvived) {
  // Every member of the document is replaced by every kind of value. The file is either loaded or refused.
  const json replacements = {nullptr,
                             true,
                             -1,
                             0,
                             3.5,
                             4294967296.0,
                             1e300,
                             "text",
                             json::array(),
                             json::object(),
                             json::array({1, "x", nullptr})};
  GltfWriter writer = itu_quad();
  writer.append("images",
                {{"uri", "data:image/png;base64," + test::base64(test::encode_png(1, 1, {1, 2, 3, 4}))}});
  writer.append("samplers", {{"wrapS", 33071}});
  writer.append("textures", {{"source", 0}, {"sampler", 0}});
  writer.document["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", 0}}},
                                                             {"baseColorFactor", {1, 1, 1, 1}}};
  writer.document["materials"][0]["extensions"] = {{"GREATX_radio_material", {{"itu", "wood"}}}};
  writer.document["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}}}}}}};
  writer.document["nodes"][0]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
  writer.document["nodes"][0]["translation"] = {0, 0, 0};
  const json flat = writer.document.flatten();
  std::vector<json::json_pointer> places;
  for (const auto& [path, value] : flat.items()) {
    for (json::json_pointer place(path); !place.empty(); place.pop_back()) {
      if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
    }
  }
  ASSERT_GT(places.size(), 50u);
  size_t refused = 0;
  for (const auto& place : places) {
    for (const json& replacement : replacements) {
      GltfWriter broken = writer;
      broken.document[place] = replacement;
      try {
        broken.load();
      } catch (const UserError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 100u);
}

TEST(HardCase, N13_NotANumberIsRefusedByName) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::vector<vec3> positions = test::unit_quad();
    positions[2].y = bad;
    GltfWriter writer;
    writer.add_triangles("facade", positions, test::quad_indices(), writer.itu_material());
    expect_user_error([&] { writer.load(); },
                      {"test.glb: mesh 'facade', primitive 0, POSITION", "vertex 2 is not finite"});
  }
}

TEST(HardCase, N13_ZeroAreaAndDuplicateVerticesAreDroppedByName) {
  std::vector<vec3> positions = test::unit_quad();
  positions.push_back(positions[0]);         // 4: the same place as 0
  positions.emplace_back(0.5f, 0.0f, 0.0f);  // 5: on the edge 0–1
  // The triangles are: good, repeated index, duplicate vertex, collinear, good.
  const std::vector<uint32_t> indices = {0, 1, 2, 0, 1, 1, 0, 4, 1, 0, 5, 1, 0, 2, 3};
  GltfWriter writer;
  writer.add_triangles("facade", positions, indices, writer.itu_material());
  const Model model = writer.load();
  EXPECT_EQ(model.meshes.at(0).primitives.at(0).indices, test::quad_indices());
  EXPECT_TRUE(has_note(model.notes, "mesh 'facade': 3 triangles of zero area are dropped"));

  GltfWriter nothing_else;
  nothing_else.add_triangles("facade", positions, {0, 4, 1, 0, 5, 1}, nothing_else.itu_material());
  expect_user_error([&] { nothing_else.load(); },
                    {"test.glb: mesh 'facade'", "nothing but 2 triangles of zero area"});
}

TEST(HardCase, N05_SliversAreKept) {
  const std::vector<vec3> positions = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0.5f, 1e-4f, 0),
                                       vec3(0.5f, 1e-30f, 0)};
  GltfWriter writer;
  writer.add_triangles("sliver", positions, {0, 1, 2, 0, 1, 3}, writer.itu_material());
  EXPECT_EQ(writer.load().meshes.at(0).primitives.at(0).indices.size(), 6u);
}

}  // namespace
}  // namespace greatx::scene
