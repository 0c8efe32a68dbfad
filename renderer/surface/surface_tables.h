// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the data of triangles and materials that shading needs, packed for few wide fetches. On a CPU
// driver most of a pixel's cost is the gathers (docs/camera.md has the figures).
#pragma once

#include <vector>

#include "gpu/cmd.h"
#include "renderer/surface/closed_bodies.h"
#include "scene/device/gpu_scene.h"

namespace greatx::render {

class SurfaceTables {
 public:
  /// Throws UserError if the scene has 65536 bodies or materials, or more.
  /// Without `lamps`, lamps that switch (scene/description/lamps.h) are dark.
  explicit SurfaceTables(const scene::GpuScene& scene, bool lamps = true);

  static std::vector<gpu::Binding> bindings();
  std::vector<gpu::Descriptor> descriptors() const;
  /// Returns whether records of triangles are read by their address (shared::spec_triangle_address).
  bool by_address() const { return static_cast<bool>(address_); }
  const gpu::Buffer& materials() const { return materials_; }  ///< the records of materials
  /// uint [triangles]: the primitive of each triangle.
  const gpu::Buffer& triangle_primitives() const { return triangle_primitives_; }
  /// uvec2 [triangles + 1], by triangle + 1: instance + 1, semantic class | (material + 1) << 16; [0]:
  /// nothing.
  const gpu::Buffer& triangle_ids() const { return triangle_ids_; }
  const ClosedSurfaces& closed() const { return closed_; }

 private:
  gpu::Buffer triangles_, materials_;  ///< shaders/shared/camera.h: triangle_record_quads
  gpu::Buffer address_;                ///< address of triangles_, if they are too many to be bound
  gpu::Buffer triangle_primitives_, triangle_ids_;
  ClosedSurfaces closed_;
};

}  // namespace greatx::render
