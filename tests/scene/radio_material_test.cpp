// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the sources of a material's radio properties: name, extension, sidecar.
#include <set>

#include "scene/build/build.h"
#include "scene/description/scene_hash.h"
#include "tests/scene/gltf_writer.h"

namespace greatx::scene {
namespace {

using test::expect_user_error;
using test::GltfWriter;
using test::json;
using test::TemporaryFolder;

GltfWriter quad_with(json material) {
  GltfWriter writer;
  writer.add_triangles("wall", test::unit_quad(), test::quad_indices(), writer.material(std::move(material)));
  return writer;
}

json with_extension(json fields, const std::string& name = "paint") {
  return {{"name", name}, {"extensions", {{"GREATX_radio_material", std::move(fields)}}}};
}

RadioMaterial load_extension(json fields) {
  return *quad_with(with_extension(std::move(fields))).load().materials.at(0).radio;
}

Material load_with_sidecar(const std::string& yaml, json material) {
  const TemporaryFolder folder;
  LoadOptions options;
  options.radio_materials = folder.write("radio.yaml", yaml);
  return quad_with(std::move(material)).load(options).materials.at(0);
}

TEST(RadioMaterial, ItuNameInTheFile) {
  for (const char* name : {"itu_concrete", "itu_concrete.001", "ITU-Concrete", "mat-itu_concrete"}) {
    const Model model = quad_with({{"name", name}}).load();
    ASSERT_TRUE(model.materials.at(0).radio) << name;
    const RadioMaterial& radio = *model.materials[0].radio;
    EXPECT_EQ(radio.layers.at(0).medium.source, "ITU-R P.2040-4 Table 3, concrete");
    EXPECT_EQ(radio.layers[0].thickness_m, 0.0);  // a half-space
    EXPECT_EQ(radio.scattering_coefficient, 0.0);
  }
}

TEST(RadioMaterial, ExtensionWithEveryField) {
  const Model model = quad_with(with_extension({{"itu", "brick"},
                                                {"thickness_m", 0.24},
                                                {"extrapolate", true},
                                                {"scattering_coefficient", 0.3},
                                                {"pattern", "backscattering"},
                                                {"pattern_exponent", 5},
                                                {"backscatter_exponent", 6},
                                                {"backscatter_share", 0.25},
                                                {"cross_polarization", 0.1},
                                                {"roughness_m", 0.002},
                                                {"deviation_m", 0.003},
                                                {"clutter", "snow"},
                                                {"reflectance_905nm", 0.4},
                                                {"reflectance_1550nm", 0.35}}))
                          .load();
  const Material& material = model.materials.at(0);
  ASSERT_TRUE(material.radio);
  EXPECT_EQ(material.radio->layers.at(0).medium.source, "ITU-R P.2040-4 Table 3, brick");
  EXPECT_TRUE(material.radio->layers[0].medium.extrapolate);
  EXPECT_EQ(material.radio->layers[0].thickness_m, 0.24);
  EXPECT_EQ(material.radio->scattering_coefficient, 0.3);
  EXPECT_EQ(material.radio->pattern, ScatteringPattern::backscattering);
  EXPECT_EQ(material.radio->pattern_exponent, 5.0);
  EXPECT_EQ(material.radio->backscatter_exponent, 6.0);
  EXPECT_EQ(material.radio->backscatter_share, 0.25);
  EXPECT_EQ(material.radio->cross_polarization, 0.1);
  EXPECT_EQ(material.radio->roughness_m, 0.002);
  EXPECT_EQ(material.radio->deviation_m, 0.003);
  EXPECT_EQ(material.radio->clutter, clutter_called("snow"));
  EXPECT_EQ(material.reflectance_905nm, 0.4f);
  EXPECT_EQ(material.reflectance_1550nm, 0.35f);
}

TEST(RadioMaterial, ExplicitRowsAndPermittivity) {
  const json row = {{"a", 5.0}, {"b", -0.1}, {"c", 0.02}, {"d", 0.9}, {"min_hz", 1e9}, {"max_hz", 1e11}};
  for (const RadioMaterial& radio : {load_extension(row), load_extension({{"rows", json::array({row})}})}) {
    ASSERT_EQ(radio.layers.at(0).medium.rows.size(), 1u);
    EXPECT_EQ(radio.layers[0].medium.source, "explicit a, b, c, d");
    EXPECT_EQ(radio.layers[0].medium.rows[0].b, -0.1);
    EXPECT_EQ(radio.layers[0].medium.rows[0].max_hz, 1e11);
  }
  const RadioMaterial constant = load_extension({{"relative_permittivity", 4.0}, {"conductivity", 0.02}});
  for (const double hertz : {1e6, 28e9, 1e12}) {
    const auto eta = relative_permittivity(constant.layers.at(0).medium, hertz, "paint");
    EXPECT_EQ(eta.real(), 4.0);
    EXPECT_NEAR(eta.imag() * hertz, -0.02 / (2 * 3.14159265358979 * 8.8541878128e-12), 1.0);
  }
}

TEST(RadioMaterial, LayersInOrder) {
  const json glass = {{"itu", "glass"}, {"thickness_m", 0.006}};
  const json air = {{"relative_permittivity", 1.0}, {"conductivity", 0.0}, {"thickness_m", 0.012}};
  const RadioMaterial pane =
      load_extension({{"layers", {glass, air, {{"itu", "glass"}, {"thickness_m", 0.004}}}}});
  ASSERT_EQ(pane.layers.size(), 3u);
  EXPECT_EQ(pane.layers[0].thickness_m, 0.006);
  EXPECT_EQ(pane.layers[1].medium.source, "explicit permittivity");
  EXPECT_EQ(pane.layers[2].thickness_m, 0.004);
}

json windows(double share = 0.22) {
  const json glass = {{"itu", "glass"}, {"thickness_m", 0.006}};
  const json air = {{"relative_permittivity", 1.0}, {"conductivity", 0.0}, {"thickness_m", 0.016}};
  return {{"share", share}, {"layers", {glass, air, glass}}};
}

TEST(RadioMaterial, WindowsInAWall) {
  const RadioMaterial wall = load_extension({{"itu", "brick"}, {"thickness_m", 0.3}, {"windows", windows()}});
  ASSERT_TRUE(wall.windows);
  EXPECT_EQ(wall.windows->share, 0.22);
  ASSERT_EQ(wall.windows->layers.size(), 3u);
  EXPECT_EQ(wall.windows->layers[0].medium.source, "ITU-R P.2040-4 Table 3, glass");
  EXPECT_EQ(wall.windows->layers[1].thickness_m, 0.016);
  EXPECT_FALSE(wall.windows->layers[0].medium.extrapolate);
  ASSERT_EQ(wall.layers.size(), 1u);
  EXPECT_EQ(wall.layers[0].thickness_m, 0.3);
  EXPECT_FALSE(load_extension({{"itu", "brick"}}).windows);
}

TEST(RadioMaterial, WindowsExtrapolateWithTheirWall) {
  const auto loaded = [](json fields) { return *load_extension(std::move(fields)).windows; };
  const RadioWindows own = loaded({{"itu", "brick"}, {"extrapolate", true}, {"windows", windows()}});
  for (const RadioLayer& layer : own.layers) EXPECT_TRUE(layer.medium.extrapolate);
  json stated = windows();
  stated["layers"][2]["extrapolate"] = false;
  const RadioWindows some = loaded({{"itu", "brick"}, {"extrapolate", true}, {"windows", stated}});
  EXPECT_TRUE(some.layers[0].medium.extrapolate);
  EXPECT_FALSE(some.layers[2].medium.extrapolate);
  stated["layers"][0]["extrapolate"] = true;
  const RadioWindows alone = loaded({{"itu", "brick"}, {"windows", stated}});
  EXPECT_TRUE(alone.layers[0].medium.extrapolate);
  EXPECT_FALSE(alone.layers[1].medium.extrapolate);
}

TEST(RadioMaterial, WindowErrors) {
  const auto refuse = [](json given, std::vector<std::string> parts, json wall = {{"itu", "brick"}}) {
    parts.insert(parts.end(), {"test.glb", "paint", "GREATX_radio_material"});
    wall["windows"] = std::move(given);
    expect_user_error([&] { load_extension(wall); }, parts);
  };
  refuse(windows(1.01), {".windows.share", "from 0 to 1", "1.01"});
  refuse(windows(-0.1), {".windows.share", "-0.1"});
  json bad = windows();
  bad["share"] = "a fifth";
  refuse(bad, {".windows.share", "'a fifth'"});
  bad["share"] = nullptr;
  refuse(bad, {".windows.share"});
  refuse({{"share", 0.2}}, {".windows", "'layers' is missing"});
  refuse({{"layers", windows()["layers"]}}, {".windows", "'share' is missing"});
  refuse(json::object(), {".windows", "share of the wall's area, their layers, or both"});
  refuse(0.2, {".windows", "expected a map"});
  refuse({{"share", 0.2}, {"layers", json::array()}}, {".windows.layers"});
  refuse({{"share", 0.2}, {"layers", json::array({json{{"itu", "glass"}}})}},
         {".windows.layers[0]", "thickness_m"});
  refuse({{"share", 0.2}, {"layers", json::array({json{{"itu", "glas"}, {"thickness_m", 1}}})}},
         {".windows.layers[0].itu", "'glas'"});
  refuse({{"share", 0.2}, {"itu", "glass"}}, {".windows", "unknown key 'itu'"});
  refuse({{"share", 0.2}, {"layer", 1}}, {"did you mean 'layers'"});
  refuse(windows(), {".windows", "need a wall"}, json::object());
  refuse(windows(), {"no surface", "'windows'"}, {{"foliage", "weissberger"}});
}

TEST(RadioMaterial, Foliage) {
  const RadioMaterial model = load_extension({{"foliage", "weissberger"}});
  ASSERT_TRUE(model.foliage);
  EXPECT_FALSE(model.foliage->attenuation_db_per_m);
  EXPECT_TRUE(model.layers.empty());
  const RadioMaterial explicit_loss = load_extension({{"foliage", {{"attenuation_db_per_m", 1.25}}}});
  ASSERT_TRUE(explicit_loss.foliage);
  EXPECT_EQ(explicit_loss.foliage->attenuation_db_per_m, 1.25);
  const Material lit = quad_with(with_extension({{"foliage", "weissberger"}, {"reflectance_905nm", 0.4}}))
                           .load()
                           .materials.at(0);
  EXPECT_EQ(lit.reflectance_905nm, 0.4f);
}

TEST(RadioMaterial, FoliageErrors) {
  const auto refuse = [](json fields, std::vector<std::string> parts) {
    parts.insert(parts.end(), {"test.glb", "paint", "GREATX_radio_material"});
    expect_user_error([&] { load_extension(fields); }, parts);
  };
  const std::string expected = "expected weissberger or {attenuation_db_per_m: dB/m}";
  refuse({{"foliage", "oak"}}, {".foliage", expected, "'oak'"});
  refuse({{"foliage", true}}, {".foliage", expected, "true"});
  refuse({{"foliage", json::object()}}, {".foliage", expected, "a map"});
  refuse({{"foliage", {{"attenuation_db_per_m", -0.1}}}},
         {".foliage.attenuation_db_per_m", "from 0 to 1000", "-0.1"});
  refuse({{"foliage", {{"db_per_m", 1}}}}, {".foliage", "unknown key 'db_per_m'"});
  for (const char* key : {"itu", "thickness_m", "layers", "scattering_coefficient", "roughness_m",
                          "deviation_m", "extrapolate"})
    refuse({{"foliage", "weissberger"}, {key, 1}}, {"no surface", fmt::format("'{}'", key)});
}

TEST(RadioMaterial, EveryMemberCountsInEqualityAndHash) {
  const Model model = quad_with(with_extension({{"itu", "concrete"}, {"thickness_m", 0.2}})).load();
  const Scene scene = build_scene({{"", &model, {}, dvec3(1.0), false, {}}}, {.name = "s"});
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0], Material(scene.materials[0]));
  using Change = void (*)(Material&);
  const std::vector<Change> changes{[](Material& m) { m.pbr.base_color.x = 0.3f; },
                                    [](Material& m) { m.pbr.metallic = 0.3f; },
                                    [](Material& m) { m.pbr.roughness = 0.3f; },
                                    [](Material& m) { m.pbr.emissive.z = 0.3f; },
                                    [](Material& m) { m.pbr.normal_scale = 0.3f; },
                                    [](Material& m) { m.pbr.alpha_cutoff = 0.3f; },
                                    [](Material& m) { m.pbr.alpha_mode = AlphaMode::mask; },
                                    [](Material& m) { m.pbr.double_sided = !m.pbr.double_sided; },
                                    [](Material& m) { m.pbr.transmission = 0.3f; },
                                    [](Material& m) { m.pbr.base_color_texture = 3; },
                                    [](Material& m) { m.pbr.metallic_roughness_texture = 3; },
                                    [](Material& m) { m.pbr.normal_texture = 3; },
                                    [](Material& m) { m.pbr.emissive_texture = 3; },
                                    [](Material& m) { m.radio->layers[0].thickness_m = 0.3; },
                                    [](Material& m) { m.radio->layers[0].medium.extrapolate = true; },
                                    [](Material& m) { m.radio->layers[0].medium.rows[0].a = 0.3; },
                                    [](Material& m) { m.radio->layers[0].medium.rows[0].b = 0.3; },
                                    [](Material& m) { m.radio->layers[0].medium.rows[0].c = 0.3; },
                                    [](Material& m) { m.radio->layers[0].medium.rows[0].d = 0.3; },
                                    [](Material& m) { m.radio->layers[0].medium.rows[0].min_hz = 0.3; },
                                    [](Material& m) { m.radio->layers[0].medium.rows[0].max_hz = 0.3; },
                                    [](Material& m) { m.radio->scattering_coefficient = 0.3; },
                                    [](Material& m) { m.radio->pattern = ScatteringPattern::directive; },
                                    [](Material& m) { m.radio->pattern_exponent = 3.0; },
                                    [](Material& m) { m.radio->backscatter_exponent = 3.0; },
                                    [](Material& m) { m.radio->backscatter_share = 0.3; },
                                    [](Material& m) { m.radio->cross_polarization = 0.3; },
                                    [](Material& m) { m.radio->roughness_m = 0.3; },
                                    [](Material& m) { m.radio->deviation_m = 0.3; },
                                    [](Material& m) { m.radio->clutter = clutter_called("soil"); },
                                    [](Material& m) { m.radio->clutter = clutter_called("snow"); },
                                    [](Material& m) { m.radio->clutter = clutter_called("water"); },
                                    [](Material& m) { m.radio->foliage = Foliage{}; },
                                    [](Material& m) { m.radio->windows = RadioWindows{}; },
                                    [](Material& m) {
                                      m.radio->windows = RadioWindows{0.2, {}};
                                    },
                                    [](Material& m) {
                                      m.radio->windows = {0.2, m.radio->layers};
                                    },
                                    [](Material& m) { m.radio.reset(); },
                                    [](Material& m) { m.reflectance_905nm = 0.3f; },
                                    [](Material& m) { m.reflectance_1550nm = 0.3f; }};
  std::set<std::string> hashes{hash_of(scene)};
  for (size_t i = 0; i < changes.size(); ++i) {
    Scene changed = scene;
    changes[i](changed.materials[0]);
    EXPECT_NE(changed.materials[0], scene.materials[0]) << i;
    EXPECT_TRUE(hashes.insert(hash_of(changed)).second) << i;
  }
  // Names and sources take part in the comparison, but not in the hash.
  Scene renamed = scene;
  renamed.materials[0].name = "other";
  EXPECT_NE(renamed.materials[0], scene.materials[0]);
  EXPECT_TRUE(hashes.contains(hash_of(renamed)));
}

