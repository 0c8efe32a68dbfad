// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The echoes of a radar, from the scene: shooting and bouncing rays with the physical optics of each tube
// (docs/radar_echoes.md; H. Ling, R.-C. Chou, S.-W. Lee, "Shooting and bouncing rays: calculating the RCS of an arbitrarily
// shaped cavity", IEEE Trans. Antennas Propag. 37(2), 1989).
//
//   record   RayGrid: tubes over the field of view, finer where targets are ─► EchoPass: what each ray meets (GPU)
//   collect  (EchoTracer: the same on the host, where the device is a CPU)
//            TubeEchoes: fields and phase integrals of every tube, fp64 ─► merge ─► delay tracks ─► EchoList
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "rf/config/echo_options.h"
#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/echo_motion.h"
#include "rf/radar/echoes/echo_pass.h"
#include "rf/radar/echoes/echo_tracer.h"
#include "rf/radar/echoes/facet_trees.h"
#include "rf/radar/echoes/mirrors.h"
#include "rf/radar/echoes/ray_grid.h"
#include "rf/radar/signal/echo.h"
#include "rf/surface/surfaces.h"
#include "scene/device/gpu_scene.h"

namespace greatx::rf {

class EchoFinder {
 public:
  /// `receiver`: absent for a monostatic radar, whose receiver is the transmitter. Surfaces are those of the carrier.
  /// Throws UserError if an option is out of its range.
  EchoFinder(scene::GpuScene& scene, const RadioSurfaces& surfaces, const EchoEnd& transmitter,
             const std::optional<EchoEnd>& receiver, const EchoOptions& options);

  /// What is under way; the slices are valid until the slot is begun again.
  struct Pending {
    std::shared_ptr<const RayGrid> grid;  ///< none yet if the host traces
    Pose transmitter, receiver;
    std::vector<Pose> body_poses;
    EchoPass::Pending rays;  ///< nothing if the host traces
  };

  /// Records the rays among the scene as scene.record_update(slot, body_poses) left it. Poses in local coordinates.
  [[nodiscard]] Pending record(gpu::TickSlot& slot, const Pose& transmitter, const Pose& receiver,
                               std::span<const Pose> body_poses);
  [[nodiscard]] Pending record(gpu::TickSlot& slot, const Pose& radar, std::span<const Pose> body_poses) {
    return record(slot, radar, radar, body_poses);
  }

  /// The echoes, after the slot's submission is done; the same bytes whatever the threads. Nothing met: no echoes.
  /// Throws UserError naming the instance if a surface is inside an antenna (EchoOptions::antenna_radius_m).
  EchoList collect(const Pending& pending, const EchoMotion& motion, EchoStatistics* statistics = nullptr);

  /// The same outside the ticks, everything at rest, in a set-up submission of its own (waits for it); calls
  /// GpuScene::record_update: record it again before the next pass of a tick.
  EchoList find(const Pose& transmitter, const Pose& receiver, std::span<const Pose> body_poses,
                EchoStatistics* statistics = nullptr);

  const EchoOptions& options() const { return options_; }

 private:
  std::vector<TargetBox> targets(std::span<const Pose> body_poses) const;
  /// Tubes for where everything is; world_ is posed so.
  std::shared_ptr<const RayGrid> grid_for(const Pose& transmitter, std::span<const Pose> body_poses) const;
  EchoRays rays_of(const Pending& pending) const {
    return {pending.transmitter.position, pending.receiver.position, transmitter_.own_body,
            receiver_.own_body};
  }
  void pose_world(std::span<const Pose> body_poses);
  void check_antenna(const dvec3& at, const RayGrid& grid, std::span<const uint32_t> hits) const;

  scene::GpuScene* scene_;
  RadioSurfaces surfaces_;
  EchoEnd transmitter_, receiver_;
  bool monostatic_;
  EchoOptions options_;
  FacetWorld world_;
  FacetTrees trees_;
  uint32_t traced_;                   ///< surfaces that a ray may meet
  std::optional<EchoPass> pass_;      ///< none: the host traces
  std::optional<EchoTracer> tracer_;  ///< if it does, or looks for mirrors
  std::optional<MirrorFinder> mirrors_;
};

}  // namespace greatx::rf
