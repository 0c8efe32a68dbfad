// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace greatx {

/// Returns the folder for results that are kept between runs: GREATX_CACHE ("off": none), else
/// $XDG_CACHE_HOME/greatx, else ~/.cache/greatx; an empty path: nothing is kept.
std::filesystem::path cache_folder();

}  // namespace greatx
