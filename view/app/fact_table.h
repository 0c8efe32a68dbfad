// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "view/pick/pick.h"

namespace greatx::view {

/// Draws names and values as a table into the current ImGui window.
void draw_facts(const Facts& facts);

}  // namespace greatx::view
