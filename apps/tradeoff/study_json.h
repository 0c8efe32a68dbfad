// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of a study as JSON.
#pragma once

#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

#include "sim/tradeoff/measure.h"

namespace greatx::apps {

/// JSON has no infinity: null.
inline nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

/// Returns median and quartiles: {"median", "low", "high", "count"}.
inline nlohmann::json spread_json(const std::vector<double>& samples) {
  const sim::Spread spread = sim::spread_of(samples);
  return {{"median", spread.median}, {"low", spread.low}, {"high", spread.high}, {"count", spread.count}};
}

}  // namespace greatx::apps
