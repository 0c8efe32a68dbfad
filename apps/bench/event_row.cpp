// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/event_row.h"

#include <utility>

#include "apps/bench/measure.h"

namespace greatx::apps {

render::CameraDesc luminance_camera(render::CameraDesc desc) {
  desc.outputs = render::CameraOutputs::of_luminance(false);
  return desc;
}

render::EventDesc event_camera(const std::string& name, const render::CameraDesc& camera, uint32_t substeps) {
  render::EventDesc desc;
  desc.name = name;
  desc.width = camera.width;
  desc.height = camera.height;
  desc.substeps = substeps;
  desc.capacity = 16 * camera.width * camera.height;
  return desc;
}

EventRow::EventRow(std::string name, scene::GpuScene& gpu_scene, render::SceneLighting& lighting,
                   render::CameraDesc desc)
    : name_(std::move(name)),
      gpu_(gpu_scene),
      lighting_(lighting),
      camera_(lighting, luminance_camera(std::move(desc))),
      events_(gpu_scene, event_camera(name_, camera_.desc(), substeps)),
      ring_(gpu_scene.device(), 2, 4u << 20, 16u << 20) {}

void EventRow::take(gpu::TickSlot& slot, uint32_t index, const Instant& instant) {
  gpu_.record_poses(slot, instant.bodies);
  lighting_.record(slot, instant.bodies);
  camera_.record(slot, instant.local_from_sensor);
  events_.step(slot, index, camera_.luminance(), nullptr, {});
}

void EventRow::shoot(const std::vector<Instant>& instants, bool counts) {
  events_.restart();
  for (const bool first : {true, false}) {
    const double cpu_before = cpu_milliseconds();
    const Clock::time_point begin = Clock::now();
    gpu::TickSlot& slot = ring_.begin();
    events_.begin(slot, {0, first ? 0 : interval_ns, first ? 0 : 1, 0});
    for (uint32_t i = first ? 0 : 1; i <= (first ? 0 : substeps); ++i) take(slot, i, instants[i]);
    events_.end(slot, camera_.luminance());
    ring_.submit(slot);
    ring_.wait(slot);
    const render::EventFrame frame = events_.collect(slot);
    if (first || !counts) continue;
    times_.push_back(milliseconds_since(begin));
    cpu_.push_back(cpu_milliseconds() - cpu_before);
    found_ += frame.size();
  }
}

nlohmann::json EventRow::result() const {
  return {{"name", name_},
          {"tick_ms", distribution(times_)},
          {"cpu_ms", distribution(cpu_)},
          {"lamps_seen", 0.0},
          {"events", times_.empty() ? 0.0 : double(found_) / double(times_.size())}};
}

}  // namespace greatx::apps
