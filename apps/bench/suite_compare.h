// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --compare A.json B.json`: holds two suites side by side.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace greatx::apps {

/// Reads two files of `greatx bench --suite`. Returns {"a", "b": device and version, "rows": [{axis, size,
/// pass, tracer, "a_ms", "b_ms": distributions of the wall time, "ratio": median of b over a, "verdict"}],
/// "only_a", "only_b": rows of one file alone}. The verdict is "slower" or "faster" if the slowest run of one
/// file is faster than the fastest of the other, "within the spread" if not, and "too few runs" with fewer
/// than three runs on either side. Throws UserError that names file, line and field if a file is not such
/// JSON.
nlohmann::json compare_suites(const std::filesystem::path& a, const std::filesystem::path& b);

/// Returns the comparison as a table; the rows that differ come again at its end.
std::string compare_text(const nlohmann::json& comparison);

}  // namespace greatx::apps
