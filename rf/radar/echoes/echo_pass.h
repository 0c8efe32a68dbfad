// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Traces the rays of a radar on the GPU, in the tick's command buffer: which facets each meets, bounce by
// bounce.
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
  uint32_t source_body = 0;          ///< that rays pass through; 0: none
  uint32_t receiver_body = 0;        ///< that does not hide the receiver; 0: none
};

class EchoPass {
 public:
  /// `monostatic`: whether the receiver is seen is asked for first hits alone, of which it always is.
  /// `own_body`: rays pass through EchoRays::source_body.
  EchoPass(scene::GpuScene& scene, uint32_t max_bounces, bool monostatic, bool own_body);

  /// Where the answers of one batch will be; valid until its slot is begun again.
  struct Pending {
    gpu::Slice hits;
    uint32_t rays = 0;
  };

  /// Records rays from one source along `directions` (unit, local axes), among the scene as
  /// scene.record_update left it. Throws UserError if they are more than the device lets a shader see at
  /// once.
  [[nodiscard]] Pending record(gpu::TickSlot& slot, const EchoRays& rays, std::span<const vec3> directions);
  /// [max_bounces * rays] words (shaders/shared/radar.h), after the slot's submission is done.
  std::span<const uint32_t> collect(const Pending& pending) const;
  /// Whether nothing stands between the source and the receiver; false for a monostatic radar.
  bool direct(const Pending& pending) const;

 private:
  scene::GpuScene* scene_;
  uint32_t max_bounces_;
  gpu::ComputePipeline pipeline_;
};

}  // namespace greatx::rf
