// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/camera_bench.h"

#include <cmath>
#include <functional>
#include <memory>

#include "apps/bench/event_row.h"
#include "apps/bench/first_sensor.h"
#include "apps/bench/measure.h"
#include "core/srgb.h"
#include "core/units.h"
#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "sim/plan/camera_desc.h"
#include "sim/plan/plan_options.h"
#include "sim/scenario/clock.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/sensors/sensor.h"
#include "sim/world/moment.h"
#include "sim/world/world.h"

namespace greatx::apps {

namespace {

constexpr double day_target_ms = 20.0, night_over_day = 1.5, events_target_ms = 60.0;
constexpr double night_elevation_deg = -20.0, night_ev100 = 4.0;
constexpr double fog_g_m3 = 0.05, fog_sun_elevation_deg = 48.0, fog_sun_lux = 2500.0, fog_sky_lux = 14000.0,
                 fog_ev100 = 13.4;

/// Measures one row: a camera pass with its own scene, lighting and ring of ticks.
class CameraRow {
 public:
  CameraRow(gpu::Device& device, std::string name, scene::Scene scene, const sim::EffectPlan& plan,
            const render::Lighting& lighting, const render::CameraEffects& effects,
            const render::CameraDesc& desc)
      : name_(std::move(name)),
        scene_(std::make_unique<scene::Scene>(std::move(scene))),
        gpu_(device, *scene_,
             {.acceleration_structure = false, .textures = sim::gpu_scene_options(plan).textures}),
        lighting_(gpu_, lighting, effects),
        camera_(lighting_, desc),
        ring_(device, 2, 4u << 20, 16u << 20) {}

  void shoot(const Instant& instant, bool counts) {
    const double cpu_before = cpu_milliseconds();
    const Clock::time_point begin = Clock::now();
    gpu::TickSlot& slot = ring_.begin();
    gpu_.record_update(slot, instant.bodies);
    lighting_.record(slot, instant.bodies);
    camera_.record(slot, instant.local_from_sensor);
    ring_.submit(slot);
    ring_.wait(slot);
    images_ = camera_.collect(slot);
    if (!counts) return;
    times_.push_back(milliseconds_since(begin));
    cpu_.push_back(cpu_milliseconds() - cpu_before);
    lamps_ += camera_.lamps().seen;
  }
  const render::CameraImages& images() const { return images_; }
  const std::string& name() const { return name_; }
  scene::GpuScene& gpu_scene() { return gpu_; }
  render::SceneLighting& lighting() { return lighting_; }

  /// Adds the squared differences between the 8-bit channels of the last picture and of `reference`, if both
  /// have the same size.
  void compare(const std::vector<uint8_t>& reference) {
    if (images_.rgb.size() != reference.size()) return;
    for (size_t i = 0; i < reference.size(); ++i)
      squares_ += std::pow(double(images_.rgb[i]) - reference[i], 2.0);
    compared_ += reference.size();
  }

  nlohmann::json result() const {
    nlohmann::json row{{"name", name_}, {"tick_ms", distribution(times_)}, {"cpu_ms", distribution(cpu_)}};
    row["lamps_placed"] = scene_->lights.size();
    row["lamps_seen"] = times_.empty() ? 0.0 : double(lamps_) / double(times_.size());
    if (compared_ > 0) row["rmse_8bit"] = std::sqrt(squares_ / double(compared_));
    return row;
  }

