// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the scene on the GPU. It is uploaded once; then only the bodies' poses change.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "gpu/acceleration.h"
#include "gpu/cmd.h"
#include "gpu/pipeline.h"
#include "gpu/tick_ring.h"
#include "scene/description/lamps.h"
#include "scene/description/scene.h"
#include "scene/device/body_tree.h"
#include "scene/device/gpu_textures.h"
#include "shaders/shared/scene.h"

namespace greatx::scene {

/// Selects the parts that the plan asks the upload to make.
struct GpuSceneOptions {
  bool acceleration_structure = true;  ///< some pass traces rays
  bool textures = true;                ///< some pass samples textures (cameras; alpha masks for LiDAR)
  gpu::Tracer tracer = gpu::Tracer::automatic;  ///< automatic: the device's
  /// Tables that grow with the triangles and are larger than this are read by their address, and so are
  /// tables larger than the device's limit for a storage buffer. Tests lower this value.
  uint64_t most_table_bytes = ~uint64_t{0};
};

class GpuScene {
 public:
  GpuScene(gpu::Device& device, const Scene& scene, const GpuSceneOptions& options);

  /// Uploads the bodies' poses (local coordinates; [0] is ignored) into the slot. If rays are traced, it also
  /// uploads the tree of the bodies, or for the driver's tracer builds the top-level structure the first time
  /// and refits it if a body has moved since. It must be recorded before any pass of the tick that uses the
  /// scene.
  void record_update(gpu::TickSlot& slot, std::span<const Pose> body_poses);

  /// Uploads only the poses, for raster passes that look at another instant than the tick's. The acceleration
  /// structure stays.
  void record_poses(gpu::TickSlot& slot, std::span<const Pose> body_poses);

  /// Sets the factors of the emission of the switched lamps (scene/description/lamps.h), in their order, for
  /// the next updates. They are 1 before. The poses' buffer carries them to the shaders, which find them
  /// behind the last body (shaders/lib/scene.glsl).
  void set_lamps(std::vector<float> factors);
  const SwitchedLamps& switched_lamps() const { return switched_lamps_; }

  const Scene& scene() const { return *scene_; }
  const GpuSceneOptions& options() const { return options_; }
  gpu::Device& device() const { return *device_; }
  /// Returns whether rays are traced, and so the tracer is there.
  bool traces() const { return options_.acceleration_structure; }
  /// Returns the tracer of every pass over this scene: the driver or the tree.
  gpu::Tracer tracer() const { return tracer_; }
  const GpuTextures& textures() const { return textures_; }
  const gpu::Buffer& indices() const { return indices_; }
  /// Returns the descriptors of set 0 that passes which trace share: scene addresses, this tick's bodies, and
  /// the tracer's structures.
  std::vector<gpu::Descriptor> descriptors() const;
  /// Makes `compute` trace rays through this scene: it sets the variant of the shader `name`, the bindings of
  /// `descriptors` and the tracer's specialization constant. The shader's own constants have lower numbers
  /// and are already there.
  void prepare_tracing(gpu::ComputeDesc& compute, std::string_view name) const;
  /// Returns the bindings of `raster_descriptors`, for building pipelines.
  static std::vector<gpu::Binding> raster_bindings();
  /// Returns the descriptors for passes that do not trace.
  std::vector<gpu::Descriptor> raster_descriptors() const;

 private:
  void upload_geometry();
  void build_structures();
  void build_trees();
  void record_tlas(gpu::TickSlot& slot, std::vector<Pose> poses);

  gpu::Device* device_;
  const Scene* scene_;
  GpuSceneOptions options_;
  gpu::Tracer tracer_;
  gpu::Buffer positions_, normals_, tangents_, uvs_, indices_, primitives_, materials_, facet_of_triangle_,
      addresses_;
  GpuTextures textures_;
  // The driver's tracer:
  std::vector<gpu::Blas> blas_;      ///< one for each body that has triangles
  std::vector<uint32_t> blas_body_;  ///< body of each element of blas_
  gpu::Tlas tlas_;
  std::vector<Pose> last_poses_;
  // The tree (shaders/shared/tree.h):
  gpu::Buffer trees_;
  bool trees_by_address_ = false;
  BodyTree body_tree_;
  gpu::Slice body_words_;  ///< of the tick that is being recorded
  SwitchedLamps switched_lamps_;
  std::vector<float> lamp_factors_;
  gpu::Slice bodies_;  ///< slice of the tick that is being recorded
};

}  // namespace greatx::scene
