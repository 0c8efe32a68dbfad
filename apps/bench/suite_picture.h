// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The camera's pictures of `greatx bench --suite`.
#pragma once

#include <memory>

#include "apps/bench/suite_passes.h"

namespace greatx::apps {

/// Makes the pass of a picture with rgb, depth and ids, by day with the sun's shadows, or at night with the
/// scene's lamps. Both arguments outlive it.
std::unique_ptr<SuitePass> make_suite_picture(scene::GpuScene& gpu_scene, const SuiteScene& scene,
                                              const SuiteWork& work, bool night);

}  // namespace greatx::apps
