// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses the event cameras of nodes[].sensors[].
#include <algorithm>

#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

constexpr uint32_t most_steps = 64;
constexpr uint32_t most_instants = 256;
constexpr double slowest_rate_hz = 0.5;  ///< times within an interval are 31-bit nanoseconds

/// Parses {by: pixel, max_px, most, pictures}.
void parse_pixel_steps(const Field& field, EventCameraConfig& camera) {
  const FieldMap map(field, {"by", "max_px", "most", "pictures"});
  camera.steps = EventCameraConfig::Steps::by_pixel;
  camera.substeps = 1;
  if (const auto f = map.find("max_px")) camera.max_flow_px = f->positive();
  if (const auto f = map.find("most")) camera.instants = f->integer32(1, most_instants);
  if (const auto f = map.find("pictures")) camera.substeps = f->integer32(1, most_steps);
}

/// Parses a number of even instants, or {by: flow, max_px, most}, or {by: brightness, max_change, most}, or
/// {by: pixel, max_px, most, pictures}.
void parse_steps(const Field& field, EventCameraConfig& camera) {
  if (field.is_scalar()) {
    camera.substeps = field.integer32(1, most_steps);
    return;
  }
  const size_t by = kind_of(field, "by", {"flow", "brightness", "pixel"});
  if (by == 2) return parse_pixel_steps(field, camera);
  const bool by_flow = by == 0;
  const FieldMap map =
      by_flow ? FieldMap(field, {"by", "max_px", "most"}) : FieldMap(field, {"by", "max_change", "most"});
  camera.steps = by_flow ? EventCameraConfig::Steps::by_flow : EventCameraConfig::Steps::by_brightness;
  camera.substeps = 16;
  if (const auto f = map.find("max_px")) camera.max_flow_px = f->positive();
  if (const auto f = map.find("max_change")) camera.max_change = f->positive();
  if (const auto f = map.find("most")) camera.substeps = f->integer32(2, most_steps);
}

/// Parses one number for both polarities, or {on, off, sigma}.
void parse_threshold(const Field& field, EventCameraConfig& camera) {
  constexpr double least = 0.01, most = 1.0;
  if (field.is_scalar()) {
    camera.threshold_on = camera.threshold_off = field.between(least, most);
    return;
  }
  const FieldMap map(field, {"on", "off", "sigma"});
  if (const auto f = map.find("on")) camera.threshold_on = f->between(least, most);
  if (const auto f = map.find("off")) camera.threshold_off = f->between(least, most);
  if (const auto f = map.find("sigma")) camera.threshold_sigma = f->between(0.0, 0.5);
}

void parse_noise(const Field& field, EventCameraConfig& camera) {
  const FieldMap map(field, {"leak_rate_hz", "shot_rate_hz"});
  if (const auto f = map.find("leak_rate_hz")) camera.leak_rate_hz = f->between(0.0, 10.0);
  if (const auto f = map.find("shot_rate_hz")) camera.shot_rate_hz = f->between(0.0, 1000.0);
}

void parse_outputs(const Field& field, EventCameraConfig& camera) {
  struct Output {
    std::string_view name;
    bool* wanted;
  };
  const Output outputs[] = {{"events", &camera.events},
                            {"differences", &camera.differences},
                            {"hdf5", &camera.hdf5},
                            {"text", &camera.text},
                            {"instance", &camera.instance}};
  for (const Output& output : outputs) *output.wanted = false;
  for (const Field& item : field.list("outputs", 1)) {
    bool& wanted = *outputs[item.choice({"events", "differences", "hdf5", "text", "instance"})].wanted;
    if (wanted) item.fail("every output once", fmt::format("a second '{}'", item.text()));
    wanted = true;
  }
  if ((camera.hdf5 || camera.text || camera.instance) && !camera.events)
    field.fail("'events' beside 'hdf5', 'text' and 'instance'", "no 'events'");
}

void parse_difference(const Field& field, EventCameraConfig& camera) {
  if (!camera.differences) field.fail("'differences' among the outputs", "none there");
  const FieldMap map(field, {"on", "off", "ev100"});
  if (const auto f = map.find("on")) camera.difference_on = f->positive();
  if (const auto f = map.find("off")) camera.difference_off = f->positive();
  if (const auto f = map.find("ev100")) camera.difference_ev100 = f->between(-20.0, 24.0);
}

/// The keys that belong to the shared camera.
constexpr std::string_view of_the_camera[] = {"mount",        "see_own_body", "width", "height", "fov_deg",
                                              "fx",           "fy",           "cx",    "cy",     "near_m",
                                              "antialiasing", "distortion",   "lens"};

