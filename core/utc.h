// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>
#include <string>

namespace greatx {

/// Returns a time in UTC, by default as ISO 8601 writes it: 2026-01-31T12:00:00Z. `format` is that of
/// strftime(), for a text of at most 63 bytes.
std::string utc_text(std::time_t time, const char* format = "%Y-%m-%dT%H:%M:%SZ");

}  // namespace greatx
