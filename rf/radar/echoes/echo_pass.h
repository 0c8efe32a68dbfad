// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Traces the rays of a radar on the GPU, in the command buffer of the tick. The result is the facets that
// each ray meets, bounce by bounce.
#pragma once

#include <cstdint>
#include <span>

#include "core/vec.h"
#include "gpu/pipeline.h"
#include "gpu/tick_ring.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/radar.h"

namespace greatx::rf {

struct EchoRays {
  dvec3 source{0.0}, receiver{0.0};  ///< local coordinates
  uint32_t source_body = 0;          ///< body that rays pass through; 0: none
  uint32_t receiver_body = 0;        ///< body that does not hide the receiver; 0: none
};

class EchoPass {
 public:
  /// For a `monostatic` radar the pass marks the receiver as seen at first hits only, where it always is.
  /// With `own_body`, rays pass through EchoRays::source_body.
  EchoPass(scene::GpuScene& scene, uint32_t max_bounces, bool monostatic, bool own_body);

  /// Refers to the results of one batch of rays. It is valid until its slot begins again.
  struct Pending {
    gpu::Slice hits;
    uint32_t rays = 0;
  };

  /// Records rays from one source along `directions` (unit vectors, local axes) in the scene as
  /// scene.record_update left it. Throws UserError if the rays exceed the buffer range that the device lets a
  /// shader see.
  [[nodiscard]] Pending record(gpu::TickSlot& slot, const EchoRays& rays, std::span<const vec3> directions);
  /// Returns [max_bounces * rays] words (shaders/shared/radar.h); call it after the submission of the slot is
  /// done.
  std::span<const uint32_t> collect(const Pending& pending) const;
  /// Returns whether the receiver is visible from the source. Returns false for a monostatic radar.
  bool direct(const Pending& pending) const;

 private:
  scene::GpuScene* scene_;
  uint32_t max_bounces_;
  gpu::ComputePipeline pipeline_;
};

}  // namespace greatx::rf