/// Scenes of before there were windows keep their hash.
TEST(RadioMaterial, TheHashOfAWallWithoutWindowsStays) {
  const Model model = quad_with(with_extension({{"itu", "concrete"}, {"thickness_m", 0.2}})).load();
  const Scene scene = build_scene({{"", &model, {}, dvec3(1.0), false, {}}}, {.name = "s"});
  EXPECT_EQ(hash_of(scene), "1a2c93e0b7f21dfb51f3b653c2590d65c45e2a2da777d0401dc39f00985981fa");
  Scene glazed = scene;
  glazed.materials[0].radio->clutter = clutter_called("soil");
  EXPECT_EQ(hash_of(glazed), "d12d94a7fa20bc0e886795b92b2fbd6d28842ad2852447359354b76956df77fd");
}

TEST(RadioMaterial, FoliageIsPartOfTheHash) {
  const auto hash_with = [](json fields) {
    const Model model = quad_with(with_extension(std::move(fields))).load();
    return hash_of(build_scene({{"", &model, {}, dvec3(1.0), false, {}}}, {.name = "s"}));
  };
  const std::set<std::string> hashes{
      hash_with({{"foliage", "weissberger"}}), hash_with({{"foliage", {{"attenuation_db_per_m", 0.0}}}}),
      hash_with({{"foliage", {{"attenuation_db_per_m", 0.5}}}}),
      hash_with({{"foliage", {{"attenuation_db_per_m", 0.6}}}}), hash_with({{"itu", "wood"}})};
  EXPECT_EQ(hashes.size(), 5u);
}

