// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses the cameras of nodes[].sensors[], and the part that event cameras share with them.
#include <cmath>

#include "core/units.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

constexpr uint32_t largest_image_edge = 16384;

/// Parses fov_deg (horizontal, square pixels), or fx and, if it differs, fy. The principal point is the
/// centre by default.
void parse_intrinsics(const FieldMap& map, PinholeConfig& camera) {
  if (camera.wide.model == LensModel::equirectangular) return;  // they follow from the size
  map.exclude("fov_deg", "fx");
  map.exclude("fov_deg", "fy");
  if (const auto f = map.find("fov_deg")) {
    const double fov_deg = f->number();
    const bool fisheye = camera.wide.fisheye();
    if (!fisheye && !(fov_deg > 0.0 && fov_deg < 180.0)) f->fail("an angle greater than 0 and less than 180");
    camera.fx = camera.fy =
        fisheye ? fisheye_focal_length(*f, camera) : 0.5 * camera.width / std::tan(0.5 * radians(fov_deg));
  } else {
    camera.fx = camera.fy = map.require("fx", "a focal length in pixels (or 'fov_deg')").positive(1e-3, 1e9);
    if (const auto fy = map.find("fy")) camera.fy = fy->positive(1e-3, 1e9);
  }
  camera.cx = 0.5 * camera.width;
  camera.cy = 0.5 * camera.height;
  if (const auto f = map.find("cx")) camera.cx = f->number(1e6);
  if (const auto f = map.find("cy")) camera.cy = f->number(1e6);
}

Distortion parse_distortion(const Field& field) {
  const FieldMap map(field, {"k1", "k2", "p1", "p2", "k3"});
  Distortion distortion;
  const auto read = [&](const char* key, double& value) {
    if (const auto f = map.find(key)) value = f->number(1e6);
  };
  read("k1", distortion.k1);
  read("k2", distortion.k2);
  read("p1", distortion.p1);
  read("p2", distortion.p2);
  read("k3", distortion.k3);
  return distortion;
}

/// Parses auto, or {auto: true, compensation_ev}, or {ev100}, or {f_number, shutter_s, iso}. shutter_s may be
/// given in each map.
Exposure parse_exposure(const Field& field) {
  Exposure exposure;
  if (field.is_scalar()) {
    field.choice({"auto"});
    exposure.automatic = true;
    return exposure;
  }
  const FieldMap map(field, {"auto", "compensation_ev", "ev100", "f_number", "shutter_s", "iso"});
  for (const char* fixed : {"ev100", "f_number", "iso"}) map.exclude("auto", fixed);
  map.exclude("ev100", "f_number");
  map.exclude("ev100", "iso");
  if (const auto f = map.find("shutter_s")) exposure.shutter_s = f->positive(1e-9, 1e6);
  if (const auto f = map.find("auto")) {
    if (!f->boolean()) f->fail("true, or no 'auto'", "false");
    exposure.automatic = true;
  }
  if (const auto f = map.find("compensation_ev")) {
    if (!exposure.automatic) f->fail("no compensation, for the exposure is not automatic", f->text());
    exposure.compensation_ev = f->between(-10.0, 10.0);
  }
  if (exposure.automatic) return exposure;
  if (const auto f = map.find("ev100")) {
    exposure.ev100 = f->between(-20.0, 24.0);
    return exposure;
  }
  // EV100 = log2(N^2 / t * 100 / S) (ISO 2720).
  const Field f_number =
      map.require("f_number", "an f-number, with shutter_s and iso (or 'ev100', or 'auto')");
  map.require("shutter_s", "an exposure time in seconds, with f_number and iso");
  const double iso = map.require("iso", "a sensitivity such as 100, with f_number and shutter_s").positive();
  const double n = f_number.positive();
  exposure.ev100 = std::log2(n * n / *exposure.shutter_s * 100.0 / iso);
  if (!(exposure.ev100 >= -20.0 && exposure.ev100 <= 24.0))
    f_number.fail("an exposure of EV100 -20 to 24", fmt::format("EV100 {:.2f}", exposure.ev100));
  return exposure;
}

Vignetting parse_vignetting(const Field& field) {
  Vignetting vignetting;
  if (field.is_scalar()) {
    field.choice({"natural"});
    vignetting.natural = true;
    return vignetting;
  }
  const dvec3 radial = field.vector3(1e6);
  vignetting.radial = {radial.x, radial.y, radial.z};
  return vignetting;
}

SensorNoise parse_noise(const Field& field) {
  const FieldMap map(field, {"full_well_e", "read_noise_e", "bits"});
  SensorNoise noise;
  if (const auto f = map.find("full_well_e")) noise.full_well_e = f->between(10.0, 1e7);
  if (const auto f = map.find("read_noise_e")) noise.read_noise_e = f->between(0.0, 1e5);
  if (const auto f = map.find("bits")) noise.bits = f->integer32(4, 16);
  return noise;
}

