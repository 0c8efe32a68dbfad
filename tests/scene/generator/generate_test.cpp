// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/generate.h"

#include <cstring>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "scene/build/build.h"
#include "scene/generator/city/city.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/mesh/mesh_builder.h"
#include "scene/generator/paint/lettering.h"
#include "scene/generator/paint/textures.h"
#include "tests/scene/generator/soup.h"

namespace greatx::scene {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string message_of(const GenerateOptions& options) {
  try {
    generate_glb(options);
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Generate, SameSeedSameBytesOtherSeedOtherBytes) {
  for (const char* kind : {"city", "country", "canyon"}) {
    const auto first = generate_glb({.kind = kind, .seed = 7, .size_m = 200});
    EXPECT_EQ(first, generate_glb({.kind = kind, .seed = 7, .size_m = 200})) << kind;
    EXPECT_NE(first, generate_glb({.kind = kind, .seed = 8, .size_m = 200})) << kind;
    EXPECT_NE(first, generate_glb({.kind = kind, .seed = 7ull + (1ull << 32), .size_m = 200})) << kind;
  }
  EXPECT_EQ(generate_glb({.kind = "car", .seed = 1}), generate_glb({.kind = "car", .seed = 2}));
}

TEST(Generate, RotationsAreFloats) {
  const auto file = generate_glb({.kind = "city", .seed = 7, .size_m = 200});
  uint32_t length = 0;
  std::memcpy(&length, file.data() + 12, sizeof(length));
  const char* const text = reinterpret_cast<const char*>(file.data()) + 20;
  const nlohmann::json scene = nlohmann::json::parse(text, text + length);
  int rotations = 0;
  for (const auto& node : scene["nodes"]) {
    if (!node.contains("rotation")) continue;
    ++rotations;
    for (const double value : node["rotation"]) {
      // volatile, since GCC 12 would drop both conversions
      const volatile float rounded = static_cast<float>(value);
      EXPECT_EQ(static_cast<double>(rounded), value);
    }
  }
  EXPECT_GT(rotations, 10);
}

TEST(Generate, EmptyVariantIsTheFirst) {
  for (const std::string kind : {"car", "quadrotor", "city", "country"}) {
    const std::vector<std::string> variants = generator_variants(kind);
    const auto make = [&](const std::string& variant) {
      return generate_glb({.kind = kind, .size_m = 160, .variant = variant});
    };
    const auto first = make(variants[0]);
    EXPECT_EQ(make(""), first);
    for (size_t i = 1; i < variants.size(); ++i) EXPECT_NE(make(variants[i]), first);
  }
}

TEST(Generate, NamesWhatIsAllowed) {
  EXPECT_THAT(generator_kinds(), ElementsAre("city", "country", "canyon", "room", "mast", "car", "vehicle",
                                             "person", "quadrotor"));
  EXPECT_THAT(message_of({.kind = "town"}),
              AllOf(HasSubstr("city, country, canyon, room, mast, car, vehicle, person, quadrotor"),
                    HasSubstr("town")));
  EXPECT_THAT(message_of({.kind = ""}), HasSubstr("city, country"));
  EXPECT_THAT(message_of({.kind = "car", .variant = "tank"}),
              AllOf(HasSubstr("hatchback, van"), HasSubstr("tank")));
  EXPECT_THAT(message_of({.kind = "quadrotor", .variant = "huge"}), HasSubstr("medium, small, large"));
  EXPECT_THAT(message_of({.kind = "mast", .variant = "x"}), HasSubstr("has none"));
  EXPECT_THAT(message_of({.kind = "city", .variant = "monsoon"}),
              AllOf(HasSubstr("season of city"), HasSubstr("summer, spring, autumn, winter")));
  EXPECT_THAT(message_of({.kind = "city", .size_m = 99}), AllOf(HasSubstr("100 to 1000"), HasSubstr("99")));
  EXPECT_THAT(message_of({.kind = "city", .size_m = 1001}), HasSubstr("100 to 1000"));
  EXPECT_THAT(message_of({.kind = "country", .size_m = 2001}), HasSubstr("160 to 2000"));
  EXPECT_THAT(message_of({.kind = "city", .size_m = std::numeric_limits<double>::quiet_NaN()}),
              HasSubstr("nan"));
  EXPECT_THROW(generator_variants("town"), UserError);
}

TEST(Generate, ContainerIsWellFormed) {
  const auto glb = generate_glb({.kind = "quadrotor"});
  const auto word = [&](size_t at) {
    uint32_t value = 0;
    std::memcpy(&value, glb.data() + at, 4);
    return value;
  };
  ASSERT_EQ(word(0), 0x46546C67u);  // "glTF"
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), glb.size());
  EXPECT_EQ(word(16), 0x4E4F534Au);  // "JSON"
  const uint32_t json_bytes = word(12);
  EXPECT_EQ(json_bytes % 4, 0u);
  EXPECT_EQ(word(20 + json_bytes + 4), 0x004E4942u);  // "BIN\0"
  EXPECT_EQ(28 + json_bytes + word(20 + json_bytes), glb.size());
  const char* const text = reinterpret_cast<const char*>(glb.data()) + 20;
  const auto document = nlohmann::json::parse(text, text + json_bytes);
  EXPECT_EQ(document["asset"]["version"], "2.0");
  for (const auto& view : document["bufferViews"]) EXPECT_EQ(view["byteOffset"].get<size_t>() % 4, 0u);
}

