// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/files/same_request.h"

#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace greatx::io {
namespace {

using Json = nlohmann::ordered_json;

std::string first_difference(const Json& asked, const Json& found) {
  const Json a = asked.flatten(), b = found.is_structured() ? found.flatten() : Json::object();
  for (const auto& [key, value] : a.items())
    if (!b.contains(key) || b[key] != value)
      return fmt::format("{}: asked for {}, the folder's has {}", key, value.dump(),
                         b.contains(key) ? b[key].dump() : "none");
  return "it has more in it";
}

}  // namespace

void check_same_request(const std::filesystem::path& folder, std::string_view what, const Json& asked,
                        const Json& found) {
  if (found == asked) return;
  throw_user_error("{}: holds {} that asked for something else, which this one cannot resume: {}",
                   folder.string(), what, first_difference(asked, found));
}

}  // namespace greatx::io
