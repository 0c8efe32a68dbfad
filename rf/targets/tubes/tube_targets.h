// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the echoes of targets between two points from their surfaces, with the ray tubes, the physical
// optics and the scatterers of radars (docs/radar_echoes.md, docs/clutter.md), for both polarizations at each
// end. A body has the cross-section that a radar sees (docs/radar_bodies.md), but for what edges add beyond
// physical optics, what waves bring that pass through panes, and what comes back over a mirror.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rf/radar/echoes/echo_finder.h"
#include "rf/surface/surfaces.h"
#include "scene/description/scene.h"
#include "scene/device/gpu_scene.h"

namespace greatx::rf {

struct TubeOptions {
  std::vector<uint32_t> instances;  ///< of the targets, indices into Scene::instances
  double tube_m = 0.03;             ///< width of the tubes on them
  uint32_t budget = 16384;          ///< most tubes on each of them
  uint32_t max_bounces = 3;
  bool roughness = false;
  double air_db_per_km = 0.0;
  double bandwidth_hz = 100e6;  ///< echoes merge that this band cannot tell apart
  /// Side of the squares of the targets' surfaces with one scatterer each, where their materials scatter.
  /// They widen until the box of the largest target has no more of them than `budget` and 32,768.
  double square_m = 0.05;
  uint64_t seed = 1;  ///< of the scatterers
};

/// Describes what one polarization of the transmitter sends over a target to one polarization of the
/// receiver.
struct TubeEcho {
  uint32_t instance = 0;            ///< index into Scene::instances of the last surface
  uint32_t sent = 0, received = 0;  ///< 0: theta, 1: phi, in the directions below and in world axes
  /// Field at the receiver per field at the transmitter, 1/m, without the phase of the delay.
  Complex transfer;
  dvec3 departure{0.0}, arrival{0.0}, point{0.0};
  std::vector<double> delay_s;  ///< [times] asked for
  double rate = 0.0;            ///< of the delay at the first of them, s/s
};

class TubeTargets {
 public:
  /// `surfaces` are those at the carrier. The bodies carry the ends and are not seen from them; 0: none.
  TubeTargets(scene::GpuScene& scene, const RadioSurfaces& surfaces, const std::string& name,
              uint32_t transmitter_body, uint32_t receiver_body, const TubeOptions& options);

  /// Holds the searches of one target.
  struct Search {
    FieldOfView view;                ///< of the box of the target with its parts
    dquat turn{1.0, 0.0, 0.0, 0.0};  ///< local from the frame of the view, whose x axis points to the box
    uint32_t tubes = 0;
    std::array<EchoFinder::Pending, 4> rays;
  };
  using Pending = std::vector<Search>;  ///< [instances]
  /// Records the rays in the scene as GpuScene::record_update() left it. Positions are local.
  [[nodiscard]] Pending record(gpu::TickSlot& slot, const dvec3& transmitter, const dvec3& receiver,
                               std::span<const Pose> bodies);
  /// Returns the echoes of the targets, after the submission of the slot is done, with their delays at
  /// `times_s`. The direct path, and what surfaces of other instances send, are left out.
  std::vector<TubeEcho> collect(const Pending& pending, const EchoMotion& motion,
                                std::span<const double> times_s) const;

 private:
  bool belongs(uint32_t instance, uint32_t target) const;
  /// Returns the instances of all targets with the parts that they carry, if any of them scatters.
  std::vector<uint32_t> scattering(const RadioSurfaces& surfaces) const;
  /// Returns the box of a target with the parts that it carries, in the frame of its body.
  scene::Bounds box_of(uint32_t target) const;
  double square_m() const;
  Search view_of(uint32_t target, const dvec3& transmitter, std::span<const Pose> bodies) const;

  const scene::Scene& scene_;
  double wavelength_m_;
  TubeOptions options_;
  /// [2 received + sent] one search for each pair of polarizations. All meet the same surfaces.
  std::array<std::unique_ptr<EchoFinder>, 4> finders_;
};

}  // namespace greatx::rf
