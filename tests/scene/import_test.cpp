// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the import of scenes of Mitsuba 3 and Sionna RT: what is read, that the result passes through glTF
// unchanged, and what is refused.
#include <algorithm>
#include <fstream>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/files/scene_import.h"
#include "core/error.h"
#include "scene/build/build.h"
#include "scene/import/mitsuba.h"
#include "scene/import/ply_mesh.h"
#include "tests/support/temporary_folder.h"

namespace greatx::scene {
namespace {

using apps::imported_glb;
using apps::imported_sidecar;
using test::TemporaryFolder;
using testing::HasSubstr;

const std::string ascii_triangle =
    "ply\nformat ascii 1.0\ncomment a wall\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
    "float z\n"
    "property float u\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "-0.1 20.3 0.7 0\n1234.567 -3.25 1e-3 0.5\n7.7 8.8 9.9 1\n3 0 1 2\n";

class Folder {
 public:
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = folder_.path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }
  /// Writes a scene with these elements, and meshes/wall.ply.
  std::filesystem::path scene(const std::string& elements) const {
    write("meshes/wall.ply", ascii_triangle);
    return write("scene.xml", "<scene version=\"2.1.0\">\n" + elements + "</scene>\n");
  }
  ImportedScene import(const std::string& elements, const MitsubaOptions& options = {}) const {
    return import_mitsuba(scene(elements), options);
  }

 private:
  TemporaryFolder folder_;
};

std::string bsdf(const std::string& id, const std::string& type, const std::string& fields) {
  return "<bsdf type=\"" + type + "\" id=\"" + id + "\">" + fields + "</bsdf>\n";
}

std::string wall(const std::string& material, const std::string& more = "") {
  return "<shape type=\"ply\" id=\"mesh-wall\"><string name=\"filename\" value=\"meshes/wall.ply\"/><ref "
         "id=\"" +
         material + "\" name=\"bsdf\"/>" + more + "</shape>\n";
}

const std::string concrete = bsdf("mat-itu_concrete", "diffuse", "");

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

PlyMesh read_ply(const std::string& file) {
  return read_ply_mesh({reinterpret_cast<const unsigned char*>(file.data()), file.size()}, "x.ply");
}

template <typename T>
void put(std::string& out, T value, bool big_endian) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof(T));
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  out += bytes;
}

/// Returns two triangles as one quadrilateral, with doubles and with an element between them that must be
/// skipped.
std::string binary_quad(bool big_endian) {
  std::string file =
      std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
      "_endian 1.0\nelement vertex 4\nproperty double x\nproperty uchar red\nproperty double y\n"
      "property double z\nelement extra 1\nproperty list ushort short many\nproperty int one\n"
      "element face 1\nproperty list uint8 uint32 vertex_index\nend_header\n";
  for (const dvec3& p : {dvec3(0, 0, 0.1), dvec3(2, 0, 0), dvec3(2, 3, 0), dvec3(0, 3, -0.1)}) {
    put(file, p.x, big_endian);
    put(file, uint8_t{200}, big_endian);
    put(file, p.y, big_endian);
    put(file, p.z, big_endian);
  }
  put(file, uint16_t{2}, big_endian);
  put(file, int16_t{5}, big_endian);
  put(file, int16_t{6}, big_endian);
  put(file, int32_t{7}, big_endian);
  put(file, uint8_t{4}, big_endian);
  for (const uint32_t index : {0u, 1u, 2u, 3u}) put(file, index, big_endian);
  return file;
}

TEST(ImportPly, AsciiKeepsEveryFloat) {
  const PlyMesh mesh = read_ply(ascii_triangle);
  ASSERT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.positions[0], vec3(-0.1f, 20.3f, 0.7f));
  EXPECT_EQ(mesh.positions[1], vec3(1234.567f, -3.25f, 1e-3f));
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_TRUE(mesh.normals.empty());
}

