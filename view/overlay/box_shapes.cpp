// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay/box_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "core/text.h"
#include "view/overlay/record_arrays.h"
#include "view/overlay/shape_parts.h"

namespace greatx::view {

namespace {

/// Hues of classes, far from each other; the class 0 has none.
io::Color class_color(uint32_t semantic) { return semantic == 0 ? dim_color : io::color_of_id(semantic); }

struct ObjectBox {
  Pose world_from_box;
  dvec3 low{0.0}, high{0.0};
  std::string name, semantic_class, more;
  uint32_t semantic = 0;
  uint32_t instance = 0;  ///< id of its first one
  double speed_m_s = 0.0;
  bool moves = false, hidden = false;
};

void add_object(Shapes& shapes, const ObjectBox& box, bool label) {
  const dvec3 size = box.high - box.low, center = box.world_from_box.apply(0.5 * (box.low + box.high));
  const uint32_t row = shapes.add_row(
      fmt::format("{} ({})\n{:.2f} x {:.2f} x {:.2f} m at ({:.2f}, {:.2f}, {:.2f}) m\n{}{}", box.name,
                  box.semantic_class, size.x, size.y, size.z, center.x, center.y, center.z,
                  box.moves ? fmt::format("{:.2f} m/s", box.speed_m_s) : "never moves", box.more),
      row_id("box", box.instance));
  const io::Color color = class_color(box.semantic);
  add_box(shapes, box.world_from_box, box.low, box.high, color, box.hidden ? 0.8f : 1.6f, row);
  if (!label) return;
  const dvec3 top =
      box.world_from_box.apply({0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y), box.high.z});
  shapes.labels.push_back({top, box.name, color});
}

/// The first `most` of the boxes, and a legend of their classes.
void add_objects(Shapes& shapes, const std::vector<ObjectBox>& boxes, const BoxOptions& options,
                 const std::string& what) {
  const size_t shown = std::min(boxes.size(), options.most);
  std::map<uint32_t, std::pair<std::string, size_t>> classes;
  for (size_t i = 0; i < shown; ++i) {
    add_object(shapes, boxes[i], options.labels && boxes[i].moves);
    auto& [name, count] = classes[boxes[i].semantic];
    name = boxes[i].semantic_class;
    ++count;
  }
  shapes.note(shown == boxes.size() ? fmt::format("{}: {} boxes", what, shown)
                                    : fmt::format("{}: the first {} of {} boxes", what, shown, boxes.size()));
  for (const auto& [semantic, entry] : classes)
    shapes.legend.emplace_back(fmt::format("{} ({})", entry.first, entry.second), class_color(semantic));
}

double speed_of(const NodePoses* poses, std::optional<uint32_t> node) {
  return poses != nullptr && node ? glm::length(poses->motion(*node).velocity) : 0.0;
}

}  // namespace

