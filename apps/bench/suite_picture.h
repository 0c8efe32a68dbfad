// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The pictures of the camera and of the event camera of `greatx bench --suite`.
#pragma once

#include <memory>

#include "apps/bench/suite_passes.h"

namespace greatx::apps {

/// Makes the pass of a picture with rgb, depth and ids, by day with the sun's shadows, or at night with the
/// scene's lamps. Both arguments outlive it.
std::unique_ptr<SuitePass> make_suite_picture(scene::GpuScene& gpu_scene, const SuiteScene& scene,
                                              const SuiteWork& work, bool night);

/// Pictures of an interval of the event camera, without the one that it begins with.
inline constexpr uint32_t suite_event_pictures = 4;
/// Makes the pass of an interval: pictures of luminance by day, between which the camera turns, and their
/// events, sorted. Both arguments outlive it.
std::unique_ptr<SuitePass> make_suite_events(scene::GpuScene& gpu_scene, const SuiteScene& scene,
                                             const SuiteWork& work);

}  // namespace greatx::apps
