// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the rows of the catalogue as text and as JSON.
#pragma once

#include <ostream>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "apps/selftest/catalogue.h"
#include "gpu/device.h"

namespace greatx::apps::selftest {

struct Verdict {
  uint32_t cases = 0, rows = 0, failed = 0;  ///< `failed` counts rows
  double seconds = 0.0;
};

/// Returns one line of the table: verdict, number, figure, what computed it, expected, got, tolerance.
std::string line_of(const Row& row);
/// Returns the heading of these lines.
std::string heading();
/// Returns the last line: how many rows agree, on which device, in what time.
std::string summary_of(const Verdict& verdict, const gpu::DeviceInfo& device);

/// Returns {greatx, device, driver, cases, rows: [...], failed, seconds, passed}. A figure that is not finite
/// is null.
nlohmann::json json_of(std::span<const Row> rows, const Verdict& verdict, const gpu::DeviceInfo& device);

}  // namespace greatx::apps::selftest