/// Returns the camera whose pixels the node's event camera `s` shares.
const SensorConfig& camera_of(const NodeConfig& node, size_t s, const std::string& path) {
  const SensorConfig& sensor = node.sensors[s];
  const std::string& name = std::get<EventCameraConfig>(sensor.config).camera;
  const auto fail = [&](const std::string& expected, const std::string& found) {
    throw_user_error_at(sensor.where, "{}.camera: expected {}, found {}", path, expected, found);
  };
  const auto end = node.sensors.begin() + static_cast<ptrdiff_t>(s);
  const auto found = std::find_if(node.sensors.begin(), end, [&](const SensorConfig& c) {
    return c.name == name && std::holds_alternative<CameraConfig>(c.config);
  });
  if (found == end) fail("the name of a camera of the same node listed before", fmt::format("'{}'", name));
  if (found->rate_hz != sensor.rate_hz)
    fail(fmt::format("a camera of the same rate, {} Hz", sensor.rate_hz.str()),
         fmt::format("'{}' of {} Hz", name, found->rate_hz.str()));
  if (std::get<CameraConfig>(found->config).motion_blur_samples > 0)
    fail("a camera without motion blur", fmt::format("'{}' with it", name));
  if (std::get<CameraConfig>(found->config).wide.any())
    fail("a camera without a lens that is fisheye or equirectangular", fmt::format("'{}' with one", name));
  if (std::get<CameraConfig>(found->config).rolling.any())
    fail("a camera without a rolling shutter", fmt::format("'{}' with one", name));
  return *found;
}

}  // namespace

void resolve_event_cameras(std::vector<NodeConfig>& nodes) {
  for (size_t n = 0; n < nodes.size(); ++n) {
    for (size_t s = 0; s < nodes[n].sensors.size(); ++s) {
      SensorConfig& sensor = nodes[n].sensors[s];
      auto* events = std::get_if<EventCameraConfig>(&sensor.config);
      if (events == nullptr) continue;
      const std::string path = fmt::format("nodes[{}].sensors[{}]", n, s);
      if (!events->camera.empty()) {
        const SensorConfig& shared = camera_of(nodes[n], s, path);
        const auto& camera = std::get<CameraConfig>(shared.config);
        static_cast<PinholeConfig&>(*events) = camera;
        events->see_own_body = camera.see_own_body;
        sensor.mount = shared.mount;
      }
      if (events->steps == EventCameraConfig::Steps::by_pixel && events->distortion.any())
        throw_user_error_at(sensor.where,
                            "{}.steps.by: expected 'flow', 'brightness' or a number behind a lens that "
                            "distorts, found 'pixel'",
                            path);
    }
  }
}

EventCameraConfig parse_event_camera(const FieldMap& map, const Rational& rate_hz) {
  EventCameraConfig camera;
  if (const auto f = map.find("camera")) {
    camera.camera = f->text();
    for (const std::string_view key : of_the_camera) map.exclude("camera", key);
  } else {
    parse_pinhole(map, camera);
    if (const auto lens = map.find("lens")) lens->fail("none, for an event camera compares pinhole pictures");
  }
  if (rate_hz.value() < slowest_rate_hz)
    map.require("rate_hz", "a rate")
        .fail(fmt::format("a rate of at least {} Hz of an event camera", slowest_rate_hz));
  if (const auto f = map.find("steps")) parse_steps(*f, camera);
  if (const auto f = map.find("threshold")) parse_threshold(*f, camera);
  if (const auto f = map.find("noise")) parse_noise(*f, camera);
  if (const auto f = map.find("refractory_s")) camera.refractory_s = f->between(0.0, 1.0);
  if (const auto f = map.find("cutoff_hz")) camera.cutoff_hz = f->between(0.0, 1e6);
  if (const auto f = map.find("dark_cd_m2")) camera.dark_cd_m2 = f->between(1e-6, 1e6);
  if (const auto f = map.find("bright_cd_m2")) camera.bright_cd_m2 = f->between(1e-6, 1e9);
  if (const auto f = map.find("max_events_per_pixel")) camera.max_events_per_pixel = f->integer32(1, 1000);
  if (const auto f = map.find("outputs")) parse_outputs(*f, camera);
  if (const auto f = map.find("difference")) parse_difference(*f, camera);
  if (const auto f = map.find("see_own_body")) camera.see_own_body = f->boolean();
  return camera;
}

}  // namespace greatx::sim
