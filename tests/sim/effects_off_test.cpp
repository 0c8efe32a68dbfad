// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests that an effect that is off costs nothing: it builds no pipeline, records no pass, and enters no
// code that changes a byte. Every effect that can be switched is tried in a yard
// that has something for each of them to act on.
#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/sim/radio_run.h"

namespace greatx::sim {
namespace {

using test::KeptRun;
using test::TinyScene;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// ------------------------------------------------------------------------------------------------- the yard

scene::Texture checks(const char* name, uint8_t alpha) {
  scene::Texture texture;
  texture.name = name;
  texture.width = texture.height = 8;
  for (uint32_t i = 0; i < 64; ++i) {
    const bool dark = (i % 8 < 4) != (i / 8 < 4);
    const uint8_t shade = dark ? 60 : 220;
    texture.rgba.insert(texture.rgba.end(), {shade, shade, shade, dark ? alpha : uint8_t(255)});
  }
  return texture;
}

scene::Material surface(const std::string& name, const std::string& itu, double thickness_m = 0.0) {
  scene::Material material = testing::radio_material(itu, thickness_m);
  material.name = name;
  material.pbr.metallic = 0.0f;
  material.pbr.base_color = {0.5f, 0.5f, 0.5f, 1.0f};
  return material;
}

/// Returns a yard with a ground that is textured, bumpy, rough and scatters, a wall, a pane, a fence with
/// holes, a marking, a sign that glows, a lamp, a pole, the crown of a tree with a plate behind it, and body
/// 1, a van.
scene::Scene yard() {
  TinyScene tiny;
  scene::Material ground = surface("ground", "concrete");
  ground.pbr.base_color_texture = int32_t(tiny.texture(checks("tiles", 255)));
  scene::Texture lean = checks("lean", 255);
  lean.srgb = false;
  for (size_t i = 0; i < 64; ++i)
    lean.rgba[4 * i] = 191, lean.rgba[4 * i + 1] = 128, lean.rgba[4 * i + 2] = 238;
  ground.pbr.normal_texture = int32_t(tiny.texture(lean));
  ground.radio->roughness_m = 5e-3;
  ground.radio->scattering_coefficient = 0.4;
  scene::Material fence = surface("fence", "wood", 0.02);
  fence.pbr.base_color_texture = int32_t(tiny.texture(checks("holes", 0)));
  fence.pbr.alpha_mode = scene::AlphaMode::mask;
  fence.pbr.double_sided = true;
  scene::Material sign = surface("sign", "metal");
  sign.pbr.emissive = vec3(50.0f);
  scene::Material pane = surface("pane", "glass", 0.006);
  pane.pbr.transmission = 0.8f;
  pane.pbr.roughness = 0.1f;
  scene::Material leaves;
  leaves.name = "leaves";
  leaves.radio.emplace().foliage.emplace();
  const uint32_t g = tiny.material_as(ground), w = tiny.material_as(surface("wall", "concrete"));
  const uint32_t f = tiny.material_as(fence), s = tiny.material_as(sign), p = tiny.material_as(pane);
  const uint32_t l = tiny.material_as(leaves), v = tiny.material_as(surface("van", "metal"));
  scene::Material lens = surface("switched_red", "glass", 0.003);
  lens.pbr.emissive = vec3(50.0f);
  const uint32_t van = tiny.body("van"), q = tiny.material_as(lens);
  tiny.object("ground", 0, g).quad({-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0});
  tiny.object("house", 0, w).box({-14, 8, 0}, {16, 12, 6});
  tiny.object("fence", 0, f).quad({4, 6, 0}, {4, 1.5, 0}, {4, 1.5, 4}, {4, 6, 4});
  tiny.object("pane", 0, p).quad({5, -9, 0}, {5, -14, 0}, {5, -14, 4}, {5, -9, 4});
  tiny.object("sign", 0, s).quad({15, 2, 6}, {15, -2, 6}, {15, -2, 9}, {15, 2, 9});
  tiny.object("crown", 0, l).box({-2, -0.6, 1.0}, {2, 1.2, 3.2});
  tiny.object("plate", 0, v).quad({8, 0.6, 1.6}, {8, 0.1, 1.6}, {8, 0.1, 2.1}, {8, 0.6, 2.1});
  tiny.object("lens", 0, q).quad({15, 4, 6}, {15, 2.5, 6}, {15, 2.5, 9}, {15, 4, 9});
  tiny.object("line", 0, w).quad({-2, 2, 0.02}, {3, 2, 0.02}, {3, 2.2, 0.02}, {-2, 2.2, 0.02});
  tiny.object("pole", 0, w).box({12, 5, 0}, {12.1, 5.1, 5});
  tiny.object("van", van, v).box({-1, -2, 0}, {1, 2, 5});
  scene::Scene scene = tiny.build();
  for (scene::Instance& instance : scene.instances)
    if (instance.name == "line")
      instance.semantic_class = scene::SemanticClass::lane_marking;
    else if (instance.name == "pole")
      instance.semantic_class = scene::SemanticClass::pole;
  for (vec4& tangent : scene.tangents) tangent = vec4(1, 0, 0, 1);
  scene::PunctualLight lamp;
  lamp.name = "lamp";
  lamp.position = {9.0, -4.0, 5.0};
  lamp.intensity = 80000.0f;
  scene.lights.push_back(lamp);
  return scene;
}

enum Sensor { camera_sensor, lidar_sensor, radar_sensor, channel_sensor, sensing_sensor };

const char* const sensor_texts[] = {
    "      - {name: camera, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90, "
    "outputs: [rgb, hdr, depth]}\n",
    "      - {name: lidar, type: lidar, rate_hz: 10, channels: 16, elevation_min_deg: -25, "
    "elevation_max_deg: "
    "20, azimuth_steps: 180, sweep_s: 0.1, max_range_m: 60, beam: {divergence_mrad: 6, rings: 1}, "
    "detection: {range_m: 60, reflectance: 0.2, probability: 0.8, threshold: 4}, "
    "noise: {range_m: 0.02, rise_m: 0.1}, returns: {mode: all, most: 3, resolution_m: 0.5}}\n",
    "      - {name: radar, type: radar, rate_hz: 10, waveform: {carrier_hz: 77e9, bandwidth_hz: 300e6, "
    "samples: 64, sample_rate_hz: 25e6, adc_start_s: 1.5e-6, chirp_s: 12e-6, interval_s: 13e-6, chirps: 32}, "
    "receiver: {noise_figure_db: 12, phase_noise: {level_dbc_hz: -95, pole_hz: 2e6}, "
    "adc: {bits: 10, full_scale_dbm: -20}, leakage: {level_db: -60, length_m: 0.1}}, interference: {radars: "
    "[rig/other]}}\n"
    "      - {name: other, type: radar, rate_hz: 10, mount: {position_m: [0.5, 0, 0.2]}, echoes: {tubes: "
    "100}, "
    "waveform: {carrier_hz: 77e9, bandwidth_hz: 100e6, samples: 64, sample_rate_hz: 25e6, adc_start_s: "
    "1.5e-6, "
    "chirp_s: 12e-6, interval_s: 13e-6, chirps: 32}, transmit: {columns: 1}, receive: {columns: 1}}\n",
    "", ""};

/// Switches every effect that can be switched: on if it is in `on`, else off.
std::string switches_with(const std::set<std::string>& on) {
  const EffectPlan rows;
  std::string text = "effects: {";
  for (const Effect* row : rows.all())
    if (row->switchable)
      text += fmt::format("{}{}: {}", text.back() == '{' ? "" : ", ", row->name,
                          on.contains(row->name) ? "on" : "off");
  return text + "}\n";
}

std::string yard_scenario(Sensor sensor, const std::string& effects, uint32_t depth = 2, bool night = false) {
  std::string yaml =
      "greatx: 1\nname: yard\nseed: 5\nticks: 2\ntick_rate_hz: 10\n"
      "environment: {rain_mm_h: 30, fog_g_m3: 0.1, snow: 0.5, " +
      std::string(night ? "sky: clear, sun: {azimuth_deg: 200, elevation_deg: -30}, moon: {azimuth_deg: 0, "
                          "elevation_deg: 12}"
                        : "sun: {azimuth_deg: 200, elevation_deg: 40, illuminance_lux: 5e4}") +
      "}\nnodes:\n"
      "  - name: rig\n"
      "    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-12, 0.4, 1.8]}, {t_s: 1, "
      "position_m: "
      "[-11, 0.4, 1.8]}]}\n"
      "    sensors:\n"
      "      - {name: antenna, type: antenna, columns: 2, column_spacing_wl: 40}\n";
  yaml += sensor_texts[sensor];
  yaml +=
      "  - name: van\n"
      "    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [0, -7, 0]}, {t_s: 1, position_m: [0, "
      "-4, 0]}]}\n" +
      std::string(sensor == sensing_sensor ? "    model: {generate: {kind: car}}\n" : "") +
      "  - name: mast\n"
      "    trajectory: {type: static, position_m: [12, 0.2, 3]}\n"
      "    sensors: [{name: antenna, type: antenna}]\n";
  if (sensor == channel_sensor)
    yaml += fmt::format(
        "channels:\n  - {{name: csi, tx: mast/antenna, rx: [rig/antenna], rate_hz: 10, carrier_hz: 28e9, "
        "bandwidth_hz: 400e6, subcarriers: 16, time_samples: 2, max_depth: {}}}\n",
        depth);
  if (sensor == sensing_sensor)
    yaml +=
        "channels:\n  - {name: csi, tx: mast/antenna, rx: [rig/antenna], rate_hz: 10, carrier_hz: 28e9, "
        "bandwidth_hz: 400e6, subcarriers: 32, time_samples: 16, max_depth: 2, targets: [{nodes: van, "
        "tr38901: "
        "vehicle}], sensing: {power_dbm: 30, noise_figure_db: 7, adc: {bits: 8, full_scale_dbm: -20}, "
        "leakage: "
        "{level_db: -60}, clutter_removal: none}}\n";
  return yaml + effects;
}

KeptRun run_yard(const std::string& yaml) {
  Scenario scenario = parse_scenario(yaml, "yard.yaml", ".");
  World world{yard(), {0, 1, 0}, {0, 1}, {}, {World::no_part, World::no_part}};  // the van follows its node
  world.scene.hash = scene::hash_of(world.scene);
  return test::keep_run(
      make_experiment(std::move(scenario), std::make_shared<const World>(std::move(world))));
}

// --------------------------------------------------------------------------------------------- what was done

/// Describes everything that a run built, recorded and counted.
struct Work {
  std::vector<std::string> pipelines;
  std::map<std::string, uint64_t> passes, counters;
  uint64_t dispatches = 0, draws = 0;

