// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares the request that a folder of results keeps with the one that shall go on there.
#pragma once

#include <filesystem>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace greatx::io {

/// Throws UserError if `found`, the request in the folder, is not `asked`. `what` names what the folder holds
/// ("a fit"). The message gives the first difference by its JSON pointer: "/grid/cell_m: asked for 1, the
/// folder's has 2".
void check_same_request(const std::filesystem::path& folder, std::string_view what,
                        const nlohmann::ordered_json& asked, const nlohmann::ordered_json& found);

}  // namespace greatx::io