TEST(ImportPly, BothByteOrdersAreTheSame) {
  for (const bool big_endian : {false, true}) {
    const PlyMesh mesh = read_ply(binary_quad(big_endian));
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions[0], vec3(0, 0, 0.1f));
    EXPECT_EQ(mesh.positions[3], vec3(0, 3, -0.1f));
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
  }
}

TEST(ImportPly, WhatIsWrongIsSaidWithItsPlace) {
  const auto with = [](std::string from, const std::string& to) {
    std::string file = ascii_triangle;
    file.replace(file.find(from), from.size(), to);
    return message_of([&] { read_ply(file); });
  };
  EXPECT_THAT(with("ply\n", "plx\n"), HasSubstr("x.ply:1: expected 'ply'"));
  EXPECT_THAT(with("ascii 1.0", "binary_middle_endian 1.0"), HasSubstr("x.ply:2: format"));
  EXPECT_THAT(with("float y", "floaty y"), HasSubstr("x.ply:6: unknown type 'floaty'"));
  EXPECT_THAT(with("end_header\n", "end\n"), HasSubstr("x.ply:11: expected format, element"));
  EXPECT_THAT(with("vertex 3", "vertex 99999999999"), HasSubstr("do not fit"));
  EXPECT_THAT(with("vertex 3", "vertex -3"), HasSubstr("expected 'element NAME COUNT'"));
  EXPECT_THAT(with("7.7 8.8 9.9 1", "7.7 nan 9.9 1"),
              HasSubstr("x.ply:14: vertex 2: y: expected a finite number"));
  EXPECT_THAT(with("7.7", "7.7m"), HasSubstr("x.ply:14: expected a number, found '7.7m'"));
  EXPECT_THAT(with("3 0 1 2\n", "3 0 1 3\n"),
              HasSubstr("x.ply:15: face 0: vertex index 3, but there are 3 vertices"));
  EXPECT_THAT(with("3 0 1 2\n", "3 0 1 -1\n"), HasSubstr("face 0: vertex index -1"));
  EXPECT_THAT(with("3 0 1 2\n", "5 0 1 2 0 1\n"), HasSubstr("face 0: expected 3 or 4 corners, found 5"));
  EXPECT_THAT(with("3 0 1 2\n", "3 0 1\n"), HasSubstr("the file ends early"));
  EXPECT_THAT(with("float z", "float height"), HasSubstr("x, y and z"));
  const std::string binary = binary_quad(false);
  EXPECT_THAT(message_of([&] { read_ply(binary.substr(0, binary.size() - 3)); }), HasSubstr("x.ply: byte "));
}

TEST(ImportMitsuba, WorldCoordinatesAreTheFilesToTheBit) {
  const Folder folder;
  const io::Bytes glb = imported_glb(folder.import(concrete + wall("mat-itu_concrete")), "scene");
  const Model model = load_model("scene.glb", glb, {});
  const Scene scene = build_scene({{"", &model, {}, dvec3(1.0), false, {}}}, {"scene.glb", dvec3(0.0)});
  ASSERT_EQ(scene.triangle_count(), 1u);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].name, "wall");
  const PlyMesh mesh = read_ply(ascii_triangle);
  for (size_t i = 0; i < 3; ++i)
    EXPECT_EQ(vec3(scene.positions.at(scene.indices.at(i))), mesh.positions[mesh.indices[i]]);
}

