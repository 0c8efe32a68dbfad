// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the echoes of a radar in the scene by shooting and bouncing rays, with the physical optics of each
// tube (docs/radar_echoes.md; H. Ling, R.-C. Chou, S.-W. Lee, "Shooting and bouncing rays: calculating the
// RCS of an arbitrarily shaped cavity", IEEE Trans. Antennas Propag. 37(2), 1989).
//
//   record   RayGrid: tubes over the field of view, finer where targets are
//              ─► EchoPass (GPU): facets that each ray meets
//   collect  (EchoTracer: the same on the host, where the device is a CPU)
//              ─► TubeEchoes (fp64): fields and phase integrals of every tube
//              ─► merge ─► delay tracks ─► EchoList
//              ─► ClutterPatches: scatterers on what the tubes see of rough surfaces ─► EchoList::patches
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "rf/config/echo_options.h"
#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/beam_memory.h"
#include "rf/radar/echoes/clutter_patches.h"
#include "rf/radar/echoes/echo_field.h"
#include "rf/radar/echoes/echo_motion.h"
#include "rf/radar/echoes/echo_pass.h"
#include "rf/radar/echoes/echo_sender.h"
#include "rf/radar/echoes/echo_tracer.h"
#include "rf/radar/echoes/edge_echoes.h"
#include "rf/radar/echoes/facet_echoes.h"
#include "rf/radar/echoes/facet_trees.h"
#include "rf/radar/echoes/mirrors.h"
#include "rf/radar/echoes/ray_grid.h"
#include "rf/radar/echoes/ray_hits.h"
#include "rf/radar/echoes/veils.h"
#include "rf/radar/signal/echo.h"
#include "rf/surface/surfaces.h"
#include "scene/device/gpu_scene.h"

namespace greatx::rf {

class EchoFinder {
 public:
  /// `receiver` is absent for a monostatic radar, whose receiver is the transmitter. `surfaces` are those at
  /// the carrier. `survey` is null, or one of the scene's edges, which spares work. Throws UserError if an
  /// option is out of its range.
  EchoFinder(scene::GpuScene& scene, const RadioSurfaces& surfaces, const EchoEnd& transmitter,
             const std::optional<EchoEnd>& receiver, const EchoOptions& options,
             const scene::EdgeSurvey* survey = nullptr);
  /// Whether the host traces the rays of a finder with these options. Such a finder records nothing on the
  /// device, and a thread beside others that do may make it.
  static bool traces_on_host(const gpu::Device& device, const EchoOptions& options);

  /// Holds a search that is under way. The slices are valid until the slot begins again.
  struct Pending {
    std::shared_ptr<const RayGrid> grid;  ///< null if the host traces
    Pose transmitter, receiver;
    std::vector<Pose> body_poses;
    EchoPass::Pending rays;  ///< empty if the host traces
  };

  /// Records the rays in the scene as scene.record_update(slot, body_poses) left it. Poses are in local
  /// coordinates.
  [[nodiscard]] Pending record(gpu::TickSlot& slot, const Pose& transmitter, const Pose& receiver,
                               std::span<const Pose> body_poses);

  /// Returns the echoes; call it after the submission of the slot is done. The list is empty if no ray meets
  /// anything. The bytes do not depend on the number of threads. Throws UserError naming the instance if a
  /// surface is inside an antenna (EchoOptions::antenna_radius_m).
  EchoList collect(const Pending& pending, const EchoMotion& motion, EchoStatistics* statistics = nullptr);

  /// Returns the ratio of the field at the receiver's port to that at the port of another radar's
  /// transmitter at `pose`, without the phase of the way; 0 if something is between. `pending` says where
  /// the receiver and the bodies are.
  std::complex<double> direct(const Pending& pending, const EchoEnd& other, const Pose& pose);

  const EchoOptions& options() const { return options_; }
  /// Sets the field of view and the number of tubes for the calls of record() and collect() that follow. Both
  /// calls of one search need the same. The field of view is about the x axis of a frame that `turn` turns
  /// from local coordinates, whatever the orientation of the transmitter.
  void set_view(const FieldOfView& view, uint32_t tubes, const dquat& turn) {
    options_.field_of_view = view;
    options_.tubes = tubes;
    turn_ = turn;
  }

 private:
  std::vector<TargetBox> targets(std::span<const Pose> body_poses) const;
  /// Returns the echoes of tubes and of small facets. world_ must already be in its poses.
  RawEchoes raw_echoes(const Pending& pending, const RayGrid& grid, const RayHits& hits,
                       const EchoField& field, EchoStatistics& statistics) const;
  class VeiledSearch;
  EchoRays rays_of(const Pending& pending) const {
    return {pending.transmitter.position, pending.receiver.position, transmitter_.own_body,
            receiver_.own_body};
  }
  RayGrid grid_at(const Pose& transmitter) const {
    return RayGrid(options_, {transmitter.position, turn_.value_or(transmitter.orientation)});
  }
  void pose_world(std::span<const Pose> body_poses);
  void check_antenna(const dvec3& at, const RayGrid& grid, std::span<const uint32_t> hits) const;

  scene::GpuScene* scene_;
  RadioSurfaces surfaces_;
  EchoEnd transmitter_, receiver_;
  bool monostatic_;
  EchoOptions options_;
  std::optional<dquat> turn_;  ///< of the field of view; absent: that of the transmitter
  FacetWorld world_;
  FacetTrees trees_;
  EchoTracer tracer_;
  std::unique_ptr<BeamMemory> memory_;
  uint32_t traced_;               ///< number of surfaces that a ray may meet
  std::optional<EchoPass> pass_;  ///< empty if the host traces
  std::optional<MirrorFinder> mirrors_;
  std::optional<Veils> veils_;             ///< present if transmission is asked for and there are any
  std::optional<EdgeEchoes> edges_;        ///< present if edges are asked for
  std::optional<ClutterPatches> clutter_;  ///< present if rough surfaces are asked for
};

}  // namespace greatx::rf