TEST(RadioMaterial, FoliagesThatDifferStayApart) {
  const Model soft = quad_with(with_extension({{"foliage", "weissberger"}})).load(),
              hard = quad_with(with_extension({{"foliage", {{"attenuation_db_per_m", 0.5}}}})).load(),
              same = quad_with(with_extension({{"foliage", "weissberger"}})).load();
  const auto placed = [](const Model& model, const char* name) {
    return ModelPlacement{name, &model, {}, dvec3(1.0), false, {}};
  };
  const Scene scene = build_scene({placed(soft, "a"), placed(hard, "b"), placed(same, "c")}, {.name = "s"});
  EXPECT_EQ(scene.materials.size(), 2u);
}

TEST(RadioMaterial, ExtensionErrorsNameFileMaterialAndField) {
  const auto refuse = [](json fields, std::vector<std::string> parts) {
    parts.insert(parts.end(), {"test.glb", "paint"});
    expect_user_error([&] { load_extension(fields); }, parts);
  };
  refuse({{"itu", "unobtanium"}}, {"GREATX_radio_material.itu", "unobtanium", "concrete"});
  refuse({{"itu", "concrete"}, {"thickness_m", 0.0}}, {"thickness_m", "above 0"});
  refuse({{"itu", "concrete"}, {"thickness_m", -0.1}}, {"thickness_m", "-0.1"});
  refuse({{"itu", "concrete"}, {"thickness_m", "0.1 m"}}, {"thickness_m", "'0.1 m'"});
  refuse({{"itu", "concrete"}, {"scattering_coefficient", 1.5}},
         {"scattering_coefficient", "from 0 to 1", "1.5"});
  refuse({{"itu", "concrete"}, {"cross_polarization", -0.1}}, {"cross_polarization"});
  refuse({{"itu", "concrete"}, {"pattern", "spiky"}}, {"pattern", "spiky", "lambertian"});
  refuse({{"itu", "concrete"}, {"pattern_exponent", 2.5}}, {"pattern_exponent", "whole number"});
  refuse({{"itu", "concrete"}, {"roughness_m", -1}}, {"roughness_m"});
  refuse({{"itu", "concrete"}, {"deviation_m", -1}}, {"deviation_m", "from 0 to 10 m", "-1"});
  refuse({{"itu", "concrete"}, {"deviation_m", 11}}, {"deviation_m", "from 0 to 10 m", "11"});
  refuse({{"itu", "concrete"}, {"clutter", "lawn"}}, {"clutter", "one of asphalt", "'lawn'"});
  refuse({{"itu", "concrete"}, {"clutter", {{"angle_db", 3}}}}, {"clutter", "one of level_db, gamma_db"});
  refuse({{"itu", "concrete"}, {"clutter", {{"level_db", -30}, {"sea_state", 1}}}}, {"one of level_db"});
  refuse({{"itu", "concrete"}, {"clutter", {{"gamma_db", -15}, {"angle_db", 3}}}}, {"belongs to level_db"});
  refuse({{"itu", "concrete"}, {"clutter", {{"sea_state", 7}}}}, {"sea_state", "from 0 to 6"});
  refuse({{"clutter", "soil"}}, {"clutter needs a medium"});
  refuse({{"itu", "concrete"}, {"reflectance_905nm", 2}}, {"reflectance_905nm"});
  refuse({{"itu", "concrete"}, {"thicknes_m", 0.1}}, {"unknown key 'thicknes_m'", "thickness_m"});
  refuse({{"itu", "concrete"}, {"relative_permittivity", 4}, {"conductivity", 0}}, {"given twice"});
  refuse({{"relative_permittivity", 4}}, {"conductivity", "missing"});
  refuse({{"relative_permittivity", 0.5}, {"conductivity", 0}}, {"relative_permittivity", "1 or more"});
  refuse({{"a", 4}, {"b", 0}, {"c", 0.1}, {"d", 0}}, {"missing", "max_hz"});
  refuse({{"a", 4}, {"b", 0}, {"c", 0.1}, {"d", 0}, {"min_hz", 2e9}, {"max_hz", 1e9}},
         {"min_hz below max_hz"});
  refuse({{"rows", json::array()}}, {"rows", "a list of 1 or more rows"});
  refuse({{"layers", json::array()}}, {"layers"});
  const json no_thickness = {{"itu", "glass"}}, no_medium = {{"thickness_m", 0.1}};
  const json good = {{"itu", "glass"}, {"thickness_m", 0.1}};
  refuse({{"layers", json::array({no_thickness})}}, {"layers[0]", "thickness_m"});
  refuse({{"layers", json::array({no_medium})}}, {"layers[0]", "needs a medium"});
  refuse({{"layers", json::array({good})}, {"itu", "glass"}}, {"layers exclude"});
  refuse({{"thickness_m", 0.1}}, {"need a medium"});
  refuse({{"scattering_coefficient", 0.1}}, {"need a medium"});
  refuse(json::array(), {"expected a map"});
}

