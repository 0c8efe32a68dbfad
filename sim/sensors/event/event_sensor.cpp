// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/event/event_sensor.h"

#include <algorithm>

#include "core/hash.h"
#include "gpu/condition.h"
#include "sim/plan/camera_desc.h"
#include "sim/sensors/camera/camera_metadata.h"
#include "sim/sensors/camera/camera_sensor.h"

namespace greatx::sim {

namespace {

constexpr uint32_t chosen_events_per_pixel = 8;
constexpr uint64_t most_events = 1u << 28;
constexpr double nearest_point_m = 2.0;          ///< points for which reconstructed instants keep their error
constexpr size_t most_listed_instances = 65534;  ///< a cell has 16 bits for its instance
constexpr double longest_hdf5_s = 4294.967295;   ///< times in DSEC are 32-bit microseconds

render::CameraDesc camera_desc(const std::string& name, const EventCameraConfig& config, bool seen,
                               uint32_t body) {
  render::CameraDesc desc;
  desc.name = name + " sub-step";
  set_pinhole(desc, config);
  desc.outputs = render::CameraOutputs::of_luminance(seen);
  desc.outputs.cells = needs_cells(config);
  if (body != 0 && !config.see_own_body) desc.excluded_body = body;
  return desc;
}

render::EventDesc event_desc(const std::string& name, const Scenario& scenario,
                             const EventCameraConfig& config) {
  render::EventDesc desc;
  desc.name = name;
  set_intrinsics(desc, config);
  desc.substeps = config.events ? config.substeps : 1;
  if (config.steps == EventCameraConfig::Steps::by_flow) desc.steps = render::EventSteps::by_flow;
  if (config.steps == EventCameraConfig::Steps::by_brightness) desc.steps = render::EventSteps::by_brightness;
  if (config.steps == EventCameraConfig::Steps::by_pixel) desc.steps = render::EventSteps::by_pixel;
  if (!config.events) desc.steps = render::EventSteps::fixed;
  desc.wanted =
      config.steps == EventCameraConfig::Steps::by_brightness ? config.max_change : config.max_flow_px;
  desc.instants = config.instants;
  desc.smooth_edges = config.smooth_edges && config.msaa == 1;
  desc.threshold_on = config.threshold_on;
  desc.threshold_off = config.threshold_off;
  desc.threshold_sigma = config.threshold_sigma;
  desc.refractory_s = config.refractory_s;
  desc.leak_rate_hz = config.leak_rate_hz;
  desc.shot_rate_hz = config.shot_rate_hz;
  desc.cutoff_hz = config.cutoff_hz;
  desc.dark_cd_m2 = config.dark_cd_m2;
  desc.bright_cd_m2 = config.bright_cd_m2;
  const uint64_t pixels = uint64_t{config.width} * config.height;
  if (config.max_events_per_pixel * pixels > most_events)
    throw_user_error(
        "event camera {}: max_events_per_pixel: expected at most {} for {} x {} pixels, found {}", name,
        most_events / pixels, config.width, config.height, config.max_events_per_pixel);
  const uint64_t per_pixel =
      config.max_events_per_pixel > 0 ? config.max_events_per_pixel : chosen_events_per_pixel;
  desc.capacity = static_cast<uint32_t>(std::min(per_pixel * pixels, most_events));
  desc.events = config.events;
  desc.instance = config.instance;
  desc.differences = config.differences;
  const double l_max = render::saturation_luminance(config.difference_ev100);
  desc.difference_on_cd_m2 = config.difference_on * l_max;
  desc.difference_off_cd_m2 = config.difference_off * l_max;
  desc.seed = scenario.seed;
  desc.stream = fnv1a32(name);
  return desc;
}

std::string name_of(const NodeConfig& node, uint32_t sensor) {
  return node.name + "/" + node.sensors[sensor].name;
}

}  // namespace

EventSensor::EventSensor(PosedScene& posed, CameraSensor* shared, const Scenario& scenario, uint32_t node,
                         uint32_t sensor)
    : posed_(posed),
      world_(posed.world()),
      config_(std::get<EventCameraConfig>(scenario.nodes[node].sensors[sensor].config)),
      node_(node),
      mount_(mount_pose(scenario.nodes[node].sensors[sensor].mount)),
      clock_(scenario.tick_rate_hz),
      shared_(shared),
      events_(posed.lighting().scene(),
              event_desc(name_of(scenario.nodes[node], sensor), scenario, config_)) {
  const SensorConfig& config = scenario.nodes[node].sensors[sensor];
  if (shared_ == nullptr || events_.desc().substeps > 1)
    camera_.emplace(posed.lighting(), camera_desc(name_of(scenario.nodes[node], sensor), config_,
                                                  needs_seen(config_), world_.body_of_node[node]));
  if (config_.hdf5 && clock_.seconds(scenario.ticks) > longest_hdf5_s)
    throw_user_error_at(config.where, "outputs: expected a run of at most {} s for 'hdf5', found {} s",
                        longest_hdf5_s, clock_.seconds(scenario.ticks));
  if (config_.steps == EventCameraConfig::Steps::by_pixel && config_.instance &&
      world_.scene.instances.size() > most_listed_instances)
    throw_user_error_at(config.where,
                        "outputs: expected a scene of at most {} instances for 'instance' with steps by "
                        "pixel, found {}",
                        most_listed_instances, world_.scene.instances.size());
  spec_.name = name_of(scenario.nodes[node], sensor);
  spec_.kind = "event_camera";
  spec_.rate = config.rate_hz.str();
  describe();
}

void EventSensor::describe() {
  nlohmann::json metadata = pinhole_metadata(config_, mount_);
  if (shared_ != nullptr) metadata["camera"] = shared_->spec().name;
  if (config_.events) {
    spec_.arrays = {{"t", DType::i64, {-1}, "ns", "[event] since the sequence's first tick"},
                    {"x", DType::u16, {-1}, "1", "[event] column"},
                    {"y", DType::u16, {-1}, "1", "[event] row"},
                    {"p", DType::u8, {-1}, "1", "[event] 1: brighter, 0: darker"}};
    if (config_.instance)
      spec_.arrays.push_back({"instance",
                              DType::u32,
                              {-1},
                              "1",
                              "[event] index into instances + 1 of what the pixel sees then; 0: nothing"});
    for (const ArraySpec& array : spec_.arrays)
      spec_.outputs.push_back({array.name, FileFormat::npy_ragged, {array.name}});
    spec_.arrays.push_back({"dropped", DType::u64, {}, "1", "events beyond the buffer's room"});
    spec_.arrays.push_back({"pictures", DType::u32, {}, "1", "taken since the record before"});
    for (const char* name : {"dropped", "pictures"})
      spec_.outputs.push_back({name, FileFormat::npy_stack, {name}});
    if (config_.hdf5) spec_.outputs.push_back({"events", FileFormat::hdf5_events, {"t", "x", "y", "p"}});
    if (config_.text) spec_.outputs.push_back({"events_text", FileFormat::text_events, {"t", "x", "y", "p"}});
    metadata["threshold"] = {
        {"on", config_.threshold_on}, {"off", config_.threshold_off}, {"sigma", config_.threshold_sigma}};
    metadata["noise"] = {{"leak_rate_hz", config_.leak_rate_hz}, {"shot_rate_hz", config_.shot_rate_hz}};
    metadata["refractory_s"] = config_.refractory_s;
    metadata["cutoff_hz"] = config_.cutoff_hz;
    metadata["dark_cd_m2"] = config_.dark_cd_m2;
    metadata["bright_cd_m2"] = config_.bright_cd_m2;
    metadata["capacity"] = events_.desc().capacity;
    metadata["steps"] = {{"most", events_.desc().substeps}};
    if (config_.steps == EventCameraConfig::Steps::by_pixel)
      metadata["steps"] = {
          {"most", config_.instants}, {"max_px", config_.max_flow_px}, {"pictures", config_.substeps}};
    if (config_.steps == EventCameraConfig::Steps::by_flow) metadata["steps"]["max_px"] = config_.max_flow_px;
    if (config_.steps == EventCameraConfig::Steps::by_brightness)
      metadata["steps"]["max_change"] = config_.max_change;
  }
  if (config_.differences) {
    const std::vector<int64_t> shape{config_.height, config_.width};
    spec_.arrays.push_back({"difference", DType::i8, shape, "1",
                            "[row, column] 1: brighter than at the record before, -1: darker, else 0"});
    spec_.arrays.push_back(
        {"difference_picture", DType::u8, shape, "1", "[row, column] the same as grey: 255, 0, 128"});
    spec_.outputs.push_back({"difference", FileFormat::npy_stack, {"difference"}});
    spec_.outputs.push_back({"differences", FileFormat::png, {"difference_picture"}});
    metadata["difference_cd_m2"] = {{"on", events_.desc().difference_on_cd_m2},
                                    {"off", events_.desc().difference_off_cd_m2}};
  }
  spec_.metadata_json = metadata.dump();
}

void EventSensor::start(const TickContext& /*context*/) {
  events_.restart();
  last_ns_.reset();
  sample_ = 0;
}

void EventSensor::record(gpu::TickSlot& slot, const TickContext& context) {
  const int64_t now_ns = clock_.nanoseconds(context.tick), before_ns = last_ns_.value_or(now_ns);
  events_.begin(slot, {before_ns, now_ns, sample_, context.sequence});
  picture_s_ = 1e-9 * double(before_ns);
  posed_.at_instants(slot, context, [&](Instants& at) {
    if (!last_ns_) return take_picture(slot, context, at, 0, context.time_s);
    const uint32_t last = events_.desc().substeps;
    for (uint32_t i = 1; i <= last; ++i)
      take_picture(slot, context, at, i, i == last ? context.time_s : 1e-9 * double(events_.time_ns(i)));
  });
  events_.end(slot, picture_at(true).luminance());
  begin_ns_[slot.index] = before_ns;
  last_ns_ = now_ns;
  ++sample_;
}

render::CameraPass& EventSensor::picture_at(bool sample) {
  return sample && shared_ != nullptr ? shared_->pass() : *camera_;
}

void EventSensor::take_picture(gpu::TickSlot& slot, const TickContext& context, Instants& at, uint32_t index,
                               double time_s) {
  const gpu::Condition condition(*slot.cmd, events_.condition(index));
  const bool sample = time_s == context.time_s, of_shared = sample && shared_ != nullptr;
  at.move_to(time_s);
  if (!of_shared) {
    const Motion motion = sample ? context.nodes[node_] : context.motion_at(node_, time_s);
    camera_->record(slot, world_.scene.to_local(motion.pose) * mount_, {context.sequence, context.tick});
  }
  render::CameraPass& picture = picture_at(sample);
  if (const gpu::Buffer* cells = events_.next_cells()) {
    picture.record_cells(slot, *cells);
    if (index > 0) find_paths(context, picture_s_, time_s);
    picture_s_ = time_s;
  }
  const bool by_flow = events_.desc().steps == render::EventSteps::by_flow;
  events_.step(slot, index, picture.luminance(), events_.needs_seen() ? &picture.seen() : nullptr,
               by_flow ? motions(context, time_s) : std::vector<shared::EventMotion>(), &paths_);
}

void EventSensor::find_paths(const TickContext& context, double from_s, double to_s) {
  const auto moment_at = [&](double part) {
    const double time_s = part == 0.0 ? from_s : part == 1.0 ? to_s : from_s + part * (to_s - from_s);
    const Motion carrier = time_s == context.time_s ? context.nodes[node_] : context.motion_at(node_, time_s);
    return EventMoment{world_.scene.to_local(carrier.pose) * mount_, context.body_poses_at(time_s)};
  };
  find_pixel_paths(config_, config_.instants, nearest_point_m, moment_at, paths_);
}

/// Returns the motion of every body relative to the camera. With p_camera = R^T (P - c) and P = O + R_b p_b,
/// the derivative of p_camera is R^T (V + W x (c - O) - v) + R^T (W - w) x p_camera. The result is in optical
/// axes.
std::vector<shared::EventMotion> EventSensor::motions(const TickContext& context, double time_s) const {
  const Motion carrier = context.motion_at(node_, time_s);
  const Pose camera = carrier.pose * mount_;
  const dvec3 velocity =
      carrier.velocity + glm::cross(carrier.angular_velocity, camera.position - carrier.pose.position);
  const dquat to_camera = glm::conjugate(camera.orientation);
  const auto optical = [&](const dvec3& v) { return vec3(to_optical(to_camera * v)); };
  std::vector<shared::EventMotion> motions(world_.scene.bodies.size(),
                                           {optical(-velocity), optical(-carrier.angular_velocity)});
  for (uint32_t node = 0; node < world_.body_of_node.size(); ++node) {
    const uint32_t body = world_.body_of_node[node];
    if (body == 0) continue;
    const Motion m = context.motion_at(node, time_s);
    const dvec3 there = m.velocity + glm::cross(m.angular_velocity, camera.position - m.pose.position);
    motions[body] = {optical(there - velocity), optical(m.angular_velocity - carrier.angular_velocity)};
  }
  const dvec3 local = world_.scene.to_local(camera.position);
  for (const Part& part : world_.parts) {
    const Motion m = context.body_motion_at(part.body, time_s);
    const dvec3 there = m.velocity + glm::cross(m.angular_velocity, local - m.pose.position);
    motions[part.body] = {optical(there - velocity), optical(m.angular_velocity - carrier.angular_velocity)};
  }
  return motions;
}

std::vector<Array> EventSensor::collect(const gpu::TickSlot& slot) {
  const render::EventCounts counts = events_.counts(slot);
  event_count_ += counts.events;
  dropped_ += counts.dropped;
  pictures_ += counts.pictures;
  coarse_ += counts.coarse;
  std::vector<Array> arrays;
  if (config_.events) {
    const auto count = static_cast<int64_t>(counts.events);
    Array times(DType::i64, {count}), columns(DType::u16, {count}), rows(DType::u16, {count}),
        polarities(DType::u8, {count}), instances(DType::u32, {config_.instance ? count : 0});
    events_.sort_into(
        slot, {times.as<int64_t>().data(), columns.as<uint16_t>().data(), rows.as<uint16_t>().data(),
               polarities.as<uint8_t>().data(), instances.as<uint32_t>().data(), begin_ns_[slot.index]});
    for (Array* array : {&times, &columns, &rows, &polarities}) arrays.push_back(std::move(*array));
    if (config_.instance) arrays.push_back(std::move(instances));
    arrays.push_back(Array::of<uint64_t>({}, std::span(&counts.dropped, 1)));
    arrays.push_back(Array::of<uint32_t>({}, std::span(&counts.pictures, 1)));
  }
  if (config_.differences) {
    const std::vector<int64_t> shape{config_.height, config_.width};
    const std::span<const int8_t> difference = events_.difference(slot);
    arrays.push_back(Array::of<int8_t>(shape, difference));
    Array picture(DType::u8, shape);
    std::transform(difference.begin(), difference.end(), picture.as<uint8_t>().begin(), [](int8_t d) {
      return static_cast<uint8_t>(d > 0 ? 255 : d < 0 ? 0 : 128);
    });
    arrays.push_back(std::move(picture));
  }
  return arrays;
}

void EventSensor::count(std::map<std::string, uint64_t>& counters) const {
  if (!config_.events) return;
  counters[spec_.name + ".events"] += event_count_;
  counters[spec_.name + ".event_overflow"] += dropped_;
  counters[spec_.name + ".event_pictures"] += pictures_;
  if (events_.desc().adaptive()) counters[spec_.name + ".event_pictures_too_coarse"] += coarse_;
}

void EventSensor::warn(std::vector<std::string>& warnings) const {
  if (dropped_ == 0) return;
  warnings.push_back(
      fmt::format("{}: {} events were left out, beyond the {} an interval that there is room for; "
                  "max_events_per_pixel makes more",
                  spec_.name, dropped_, events_.desc().capacity));
}

}  // namespace greatx::sim
