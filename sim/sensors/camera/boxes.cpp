// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/camera/boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/convex_hull.h"
#include "core/units.h"

namespace greatx::sim {

namespace {

using scene::SemanticClass;

bool boxed_by_default(SemanticClass semantic_class) {
  switch (semantic_class) {
    case SemanticClass::unlabeled:
    case SemanticClass::ground:
    case SemanticClass::road:
    case SemanticClass::pavement:
    case SemanticClass::lane_marking:
    case SemanticClass::building:
    case SemanticClass::roof:
    case SemanticClass::window:
    case SemanticClass::water:
      return false;
    default:
      return true;
  }
}

/// Returns the rotation between the sensor frame (x forward, y left, z up) and the optical frame (x right, y
/// down, z forward).
Pose optical_from_sensor() {
  return {dvec3(0.0), glm::quat_cast(glm::dmat3(dvec3(0, 0, 1), dvec3(-1, 0, 0), dvec3(0, -1, 0)))};
}

/// Returns sensor_from_body. The position is computed from the difference to the sensor, so that large
/// coordinates cancel.
Pose from_sensor(const Pose& local_from_sensor, uint32_t body, std::span<const Pose> bodies) {
  const Pose local_from_body = body == 0 ? Pose{} : bodies[body],
             sensor_from_local = local_from_sensor.inverse();
  return {sensor_from_local.rotate(local_from_body.position - local_from_sensor.position),
          glm::normalize(sensor_from_local.orientation * local_from_body.orientation)};
}

double area(const dvec4& rectangle) {
  return std::max(0.0, rectangle.z - rectangle.x) * std::max(0.0, rectangle.w - rectangle.y);
}

}  // namespace

double ObjectBox::truncation() const {
  const double whole = area(unclipped);
  return whole > 0.0 ? std::clamp(1.0 - area(amodal) / whole, 0.0, 1.0) : 0.0;
}

Pose upright_box(std::span<const dvec3> points, dvec3& size) {
  GREATX_CHECK(!points.empty(), "a box around nothing");
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::vector<dvec2> flat;
  for (const dvec3& point : points) {
    flat.emplace_back(point.x, point.y);
    low = std::min(low, point.z);
    high = std::max(high, point.z);
  }
  const std::vector<dvec2> hull = convex_hull(std::move(flat));
  struct Rectangle {
    double yaw = 0.0;
    dvec2 least{0.0}, most{0.0};
    double area() const { return (most.x - least.x) * (most.y - least.y); }
  };
  const auto around = [&](double yaw) {
    Rectangle rectangle{yaw, dvec2(std::numeric_limits<double>::infinity()),
                        dvec2(-std::numeric_limits<double>::infinity())};
    const dvec2 x(std::cos(yaw), std::sin(yaw)), y(-x.y, x.x);
    for (const dvec2& point : hull) {
      const dvec2 turned(glm::dot(point, x), glm::dot(point, y));
      rectangle.least = glm::min(rectangle.least, turned);
      rectangle.most = glm::max(rectangle.most, turned);
    }
    return rectangle;
  };
  Rectangle best = around(0.0);
  for (size_t i = 0; i < hull.size(); ++i) {
    const dvec2 edge = hull[(i + 1) % hull.size()] - hull[i];
    const Rectangle candidate = around(std::atan2(edge.y, edge.x));
    // The tolerance makes the choice independent of rounding: the first of equals.
    if (candidate.area() < best.area() * (1.0 - 1e-9)) best = candidate;
  }
  const dvec2 sides = best.most - best.least;
  const bool square = std::abs(sides.x - sides.y) <= 1e-6 * (sides.x + sides.y);
  // The x axis is along the longer side, within half a turn; for a square within a quarter turn.
  double yaw = best.yaw + (!square && sides.y > sides.x ? 0.5 * pi : 0.0);
  const double period = square ? 0.5 * pi : pi;
  yaw -= period * std::ceil(yaw / period - 0.5);
  const Rectangle final = around(yaw);
  const dvec2 middle = 0.5 * (final.least + final.most), x(std::cos(yaw), std::sin(yaw));
  size = {final.most - final.least, high - low};
  return {{middle.x * x.x - middle.y * x.y, middle.x * x.y + middle.y * x.x, 0.5 * (low + high)},
          orientation_from_yaw_pitch_roll(yaw, 0.0, 0.0)};
}

Boxes::Boxes(const scene::Scene& scene, const render::CameraDesc& camera,
             std::span<const std::string> classes)
    : scene_(scene),
      projection_(camera),
      object_of_id_(scene.instances.size() + 1, 0),
      coverage_(projection_) {
  if (camera.wide.any()) wide_.emplace(camera);
  const auto wanted = [&](const Object& object) {
    if (camera.excluded_body && object.body == *camera.excluded_body) return false;
    if (classes.empty()) return boxed_by_default(object.semantic_class);
    return std::ranges::find(classes, std::string(name_of(object.semantic_class))) != classes.end();
  };
  const auto instances = static_cast<uint32_t>(scene.instances.size());
  std::vector<std::vector<uint32_t>> primitives(instances);
  for (uint32_t i = 0; i < scene.primitives.size(); ++i)
    if (scene.primitives[i].index_count > 0) primitives[scene.primitives[i].instance].push_back(i);
  for (uint32_t first = 0, end = 0; first < instances; first = end) {
    Object object;
    object.first_instance = first;
    object.body = scene.owner_of(scene.instances[first].body);
    for (end = first + 1;
         object.body != 0 && end < instances && scene.owner_of(scene.instances[end].body) == object.body;)
      ++end;
    object.instance_count = end - first;
    const std::span parts(primitives.begin() + first, end - first);
    object.semantic_class = class_of(parts);
    if (!wanted(object)) continue;
    add_geometry(object, parts);
    if (object.indices.empty()) continue;
    objects_.push_back(std::move(object));
    for (uint32_t i = first; i < end; ++i) object_of_id_[i + 1] = static_cast<uint32_t>(objects_.size());
  }
  seen_.resize(objects_.size());
}

SemanticClass Boxes::class_of(std::span<const std::vector<uint32_t>> parts) const {
  std::map<SemanticClass, uint32_t> indices;
  for (const std::vector<uint32_t>& part : parts)
    for (const uint32_t i : part)
      indices[scene_.instances[scene_.primitives[i].instance].semantic_class] +=
          scene_.primitives[i].index_count;
  SemanticClass best = SemanticClass::unlabeled;
  uint32_t most = 0;
  for (const auto& [semantic_class, count] : indices)
    if (count > most) {
      most = count;
      best = semantic_class;
    }
  return best;
}

void Boxes::add_geometry(Object& object, std::span<const std::vector<uint32_t>> parts) const {
  std::map<uint32_t, uint32_t> vertex_of;  // by the vertex index of the scene
  for (const std::vector<uint32_t>& part : parts)
    for (const uint32_t p : part) {
      const uint32_t body = scene_.instances[scene_.primitives[p].instance].body;
      if (object.pieces.empty() || object.pieces.back().body != body)
        object.pieces.push_back({body, static_cast<uint32_t>(object.vertices.size())});
      for (uint32_t i = 0; i < scene_.primitives[p].index_count; ++i) {
        const uint32_t vertex = scene_.indices[scene_.primitives[p].first_index + i];
        const auto [entry, is_new] =
            vertex_of.try_emplace(vertex, static_cast<uint32_t>(object.vertices.size()));
        if (is_new) object.vertices.emplace_back(scene_.positions[vertex]);
        object.indices.push_back(entry->second);
      }
    }
  if (object.vertices.empty()) return;
  if (object.body == 0) {
    object.body_from_box = upright_box(object.vertices, object.size);
    return;
  }
  scene::Bounds bounds;
  if (object.pieces.size() == 1 && object.pieces[0].body == object.body)
    for (const dvec3& vertex : object.vertices) bounds.add(vertex);
  else
    bounds = scene_.reach_of(object.body);
  object.body_from_box.position = bounds.center();
  object.size = bounds.size();
}

void Boxes::count_seen(std::span<const uint32_t> instances) {
  const uint32_t width = projection_.width(), height = projection_.height();
  GREATX_CHECK(instances.size() == size_t{width} * height, "{} ids for {} x {} pixels", instances.size(),
               width, height);
  std::ranges::fill(seen_, Seen{});
  for (uint32_t row = 0; row < height; ++row) {
    const uint32_t* const ids = instances.data() + size_t{row} * width;
    // Adjacent pixels mostly show the same instance, so runs are counted.
    for (uint32_t first = 0, end = 0; first < width; first = end) {
      const uint32_t id = ids[first];
      for (end = first + 1; end < width && ids[end] == id;) ++end;
      if (object_of_id_[id] == 0) continue;
      Seen& seen = seen_[object_of_id_[id] - 1];
      seen.pixels += end - first;
      seen.bounds = {std::min(seen.bounds[0], first), std::min(seen.bounds[1], row),
                     std::max(seen.bounds[2], end), std::max(seen.bounds[3], row + 1)};
    }
  }
}

bool Boxes::outside(const Object& object, const Pose& optical_from_body) const {
  if (wide_) return false;  // it sees nearly everything
  // The test in homogeneous coordinates also holds for corners behind the camera.
  uint32_t beyond_all = 31;
  const dvec2 least = projection_.least(), most = projection_.most();
  const Pose optical_from_box = optical_from_body * object.body_from_box;
  for (int corner = 0; corner < 8 && beyond_all != 0; ++corner) {
    const dvec3 half = 0.5 * object.size;
    const dvec3 p = optical_from_box.apply(
        {corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z});
    const dvec2 uv_times_z =
        projection_.pinhole({p.x, p.y, 1.0}) + projection_.pinhole(dvec3(0, 0, 1)) * (p.z - 1.0);
    const uint32_t beyond =
        uint32_t{p.z < projection_.near_m()} | uint32_t{uv_times_z.x < least.x * p.z} << 1 |
        uint32_t{uv_times_z.x > most.x * p.z} << 2 | uint32_t{uv_times_z.y < least.y * p.z} << 3 |
        uint32_t{uv_times_z.y > most.y * p.z} << 4;
    beyond_all &= beyond;
  }
  return beyond_all != 0;
}

void Boxes::place(const Object& object, const Pose& local_from_sensor, std::span<const Pose> bodies) {
  optical_.resize(object.vertices.size());
  for (size_t piece = 0; piece < object.pieces.size(); ++piece) {
    const auto [body, first] = object.pieces[piece];
    const size_t end =
        piece + 1 < object.pieces.size() ? object.pieces[piece + 1].first_vertex : object.vertices.size();
    const Pose optical_from_body = optical_from_sensor() * from_sensor(local_from_sensor, body, bodies);
    const glm::dmat3 turn = glm::mat3_cast(optical_from_body.orientation);
    for (size_t i = first; i < end; ++i) optical_[i] = turn * object.vertices[i] + optical_from_body.position;
  }
}

void Boxes::project(const Object& object, ObjectBox& box) {
  const double near = projection_.near_m();
  const double infinity = std::numeric_limits<double>::infinity();
  box.unclipped = {infinity, infinity, -infinity, -infinity};
  if (wide_) {
    WideProjection::Shape shape{box.unclipped};
    for (size_t i = 0; i < object.indices.size(); i += 3)
      wide_->add(
          {optical_[object.indices[i]], optical_[object.indices[i + 1]], optical_[object.indices[i + 2]]},
          shape, coverage_);
    box.unclipped = shape.bounds;
    box.crosses_near = shape.crosses_near;
    return;
  }
  for (size_t i = 0; i < object.indices.size(); i += 3) {
    std::array<dvec2, 4> polygon;
    size_t corners = 0;
    for (size_t c = 0; c < 3; ++c) {
      const dvec3 &a = optical_[object.indices[i + c]], &b = optical_[object.indices[i + (c + 1) % 3]];
      if (a.z >= near) polygon[corners++] = projection_.pinhole(a);
      if ((a.z >= near) != (b.z >= near)) {
        dvec3 cut = a + (b - a) * ((near - a.z) / (b.z - a.z));
        cut.z = near;
        polygon[corners++] = projection_.pinhole(cut);
        box.crosses_near = true;
      } else if (a.z < near) {
        box.crosses_near = true;
      }
    }
    if (corners == 0) continue;
    const std::span<const dvec2> part(polygon.data(), corners);
    const dvec4 bounds = projection_.bounds(part);
    box.unclipped = {std::min(box.unclipped.x, bounds.x), std::min(box.unclipped.y, bounds.y),
                     std::max(box.unclipped.z, bounds.z), std::max(box.unclipped.w, bounds.w)};
    coverage_.add(part, bounds);
  }
}

std::vector<ObjectBox> Boxes::find(const Pose& local_from_sensor, std::span<const Pose> bodies,
                                   std::span<const uint32_t> instances) {
  count_seen(instances);
  std::vector<ObjectBox> found;
  for (uint32_t i = 0; i < objects_.size(); ++i) {
    const Object& object = objects_[i];
    const Seen& seen = seen_[i];
    const Pose local_from_body = object.body == 0 ? Pose{} : bodies[object.body];
    const Pose sensor_from_body = from_sensor(local_from_sensor, object.body, bodies);
    const Pose optical_from_body = optical_from_sensor() * sensor_from_body;
    if (seen.pixels == 0 && outside(object, optical_from_body)) continue;
    ObjectBox box;
    box.object = i;
    coverage_.clear();
    place(object, local_from_sensor, bodies);
    project(object, box);
    if (seen.pixels > 0) {
      box.visible = seen.pixels;
      for (size_t side = 0; side < 4; ++side) box.modal[side] = static_cast<int32_t>(seen.bounds[side]);
      // Pixels that show the object count as covered, also where rasterisation on the GPU rounds to the other
      // side of an edge.
      for (uint32_t row = seen.bounds[1]; row < seen.bounds[3]; ++row)
        for (uint32_t column = seen.bounds[0]; column < seen.bounds[2]; ++column)
          if (object_of_id_[instances[size_t{row} * projection_.width() + column]] == i + 1)
            coverage_.add(column, row);
    }
    box.alone = coverage_.count();
    if (box.alone == 0) continue;
    // The object is visible, but by rounding no part lies beyond the near plane.
    if (box.unclipped.x > box.unclipped.z)
      box.unclipped = dvec4(box.modal[0], box.modal[1], box.modal[2], box.modal[3]);
    const double width = projection_.width(), height = projection_.height();
    box.amodal = {std::clamp(box.unclipped.x, 0.0, width), std::clamp(box.unclipped.y, 0.0, height),
                  std::clamp(box.unclipped.z, 0.0, width), std::clamp(box.unclipped.w, 0.0, height)};
    const Pose local_from_box = local_from_body * object.body_from_box;
    box.world_from_box = {local_from_box.position + scene_.origin, local_from_box.orientation};
    box.sensor_from_box = sensor_from_body * object.body_from_box;
    found.push_back(box);
  }
  return found;
}

}  // namespace greatx::sim