/// A material as Blender writes it: its custom properties are in the extras.
json with_extras(const std::string& name, const json& extras) { return {{"name", name}, {"extras", extras}}; }

TEST(RadioMaterial, ExtrasHoldAMapOrAText) {
  for (const json& value :
       {json({{"itu", "glass"}, {"thickness_m", 0.006}}), json("itu: glass, thickness_m: 0.006"),
        json("  {itu: glass, thickness_m: 0.006}"), json("{\"itu\": \"glass\", \"thickness_m\": 0.006}")}) {
    const Material material =
        quad_with(with_extras("pane", {{"greatx_radio", value}})).load().materials.at(0);
    ASSERT_TRUE(material.radio) << value.dump();
    ASSERT_EQ(material.radio->layers.size(), 1u);
    EXPECT_EQ(material.radio->layers[0].medium, *itu_medium("glass"));
    EXPECT_EQ(material.radio->layers[0].thickness_m, 0.006);
  }
  const json layers =
      "layers: [{itu: glass, thickness_m: 0.006}, {itu: vacuum, thickness_m: 0.012}], "
      "reflectance_905nm: 0.1";
  const Material pane = quad_with(with_extras("pane", {{"greatx_radio", layers}})).load().materials.at(0);
  EXPECT_EQ(pane.radio->layers.size(), 2u);
  EXPECT_EQ(pane.reflectance_905nm, 0.1f);
}