TEST(Generate, CityStaysWithinItsBudget) {
  for (const uint64_t seed : {1u, 2u, 3u}) {
    const auto glb = generate_glb({.kind = "city", .seed = seed, .size_m = 300});
    EXPECT_LE(glb.size(), 4u << 20) << "seed " << seed;
    const Model model = load_model("city.glb", glb, {});
    const Scene scene = build_scene({{.name = "", .model = &model, .pose = {}}}, {.name = "city"});
    EXPECT_LE(scene.triangle_count(), 60000u) << "seed " << seed;
    EXPECT_LE(scene.facets.size(), 30000u) << "seed " << seed;
    EXPECT_GT(scene.facets.size(), 3000u) << "seed " << seed;
    // The whole street is one mirror.
    size_t road_facets = 0;
    for (const Facet& facet : scene.facets) {
      if (scene.instances[facet.instance].name != "road") continue;
      ++road_facets;
      EXPECT_NEAR(facet.normal.z, 1.0, 1e-12);
    }
    EXPECT_EQ(road_facets, 1u);
  }
}

TEST(Generate, PicturesPackedInAHurryAreTheSame) {
  const auto model_of = [](bool quick) {
    return load_model("city.glb", generate_glb({.kind = "city", .seed = 4, .size_m = 120, .quick = quick}),
                      {});
  };
  const Model slow = model_of(false), quick = model_of(true);
  ASSERT_EQ(slow.textures.size(), quick.textures.size());
  ASSERT_GT(slow.textures.size(), 20u);
  for (size_t i = 0; i < slow.textures.size(); ++i) {
    EXPECT_EQ(slow.textures[i].width, quick.textures[i].width);
    EXPECT_TRUE(slow.textures[i].rgba == quick.textures[i].rgba) << i;
  }
}

TEST(Generate, TexturesPaintedAheadAreThoseOfACity) {
  std::set<std::string> shown;
  const auto glb = generate_glb({.kind = "city", .seed = 7, .size_m = 300});
  uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, glb.data() + 12, 4);
  const char* const text = reinterpret_cast<const char*>(glb.data()) + 20;
  const auto document = nlohmann::json::parse(text, text + json_bytes);
  for (const auto& image : document["images"]) shown.insert(image["name"].get<std::string>());
  for (const char* const name : generator::city_textures()) EXPECT_TRUE(shown.contains(name)) << name;
}

TEST(Generate, EveryMaterialHoldsFrom1To40GHz) {
  for (const std::string& kind : generator_kinds()) {
    const Soup soup = load_soup({.kind = kind, .seed = 3, .size_m = 200});
    ASSERT_FALSE(soup.model.materials.empty());
    for (const Material& material : soup.model.materials) {
      ASSERT_TRUE(material.radio.has_value()) << material.name;
      for (const double frequency : {1e9, 3.5e9, 28e9, 40e9})
        for (const RadioLayer& layer : material.radio->layers) {
          const std::complex<double> eta = relative_permittivity(layer.medium, frequency, material.name);
          EXPECT_GE(eta.real(), 1.0) << material.name;
          EXPECT_LE(eta.imag(), 0.0) << material.name;
        }
      EXPECT_LE(glm::length(glm::max(vec3(material.pbr.base_color), vec3(0.0f))), std::sqrt(3.0f))
          << material.name;
    }
  }
}

TEST(Generate, LibraryNamesAreUniqueAndTexturesExist) {
  std::set<std::string> names, textures;
  for (const generator::MaterialSpec& spec : generator::material_library()) {
    EXPECT_TRUE(names.insert(spec.name).second) << spec.name;
    if (spec.texture.empty() || !textures.insert(spec.texture).second) continue;
    const generator::TextureMaps maps = generator::make_texture(spec.texture);
    EXPECT_EQ(maps.color.rgb.size(), 3ull * maps.color.width * maps.color.height) << spec.texture;
    EXPECT_EQ(maps.metallic_roughness.empty(), maps.color.empty() || spec.bays == 0) << spec.texture;
    // The map is not one flat colour.
    EXPECT_GT(std::set<uint8_t>(maps.color.rgb.begin(), maps.color.rgb.end()).size(), 8u) << spec.texture;
  }
  EXPECT_THROW(generator::material("unobtainium"), ContractError);
  EXPECT_THROW(generator::make_texture("unobtainium"), ContractError);
}