 private:
  std::string name_;
  std::unique_ptr<scene::Scene> scene_;
  scene::GpuScene gpu_;
  render::SceneLighting lighting_;
  render::CameraPass camera_;
  gpu::TickRing ring_;
  render::CameraImages images_;
  std::vector<double> times_, cpu_;
  uint64_t lamps_ = 0, compared_ = 0;
  double squares_ = 0.0;
};

/// Returns `count` street lamps around the middle of the scene, on a square grid with a spacing of 30 m, 8 m
/// above the lowest point of the scene. Each shines 900 cd down a cone of 70 degrees half-angle with a range
/// of 30 m. More lamps cover a larger area.
std::vector<scene::PunctualLight> lattice_of_lamps(const scene::Scene& scene, uint32_t count) {
  constexpr double spacing_m = 30.0;
  std::vector<scene::PunctualLight> lamps;
  const auto side = static_cast<uint32_t>(std::ceil(std::sqrt(double(count))));
  const dvec3 middle = scene.bounds.center();
  for (uint32_t i = 0; i < count; ++i) {
    scene::PunctualLight lamp;
    lamp.type = scene::PunctualLight::Type::spot;
    const dvec2 place = spacing_m * (dvec2(i % side, i / side) - 0.5 * (side - 1.0));
    lamp.position = dvec3(dvec2(middle) + place, scene.bounds.min.z + 8.0);
    lamp.intensity = 900.0f;
    lamp.range_m = 30.0f;
    lamp.inner_cone = float(radians(50.0));
    lamp.outer_cone = float(radians(70.0));
    lamps.push_back(lamp);
  }
  return lamps;
}

/// Returns, for each of `count` ticks spread evenly over the first sequence, the instants of an event
/// camera's interval that begins at the tick.
std::vector<std::vector<Instant>> instants_of(const sim::Scenario& scenario, const sim::World& world,
                                              sim::SensorPlace camera, uint32_t count) {
  const sim::Courses courses = sim::make_courses(scenario, world, 0);
  const sim::Clock clock(scenario.tick_rate_hz);
  const Pose mount = sim::mount_pose(scenario.nodes[camera.node].sensors[camera.sensor].mount);
  std::vector<std::vector<Instant>> intervals;
  for (uint32_t i = 0; i < count; ++i) {
    const double begin_s = clock.seconds(scenario.ticks * i / count);
    std::vector<Instant> instants;
    for (uint32_t step = 0; step <= EventRow::substeps; ++step) {
      const double time_s = begin_s + 1e-9 * double(EventRow::interval_ns) * step / EventRow::substeps;
      instants.push_back({world.scene.to_local(courses.nodes[camera.node]->at(time_s).pose) * mount,
                          sim::body_poses(world, courses, time_s)});
    }
    intervals.push_back(std::move(instants));
  }
  return intervals;
}

/// Reduces a picture to a quarter of its width and height. A pixel is the mean of 4 x 4 pixels in linear
/// light.
std::vector<uint8_t> reduced(const render::CameraImages& large) {
  const uint32_t width = large.width / 4, height = large.height / 4;
  std::vector<uint8_t> small(size_t{3} * width * height);
  for (uint32_t row = 0; row < height; ++row)
    for (uint32_t column = 0; column < width; ++column)
      for (uint32_t c = 0; c < 3; ++c) {
        double sum = 0.0;
        for (uint32_t k = 0; k < 16; ++k)
          sum += linear_from_srgb(
              large.rgb[3 * (size_t{4 * row + k / 4} * large.width + 4 * column + k % 4) + c] / 255.0);
        small[3 * (size_t{row} * width + column) + c] =
            static_cast<uint8_t>(std::lround(255.0 * srgb_from_linear(sum / 16.0)));
      }
  return small;
}

render::CameraDesc enlarged(render::CameraDesc desc) {
  desc.width *= 4;
  desc.height *= 4;
  desc.fx *= 4.0;
  desc.fy *= 4.0;
  desc.cx *= 4.0;
  desc.cy *= 4.0;
  return desc;
}

class CameraBench {
 public:
  CameraBench(const ScenarioOptions& options, const RunOptions& run)
      : experiment_(sim::make_experiment(load_scenario(options))),
        device_(run.device_options()),
        camera_(first_sensor<sim::CameraConfig>(scenario_, "--camera", "a camera")) {
    const sim::NodeConfig& node = scenario_.nodes[camera_.node];
    desc_ =
        sim::camera_desc(scenario_, node, node.sensors[camera_.sensor], world_.body_of_node[camera_.node]);
    desc_.outputs = {};  // rgb, depth, ids
    desc_.distortion = {};
    desc_.wide = {};
    desc_.bands = 0;
    desc_.chromatic = {};
    desc_.parts = false;
    day_ = sim::lighting_of(scenario_.environment, plan_);
    effects_ = sim::camera_effects(plan_);
  }

