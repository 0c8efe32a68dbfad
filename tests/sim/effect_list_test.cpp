// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the table of effects. Each row is a member of the plan, and has a name, a rule about switching, and
// the struct that holds the switch.
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/experiment/experiment.h"
#include "sim/plan/plan_options.h"
#include "sim/scenario/parse/load_scenario.h"

namespace greatx::sim {
namespace {

Scenario with_effect(const std::string& name, const char* wish) {
  return parse_scenario(
      fmt::format("greatx: 1\nname: x\nticks: 1\nnodes: []\neffects: {{{}: {}}}\n", name, wish), "s.yaml",
      ".");
}

const Effect& called(const EffectPlan& plan, const std::string& name) {
  for (const Effect* effect : plan.all())
    if (effect->name == name) return *effect;
  throw std::runtime_error("no effect " + name);
}

TEST(EffectList, MembersHaveTheirOwnNames) {
  const EffectPlan plan;
  std::set<std::string> names;
  for (const Effect* effect : plan.all()) names.insert(effect->name);
  EXPECT_EQ(names.size(), plan.all().size());
  EXPECT_EQ(plan.all().front(), &plan.acceleration_structure);
  EXPECT_EQ(plan.all().back(), &plan.consistency);
  EXPECT_EQ(&called(plan, "diffraction_lit_region"), &plan.diffraction_lit_region);
  EXPECT_EQ(&called(plan, "lidar_haze"), &plan.lidar_haze);
}

TEST(EffectList, ScenariosSwitchWhatIsSwitchableAndNothingElse) {
  size_t fixed = 0;
  const EffectPlan rows;
  for (const Effect* row : rows.all()) {
    SCOPED_TRACE(row->name);
    if (row->switchable) {
      const EffectPlan off = make_effect_plan(with_effect(row->name, "off"), {});
      EXPECT_FALSE(called(off, row->name).on);
      EXPECT_NE(called(off, row->name).reason, "") << "nobody decided it";
      continue;
    }
    ++fixed;
    EXPECT_THAT([&] { make_effect_plan(with_effect(row->name, "on"), {}); },
                testing::ThrowsMessage<UserError>(
                    ::testing::HasSubstr(fmt::format("effects.{}: cannot be switched", row->name))));
  }
  EXPECT_GT(fixed, 10u);
}

TEST(EffectList, OptionsHaveTheSwitchesOfTheirNames) {
  EffectPlan plan;
  const render::CameraEffects none = camera_effects(plan);
  EXPECT_FALSE(none.sun || none.sky || none.textures || none.punctual_lights || none.haze || none.night_sky);
  EXPECT_TRUE(none.specular) << "is no effect of the plan";
  plan.moving_shadows.on = plan.ambient_occlusion.on = true;
  const render::CameraEffects some = camera_effects(plan);
  EXPECT_TRUE(some.moving_shadows && some.ambient_occlusion);
  EXPECT_FALSE(some.static_shadows || some.normal_maps || some.alpha_mask || some.emissive);

  const rf::RadioEffects quiet = radio_switches(plan);
  EXPECT_FALSE(quiet.line_of_sight || quiet.reflection || quiet.diffraction_lit_region || quiet.field.rain);
  plan.diffraction_lit_region.on = plan.scattering.on = plan.rain.on = true;
  const rf::RadioEffects loud = radio_switches(plan);
  EXPECT_TRUE(loud.diffraction_lit_region && loud.scattering && loud.field.rain);
  EXPECT_TRUE(loud.field.scattering) << "what is scattered is not reflected";
  EXPECT_FALSE(loud.diffraction || loud.free_edges || loud.field.fog || loud.field.roughness);
}

TEST(Experiment, OthersShareItsWorld) {
  const Experiment first = make_experiment(with_effect("sky", "auto"));
  const Experiment second = make_experiment(with_effect("sky", "on"), first.world);
  EXPECT_EQ(first.world, second.world);
  EXPECT_EQ(&first.scene(), &first.world->scene);
  EXPECT_FALSE(first.plan.sky.on);
  EXPECT_TRUE(second.plan.sky.on);
}

}  // namespace
}  // namespace greatx::sim
