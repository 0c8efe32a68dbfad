// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Traces single rays through the scene, with which pictures are compared.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gpu/pipeline.h"
#include "gpu/tick_ring.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/probe.h"

namespace greatx::render {

class ProbePass {
 public:
  /// Throws ContractError if `scene` was uploaded without a tracer.
  explicit ProbePass(const scene::GpuScene& scene);
  /// Records the rays (local coordinates). Hits of `excluded_body` are passed through. Returns the place of
  /// shared::ProbeHit [rays] once the slot's submission is done.
  gpu::Slice record(gpu::TickSlot& slot, std::span<const shared::ProbeRay> rays,
                    std::optional<uint32_t> excluded_body) const;

 private:
  const scene::GpuScene* scene_;
  gpu::ComputePipeline pipeline_;
};

}  // namespace greatx::render
