// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/wall_glow.h"

#include <algorithm>
#include <cmath>

#include "renderer/light/sky.h"
#include "renderer/surface/texel.h"
#include "scene/description/lamps.h"
#include "shaders/shared/camera.h"
#include "shaders/shared/surroundings.h"

namespace greatx::render {

namespace {

/// The most columns and rows of a grid over a texture: 0.4 m of a façade of eight bays and two floors.
constexpr uint32_t most_columns = 64, most_rows = 16;
/// The most texels of one axis that a mean over a part of a texture reads.
constexpr uint32_t most_texels = 4;
/// The height of the pieces of a strip whose emission is read once, m.
constexpr double piece_m = 0.5;

uint32_t place_in(double at, uint32_t count, bool repeats) {
  const double share = repeats ? at - std::floor(at) : std::clamp(at, 0.0, 1.0);
  return std::min(static_cast<uint32_t>(share * count), count - 1);
}

/// Returns the mean of a texture, in linear light, over part (i, j) of a grid.
dvec3 mean_over_part(const scene::Texture& texture, uint32_t i, uint32_t j, uint32_t columns, uint32_t rows) {
  const auto texel = [](uint32_t part, uint32_t parts, uint32_t k, uint32_t steps, uint32_t size) {
    return std::min(static_cast<uint32_t>((part + (k + 0.5) / steps) / parts * size), size - 1);
  };
  const uint32_t across = std::clamp(texture.width / columns, 1u, most_texels),
                 down = std::clamp(texture.height / rows, 1u, most_texels);
  dvec3 sum(0.0);
  for (uint32_t l = 0; l < down; ++l)
    for (uint32_t k = 0; k < across; ++k)
      sum += linear_texel(texture, texel(i, columns, k, across, texture.width),
                          texel(j, rows, l, down, texture.height));
  return sum / double(across * down);
}

}  // namespace

const dvec3& WallGlows::Picture::at(const dvec2& uv) const {
  return radiance[size_t{place_in(uv.y, rows, repeat_v)} * columns + place_in(uv.x, columns, repeat_u)];
}

WallGlows::Picture WallGlows::make_picture(const scene::Scene& scene, const scene::PbrMaterial& pbr) {
  const dvec3 factor = dvec3(pbr.emissive) * double(shared::emissive_nits);
  Picture picture;
  if (pbr.emissive_texture < 0) {
    picture.radiance = {factor};
    return picture;
  }
  const scene::Texture& texture = scene.textures[static_cast<size_t>(pbr.emissive_texture)];
  picture.columns = std::min(texture.width, most_columns);
  picture.rows = std::min(texture.height, most_rows);
  picture.repeat_u = texture.repeat_u;
  picture.repeat_v = texture.repeat_v;
  for (uint32_t j = 0; j < picture.rows; ++j)
    for (uint32_t i = 0; i < picture.columns; ++i)
      picture.radiance.push_back(factor * mean_over_part(texture, i, j, picture.columns, picture.rows));
  return picture;
}

WallGlows::WallGlows(const scene::Scene& scene, size_t cells, double cell_m)
    : scene_(&scene), cell_m_(cell_m), glass_(scene), pictures_(scene.materials.size()) {
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const scene::Material& material = scene.materials[i];
    if (material.pbr.emissive == vec3(0.0f) || scene::lamp_role(material)) continue;
    pictures_[i] = make_picture(scene, material.pbr);
    any_ = true;
  }
  if (any_) sums_.resize(cells);
}

void WallGlows::add(size_t cell, double bottom, const SteepStrip& strip, const dvec2& normal,
                    uint32_t first_index, uint32_t material) {
  const uint32_t* corner = &scene_->indices[first_index];
  const auto place = [&](const dvec3& weights) {
    dvec2 uv(0.0);
    for (int k = 0; k < 3; ++k) uv += weights[k] * dvec2(scene_->uvs[corner[k]]);
    return uv;
  };
  const dvec2 low = place(strip.low_weights), high = place(strip.high_weights);
  const int pieces = 1 + static_cast<int>((strip.high - strip.low) / piece_m);
  const double area = (strip.high - strip.low) / pieces * strip.width;
  Sum& sum = sums_[cell];
  for (int k = 0; k < pieces; ++k) {
    const double up = (k + 0.5) / pieces, height = glm::mix(strip.low, strip.high, up);
    const dvec3 emitted = pictures_[material]->at(glm::mix(low, high, up)) * area;
    (height < bottom + double(shared::surroundings_glow_split) ? sum.low : sum.high) += emitted;
    sum.normal += normal * luminance(emitted);
  }
}

WallGlow WallGlows::of(size_t cell, double bottom, double top) const {
  WallGlow glow;
  if (sums_.empty()) return glow;
  const Sum& sum = sums_[cell];
  const double emitted = luminance(sum.low + sum.high);
  if (emitted <= 0.0) return glow;
  // Of what glows on two sides, one sees one.
  const double seen = 0.5 + 0.5 * std::min(glm::length(sum.normal) / emitted, 1.0);
  const double split = std::min(bottom + double(shared::surroundings_glow_split), top);
  if (split > bottom) glow.low = sum.low * (seen / (cell_m_ * (split - bottom)));
  if (top > split) glow.high = sum.high * (seen / (cell_m_ * (top - split)));
  return glow;
}

}  // namespace greatx::render
