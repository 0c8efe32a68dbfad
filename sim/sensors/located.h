// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/error.h"

namespace greatx::sim {

/// Returns the result of `act`. If `act` throws a UserError without a location, `where` is added, unless its
/// line is 0.
template <typename Act>
auto located(const SourceLocation& where, const Act& act) {
  try {
    return act();
  } catch (const UserError& error) {
    if (error.located() || where.line == 0) throw;
    throw_user_error_at(where, "{}", error.what());
  }
}

}  // namespace greatx::sim