TEST(RadioMaterial, ExtrasLieBetweenTheExtensionAndTheSidecar) {
  json material = with_extras("itu_concrete", {{"greatx_radio", "thickness_m: 0.2"}, {"other_tool", 7}});
  const Material thick = quad_with(material).load().materials.at(0);
  EXPECT_EQ(thick.radio->layers[0].medium, *itu_medium("concrete"));
  EXPECT_EQ(thick.radio->layers[0].thickness_m, 0.2);
  material["extensions"]["GREATX_radio_material"] = {{"itu", "brick"}, {"thickness_m", 0.1}};
  EXPECT_EQ(quad_with(material).load().materials.at(0).radio->layers[0].medium, *itu_medium("brick"));
  EXPECT_EQ(quad_with(material).load().materials.at(0).radio->layers[0].thickness_m, 0.2);
  const TemporaryFolder folder;
  LoadOptions options;
  options.radio_materials =
      folder.write("radio.yaml", std::string("materials: {itu_concrete: {thickness_m: 0.3}}"));
  EXPECT_EQ(quad_with(material).load(options).materials.at(0).radio->layers[0].thickness_m, 0.3);
}

TEST(RadioMaterial, ExtrasErrorsNameFileMaterialAndField) {
  const auto refuse = [](const json& extras, const std::vector<std::string>& parts) {
    expect_user_error([&] { quad_with(with_extras("pane", extras)).load(); }, parts);
  };
  refuse({{"greatx_radio", "itu: glas"}}, {"test.glb", "pane", "extras.greatx_radio", "itu", "glas"});
  refuse({{"greatx_radio", {{"itu", "glass"}, {"thikness_m", 0.1}}}},
         {"test.glb", "pane", "extras.greatx_radio", "thikness_m"});
  refuse({{"greatx_radio", "glass"}}, {"test.glb", "pane", "extras.greatx_radio", "glass"});
  refuse({{"greatx_radio", 7}}, {"test.glb", "pane", "extras.greatx_radio", "7"});
  refuse({{"greatx_radio", "itu: [glass"}}, {"test.glb", "pane", "extras.greatx_radio"});
  refuse({{"greatx_radio", std::string(70000, 'x')}}, {"pane", "extras.greatx_radio", "70000 bytes"});
  refuse({{"greatx_rado", "itu: glass"}}, {"test.glb", "pane", "greatx_rado", "greatx_radio"});
  refuse({{"greatx_class", "window"}}, {"test.glb", "pane", "greatx_class", "greatx_radio"});
}

