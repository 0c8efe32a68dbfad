// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// LiDAR on the GPU (docs/lidar.md):
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
  ScanPattern pattern;       ///< of every sweep, or, of a scan that does not repeat, of the first one
  double min_range_m = 0.5;  ///< nearer surfaces are not seen: the beam begins here
  double max_range_m = 120.0;
  uint32_t wavelength_nm = 905;           ///< 905 or 1550: which reflectance of the materials counts
  std::optional<uint32_t> excluded_body;  ///< the body that carries the sensor: beams pass through it

  /// Full angle at 1/e^2, rad. Without rings it is only what mirrors see of the beam's width (glare of panes).
  double divergence = 0.0;
  uint32_t rings = 0;  ///< of sub-rays around the axis; 0: one ray a shot

  Receiver receiver;
  ReturnChoice returns;

  // What the effect plan asks for.
  bool alpha_mask = false;  ///< holes of alpha-masked materials let beams through; off: they are solid
  bool textured_reflectance =
      false;           ///< base-colour textures modulate a reflectance that comes from the base colour
  bool glass = false;  ///< panes let light through; off: they are solid
  bool target_motion =
      false;  ///< sweeps may have bodies that move meanwhile, or several that carry the sensor
};

/// A body that does not belong to the static world, as one sweep sees it.
struct LidarTarget {
  uint32_t body = 0;
  /// tick_from_shot: takes a point from where the body stands at an instant to where it stands at the tick; local
  /// coordinates, [instants], or empty: it does not move during the sweep.
  std::vector<Pose> motions;
  dvec3 center{0.0};  ///< local coordinates, of a sphere that holds the body at every instant
  double radius_m = 0.0;
};

/// Of a sweep. `apart`: bodies are met one by one, those listed and no others, each where its motion takes it; otherwise
/// all of them stand where scene.record_update put them for this tick, but for LidarDesc::excluded_body.
struct LidarTargets {
  bool apart = false;
  std::vector<LidarTarget> bodies;
};

/// Intensity is rho * cos(theta), range-corrected, in [0, 1] for reflectances up to 1: Lambertian reflectance
/// at the wavelength times the cosine of the angle of incidence on the triangle. Panes: docs/lidar.md.
class LidarPass {
 public:
  /// Builds the pipeline and uploads the beams. `name` is the scope's and the pipeline's. Throws UserError if the echoes
  /// of a sweep exceed the device's largest buffer.
  LidarPass(scene::GpuScene& scene, const LidarDesc& desc, std::string_view name = "lidar");

  /// Where a recorded sweep will be; valid until its slot is begun again.
  struct Pending {
    gpu::Slice echoes;
    std::shared_ptr<const ScanPattern> pattern;
  };

  /// Records one sweep. `local_from_sensor` [instants], the pose at each of the pattern's times, or [1] for all of them;
  /// in local coordinates (scene.to_local). `targets`: apart only with target_motion. `pattern`: of this sweep alone, of
  /// as many shots as the first one's.
  [[nodiscard]] Pending record(gpu::TickSlot& slot, std::span<const Pose> local_from_sensor,
                               const LidarTargets& targets = {},
                               std::shared_ptr<const ScanPattern> pattern = nullptr);
  /// The sweep, after the slot's submission is done.
  LidarScan collect(const Pending& pending, const ShotNoise& noise = {}) const;
  /// The ranges of the beams' axes alone as an image, f32 [rows, columns] in metres; +inf where nothing was met.
  std::vector<float> collect_ranges(const Pending& pending) const;

  const LidarDesc& desc() const { return desc_; }
  const std::string& name() const { return name_; }
  const ScanPattern& pattern() const { return *pattern_; }

 private:
  gpu::Slice beams_of(gpu::TickSlot& slot, const ScanPattern& pattern) const;
  EchoView view(const Pending& pending) const;
  gpu::ComputePipeline build_pipeline() const;

  scene::GpuScene* scene_;
  LidarDesc desc_;
  std::string name_;
  std::shared_ptr<const ScanPattern> pattern_;
  ReturnModel model_;
  uint32_t slots_ = 1;  ///< echoes a ray
  float refractive_index_ = 1.0f;
  gpu::ComputePipeline pipeline_;
  gpu::Buffer beams_, offsets_, panes_, echoes_;
};

}  // namespace greatx::render
