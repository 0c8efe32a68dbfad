// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Translates the classes of CityJSON into tags of OpenStreetMap.
#pragma once

#include <string>
#include <string_view>

#include "scene/place/source/vocabulary.h"

namespace greatx::scene::place {

struct CityClass {
  enum class Shape { solid, area, point, none } shape = Shape::none;
  std::map<std::string, std::string, std::less<>> tags;
};

/// Returns what a city object of a type is. Attributes refine it: `class`, `function` and `averageHeight` of
/// CityGML 3.0, and the words of the Dutch base map (IMGeo 2.2, bgt_fysiekvoorkomen and others), whose
/// CityJSON files are common.
CityClass city_class(std::string_view type, const Attributes& attributes);

}  // namespace greatx::scene::place
