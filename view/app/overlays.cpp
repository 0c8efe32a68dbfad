// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/overlays.h"

#include <algorithm>
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
  if (settings_.boxes) add_boxes(tick, known);
  add_picture(tick);
  if (settings_.sensors) shapes_.append(sensor_shapes(tables_, known, settings_.sensor));
  if (settings_.trajectories && known != nullptr)
    shapes_.append(trajectory_shapes(tables_, history_, tick.packet.time_ns, settings_.trajectory));
}

/// Through a camera that records boxes, its own: in the world and in its picture.
void Overlays::add_boxes(const ShownTick& tick, const NodePoses* poses) {
  const auto through = std::ranges::find(info_->sensors, settings_.camera, &SensorSpec::name);
  const SensorSpec* const spec =
      through != info_->sensors.end() && through->kind == "camera" ? &*through : nullptr;
  const Record* const record =
      spec != nullptr ? newest(tick, static_cast<size_t>(through - info_->sensors.begin())) : nullptr;
  shapes_.append(box_shapes(tables_, spec, record, poses, settings_.box));
  if (record != nullptr) shapes_.append(picture_box_shapes(tables_, *spec, *record, settings_.rectangle));
}

/// The events of the camera that one looks through, or of an event camera that has the pixels of that camera.
void Overlays::add_picture(const ShownTick& tick) {
  if (!settings_.events || settings_.camera.empty()) return;
  for (size_t i = 0; i < info_->sensors.size(); ++i) {
    const SensorSpec& spec = info_->sensors[i];
    const SensorFacts& facts = tables_.sensors()[i];
    if (spec.kind != "event_camera" || !facts.camera) continue;
    if (spec.name != settings_.camera && facts.camera->shared_with != settings_.camera) continue;
    if (const Record* const record = newest(tick, i))
      shapes_.append(event_shapes(tables_, spec, *record, settings_.event));
    return;
  }
  shapes_.note(settings_.camera + ": no event camera has these pixels");
}

std::optional<PathStory> Overlays::story(const ShownTick& tick, uint64_t row_id) const {
  const std::vector<size_t> channels = sensors_of("csi"), poses = sensors_of("pose");
  if (settings_.channel >= channels.size() || poses.empty()) return {};
  const Record *const record = newest(tick, channels[settings_.channel]), *const at = newest(tick, poses[0]);
  if (record == nullptr || at == nullptr) return {};
  return path_story(tables_, info_->sensors[channels[settings_.channel]], *record, NodePoses(tables_, *at),
                    row_id);
}

uint64_t Overlays::path_of_rank(const std::shared_ptr<const ShownTick>& tick, size_t rank) {
  const Shapes& all = shapes(tick);
  uint32_t last = ~0u;  // the strongest path is drawn last
  for (auto line = all.lines.rbegin(); line != all.lines.rend(); ++line) {
    if (line->row == ~0u || line->row == last || !all.rows[line->row].is_path) continue;
    last = line->row;
    if (--rank == 0) return all.rows[line->row].id;
  }
  return 0;
}

void Overlays::look_through(const std::string& camera) {
  // The node's number may have changed with the scenario, even where the name has not.
  const std::optional<uint32_t> node = tables_.node_called(camera.substr(0, camera.find('/')));
  if (camera == settings_.camera && node == settings_.sensor.hidden_node) return;
  settings_.camera = camera;
  settings_.sensor.hidden_node = node;
  ++settings_.version;
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
