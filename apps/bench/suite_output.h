// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes what `greatx bench --suite` has measured.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "core/record.h"
#include "gpu/device.h"

namespace greatx::apps {

/// Returns {"name", "type", "driver", "api_version", "memory_bytes", "ray_query", "mesa", "llvm"}. The last
/// two are versions from the texts of name and driver, and are empty where these name none.
nlohmann::json suite_device(const gpu::DeviceInfo& info);
/// Returns the version that follows `word` in a text, e.g. "25.0.7" of "llvmpipe Mesa 25.0.7-2 (LLVM
/// 15.0.6)" for "Mesa"; empty if there is none.
std::string version_after(const std::string& text, const std::string& word);

/// Returns the tables: the device, and a table for each axis.
std::string suite_markdown(const nlohmann::json& result);
/// Returns the small file that docs/devices/ collects: the device, and the rates of each pass at 100 k
/// triangles, or at the largest size below.
nlohmann::json suite_summary(const nlohmann::json& result);
/// Returns the growth curves of an axis: a panel for each pass, a line for each tracer. They show rates over
/// sizes, both logarithmic, with bars from the slowest to the fastest run.
Array suite_curves(const nlohmann::json& result, const std::string& axis);

/// Writes suite.json, suite.md, device.json and AXIS.png. Creates the folder.
void write_suite(const std::filesystem::path& folder, const nlohmann::json& result);

}  // namespace greatx::apps
