// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The scene on the GPU: uploaded once, then only the bodies' poses change.
#pragma once

#include <span>
#include <vector>

#include "gpu/acceleration.h"
#include "gpu/cmd.h"
#include "gpu/tick_ring.h"
#include "scene/description/scene.h"
#include "scene/device/gpu_textures.h"
#include "shaders/shared/scene.h"

namespace greatx::scene {

/// What traces rays through the static world, in the passes that can do either.
enum class Tracer : uint32_t {
  automatic,  ///< the tree on a CPU's driver, else the driver's
  driver,     ///< ray queries
  tree,       ///< scene/device/static_tree.h; bodies that move are the driver's all the same
};

/// What the plan asks the upload to make.
struct GpuSceneOptions {
  bool acceleration_structure = true;  ///< some pass traces rays
  bool textures = true;                ///< some pass samples textures (cameras; alpha masks for LiDAR)
  Tracer tracer = Tracer::automatic;
  /// Tables that grow with the triangles and are larger are read by their address, as those are that the device does not let
  /// a shader see at once. Tests lower it.
  uint64_t most_table_bytes = ~uint64_t{0};
};

class GpuScene {
 public:
  GpuScene(gpu::Device& device, const Scene& scene, const GpuSceneOptions& options);

  /// Uploads the bodies' poses (local coordinates; [0] is ignored) into the slot, and builds the top-level
  /// structure the first time, refits it when a body moved since, and leaves it alone otherwise. Must be
  /// recorded before any pass of the tick that uses the scene.
  void record_update(gpu::TickSlot& slot, std::span<const Pose> body_poses);

  /// The poses alone, for raster passes that look at another instant than the tick's; the acceleration structure stays.
  void record_poses(gpu::TickSlot& slot, std::span<const Pose> body_poses);

  const Scene& scene() const { return *scene_; }
  const GpuSceneOptions& options() const { return options_; }
  gpu::Device& device() const { return *device_; }
  const gpu::Tlas& tlas() const { return tlas_; }
  const GpuTextures& textures() const { return textures_; }
  const gpu::Buffer& indices() const { return indices_; }
  /// Descriptors of set 0 shared by all passes: scene addresses, TLAS (if there is one), this tick's bodies.
  std::vector<gpu::Descriptor> descriptors() const;
  /// Their bindings, for building pipelines. `trace`: with the TLAS.
  static std::vector<gpu::Binding> bindings(bool trace);
  /// Says in a pipeline's specialization constants which tracer it uses; a shader's own have lower numbers and stand in there
  /// already. Builds the tree when the first pass is to use it; `descriptors` has it from then on. A tree that would not fit into
  /// a storage buffer is not built, and the driver's tracer is used.
  void specialize_tracer(std::vector<uint32_t>& specialization);
  /// Whether a pass traces through the tree.
  bool has_tree() const { return has_tree_; }
  /// The same without the TLAS, for raster passes.
  std::vector<gpu::Descriptor> raster_descriptors() const;

 private:
  void upload_geometry();
  void build_structures();
  bool wants_tree() const;

  gpu::Device* device_;
  const Scene* scene_;
  GpuSceneOptions options_;
  gpu::Buffer positions_, normals_, tangents_, uvs_, indices_, primitives_, materials_, facet_of_triangle_,
      addresses_;
  GpuTextures textures_;
  std::vector<gpu::Blas> blas_;      ///< of the bodies that have triangles
  std::vector<uint32_t> blas_body_;  ///< body of each
  gpu::Tlas tlas_;
  gpu::Buffer tree_;  ///< of one quadruple until a pass needs it
  bool has_tree_ = false;
  gpu::Slice bodies_;  ///< of the tick being recorded
  std::vector<Pose> last_poses_;
};

}  // namespace greatx::scene
