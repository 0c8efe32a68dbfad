// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/overlays.h"

#include <chrono>
#include <optional>

#include "core/error.h"

namespace greatx::view {

Overlays::Overlays(std::shared_ptr<const io::DatasetInfo> info)
    : info_(std::move(info)), tables_(info_->run_json, info_->sensors, io::dataset_file) {}

std::vector<size_t> Overlays::sensors_of(std::string_view kind) const {
  std::vector<size_t> found;
  for (size_t i = 0; i < info_->sensors.size(); ++i)
    if (info_->sensors[i].kind == kind) found.push_back(i);
  return found;
}

const Record* Overlays::newest(const ShownTick& tick, size_t sensor) const {
  return sensor < tick.newest.size() ? tick.newest[sensor].get() : nullptr;
}

const Shapes& Overlays::shapes(const std::shared_ptr<const ShownTick>& tick) {
  if (tick == made_of_ && settings_.version == made_version_) return shapes_;
  const auto begin = std::chrono::steady_clock::now();
  shapes_ = {};
  error_.clear();
  try {
    if (tick != nullptr) make(*tick);
  } catch (const UserError& error) {
    error_ = error.what();
  }
  ++made_;
  made_of_ = tick;
  made_version_ = settings_.version;
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return shapes_;
}

void Overlays::make(const ShownTick& tick) {
  std::optional<NodePoses> poses;
  for (const size_t sensor : sensors_of("pose")) {
    const std::shared_ptr<const Record> record = sensor < tick.newest.size() ? tick.newest[sensor] : nullptr;
    if (record == nullptr) continue;
    history_.add(tick.sequence, record);
    poses.emplace(tables_, *record);
  }
  const NodePoses* const known = poses ? &*poses : nullptr;
  add_sensors(tick, known);
  if (settings_.boxes) shapes_.append(box_shapes(tables_, nullptr, nullptr, known, settings_.box));
  if (settings_.sensors) shapes_.append(sensor_shapes(tables_, known, settings_.sensor));
  if (settings_.trajectories && known != nullptr)
    shapes_.append(trajectory_shapes(tables_, history_, tick.packet.time_ns, settings_.trajectory));
}

void Overlays::add_sensors(const ShownTick& tick, const NodePoses* poses) {
  size_t channel = 0;
  for (size_t i = 0; i < info_->sensors.size(); ++i) {
    const SensorSpec& spec = info_->sensors[i];
    const bool chosen = spec.kind == "csi" && channel++ == settings_.channel;
    const Record* const record = newest(tick, i);
    if (record == nullptr) continue;
    if (settings_.lidar && spec.kind == "lidar")
      shapes_.append(lidar_shapes(tables_, spec, *record, poses, settings_.cloud));
    if (settings_.radar && spec.kind == "radar")
      shapes_.append(radar_shapes(tables_, spec, *record, poses, settings_.detections));
    if (settings_.paths && chosen) shapes_.append(path_shapes(tables_, spec, *record, poses, settings_.path));
  }
}

}  // namespace greatx::view
