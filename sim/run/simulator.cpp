// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/run/simulator.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/activity.h"
#include "renderer/probe/probe.h"
#include "rf/paths/crossings.h"
#include "sim/channel/channel_sensor.h"
#include "sim/compare/consistency.h"
#include "sim/plan/plan_options.h"
#include "sim/sensors/camera/camera_sensor.h"
#include "sim/sensors/event/event_sensor.h"
#include "sim/sensors/lidar/lidar_sensor.h"
#include "sim/sensors/pose/pose_sensor.h"
#include "sim/sensors/radar/radar_sensor.h"

namespace greatx::sim {

namespace {

constexpr VkDeviceSize first_upload_bytes = 4u << 20, first_readback_bytes = 16u << 20;
constexpr uint32_t poses_sensor = 0;  ///< the first sensor; due whenever another one is

/// What `act` gives; its errors say where the scenario has what they are about.
template <typename Act>
auto located(const SourceLocation& where, const Act& act) {
  try {
    return act();
  } catch (const UserError& error) {
    if (error.located() || where.line == 0) throw;
    throw_user_error_at(where, "{}", error.what());
  }
}

}  // namespace

/// Passes that several sensors share; only those of the plan exist.
struct Simulator::Passes {
  std::unique_ptr<render::SceneLighting> lighting;
  std::unique_ptr<PosedScene> posed;  ///< with the lighting
  std::unique_ptr<render::ProbePass> probe;
  std::unique_ptr<rf::CrossingPass> crossings;
};

/// A tick that was submitted and not yet collected.
struct Simulator::InFlight {
  const gpu::TickSlot* slot = nullptr;
  int64_t tick = 0;
  std::vector<Due> due;
};

/// Adds the wall time of its life to a row of RunStatistics::host, if samples are kept.
class Simulator::HostScope {
 public:
  HostScope(Simulator& simulator, const char* doing, const std::string& sensor = {}) {
    if (!simulator.keep_samples_) return;
    total_ = &simulator.statistics_.host[sensor.empty() ? doing : doing + (" " + sensor)];
    begin_ = std::chrono::steady_clock::now();
  }
  ~HostScope() {
    if (total_ == nullptr) return;
    const double milliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count();
    ++total_->count;
    total_->milliseconds += milliseconds;
    total_->samples.push_back(milliseconds);
  }
  HostScope(const HostScope&) = delete;
  HostScope& operator=(const HostScope&) = delete;

