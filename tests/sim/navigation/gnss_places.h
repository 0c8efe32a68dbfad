// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The place and the time of the tests of GNSS receivers.
#pragma once

#include "core/geodesy.h"

namespace greatx::navigation {

constexpr double noon_unix_s = 1782043200.0;  // 2026-06-21T12:00:00Z
inline const Georeference delft{{52.0, 4.37, 45.0}, 43.0, "NAP"};

}  // namespace greatx::navigation
