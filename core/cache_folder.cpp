// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/cache_folder.h"

#include <cstdlib>
#include <string>

namespace greatx {

std::filesystem::path cache_folder() {
  const auto variable = [](const char* name) {
    const char* const value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  if (const std::string own = variable("GREATX_CACHE"); !own.empty())
    return own == "off" ? std::filesystem::path() : std::filesystem::path(own);
  if (const std::string shared = variable("XDG_CACHE_HOME"); !shared.empty())
    return std::filesystem::path(shared) / "greatx";
  if (const std::string home = variable("HOME"); !home.empty())
    return std::filesystem::path(home) / ".cache" / "greatx";
  return {};
}

}  // namespace greatx
