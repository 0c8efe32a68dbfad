// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include "apps/place/scene_build.h"
#include "core/error.h"

namespace greatx::apps {

void add_scene_build(CLI::App& scene_command) {
  CLI::App* command = scene_command.add_subcommand("build", "a real place from maps (not in this program)");
  command->allow_extras();
  command->callback([] {
    throw_user_error(
        "scene build: this program was built without GDAL, PROJ, GEOS or libosmium. Install libgdal-dev "
        "libproj-dev "
        "libgeos-dev libosmium2-dev libexpat1-dev libbz2-dev (Debian's names), then build greatx again");
  });
}

}  // namespace greatx::apps
