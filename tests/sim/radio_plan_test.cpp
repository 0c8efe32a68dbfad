// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests which radio effects a scenario needs and why, and that omitted effects are as small as the plan says.
#include "sim/plan/radio_plan.h"

#include <cmath>
#include <complex>
#include <cstdio>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.h"
#include "rf/paths/radio_model.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/sim/radio_run.h"

namespace greatx::sim {
namespace {

using sim::testing::radio_material;
using sim::testing::RadioRun;
using sim::testing::run;
using test::TinyScene;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Returns a scenario with one channel, and a base station and a terminal 30 m apart above the ground.
std::string planned_scenario(const std::string& channel = "", const std::string& more = "") {
  return "greatx: 1\nname: test\nseed: 5\nticks: 1\ntick_rate_hz: 10\n"
         "nodes:\n"
         "  - name: bs\n    trajectory: {type: static, position_m: [-15, 0, 8]}\n"
         "    sensors: [{name: antenna, type: antenna}]\n"
         "  - name: ue\n    trajectory: {type: static, position_m: [15, 1, 1.5]}\n"
         "    sensors: [{name: antenna, type: antenna}]\n"
         "channels:\n  - {name: csi, tx: bs/antenna, rx: [ue/antenna], rate_hz: 10, subcarriers: 16, "
         "bandwidth_hz: 20e6, max_depth: 2" +
         channel + "}\n" + more;
}

/// Returns a ground and walls of these materials.
scene::Scene planned_street(scene::Material ground, scene::Material wall) {
  TinyScene tiny;
  const uint32_t g = tiny.material_as(ground), w = tiny.material_as(wall);
  tiny.object("ground", 0, g).quad({-30, -20, 0}, {30, -20, 0}, {30, 20, 0}, {-30, 20, 0});
  tiny.object("wall", 0, w).quad({-30, 9, 0}, {30, 9, 0}, {30, 9, 12}, {-30, 9, 12});
  tiny.object("fence", 0, w).quad({5, -20, 0}, {5, 20, 0}, {5, 20, 1}, {5, -20, 1});
  return tiny.build();
}
scene::Scene planned_street() {
  return planned_street(radio_material("medium_dry_ground"), radio_material("concrete"));
}

EffectPlan plan(const std::string& yaml, const scene::Scene& scene) {
  return make_effect_plan(parse_scenario(yaml, "test.yaml", "."), scene);
}

void expect(const Effect& effect, bool on, const std::string& reason, const std::string& bound = "") {
  EXPECT_EQ(effect.on, on) << effect.name << ": " << effect.reason;
  EXPECT_THAT(effect.reason, HasSubstr(reason)) << effect.name;
  EXPECT_THAT(effect.bound, HasSubstr(bound)) << effect.name;
}

const std::string switches(const std::string& effects) { return "effects: {" + effects + "}\n"; }

TEST(RadioPlan, WithoutAChannelThereIsNone) {
  std::string yaml = planned_scenario();
  yaml.resize(yaml.find("channels:"));
  const EffectPlan none = plan(yaml, planned_street());
  for (const Effect* effect :
       {&none.channel, &none.line_of_sight, &none.reflection, &none.transmission, &none.diffraction,
        &none.scattering, &none.roughness, &none.gas, &none.rain, &none.fog, &none.foliage, &none.dispersion,
        &none.doppler, &none.finite_reflectors})
    expect(*effect, false, "no channel");
}

TEST(RadioPlan, ReflectionsComeWithSurfacesAndDepth) {
  expect(plan(planned_scenario(), planned_street()).reflection, true, "up to 2", "none is missed");
  expect(plan(planned_scenario(", candidates: rays"), planned_street()).reflection, true, "up to 2",
         "may be missed");
  expect(plan(planned_scenario(), TinyScene().build()).reflection, false, "no surface");
  std::string flat = planned_scenario();
  flat.replace(flat.find("max_depth: 2"), 12, "max_depth: 0");
  expect(plan(flat, planned_street()).reflection, false, "max_depth is 0");
  expect(plan(planned_scenario("", switches("reflection: off")), planned_street()).reflection, false,
         "switched off (");
  expect(plan(planned_scenario("", switches("line_of_sight: off")), planned_street()).line_of_sight, false,
         "switched off (");
}

TEST(RadioPlan, TransmissionComesWithThinWalls) {
  expect(plan(planned_scenario(), planned_street()).transmission, false, "no material lets waves pass");
  const scene::Scene thin =
      planned_street(radio_material("medium_dry_ground"), radio_material("glass", 0.01));
  const EffectPlan walls = plan(planned_scenario(), thin);
  expect(walls.transmission, true, "1 materials let waves pass, up to 2 walls", "glass wall, takes");
  expect(plan(planned_scenario(", max_transmissions: 0"), thin).transmission, false, "max_transmissions");
  std::string deep = planned_scenario();
  deep.replace(deep.find("max_depth: 2"), 12, "max_depth: 16");
  expect(plan(deep, thin).transmission, true, "up to 8 walls");
  expect(plan(planned_scenario("", switches("transmission: off")), thin).transmission, false,
         "switched off (");
  const scene::Scene dark =
      planned_street(radio_material("medium_dry_ground"), radio_material("metal", 0.002));
  expect(plan(planned_scenario(), dark).transmission, false, "take 100 dB or more");
}

TEST(RadioPlan, TransmissionComesWithWindows) {
  scene::Material facade = radio_material("concrete");  // a half-space
  facade.radio->windows = scene::RadioWindows{0.22, {{*scene::itu_medium("glass"), 0.006}}};
  const scene::Scene glazed = planned_street(radio_material("medium_dry_ground"), facade);
  expect(plan(planned_scenario(), glazed).transmission, true, "1 materials let waves pass",
         "concrete, takes");
  facade.radio->windows->share = 0.0;
  expect(plan(planned_scenario(), planned_street(radio_material("medium_dry_ground"), facade)).transmission,
         false, "no material lets waves pass");
}

TEST(RadioPlan, TheAirComesWithDistanceAndFrequency) {
  const scene::Scene scene = planned_street();
  expect(plan(planned_scenario(", carrier_hz: 3.5e9"), scene).gas, false, "within the tolerance", "at most");
  expect(plan(planned_scenario(", carrier_hz: 39e9"), scene).gas, true, "more than the tolerance",
         "at 39 GHz");
  expect(plan(planned_scenario(", carrier_hz: 39e9", "tolerance_db: 1\n"), scene).gas, false,
         "within the tolerance");
  expect(plan(planned_scenario(", carrier_hz: 39e9", switches("gas: off")), scene).gas, false,
         "switched off (more");
  expect(plan(planned_scenario("", switches("gas: on")), scene).gas, true, "switched on (within");
  EXPECT_THAT(plan(planned_scenario(), scene).rain.bound, IsEmpty());
  expect(plan(planned_scenario(), scene).rain, false, "no rain");
  expect(plan(planned_scenario("", "environment: {rain_mm_h: 2}\n"), scene).rain, false,
         "within the tolerance", "at most");
  expect(plan(planned_scenario(", carrier_hz: 28e9", "environment: {rain_mm_h: 25}\n"), scene).rain, true,
         "more");
  expect(plan(planned_scenario(), scene).fog, false, "no fog");
  expect(plan(planned_scenario("", "environment: {fog_g_m3: 0.05}\n"), scene).fog, false, "within",
         "at most");
  expect(plan(planned_scenario(", carrier_hz: 39e9", "environment: {fog_g_m3: 0.5}\n"), scene).fog, true,
         "more");
  expect(plan(planned_scenario(", carrier_hz: 0.5e9"), TinyScene().build()).gas, false,
         "does not cover 0.5 GHz");
}

TEST(RadioPlan, TheAirIsBoundedForTheChannelThatItTakesMostFrom) {
  // The oxygen band at 60 GHz attenuates ten times more than the air at 80 GHz.
  const std::string two =
      planned_scenario(", carrier_hz: 60e9") +
      "  - {name: second, tx: bs/antenna, rx: [ue/antenna], rate_hz: 10, subcarriers: 16, "
      "bandwidth_hz: 20e6, carrier_hz: 80e9}\n";
  expect(plan(two, TinyScene().build()).gas, true, "more", "at 60 GHz");
}

TEST(RadioPlan, AChannelThatTheAirDoesNotCoverGoesWithoutAndThePlanSaysSo) {
  const scene::Scene scene = TinyScene().build();
  const std::string two =
      planned_scenario(", carrier_hz: 39e9") +
      "  - {name: second, tx: bs/antenna, rx: [ue/antenna], rate_hz: 10, subcarriers: 16, "
      "bandwidth_hz: 20e6, carrier_hz: 0.5e9}\n";
  expect(plan(two + switches("gas: on"), scene).gas, true, "not at 0.5 GHz, which P.676-13 does not cover");
  rf::RadioEffects effects;
  effects.field.gas = effects.field.rain = true;
  effects.weather.rain_mm_h = 25.0;
  EXPECT_TRUE(rf::RadioModel(scene, 0.5e9, effects).field_model().attenuation.none());
  EXPECT_FALSE(rf::RadioModel(scene, 39e9, effects).field_model().attenuation.none());
  EXPECT_THROW(plan(planned_scenario(", carrier_hz: 0.5e9", switches("gas: on")), scene), UserError);
}

TEST(RadioPlan, RoughnessComesWithHeightsThatMatterOverAllReflections) {
  const auto rough = [](double rms_m) {
    scene::Material ground = radio_material("medium_dry_ground");
    ground.radio->roughness_m = rms_m;
    return planned_street(ground, radio_material("concrete"));
  };
  expect(plan(planned_scenario(), rough(0.0)).roughness, false, "no material has one");
  expect(plan(planned_scenario(), rough(1e-4)).roughness, false, "within", "over 2 reflections");
  expect(plan(planned_scenario(), rough(1e-2)).roughness, true, "more than the tolerance");
  // 0.3 mm cost 0.0084 dB per reflection. One reflection is within the tolerance of 0.01 dB, two are beyond
  // it.
  std::string once = planned_scenario();
  once.replace(once.find("max_depth: 2"), 12, "max_depth: 1");
  EXPECT_FALSE(plan(once, rough(3e-4)).roughness.on);
  EXPECT_TRUE(plan(planned_scenario(), rough(3e-4)).roughness.on);
}

TEST(RadioPlan, FiniteReflectorsComeWithEdges) {
  const auto decided = [](const std::string& more, const scene::Scene& scene) {
    return plan(planned_scenario("", more), scene).finite_reflectors;
  };
  expect(decided("", planned_street()), true, "more than the tolerance", "at most 6.02 dB");
  expect(decided("tolerance_db: 7\n", planned_street()), false, "within the tolerance", "at most 6.02 dB");
  expect(decided(switches("finite_reflectors: off"), planned_street()), false, "switched off (");
  expect(decided(switches("reflection: off"), planned_street()), false, "no reflection");
  // A sign of 0.1 m^2 covers 4 A/(lambda L) of what an endless wall reflects on the longest path, L.
  TinyScene tiny;
  const uint32_t metal = tiny.material_as(radio_material("metal"));
  tiny.object("sign", 0, metal).quad({-30, 9, 2}, {-29.5, 9, 2}, {-29.5, 9, 2.2}, {-30, 9, 2.2});
  const Effect sign = decided("", tiny.build());
  expect(sign, true, "more than the tolerance", "of 'sign'");
  EXPECT_THAT(sign.bound, HasSubstr("1 of 1 facets are smaller than a Fresnel zone can be"));
  // From inside, a closed room ends nowhere.
  TinyScene room;
  const uint32_t wall = room.material_as(radio_material("concrete"));
  const dvec3 a(-20, -5, 0), x(40, 0, 0), y(0, 10, 0), z(0, 0, 10);
  TinyScene& walls = room.object("room", 0, wall);
  walls.quad(a, a + y, a + y + z, a + z).quad(a + x, a + x + z, a + x + y + z, a + x + y);
  walls.quad(a, a + z, a + x + z, a + x).quad(a + y, a + x + y, a + x + y + z, a + y + z);
  walls.quad(a, a + x, a + x + y, a + y).quad(a + z, a + y + z, a + x + y + z, a + x + z);
  expect(decided("", room.build()), false, "no reflecting surface ends or bends outwards");
}

TEST(RadioPlan, FiniteReflectorsWeighTheReflectionsOfRuns) {
  // The fence is 1 m high: its reflections change, and nothing else does. Switched off, the run has the bytes
  // that an endless wall gives.
  const scene::Scene scene = planned_street();
  const RadioRun on = run(planned_scenario(), scene);
  const RadioRun off = run(planned_scenario("", switches("finite_reflectors: off")), scene);
  const auto lit = off.values<int32_t>(0, "path_count")[0];
  ASSERT_EQ(on.values<int32_t>(0, "path_count")[0], lit);
  const auto before = off.values<std::complex<float>>(0, "amplitude"),
             after = on.values<std::complex<float>>(0, "amplitude");
  size_t changed = 0;
  for (size_t i = 0; i < before.size(); ++i) changed += before[i] != after[i];
  EXPECT_EQ(before[0], after[0]) << "the line of sight";
  EXPECT_GT(changed, 0u);
}

TEST(RadioPlan, FoliageComesWithCrowns) {
  expect(plan(planned_scenario(), planned_street()).foliage, false, "the scene has none");
  scene::Material leaves;
  leaves.name = "leaves";
  leaves.radio.emplace().foliage.emplace();
  expect(plan(planned_scenario(), planned_street(radio_material("concrete"), leaves)).foliage, true,
         "crowns");
}

TEST(RadioPlan, WhatIsAskedForByName) {
  const EffectPlan silent = plan(planned_scenario(), planned_street());
  expect(silent.diffraction, false,
         "not asked for (effects: {diffraction: on}; accuracy: decides by measurement)", "6 dB");
  expect(silent.diffraction_lit_region, false, "diffraction is off");
  expect(silent.scattering, false, "no material has a scattering coefficient");
  expect(silent.dispersion, false, "not asked for");
  const EffectPlan asked = plan(
      planned_scenario("", switches("diffraction: on, dispersion: on, free_edges: on")), planned_street());
  expect(asked.diffraction, true, "switched on (");
  expect(asked.diffraction_lit_region, true, "continuous");
  expect(asked.free_edges, true, "switched on (");
  expect(asked.dispersion, true, "switched on (");
  // An effect without anything to act on is off, and the reason does not say "on".
  expect(plan(planned_scenario("", switches("scattering: on")), planned_street()).scattering, false,
         "nothing to act on (no material has");
  expect(plan(planned_scenario("", switches("diffraction: on")), TinyScene().build()).diffraction, false,
         "nothing to act on (the scene has no edge)");
  scene::Material wall = radio_material("concrete");
  wall.radio->scattering_coefficient = 0.3;
  const scene::Scene scatters = planned_street(radio_material("medium_dry_ground"), wall);
  expect(plan(planned_scenario(), scatters).scattering, false, "not asked for");
  expect(plan(planned_scenario("", switches("scattering: on")), scatters).scattering, true, "switched on (");
}

TEST(RadioPlan, DopplerComesWithTimeSamples) {
  expect(plan(planned_scenario(), planned_street()).doppler, false, "one time sample");
  expect(plan(planned_scenario(", time_samples: 8"), planned_street()).doppler, true, "8 time samples",
         "turns per m/s");
}

TEST(RadioPlan, EveryEffectHasAReasonAndUnknownNamesAreErrors) {
  const EffectPlan whole = plan(planned_scenario(), planned_street());
  for (const Effect* effect : whole.all()) EXPECT_FALSE(effect->reason.empty()) << effect->name;
  try {
    plan(planned_scenario("", switches("difraction: on")), planned_street());
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr("effects: 'difraction' is no effect (did you mean 'diffraction'?); expected one of"));
    EXPECT_THAT(error.what(), HasSubstr("diffraction"));
  }
  EXPECT_THROW(plan(planned_scenario("", switches("channel: off")), planned_street()), UserError);
}

TEST(RadioPlan, WeatherThatIsNoneIsAnErrorByField) {
  for (const auto& [field, value] : {std::pair("temperature_k", "20"), std::pair("pressure_hpa", "-1"),
                                     std::pair("water_vapour_g_m3", "nan"), std::pair("rain_mm_h", "-3"),
                                     std::pair("fog_g_m3", "11"), std::pair("rain", "3")}) {
    try {
      plan(planned_scenario("", fmt::format("environment: {{{}: {}}}\n", field, value)), planned_street());
      ADD_FAILURE() << field;
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), HasSubstr(std::string("test.yaml:"))) << field;
      EXPECT_THAT(error.what(), HasSubstr(std::string("environment.") + field)) << field;
    }
  }
}

