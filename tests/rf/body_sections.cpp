// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/rf/body_sections.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "scene/build/build.h"
#include "scene/generator/generate.h"
#include "scene/gltf/model.h"
#include "tests/rf/radar_echo_scenes.h"

namespace greatx::rf::testing {
namespace {

constexpr int band_samples = 21;

EchoOptions options_of(const Turntable& table) {
  const double tubes = 2.0 * table.half_m / table.tube_m;
  EchoOptions options = around(table.half_m, table.range_m, static_cast<uint32_t>(tubes * tubes));
  options.max_bounces = table.max_bounces;
  options.edges = table.edges;
  options.diffuse = table.diffuse;
  options.transmission = table.transmission;
  options.roughness = true;
  options.diffuse_patch_m = table.square_m;
  options.waveform.carrier_hz = table.carrier_hz;
  options.waveform.slots = options.waveform.transmitters = 1;
  return options;
}

}  // namespace

TurntableRadar::TurntableRadar(scene::Scene scene, const Turntable& table)
    : table_(table),
      scene_(std::move(scene)),
      gpu_(test::device(), scene_, {}),
      surfaces_(scene_, table.carrier_hz) {
  finder_.emplace(gpu_, surfaces_, EchoEnd{}, std::nullopt, options_of(table));
}

EchoList TurntableRadar::list_at(double azimuth_rad) {
  const dvec3 aim(0.0, 0.0, table_.aim_z_m);
  const double rise = table_.height_m - table_.aim_z_m;
  const double level = std::sqrt(table_.range_m * table_.range_m - rise * rise);
  const dvec3 place = aim + dvec3(level * std::cos(azimuth_rad), level * std::sin(azimuth_rad), rise);
  const Pose radar = looking(scene_.to_local(place), scene_.to_local(aim));
  return trace_echoes(*finder_, gpu_, scene_.bodies.size(), at_rest(radar, radar));
}

BodySection TurntableRadar::at(double azimuth_rad) {
  const EchoList list = list_at(azimuth_rad);
  BodySection mean;
  for (int i = 0; i < band_samples; ++i) {
    const double f = table_.carrier_hz + table_.band_hz * (i / (band_samples - 1.0) - 0.5);
    const auto turned = [f](double delay_s) {
      return std::polar(1.0, -2.0 * pi * std::remainder(f * delay_s, 1.0));
    };
    std::array<Complex, 3> sums{};
    for (const Echo& echo : list.echoes)
      sums[echo.bounces > 1 ? 1 : 0] += echo.amplitude * turned(echo.delay.coefficients[0]);
    for (size_t k = 0; k < list.patches.size(); ++k)
      sums[2] += Complex(list.patches.re[k], list.patches.im[k]) * turned(list.patches.delay_s[k]);
    const double wavelength = speed_of_light / table_.carrier_hz;
    const double share =
        std::pow(4.0 * pi, 3) * std::pow(table_.range_m, 4) / (wavelength * wavelength) / band_samples;
    mean.all += share * std::norm(sums[0] + sums[1] + sums[2]);
    mean.first += share * std::norm(sums[0]);
    mean.more += share * std::norm(sums[1]);
    mean.scattered += share * std::norm(sums[2]);
  }
  return mean;
}

std::vector<BodySection> TurntableRadar::around(int count) {
  std::vector<BodySection> sections;
  for (int i = 0; i < count; ++i) sections.push_back(at(2.0 * pi * i / count));
  return sections;
}

scene::Scene generated_body(const std::string& kind, const std::string& variant, uint64_t seed) {
  const std::vector<std::byte> file = scene::generate_glb({.kind = kind, .seed = seed, .variant = variant});
  const scene::Model model = scene::load_model(kind, file, {});
  return scene::build_scene({{.name = "", .model = &model, .pose = {}}}, {.name = kind});
}

SectionFigures figures_of(const std::vector<BodySection>& sections) {
  std::vector<double> values;
  double sum = 0.0;
  for (const BodySection& section : sections) values.push_back(section.all), sum += section.all;
  std::sort(values.begin(), values.end());
  return {decibels(sum / static_cast<double>(values.size())), decibels(values[values.size() / 2]),
          decibels(values.back())};
}

}  // namespace greatx::rf::testing
