// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts between linear values and sRGB by IEC 61966-2-1, exactly, from 0 to 1. The shaders have their own
// version (shaders/shared/develop.h).
#pragma once

#include <cmath>

namespace greatx {

template <typename T>
T linear_from_srgb(T s) {
  return s <= T(0.04045) ? s / T(12.92) : std::pow((s + T(0.055)) / T(1.055), T(2.4));
}

template <typename T>
T srgb_from_linear(T c) {
  return c <= T(0.0031308) ? T(12.92) * c : T(1.055) * std::pow(c, T(1.0 / 2.4)) - T(0.055);
}

}  // namespace greatx
