// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace greatx::apps {

/// Adds `greatx scene build`. A program without GDAL, PROJ, GEOS and libosmium says which packages it needs.
void add_scene_build(CLI::App& scene_command);

}  // namespace greatx::apps
