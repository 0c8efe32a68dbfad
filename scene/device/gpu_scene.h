// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the scene on the GPU. It is uploaded once; then only the bodies' poses change.
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

/// Selects the tracer of the static world, in the passes that can use either.
enum class Tracer : uint32_t {
  automatic,  ///< the tree on a CPU driver, else the driver's tracer
  driver,     ///< ray queries
  tree,       ///< scene/device/static_tree.h; the driver still traces moving bodies
};

/// Selects the parts that the plan asks the upload to make.
struct GpuSceneOptions {
  bool acceleration_structure = true;  ///< some pass traces rays
  bool textures = true;                ///< some pass samples textures (cameras; alpha masks for LiDAR)
  Tracer tracer = Tracer::automatic;
  /// Tables that grow with the triangles and are larger than this are read by their address, and so are
  /// tables larger than the device's limit for a storage buffer. Tests lower this value.
  uint64_t most_table_bytes = ~uint64_t{0};
};

class GpuScene {
 public:
  GpuScene(gpu::Device& device, const Scene& scene, const GpuSceneOptions& options);

  /// Uploads the bodies' poses (local coordinates; [0] is ignored) into the slot. It builds the top-level
  /// structure the first time, refits it if a body has moved since, and leaves it alone otherwise. It must be
  /// recorded before any pass of the tick that uses the scene.
  void record_update(gpu::TickSlot& slot, std::span<const Pose> body_poses);

  /// Uploads only the poses, for raster passes that look at another instant than the tick's. The acceleration
  /// structure stays.
  void record_poses(gpu::TickSlot& slot, std::span<const Pose> body_poses);

  const Scene& scene() const { return *scene_; }
  const GpuSceneOptions& options() const { return options_; }
  gpu::Device& device() const { return *device_; }
  const gpu::Tlas& tlas() const { return tlas_; }
  const GpuTextures& textures() const { return textures_; }
  const gpu::Buffer& indices() const { return indices_; }
  /// Returns the descriptors of set 0 that all passes share: scene addresses, TLAS (if there is one), and
  /// this tick's bodies.
  std::vector<gpu::Descriptor> descriptors() const;
  /// Returns the bindings of these descriptors, for building pipelines. If `trace`, they include the TLAS.
  static std::vector<gpu::Binding> bindings(bool trace);
  /// Adds the tracer of a pipeline to its specialization constants. The shader's own constants have lower
  /// numbers and are already there. The tree is built when the first pass is to use it, and from then on
  /// `descriptors` has it. If the tree would not fit into a storage buffer, it is not built, and the driver's
  /// tracer is used.
  void specialize_tracer(std::vector<uint32_t>& specialization);
  /// Returns whether a pass traces through the tree.
  bool has_tree() const { return has_tree_; }
  /// Returns the descriptors without the TLAS, for raster passes.
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
  std::vector<gpu::Blas> blas_;      ///< one for each body that has triangles
  std::vector<uint32_t> blas_body_;  ///< body of each element of blas_
  gpu::Tlas tlas_;
  gpu::Buffer tree_;  ///< a single quadruple until a pass needs the tree
  bool has_tree_ = false;
  gpu::Slice bodies_;  ///< slice of the tick that is being recorded
  std::vector<Pose> last_poses_;
};

}  // namespace greatx::scene
