// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares the echoes of cars and a drone at the default settings with physical optics by brute force. The
// cars are parked ones: brute force takes all pairs of facets, and a driving car has four times as many.
#include <algorithm>

#include <gtest/gtest.h>

#include "scene/build/build.h"
#include "scene/generator/generate.h"
#include "scene/generator/mesh/scene_writer.h"
#include "scene/generator/objects/vehicles.h"
#include "scene/gltf/model.h"
#include "tests/rf/radar_brute_force.h"
#include "tests/rf/radar_echo_scenes.h"

namespace greatx::rf {
namespace {

using namespace rf::testing;

std::vector<std::byte> file_of(const std::string& kind, const std::string& variant) {
  if (kind != "car") return scene::generate_glb({.kind = kind, .variant = variant});
  scene::generator::SceneWriter writer;
  const auto mesh = scene::generator::make_parked_car(variant, "car_paint_red");
  writer.add_node({.name = variant,
                   .mesh = writer.add_mesh(variant, mesh),
                   .semantic_class = scene::SemanticClass::vehicle});
  return writer.finish(variant);
}

scene::Scene vehicle(const std::string& kind, const std::string& variant) {
  const scene::Model model = scene::load_model(kind, file_of(kind, variant), {});
  return scene::build_scene({{.name = "", .model = &model, .pose = {}}}, {.name = kind});
}

/// Holds cross-sections of paths with one bounce, of paths with two bounces, and of all of them, dBsm.
struct Sections {
  double once, twice, all;
};

class Aspects {
 public:
  Aspects(scene::Scene scene, double carrier_hz)
      : scene_(std::move(scene)),
        gpu_(test::device(), scene_, {}),
        trees_(scene_),
        tracer_(scene_, trees_),
        world_(scene_),
        conductors_(scene_.materials.size(), conductor()),
        surfaces_(conductors_, carrier_hz),
        carrier_hz_(carrier_hz) {
    options_.max_bounces = 2;
  }
  /// Places the radar at 57 m, 15 degrees above the vehicle.
  static Pose radar_at(double azimuth) {
    const double elevation = radians(15.0);
    return looking(57.0 * dvec3(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation)),
                   dvec3(0.0));
  }
  Sections found(const Pose& radar) {
    EchoFinder finder(gpu_, surfaces_, EchoEnd{}, std::nullopt, options_);
    const EchoList list = trace_echoes(finder, gpu_, scene_.bodies.size(), at_rest(radar, radar));
    Complex sums[3] = {};
    for (const Echo& echo : list.echoes)
      sums[echo.bounces] +=
          echo.amplitude *
          std::polar(1.0, -2.0 * pi * std::remainder(carrier_hz_ * echo.delay.coefficients[0], 1.0));
    return sections(radar, sums[1], sums[2]);
  }
  Sections brute_force(const Pose& radar, double step_m) const {
    const EchoEnd end;
    const TurnedElement turned{end.pattern, std::span(&end.slant, 1), radar.orientation};
    const EchoField field(world_, surfaces_, options_, turned, turned, radar.position);
    const BruteForce::Fields fields =
        BruteForce({world_, trees_, tracer_}, field, radar.position, step_m).find();
    return sections(radar, fields.once, fields.twice);
  }

 private:
  Sections sections(const Pose& radar, const Complex& once, const Complex& twice) const {
    const double wavelength = speed_of_light / carrier_hz_;
    const auto section = [&](const Complex& field) {
      return decibels(std::norm(field) * std::pow(4.0 * pi, 3) * std::pow(glm::length(radar.position), 4) /
                      (wavelength * wavelength));
    };
    return {section(once), section(twice), section(once + twice)};
  }

  scene::Scene scene_;
  scene::GpuScene gpu_;
  FacetTrees trees_;
  EchoTracer tracer_;
  FacetWorld world_;
  std::vector<RadioSurface> conductors_;
  RadioSurfaces surfaces_;
  double carrier_hz_;
  EchoOptions options_;
};

class RadarVehicles : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(RadarVehicles, SectionsAtDefaultSettingsAreThoseOfBruteForce) {
  Aspects aspects(vehicle(GetParam().first, GetParam().second), 10e9);
  const double step_m = GetParam().first == std::string("car") ? 0.004 : 0.002;
  std::vector<double> once, all;
  for (int i = 0; i < 8; ++i) {
    const Pose radar = Aspects::radar_at(radians(45.0 * i + 9.0));
    const Sections found = aspects.found(radar), sure = aspects.brute_force(radar, step_m);
    once.push_back(std::abs(found.once - sure.once));
    all.push_back(std::abs(found.all - sure.all));
    // Brute force itself is not sure of the faint ones.
    if (sure.all > -5.0) {
      EXPECT_LT(all.back(), 1.0) << i;
    }
  }
  for (std::vector<double>* errors : {&once, &all}) {
    std::sort(errors->begin(), errors->end());
    EXPECT_LT(0.5 * ((*errors)[3] + (*errors)[4]), 1.0);
  }
}

TEST(RadarCrossedPlates, EachHidesWhatIsBehindIt) {
  test::TinyScene tiny;
  tiny.object("upright").quad({0, -0.4, -0.3}, {0, 0.4, -0.3}, {0, 0.4, 0.3}, {0, -0.4, 0.3});
  tiny.object("slanted").quad({0.25, -0.3, -0.2}, {0.15, 0.3, -0.2}, {-0.25, 0.3, 0.25}, {-0.15, -0.3, 0.25});
  Aspects aspects(tiny.build(), 10e9);
  for (const double azimuth : {0.0, 9.0}) {
    const Pose radar = Aspects::radar_at(radians(azimuth));
    EXPECT_NEAR(aspects.found(radar).once, aspects.brute_force(radar, 0.001).once, 0.05) << azimuth;
  }
}

INSTANTIATE_TEST_SUITE_P(All, RadarVehicles,
                         ::testing::Values(std::pair("car", "hatchback"), std::pair("car", "van"),
                                           std::pair("quadrotor", "large")),
                         [](const auto& test) { return test.param.second; });

}  // namespace
}  // namespace greatx::rf
