// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "core/error.h"

namespace greatx::scene {
namespace {

/// A checked range of elements inside a buffer.
struct Elements {
  const unsigned char* data = nullptr;
  uint64_t count = 0, stride = 0;
};

uint64_t component_size(int component_type, const std::string& what) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      throw_user_error("{}: component type {} is not one of glTF 2.0's", what, component_type);
  }
}

/// Returns `count` elements of `element_size` bytes. Checks that they lie within the view and that the view
/// lies within its buffer.
Elements checked_elements(const GltfFile& file, int view_index, uint64_t offset, uint64_t count,
                          uint64_t element_size, bool may_stride, const std::string& what) {
  const auto& views = file.model.bufferViews;
  if (view_index < 0 || static_cast<size_t>(view_index) >= views.size()) {
    throw_user_error("{}: buffer view {} does not exist (the file has {})", what, view_index, views.size());
  }
  const tinygltf::BufferView& view = views[static_cast<size_t>(view_index)];
  const auto& buffers = file.model.buffers;
  if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= buffers.size()) {
    throw_user_error("{}: buffer {} of buffer view {} does not exist (the file has {})", what, view.buffer,
                     view_index, buffers.size());
  }
  const auto& bytes = buffers[static_cast<size_t>(view.buffer)].data;
  // Unsigned 64-bit sums could wrap around, so the code compares with the remaining length instead.
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) {
    throw_user_error("{}: buffer view {} (offset {}, length {}) exceeds its buffer of {} bytes", what,
                     view_index, view.byteOffset, view.byteLength, bytes.size());
  }
  const uint64_t stride = may_stride && view.byteStride != 0 ? view.byteStride : element_size;
  if (stride < element_size) {
    throw_user_error("{}: buffer view {}: byteStride {} is less than an element's {} bytes", what, view_index,
                     stride, element_size);
  }
  const uint64_t left = offset <= view.byteLength ? view.byteLength - offset : 0;
  const bool fits =
      offset <= view.byteLength && left >= element_size && count - 1 <= (left - element_size) / stride;
  if (count > 0 && !fits) {
    throw_user_error("{}: {} elements of {} bytes (offset {}, stride {}) exceed buffer view {} of {} bytes",
                     what, count, element_size, offset, stride, view_index, view.byteLength);
  }
  return {bytes.data() + view.byteOffset + (count > 0 ? offset : 0), count, stride};
}

const tinygltf::Accessor& checked_accessor(const GltfFile& file, int index, const std::string& what) {
  const auto& accessors = file.model.accessors;
  if (index < 0 || static_cast<size_t>(index) >= accessors.size()) {
    throw_user_error("{}: accessor {} does not exist (the file has {})", what, index, accessors.size());
  }
  return accessors[static_cast<size_t>(index)];
}