  void add_rows() {
    const auto with = [&](const std::string& name, const std::function<void(render::CameraDesc&)>& change) {
      render::CameraDesc desc = desc_;
      change(desc);
      add(name, world_.scene, day_, effects_, desc);
    };
    with("as in the scenario", [](auto&) {});
    with("antialiasing none", [](auto& d) { d.msaa = 1, d.smooth_edges = false; });
    with("antialiasing edges", [](auto& d) { d.msaa = 1, d.smooth_edges = true; });
    with("antialiasing msaa4", [](auto& d) { d.msaa = 4, d.smooth_edges = false; });
    with("depth and ids alone", [](auto& d) { d.outputs.rgb = false; });
    with("automatic exposure", [](auto& d) { d.automatic_exposure = true; });
    with("sensor noise", [](auto& d) { d.noise = render::SensorNoise{}; });
    with("lens distortion", [](auto& d) { d.distortion.k1 = -0.05; });
    with("fisheye of 190 degrees", [](auto& d) {
      d.wide = {.model = render::LensModel::fisheye, .half_angle = radians(95.0), .circle_given = true};
      d.fx = d.fy = 0.5 * d.width / d.wide.half_angle;
      d.vignetting.natural = false;
    });
    with("chromatic aberration", [](auto& d) { d.chromatic = {.red = 1.002, .blue = 0.998}; });
    const auto without = [&](const std::string& name, bool render::CameraEffects::*effect) {
      if (!(effects_.*effect)) return;
      render::CameraEffects effects = effects_;
      effects.*effect = false;
      add("without " + name, world_.scene, day_, effects, desc_);
    };
    without("textures", &render::CameraEffects::textures);
    without("static shadows", &render::CameraEffects::static_shadows);
    without("moving shadows", &render::CameraEffects::moving_shadows);
    without("shadow cascades", &render::CameraEffects::shadow_cascades);
    without("ambient occlusion", &render::CameraEffects::ambient_occlusion);
    without("specular", &render::CameraEffects::specular);
    add_fog();
    add_night();
    add_events();
    render::CameraDesc large = enlarged(desc_);
    large.msaa = 1;
    large.smooth_edges = false;
    reference_ =
        std::make_unique<CameraRow>(device_, "reference", world_.scene, plan_, day_, effects_, large);
  }

  nlohmann::json measure(const CameraBenchOptions& options) {
    const auto warm = static_cast<uint32_t>(options.warm_up);
    const auto intervals = instants_of(scenario_, world_, camera_, options.pictures + warm);
    for (uint32_t i = 0; i < intervals.size(); ++i) {
      for (const auto& row : rows_) row->shoot(intervals[i][0], i >= warm);
      for (const auto& row : event_rows_) row->shoot(intervals[i], i >= warm);
      if (i % 8 == 0) compare(intervals[i][0]);
    }
    return result();
  }

 private:
  void add(const std::string& name, scene::Scene scene, const render::Lighting& lighting,
           const render::CameraEffects& effects, const render::CameraDesc& desc) {
    rows_.push_back(
        std::make_unique<CameraRow>(device_, name, std::move(scene), plan_, lighting, effects, desc));
  }

  /// Adds the same view in fog, with the light of the scenario city_fog: an overcast sky and a visibility of
  /// about 380 m.
  void add_fog() {
    sim::Scenario scenario = scenario_;
    sim::Environment& environment = scenario.environment = {};
    environment.sun_elevation = radians(fog_sun_elevation_deg);
    environment.sun_illuminance_lux = fog_sun_lux;
    environment.sky = sim::SkyKind::overcast;
    environment.sky_illuminance_lux = fog_sky_lux;
    environment.fog_g_m3 = fog_g_m3;
    render::CameraDesc desc = desc_;
    desc.exposure_ev100 = fog_ev100;
    desc.automatic_exposure = false;
    add("fog", world_.scene, sim::lighting_of(environment, {}),
        sim::camera_effects(sim::make_effect_plan(scenario, experiment_.scene())), desc);
  }

  /// Adds the same view by night, first with the scene's own lamps, then with lattice_of_lamps().
  void add_night() {
    sim::Scenario scenario = scenario_;
    scenario.environment = {};
    scenario.environment.sun_elevation = radians(night_elevation_deg);
    const sim::EffectPlan plan = sim::make_effect_plan(scenario, experiment_.scene());
    const render::Lighting night = sim::lighting_of(scenario.environment, plan);
    render::CameraDesc desc = desc_;
    desc.exposure_ev100 = night_ev100;
    desc.automatic_exposure = false;
    add("night", world_.scene, night, sim::camera_effects(plan), desc);
    render::CameraEffects effects = sim::camera_effects(plan);
    effects.punctual_lights = true;
    for (const uint32_t count : {10u, 100u, 1000u}) {
      scene::Scene scene = world_.scene;
      scene.lights = lattice_of_lamps(scene, count);
      add(fmt::format("night, {} lamps placed", count), std::move(scene), night, effects, desc);
    }
  }

