// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The passes that `greatx bench --suite` measures, each with its rays and, where it traces, its answers.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/bench/suite_scene.h"
#include "gpu/tick_ring.h"
#include "scene/device/gpu_scene.h"

namespace greatx::apps {

/// A ray or a segment, as Embree gets it: hits with t_min < t < t_max count.
struct SuiteRay {
  vec3 origin{0.0f};
  float t_min = 0.0f;
  vec3 direction{1.0f, 0.0f, 0.0f};
  float t_max = 0.0f;
};

/// The answer to one ray, in a form that two tracers can be compared by.
struct SuiteAnswer {
  uint64_t word = 0;   ///< 0 or 1: whether something was met; or a hash of the facets met
  float distance = 0;  ///< to the hit; 0 where the pass tells none
};
/// Returns whether the words differ, or the distances by more than 1 mm and 1e-4 of them.
bool differs(const SuiteAnswer& a, const SuiteAnswer& b);
/// Returns the number of answers that differ. Both lists have the same length.
uint64_t count_differing(const std::vector<SuiteAnswer>& a, const std::vector<SuiteAnswer>& b);

/// What a pass is asked: the number of its rays, and the part of the scene it looks at.
struct SuiteWork {
  uint32_t rays = 1u << 16;
  uint32_t width = 320, height = 240;  ///< of the camera's picture
};

/// A pass over one scene on the device.
class SuitePass {
 public:
  virtual ~SuitePass() = default;
  /// Records the pass into the slot, for a scene whose update was recorded before.
  virtual void record(gpu::TickSlot& slot, const std::vector<Pose>& bodies) = 0;
  /// Takes what the host makes of the slot's submission, which is done. It belongs to the measured time.
  virtual void collect(const gpu::TickSlot& slot) { (void)slot; }
  /// Returns one answer for each ray, after the slot's submission is done; empty if the pass traces no rays.
  virtual std::vector<SuiteAnswer> answers(const std::vector<Pose>& bodies) {
    (void)bodies;
    return {};
  }
};

/// Names of the passes, in the order of the rows.
enum class SuiteKind { single_rays, lidar, crossings, candidates, radar, camera, events, lamps };
struct SuiteKindInfo {
  SuiteKind kind;
  const char* name;
  const char* modality;
  const char* unit;  ///< of the count
  bool traces;       ///< whether the pass runs once with each tracer
};
const std::vector<SuiteKindInfo>& suite_kinds();
const SuiteKindInfo& info_of(SuiteKind kind);

/// Returns the number of units of one run: rays, segments, or pixels of all pictures.
uint64_t suite_count(SuiteKind kind, const SuiteWork& work);
/// Makes a pass. Both arguments outlive it.
std::unique_ptr<SuitePass> make_suite_pass(SuiteKind kind, scene::GpuScene& gpu_scene,
                                           const SuiteScene& scene, const SuiteWork& work);
/// Returns the rays of a pass that Embree can trace too; empty for the others. `closest` says whether the
/// nearest hit is asked for, or any one.
std::vector<SuiteRay> suite_rays(SuiteKind kind, const SuiteScene& scene, const SuiteWork& work,
                                 bool& closest);

}  // namespace greatx::apps
