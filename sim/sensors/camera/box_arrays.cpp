// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/camera/box_arrays.h"

namespace greatx::sim {

namespace {

struct Row {
  const Boxes::Object& object;
  const ObjectBox& box;
  int32_t node;
};

/// Describes one array; `write` fills the values of a row.
struct Column {
  const char* name;
  DType dtype;
  int64_t width;  ///< values per row; 0: a scalar
  const char* unit;
  const char* description;
  void (*write)(const Row& row, std::byte* to);
};

template <typename T>
void put(std::byte* to, std::initializer_list<T> values) {
  std::copy_n(reinterpret_cast<const std::byte*>(values.begin()), sizeof(T) * values.size(), to);
}
void put_vector(std::byte* to, const dvec3& v) { put<double>(to, {v.x, v.y, v.z}); }
void put_quaternion(std::byte* to, const dquat& q) { put<double>(to, {q.w, q.x, q.y, q.z}); }
void put_rectangle(std::byte* to, const dvec4& r) {
  put<float>(to, {float(r.x), float(r.y), float(r.z), float(r.w)});
}

const Column columns[] = {
    {"instance", DType::u32, 0, "1", "[object] index into instances + 1; of several, the first",
     [](const Row& r, std::byte* to) { put<uint32_t>(to, {r.object.first_instance + 1}); }},
    {"instance_count", DType::u32, 0, "1", "[object] instances that it consists of, one after the other",
     [](const Row& r, std::byte* to) { put<uint32_t>(to, {r.object.instance_count}); }},
    {"semantic", DType::u8, 0, "1", "[object] index into semantic_classes",
     [](const Row& r, std::byte* to) { put<uint8_t>(to, {uint8_t(r.object.semantic_class)}); }},
    {"node", DType::i32, 0, "1",
     "[object] the node it moves with, index into the poses' nodes; -1: never moves",
     [](const Row& r, std::byte* to) { put<int32_t>(to, {r.node}); }},
    {"center", DType::f64, 3, "m", "[object, xyz] of the box, world",
     [](const Row& r, std::byte* to) { put_vector(to, r.box.world_from_box.position); }},
    {"size", DType::f32, 3, "m", "[object, lwh] along the box's x, y, z",
     [](const Row& r, std::byte* to) {
       put<float>(to, {float(r.object.size.x), float(r.object.size.y), float(r.object.size.z)});
     }},
    {"orientation", DType::f64, 4, "1", "[object, wxyz] world_from_box",
     [](const Row& r, std::byte* to) { put_quaternion(to, r.box.world_from_box.orientation); }},
    {"sensor_center", DType::f64, 3, "m", "[object, xyz] in the sensor's frame: x forward, y left, z up",
     [](const Row& r, std::byte* to) { put_vector(to, r.box.sensor_from_box.position); }},
    {"sensor_orientation", DType::f64, 4, "1", "[object, wxyz] sensor_from_box",
     [](const Row& r, std::byte* to) { put_quaternion(to, r.box.sensor_from_box.orientation); }},
    {"amodal", DType::f32, 4, "pixel",
     "[object, u_min v_min u_max v_max] within the picture, hidden parts too",
     [](const Row& r, std::byte* to) { put_rectangle(to, r.box.amodal); }},
    {"unclipped", DType::f32, 4, "pixel", "[object, u_min v_min u_max v_max] also outside of the picture",
     [](const Row& r, std::byte* to) { put_rectangle(to, r.box.unclipped); }},
    {"modal", DType::i32, 4, "pixel", "[object, u_min v_min u_max v_max] of the visible pixels; zeros: none",
     [](const Row& r, std::byte* to) {
       const auto& m = r.box.modal;
       put<int32_t>(to, {m[0], m[1], m[2], m[3]});
     }},
    {"visible_pixels", DType::u32, 0, "1", "[object] pixels whose centres see it",
     [](const Row& r, std::byte* to) { put<uint32_t>(to, {r.box.visible}); }},
    {"alone_pixels", DType::u32, 0, "1", "[object] pixels whose centres would see it if it were alone",
     [](const Row& r, std::byte* to) { put<uint32_t>(to, {r.box.alone}); }},
    {"visibility", DType::f32, 0, "1", "[object] visible_pixels / alone_pixels",
     [](const Row& r, std::byte* to) { put<float>(to, {float(r.box.visibility())}); }},
    {"truncation", DType::f32, 0, "1", "[object] share of the unclipped box's area outside of the picture",
     [](const Row& r, std::byte* to) { put<float>(to, {float(r.box.truncation())}); }},
    {"crosses_near", DType::u8, 0, "1", "[object] 1: a part is nearer than near_m, and in no rectangle",
     [](const Row& r, std::byte* to) { put<uint8_t>(to, {uint8_t(r.box.crosses_near)}); }},
};

std::vector<int64_t> shape_of(const Column& column, int64_t rows) {
  return column.width == 0 ? std::vector<int64_t>{rows} : std::vector<int64_t>{rows, column.width};
}

}  // namespace

void describe_boxes(SensorSpec& spec) {
  for (const Column& column : columns) {
    const std::string name = std::string("box_") + column.name;
    spec.arrays.push_back({name, column.dtype, shape_of(column, -1), column.unit, column.description});
    spec.outputs.push_back({std::string("boxes/") + column.name, FileFormat::npy_ragged, {name}});
  }
}

std::vector<Array> box_arrays(const Boxes& boxes, std::span<const ObjectBox> found,
                              std::span<const int32_t> node_of_body) {
  std::vector<Array> arrays;
  for (const Column& column : columns) {
    Array array(column.dtype, shape_of(column, static_cast<int64_t>(found.size())));
    const size_t row_bytes = size_of(column.dtype) * static_cast<size_t>(std::max<int64_t>(column.width, 1));
    for (size_t i = 0; i < found.size(); ++i) {
      const Boxes::Object& object = boxes.objects()[found[i].object];
      column.write({object, found[i], node_of_body[object.body]}, array.bytes.data() + i * row_bytes);
    }
    arrays.push_back(std::move(array));
  }
  return arrays;
}

}  // namespace greatx::sim
