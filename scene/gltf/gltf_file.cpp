// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/gltf_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <new>
#include <string_view>

#include <climits>

#include "core/error.h"
#include "scene/gltf/gltf_schema.h"

namespace greatx::scene {
namespace {

using nlohmann::json;
using Bytes = std::vector<unsigned char>;

constexpr uint32_t glb_magic = 0x46546C67, chunk_json = 0x4E4F534A, chunk_bin = 0x004E4942;
constexpr int max_json_depth = 128;
constexpr std::string_view external_token = "greatx-external-";

/// Holds the parts of a file: its JSON text and, for a .glb, the binary chunk.
struct Container {
  std::string_view text;
  std::span<const unsigned char> binary;
};

uint32_t read_u32(std::span<const unsigned char> bytes, size_t offset) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

std::string_view text_of(std::span<const unsigned char> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Splits a .glb: a header of 12 bytes, then chunks of length, type, data (glTF 2.0, section 4.4).
Container split_glb(const std::string& name, std::span<const unsigned char> bytes) {
  if (bytes.size() < 20)
    throw_user_error("{}: truncated .glb: {} bytes, expected 20 at least", name, bytes.size());
  const uint32_t version = read_u32(bytes, 4), length = read_u32(bytes, 8);
  if (version != 2) throw_user_error("{}: .glb version {}, expected 2", name, version);
  if (length > bytes.size()) {
    throw_user_error("{}: truncated .glb: its header says {} bytes, the file has {}", name, length,
                     bytes.size());
  }
  Container container;
  bool has_json = false;
  for (uint64_t offset = 12; offset < length;) {
    if (offset + 8 > length) throw_user_error("{}: truncated .glb: chunk header at byte {}", name, offset);
    const uint64_t size = read_u32(bytes, offset);
    const uint32_t type = read_u32(bytes, offset + 4);
    if (offset + 8 + size > length) {
      throw_user_error("{}: truncated .glb: the chunk at byte {} says {} bytes, {} are left", name, offset,
                       size, length - offset - 8);
    }
    const auto data = bytes.subspan(offset + 8, size);
    if (!has_json && type != chunk_json) throw_user_error("{}: .glb whose first chunk is not JSON", name);
    if (!has_json) {
      container.text = text_of(data);
      has_json = true;
    } else if (type == chunk_bin && container.binary.empty()) {
      container.binary = data;
    }
    offset += 8 + size;
  }
  if (!has_json) throw_user_error("{}: .glb without a JSON chunk", name);
  return container;
}

/// Limits the nesting, since deep nesting would overflow the stack of tinygltf's recursive reader.
void check_depth(const std::string& name, std::string_view text) {
  int depth = 0;
  bool in_string = false;
  for (size_t index = 0; index < text.size(); ++index) {
    const char character = text[index];
    if (in_string) {
      if (character == '\\') ++index;
      if (character == '"') in_string = false;
    } else if (character == '"') {
      in_string = true;
    } else if (character == '{' || character == '[') {
      if (++depth > max_json_depth)
        throw_user_error("{}: JSON is nested deeper than {}", name, max_json_depth);
    } else if (character == '}' || character == ']') {
      --depth;
    }
  }
}

json parse_json(const std::string& name, std::string_view text) {
  require_within(name, text.size(), budget::model_json);
  check_depth(name, text);
  json document;
  try {
    document = json::parse(text);
  } catch (const json::exception& error) {
    throw_user_error("{}: not valid JSON: {}", name, error.what());
  }
  if (!document.is_object()) throw_user_error("{}: the JSON root is not an object", name);
  std::string version;
  if (document.contains("asset") && document["asset"].is_object() && document["asset"].contains("version")) {
    const json& found = document["asset"]["version"];
    version = found.is_string() ? found.get<std::string>() : found.dump();
  }
  if (!version.starts_with("2."))
    throw_user_error("{}: asset.version '{}', expected glTF 2.x", name, version);
  check_gltf_types(name, document);
  return document;
}

void check_required_extensions(const std::string& name, const json& document) {
  static constexpr std::array supported = {"KHR_lights_punctual", "KHR_materials_emissive_strength",
                                           "KHR_materials_transmission", "KHR_mesh_quantization",
                                           "GREATX_radio_material"};
  if (!document.contains("extensionsRequired")) return;
  for (const json& extension : document["extensionsRequired"]) {
    const std::string text = extension;
    if (std::find(supported.begin(), supported.end(), text) == supported.end()) {
      throw_user_error("{}: requires the extension '{}', which is not supported", name, text);
    }
  }
}

bool is_known_data_uri(const std::string& uri) {
  static constexpr std::array prefixes = {"data:application/octet-stream;base64,",
                                          "data:application/gltf-buffer;base64,", "data:image/png;base64,",
                                          "data:image/jpeg;base64,"};
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const char* prefix) { return uri.starts_with(prefix); });
}

/// Reads the file that `uri` names. If `lost` is set, an error goes there with the index, and the bytes are
/// no picture.
Bytes read_external_file(AssetFolder& folder, const std::string& uri, const std::string& what, size_t index,
                         std::map<size_t, std::string>* lost) {
  try {
    Bytes bytes = folder.read(uri, what);
    if (bytes.empty()) throw_user_error("{}: file '{}' is empty", what, uri);
    return bytes;
  } catch (const UserError& error) {
    if (!lost) throw;
    lost->emplace(index, error.what());
    return {0};
  }
}

/// Reads the file of every URI in `list` and puts a token in place of the URI, so that tinygltf never sees a
/// path. Returns whether the document has changed. `lost` gets what cannot be read; null: that is an error.
bool take_externals(const std::string& name, json& document, const char* list, const char* singular,
                    AssetFolder& folder, std::vector<Bytes>& externals, std::map<size_t, std::string>* lost) {
  if (!document.contains(list)) return false;
  bool changed = false;
  for (size_t index = 0; index < document[list].size(); ++index) {
    json& element = document[list][index];
    const std::string what = fmt::format("{}: {} {}", name, singular, index);
    if (!element.contains("uri")) continue;
    const std::string uri = element["uri"];
    if (uri.starts_with("data:")) {
      if (!is_known_data_uri(uri)) {
        throw_user_error("{}: data URI '{}…' is not base64 of a buffer, PNG or JPEG", what,
                         uri.substr(0, 40));
      }
      continue;
    }
    Bytes bytes = read_external_file(folder, uri, what, index, lost);
    if (element.contains("byteLength")) {
      // Files may be padded beyond the length that the buffer declares (glTF 2.0, section 3.6.1).
      const uint64_t length = element["byteLength"];
      if (bytes.size() < length) {
        throw_user_error("{}: byteLength {}, but file '{}' has {} bytes", what, length, uri, bytes.size());
      }
      bytes.resize(length);
      bytes.shrink_to_fit();
    }
    element["uri"] = fmt::format("{}{}", external_token, externals.size());
    externals.push_back(std::move(bytes));
    changed = true;
  }
  return changed;
}

uint64_t unsigned_member(const json& object, const char* key, uint64_t fallback) {
  const auto found = object.find(key);
  if (found == object.end()) return fallback;
  return found->get<uint64_t>();
}

/// Checks the ranges of images in buffers, since tinygltf takes pointers to them without a check.
void check_image_views(const std::string& name, const json& document) {
  if (!document.contains("images")) return;
  const json empty = json::array();
  const json& views = document.contains("bufferViews") ? document["bufferViews"] : empty;
  const json& buffers = document.contains("buffers") ? document["buffers"] : empty;
  for (size_t index = 0; index < document["images"].size(); ++index) {
    const json& image = document["images"][index];
    if (!image.contains("bufferView")) continue;
    const uint64_t view = unsigned_member(image, "bufferView", UINT64_MAX);
    if (view >= views.size()) {
      throw_user_error("{}: image {}: bufferView out of range (the file has {})", name, index, views.size());
    }
    const uint64_t buffer = unsigned_member(views[view], "buffer", UINT64_MAX);
    const uint64_t offset = unsigned_member(views[view], "byteOffset", 0);
    const uint64_t length = unsigned_member(views[view], "byteLength", UINT64_MAX);
    const uint64_t size = buffer < buffers.size() ? unsigned_member(buffers[buffer], "byteLength", 0) : 0;
    if (length == 0 || length > INT_MAX || offset > size || length > size - offset || size == UINT64_MAX) {
      throw_user_error("{}: image {}: buffer view {} (offset {}, length {}) exceeds buffer {} of {} bytes",
                       name, index, view, offset, length, buffer, size);
    }
  }
}

Bytes make_glb(const std::string& text, std::span<const unsigned char> binary) {
  std::string padded = text;
  padded.resize((padded.size() + 3) / 4 * 4, ' ');
  const size_t total = 20 + padded.size() + (binary.empty() ? 0 : 8 + (binary.size() + 3) / 4 * 4);
  Bytes glb;
  glb.reserve(total);
  const auto put = [&](uint64_t value) {
    for (int shift = 0; shift < 32; shift += 8) glb.push_back(static_cast<unsigned char>(value >> shift));
  };
  put(glb_magic), put(2), put(total), put(padded.size()), put(chunk_json);
  glb.insert(glb.end(), padded.begin(), padded.end());
  if (!binary.empty()) {
    put((binary.size() + 3) / 4 * 4), put(chunk_bin);
    glb.insert(glb.end(), binary.begin(), binary.end());
    glb.resize(total);
  }
  return glb;
}

// tinygltf's file functions follow. They open the tokens that take_externals has put into the document, and
// nothing else.
const Bytes* external_of(const std::string& path, void* user) {
  const size_t token = path.find(external_token);
  if (token == std::string::npos) return nullptr;
  const auto& externals = *static_cast<const std::vector<Bytes>*>(user);
  const char* const digits = path.data() + token + external_token.size();
  size_t index = externals.size();
  std::from_chars(digits, path.data() + path.size(), index);
  return index < externals.size() ? &externals[index] : nullptr;
}
bool external_exists(const std::string& path, void* user) { return external_of(path, user) != nullptr; }
std::string keep_path(const std::string& path, void*) { return path; }
bool read_external(Bytes* out, std::string* error, const std::string& path, void* user) {
  const Bytes* bytes = external_of(path, user);
  if (!bytes) {
    *error += "no such file: " + path;
    return false;
  }
  *out = *bytes;
  return true;
}
bool refuse_write(std::string* error, const std::string& path, const Bytes&, void*) {
  *error += "writing is not allowed: " + path;
  return false;
}

/// Keeps the encoded bytes. Only the images that a material uses are decoded later.
bool keep_encoded_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                        const unsigned char* bytes, int size, void*) {
  image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

bool run_tinygltf(GltfFile& file, std::string_view text, std::span<const unsigned char> glb,
                  std::vector<Bytes>& externals, std::string& error) {
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks({external_exists, keep_path, read_external, refuse_write, &externals});
  parser.SetImageLoader(keep_encoded_image, nullptr);
  std::string warning;
  if (glb.empty()) {
    return parser.LoadASCIIFromString(&file.model, &error, &warning, text.data(),
                                      static_cast<unsigned int>(text.size()), "");
  }
  return parser.LoadBinaryFromMemory(&file.model, &error, &warning, glb.data(),
                                     static_cast<unsigned int>(glb.size()), "");
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

}  // namespace

GltfFile parse_gltf(const std::string& name, std::span<const unsigned char> bytes, AssetFolder& folder,
                    bool keep_faults) {
  if (bytes.empty()) throw_user_error("{}: the file is empty", name);
  if (bytes.size() > UINT32_MAX)
    throw_user_error("{}: {} bytes, expected less than 4 GiB", name, bytes.size());
  const bool is_glb = bytes.size() >= 4 && read_u32(bytes, 0) == glb_magic;
  const Container container = is_glb ? split_glb(name, bytes) : Container{text_of(bytes), {}};

  GltfFile file;
  file.name = name;
  file.keep_faults = keep_faults;
  file.json = parse_json(name, container.text);
  check_required_extensions(name, file.json);
  std::vector<Bytes> externals;
  bool rewritten = take_externals(name, file.json, "buffers", "buffer", folder, externals, nullptr);
  rewritten |= take_externals(name, file.json, "images", "image", folder, externals,
                              keep_faults ? &file.lost_images : nullptr);
  check_image_views(name, file.json);

  std::string rewritten_text, error;
  if (rewritten) rewritten_text = file.json.dump();
  Bytes rewritten_glb;
  if (is_glb && rewritten) rewritten_glb = make_glb(rewritten_text, container.binary);
  const std::string_view text = rewritten ? std::string_view(rewritten_text) : container.text;
  const std::span<const unsigned char> glb =
      rewritten ? std::span<const unsigned char>(rewritten_glb) : bytes;
  bool parsed = false;
  try {
    parsed = run_tinygltf(file, text, is_glb ? glb : std::span<const unsigned char>(), externals, error);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& exception) {  // type errors deep inside the JSON
    error = exception.what();
  }
  // tinygltf continues after some of its errors. This loader does not.
  if (!parsed || !error.empty()) throw_user_error("{}: not valid glTF: {}", name, one_line(error));
  return file;
}

}  // namespace greatx::scene