TEST(RadioMaterial, UsedMaterialsWithoutRadioAreListedInOneError) {
  GltfWriter writer;
  writer.add_triangles("house", test::unit_quad(), test::quad_indices(),
                       writer.material({{"name", "stucco"}}));
  writer.add_triangles("street", test::unit_quad(), test::quad_indices(),
                       writer.material({{"name", "tar \"new\""}}));
  writer.add_triangles("ok", test::unit_quad(), test::quad_indices(), writer.itu_material());
  writer.add_triangles("odd", test::unit_quad(), test::quad_indices(), writer.itu_material("itu_unobtanium"));
  writer.material({{"name", "unused"}});
  const json bare = {{"attributes", {{"POSITION", writer.vec3s(test::unit_quad())}}},
                     {"indices", writer.indices32(test::quad_indices())}};
  writer.root({{"name", "bare"}, {"mesh", writer.mesh("bare", json::array({bare}))}});
  expect_user_error(
      [&] { writer.load(); },
      {"test.glb", "4 materials", "\nmaterials:", "\n  \"stucco\": { itu: ", "\"tar \\\"new\\\"\": {",
       "mesh 'house'", "mesh 'street'", "\"default_material\": {", "'unobtanium' is no material"});
  try {
    writer.load();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("unused")));
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\"itu_concrete\"")));
  }
  LoadOptions optical;
  optical.optical_only = true;
  const Model model = writer.load(optical);
  EXPECT_EQ(model.materials.size(), 5u);  // without the unused material
  EXPECT_FALSE(model.materials.at(0).radio);
}

TEST(RadioSidecar, TheLinesOfTheErrorAreTheCure) {
  for (const auto& [name, thickness] : {std::pair("coat \"new\"", 0.3), {"red_\"brick\"", 0.24}}) {
    const GltfWriter writer = quad_with({{"name", name}});
    std::string message;
    try {
      writer.load();
    } catch (const UserError& error) {
      message = error.what();
    }
    const TemporaryFolder folder;
    LoadOptions options;
    options.radio_materials = folder.write("radio.yaml", message.substr(message.find("materials:")));
    EXPECT_EQ(writer.load(options).materials.at(0).radio->layers.at(0).thickness_m, thickness) << name;
  }
}

TEST(RadioSidecar, ExactNameBeatsGlobAndFirstGlobWins) {
  const std::string yaml =
      "materials:\n"
      "  \"pa*\": { itu: wood, thickness_m: 0.02 }\n"
      "  \"*\": { itu: glass }\n"
      "  paint: { itu: metal }\n";
  EXPECT_EQ(load_with_sidecar(yaml, {{"name", "paint"}}).radio->layers.at(0).medium.source,
            "ITU-R P.2040-4 Table 3, metal; above 100 GHz the same conductivity (Hagen and Rubens 1903)");
  EXPECT_EQ(load_with_sidecar(yaml, {{"name", "pane"}}).radio->layers.at(0).medium.source,
            "ITU-R P.2040-4 Table 3, wood");
  EXPECT_EQ(load_with_sidecar(yaml, {{"name", "other"}}).radio->layers.at(0).medium.source,
            "ITU-R P.2040-4 Table 3, glass");
}

