// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the boxes of a camera's objects, in three dimensions and in its picture, and the visible share of
// each. It runs on the host in fp64. docs/truth.md has the definitions.
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
#include "sim/sensors/camera/wide_coverage.h"

namespace greatx::sim {

/// Describes an object in one picture. Rectangles are u_min, v_min, u_max, v_max in pixel coordinates (pixel
/// i reaches from i to i + 1).
struct ObjectBox {
  uint32_t object = 0;  ///< index into Boxes::objects()
  Pose world_from_box;  ///< the origin of a box is its centre
  Pose sensor_from_box;
  /// Bounds of the part beyond the near plane, also outside the picture.
  dvec4 unclipped{0.0};
  dvec4 amodal{0.0};               ///< the part of `unclipped` within the picture
  std::array<int32_t, 4> modal{};  ///< bounds of the visible pixels; zeros if there are none
  /// A part is nearer than the near plane; the rectangles leave it out.
  bool crosses_near = false;
  uint32_t visible = 0;  ///< pixels that show it
  uint32_t alone = 0;    ///< pixels that would show it if it were alone
  double visibility() const { return alone == 0 ? 0.0 : double(visible) / alone; }
  /// Returns the share of the area of `unclipped` that lies outside the picture.
  double truncation() const;
};

/// Finds the boxes of the objects that a camera sees.
class Boxes {
 public:
  /// Describes an object that gets a box: a moving body with all its instances and parts, or an instance of
  /// the static world. The box of a body with turning parts contains the parts in every position, so its size
  /// is constant. Rectangles and pixels are those of the current positions.
  struct Object {
    uint32_t first_instance = 0, instance_count = 1;
    scene::SemanticClass semantic_class = scene::SemanticClass::unlabeled;
    uint32_t body = 0;
    Pose body_from_box;
    dvec3 size{0.0};  ///< along the box's x, y, z
    // Geometry as it is drawn.
    std::vector<dvec3> vertices;    ///< in the frame of the body of their piece
    std::vector<uint32_t> indices;  ///< into vertices, three a triangle
    struct Piece {
      uint32_t body = 0, first_vertex = 0;
    };
    /// The vertices of a piece, up to the first one of the next piece, belong to its body. The object's own
    /// body comes first.
    std::vector<Piece> pieces;
  };

  /// Collects the objects of `classes` (names). If none is given, it takes every class but ground, road,
  /// pavement, lane_marking, building, roof, window, water and unlabeled. `scene` outlives this.
  Boxes(const scene::Scene& scene, const render::CameraDesc& camera, std::span<const std::string> classes);
  Boxes(const Boxes&) = delete;
  Boxes& operator=(const Boxes&) = delete;

  const std::vector<Object>& objects() const { return objects_; }
  /// Returns the objects that are visible, or would cover the centre of a pixel if they were alone, in the
  /// order of their instances. `bodies` holds local poses by body. `instances` is [height, width], instance
  /// index + 1; 0: nothing.
  std::vector<ObjectBox> find(const Pose& local_from_sensor, std::span<const Pose> bodies,
                              std::span<const uint32_t> instances);

 private:
  struct Seen {
    uint32_t pixels = 0;
    std::array<uint32_t, 4> bounds{~0u, ~0u, 0u, 0u};  ///< columns and rows; the end is exclusive
  };
  /// Returns the class of most triangles, the lowest of equals. `parts` holds primitives by instance.
  scene::SemanticClass class_of(std::span<const std::vector<uint32_t>> parts) const;
  void add_geometry(Object& object, std::span<const std::vector<uint32_t>> parts) const;
  void count_seen(std::span<const uint32_t> instances);
  bool outside(const Object& object, const Pose& optical_from_body) const;
  /// Sets optical_ to the current vertices of an object.
  void place(const Object& object, const Pose& local_from_sensor, std::span<const Pose> bodies);
  void project(const Object& object, ObjectBox& box);

  const scene::Scene& scene_;
  Projection projection_;
  std::optional<WideProjection> wide_;  ///< behind a fisheye or an equirectangular lens
  std::vector<Object> objects_;
  std::vector<uint32_t> object_of_id_;  ///< [instance + 1] object + 1; 0: none
  // Data of the current picture.
  std::vector<Seen> seen_;      ///< [objects]
  std::vector<dvec3> optical_;  ///< vertices of the current object in the optical frame
  Coverage coverage_;
};

/// Computes the upright box of least volume around points: the rectangle of least area over their horizontal
/// hull (H. Freeman and R. Shapira, "Determining the minimum-area encasing rectangle", CACM 18(7), 1975). The
/// x axis is along its longer side, and the yaw is within (-90, 90] degrees. Sets `size` and returns the pose
/// of the box.
Pose upright_box(std::span<const dvec3> points, dvec3& size);

}  // namespace greatx::sim
