// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/reference_bench.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "apps/bench/first_sensor.h"
#include "apps/bench/measure.h"
#include "gpu/tick_ring.h"
#include "io/files/file.h"
#include "io/formats/exr.h"
#include "io/formats/png.h"
#include "renderer/camera/camera.h"
#include "renderer/reference/reference_picture.h"
#include "sim/experiment/experiment.h"
#include "sim/plan/camera_desc.h"
#include "sim/plan/plan_options.h"
#include "sim/tradeoff/error/flip.h"

namespace greatx::apps {

using namespace std::string_literals;

namespace {

/// Glossy surfaces are those whose mirror images keep their shapes.
constexpr float glossy_roughness = 0.3f;
/// A pixel lies in the shade if the key light gives it less than this part of its luminance.
constexpr float shade_share = 0.02f;
constexpr const char* lines_name = "thin lines";

/// The part of a tick that a picture needs.
struct Still {
  std::vector<Pose> bodies;
  Pose local_from_sensor;
};

/// One set of effects: a pass that is timed with the outputs of a plain camera, and one that gives radiance.
class ComparedRow {
 public:
  ComparedRow(scene::GpuScene& gpu_scene, std::string name, const render::Lighting& light,
              const render::CameraEffects& effects, const render::CameraDesc& desc)
      : name_(std::move(name)),
        gpu_(&gpu_scene),
        lighting_(gpu_scene, light, effects),
        timed_(lighting_, desc),
        linear_(lighting_, with_radiance(desc)),
        ring_(gpu_scene.device(), 2, 4u << 20, 64u << 20) {}

  void time(const Still& still, bool counts) {
    const double before = cpu_milliseconds();
    shoot(timed_, still);
    if (counts) cpu_.push_back(cpu_milliseconds() - before);
  }
  render::CameraImages radiance(const Still& still) { return shoot(linear_, still); }
  const std::string& name() const { return name_; }
  const std::vector<double>& cpu() const { return cpu_; }

 private:
  static render::CameraDesc with_radiance(render::CameraDesc desc) {
    desc.outputs.hdr = true;
    return desc;
  }
  render::CameraImages shoot(render::CameraPass& camera, const Still& still) {
    gpu::TickSlot& slot = ring_.begin();
    gpu_->record_update(slot, still.bodies);
    lighting_.record(slot, still.bodies);
    camera.record(slot, still.local_from_sensor);
    ring_.submit(slot);
    ring_.wait(slot);
    return camera.collect(slot);
  }

  std::string name_;
  scene::GpuScene* gpu_;
  render::SceneLighting lighting_;
  render::CameraPass timed_, linear_;
  gpu::TickRing ring_;
  std::vector<double> cpu_;
};

Array picture_array(const std::vector<uint8_t>& rgb, uint32_t width, uint32_t height) {
  return Array::of<uint8_t>({height, width, 3}, rgb);
}

/// Returns half of the difference of two pictures, around middle grey.
std::vector<uint8_t> difference_picture(const std::vector<uint8_t>& picture,
                                        const std::vector<uint8_t>& reference) {
  std::vector<uint8_t> result(picture.size());
  for (size_t i = 0; i < picture.size(); ++i)
    result[i] = static_cast<uint8_t>(std::clamp(128 + int{picture[i]} - int{reference[i]}, 0, 255));
  return result;
}

nlohmann::json error_json(const render::ReferenceError& error) {
  return {{"pixels", error.pixels}, {"rmse", error.rmse}, {"bias", error.bias}, {"noise", error.noise}};
}

class ReferenceBench {
 public:
  ReferenceBench(const ScenarioOptions& scenario, const RunOptions& run, const ReferenceBenchOptions& options)
      : options_(options),
        experiment_(sim::make_experiment(load_scenario(scenario))),
        device_(run.device_options()),
        place_(first_sensor<sim::CameraConfig>(experiment_.scenario, "--camera", "a camera")),
        light_(sim::lighting_of(experiment_.scenario.environment, experiment_.plan)),
        effects_(sim::camera_effects(experiment_.plan)) {
    check_instant(0, options.tick, experiment_.scenario);
    const sim::NodeConfig& node = experiment_.scenario.nodes[place_.node];
    desc_ = sim::camera_desc(experiment_.scenario, node, node.sensors[place_.sensor],
                             experiment_.world->body_of_node[place_.node]);
    desc_.outputs = {};  // rgb, depth, ids
    desc_.parts = false;
    desc_.noise.reset();
    desc_.vignetting = {};
    find_still();
    gpu_ = std::make_unique<scene::GpuScene>(
        device_, experiment_.scene(),
        scene::GpuSceneOptions{.acceleration_structure = false,
                               .textures = sim::gpu_scene_options(experiment_.plan).textures});
    if (!lamp_factors_.empty()) gpu_->set_lamps(lamp_factors_);
    add_rows();
  }