  explicit Work(const KeptRun& run)
      : pipelines(run.counters.pipelines),
        counters(run.statistics.counters),
        dispatches(run.counters.dispatches),
        draws(run.counters.draws) {
    for (const auto& [name, pass] : run.statistics.passes) passes[name] = pass.count;
  }
  bool operator==(const Work&) const = default;
  std::string text() const {
    return fmt::format("pipelines {}; passes {}; {} dispatches, {} draws; counters {}",
                       fmt::join(pipelines, ", "), passes, dispatches, draws, counters);
  }
};

std::vector<std::vector<std::byte>> bytes_of(const KeptRun& run) {
  std::vector<std::vector<std::byte>> all;
  for (const Packet& packet : run.packets)
    for (const Record& record : packet.records)
      for (const Array& array : record.arrays) all.emplace_back(array.bytes.begin(), array.bytes.end());
  return all;
}

TEST(EffectsOff, ALineOfSightBuildsAndRecordsThisAndNothingElse) {
  const KeptRun bare = run_yard(yard_scenario(channel_sensor, switches_with({"line_of_sight"})));
  const Work work(bare);
  EXPECT_THAT(work.pipelines, ElementsAre("crossings"));
  std::vector<std::string> passes;
  for (const auto& [name, count] : work.passes) passes.push_back(name);
  if (test::device().tracer() == gpu::Tracer::tree)
    EXPECT_THAT(passes, ElementsAre("crossings"));
  else
    EXPECT_THAT(passes, ElementsAre("crossings", "tlas build", "tlas refit"));
  EXPECT_EQ(bare.counter("csi.paths"), 2u);
  EXPECT_EQ(bare.counter("csi.geometric_paths"), 2u);
  EXPECT_EQ(work.draws, 0u);
}

TEST(EffectsOff, OtherSensorsBuildAndRecordThisAndNothingElse) {
  const auto built = [](Sensor sensor) {
    return run_yard(yard_scenario(sensor, switches_with({}))).counters.pipelines;
  };
  EXPECT_THAT(built(camera_sensor),
              ElementsAre("rig/camera visibility", "rig/camera visibility of closed things",
                          "rig/camera visibility of bodies", "rig/camera visibility of closed bodies",
                          "rig/camera shade", "rig/camera edges", "rig/camera develop"));
  EXPECT_THAT(built(lidar_sensor), ElementsAre("rig/lidar"));
  EXPECT_THAT(built(radar_sensor), Each(HasSubstr("radar")));  // none where the host traces
}

TEST(EffectsOff, WhatHasNothingToActOnIsNotBuiltUnderAuto) {
  // In an empty world without weather, `auto` does no more than a scenario that switches everything off.
  const auto run_empty = [](const std::string& effects) {
    std::string yaml = yard_scenario(channel_sensor, effects, 3);
    yaml.erase(yaml.find("environment:"), yaml.find("nodes:") - yaml.find("environment:"));
    yaml.replace(yaml.find("time_samples: 2"), 15, "time_samples: 1");
    yaml.replace(yaml.find("columns: 2, column_spacing_wl: 40"), 33, "columns: 1");
    return test::keep_run(testing::experiment_in(yaml, TinyScene().build()));
  };
  const KeptRun automatic = run_empty("tolerance_db: 0.1\n");
  const KeptRun bare = run_empty(switches_with({"line_of_sight"}));
  EXPECT_EQ(Work(automatic).text(), Work(bare).text());
  test::expect_same_bytes(automatic, bare);
}

TEST(EffectsOff, OnlyAWideSceneHasShadowCascades) {
  for (const double half : {150.0, 300.0}) {
    TinyScene tiny;
    tiny.object("ground").quad({-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0});
    const Experiment experiment = testing::experiment_in(yard_scenario(camera_sensor, ""), tiny.build());
    EXPECT_TRUE(experiment.plan.static_shadows.on);
    EXPECT_EQ(experiment.plan.shadow_cascades.on, half > 200.0) << experiment.plan.shadow_cascades.reason;
  }
}

/// Names an effect, what it needs to be on beside it, and the sensor that has it.
struct Tried {
  Sensor sensor;
  std::set<std::string> beside;
  bool night = false;
};

const std::map<std::string, Tried> tried{
    {"sun", {camera_sensor, {}}},
    {"sky", {camera_sensor, {}}},
    {"static_shadows", {camera_sensor, {"sun"}}},
    {"moving_shadows", {camera_sensor, {"sun"}}},
    {"shadow_cascades", {camera_sensor, {"sun", "static_shadows"}}},
    {"ambient_occlusion", {camera_sensor, {"sky"}}},
    {"contact_occlusion", {camera_sensor, {"sky"}}},
    {"bounced_light", {camera_sensor, {"sky", "ambient_occlusion"}}},
    {"glass", {camera_sensor, {"sky"}}},
    {"panes", {camera_sensor, {"sky"}}},
    {"textures", {camera_sensor, {"sky"}}},
    {"normal_maps", {camera_sensor, {"sun", "textures"}}},
    {"alpha_mask", {camera_sensor, {"sky"}}},
    {"emissive", {camera_sensor, {"sky"}}},
    {"switched_lamps", {camera_sensor, {"sky"}}},
    {"punctual_lights", {camera_sensor, {"sky"}}},
    {"haze", {camera_sensor, {"sky"}}},
    {"night_sky", {camera_sensor, {"sky"}, true}},
    {"clouds", {camera_sensor, {"sky"}}},
    {"horizon", {camera_sensor, {"sky"}}},
    {"markings", {camera_sensor, {"sky"}}},
    {"thin_lines", {camera_sensor, {"sky"}}},
    {"wet_surfaces", {camera_sensor, {"sky"}}},
    {"snow_cover", {camera_sensor, {"sky"}}},
    {"rain_streaks", {camera_sensor, {"sky"}}},
    {"lamp_shadows", {camera_sensor, {"punctual_lights"}}},
    {"lamp_halos", {camera_sensor, {"punctual_lights", "haze"}}},
    {"consistency", {camera_sensor, {}}},
    {"lidar_alpha_mask", {lidar_sensor, {}}},
    {"lidar_textures", {lidar_sensor, {}}},
    {"lidar_sweep_motion", {lidar_sensor, {}}},
    {"lidar_target_motion", {lidar_sensor, {"lidar_sweep_motion"}}},
    {"lidar_divergence", {lidar_sensor, {}}},
    {"lidar_glass", {lidar_sensor, {}}},
    {"lidar_haze", {lidar_sensor, {}}},
    {"lidar_backscatter", {lidar_sensor, {"lidar_haze", "lidar_detection"}}},
    {"lidar_detection", {lidar_sensor, {}}},
    {"lidar_range_noise", {lidar_sensor, {}}},
    {"radar_roughness", {radar_sensor, {}}},
    {"radar_clutter", {radar_sensor, {}}},
    {"radar_air", {radar_sensor, {}}},
    {"radar_transmission", {radar_sensor, {}}},
    {"radar_edges", {radar_sensor, {}}},
    {"radar_noise", {radar_sensor, {}}},
    {"radar_phase_noise", {radar_sensor, {}}},
    {"radar_quantisation", {radar_sensor, {}}},
    {"radar_leakage", {radar_sensor, {}}},
    {"radar_interference", {radar_sensor, {}}},
    {"radar_rain", {radar_sensor, {}}},
    {"line_of_sight", {channel_sensor, {"reflection"}}},
    {"reflection", {channel_sensor, {}}},
    {"moving_reflectors", {channel_sensor, {"reflection"}}},
    {"transmission", {channel_sensor, {"reflection"}}},
    {"diffraction", {channel_sensor, {}}},
    {"diffraction_lit_region", {channel_sensor, {"diffraction"}}},
    {"corner_diffraction", {channel_sensor, {"diffraction", "diffraction_lit_region"}}},
    {"free_edges", {channel_sensor, {"diffraction", "diffraction_lit_region"}}},
    {"scattering", {channel_sensor, {}}},
    {"roughness", {channel_sensor, {"reflection"}}},
    {"finite_reflectors", {channel_sensor, {"reflection"}}},
    {"gas", {channel_sensor, {}}},
    {"rain", {channel_sensor, {}}},
    {"fog", {channel_sensor, {}}},
    {"foliage", {channel_sensor, {}}},
    {"dispersion", {channel_sensor, {"reflection"}}},
    {"doppler", {channel_sensor, {}}},
    {"wave_curvature", {channel_sensor, {}}},
    {"beam_squint", {channel_sensor, {}}},
    {"every_element", {channel_sensor, {}}},
    {"target_echoes", {sensing_sensor, {}}},
    {"sensing_noise", {sensing_sensor, {}}},
    {"sensing_quantisation", {sensing_sensor, {}}},
    {"sensing_leakage", {sensing_sensor, {}}},
};

const Effect& effect_called(const EffectPlan& plan, const std::string& name) {
  for (const Effect* effect : plan.all())
    if (effect->name == name) return *effect;
  throw std::runtime_error("no effect " + name);
}

TEST(EffectsOff, EveryEffectWorksWhenItIsOnAndDoesNothingWhenItIsOff) {
  const EffectPlan rows;
  for (const Effect* row : rows.all()) EXPECT_EQ(row->switchable, tried.contains(row->name)) << row->name;
  std::map<std::string, KeptRun> without;  // by sensor and effects
  const auto run_with = [&](const Tried& one, const std::set<std::string>& on) -> const KeptRun& {
    std::set<std::string> effects = on;
    if (one.sensor >= channel_sensor && !on.contains("reflection")) effects.insert("line_of_sight");
    const std::string yaml = yard_scenario(one.sensor, switches_with(effects), 2, one.night);
    const auto [known, is_new] = without.try_emplace(yaml);
    if (is_new) known->second = run_yard(yaml);
    return known->second;
  };
  for (const auto& [name, one] : tried) {
    SCOPED_TRACE(name);
    std::set<std::string> on = one.beside;
    on.insert(name);
    const KeptRun &off_run = run_with(one, one.beside), &on_run = run_with(one, on);
    EXPECT_FALSE(effect_called(off_run.plan, name).on);
    EXPECT_TRUE(effect_called(on_run.plan, name).on) << effect_called(on_run.plan, name).reason;
    const Work idle(off_run), busy(on_run);
    // On: more is built or counted, or other code runs and gives other bytes.
    EXPECT_TRUE(idle != busy || bytes_of(off_run) != bytes_of(on_run))
        << "the effect has nothing to act on: " << idle.text();
    // Off: nothing is built or recorded that is not there with the effect on.
    EXPECT_LE(idle.pipelines.size(), busy.pipelines.size());
    for (const auto& [pass, count] : idle.passes) {
      const auto same = busy.passes.find(pass);
      EXPECT_LE(count, same == busy.passes.end() ? 0 : same->second) << pass;
    }
  }
}

}  // namespace
}  // namespace greatx::sim
