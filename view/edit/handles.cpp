// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/edit/handles.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/text.h"
#include "core/units.h"

namespace greatx::view {

namespace {

using Value = std::shared_ptr<const FieldValue>;

YamlPath below(YamlPath path, YamlStep step) {
  path.push_back(std::move(step));
  return path;
}

std::string text_of(const FieldValue& map, const std::string& key) {
  const auto member = std::ranges::find(map.members, key, &FieldValue::Member::key);
  return member == map.members.end() ? "" : member->value->text;
}

std::optional<dvec3> vector_of(const Value& value) {
  if (value == nullptr || value->items.size() != 3) return {};
  dvec3 vector(0.0);
  for (int i = 0; i < 3; ++i) {
    const std::optional<double> number = parse_number(value->items[static_cast<size_t>(i)]->text);
    if (!number) return {};
    vector[i] = *number;
  }
  return vector;
}

/// Metres to a tenth of a millimetre, degrees to a thousandth: finer than anybody drags.
std::string list_of(const dvec3& vector, int digits) {
  std::string text;
  for (int i = 0; i < 3; ++i) {
    std::string number = fmt::format("{:.{}f}", vector[i], digits);
    number.erase(number.find_last_not_of('0') + 1);
    if (number.ends_with('.')) number.pop_back();
    text += (i == 0 ? "" : ", ") + (number == "-0" ? std::string("0") : number);
  }
  return "[" + text + "]";
}

/// Gathers the handles of one scenario.
class Gatherer {
 public:
  explicit Gatherer(const Value& root) : root_(root) {}

  void point(const std::string& node, const std::string& label, const YamlPath& path,
             const std::optional<dvec3>& otherwise = {}) {
    const Value value = value_at(root_, path);
    const std::optional<dvec3> position = value == nullptr ? otherwise : vector_of(value);
    if (position) handles.push_back({label, node, path, *position, {}, dvec3(0.0)});
  }
  /// A map with position_m and rotation_deg.
  void pose(const std::string& node, const std::string& label, const YamlPath& map, bool always_turns,
            const std::optional<dvec3>& otherwise = {}) {
    const size_t before = handles.size();
    point(node, label, below(map, "position_m"), otherwise);
    const Value rotation = value_at(root_, below(map, "rotation_deg"));
    if (handles.size() == before || (rotation == nullptr && !always_turns)) return;
    if (rotation != nullptr && !vector_of(rotation)) return;
    handles.back().rotation_path = below(map, "rotation_deg");
    if (rotation != nullptr) handles.back().rotation_deg = *vector_of(rotation);
  }
  void points(const std::string& node, const std::string& what, const YamlPath& list) {
    const Value value = value_at(root_, list);
    for (size_t i = 0; value != nullptr && i < value->items.size(); ++i)
      point(node, fmt::format("{}, {} {}", node, what, i), below(list, i));
  }
  void trajectory(const std::string& node, const YamlPath& path) {
    const Value value = value_at(root_, path);
    if (value == nullptr) return;
    if (text_of(*value, "type") == "static") pose(node, node, path, true);
    const Value way_points = value_at(value, {YamlStep("points")});
    for (size_t i = 0; way_points != nullptr && i < way_points->items.size(); ++i)
      pose(node, fmt::format("{}, way-point {} at {} s", node, i, text_of(*way_points->items[i], "t_s")),
           below(below(path, "points"), i), false);
    points(node, "control point", below(path, "control_points_m"));
    points(node, "corner", below(path, "center_line_m"));
    point(node, node + ", lower corner of its box", below(below(path, "box"), "min_m"));
    point(node, node + ", upper corner of its box", below(below(path, "box"), "max_m"));
  }

  std::vector<Handle> handles;

