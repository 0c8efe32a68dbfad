// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/rounding.h"

namespace greatx {

double rounded_to_float(double value) { return static_cast<double>(static_cast<float>(value)); }

}  // namespace greatx
