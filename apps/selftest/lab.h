// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the cases of the catalogue work with: the device, the passes of the product on small scenes, and the
// fault that a test plants to prove that a verdict can fail.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "apps/selftest/stage.h"
#include "core/random.h"
#include "gpu/tick_ring.h"
#include "renderer/lidar/lidar_pass.h"
#include "rf/antenna/antenna.h"
#include "rf/channel/frequency_response.h"
#include "rf/paths/path_solver.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/probe.h"

namespace greatx::apps::selftest {

/// A fault of the inputs. The expected values know nothing of it, so that each case must fail under some
/// fault.
enum class Fault {
  none,
  hole,   ///< the first triangle of each object is missing
  scale,  ///< every figure that goes into the product (Lab::given) is larger by a part in 1000
};

/// Returns "driver, fp32" or "tree, fp32".
const char* precision_of(gpu::Tracer tracer);
inline constexpr const char* host = "host, fp64";

class Lab {
 public:
  explicit Lab(gpu::Device& device, Fault fault = Fault::none) : device_(&device), fault_(fault) {}

  gpu::Device& device() const { return *device_; }
  /// Returns the tracers that the device has: the tree, and the driver if it has ray queries.
  std::vector<gpu::Tracer> tracers() const;
  /// Returns the name of what finds paths: the host, and the device's own tracer for visibility.
  std::string host_and_tracer() const;
  Stage stage() const { return Stage(fault_ == Fault::hole); }
  /// Returns a figure as the product gets it: unchanged, unless the fault says otherwise.
  double given(double value) const { return fault_ == Fault::scale ? 1.001 * value : value; }
  dvec3 given(const dvec3& value) const { return fault_ == Fault::scale ? 1.001 * value : value; }

  /// Returns the first hit of each ray, in lengths of its direction.
  std::vector<shared::ProbeHit> probe(const scene::Scene& scene, std::span<const shared::ProbeRay> rays,
                                      gpu::Tracer tracer) const;
  /// Returns what lies on each segment. If `walls`, materials with a thickness let waves through.
  std::vector<rf::Crossing> crossings(const scene::Scene& scene, std::span<const rf::Segment> segments,
                                      gpu::Tracer tracer, bool walls = false) const;
  /// Returns one sweep of a LiDAR at the origin.
  render::LidarScan sweep(const scene::Scene& scene, const render::LidarDesc& desc, gpu::Tracer tracer) const;

 private:
  gpu::Device* device_;
  Fault fault_;
};

/// Solves the paths of links in a scene by all stages of the product: beams, images in fp64, visibility by
/// the device's tracer in fp32, fields in fp64.
class Links {
 public:
  struct Options {
    double carrier_hz = 3.5e9;
    uint32_t max_depth = 1;
    bool walls = false;  ///< materials with a thickness let waves through
    bool edges = false;  ///< edges diffract
    uint32_t threads = 0;
  };
  /// `scene` must outlive this.
  Links(const Lab& lab, const scene::Scene& scene, const Options& options);

  /// Returns the paths to each receiver, in canonical order.
  std::vector<std::vector<rf::Path>> solve(const dvec3& transmitter, std::span<const dvec3> receivers);
  std::vector<rf::Path> solve(const dvec3& transmitter, const dvec3& receiver) {
    return solve(transmitter, std::span(&receiver, 1)).front();
  }
  const rf::RadioModel& model() const { return model_; }

 private:
  Options options_;
  rf::RadioModel model_;
  scene::GpuScene gpu_;
  rf::CrossingPass pass_;
  gpu::TickRing ring_;
};

/// Returns a single element at the origin of its array.
rf::ArrayPose antenna(rf::Pattern pattern = rf::Pattern::isotropic,
                      rf::Polarization polarization = rf::Polarization::v);

/// Returns a direction that is uniform over the sphere.
dvec3 random_direction(RandomStream& random);

/// Returns a ray towards `target`, which is one length away.
shared::ProbeRay ray_towards(const dvec3& origin, const dvec3& target);

}  // namespace greatx::apps::selftest