TEST(RadioSidecar, LaysOverNameAndExtension) {
  const Material named =
      load_with_sidecar("materials:\n  itu_marble: { thickness_m: 0.3 }\n", {{"name", "itu_marble"}});
  EXPECT_EQ(named.radio->layers.at(0).medium.source, "ITU-R P.2040-4 Table 3, marble");
  EXPECT_EQ(named.radio->layers[0].thickness_m, 0.3);
  const Material over =
      load_with_sidecar("materials:\n  paint: { itu: glass, reflectance_905nm: 0.1 }\n",
                        with_extension({{"itu", "brick"}, {"scattering_coefficient", 0.2}}));
  EXPECT_EQ(over.radio->layers.at(0).medium.source, "ITU-R P.2040-4 Table 3, glass");
  EXPECT_EQ(over.radio->scattering_coefficient, 0.2);
  EXPECT_EQ(over.reflectance_905nm, 0.1f);
}

TEST(RadioSidecar, BeyondRangeIsForEveryMedium) {
  const std::string all = "beyond_range: extrapolate\nmaterials:\n";
  EXPECT_TRUE(
      load_with_sidecar(all + "  {}\n", {{"name", "itu_marble"}}).radio->layers.at(0).medium.extrapolate);
  EXPECT_TRUE(load_with_sidecar(all + "  paint: { itu: glass }\n", with_extension({{"itu", "brick"}}))
                  .radio->layers.at(0)
                  .medium.extrapolate);
  EXPECT_FALSE(load_with_sidecar(all + "  itu_marble: { extrapolate: false }\n", {{"name", "itu_marble"}})
                   .radio->layers.at(0)
                   .medium.extrapolate);
  EXPECT_FALSE(load_with_sidecar("beyond_range: refuse\nmaterials: {}\n", {{"name", "itu_marble"}})
                   .radio->layers.at(0)
                   .medium.extrapolate);
  EXPECT_TRUE(load_with_sidecar(all + "  {}\n", with_extension({{"foliage", "weissberger"}})).radio->foliage);
  expect_user_error(
      [&] {
        load_with_sidecar("beyond_range: guess\nmaterials: {}\n", {{"name", "itu_marble"}});
      },
      {"radio.yaml:1", "beyond_range", "one of refuse, extrapolate", "'guess'"});
}

TEST(RadioSidecar, WindowsLieOverThoseBelow) {
  const json wall = with_extension({{"itu", "brick"}, {"thickness_m", 0.3}, {"windows", windows()}});
  const auto laid = [&](const std::string& entry) {
    return *load_with_sidecar("materials:\n  paint: " + entry + "\n", wall).radio;
  };
  const RadioMaterial more = laid("{ windows: { share: 0.4 } }");
  EXPECT_EQ(more.windows->share, 0.4);
  EXPECT_EQ(more.windows->layers.size(), 3u);
  const RadioMaterial single = laid("{ windows: { layers: [ { itu: glass, thickness_m: 0.004 } ] } }");
  EXPECT_EQ(single.windows->share, 0.22);
  ASSERT_EQ(single.windows->layers.size(), 1u);
  EXPECT_EQ(single.windows->layers[0].thickness_m, 0.004);
  const RadioMaterial other = laid("{ itu: concrete, thickness_m: 0.2 }");
  EXPECT_EQ(other.layers.at(0).thickness_m, 0.2);
  EXPECT_EQ(other.windows->share, 0.22) << "as the other fields of the wall";
  EXPECT_FALSE(laid("{ foliage: weissberger }").windows);
  const RadioMaterial far = laid("{ extrapolate: true }");
  EXPECT_TRUE(far.layers.at(0).medium.extrapolate);
  for (const RadioLayer& layer : far.windows->layers) EXPECT_TRUE(layer.medium.extrapolate);
  expect_user_error([&] { laid("{ windows: {} }"); },
                    {"radio.yaml:2", "materials.paint.windows", "their layers, or both"});
  expect_user_error([&] { laid("{ windows: { share: 2 } }"); },
                    {"radio.yaml:2", "materials.paint.windows.share", "from 0 to 1"});
  expect_user_error(
      [&] {
        load_with_sidecar("materials:\n  paint: { windows: { share: 0.4 } }\n",
                          with_extension({{"itu", "brick"}}));
      },
      {"radio.yaml:2", "materials.paint.windows", "'layers' is missing"});
}