  nlohmann::json measure() {
    const Clock::time_point begin = Clock::now();
    render::ReferenceOptions options;
    options.samples = options_.samples;
    options.paths.bounces = options_.bounces;
    options.paths.later_roughness = options_.later_roughness;
    options.paths.lamp_factors = lamp_factors_;
    options.seed = experiment_.scenario.seed;
    reference_ = render::trace_reference(experiment_.scene(), still_.bodies, light_, effects_, desc_,
                                         still_.local_from_sensor, options);
    const double seconds = seconds_since(begin);
    for (int64_t i = -options_.warm_up; i < int64_t{options_.pictures}; ++i)
      for (const auto& row : rows_) row->time(still_, i >= 0);
    select();
    select_lines();
    nlohmann::json result{{"scenario", experiment_.scenario.name},
                          {"device", device_.info().name},
                          {"driver", device_.info().driver},
                          {"camera", desc_.name},
                          {"width", desc_.width},
                          {"height", desc_.height},
                          {"samples", options_.samples},
                          {"bounces", options_.bounces},
                          {"later_roughness", options_.later_roughness},
                          {"seconds", seconds},
                          {"rows", nlohmann::json::array()}};
    for (const auto& row : rows_) result["rows"].push_back(compare(*row));
    return result;
  }

 private:
  void find_still() {
    const sim::Scenario& scenario = experiment_.scenario;
    const sim::Courses courses = sim::make_courses(scenario, *experiment_.world, 0);
    const sim::Moment moment =
        sim::moment_at(*experiment_.world, courses, sim::Clock(scenario.tick_rate_hz), options_.tick);
    still_.bodies.assign(moment.context.body_poses.begin(), moment.context.body_poses.end());
    if (moment.context.lamps_at) lamp_factors_ = moment.context.lamps_at(moment.context.time_s);
    const sim::SensorConfig& sensor = scenario.nodes[place_.node].sensors[place_.sensor];
    still_.local_from_sensor =
        experiment_.scene().to_local(moment.context.nodes[place_.node].pose) * sim::mount_pose(sensor.mount);
  }

  void add_rows() {
    const auto add = [&](const std::string& name, const render::CameraEffects& effects) {
      rows_.push_back(std::make_unique<ComparedRow>(*gpu_, name, light_, effects, desc_));
    };
    add("picture", effects_);
    const auto without = [&](const std::string& name, bool render::CameraEffects::*effect) {
      if (!(effects_.*effect)) return;
      render::CameraEffects effects = effects_;
      effects.*effect = false;
      add("without " + name, effects);
    };
    without("ambient occlusion", &render::CameraEffects::ambient_occlusion);
    without("contact occlusion", &render::CameraEffects::contact_occlusion);
    without("bounced light", &render::CameraEffects::bounced_light);
    without("glass", &render::CameraEffects::glass);
    without("panes", &render::CameraEffects::panes);
    without("specular", &render::CameraEffects::specular);
    without("static shadows", &render::CameraEffects::static_shadows);
    without("lamp shadows", &render::CameraEffects::lamp_shadows);
    without("beam shadows", &render::CameraEffects::beam_shadows);
    without(lines_name, &render::CameraEffects::thin_lines);
  }

  /// Chooses the pixels of each kind.
  void select() {
    const size_t pixels = reference_.coverage.size();
    scene_.assign(pixels, 0);
    shade_ = glossy_ = lines_ = scene_;
    for (size_t i = 0; i < pixels; ++i) {
      scene_[i] = reference_.coverage[i] >= 1.0f;
      shade_[i] = scene_[i] && reference_.key_share[i] < shade_share;
      glossy_[i] = scene_[i] && reference_.roughness[i] <= glossy_roughness;
    }
  }

  /// Chooses the pixels that thin lines change.
  void select_lines() {
    const auto bare =
        std::ranges::find(rows_, "without "s + lines_name, [](const auto& row) { return row->name(); });
    if (bare == rows_.end()) return;
    const std::vector<float> with = rows_.front()->radiance(still_).hdr,
                             without = (*bare)->radiance(still_).hdr;
    for (size_t i = 0; i < lines_.size(); ++i)
      lines_[i] = !std::equal(&with[3 * i], &with[3 * i] + 3, &without[3 * i]);
  }

