// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes ground truth of a camera's pixels besides planar depth and ids (which DevelopPass unpacks):
// surface normals, distance along the ray, optical flow. docs/truth.md has conventions, formulas and
// accuracy.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "shaders/shared/truth.h"

namespace greatx::render {

struct TruthOutputs {
  bool normals = false, depth_ray = false, flow = false;
  bool any() const { return normals || depth_ray || flow; }
};

/// Holds the truth of a picture. Arrays that were not asked for are empty. They are in C order, row 0 on top.
struct TruthImages {
  /// [height, width, 3] unit, local (= world) axes, on the eye's side; 0 where there is no surface.
  std::vector<float> normals;
  std::vector<float> depth_ray;  ///< [height, width] distance from the eye, m; sky: +inf
  /// [height, width, 2] to the right and down, pixels; NaN: out of sight at the next picture
  std::vector<float> flow;
};

/// Describes a camera and the bodies that it looks at, at one instant, in local coordinates.
struct TruthInstant {
  Pose local_from_sensor;
  std::span<const Pose> bodies;  ///< by body; [0] is ignored: the static world stays
};

class TruthPass {
 public:
  /// Builds the pipeline for `outputs`, at least one, of the camera `desc`, whose `outputs.seen` is set.
  /// `lighting` outlives this.
  TruthPass(const SceneLighting& lighting, const CameraDesc& desc, const TruthOutputs& outputs);
  /// Records the truth of a picture. Called after CameraPass::record of the same tick; `seen` is its seen().
  /// `next` holds the poses at the time of the camera's next picture. It is read only for the flow.
  void record(gpu::TickSlot& slot, const gpu::Buffer& seen, const TruthInstant& now,
              const TruthInstant& next);
  /// Returns the arrays that were recorded into `slot`, once its submission is done.
  TruthImages collect(const gpu::TickSlot& slot) const;

 private:
  struct Readback {
    gpu::Slice normals, depth_ray, flow;
  };
  void upload_lens();

  const SceneLighting* lighting_;
  CameraDesc desc_;
  TruthOutputs outputs_;
  gpu::ComputePipeline pipeline_;
  gpu::Buffer lens_;                 ///< only behind a lens that distorts
  std::vector<Readback> readbacks_;  ///< by slot
  std::string scope_;
};

/// Returns how a body moves against the camera from one instant to the other (shared::GpuBodyMotion).
shared::GpuBodyMotion body_motion(const Pose& local_from_sensor, const Pose& local_from_body,
                                  const Pose& next_local_from_sensor, const Pose& next_local_from_body);

}  // namespace greatx::render
