// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the files of FitModel share.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/fit/model.h"

namespace greatx::sim {

inline std::span<const double> values_at(const FitSet& set, uint32_t position) {
  return std::span(set.values).subspan(size_t{position} * set.width, set.width);
}
inline std::span<const rf::Complex> responses_at(const FitSet& set, uint32_t position) {
  return std::span(set.responses).subspan(size_t{position} * set.width, set.width);
}

inline double rms_of(std::span<const rf::Complex> of) {
  double sum = 0.0;
  for (const rf::Complex& value : of) sum += std::norm(value);
  return std::sqrt(sum / static_cast<double>(of.size()));
}

/// The columns of a link: its parameters and the variables of its set, ascending.
struct FitModel::Columns {
  std::vector<uint32_t> variables;
  const SetVariables* set = nullptr;
  int of(int variable) const {
    if (variable < 0) return -1;
    const auto found = std::ranges::find(variables, static_cast<uint32_t>(variable));
    return found == variables.end() ? -1 : static_cast<int>(found - variables.begin());
  }
};

}  // namespace greatx::sim
