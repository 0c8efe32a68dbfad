// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/build/build_materials.h"

#include <functional>
#include <string_view>
#include <tuple>

#include "core/error.h"

namespace greatx::scene {
namespace {

/// Returns whether the textures are equal. Their names do not matter.
bool equal(const Texture& left, const Texture& right) {
  const auto key = [](const Texture& texture) {
    return std::tie(texture.width, texture.height, texture.srgb, texture.repeat_u, texture.repeat_v,
                    texture.rgba);
  };
  return key(left) == key(right);
}

bool equal(const Material& left, const Material& right) { return left == right; }

size_t key_of(const Texture& texture) {
  return std::hash<std::string_view>()(
      {reinterpret_cast<const char*>(texture.rgba.data()), texture.rgba.size()});
}

size_t key_of(const Material& material) { return std::hash<std::string>()(material.name); }

/// Returns the index of the element equal to `element`, which is added if there is none. `known` maps
/// key_of() to indices.
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
