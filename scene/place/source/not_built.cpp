// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Stands for the readers in a program that was built without GDAL, PROJ and libosmium.
#include "core/error.h"
#include "scene/place/source/source.h"

namespace greatx::scene::place {

bool places_built_in() { return false; }

PlaceInput read_place(const PlaceConfig& config, const Progress&) {
  throw_user_error(
      "{}: this greatx was built without the readers of maps: install libgdal-dev libproj-dev libgeos-dev "
      "libosmium2-dev libexpat1-dev libbz2-dev zlib1g-dev (scripts/setup.sh does so on Debian and Ubuntu), "
      "then configure and build again (GREATX_PLACES=ON)",
      config.file.string());
}

}  // namespace greatx::scene::place
