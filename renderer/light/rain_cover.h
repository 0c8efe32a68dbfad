// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Says where rain and snow fall: a map of depth of the static world as seen from straight above. Crowns of
// trees and other masked surfaces hold nothing off, since they drip. Bodies that move hold nothing off
// either.
#pragma once

#include "gpu/resources.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/weather.h"

namespace greatx::render {

class RainCover {
 public:
  RainCover() = default;
  /// Renders the map in a set-up submission. Without `wanted` it has one texel and covers nothing.
  RainCover(const scene::GpuScene& scene, bool wanted);
  /// Fills in the map's part of the block.
  void describe(shared::GpuWeather& block) const;
  gpu::Descriptor descriptor() const;

 private:
  dvec3 least_{0.0}, most_{1.0};  ///< local coordinates of the map, with margins
  gpu::Image map_;
  gpu::Sampler sampler_;
};

}  // namespace greatx::render
