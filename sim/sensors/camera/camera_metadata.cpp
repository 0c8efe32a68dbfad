// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/camera/camera_metadata.h"

#include <algorithm>

#include "core/units.h"
#include "sim/sensors/sensor_metadata.h"

namespace greatx::sim {

namespace {

nlohmann::json lens_metadata(const WideLens& lens) {
  if (!lens.fisheye()) return {{"model", "equirectangular"}};
  return {{"model", "fisheye"},
          {"formula", "Kannala-Brandt as OpenCV's fisheye"},
          {"k1", lens.k1},
          {"k2", lens.k2},
          {"k3", lens.k3},
          {"k4", lens.k4},
          {"circle_deg", degrees(2.0 * std::min(lens.half_angle, lens.fold_angle()))}};
}

}  // namespace

nlohmann::json pinhole_metadata(const PinholeConfig& config, const Pose& body_from_sensor) {
  nlohmann::json metadata;
  metadata["width"] = config.width;
  metadata["height"] = config.height;
  metadata["fx"] = config.fx;
  metadata["fy"] = config.fy;
  metadata["cx"] = config.cx;
  metadata["cy"] = config.cy;
  metadata["pixel_center"] = 0.5;
  metadata["near_m"] = config.near_m;
  metadata["antialiasing"] = config.msaa > 1 ? "msaa4" : config.smooth_edges ? "edges" : "none";
  metadata["optical_frame"] = "x right, y down, z forward";
  metadata["body_from_sensor"] = json_of(body_from_sensor);
  const Distortion& lens = config.distortion;
  if (lens.any())
    metadata["distortion"] = {{"model", "Brown-Conrady as OpenCV's calib3d"},
                              {"k1", lens.k1},
                              {"k2", lens.k2},
                              {"p1", lens.p1},
                              {"p2", lens.p2},
                              {"k3", lens.k3}};
  if (config.wide.any()) metadata["lens"] = lens_metadata(config.wide);
  return metadata;
}

nlohmann::json camera_metadata(const CameraConfig& config, const Pose& body_from_sensor) {
  nlohmann::json metadata = pinhole_metadata(config, body_from_sensor);
  const Exposure& exposure = config.exposure;
  if (exposure.automatic)
    metadata["exposure"] = {{"automatic", true}, {"compensation_ev", exposure.compensation_ev}};
  else
    metadata["exposure_ev100"] = exposure.ev100;
  if (exposure.shutter_s) metadata["shutter_s"] = *exposure.shutter_s;
  if (config.motion_blur_samples > 0) metadata["motion_blur_samples"] = config.motion_blur_samples;
  if (config.vignetting.any())
    metadata["vignetting"] = {{"natural", config.vignetting.natural}, {"radial", config.vignetting.radial}};
  if (config.drops.any())
    metadata["lens_drops"] = {
        {"coverage", config.drops.coverage},       {"rain_mm_h", config.drops.rain_mm_h},
        {"glass_m", config.drops.glass_m},         {"aperture_m", config.drops.aperture_m},
        {"contact_deg", config.drops.contact_deg}, {"stay_s", config.drops.stay_s}};
  if (config.glare > 0.0) metadata["glare"] = config.glare;
  if (config.noise)
    metadata["noise"] = {{"full_well_e", config.noise->full_well_e},
                         {"read_noise_e", config.noise->read_noise_e},
                         {"bits", config.noise->bits}};
  if (config.rolling.any())
    metadata["rolling_shutter"] = {
        {"readout_s", config.rolling.readout_s},
        {"bands", config.rolling.bands},
        {"rows", "row r of height h is that of tick time + readout_s ((r + 0.5) / h - 0.5)"}};
  if (config.chromatic.any())
    metadata["chromatic_aberration"] = {{"red", config.chromatic.red}, {"blue", config.chromatic.blue}};
  metadata["depth"] = config.wide.any() ? "range" : "planar";
  if (config.normals)
    metadata["normals"] = "interpolated vertex normals, world axes, on the camera's side; 0 0 0: sky";
  if (config.flow) {
    metadata["flow"] =
        "pixels from this picture to the camera's next one, right and down; NaN: out of sight then";
    metadata["non_finite"] = {"flow"};
  }
  if (config.boxes)
    metadata["boxes"] = "u_min v_min u_max v_max in pixel coordinates; size along the box's x y z";
  return metadata;
}

}  // namespace greatx::sim