  nlohmann::json compare(ComparedRow& row) {
    const render::CameraImages images = row.radiance(still_);
    const double saturation = render::saturation_luminance(double(images.ev100));
    const std::vector<uint8_t> picture = render::develop_radiance(images.hdr, saturation),
                               reference = render::develop_radiance(reference_.radiance, saturation);
    nlohmann::json json{{"name", row.name()}, {"cpu_ms", distribution(row.cpu())}};
    json["flip"] = sim::flip(picture_array(reference, desc_.width, desc_.height),
                             picture_array(picture, desc_.width, desc_.height))
                       .mean;
    json["scene"] = error_json(render::compare_with(reference_, images.hdr, scene_, saturation));
    json["shade"] = error_json(render::compare_with(reference_, images.hdr, shade_, saturation));
    json["glossy"] = error_json(render::compare_with(reference_, images.hdr, glossy_, saturation));
    json["lines"] = error_json(render::compare_with(reference_, images.hdr, lines_, saturation));
    if (!options_.folder.empty()) write(row.name(), picture, reference);
    return json;
  }

  void write(std::string name, const std::vector<uint8_t>& picture, const std::vector<uint8_t>& reference) {
    std::filesystem::create_directories(options_.folder);
    std::ranges::replace(name, ' ', '_');
    const auto png = [&](const std::string& file, const std::vector<uint8_t>& rgb) {
      io::write_file_atomically(
          options_.folder / file,
          io::encode_png(picture_array(rgb, desc_.width, desc_.height), io::PngCoding::small));
    };
    if (rows_.front()->name() == name) {
      png("reference.png", reference);
      io::write_file_atomically(
          options_.folder / "reference.exr",
          io::encode_exr(Array::of<float>({desc_.height, desc_.width, 3}, reference_.radiance), 6));
    }
    png(name + ".png", picture);
    png(name + "-difference.png", difference_picture(picture, reference));
  }

  ReferenceBenchOptions options_;
  sim::Experiment experiment_;
  gpu::Device device_;
  sim::SensorPlace place_;
  render::Lighting light_;
  render::CameraEffects effects_;
  render::CameraDesc desc_;
  Still still_;
  std::vector<float> lamp_factors_;  ///< of the switched lamps at that instant
  std::unique_ptr<scene::GpuScene> gpu_;
  std::vector<std::unique_ptr<ComparedRow>> rows_;
  render::ReferencePicture reference_;
  std::vector<uint8_t> scene_, shade_, glossy_, lines_;  ///< by pixel: whether it counts
};

}  // namespace

nlohmann::json reference_bench(const ScenarioOptions& scenario, const RunOptions& run,
                               const ReferenceBenchOptions& options) {
  return ReferenceBench(scenario, run, options).measure();
}

std::string reference_bench_text(const nlohmann::json& result) {
  std::string text = fmt::format(
      "{}, {} of {} x {}, on {}\nreference: {} paths a pixel, up to {} bounces, later roughness {}, {:.1f} "
      "s\n"
      "{:<28} {:>8} {:>6} {:>21} {:>21} {:>21} {:>21}\n{:<28} {:>8} {:>6}",
      result["scenario"].get<std::string>(), result["camera"].get<std::string>(), result["width"].get<int>(),
      result["height"].get<int>(), result["device"].get<std::string>(), result["samples"].get<int>(),
      result["bounces"].get<int>(), result["later_roughness"].get<double>(), result["seconds"].get<double>(),
      "", "", "", "scene", "shade", "glossy", "lines", "", "cpu ms", "FLIP");
  for (int i = 0; i < 4; ++i) text += fmt::format(" {:>7}{:>7}{:>7}", "rmse %", "bias", "noise");
  text += "\n";
  for (const nlohmann::json& row : result["rows"]) {
    const nlohmann::json& cpu = row["cpu_ms"];
    text += fmt::format("{:<28} {:8.2f} {:6.3f}", row["name"].get<std::string>(),
                        cpu["count"].get<size_t>() > 0 ? cpu["min"].get<double>() : 0.0,
                        row["flip"].get<double>());
    for (const char* part : {"scene", "shade", "glossy", "lines"})
      text += fmt::format(" {:7.1f}{:+7.1f}{:7.1f}", 100.0 * row[part]["rmse"].get<double>(),
                          100.0 * row[part]["bias"].get<double>(), 100.0 * row[part]["noise"].get<double>());
    text += "\n";
  }
  return text;
}

}  // namespace greatx::apps