 private:
  PassTotal* total_ = nullptr;
  std::chrono::steady_clock::time_point begin_;
};

Simulator::Simulator(gpu::Device& device, const Scenario& scenario, const World& world,
                     const EffectPlan& plan)
    : scenario_(scenario),
      world_(world),
      plan_(plan),
      device_(device),
      gpu_scene_(device, world.scene, gpu_scene_options(plan)),
      ring_(device, slots_in_flight, first_upload_bytes, first_readback_bytes),
      clock_(scenario.tick_rate_hz),
      schedule_(scenario.tick_rate_hz),
      passes_(std::make_unique<Passes>()) {
  if (plan.camera.on)
    passes_->lighting = std::make_unique<render::SceneLighting>(gpu_scene_, lighting_of(scenario.environment),
                                                                camera_effects(plan));
  if (passes_->lighting) passes_->posed = std::make_unique<PosedScene>(gpu_scene_, *passes_->lighting, world);
  if (plan.consistency.on) passes_->probe = std::make_unique<render::ProbePass>(gpu_scene_);
  if (plan.channel.on)
    passes_->crossings = std::make_unique<rf::CrossingPass>(
        gpu_scene_, rf::facet_kinds(world.scene, radio_effects(plan, scenario)));
  add_sensors();
}

Simulator::~Simulator() = default;

void Simulator::add_sensors() {
  sensors_.push_back(std::make_unique<PoseSensor>(scenario_, world_.scene.origin));
  places_.emplace_back();
  for (uint32_t node = 0; node < scenario_.nodes.size(); ++node) {
    const std::vector<SensorConfig>& configs = scenario_.nodes[node].sensors;
    for (uint32_t i = 0; i < configs.size(); ++i) {
      if (std::holds_alternative<AntennaConfig>(configs[i].config)) continue;
      add(located(configs[i].where, [&] { return make_sensor(node, i); }), configs[i].rate_hz,
          configs[i].where);
    }
  }
  for (uint32_t i = 0; i < scenario_.channels.size(); ++i) {
    const ChannelConfig& config = scenario_.channels[i];
    const auto make = [&] {
      return std::make_unique<ChannelSensor>(gpu_scene_, *passes_->crossings, plan_, scenario_, world_, i);
    };
    add(located(config.where, make), config.rate_hz, config.where);
  }
  for (const auto& sensor : sensors_) {
    specs_.push_back(sensor->spec());
    looks_ahead_ |= sensor->looks_ahead();
  }
}

std::unique_ptr<Sensor> Simulator::make_sensor(uint32_t node, uint32_t sensor) {
  const auto& config = scenario_.nodes[node].sensors[sensor].config;
  if (std::holds_alternative<CameraConfig>(config))
    return std::make_unique<CameraSensor>(*passes_->posed, passes_->probe.get(), scenario_, node, sensor);
  if (std::holds_alternative<EventCameraConfig>(config))
    return std::make_unique<EventSensor>(*passes_->posed, shared_camera(node, sensor), scenario_, node,
                                         sensor);
  if (std::holds_alternative<LidarConfig>(config))
    return std::make_unique<LidarSensor>(gpu_scene_, plan_, scenario_, world_, node, sensor);
  return std::make_unique<RadarSensor>(gpu_scene_, plan_, scenario_, world_, node, sensor);
}

/// The camera whose pixels an event camera has; null: none. It has been added before.
const CameraSensor* Simulator::shared_camera(uint32_t node, uint32_t sensor) const {
  const NodeConfig& config = scenario_.nodes[node];
  const std::string& name = std::get<EventCameraConfig>(config.sensors[sensor].config).camera;
  if (name.empty()) return nullptr;
  const auto found = std::ranges::find_if(
      sensors_, [&](const auto& other) { return other->spec().name == config.name + "/" + name; });
  GREATX_CHECK(found != sensors_.end(), "{}: no camera '{}'", config.name, name);
  return dynamic_cast<const CameraSensor*>(found->get());
}

void Simulator::add(std::unique_ptr<Sensor> sensor, Rational rate_hz, const SourceLocation& where) {
  sensors_.push_back(std::move(sensor));
  places_.push_back(where);
  schedule_.add(rate_hz);
}

void Simulator::start(uint32_t sequence, int64_t first_tick) {
  GREATX_CHECK(pending_ == nullptr, "sequence {} started with a tick in flight", sequence);
  sequence_ = sequence;
  courses_ = make_courses(scenario_, world_, sequence);
  due_ticks_ = 0;
  for (next_tick_ = schedule_.next(0, scenario_.ticks); next_tick_ < std::min(first_tick, scenario_.ticks);
       ++due_ticks_)
    next_tick_ = schedule_.next(next_tick_ + 1, scenario_.ticks);
  if (next_tick_ >= scenario_.ticks) return;
  const Moment moment = moment_at(next_tick_), beginning = moment_at(0);
  for (size_t i = 0; i < sensors_.size(); ++i)
    located(places_[i],
            [&] { sensors_[i]->start(sensors_[i]->remembers() ? beginning.context : moment.context); });
  replay(next_tick_);
}

/// Takes the sensors that remember through the ticks before `end`; nothing is written.
void Simulator::replay(int64_t end) {
  for (int64_t tick = schedule_.next(0, end); tick < end; tick = schedule_.next(tick + 1, end)) {
    std::vector<Due> due;
    for (const Due& sensor : schedule_.due(tick))
      if (sensors_[sensor.sensor + 1]->remembers()) due.push_back({sensor.sensor + 1, sensor.sample});
    if (due.empty()) continue;
    gpu::TickSlot& slot = ring_.begin();
    record(slot, moment_at(tick), due);
    ring_.submit(slot, gpu::TickRing::Kind::setup);
    ring_.wait(slot);
    for (const Due& sensor : due) sensors_[sensor.sensor]->catch_up(slot);
  }
}

Moment Simulator::moment_at(int64_t tick) const {
  Moment moment = sim::moment_at(world_, courses_, clock_, tick, schedule_.previous(tick));
  moment.context.sequence = sequence_;
  return moment;
}

bool Simulator::step(RecordSink& sink) {
  if (next_tick_ >= scenario_.ticks) {
    drain(sink);
    return false;
  }
  if (looks_ahead_ && pending_ != nullptr) {
    const HostScope scope(*this, "wait to look ahead");
    ring_.wait(*pending_->slot);
  }
  const int64_t tick = next_tick_;
  std::vector<Due> due{{poses_sensor, due_ticks_++}};
  for (const Due& sensor : schedule_.due(tick)) due.push_back({sensor.sensor + 1, sensor.sample});

  gpu::TickSlot& slot = ring_.begin();
  record(slot, moment_at(tick), due);
  next_tick_ = schedule_.next(tick + 1, scenario_.ticks);
  if (looks_ahead_ && next_tick_ < scenario_.ticks) record_ahead(slot);
  ring_.submit(slot);
  ++statistics_.ticks;

  drain(sink);  // the tick before, while the GPU works on this one
  pending_ = std::make_unique<InFlight>(InFlight{&slot, tick, std::move(due)});
  return true;
}

void Simulator::record(gpu::TickSlot& slot, const Moment& moment, const std::vector<Due>& due) {
  const Activity activity("recording a tick");
  gpu_scene_.record_update(slot, moment.bodies);
  const bool camera_due = std::any_of(
      due.begin(), due.end(), [&](const Due& d) { return specs_[d.sensor].kind.ends_with("camera"); });
  if (camera_due) passes_->lighting->record(slot, moment.bodies);
  for (const Due& sensor : due) {
    const HostScope scope(*this, "record", specs_[sensor.sensor].name);
    located(places_[sensor.sensor], [&] { sensors_[sensor.sensor]->record(slot, moment.context); });
  }
}

void Simulator::record_ahead(gpu::TickSlot& slot) {
  const Moment next = moment_at(next_tick_);
  bool updated = false;
  for (const Due& due : schedule_.due(next_tick_)) {
    Sensor& sensor = *sensors_[due.sensor + 1];
    if (!sensor.looks_ahead()) continue;
    if (!updated) gpu_scene_.record_update(slot, next.bodies);
    updated = true;
    sensor.record_ahead(slot, next.context);
  }
}

void Simulator::drain(RecordSink& sink) {
  if (pending_ == nullptr) return;
  const std::unique_ptr<InFlight> in_flight = std::move(pending_);
  collect(*in_flight, sink);
}

void Simulator::collect(const InFlight& in_flight, RecordSink& sink) {
  const Activity activity("collecting a tick");
  {
    const HostScope scope(*this, "wait");
    ring_.wait(*in_flight.slot);
  }
  Packet packet{in_flight.tick, clock_.nanoseconds(in_flight.tick), {}};
  for (const Due& due : in_flight.due) {
    const HostScope scope(*this, "collect", specs_[due.sensor].name);
    const auto collect = [&] { return sensors_[due.sensor]->collect(*in_flight.slot); };
    packet.records.push_back(
        {due.sensor, packet.tick, packet.time_ns, due.sample, located(places_[due.sensor], collect)});
    ++statistics_.records[specs_[due.sensor].name];
  }
  {
    const HostScope scope(*this, "compare");
    compare(packet);
  }
  for (const gpu::PassTime& pass : in_flight.slot->timestamps.read()) {
    PassTotal& total = statistics_.passes[pass.name];
    ++total.count;
    total.milliseconds += pass.milliseconds;
    if (keep_samples_) total.samples.push_back(pass.milliseconds);
  }
  const HostScope scope(*this, "hand over");
  sink.write(std::move(packet));
  ++statistics_.packets;
}

void Simulator::compare(const Packet& packet) {
  for (const Record& record : packet.records)
    if (const auto* channel = dynamic_cast<const ChannelSensor*>(sensors_[record.sensor].get()))
      keep(sight_figure, packet, record.sensor, poses_sensor, channel->sights(), nullptr);
  if (!plan_.consistency.on) return;
  compare_lidar_with_depth(packet);
  compare_radars(packet);
}

/// `total`: of the run; null, if the sensor has it itself.
void Simulator::keep(const char* figure, const Packet& packet, uint32_t sensor, uint32_t other,
                     const ErrorStatistics& errors, ErrorStatistics* total) {
  if (errors.count() == 0) return;
  if (total != nullptr) total->add(errors);
  statistics_.rows.push_back({figure, sequence_, packet.tick, specs_[sensor].name, specs_[other].name,
                              errors.count(), errors.max()});
}

void Simulator::compare_lidar_with_depth(const Packet& packet) {
  for (const Record& a : packet.records) {
    const auto* lidar = dynamic_cast<const LidarSensor*>(sensors_[a.sensor].get());
    if (lidar == nullptr || !lidar->exact()) continue;
    for (const Record& b : packet.records) {
      const auto* camera = dynamic_cast<const CameraSensor*>(sensors_[b.sensor].get());
      if (camera == nullptr || camera->node() != lidar->node() || camera->images().depth.empty()) continue;
      if (camera->desc().distortion.any()) continue;  // the comparison is that of a pinhole camera
      const Pose camera_from_lidar = camera->mount().inverse() * lidar->mount();
      const render::LidarScan& scan = lidar->scan();
      const std::span<const float> points(scan.size() > 0 ? &scan.points[0].x : nullptr, 4 * scan.size());
      const ErrorStatistics errors = lidar_against_depth(camera->desc(), camera->images(), camera_from_lidar,
                                                         points, scan.instance, scan.material);
      keep(lidar_figure, packet, a.sensor, b.sensor, errors, &statistics_.consistency.lidar);
    }
  }
}

void Simulator::compare_radars(const Packet& packet) {
  const auto view = [&](const Record& record) {
    const SensorSpec* const spec = &specs_[record.sensor];
    return RecordView{*spec, [spec, arrays = &record.arrays](const std::string& name) {
                        const auto found = std::ranges::find(spec->arrays, name, &ArraySpec::name);
                        GREATX_CHECK(found != spec->arrays.end(), "{} has no array {}", spec->name, name);
                        return (*arrays)[static_cast<size_t>(found - spec->arrays.begin())];
                      }};
  };
  for (const Record& record : packet.records) {
    const auto* radar = dynamic_cast<const RadarSensor*>(sensors_[record.sensor].get());
    if (radar == nullptr || !radar->config().outputs.detections) continue;
    if (boxes_.empty()) boxes_ = instance_boxes(world_);
    keep(radar_figure, packet, record.sensor, poses_sensor,
         compare_radar(view(record), view(packet.records.front()), boxes_), &statistics_.consistency.radar);
  }
}

RunStatistics Simulator::statistics() const {
  RunStatistics statistics = statistics_;
  if (gpu_scene_.has_tree())
    statistics.notes.emplace_back("tracer",
                                  "the device is a CPU: LiDAR rays meet the static world in a tree of "
                                  "greatx's own, all others in the driver's");
  for (const auto& sensor : sensors_) {
    sensor->report(statistics.consistency);
    sensor->count(statistics.counters);
    sensor->warn(statistics.warnings);
    sensor->note(statistics.notes);
  }
  return statistics;
}

}  // namespace greatx::sim
