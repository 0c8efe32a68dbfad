// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "renderer/light/sky_view.h"
#include "renderer/light/surroundings.h"

namespace greatx::test {

/// The columns of a scene, with the scene.
struct Columns {
  explicit Columns(scene::Scene of, const render::SurroundingLight& light = {},
                   const render::SurroundingSources& sources = {})
      : scene(std::move(of)),
        field(render::height_field(scene)),
        surroundings(scene, field, light, sources) {}
  Columns(const Columns&) = delete;
  Columns& operator=(const Columns&) = delete;

  /// Returns the column at a place in local coordinates.
  const render::SurroundingCell& at(double x, double y) const {
    const dvec2 cell = (dvec2(x, y) - field.corner) / field.cell_m;
    return surroundings.cell(static_cast<uint32_t>(cell.x), static_cast<uint32_t>(cell.y));
  }

  scene::Scene scene;
  render::HeightField field;
  render::Surroundings surroundings;  ///< of `field`, which stays where it is
};

}  // namespace greatx::test
