// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/build/build_materials.h"

#include <algorithm>
#include <functional>
#include <string_view>
#include <tuple>

#include "core/error.h"

namespace greatx::scene {
namespace {

bool equal(const Texture& left, const Texture& right) {
  const auto key = [](const Texture& texture) {
    return std::tie(texture.width, texture.height, texture.srgb, texture.repeat_u, texture.repeat_v);
  };
  return key(left) == key(right) && left.rgba == right.rgba;
}

bool equal(const PbrMaterial& left, const PbrMaterial& right) {
  const auto key = [](const PbrMaterial& pbr) {
    return std::tie(pbr.metallic, pbr.roughness, pbr.normal_scale, pbr.alpha_cutoff, pbr.alpha_mode,
                    pbr.double_sided, pbr.transmission, pbr.base_color_texture,
                    pbr.metallic_roughness_texture, pbr.normal_texture, pbr.emissive_texture);
  };
  return key(left) == key(right) && left.base_color == right.base_color && left.emissive == right.emissive;
}

bool equal(const RadioMedium& left, const RadioMedium& right) {
  const auto same_row = [](const RadioRow& one, const RadioRow& two) {
    return std::tie(one.a, one.b, one.c, one.d, one.min_hz, one.max_hz) ==
           std::tie(two.a, two.b, two.c, two.d, two.min_hz, two.max_hz);
  };
  return left.source == right.source && left.extrapolate == right.extrapolate &&
         std::equal(left.rows.begin(), left.rows.end(), right.rows.begin(), right.rows.end(), same_row);
}

bool equal(const RadioMaterial& left, const RadioMaterial& right) {
  const auto key = [](const RadioMaterial& radio) {
    return std::tie(radio.scattering_coefficient, radio.pattern, radio.pattern_exponent,
                    radio.backscatter_exponent, radio.backscatter_share, radio.cross_polarization,
                    radio.roughness_m);
  };
  const auto same_layer = [](const RadioLayer& one, const RadioLayer& two) {
    return one.thickness_m == two.thickness_m && equal(one.medium, two.medium);
  };
  const bool same_foliage =
      left.foliage.has_value() == right.foliage.has_value() &&
      (!left.foliage || left.foliage->attenuation_db_per_m == right.foliage->attenuation_db_per_m);
  return key(left) == key(right) && same_foliage &&
         std::equal(left.layers.begin(), left.layers.end(), right.layers.begin(), right.layers.end(),
                    same_layer);
}

bool equal(const Material& left, const Material& right) {
  const bool same_radio =
      left.radio.has_value() == right.radio.has_value() && (!left.radio || equal(*left.radio, *right.radio));
  return left.name == right.name && equal(left.pbr, right.pbr) && same_radio &&
         left.reflectance_905nm == right.reflectance_905nm &&
         left.reflectance_1550nm == right.reflectance_1550nm;
}

size_t key_of(const Texture& texture) {
  return std::hash<std::string_view>()(
      {reinterpret_cast<const char*>(texture.rgba.data()), texture.rgba.size()});
}

size_t key_of(const Material& material) { return std::hash<std::string>()(material.name); }

/// The index of an element equal to `element`, which is added if there is none. `known`: by key_of().
template <typename T>
uint32_t index_of(std::vector<T>& elements, std::unordered_multimap<size_t, uint32_t>& known,
                  const T& element) {
  const size_t key = key_of(element);
  const auto [first, last] = known.equal_range(key);
  for (auto entry = first; entry != last; ++entry)
    if (equal(elements[entry->second], element)) return entry->second;
  known.emplace(key, static_cast<uint32_t>(elements.size()));
  elements.push_back(element);
  return static_cast<uint32_t>(elements.size() - 1);
}

}  // namespace

const std::vector<uint32_t>& MaterialMerger::indices_of(const Model& model) {
  const auto [entry, is_new] = done_.try_emplace(&model);
  if (!is_new) return entry->second;
  std::vector<int32_t> texture_index;
  for (const Texture& texture : model.textures) {
    const size_t before = scene_.textures.size();
    texture_index.push_back(static_cast<int32_t>(index_of(scene_.textures, textures_, texture)));
    if (scene_.textures.size() > before)
      memory_.plan(fmt::format("{}: with texture '{}'", model.file.string(), texture.name),
                   texture.rgba.size());
  }
  for (Material material : model.materials) {
    for (int32_t* texture : {&material.pbr.base_color_texture, &material.pbr.metallic_roughness_texture,
                             &material.pbr.normal_texture, &material.pbr.emissive_texture}) {
      if (*texture >= 0) *texture = texture_index[static_cast<size_t>(*texture)];
    }
    entry->second.push_back(index_of(scene_.materials, materials_, material));
  }
  return entry->second;
}

}  // namespace greatx::scene
