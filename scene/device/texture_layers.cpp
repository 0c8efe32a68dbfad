// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/device/texture_layers.h"

#include <algorithm>
#include <bit>
#include <compare>
#include <cstring>
#include <map>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "shaders/shared/scene.h"

namespace greatx::scene {

namespace {

struct Kind {
  bool srgb, repeat_u, repeat_v;
  uint32_t width, height;
  auto operator<=>(const Kind&) const = default;
  uint64_t bytes() const { return uint64_t{4} * width * height; }
};

Kind kind_of(const Texture& t) { return {t.srgb, t.repeat_u, t.repeat_v, t.width, t.height}; }

using Layer = TextureLayers::Layer;
using LayerKey = std::pair<int32_t, int32_t>;

bool same_metallic_everywhere(const Texture& metallic_roughness) {
  for (size_t i = 2; i < metallic_roughness.rgba.size(); i += 4)
    if (metallic_roughness.rgba[i] != metallic_roughness.rgba[2]) return false;
  return true;
}

/// Returns whether a material's roughness may be stored in the alpha of its base colour.
bool roughness_fits_alpha(const PbrMaterial& pbr, std::span<const Texture> textures) {
  if (pbr.base_color_texture < 0 || pbr.metallic_roughness_texture < 0 || pbr.alpha_mode != AlphaMode::opaque)
    return false;
  const Texture& color = textures[static_cast<size_t>(pbr.base_color_texture)];
  const Texture& rough = textures[static_cast<size_t>(pbr.metallic_roughness_texture)];
  const bool alike = color.width == rough.width && color.height == rough.height &&
                     color.repeat_u == rough.repeat_u && color.repeat_v == rough.repeat_v && !rough.srgb;
  return alike && (pbr.metallic == 0.0f || same_metallic_everywhere(rough));
}

/// Returns whether copies of `small` side by side fill `large`, and have the mips of `small` side by side as
/// their mips. This requires that both sides halve exactly down to one texel.
bool tiles_into(const Kind& small, const Kind& large) {
  const auto fits = [](uint32_t a, uint32_t b) {
    return std::has_single_bit(a) && b % a == 0 && std::has_single_bit(b / a) &&
           static_cast<uint32_t>(std::countr_zero(b / a)) <= shared::texture_most_log_tiles;
  };
  return small.srgb == large.srgb && small.repeat_u && small.repeat_v && large.repeat_u && large.repeat_v &&
         fits(small.width, large.width) && fits(small.height, large.height);
}

/// Returns the kind into which the layers of each kind are made: the largest kind that the bytes allow, or
/// the kind itself if none is larger. Moves that cost least go first.
std::map<Kind, Kind> sizes_of(const std::map<Kind, uint64_t>& counts, uint64_t bytes_left) {
  std::map<Kind, Kind> result;
  for (const auto& [kind, count] : counts) result.emplace(kind, kind);
  struct Move {
    uint64_t bytes;
    Kind from, to;
  };
  std::vector<Move> moves;
  for (const auto& [small, count] : counts)
    for (const auto& [large, unused] : counts)
      if (!(small == large) && tiles_into(small, large))
        moves.push_back({count * large.bytes(), small, large});
  std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
    return std::tuple(b.to.bytes(), a.bytes, a.from, a.to) < std::tuple(a.to.bytes(), b.bytes, b.from, b.to);
  });
  for (const Move& move : moves) {
    // A kind moves once, into a kind that stays. Otherwise the kinds that had moved into it would have to
    // follow.
    const bool free = result.at(move.from) == move.from && result.at(move.to) == move.to &&
                      std::none_of(result.begin(), result.end(), [&](const auto& entry) {
                        return !(entry.first == move.from) && entry.second == move.from;
                      });
    if (!free || move.bytes > bytes_left) continue;
    result.at(move.from) = move.to;
    bytes_left -= move.bytes;
  }
  return result;
}

uint32_t log_ratio(uint32_t large, uint32_t small) {
  return static_cast<uint32_t>(std::countr_zero(large / small));
}

/// Collects layers and assigns each its reference.
class Planner {
 public:
  Planner(std::span<const Texture> textures, const TextureLayerLimits& limits)
      : textures_(textures), limits_(limits) {}

  void want(int32_t texture, int32_t roughness = -1) {
    if (texture >= 0) wanted_.emplace(LayerKey{texture, roughness}, -1);
  }

