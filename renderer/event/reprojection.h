// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Takes the pixels of an event camera from one picture to the next through instants that are reconstructed
// from the two (docs/events.md, "Reconstructed instants").
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gpu/tick_ring.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/events.h"
#include "shaders/shared/reproject.h"

namespace greatx::render {

struct EventDesc;

/// Says how pixels at the instants between two pictures look at these pictures.
struct PixelPaths {
  /// PixelPath [2 pictures][grid + 1 instants][bodies]; [..][0] is the world, which needs no values unless
  /// `exact_world`.
  std::vector<shared::PixelPath> of_bodies;
  uint32_t bodies = 1;
  bool exact_world = false;                  ///< the world's paths are not cubic enough
  std::array<shared::PixelPath, 8> world{};  ///< ReprojectInterval::world
};

class Reprojection {
 public:
  /// `specialization` is that of the event shaders.
  Reprojection(const scene::GpuScene& scene, const EventDesc& desc,
               const std::vector<uint32_t>& specialization);

  /// Returns the buffer for the cells of the next picture.
  const gpu::Buffer& next() const { return cells_[1 - newest_]; }
  /// Says that the cells of the next picture have been recorded.
  void take() { newest_ = 1 - newest_; }

  /// Records the step from the picture before the newest one to the newest one. `descriptors` are those of
  /// the event shaders. `pixels` and `extra` hold the state; they are swapped with that after the step.
  void record(gpu::TickSlot& slot, std::vector<gpu::Descriptor> descriptors,
              const shared::EventConstants& constants, const PixelPaths& paths, gpu::Buffer& pixels,
              gpu::Buffer& extra);

 private:
  gpu::Slice upload(gpu::TickSlot& slot, const PixelPaths& paths, const gpu::Slice& of_bodies,
                    bool replay) const;
  void dispatch(gpu::Cmd& cmd) const;

  uint32_t width_, height_, grid_;
  float most_px_, sharpness_;
  std::array<gpu::Buffer, 2> cells_;  ///< by picture
  std::array<gpu::Buffer, 2> tiles_;  ///< ReprojectInterval::tiles
  uint32_t newest_ = 0;
  gpu::Buffer after_, extra_after_, counts_;
  gpu::ComputePipeline tile_luminance_, bound_, reproject_, rank_;
};

}  // namespace greatx::render