TEST(ImportMitsuba, EveryWayToNameAMaterial) {
  const Folder folder;
  const ImportedScene scene = folder.import(
      "<!-- exported -->\n<integrator type=\"path\"/>\n" +
          bsdf("mat-itu_wood.001", "twosided",
               "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.25, 0.5 0.75\"/></bsdf>") +
          bsdf("itu_concrete", "principled", "<float name=\"thickness\" value=\"0.3\"/>") +
          bsdf("box-mat", "itu-radio-material",
               "<string name=\"type\" value=\"metal\"/><float name=\"thickness\" value=\"1.\"/>"
               "<float name=\"scattering_coefficient\" value=\"0.2\"/><float name=\"xpd_coefficient\" "
               "value=\"0.1\"/>") +
          bsdf("mine", "radio-material",
               "<float name=\"relative_permittivity\" value=\"3\"/><float name=\"conductivity\" "
               "value=\"0.02\"/>"
               "<rgb name=\"color\" value=\"#ff0033\"/>") +
          bsdf("unused", "diffuse", "") + wall("mat-itu_wood.001") + wall("itu_concrete") + wall("box-mat") +
          wall("mine") + "<shape type=\"ply\"><string name=\"filename\" value=\"meshes/wall.ply\"/>" +
          bsdf("mat-itu_glass", "diffuse", "") + "</shape>",
      {0.2});
  ASSERT_EQ(scene.materials.size(), 5u);
  EXPECT_EQ(scene.materials[0].name, "itu_wood.001");
  EXPECT_EQ(scene.materials[0].base_color, vec3(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(scene.materials[0].radio_json, R"({"itu":"wood","thickness_m":0.2})");
  EXPECT_EQ(scene.materials[1].radio_json, R"({"itu":"concrete","thickness_m":0.3})");
  EXPECT_EQ(scene.materials[2].name, "box-mat");
  EXPECT_EQ(scene.materials[2].metallic, 1.0f);
  EXPECT_EQ(scene.materials[2].radio_json,
            R"({"itu":"metal","thickness_m":1.0,"scattering_coefficient":0.2,"cross_polarization":0.1})");
  EXPECT_EQ(scene.materials[3].radio_json,
            R"({"relative_permittivity":3.0,"conductivity":0.02,"thickness_m":0.2})");
  EXPECT_EQ(scene.materials[3].base_color, vec3(1.0f, 0.0f, 0.2f));
  EXPECT_EQ(scene.objects[4].name, "shape_5");
  EXPECT_EQ(scene.materials[4].name, "itu_glass");
}

TEST(ImportMitsuba, RadioPropertiesReachTheLoaderAndTheSidecarOverrulesThem) {
  const Folder folder;
  const ImportedScene imported = folder.import(concrete + wall("mat-itu_concrete"));
  const io::Bytes glb = imported_glb(imported, "scene");
  const RadioMaterial radio = *load_model("scene.glb", glb, {}).materials.at(0).radio;
  EXPECT_EQ(radio.layers.at(0).medium.source, "ITU-R P.2040-4 Table 3, concrete");
  EXPECT_EQ(radio.layers[0].thickness_m, 0.1);  // Sionna RT's value, which a note reports
  std::string text = imported_sidecar(imported, "scene.xml");
  text.replace(text.find("0.1"), 3, "0.4");
  LoadOptions options;
  options.radio_materials = folder.write("radio.yaml", text);
  EXPECT_EQ(load_model("scene.glb", glb, options).materials.at(0).radio->layers.at(0).thickness_m, 0.4);
}

TEST(ImportMitsuba, TransformsApplyInTheirOrder) {
  const Folder folder;
  const auto placed = [&](const std::string& steps) {
    return folder
        .import(concrete + wall("mat-itu_concrete", "<transform name=\"to_world\">" + steps + "</transform>"))
        .objects.at(0);
  };
  const auto near = [](const vec3& found, const dvec3& expected) {
    EXPECT_LT(glm::length(dvec3(found) - expected), 1e-6 * (1.0 + glm::length(expected)));
  };
  const dvec3 corner(vec3(7.7f, 8.8f, 9.9f));
  near(placed("<translate x=\"1\" z=\"2\"/><scale value=\"2\"/>").positions[2],
       2.0 * (corner + dvec3(1, 0, 2)));
  near(placed("<scale x=\"2\"/><translate value=\"1,2,3\"/>").positions[2],
       dvec3(2, 1, 1) * corner + dvec3(1, 2, 3));
  near(placed("<rotate z=\"1\" angle=\"90\"/>").positions[2], dvec3(-corner.y, corner.x, corner.z));
  near(placed("<matrix value=\"0 0 1 5  1 0 0 6  0 1 0 7  0 0 0 1\"/>").positions[2],
       dvec3(corner.z + 5, corner.x + 6, corner.y + 7));
  // A mirrored shape keeps its outer side.
  EXPECT_EQ(placed("<scale x=\"-1\"/>").indices, (std::vector<uint32_t>{0, 2, 1}));
  EXPECT_EQ(placed("<scale x=\"-1\" y=\"-1\"/>").indices, (std::vector<uint32_t>{0, 1, 2}));
}

TEST(ImportMitsuba, NormalsAreTheFilesUnlessFacesAreFlat) {
  const Folder folder;
  std::string ply = ascii_triangle;
  const auto swap = [&](const std::string& from, const std::string& to) {
    ply.replace(ply.find(from), from.size(), to);
  };
  swap("property float u\n", "property float nx\nproperty float ny\nproperty float nz\n");
  swap("0.7 0\n", "0.7 0 0 2\n");
  swap("1e-3 0.5\n", "1e-3 0 3 0\n");
  swap("9.9 1\n", "9.9 1 0 0\n");
  folder.write("meshes/smooth.ply", ply);
  const auto shape = [](const std::string& more) {
    return "<shape type=\"ply\" id=\"s\"><string name=\"filename\" value=\"meshes/smooth.ply\"/>"
           "<ref id=\"mat-itu_concrete\"/>" +
           more + "</shape>";
  };
  const auto object = [&](const std::string& more) {
    return folder.import(concrete + shape(more)).objects.at(0);
  };
  EXPECT_EQ(object("").normals, (std::vector<vec3>{vec3(0, 0, 1), vec3(0, 1, 0), vec3(1, 0, 0)}));
  EXPECT_TRUE(object("<boolean name=\"face_normals\" value=\"true\"/>").normals.empty());
  const ImportedObject flipped = object("<boolean name=\"flip_normals\" value=\"true\"/>");
  EXPECT_EQ(flipped.normals[0], vec3(0, 0, -1));
  EXPECT_EQ(flipped.indices, (std::vector<uint32_t>{0, 2, 1}));
  // Under non-uniform scale, normals follow the inverse transpose.
  EXPECT_EQ(object("<transform name=\"to_world\"><scale z=\"4\"/></transform>").normals[0], vec3(0, 0, 1));
}

TEST(ImportMitsuba, NestingIsBounded) {
  const Folder folder;
  const auto nested = [&](int depth) {
    std::string text;
    for (int i = 0; i < depth; ++i) text += "<shape type=\"merge\">\n";
    text += wall("mat-itu_concrete");
    for (int i = 0; i < depth; ++i) text += "</shape>\n";
    return concrete + text;
  };
  EXPECT_EQ(folder.import(nested(40)).objects.size(), 1u);
  EXPECT_THAT(message_of([&] { folder.import(nested(20000)); }),
              testing::AllOf(HasSubstr("scene.xml:"), HasSubstr("expected elements nested 64 deep at most")));
}

TEST(ImportMitsuba, IdsAreUtf8AndATerminalObeysNone) {
  const Folder folder;
  EXPECT_THAT(message_of([&] { folder.import(concrete + "<shape type=\"ply\" id=\"mesh-\xff\"/>"); }),
              HasSubstr("scene.xml:3: expected UTF-8, found the byte 0xff in 'mesh-\\xff'"));
  EXPECT_THAT(message_of([&] { folder.import(concrete + "<shape type=\"obj\" id=\"a&#10;&#27;[2J\"/>"); }),
              HasSubstr("shape 'a\\u000a\\u001b[2J': expected the type ply"));
  // In Latin 1 the byte is a letter.
  const auto file = folder.scene(concrete + wall("mat-itu_concrete"));
  folder.write("scene.xml", "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n<scene version=\"2.1.0\">" +
                                concrete +
                                "<shape type=\"ply\" id=\"mesh-\xe4\"><string name=\"filename\" "
                                "value=\"meshes/wall.ply\"/><ref id=\"mat-itu_concrete\"/></shape></scene>");
  EXPECT_EQ(import_mitsuba(file, {}).objects.at(0).name, "\xc3\xa4");
}

TEST(ImportMitsuba, WhatIsWrongIsSaidWithItsLine) {
  const Folder folder;
  const auto error = [&](const std::string& elements) {
    return message_of([&] { folder.import(elements); });
  };
  EXPECT_THAT(error("<shape>\n"), HasSubstr("scene.xml:"));
  EXPECT_THAT(error(""), HasSubstr("no shapes"));
  EXPECT_THAT(error(concrete + "<shape type=\"obj\" id=\"mesh-roof\"/>"),
              HasSubstr("scene.xml:3: shape 'mesh-roof': expected the type ply, found 'obj'"));
  EXPECT_THAT(error(wall("nothing")),
              HasSubstr("scene.xml:2: shape 'mesh-wall': there is no <bsdf> with the id"));
  EXPECT_THAT(error(bsdf("paint", "diffuse", "") + wall("paint")),
              HasSubstr("material 'paint': a BSDF of type 'diffuse'"));
  EXPECT_THAT(error(bsdf("itu_cheese", "diffuse", "") + wall("itu_cheese")), HasSubstr("found 'cheese'"));
  EXPECT_THAT(error(bsdf("x", "itu-radio-material", "") + wall("x")),
              HasSubstr("expected <string name=\"type\">"));
  EXPECT_THAT(error(bsdf("itu_wood", "x", "<float name=\"thickness\" value=\"0\"/>") + wall("itu_wood")),
              HasSubstr("thickness: expected metres above 0"));
  EXPECT_THAT(error(bsdf("itu_wood", "x", "<float name=\"thickness\" value=\"$t\"/>") + wall("itu_wood")),
              HasSubstr("parameters are not supported"));
  EXPECT_THAT(error(concrete + concrete + wall("mat-itu_concrete")),
              HasSubstr("scene.xml:3: a second <bsdf>"));
  EXPECT_THAT(error(concrete + "<shape type=\"ply\" id=\"m\"><ref id=\"mat-itu_concrete\"/></shape>"),
              HasSubstr("expected <string name=\"filename\">"));
  const auto transform = [&](const std::string& step) {
    return error(concrete +
                 wall("mat-itu_concrete", "<transform name=\"to_world\">" + step + "</transform>"));
  };
  EXPECT_THAT(transform("<lookat/>"),
              HasSubstr("expected translate, rotate, scale or matrix, found 'lookat'"));
  EXPECT_THAT(transform("<scale value=\"0\"/>"), HasSubstr("singular"));
  EXPECT_THAT(transform("<scale value=\"1e300\"/>"), HasSubstr("scene.xml:3"));
  EXPECT_THAT(transform("<matrix value=\"1 2 3\"/>"), HasSubstr("expected 16 or 9 numbers, found 3"));
  for (const char* name : {"missing.ply", "../meshes/wall.ply", "/etc/passwd"})
    EXPECT_THAT(error(concrete + "<shape type=\"ply\" id=\"m\">\n<string name=\"filename\" value=\"" + name +
                      "\"/><ref id=\"mat-itu_concrete\"/></shape>"),
                HasSubstr("scene.xml:4: shape 'm'"));
  EXPECT_THAT(message_of([&] { import_mitsuba(folder.scene(""), {0.0}); }), HasSubstr("thickness"));
}

}  // namespace
}  // namespace greatx::scene