TEST(RadioSidecar, BeyondRangeIsForWindowsToo) {
  const json wall = with_extension({{"itu", "brick"}, {"windows", windows()}});
  const auto loaded = [&](const std::string& materials) {
    return *load_with_sidecar("beyond_range: extrapolate\nmaterials:\n  " + materials + "\n", wall).radio;
  };
  const RadioMaterial all = loaded("{}"), own = loaded("paint: { extrapolate: false }");
  for (const RadioLayer& layer : all.windows->layers) EXPECT_TRUE(layer.medium.extrapolate);
  for (const RadioLayer& layer : own.windows->layers) EXPECT_FALSE(layer.medium.extrapolate);
}

TEST(RadioSidecar, ConductorsByName) {
  const RadioMaterial roof =
      *load_with_sidecar("materials:\n  paint: { conductor: zinc, thickness_m: 0.001 }\n",
                         with_extension({{"itu", "brick"}}))
           .radio;
  EXPECT_EQ(roof.layers.at(0).medium.rows.at(0).c, 1.67e7);
  EXPECT_EQ(roof.layers[0].thickness_m, 0.001);
  expect_user_error(
      [&] {
        load_with_sidecar("materials:\n  paint: { conductor: iron }\n", with_extension({{"itu", "brick"}}));
      },
      {"radio.yaml:2", "conductor", "silver, copper", "'iron'"});
  expect_user_error(
      [&] {
        load_with_sidecar("materials:\n  paint: { conductor: zinc, itu: metal }\n",
                          with_extension({{"itu", "brick"}}));
      },
      {"radio.yaml:2", "given twice", "itu, conductor, rows"});
}

TEST(RadioSidecar, FoliageReplacesAWallAndAWallFoliage) {
  const json wall = with_extension({{"itu", "wood"}, {"thickness_m", 0.1}, {"scattering_coefficient", 0.2}}),
             crown = with_extension({{"foliage", "weissberger"}});
  const Material leafy =
      load_with_sidecar("materials:\n  paint: { foliage: { attenuation_db_per_m: 0.7 } }\n", wall);
  ASSERT_TRUE(leafy.radio->foliage);
  EXPECT_EQ(leafy.radio->foliage->attenuation_db_per_m, 0.7);
  EXPECT_TRUE(leafy.radio->layers.empty());
  EXPECT_EQ(leafy.radio->scattering_coefficient, 0.0);
  const Material solid = load_with_sidecar("materials:\n  paint: { itu: glass, thickness_m: 0.01 }\n", crown);
  EXPECT_FALSE(solid.radio->foliage);
  EXPECT_EQ(solid.radio->layers.at(0).thickness_m, 0.01);
  for (const char* field : {"thickness_m: 0.1", "scattering_coefficient: 0.1", "extrapolate: true"})
    expect_user_error(
        [&] { load_with_sidecar(fmt::format("materials:\n  paint: {{ {} }}\n", field), crown); },
        {"radio.yaml:2", "need a medium"});
  expect_user_error([&] { load_with_sidecar("materials:\n  paint:\n    foliage: 3\n", wall); },
                    {"radio.yaml:3", "materials.paint.foliage", "found '3'"});
}

TEST(RadioSidecar, ErrorsHaveFileAndLine) {
  const auto refuse = [](const std::string& yaml, const std::vector<std::string>& parts) {
    expect_user_error([&] { load_with_sidecar(yaml, {{"name", "paint"}}); }, parts);
  };
  refuse("materials:\n  paint:\n    itu: concrete\n    colour: red\n",
         {"radio.yaml:4", "unknown key 'colour'", "materials.paint"});
  // An entry that the model does not use is checked as well.
  refuse("materials:\n  paint: { itu: concrete }\n  other: { itu: cheese }\n", {"radio.yaml:3", "cheese"});
  refuse("materials:\n  paint: { itu: concrete, thickness_m: -1 }\n", {"radio.yaml:2", "thickness_m", "-1"});
  refuse("materials:\n  paint: { itu: concrete, thickness_m: \"0.3\" }\n", {"radio.yaml:2", "'0.3'"});
  refuse("stuff: 1\n", {"radio.yaml:1", "unknown key 'stuff'"});
  refuse("materials:\n  - paint\n", {"radio.yaml", "materials: expected a map"});
  refuse("materials:\n  paint: { itu: concrete\n", {"radio.yaml", "well-formed YAML"});
  refuse("materials:\n  paint: { itu: concrete }\n  paint: { itu: glass }\n",
         {"radio.yaml:3", "materials: expected every key once, found a second 'paint'"});
  refuse("", {"radio.yaml:1", "expected a map"});
  refuse("materials: {}\n---\nmaterials: {}\n", {"radio.yaml:3", "expected one YAML document, found 2"});
  refuse("materials:\n  paint: { itu: concrete, roughnes_m: 0.1 }\n",
         {"radio.yaml:2", "did you mean 'roughness_m'"});
  LoadOptions missing;
  missing.radio_materials = "/nonexistent/radio.yaml";
  expect_user_error(
      [&] {
        quad_with({{"name", "paint"}}).load(missing);
      },
      {"/nonexistent/radio.yaml", "exist"});
}

}  // namespace
}  // namespace greatx::scene