  /// Adds the same view by day for an event camera. These rows use the scene and the lighting of the first
  /// row.
  void add_events() {
    for (const bool edges : {true, false}) {
      render::CameraDesc desc = desc_;
      desc.msaa = 1;
      desc.smooth_edges = edges;
      event_rows_.push_back(
          std::make_unique<EventRow>(fmt::format("events, 4 sub-steps, {}", edges ? "edges" : "none"),
                                     rows_.front()->gpu_scene(), rows_.front()->lighting(), desc));
    }
  }

  void compare(const Instant& instant) {
    reference_->shoot(instant, false);
    const std::vector<uint8_t> reference = reduced(reference_->images());
    for (const auto& row : rows_) {
      if (row->name().starts_with("antialiasing")) row->compare(reference);
      if (row->name().starts_with("without")) row->compare(rows_.front()->images().rgb);
    }
  }

  nlohmann::json result() const {
    nlohmann::json result{{"scenario", scenario_.name},
                          {"device", device_.info().name},
                          {"driver", device_.info().driver},
                          {"camera", desc_.name},
                          {"width", desc_.width},
                          {"height", desc_.height},
                          {"triangles", world_.scene.triangle_count()},
                          {"rows", nlohmann::json::array()}};
    double first = 0.0;
    for (const auto& row : rows_) {
      nlohmann::json json = row->result();
      const double median = json["tick_ms"]["median"];
      if (first == 0.0) {
        first = median;
        json["target_ms"] = day_target_ms;
      }
      if (row->name() == "night") json["target_ms"] = night_over_day * first;
      json["ratio"] = median / first;
      result["rows"].push_back(std::move(json));
    }
    for (const auto& row : event_rows_) {
      nlohmann::json json = row->result();
      json["ratio"] = json["tick_ms"]["median"].get<double>() / first;
      json["target_ms"] = events_target_ms;
      result["rows"].push_back(std::move(json));
    }
    return result;
  }

  sim::Experiment experiment_;
  const sim::Scenario& scenario_ = experiment_.scenario;
  const sim::World& world_ = *experiment_.world;
  const sim::EffectPlan& plan_ = experiment_.plan;
  gpu::Device device_;
  sim::SensorPlace camera_;
  render::CameraDesc desc_;
  render::Lighting day_;
  render::CameraEffects effects_;
  std::vector<std::unique_ptr<CameraRow>> rows_;
  std::vector<std::unique_ptr<EventRow>> event_rows_;
  std::unique_ptr<CameraRow> reference_;
};

}  // namespace

nlohmann::json camera_bench(const ScenarioOptions& scenario, const RunOptions& run,
                            const CameraBenchOptions& options) {
  CameraBench bench(scenario, run);
  bench.add_rows();
  return bench.measure(options);
}

std::string camera_bench_text(const nlohmann::json& result) {
  std::string text = fmt::format(
      "{}, {} of {} x {}, {} triangles, on {} ({})\n{:<28} {:>8} {:>8} {:>8} {:>7} {:>9} {:>10}\n",
      result["scenario"].get<std::string>(), result["camera"].get<std::string>(), result["width"].get<int>(),
      result["height"].get<int>(), result["triangles"].get<size_t>(), result["device"].get<std::string>(),
      result["driver"].get<std::string>(), "", "min ms", "median", "cpu ms", "ratio", "rmse/255",
      "lamps seen");
  for (const nlohmann::json& row : result["rows"]) {
    text += fmt::format(
        "{:<28} {:8.2f} {:8.2f} {:8.2f} {:7.2f} {:>9} {:>10}{}\n", row["name"].get<std::string>(),
        row["tick_ms"]["min"].get<double>(), row["tick_ms"]["median"].get<double>(),
        row["cpu_ms"]["median"].get<double>(), row["ratio"].get<double>(),
        row.contains("rmse_8bit") ? fmt::format("{:.2f}", row["rmse_8bit"].get<double>()) : "",
        row["lamps_seen"].get<double>() > 0.0 ? fmt::format("{:.1f}", row["lamps_seen"].get<double>()) : "",
        row.contains("target_ms") ? fmt::format("  (to reach: {:.1f} ms)", row["target_ms"].get<double>())
                                  : "");
  }
  return text;
}

}  // namespace greatx::apps
