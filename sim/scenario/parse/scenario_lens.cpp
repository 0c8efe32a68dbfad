// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses the lenses of cameras beyond the pinhole, the rolling shutter and the chromatic aberration.
#include <algorithm>

#include "core/units.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

constexpr double widest_deg = 220.0;

void parse_fisheye(const FieldMap& map, PinholeConfig& camera) {
  WideLens& lens = camera.wide;
  lens.model = LensModel::fisheye;
  const auto read = [&](const char* key, double& value) {
    if (const auto f = map.find(key)) value = f->number(1e3);
  };
  read("k1", lens.k1);
  read("k2", lens.k2);
  read("k3", lens.k3);
  read("k4", lens.k4);
  if (const auto f = map.find("circle_deg")) {
    lens.half_angle = 0.5 * radians(f->between(1.0, widest_deg));
    lens.circle_given = true;
  }
}

void parse_equirectangular(const FieldMap& map, const FieldMap& of_camera, PinholeConfig& camera) {
  for (const char* key : {"k1", "k2", "k3", "k4", "circle_deg"})
    if (const auto f = map.find(key)) f->fail("none, for an equirectangular picture shows the whole sphere");
  for (const char* key : {"fov_deg", "fx", "fy", "cx", "cy"})
    if (const auto f = of_camera.find(key))
      f->fail("none, for an equirectangular picture shows the whole sphere");
  if (camera.width != 2 * camera.height)
    map.field().fail("a picture twice as wide as high", fmt::format("{} x {}", camera.width, camera.height));
  camera.wide.model = LensModel::equirectangular;
  camera.fx = 0.5 * camera.width / pi;
  camera.fy = camera.height / pi;
  camera.cx = 0.5 * camera.width;
  camera.cy = 0.5 * camera.height;
}

}  // namespace

void parse_lens(const FieldMap& of_camera, const Field& field, PinholeConfig& camera) {
  of_camera.exclude("lens", "distortion");
  const FieldMap map(field, {"model", "k1", "k2", "k3", "k4", "circle_deg"});
  const Field model = map.require("model", "fisheye or equirectangular");
  if (model.choice({"fisheye", "equirectangular"}) == 0)
    parse_fisheye(map, camera);
  else
    parse_equirectangular(map, of_camera, camera);
}

double fisheye_focal_length(const Field& fov_deg, const PinholeConfig& camera) {
  const double angle = 0.5 * radians(fov_deg.number());
  const double most = std::min(0.5 * radians(widest_deg), camera.wide.fold_angle());
  if (!(angle > 0.0 && angle <= most))
    fov_deg.fail(fmt::format("an angle greater than 0 and up to {:.6g}", degrees(2.0 * most)));
  return 0.5 * camera.width / camera.wide.shown(angle);
}

RollingShutter parse_rolling_shutter(const Field& field, uint32_t height) {
  const FieldMap map(field, {"readout_s", "bands"});
  RollingShutter rolling;
  rolling.readout_s =
      map.require("readout_s", "the time from the first row to the last").positive(1e-9, 10.0);
  if (const auto f = map.find("bands")) rolling.bands = f->integer32(1, 2048);
  rolling.bands = std::min(rolling.bands, (height + 7) / 8);
  return rolling;
}

ChromaticAberration parse_chromatic_aberration(const Field& field) {
  const FieldMap map(field, {"red", "blue"});
  ChromaticAberration chromatic;
  if (const auto f = map.find("red")) chromatic.red = f->between(0.9, 1.1);
  if (const auto f = map.find("blue")) chromatic.blue = f->between(0.9, 1.1);
  return chromatic;
}

LensDrops parse_lens_drops(const Field& field) {
  const FieldMap map(field, {"coverage", "rain_mm_h", "glass_m", "aperture_m", "contact_deg", "stay_s"});
  LensDrops drops;
  drops.coverage = 0.1;
  if (const auto f = map.find("coverage")) drops.coverage = f->between(0.001, 0.4);
  if (const auto f = map.find("rain_mm_h")) drops.rain_mm_h = f->between(0.1, 200.0);
  if (const auto f = map.find("glass_m")) drops.glass_m = f->between(0.002, 2.0);
  if (const auto f = map.find("aperture_m")) drops.aperture_m = f->between(0.0, 0.1);
  if (const auto f = map.find("contact_deg")) drops.contact_deg = f->between(5.0, 90.0);
  if (const auto f = map.find("stay_s")) drops.stay_s = f->between(0.1, 1e5);
  return drops;
}

}  // namespace greatx::sim
