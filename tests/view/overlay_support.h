// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Sensors and records that tests of overlays make by hand, as docs/dataset.md has them.
#pragma once

#include <complex>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/record.h"
#include "core/vec.h"
#include "view/overlay/record_tables.h"
#include "view/overlay/shapes.h"

namespace greatx::view::testing {

/// A sensor and one record of it, which grow together.
struct Made {
  SensorSpec spec;
  Record record;

  template <typename T>
  Made& add(const std::string& name, std::vector<int64_t> shape, const std::vector<T>& values) {
    spec.arrays.push_back({name, DTypeOf<T>::value, shape, "1", ""});
    if (!spec.arrays.back().shape.empty()) spec.arrays.back().shape[0] = -1;
    record.arrays.push_back(Array::of<T>(std::move(shape), std::span<const T>(values)));
    return *this;
  }
  Array& array(const std::string& name) {
    for (size_t i = 0; i < spec.arrays.size(); ++i)
      if (spec.arrays[i].name == name) return record.arrays[i];
    throw std::runtime_error("no array " + name);
  }
  /// Takes an array out of both.
  Made& without(const std::string& name) {
    for (size_t i = 0; i < spec.arrays.size(); ++i)
      if (spec.arrays[i].name == name) {
        spec.arrays.erase(spec.arrays.begin() + static_cast<std::ptrdiff_t>(i));
        record.arrays.erase(record.arrays.begin() + static_cast<std::ptrdiff_t>(i));
        return *this;
      }
    throw std::runtime_error("no array " + name);
  }
};

struct MadeNode {
  std::string name;
  Pose pose;
  dvec3 velocity{0.0}, angular_velocity{0.0};
};

inline Made made_poses(const std::vector<MadeNode>& nodes, int64_t tick = 0, int64_t time_ns = 0) {
  Made made;
  made.spec.name = "poses";
  made.spec.kind = "pose";
  made.record.tick = tick;
  made.record.time_ns = time_ns;
  nlohmann::json metadata;
  metadata["nodes"] = nlohmann::json::array();
  std::vector<double> position, orientation, velocity, acceleration, angular_velocity;
  for (const MadeNode& node : nodes) {
    metadata["nodes"].push_back(node.name);
    const dquat& q = node.pose.orientation;
    for (const double value : {q.w, q.x, q.y, q.z}) orientation.push_back(value);
    for (int axis = 0; axis < 3; ++axis) {
      position.push_back(node.pose.position[axis]);
      velocity.push_back(node.velocity[axis]);
      acceleration.push_back(0.0);
      angular_velocity.push_back(node.angular_velocity[axis]);
    }
  }
  made.spec.metadata_json = metadata.dump();
  const auto count = static_cast<int64_t>(nodes.size());
  made.add<double>("position", {count, 3}, position)
      .add<double>("orientation", {count, 4}, orientation)
      .add<double>("velocity", {count, 3}, velocity)
      .add<double>("acceleration", {count, 3}, acceleration)
      .add<double>("angular_velocity", {count, 3}, angular_velocity);
  return made;
}

inline nlohmann::json json_of(const Pose& pose) {
  const dquat& q = pose.orientation;
  return {{"position_m", {pose.position.x, pose.position.y, pose.position.z}},
          {"orientation_wxyz", {q.w, q.x, q.y, q.z}}};
}

inline std::string legend_of(const Shapes& shapes) {
  std::string text;
  for (const auto& [line, color] : shapes.legend) text += line + "\n";
  return text;
}

inline bool same(io::Color a, io::Color b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

/// Expects a UserError that names all of these.
template <typename Call>
void expect_user_error(Call call, std::initializer_list<const char*> parts) {
  try {
    call();
    ADD_FAILURE() << "no error";
  } catch (const UserError& error) {
    for (const char* part : parts) EXPECT_THAT(error.what(), ::testing::HasSubstr(part));
  }
}

}  // namespace greatx::view::testing
