// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/record.h"

namespace greatx::apps {

void write_report(const nlohmann::json& report, const std::filesystem::path& folder);
Array picture_of(const SensorSpec& spec, const Record& record);

}  // namespace greatx::apps
