// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace greatx {

/// Returns `value` rounded to single precision. It is not inline: GCC 12 vectorises two such roundings side by
/// side and then drops both of them.
double rounded_to_float(double value);

}  // namespace greatx
