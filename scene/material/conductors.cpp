// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material/conductors.h"

#include "core/error.h"

namespace greatx::scene {
namespace {

struct Conductor {
  const char* name;
  double conductivity;  ///< S/m
};

constexpr Conductor conductors[] = {
    {"silver", 6.173e7}, {"copper", 5.813e7}, {"gold", 4.098e7},  {"aluminium", 3.816e7},
    {"brass", 2.564e7},  {"zinc", 1.67e7},    {"bronze", 1.00e7}, {"stainless_steel", 1.1e6},
};

}  // namespace

std::optional<RadioMedium> conductor_medium(const std::string& name) {
  for (const Conductor& conductor : conductors)
    if (name == conductor.name)
      return RadioMedium{
          fmt::format("conductor {} (Pozar, Microwave Engineering, 4th ed., Appendix F)", name),
          {{1.0, 0.0, conductor.conductivity, 0.0, 1e6, 1e12}},
          false};
  return std::nullopt;
}

std::vector<std::string> conductor_names() {
  std::vector<std::string> names;
  for (const Conductor& conductor : conductors) names.emplace_back(conductor.name);
  return names;
}

}  // namespace greatx::scene
