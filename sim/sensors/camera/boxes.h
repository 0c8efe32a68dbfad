// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Boxes of a camera's objects, in three dimensions and in its picture, and how much of each is seen. Host,
// fp64. docs/truth.md has the definitions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"
#include "sim/sensors/camera/coverage.h"

namespace greatx::sim {

/// An object of one picture. Rectangles are u_min, v_min, u_max, v_max in pixel coordinates (pixel i reaches
/// from i to i + 1).
struct ObjectBox {
  uint32_t object = 0;  ///< index into Boxes::objects()
  Pose world_from_box;  ///< to the box's centre and axes
  Pose sensor_from_box;
  dvec4 unclipped{0.0};            ///< bounds of what lies beyond the near plane, also outside of the picture
  dvec4 amodal{0.0};               ///< the part of `unclipped` within the picture
  std::array<int32_t, 4> modal{};  ///< bounds of the visible pixels; zeros if there are none
  bool crosses_near = false;       ///< a part is nearer than the near plane and in no rectangle
  uint32_t visible = 0;            ///< pixels that show it
  uint32_t alone = 0;              ///< pixels that would show it if it were alone
  double visibility() const { return alone == 0 ? 0.0 : double(visible) / alone; }
  /// Share of the area of `unclipped` that lies outside of the picture.
  double truncation() const;
};

class Boxes {
 public:
  /// What gets a box: a moving body with all its instances and parts, or an instance of the static world. The
  /// box of a body with parts that turn holds them however they are turned, so that its size does not change;
  /// rectangles and pixels are those of the parts as they stand.
  struct Object {
    uint32_t first_instance = 0, instance_count = 1;
    scene::SemanticClass semantic_class = scene::SemanticClass::unlabeled;
    uint32_t body = 0;
    Pose body_from_box;
    dvec3 size{0.0};  ///< along the box's x, y, z
    // Geometry as it is drawn.
    std::vector<dvec3> vertices;    ///< in the frame of their piece's body
    std::vector<uint32_t> indices;  ///< into vertices, three a triangle
    struct Piece {
      uint32_t body = 0, first_vertex = 0;
    };
    std::vector<Piece> pieces;  ///< vertices up to the next one's are of its body; the body's own first
  };

  /// Objects of `classes` (names); none given: of every class but ground, road, pavement, lane_marking,
  /// building, roof, window, water and unlabeled. `scene` outlives this.
  Boxes(const scene::Scene& scene, const render::CameraDesc& camera, std::span<const std::string> classes);
  Boxes(const Boxes&) = delete;
  Boxes& operator=(const Boxes&) = delete;

  const std::vector<Object>& objects() const { return objects_; }
  /// Objects that would cover a pixel's centre if they were alone, or are seen, in order of their instances.
  /// `bodies`: local poses by body. `instances`: [height, width] instance index + 1, 0: nothing.
  std::vector<ObjectBox> find(const Pose& local_from_sensor, std::span<const Pose> bodies,
                              std::span<const uint32_t> instances);

 private:
  struct Seen {
    uint32_t pixels = 0;
    std::array<uint32_t, 4> bounds{~0u, ~0u, 0u, 0u};  ///< columns and rows, end exclusive
  };
  /// `parts`: primitives by instance. The class of most triangles, the lowest of equals.
  scene::SemanticClass class_of(std::span<const std::vector<uint32_t>> parts) const;
  void add_geometry(Object& object, std::span<const std::vector<uint32_t>> parts) const;
  void count_seen(std::span<const uint32_t> instances);
  bool outside(const Object& object, const Pose& optical_from_body) const;
  /// Sets optical_.
  void place(const Object& object, const Pose& local_from_sensor, std::span<const Pose> bodies);
  void project(const Object& object, ObjectBox& box);

  const scene::Scene& scene_;
  Projection projection_;
  std::vector<Object> objects_;
  std::vector<uint32_t> object_of_id_;  ///< by instance + 1: object + 1; 0: none
  // Of the picture at hand.
  std::vector<Seen> seen_;      ///< by object
  std::vector<dvec3> optical_;  ///< the object's vertices as the camera has them
  Coverage coverage_;
};

/// The upright box of least volume around points: least-area rectangle over their horizontal hull (H. Freeman
/// and R. Shapira, "Determining the minimum-area encasing rectangle", CACM 18(7), 1975), x along its longer
/// side, yaw within (-90, 90] degrees. Sets `size`, returns where the box is.
Pose upright_box(std::span<const dvec3> points, dvec3& size);

}  // namespace greatx::sim
