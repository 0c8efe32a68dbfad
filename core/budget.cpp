// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/budget.h"

#include <string_view>

#include "core/error.h"

namespace greatx {

std::string amount(uint64_t value, const Budget& budget) {
  if (std::string_view(budget.unit) != "bytes") return fmt::format("{} {}", value, budget.unit);
  const auto scaled = static_cast<double>(value);
  if (value >= budget::gib) return fmt::format("{:.4g} GiB", scaled / static_cast<double>(budget::gib));
  if (value >= budget::mib) return fmt::format("{:.4g} MiB", scaled / static_cast<double>(budget::mib));
  return fmt::format("{} bytes", value);
}

void require_within(const std::string& where, uint64_t planned, const Budget& budget) {
  if (planned <= budget.most) return;
  throw_user_error("{}: expected at most {} for {} (docs/limits.md), found {}{}", where,
                   amount(budget.most, budget), budget.what, planned == UINT64_MAX ? "more than " : "",
                   amount(planned, budget));
}

void Spending::plan(const std::string& where, uint64_t planned) {
  planned_ = saturating_sum(planned_, planned);
  require_within(where, planned_, budget_);
}

}  // namespace greatx
