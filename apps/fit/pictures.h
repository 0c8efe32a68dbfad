// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the result of a fit: errors over the plan, distributions, correlations.
#pragma once

#include <string>
#include <vector>

#include "apps/fit/result.h"
#include "core/record.h"

namespace greatx::apps {

/// A line of the plan in world coordinates.
struct PlanLine {
  dvec2 from{0.0}, to{0.0};
};
/// Returns where the facets of the links' world meet the horizontal plane at a height (world), as lines.
std::vector<PlanLine> plan_lines(const sim::FitModel& model, const dvec3& origin, double height_m);

/// Draws the errors of one set over the plan, u8 [height, width, 3]. Fitted positions are discs and held-out
/// ones have a ring; positions without a path are small and grey.
Array draw_error_map(const FitResult& result, uint32_t set, std::span<const PlanLine> plan,
                     const std::string& title);
/// Draws, for one set, the distributions of measured and modelled values (single values only) and of the
/// errors' magnitudes, before and after, fitted and held out.
Array draw_distributions(const FitResult& result, uint32_t set, const std::string& title);
/// Draws the correlations of the variables' errors.
Array draw_correlations(const FitResult& result, const std::string& title);

}  // namespace greatx::apps