  void place(TextureLayers& result) {
    std::map<Kind, uint64_t> counts;
    for (const auto& [key, reference] : wanted_) ++counts[kind_of(texture(key))];
    const std::map<Kind, Kind> sizes = sizes_of(counts, limits_.tiled_bytes);
    std::map<Kind, std::vector<LayerKey>> members;
    for (const auto& [key, reference] : wanted_) members[sizes.at(kind_of(texture(key)))].push_back(key);
    for (const auto& [kind, keys] : members) {
      for (size_t i = 0; i < keys.size(); ++i) {
        if (i % limits_.layers == 0)
          result.arrays.push_back({kind.srgb, kind.repeat_u, kind.repeat_v, kind.width, kind.height, {}});
        TextureLayers::Array& array = result.arrays.back();
        const Texture& t = texture(keys[i]);
        wanted_.at(keys[i]) = static_cast<TextureReference>(
            (result.arrays.size() - 1) << shared::texture_array_shift |
            log_ratio(kind.height, t.height) << shared::texture_tiles_v_shift |
            log_ratio(kind.width, t.width) << shared::texture_tiles_u_shift | array.layers.size());
        array.layers.push_back({keys[i].first, keys[i].second});
      }
    }
    GREATX_CHECK(result.arrays.size() <= shared::texture_most_arrays, "{} sizes of textures",
                 result.arrays.size());
  }

  TextureReference reference(int32_t texture, int32_t roughness = -1) const {
    return texture < 0 ? -1 : wanted_.at({texture, roughness});
  }

 private:
  const Texture& texture(const LayerKey& key) const { return textures_[static_cast<size_t>(key.first)]; }

  std::span<const Texture> textures_;
  TextureLayerLimits limits_;
  std::map<LayerKey, TextureReference> wanted_;
};

}  // namespace

TextureLayers plan_texture_layers(std::span<const Texture> textures, std::span<const Material> materials,
                                  const TextureLayerLimits& limits) {
  TextureLayers result;
  if (textures.empty()) {  // none is wanted
    result.materials.resize(materials.size());
    return result;
  }
  Planner planner(textures, limits);
  std::vector<int32_t> in_alpha;  // for each material, the texture whose roughness goes into the alpha
  for (const Material& material : materials) {
    const PbrMaterial& pbr = material.pbr;
    in_alpha.push_back(roughness_fits_alpha(pbr, textures) ? pbr.metallic_roughness_texture : -1);
    planner.want(pbr.base_color_texture, in_alpha.back());
    if (in_alpha.back() < 0) planner.want(pbr.metallic_roughness_texture);
    planner.want(pbr.normal_texture);
    planner.want(pbr.emissive_texture);
  }
  planner.place(result);
  for (size_t i = 0; i < materials.size(); ++i) {
    const PbrMaterial& pbr = materials[i].pbr;
    MaterialTextures& all = result.materials.emplace_back();
    all.base_color = planner.reference(pbr.base_color_texture, in_alpha[i]);
    all.normal = planner.reference(pbr.normal_texture);
    all.emissive = planner.reference(pbr.emissive_texture);
    all.roughness_in_alpha = in_alpha[i] >= 0;
    if (all.roughness_in_alpha)
      all.metallic = static_cast<float>(textures[static_cast<size_t>(in_alpha[i])].rgba[2]) / 255.0f;
    else
      all.metallic_roughness = planner.reference(pbr.metallic_roughness_texture);
  }
  return result;
}

std::vector<uint8_t> texels_of(const TextureLayers::Array& array, const Layer& layer,
                               std::span<const Texture> textures) {
  const Texture& color = textures[static_cast<size_t>(layer.texture)];
  std::vector<uint8_t> once = color.rgba;
  if (layer.roughness >= 0) {
    const Texture& rough = textures[static_cast<size_t>(layer.roughness)];
    for (size_t i = 0; i < once.size(); i += 4) once[i + 3] = rough.rgba[i + 1];
  }
  if (color.width == array.width && color.height == array.height) return once;
  std::vector<uint8_t> tiled(size_t{4} * array.width * array.height);
  const size_t row = size_t{4} * color.width;
  for (uint32_t y = 0; y < array.height; ++y)
    for (uint32_t x = 0; x < array.width; x += color.width)
      std::memcpy(&tiled[size_t{4} * (size_t{y} * array.width + x)], &once[row * (y % color.height)], row);
  return tiled;
}

}  // namespace greatx::scene
