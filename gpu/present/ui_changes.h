// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Which parts of a user interface have changed since the last frame. On a CPU, the fill of a window costs as
// much as a picture of the scene, and most of a window stays as it is.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "gpu/present/ui_pipeline.h"

namespace greatx::gpu {

class UiChanges {
 public:
  /// Returns rectangles within `extent` that do not overlap. Outside of them, `drawing` draws what the last
  /// one drew. `version_of` returns a number for each texture that changes with its texels.
  std::vector<VkRect2D> update(VkExtent2D extent, const UiDrawing& drawing,
                               const std::function<uint64_t(PresentTextureId)>& version_of);
  /// The next drawing is new everywhere.
  void forget() { extent_ = {0, 0}; }

 private:
  /// A command as it was drawn.
  struct Drawn {
    uint64_t content = 0;
    VkRect2D place{};
  };
  VkExtent2D extent_{0, 0};
  std::vector<Drawn> last_;
};

/// Returns the whole pixels that the command fills if it is an upright rectangle in full colour.
std::optional<VkRect2D> opaque_quad(const UiCommand& command, const UiDrawing& drawing);
bool same_rect(const VkRect2D& a, const VkRect2D& b);
/// Returns the part that both have; its extent is empty if they have none.
VkRect2D intersection(const VkRect2D& a, const VkRect2D& b);

}  // namespace greatx::gpu
