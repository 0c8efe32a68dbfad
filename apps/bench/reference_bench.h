// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --camera --reference N`: compares the picture of a scenario's first camera, and the picture
// without each of its approximations, with a path-traced reference of N paths a pixel.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct ReferenceBenchOptions {
  int64_t warm_up = 3;           ///< pictures of each row that are taken first and not measured
  uint32_t samples = 0;          ///< paths a pixel
  uint32_t bounces = 16;         ///< reflections after the first one that a path may have
  double later_roughness = 0.0;  ///< render::PathOptions::later_roughness
  uint32_t pictures = 16;        ///< measured pictures of each row
  int64_t tick = 0;              ///< of the first sequence
  std::filesystem::path folder;  ///< for reference, pictures and differences; empty: none are written
};

/// Returns one JSON object with scenario, device, driver, camera, width, height, samples, bounces,
/// later_roughness, seconds of the reference, and `rows`. A row has:
/// - name;
/// - cpu_ms: processor time of a picture with rgb, depth and ids, all threads;
/// - flip: mean FLIP of the developed picture against the developed reference;
/// - scene, shade, glossy, lines: errors of luminance (render::ReferenceError) over pixels that show nothing
///   but the scene; over those of them that the key light does not reach; over smooth surfaces (roughness up
///   to 0.3); and over pixels that thin lines change, each with pixels, rmse, bias and noise.
/// Pictures are developed on the host without noise and vignetting. The rows' timed pictures take turns. With
/// `folder`, writes reference.exr and reference.png, and for each row NAME.png and NAME-difference.png, where
/// grey is no difference. Throws UserError if the scenario has no camera or no such tick.
nlohmann::json reference_bench(const ScenarioOptions& scenario, const RunOptions& run,
                               const ReferenceBenchOptions& options);
/// Returns the result as a table.
std::string reference_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
