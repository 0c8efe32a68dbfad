// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Traces a LiDAR on the GPU (docs/lidar.md):
//
//   ScanPattern, poses, targets ─► rays of every shot ─► echoes ─► make_scan (renderer/lidar/scan/returns.h)
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "gpu/pipeline.h"
#include "gpu/tick_ring.h"
#include "renderer/lidar/scan/returns.h"
#include "renderer/lidar/scan/scan_pattern.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/lidar.h"

namespace greatx::render {

struct LidarDesc {
  ScanPattern pattern;       ///< shots of every sweep, or of the first one if the scan does not repeat
  double min_range_m = 0.5;  ///< the beam begins here, and nearer surfaces are not seen
  double max_range_m = 120.0;
  uint32_t wavelength_nm = 905;           ///< 905 or 1550: selects the reflectance of the materials
  std::optional<uint32_t> excluded_body;  ///< the body that carries the sensor: beams pass through it

  /// Full angle at 1/e^2, rad. Without rings, only mirrors see the width of the beam (glare of panes).
  double divergence = 0.0;
  uint32_t rings = 0;  ///< rings of sub-rays around the axis; 0: one ray per shot

  Receiver receiver;
  ReturnChoice returns;

  // The members below are switched on by the effect plan.
  bool alpha_mask = false;  ///< holes of alpha-masked materials let beams through; off: they are solid
  /// Base-colour textures modulate a reflectance that comes from the base colour.
  bool textured_reflectance = false;
  bool glass = false;  ///< panes let light through; off: they are solid
  /// Sweeps may have bodies that move meanwhile, or several bodies that carry the sensor.
  bool target_motion = false;
};

/// Describes a body that does not belong to the static world, as one sweep sees it.
struct LidarTarget {
  uint32_t body = 0;
  /// tick_from_shot [instants] takes a point from where the body stands at an instant to where it stands at
  /// the tick, in local coordinates. If it is empty, the body does not move during the sweep.
  std::vector<Pose> motions;
  dvec3 center{0.0};  ///< centre of a sphere that holds the body at every instant, local
  double radius_m = 0.0;
};

/// Holds the moving bodies of a sweep. If `apart` is set, rays meet only the listed bodies, one by one, each
/// in the pose of its motion. Otherwise all bodies are in the poses that scene.record_update set for this
/// tick, except LidarDesc::excluded_body.
struct LidarTargets {
  bool apart = false;
  std::vector<LidarTarget> bodies;
};

/// Traces a LiDAR. Its intensity is rho * cos(theta), range-corrected, in [0, 1] for reflectances up to 1:
/// the Lambertian reflectance at the wavelength times the cosine of the angle of incidence on the triangle.
/// docs/lidar.md describes panes.
class LidarPass {
 public:
  /// Builds the pipeline and uploads the beams. The scope and the pipeline are called `name`. Throws
  /// UserError if the echoes of a sweep exceed the device's largest buffer.
  LidarPass(scene::GpuScene& scene, const LidarDesc& desc, std::string_view name = "lidar");

  /// Holds the place of a recorded sweep. It is valid until its slot is begun again.
  struct Pending {
    gpu::Slice echoes;
    std::shared_ptr<const ScanPattern> pattern;
  };

  /// Records one sweep. `local_from_sensor` is [instants], the pose at each of the pattern's times, or [1]
  /// for all of them, in local coordinates (scene.to_local). `targets` are apart only with target_motion.
  /// `pattern` is for this sweep only, and has as many shots as the first one.
  [[nodiscard]] Pending record(gpu::TickSlot& slot, std::span<const Pose> local_from_sensor,
                               const LidarTargets& targets = {},
                               std::shared_ptr<const ScanPattern> pattern = nullptr);
  /// Returns the sweep, after the slot's submission is done.
  LidarScan collect(const Pending& pending, const ShotNoise& noise = {}) const;

  const LidarDesc& desc() const { return desc_; }
  const std::string& name() const { return name_; }
  const ScanPattern& pattern() const { return *pattern_; }

 private:
  gpu::Slice beams_of(gpu::TickSlot& slot, const ScanPattern& pattern) const;
  gpu::ComputePipeline build_pipeline() const;

  scene::GpuScene* scene_;
  LidarDesc desc_;
  std::string name_;
  std::shared_ptr<const ScanPattern> pattern_;
  ReturnModel model_;
  uint32_t slots_ = 1;  ///< echoes per ray
  float refractive_index_ = 1.0f;
  gpu::ComputePipeline pipeline_;
  gpu::Buffer beams_, offsets_, panes_, echoes_;
};

}  // namespace greatx::render
