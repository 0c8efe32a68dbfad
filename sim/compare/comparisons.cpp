// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/compare/comparisons.h"

#include <algorithm>

#include "sim/compare/consistency.h"
#include "sim/compare/record_reading.h"

namespace greatx::sim {

namespace {

void keep_sights(const TickEvidence& tick, const KeepErrors& keep) {
  for (const Witness& witness : tick.witnesses)
    if (const ErrorStatistics* const errors = witness.evidence.delays_against_distances)
      keep(witness, tick.poses, *errors);
}

void keep_rays(const TickEvidence& tick, const KeepErrors& keep) {
  for (const Witness& witness : tick.witnesses)
    if (const ErrorStatistics* const errors = witness.evidence.pixels_against_rays)
      keep(witness, nullptr, *errors);
}

/// Compares each LiDAR only with depth pictures of its own node, because both then have bitwise the same
/// pose.
void keep_lidar(const TickEvidence& tick, const KeepErrors& keep) {
  for (const Witness& lidar : tick.witnesses) {
    const std::optional<ReturnEvidence>& returns = lidar.evidence.returns;
    if (!returns) continue;
    for (const Witness& camera : tick.witnesses) {
      const std::optional<DepthEvidence>& depth = camera.evidence.depth;
      if (!depth || depth->node != returns->node) continue;
      keep(lidar, &camera,
           lidar_against_depth(*depth->camera, *depth->images, depth->mount.inverse() * returns->mount,
                               returns->xyzi, returns->instances, returns->materials, returns->error_m,
                               returns->noise, returns->power));
    }
  }
}

void keep_radar(const TickEvidence& tick, const KeepErrors& keep) {
  for (const Witness& witness : tick.witnesses)
    if (witness.evidence.detections && tick.poses != nullptr)
      keep(witness, tick.poses, compare_radar(witness.record, tick.poses->record, tick.boxes));
}

void keep_sensing(const TickEvidence& tick, const KeepErrors& keep) {
  for (const Witness& witness : tick.witnesses)
    if (witness.evidence.sensed && tick.poses != nullptr)
      keep(witness, tick.poses, compare_sensing(witness.record, tick.poses->record, tick.boxes));
}

void keep_depth_boxes(const TickEvidence& tick, const KeepErrors& keep) {
  for (const Witness& camera : tick.witnesses)
    if (camera.evidence.depth && tick.poses != nullptr && has(camera.record.spec, "depth") &&
        has(camera.record.spec, "instance"))
      keep(camera, tick.poses, compare_depth_boxes(camera.record, tick.poses->record, tick.boxes));
}

void keep_lidar_boxes(const TickEvidence& tick, const KeepErrors& keep) {
  for (const Witness& lidar : tick.witnesses)
    if (lidar.evidence.returns && tick.poses != nullptr && has(lidar.record.spec, "points") &&
        has(lidar.record.spec, "instance"))
      keep(lidar, tick.poses, compare_lidar_boxes(lidar.record, tick.poses->record, tick.boxes));
}

/// Returns what recomputing needs. A camera with boxes compares instances in a run even if it does not write
/// them. The figure can then be recomputed only if they are written.
Comparison::Needs lidar_needs(const SensorSpec& camera) {
  Comparison::Needs needs{{"points", "instance", "material", "power"}, {"depth"}};
  if (std::ranges::any_of(camera.arrays, [](const ArraySpec& s) { return s.name.starts_with("box_"); }))
    needs.of_other.emplace_back("instance");
  return needs;
}

constexpr Comparison table[] = {
    {sight_figure, true, keep_sights,
     [](const SensorSpec&) -> Comparison::Needs {
       return {{"delay", "interaction", "rx", "tx"}, {}};
     },
     [](const RecordView& channel, const RecordView& poses, std::span<const InstanceBox>) {
       return compare_sights(channel, poses);
     }},
    {.figure = depth_figure, .always = false, .compare = keep_rays, .obstacle = "the rays are not written"},
    {lidar_figure, false, keep_lidar, lidar_needs,
     [](const RecordView& lidar, const RecordView& camera, std::span<const InstanceBox>) {
       return compare_lidar(lidar, camera);
     }},
    {depth_box_figure, false, keep_depth_boxes,
     [](const SensorSpec&) -> Comparison::Needs {
       return {{"depth", "instance"}, {}, true};
     },
     compare_depth_boxes},
    {lidar_box_figure, false, keep_lidar_boxes,
     [](const SensorSpec&) -> Comparison::Needs {
       return {{"points", "instance", "power"}, {}, true};
     },
     compare_lidar_boxes},
    {radar_figure, false, keep_radar,
     [](const SensorSpec&) -> Comparison::Needs {
       return {{"range", "power", "instance"}, {}, true};
     },
     compare_radar},
    {sensing_figure, false, keep_sensing,
     [](const SensorSpec&) -> Comparison::Needs {
       return {{"detection_range", "detection_power", "detection_instance", "detection_rx", "detection_tx"},
               {},
               true};
     },
     compare_sensing},
};

}  // namespace

std::span<const Comparison> comparisons() { return table; }

const Comparison* comparison_called(std::string_view figure) {
  const auto* const found = std::ranges::find(table, figure, &Comparison::figure);
  return found == std::end(table) ? nullptr : found;
}

Comparer::Comparer(const World& world, bool all) : world_(world), all_(all) {
  for (const Comparison& comparison : table) totals_[comparison.figure];
}

void Comparer::compare(uint32_t sequence, int64_t tick, std::span<const Witness> witnesses) {
  TickEvidence evidence{witnesses};
  bool boxed = false;  // something is compared with the boxes of instances
  for (const Witness& witness : witnesses) {
    if (witness.evidence.poses) evidence.poses = &witness;
    boxed |= witness.evidence.detections || witness.evidence.sensed || witness.evidence.depth ||
             witness.evidence.returns;
  }
  if (all_ && boxed && evidence.poses != nullptr && boxes_.empty()) boxes_ = instance_boxes(world_);
  evidence.boxes = boxes_;
  for (const Comparison& comparison : table) {
    if (!all_ && !comparison.always) continue;
    ErrorStatistics& total = totals_[comparison.figure];
    comparison.compare(evidence,
                       [&](const Witness& witness, const Witness* other, const ErrorStatistics& errors) {
                         if (errors.count() == 0) return;
                         total.add(errors);
                         if (comparison.recompute == nullptr || other == nullptr) return;
                         rows_.push_back({comparison.figure, sequence, tick, witness.record.spec.name,
                                          other->record.spec.name, errors.count(), errors.max()});
                       });
  }
}

}  // namespace greatx::sim