Shapes camera_box_shapes(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                         const NodePoses* poses, const BoxOptions& options) {
  Shapes shapes;
  const RecordArrays arrays(spec, record);
  if (!arrays.has("box_center")) {
    shapes.note(spec.name + ": its boxes are not recorded: add 'boxes' to its outputs");
    return shapes;
  }
  const std::span<const double> center = arrays.finite<double>("box_center", {-1, 3});
  const auto count = static_cast<int64_t>(center.size() / 3);
  const std::span<const double> orientation = arrays.finite<double>("box_orientation", {count, 4});
  const std::span<const float> size = arrays.finite<float>("box_size", {count, 3}),
                               visibility = arrays.finite<float>("box_visibility", {count});
  const std::span<const uint32_t> instance = arrays.get<uint32_t>("box_instance", {count});
  const std::span<const uint8_t> semantic = arrays.get<uint8_t>("box_semantic", {count});
  const std::span<const int32_t> nodes = arrays.get<int32_t>("box_node", {count});
  std::vector<ObjectBox> boxes;
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    const dquat turn(orientation[4 * i], orientation[4 * i + 1], orientation[4 * i + 2],
                     orientation[4 * i + 3]);
    if (!(std::abs(glm::length(turn) - 1.0) < 0.01))
      arrays.fail("box_orientation", "unit quaternions",
                  fmt::format("one of length {:g} in row {}", glm::length(turn), i));
    const dvec3 half = 0.5 * dvec3(size[3 * i], size[3 * i + 1], size[3 * i + 2]);
    if (half.x < 0.0 || half.y < 0.0 || half.z < 0.0)
      arrays.fail("box_size", "extents of 0 or more", fmt::format("a negative one in row {}", i));
    if (nodes[i] < -1 || nodes[i] >= static_cast<int64_t>(tables.nodes().size()))
      arrays.fail("box_node", fmt::format("-1 or one of {} nodes", tables.nodes().size()),
                  fmt::format("{} in row {}", nodes[i], i));
    ObjectBox box{{{center[3 * i], center[3 * i + 1], center[3 * i + 2]}, glm::normalize(turn)}, -half, half};
    box.moves = nodes[i] >= 0;
    box.name = box.moves ? printable(tables.nodes()[static_cast<size_t>(nodes[i])])
                         : tables.instance_name(instance[i]);
    box.semantic = semantic[i];
    box.semantic_class = tables.class_name(semantic[i]);
    box.instance = instance[i];
    if (box.moves) box.speed_m_s = speed_of(poses, static_cast<uint32_t>(nodes[i]));
    box.hidden = visibility[i] <= 0.0f;
    box.more = fmt::format("\n{:.0f} % visible to {}", 100.0 * static_cast<double>(visibility[i]), spec.name);
    boxes.push_back(std::move(box));
  }
  add_objects(shapes, boxes, options, spec.name);
  return shapes;
}

Shapes instance_box_shapes(const RecordTables& tables, const NodePoses* poses, const BoxOptions& options) {
  Shapes shapes;
  std::map<uint32_t, size_t> of_node;
  std::vector<ObjectBox> boxes;
  std::map<size_t, double> volumes;  ///< of the instance that gives a box its class
  bool known = false;
  for (size_t i = 0; i < tables.instances().size(); ++i) {
    const InstanceFacts& instance = tables.instances()[i];
    if (!instance.has_box) continue;
    known = true;
    if (instance.node && poses == nullptr) continue;
    if (!instance.node && options.hidden_classes.contains(instance.semantic_class)) continue;
    const dvec3 size = instance.high - instance.low;
    const double volume = size.x * size.y * size.z;
    ObjectBox box{Pose{}, instance.low, instance.high};
    box.instance = static_cast<uint32_t>(i + 1);
    box.semantic_class = printable(instance.semantic_class);
    box.semantic = tables.class_number(instance.semantic_class);
    box.name = printable(instance.name);
    if (!instance.node) {
      boxes.push_back(std::move(box));
      continue;
    }
    const auto [place, added] = of_node.try_emplace(*instance.node, boxes.size());
    if (added) {
      box.moves = true;
      box.name = printable(tables.nodes()[*instance.node]);
      box.world_from_box = poses->pose(*instance.node);
      box.speed_m_s = speed_of(poses, instance.node);
      volumes[boxes.size()] = volume;
      boxes.push_back(std::move(box));
      continue;
    }
    ObjectBox& whole = boxes[place->second];
    whole.low = glm::min(whole.low, box.low);
    whole.high = glm::max(whole.high, box.high);
    if (volume <= volumes[place->second]) continue;
    volumes[place->second] = volume;
    whole.semantic = box.semantic;
    whole.semantic_class = box.semantic_class;
  }
  if (!known) {
    shapes.note("boxes: the run has none of its instances (box_m)");
    return shapes;
  }
  if (poses == nullptr) shapes.note("boxes: without poses, only of what never moves");
  // What moves first, so that `most` leaves out what rests.
  std::ranges::stable_partition(boxes, [](const ObjectBox& box) { return box.moves; });
  add_objects(shapes, boxes, options, "objects");
  return shapes;
}

Shapes box_shapes(const RecordTables& tables, const SensorSpec* spec, const Record* record,
                  const NodePoses* poses, const BoxOptions& options) {
  if (spec != nullptr && record != nullptr && RecordArrays(*spec, *record).has("box_center"))
    return camera_box_shapes(tables, *spec, *record, poses, options);
  return instance_box_shapes(tables, poses, options);
}

}  // namespace greatx::view
