// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/gltf_textures.h"

#include "core/error.h"
#include "scene/files/picture.h"

namespace greatx::scene {

bool TextureReader::repeats(int wrap, const std::string& what) {
  switch (wrap) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return true;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return false;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      model_.notes.push_back(what + ": mirrored wrapping is treated as repetition");
      return true;
    default:
      throw_user_error("{}: wrapping {}, expected 10497, 33071 or 33648", what, wrap);
  }
}

int32_t TextureReader::read(int index, bool srgb, const std::string& what) {
  if (index == -1) return -1;
  const auto& textures = file_.model.textures;
  if (index < 0 || static_cast<size_t>(index) >= textures.size()) {
    throw_user_error("{}: texture {} does not exist (the file has {})", what, index, textures.size());
  }
  const tinygltf::Texture& source = textures[static_cast<size_t>(index)];
  const auto& images = file_.model.images;
  if (source.source < 0 || static_cast<size_t>(source.source) >= images.size()) {
    throw_user_error("{}: texture {} has no PNG or JPEG image (source {}, the file has {} images)", what,
                     index, source.source, images.size());
  }
  bool repeat_u = true, repeat_v = true;
  if (source.sampler != -1) {
    const auto& samplers = file_.model.samplers;
    if (source.sampler < 0 || static_cast<size_t>(source.sampler) >= samplers.size()) {
      throw_user_error("{}: sampler {} does not exist (the file has {})", what, source.sampler,
                       samplers.size());
    }
    const tinygltf::Sampler& sampler = samplers[static_cast<size_t>(source.sampler)];
    repeat_u = repeats(sampler.wrapS, what);
    repeat_v = repeats(sampler.wrapT, what);
  }
  const Key key{source.source, srgb, repeat_u, repeat_v};
  if (const auto found = done_.find(key); found != done_.end()) return found->second;

  try {
    return done_[key] = decode(key, what);
  } catch (const UserError& error) {
    if (!file_.keep_faults) throw;
    const auto lost = file_.lost_images.find(static_cast<size_t>(source.source));
    model_.lost_pictures.push_back(
        lost == file_.lost_images.end() ? error.what() : fmt::format("{}: {}", what, lost->second));
    return done_[key] = -1;
  }
}

int32_t TextureReader::decode(const Key& key, const std::string& what) {
  const auto [source, srgb, repeat_u, repeat_v] = key;
  const tinygltf::Image& image = file_.model.images[static_cast<size_t>(source)];
  DecodedPicture picture = decode_picture(image.image, what, memory_);
  Texture texture;
  texture.name = image.name;
  texture.width = picture.width;
  texture.height = picture.height;
  texture.rgba = std::move(picture.rgba);
  if (texture.name.empty()) texture.name = fmt::format("image {}", source);
  texture.srgb = srgb;
  texture.repeat_u = repeat_u;
  texture.repeat_v = repeat_v;
  model_.textures.push_back(std::move(texture));
  return static_cast<int32_t>(model_.textures.size() - 1);
}

}  // namespace greatx::scene