// ---------------------------------------------------------------------------------------- effects left out

/// Returns the number of dB in a bound of the form "at most 0.00123 dB ...".
double bound_db(const Effect& effect) {
  const std::string before = "at most ";
  const size_t at = effect.bound.find(before);
  double decibels = 0.0;
  char unit[3] = "";
  EXPECT_TRUE(at != std::string::npos &&
              std::sscanf(effect.bound.c_str() + at + before.size(), "%lf %2s", &decibels, unit) == 2 &&
              std::string(unit) == "dB")
      << effect.name << ": " << effect.bound;
  return decibels;
}

/// Expects that no H(f) changes by more than if every path's amplitude changed by `most_db`.
void expect_within(const RadioRun& plain, const RadioRun& forced, double most_db, const std::string& name) {
  double amplitudes = 0.0;
  for (const std::complex<float>& a : plain.values<std::complex<float>>(0, "amplitude"))
    amplitudes += static_cast<double>(std::abs(a));
  ASSERT_GT(amplitudes, 0.0);
  const auto a = plain.values<std::complex<float>>(0, "cfr"),
             b = forced.values<std::complex<float>>(0, "cfr");
  ASSERT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (size_t i = 0; i < a.size(); ++i)
    largest = std::max(largest, std::abs(std::complex<double>(a[i]) - std::complex<double>(b[i])));
  EXPECT_LE(largest, (1.0 - std::pow(10.0, -most_db / 20.0) + 2e-7) * amplitudes) << name;
}