/// Fails where an effect does not work behind a fisheye or an equirectangular lens, or with a rolling
/// shutter.
void check_lens_and_shutter(const FieldMap& map, const CameraConfig& camera) {
  if (camera.wide.any() && camera.vignetting.natural)
    map.find("vignetting")
        ->fail("a radial vignetting, for 'natural' is that of a pinhole camera", "'natural' beside a lens");
  if (camera.wide.any() && camera.drops.any())
    map.find("lens_drops")->fail("none beside a lens, for the glass before a pinhole camera is plane");
  if (!camera.rolling.any()) return;
  if (camera.motion_blur_samples > 0)
    map.find("motion_blur_samples")->fail("none beside a rolling_shutter, which draws its own instants");
  if (camera.boxes || camera.flow || camera.normals)
    map.find("outputs")->fail(
        "no 'boxes', 'flow' or 'normals' beside a rolling_shutter, for they are those of one instant");
}

void parse_outputs(const Field& field, CameraConfig& camera) {
  struct Output {
    std::string_view name;
    bool* wanted;
  };
  const Output outputs[] = {{"rgb", &camera.rgb},
                            {"depth", &camera.depth},
                            {"ids", &camera.ids},
                            {"hdr", &camera.hdr},
                            {"depth_png24", &camera.depth_png24},
                            {"depth_log", &camera.depth_log},
                            {"depth_ray", &camera.depth_ray},
                            {"normals", &camera.normals},
                            {"flow", &camera.flow},
                            {"boxes", &camera.boxes}};
  for (const Output& output : outputs) *output.wanted = false;
  camera.listed = true;
  for (const Field& item : field.list("outputs", 1)) {
    bool& wanted = *outputs[item.choice({"rgb", "depth", "ids", "hdr", "depth_png24", "depth_log",
                                         "depth_ray", "normals", "flow", "boxes"})]
                        .wanted;
    if (wanted) item.fail("every output once", fmt::format("a second '{}'", item.text()));
    wanted = true;
  }
}

}  // namespace

void parse_pinhole(const FieldMap& map, PinholeConfig& camera) {
  if (const auto f = map.find("width")) camera.width = f->integer32(1, largest_image_edge);
  if (const auto f = map.find("height")) camera.height = f->integer32(1, largest_image_edge);
  if (const auto f = map.find("lens")) parse_lens(map, *f, camera);
  parse_intrinsics(map, camera);
  if (const auto f = map.find("near_m")) camera.near_m = f->positive(1e-6, 1e6);
  if (const auto f = map.find("antialiasing")) {
    const size_t kind = f->choice({"none", "edges", "msaa4"});
    camera.smooth_edges = kind == 1;
    camera.msaa = kind == 2 ? 4 : 1;
  }
  if (const auto f = map.find("distortion")) camera.distortion = parse_distortion(*f);
}

CameraConfig parse_camera(const FieldMap& map) {
  CameraConfig camera;
  parse_pinhole(map, camera);
  map.exclude("exposure", "exposure_ev100");
  if (const auto f = map.find("exposure_ev100")) camera.exposure.ev100 = f->between(-20.0, 24.0);
  if (const auto f = map.find("exposure")) camera.exposure = parse_exposure(*f);
  if (const auto f = map.find("motion_blur_samples")) {
    camera.motion_blur_samples = f->integer32(3, 63);
    // The middle instant is the tick: its depth and ids are those of the picture.
    if (camera.motion_blur_samples % 2 == 0) f->fail("an odd number from 3 to 63", f->text());
    if (!camera.exposure.shutter_s) f->fail("exposure.shutter_s, over which things move");
  }
  if (const auto f = map.find("vignetting")) camera.vignetting = parse_vignetting(*f);
  if (const auto f = map.find("noise")) camera.noise = parse_noise(*f);
  if (const auto f = map.find("glare")) camera.glare = f->between(0.0, 0.5);
  if (const auto f = map.find("outputs")) parse_outputs(*f, camera);
  if (const auto f = map.find("box_classes")) {
    if (!camera.boxes) f->fail("'boxes' among the outputs");
    for (const Field& item : f->list("classes", 1)) camera.box_classes.push_back(parse_semantic_class(item));
  }
  if (const auto f = map.find("see_own_body")) camera.see_own_body = f->boolean();
  if (const auto f = map.find("rolling_shutter")) camera.rolling = parse_rolling_shutter(*f, camera.height);
  if (const auto f = map.find("chromatic_aberration")) camera.chromatic = parse_chromatic_aberration(*f);
  if (const auto f = map.find("lens_drops")) camera.drops = parse_lens_drops(*f);
  check_lens_and_shutter(map, camera);
  return camera;
}

}  // namespace greatx::sim
