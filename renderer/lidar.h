// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// LiDAR: one ray a shot, each from the sensor's pose at its own time (docs/lidar.md).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/pipeline.h"
#include "gpu/tick_ring.h"
#include "scene/gpu_scene.h"
#include "shaders/shared/lidar.h"

namespace greatx::render {

/// A scanning LiDAR. Sensor frame: x forward, y left, z up; azimuth from x towards y, elevation above the x-y
/// plane.
struct LidarDesc {
  std::vector<double> elevations;  ///< [channels] rad, 1 to 65535 of them; the ring number is the index
  uint32_t azimuth_steps =
      1024;  ///< 1 to 65535; step k looks at azimuth_start + k * azimuth_span / azimuth_steps
  double azimuth_start = 0.0;                          ///< rad
  double azimuth_span = 2.0 * 3.14159265358979323846;  ///< rad, left is positive
  double sweep_s = 0.0;      ///< step k fires k * sweep_s / azimuth_steps after the tick; 0: all at the tick
  double min_range_m = 0.5;  ///< nearer surfaces are not seen: the beam begins here
  double max_range_m = 120.0;
  uint32_t wavelength_nm = 905;           ///< 905 or 1550: which reflectance of the materials counts
  std::optional<uint32_t> excluded_body;  ///< the body that carries the sensor: beams pass through it

  // What the effect plan asks for.
  bool alpha_mask = false;  ///< holes of alpha-masked materials let beams through; off: they are solid
  bool textured_reflectance =
      false;  ///< base-colour textures modulate a reflectance that comes from the base colour

  // The receiver, for `power` alone.
  double aperture_diameter_m = 0.025;
  double system_efficiency = 1.0;
  double extinction_per_m = 0.0;  ///< of the air, one way
};

/// One sweep: the shots that met something, in the order they were fired (azimuth step by step, within a step
/// by ring). All arrays have `size()` elements.
struct LidarScan {
  std::vector<vec4> points;    ///< x, y, z: metres in the sensor frame AT THE SHOT'S OWN TIME; w: intensity
  std::vector<uint16_t> ring;  ///< channel
  std::vector<uint16_t> azimuth_step;
  std::vector<float> time_offset_s;  ///< of the shot after the tick
  std::vector<float> range_m;        ///< along the beam
  std::vector<float> power;          ///< received over transmitted power
  std::vector<uint32_t> instance;    ///< index into Scene::instances + 1
  std::vector<uint32_t> material;    ///< index into Scene::materials + 1
  size_t size() const { return points.size(); }
};

/// Intensity is rho * cos(theta), range-corrected, in [0, 1] for reflectances up to 1: Lambertian reflectance
/// at the wavelength times the cosine of the angle of incidence on the triangle. Power is the range equation
/// for a footprint that lies wholly on the surface: P_r / P_t = rho cos(theta) D^2 eta_s / (4 R^2) * exp(-2
/// alpha R).
class LidarPass {
 public:
  /// Builds the pipeline and uploads the beams' angles. `name` is the scope's and the pipeline's.
  LidarPass(scene::GpuScene& scene, const LidarDesc& desc, std::string_view name = "lidar");

  /// Where a recorded sweep will be; valid until its slot is begun again.
  struct Pending {
    gpu::Slice returns;
  };

  /// Records one sweep. `local_from_sensor` [azimuth_steps], the pose at each step's time, or [1] for all of
  /// them; in local coordinates (scene.to_local). Moving bodies stand where scene.record_update put them for
  /// this tick.
  [[nodiscard]] Pending record(gpu::TickSlot& slot, std::span<const Pose> local_from_sensor);
  /// The sweep, after the slot's submission is done.
  LidarScan collect(const Pending& pending) const;
  /// The same as an image of ranges, f32 [channels, azimuth_steps] in metres along the beam; +inf where
  /// nothing was met.
  std::vector<float> collect_ranges(const Pending& pending) const;

  const LidarDesc& desc() const { return desc_; }
  uint32_t channels() const { return static_cast<uint32_t>(desc_.elevations.size()); }
  /// When step `step` fires, seconds after the tick.
  double time_offset_s(uint32_t step) const { return step * desc_.sweep_s / desc_.azimuth_steps; }
  /// Unit direction of a beam in the sensor frame.
  vec3 beam(uint32_t step, uint32_t channel) const;

 private:
  scene::GpuScene* scene_;
  LidarDesc desc_;
  std::string name_;
  std::vector<vec2> angles_;  ///< cos, sin of the elevations, then of the azimuths
  gpu::ComputePipeline pipeline_;
  gpu::Buffer angles_buffer_, returns_;
};

}  // namespace greatx::render