TEST(RadioPlan, ForcedWhereItIsWithinTheToleranceItChangesLessThanItsBound) {
  scene::Material ground = radio_material("medium_dry_ground");
  ground.radio->roughness_m = 1e-4;
  const scene::Scene scene = planned_street(ground, radio_material("concrete"));
  const std::string weather = "environment: {rain_mm_h: 2, fog_g_m3: 0.02}\n";
  const RadioRun plain = run(planned_scenario("", weather), scene);
  ASSERT_GE(plain.values<int32_t>(0, "path_count")[0], 4);
  for (const char* name : {"gas", "rain", "fog", "roughness"}) {
    const auto effect = [&](const RadioRun& r) {
      for (const Effect* e : r.plan.all())
        if (e->name == name) return *e;
      throw std::runtime_error(name);
    };
    EXPECT_FALSE(effect(plain).on) << name;
    EXPECT_THAT(effect(plain).reason, HasSubstr("within the tolerance"));
    const RadioRun forced = run(planned_scenario("", weather + switches(fmt::format("{}: on", name))), scene);
    EXPECT_TRUE(effect(forced).on) << name;
    const double bound = bound_db(effect(forced));
    EXPECT_LE(bound, 0.01) << name << ": the tolerance";
    expect_within(plain, forced, bound, name);
    EXPECT_FALSE(plain.array(0, "amplitude").bytes == forced.array(0, "amplitude").bytes)
        << name << " is to act when it is switched on";
  }
}

