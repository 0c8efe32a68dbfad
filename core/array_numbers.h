// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/record.h"

namespace greatx {

/// Returns element `i` of an array of real numbers of any type. Throws ContractError for complex ones.
double number_at(const Array& array, size_t i);

}  // namespace greatx
