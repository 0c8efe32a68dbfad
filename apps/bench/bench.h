// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace greatx::apps {

void add_bench(CLI::App& app);

}  // namespace greatx::apps