TEST(Lettering, EveryGlyphHasInkWithinItsGrid) {
  std::set<std::vector<int>> shapes;
  for (const char letter : std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZ123456789")) {
    std::vector<int> shape;
    generator::write_text(std::string(1, letter), 10, 20, 24, 2, [&](int x, int y, int share) {
      // An I has no room at its left.
      EXPECT_GE(x, letter == 'I' ? 4 : 8) << letter;
      EXPECT_LE(x, 10 + 16 + 2) << letter;
      EXPECT_GE(y, 18) << letter;
      EXPECT_LE(y, 46) << letter;
      EXPECT_GE(share, 1) << letter;
      EXPECT_LE(share, 16) << letter;
      shape.insert(shape.end(), {x, y, share});
    });
    // A stroke as long as the letter is high, 2 pixels wide.
    EXPECT_GT(shape.size() / 3, 40u) << letter;
    EXPECT_TRUE(shapes.insert(shape).second) << letter << " looks like another glyph";
  }
  EXPECT_EQ(generator::text_width("BOOKS", 18), 5 * 18);
  EXPECT_THROW(generator::write_text("a", 0, 0, 10, 1, [](int, int, int) {}), ContractError);
}

// A stroke down of 24 pixels with round ends: its area is 24 * 4 + pi * 2^2, of which the samples see the
// pixels' shares.
TEST(Lettering, AStrokeHasItsArea) {
  int sixteenths = 0;
  generator::write_text("I", 0, 10, 24, 4, [&](int, int, int share) { sixteenths += share; });
  EXPECT_NEAR(sixteenths / 16.0, 24.0 * 4.0 + 3.14159 * 4.0, 1.0);
}

class Painted : public ::testing::TestWithParam<const char*> {};

TEST_P(Painted, LoaderDecodesWhatWasPainted) {
  const Soup soup = load_soup({.kind = GetParam(), .seed = 1, .size_m = 300});
  size_t compared = 0;
  for (const Texture& texture : soup.model.textures) {
    std::string name = texture.name;
    const auto ends = [&](const std::string& suffix) {
      if (!texture.name.ends_with(suffix)) return false;
      name.resize(name.size() - suffix.size());
      return true;
    };
    const bool surface = ends("_surface"), normal = ends("_normal"), early = ends("_lit_0"),
               late = ends("_lit_1");
    const generator::TextureMaps maps = generator::make_texture(name);
    const generator::Raster& painted = surface  ? maps.metallic_roughness
                                       : normal ? maps.normal
                                       : early  ? maps.lit[0]
                                       : late   ? maps.lit[1]
                                                : maps.color;
    ASSERT_EQ(texture.width, painted.width);
    ASSERT_EQ(3 * texture.rgba.size(), 4 * painted.rgb.size()) << texture.name;
    int worst = 0;
    for (size_t i = 0; i < painted.rgb.size(); ++i)
      worst = std::max(worst, std::abs(int{texture.rgba[i / 3 * 4 + i % 3]} - int{painted.rgb[i]}));
    EXPECT_LE(worst, early || late || normal ? 0 : 4) << texture.name << ": half a step of 5 bits";
    for (size_t i = 0; i < texture.rgba.size() / 4; ++i)
      ASSERT_EQ(texture.rgba[4 * i + 3], &painted != &maps.color || maps.alpha.empty() ? 255 : maps.alpha[i])
          << texture.name;
    ++compared;
  }
  EXPECT_GE(compared, 15u);
}

INSTANTIATE_TEST_SUITE_P(Png, Painted, ::testing::Values("city", "country"));

TEST(Triangulate, ConcavePolygonKeepsItsArea) {
  const std::vector<dvec2> u{{0, 0}, {6, 0}, {6, 5}, {4, 5}, {4, 2}, {2, 2}, {2, 5}, {0, 5}};  // 30 - 6
  double area = 0.0;
  const auto triangles = generator::triangulate(u);
  EXPECT_EQ(triangles.size(), u.size() - 2);
  for (const auto& t : triangles) {
    const dvec2 a = u[t[1]] - u[t[0]], b = u[t[2]] - u[t[0]];
    const double signed_area = 0.5 * (a.x * b.y - a.y * b.x);
    EXPECT_GT(signed_area, 0.0);
    area += signed_area;
  }
  EXPECT_DOUBLE_EQ(area, 24.0);
  const std::vector<dvec2> clockwise(u.rbegin(), u.rend());
  EXPECT_THROW(generator::triangulate(clockwise), ContractError);
}

TEST(Inset, MovesEachEdgeByItsDistance) {
  const std::vector<dvec2> square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  EXPECT_THAT(generator::inset(square, std::vector<double>{1, 2, 3, 4}),
              ElementsAre(dvec2(4, 1), dvec2(8, 1), dvec2(8, 7), dvec2(4, 7)));
}

}  // namespace
}  // namespace greatx::scene