 private:
  const Value& root_;
};

}  // namespace

std::vector<Handle> handles_of(const Value& scenario) {
  Gatherer gatherer(scenario);
  if (const Value nodes = value_at(scenario, {YamlStep("nodes")}))
    for (size_t i = 0; i < nodes->items.size(); ++i)
      gatherer.trajectory(text_of(*nodes->items[i], "name"), {YamlStep("nodes"), i, YamlStep("trajectory")});
  const YamlPath place{YamlStep("scene"), YamlStep("objects")};
  if (const Value objects = value_at(scenario, place))
    for (size_t i = 0; i < objects->items.size(); ++i) {
      const std::string name = text_of(*objects->items[i], "name");
      // A place in latitude and longitude has no handle, as an axis of the scene is none of its numbers.
      if (value_at(objects->items[i], {YamlStep("position_deg")}) == nullptr)
        gatherer.pose(name, name, below(place, i), true, dvec3(0.0));
    }
  return std::move(gatherer.handles);
}

YamlChange move_handle(const Handle& handle, const dvec3& position) {
  return {YamlChange::Kind::set, handle.path, list_of(position, 4)};
}
YamlChange turn_handle(const Handle& handle, const dvec3& rotation_deg) {
  return {YamlChange::Kind::set, handle.rotation_path, list_of(rotation_deg, 3)};
}

std::optional<YamlChange> insert_behind(const Value& scenario, const YamlPath& path) {
  const auto at = std::ranges::find_if(path, [](const YamlStep& s) { return s == YamlStep("points"); });
  if (at == path.end() || at + 1 == path.end() || !std::holds_alternative<size_t>(at[1])) return {};
  const YamlPath list(path.begin(), at + 1);
  const size_t index = std::get<size_t>(at[1]);
  const auto read = [&](size_t i) -> std::optional<std::pair<double, dvec3>> {
    const Value item = value_at(scenario, below(list, i));
    if (item == nullptr) return {};
    const std::optional<double> time = parse_number(text_of(*item, "t_s"));
    const std::optional<dvec3> position = vector_of(value_at(item, {YamlStep("position_m")}));
    return time && position ? std::optional(std::pair(*time, *position)) : std::nullopt;
  };
  const auto here = read(index);
  if (!here) return {};
  double time = here->first + 1.0;
  dvec3 position = here->second;
  if (const auto next = read(index + 1)) {
    time = 0.5 * (here->first + next->first);
    position = 0.5 * (here->second + next->second);
  } else if (const auto before = index > 0 ? read(index - 1) : std::nullopt) {
    time = 2.0 * here->first - before->first;
    position = 2.0 * here->second - before->second;
  }
  std::string item = fmt::format("{{t_s: {:.10g}, position_m: {}", time, list_of(position, 4));
  const Value rotation = value_at(scenario, below(below(list, index), "rotation_deg"));
  if (rotation != nullptr) item += ", rotation_deg: " + yaml_line(*rotation);
  return YamlChange{YamlChange::Kind::insert, below(list, index + 1), item + "}"};
}

std::optional<double> along_axis(const CursorRay& ray, const dvec3& point, const dvec3& axis) {
  // The nearest points of two lines: both are at right angles to the way between them.
  const double cosine = glm::dot(ray.direction, axis), across = 1.0 - cosine * cosine;
  if (across < 1e-6) return {};
  const dvec3 way = point - ray.origin;
  return (cosine * glm::dot(way, ray.direction) - glm::dot(way, axis)) / across;
}

std::optional<double> around_axis(const CursorRay& ray, const dvec3& point, const dvec3& axis) {
  const double slope = glm::dot(ray.direction, axis);
  if (std::abs(slope) < 1e-3) return {};
  const double distance = glm::dot(point - ray.origin, axis) / slope;
  if (distance <= 0.0) return {};
  const dvec3 spoke = ray.origin + distance * ray.direction - point;
  const dvec3 other = std::abs(axis.z) < 0.9 ? dvec3(0.0, 0.0, 1.0) : dvec3(1.0, 0.0, 0.0);
  const dvec3 first = glm::normalize(other - glm::dot(other, axis) * axis), second = glm::cross(axis, first);
  return std::atan2(glm::dot(spoke, second), glm::dot(spoke, first));
}

std::vector<dvec3> turn_axes(const dvec3& rotation_deg) {
  const double degree = pi / 180.0;
  const dquat yaw = orientation_from_yaw_pitch_roll(rotation_deg.x * degree, 0.0, 0.0);
  const dquat pitch = orientation_from_yaw_pitch_roll(rotation_deg.x * degree, rotation_deg.y * degree, 0.0);
  return {dvec3(0.0, 0.0, 1.0), yaw * dvec3(0.0, 1.0, 0.0), pitch * dvec3(1.0, 0.0, 0.0)};
}

}  // namespace greatx::view