template <typename T>
T load(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

float to_float(const unsigned char* bytes, int component_type, bool normalized) {
  // Signed normalized integers are clamped at -1 (glTF 2.0, section 3.11.1).
  const auto unsigned_value = [&](auto value, float scale) {
    return normalized ? static_cast<float>(value) / scale : static_cast<float>(value);
  };
  const auto signed_value = [&](auto value, float scale) {
    return normalized ? std::max(static_cast<float>(value) / scale, -1.0f) : static_cast<float>(value);
  };
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return signed_value(load<int8_t>(bytes), 127.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return unsigned_value(load<uint8_t>(bytes), 255.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return signed_value(load<int16_t>(bytes), 32767.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return unsigned_value(load<uint16_t>(bytes), 65535.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return static_cast<float>(load<uint32_t>(bytes));
    default:
      return load<float>(bytes);
  }
}

uint32_t to_index(const unsigned char* bytes, int component_type, const std::string& what) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<uint16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<uint32_t>(bytes);
    default:
      throw_user_error("{}: component type {}: expected unsigned byte, short or int (5121, 5123, 5125)", what,
                       component_type);
  }
}

/// The sparse part of an accessor: the elements that it replaces, and their values.
struct SparseValues {
  std::vector<uint64_t> targets;
  Elements values;
};

SparseValues checked_sparse(const GltfFile& file, const tinygltf::Accessor& accessor, uint64_t element_size,
                            const std::string& what) {
  const auto& sparse = accessor.sparse;
  if (sparse.count < 1 || static_cast<uint64_t>(sparse.count) > accessor.count ||
      sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
    throw_user_error("{}: sparse count {} (offsets {}, {}): expected 1 to {} and no negative offset", what,
                     sparse.count, sparse.indices.byteOffset, sparse.values.byteOffset, accessor.count);
  }
  const auto count = static_cast<uint64_t>(sparse.count);
  const int index_type = sparse.indices.componentType;
  const Elements indices = checked_elements(
      file, sparse.indices.bufferView, static_cast<uint64_t>(sparse.indices.byteOffset), count,
      component_size(index_type, what + ", sparse indices"), false, what + ", sparse indices");
  SparseValues result;
  result.values =
      checked_elements(file, sparse.values.bufferView, static_cast<uint64_t>(sparse.values.byteOffset), count,
                       element_size, false, what + ", sparse values");
  result.targets.reserve(count);
  for (uint64_t index = 0; index < count; ++index) {
    const uint64_t target =
        to_index(indices.data + index * indices.stride, index_type, what + ", sparse indices");
    if (target >= accessor.count) {
      throw_user_error("{}: sparse index {} is out of range (the accessor has {} elements)", what, target,
                       accessor.count);
    }
    result.targets.push_back(target);
  }
  return result;
}

/// Calls store(element, bytes) for the dense elements, then for the sparse ones.
template <typename Store>
void for_each_element(const GltfFile& file, const tinygltf::Accessor& accessor, uint64_t element_size,
                      const std::string& what, const Store& store) {
  if (accessor.bufferView >= 0) {
    const Elements dense = checked_elements(file, accessor.bufferView, accessor.byteOffset, accessor.count,
                                            element_size, true, what);
    for (uint64_t index = 0; index < dense.count; ++index) store(index, dense.data + index * dense.stride);
  }
  if (!accessor.sparse.isSparse) return;
  const SparseValues sparse = checked_sparse(file, accessor, element_size, what);
  for (size_t index = 0; index < sparse.targets.size(); ++index) {
    store(sparse.targets[index], sparse.values.data + index * sparse.values.stride);
  }
}

/// Checks the range of the dense part, and the memory budget, before memory for `count` elements is
/// allocated. `bytes_each` is the size of an element in memory. An accessor without a buffer view is all
/// zeros, and its count is bounded by nothing in the file.
void check_count(const GltfFile& file, const tinygltf::Accessor& accessor, uint64_t element_size,
                 uint64_t bytes_each, const std::string& what, GeometryMemory& memory) {
  const uint64_t planned = saturating_product({accessor.count, bytes_each});
  if (accessor.bufferView >= 0) {
    checked_elements(file, accessor.bufferView, accessor.byteOffset, accessor.count, element_size, true,
                     what);
  } else {
    memory.zeros.plan(fmt::format("{}: {} elements", what, accessor.count), planned);
  }
  memory.all.plan(fmt::format("{}: {} elements", what, accessor.count), planned);
}

}  // namespace

std::vector<float> read_floats(const GltfFile& file, int accessor_index, int components,
                               const std::string& what, GeometryMemory& memory) {
  const tinygltf::Accessor& accessor = checked_accessor(file, accessor_index, what);
  const std::string label = fmt::format("{}, accessor {}", what, accessor_index);
  if (accessor.type != components) {  // TINYGLTF_TYPE_VEC2 … VEC4 are 2 … 4
    throw_user_error("{}: expected VEC{}", label, components);
  }
  const uint64_t size = component_size(accessor.componentType, label);
  const auto width = static_cast<uint64_t>(components);
  check_count(file, accessor, size * width, width * sizeof(float), label, memory);
  std::vector<float> values(accessor.count * width, 0.0f);
  for_each_element(file, accessor, size * width, label, [&](uint64_t element, const unsigned char* bytes) {
    for (uint64_t index = 0; index < width; ++index) {
      values[element * width + index] =
          to_float(bytes + index * size, accessor.componentType, accessor.normalized);
    }
  });
  return values;
}

std::vector<uint32_t> read_indices(const GltfFile& file, int accessor_index, const std::string& what,
                                   GeometryMemory& memory) {
  const tinygltf::Accessor& accessor = checked_accessor(file, accessor_index, what);
  const std::string label = fmt::format("{}, accessor {}", what, accessor_index);
  if (accessor.type != TINYGLTF_TYPE_SCALAR) throw_user_error("{}: expected SCALAR indices", label);
  const uint64_t size = component_size(accessor.componentType, label);
  check_count(file, accessor, size, sizeof(uint32_t), label, memory);
  std::vector<uint32_t> values(accessor.count, 0);
  for_each_element(file, accessor, size, label, [&](uint64_t element, const unsigned char* bytes) {
    values[element] = to_index(bytes, accessor.componentType, label);
  });
  return values;
}

}  // namespace greatx::scene