TEST(RadioPlan, ForcedWhereThereIsNothingItChangesNoByte) {
  const scene::Scene scene = planned_street();
  const RadioRun plain = run(planned_scenario(), scene);
  for (const char* name : {"rain", "fog", "foliage", "roughness", "transmission", "doppler"})
    sim::testing::expect_same_bytes(
        plain, run(planned_scenario("", switches(fmt::format("{}: on", name))), scene), name);
}

TEST(RadioPlan, WallsThatAreDarkAreOpaqueAmongOthers) {
  // 2 mm of metal attenuate by thousands of dB. They give the same bytes as a half-space, even beside panes
  // that transmit waves.
  const scene::Material pane = radio_material("glass", 0.01);
  for (const scene::Material& ground : {radio_material("medium_dry_ground"), pane}) {
    const RadioRun thick = run(planned_scenario("", switches("transmission: on")),
                               planned_street(ground, radio_material("metal"))),
                   thin = run(planned_scenario("", switches("transmission: on")),
                              planned_street(ground, radio_material("metal", 0.002)));
    EXPECT_EQ(thick.values<uint64_t>(0, "id"), thin.values<uint64_t>(0, "id"));
    expect_within(thick, thin, 1e-5, "metal");
  }
}

TEST(RadioPlan, DispersionLeavesTheCarrierAlone) {
  const scene::Scene scene = planned_street(radio_material("concrete"), radio_material("glass", 0.01));
  const std::string wide = ", carrier_hz: 28e9";
  const RadioRun plain = run(planned_scenario(wide), scene),
                 forced = run(planned_scenario(wide, switches("dispersion: on")), scene);
  const auto a = plain.values<std::complex<float>>(0, "cfr"),
             b = forced.values<std::complex<float>>(0, "cfr");
  EXPECT_LT(std::abs(a[8] - b[8]), 1e-6f * std::abs(a[8])) << "f_8 is the carrier";
  EXPECT_GT(std::abs(a[0] - b[0]), 1e-6f * std::abs(a[0])) << "10 MHz beside it";
}

TEST(RadioPlan, CrownsThatAreOffAreNotThere) {
  scene::Material leaves;
  leaves.name = "leaves";
  leaves.radio.emplace().foliage.emplace();
  TinyScene with, without;
  for (TinyScene* tiny : {&with, &without}) {
    const uint32_t g = tiny->material_as(radio_material("medium_dry_ground")), l = tiny->material_as(leaves);
    tiny->object("ground", 0, g).quad({-30, -20, 0}, {30, -20, 0}, {30, 20, 0}, {-30, 20, 0});
    if (tiny == &with) tiny->object("crown", 0, l).box({-3, -4, 0.5}, {3, 4, 7});
  }
  const RadioRun none = run(planned_scenario(), without.build());
  ASSERT_EQ(none.values<int32_t>(0, "path_count")[0], 2);
  for (const char* candidates : {"", ", candidates: rays, rays: 20000"}) {
    const RadioRun off = run(planned_scenario(candidates, switches("foliage: off")), with.build());
    EXPECT_TRUE(off.array(0, "cfr").bytes == none.array(0, "cfr").bytes) << candidates;
    const RadioRun on = run(planned_scenario(candidates), with.build());
    EXPECT_EQ(on.values<int32_t>(0, "path_count")[0], 2) << candidates;
    EXPECT_GT(on.values<double>(0, "foliage")[0], 5.0) << candidates;
    EXPECT_LT(on.values<double>(0, "path_gain")[0], 0.9 * none.values<double>(0, "path_gain")[0]);
  }
}

TEST(RadioPlan, RaysThatMeetNoEdgesAreRefusedBeforeAnythingIsBuilt) {
  const auto with = [](const std::string& candidates, const std::string& effects) {
    plan(planned_scenario(candidates, effects), planned_street());
  };
  EXPECT_NO_THROW(with(", candidates: rays", ""));
  EXPECT_NO_THROW(with("", switches("diffraction: on")));
  try {
    with(", candidates: rays", switches("diffraction: on"));
    ADD_FAILURE() << "no error";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("candidates: expected beams, since diffraction is on"));
  }
}

}  // namespace
}  // namespace greatx::sim
