// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The table of knobs. Each function adds the knobs of one modality; their settings surround the value that
// the scenario has, and the last one is the finest unless the row says otherwise.
#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/fields/yaml.h"
#include "sim/scenario/sensor_kinds.h"
#include "sim/tradeoff/knob.h"

namespace greatx::sim {

namespace {

YamlChange set(YamlPath path, std::string value) {
  return {YamlChange::Kind::set, std::move(path), std::move(value)};
}
YamlChange effect_change(const std::string& name, bool on) {
  return set({"effects", name}, on ? "on" : "off");
}
YamlPath below(YamlPath path, const YamlPath& field) {
  path.insert(path.end(), field.begin(), field.end());
  return path;
}

/// What the rows below need of a scenario, and where they add knobs.
class Table {
 public:
  Table(const Experiment& experiment, Modality modality, bool quick)
      : experiment_(experiment), modality_(modality), quick_(quick) {
    const std::vector<NodeConfig>& nodes = experiment.scenario.nodes;
    for (size_t n = 0; n < nodes.size(); ++n)
      for (size_t s = 0; s < nodes[n].sensors.size(); ++s)
        if (sensor_kind(nodes[n].sensors[s]).type == kind_of(modality)) {
          places_.push_back({"nodes", n, "sensors", s});
          sensors_.push_back(&nodes[n].sensors[s]);
        }
    if (modality != Modality::csi) return;
    places_.clear();
    for (size_t c = 0; c < experiment.scenario.channels.size(); ++c) places_.push_back({"channels", c});
  }

  const Scenario& scenario() const { return experiment_.scenario; }
  const EffectPlan& plan() const { return experiment_.plan; }
  bool quick() const { return quick_; }
  const std::vector<YamlPath>& places() const { return places_; }
  template <typename Config>
  const Config& config(size_t i) const {
    return std::get<Config>(sensors_[i]->config);
  }
  /// Whether the text of place i has the field.
  bool has(size_t i, const std::string& field) const {
    return value_at(read_yaml(scenario().text, scenario().name), below(places_[i], {field})) != nullptr;
  }
  template <typename Config>
  const Config& first() const {
    return config<Config>(0);
  }
  /// Sets a field of every channel, or of every sensor of the modality.
  std::vector<YamlChange> everywhere(const YamlPath& field, const std::string& value) const {
    std::vector<YamlChange> changes;
    for (const YamlPath& place : places_) changes.push_back(set(below(place, field), value));
    return changes;
  }
  /// Whether the materials of the scene scatter.
  bool scatters() const {
    return std::ranges::any_of(experiment_.scene().materials, [](const scene::Material& material) {
      return material.radio && material.radio->scattering_coefficient > 0.0;
    });
  }

  Knob& add(std::string name, std::string about, std::string unit = "") {
    knobs_.push_back({std::move(name), std::move(about), std::move(unit), {}, {}, {}, 0, {}, {}, "tick"});
    return knobs_.back();
  }
  /// Adds numbers of one field, the last of which is the reference.
  Knob& add_numbers(const std::string& name, const YamlPath& field, std::vector<double> values, double own,
                    const std::string& about, const std::string& unit = "") {
    Knob& knob = add(name, about, unit);
    for (const double value : values) {
      if (value == own) knob.standard = knob.settings.size();
      const std::string text = fmt::format("{:g}", value);
      knob.settings.push_back({text, value, everywhere(field, text)});
    }
    knob.reference = knob.settings.size() - 1;
    return knob;
  }
  /// Adds an effect; on is the reference. One that `auto` applies to some links alone has that between.
  void add_effect(const Effect& effect, const std::string& about) {
    Knob& knob = add(effect.name, about);
    knob.settings.push_back({"off", {}, {effect_change(effect.name, false)}});
    if (effect.on && by_link(effect.name))
      knob.settings.push_back({"auto", {}, {set({"effects", effect.name}, "auto")}});
    knob.settings.push_back({"on", {}, {effect_change(effect.name, true)}});
    knob.reference = knob.settings.size() - 1;
    knob.standard = effect.on ? 1 : 0;
    if (!effect.on && effect.bound.empty() && !asked_for(effect.name))
      knob.skipped = "nothing to act on: " + effect.reason;
  }
  /// Leaves a knob out of a quick study.
  void skip_if_quick(const std::string& name, const std::string& what) {
    for (Knob& knob : knobs_)
      if (quick_ && knob.name == name && knob.skipped.empty())
        knob.skipped = "left out of a quick study: it costs " + what;
  }
  /// Sets something beside all settings of a knob.
  static void within(Knob& knob, std::string words, std::vector<YamlChange> changes) {
    knob.context = std::move(words);
    knob.context_changes = std::move(changes);
  }
  std::vector<Knob> take() { return std::move(knobs_); }

 private:
  /// Whether `auto` applies the effect to a few links alone, and `on` to all of them.
  bool by_link(const std::string& name) const {
    const auto wish = scenario().effects.find(name);
    return name == "every_element" && (wish == scenario().effects.end() || wish->second != Switch::on);
  }
  /// Effects that `auto` leaves off although they may have something to act on.
  static bool asked_for(const std::string& name) {
    static const std::set<std::string> names{"diffraction", "free_edges",    "scattering",
                                             "dispersion",  "radar_clutter", "moving_reflectors"};
    return names.contains(name);
  }

  const Experiment& experiment_;
  const Modality modality_;
  const bool quick_;
  std::vector<YamlPath> places_;
  std::vector<const SensorConfig*> sensors_;
  std::vector<Knob> knobs_;
};

/// Returns 0, 1, ... up to `last`.
std::vector<double> up_to(uint32_t last) {
  std::vector<double> values;
  for (uint32_t i = 0; i <= last; ++i) values.push_back(i);
  return values;
}

/// Returns own * factor for each factor, rounded to whole numbers if `whole`, ascending and each once.
std::vector<double> around(double own, const std::vector<double>& factors, bool whole) {
  std::set<double> values;
  for (const double factor : factors) values.insert(whole ? std::round(own * factor) : own * factor);
  return {values.begin(), values.end()};
}
std::vector<double> descending(std::vector<double> values) {
  std::ranges::sort(values, std::greater());
  return values;
}

void add_search(Table& table, const ChannelConfig& channel) {
  const uint32_t depth = channel.limits.max_depth;
  table.add_numbers("max_depth", {"max_depth"},
                    up_to(std::min(16u, std::max(depth + (table.quick() ? 0 : 1), 3u))), depth,
                    "interactions of a path at most");
  if (table.plan().transmission.on && channel.walls() > 0)
    table.add_numbers("max_transmissions", {"max_transmissions"}, up_to(std::max(channel.walls(), 3u)),
                      channel.walls(), "transmissions of a path through walls at most");
  Knob& candidates = table.add("candidates", "rays that shoot and bounce, or beams that miss no path");
  for (const int power : {13, 15, 17, 19})
    candidates.settings.push_back({fmt::format("rays 2^{}", power), std::ldexp(1.0, power),
                                   table.everywhere({"rays"}, std::to_string(1 << power))});
  for (Setting& setting : candidates.settings)
    for (const YamlChange& change : table.everywhere({"candidates"}, "rays"))
      setting.changes.push_back(change);
  candidates.settings.push_back({"beams", {}, table.everywhere({"candidates"}, "beams")});
  candidates.reference = candidates.settings.size() - 1;
  if (channel.candidates == ChannelConfig::Candidates::beams) candidates.standard = candidates.reference;
  if (channel.candidates == ChannelConfig::Candidates::rays)
    candidates.skipped = "the scenario asks for rays";
  else if (table.plan().diffraction.on)
    candidates.skipped = "diffraction needs beams";
  else if (table.plan().every_element.on)
    Table::within(candidates, "every_element off, which needs beams",
                  {effect_change("every_element", false)});
  table.add_numbers("max_paths", {"max_paths"}, {1, 4, 16, 64, 100000},
                    static_cast<double>(channel.limits.max_paths),
                    "geometric paths of a link and tick at most");
}

void add_scattering(Table& table, const ChannelConfig& channel) {
  const std::vector<YamlChange> on{effect_change("scattering", true)};
  const auto add = [&](Knob& knob) {
    if (!table.plan().scattering.on) Table::within(knob, "with scattering", on);
    if (!table.scatters()) knob.skipped = "no material has a scattering coefficient";
  };
  add(table.add_numbers("scattering_patch_m", {"scattering_patch_m"},
                        descending(around(channel.limits.patch_m, {8, 4, 2, 1}, false)),
                        channel.limits.patch_m, "longest side of the pieces that scatter as one", "m"));
  const uint32_t budget = channel.limits.scattering_budget;
  std::vector<double> budgets = around(budget > 0 ? budget : 4000, {0.25, 0.5, 1, 2}, true);
  const bool two_bends = channel.limits.max_scatterings > 1 || channel.limits.scattering_beside_diffraction;
  if (!two_bends) budgets.push_back(0);  // such paths are only drawn
  add(table.add_numbers("scattering_budget", {"scattering_budget"}, std::move(budgets), budget,
                        "scatterings of a link that are traced, of which some stand for others; 0: all"));
  add(table.add_numbers("max_reflections_before_scattering", {"max_reflections_before_scattering"},
                        up_to(table.quick() ? 1 : 2), channel.limits.max_reflections_before_scattering,
                        "reflections between a scattering and the end that is searched from at most"));
  if (table.quick()) return;
  if (budget > 0)
    add(table.add_numbers("max_scatterings", {"max_scatterings"}, {1, 2}, channel.limits.max_scatterings,
                          "scatterings of a path at most"));
  const auto with_edges = [&](Knob& knob) {
    if (!table.plan().diffraction.on)
      Table::within(knob, "with diffraction", {effect_change("diffraction", true)});
  };
  with_edges(table.add_numbers("max_reflections_beside_diffraction", {"max_reflections_beside_diffraction"},
                               up_to(2), channel.limits.max_reflections_beside_diffraction,
                               "reflections on each side of a diffraction at most"));
  with_edges(table.add_numbers("max_diffractions", {"max_diffractions"}, {1, 2},
                               channel.limits.max_diffractions, "edges of a path at most"));
  with_edges(table.add_numbers("corner_step_db", {"corner_step_db"}, {0.1, 0.3, 1.0},
                               channel.limits.corner_step_db, "step of the field of an edge at its end, dB"));
}

void add_csi(Table& table) {
  const ChannelConfig& channel = table.scenario().channels.front();
  add_search(table, channel);
  const EffectPlan& plan = table.plan();
#define GREATX_ROW(name, may_switch, passed, documentation) \
  if (plan.name.switchable) table.add_effect(plan.name, documentation);
  GREATX_RADIO_EFFECTS(GREATX_ROW)
#undef GREATX_ROW
  table.skip_if_quick("every_element", "a search for each element");
  add_scattering(table, channel);
}

/// Pictures with other pixels, of the same field of view.
std::vector<YamlChange> scaled_pictures(const Table& table, double factor) {
  std::vector<YamlChange> changes;
  for (size_t i = 0; i < table.places().size(); ++i) {
    const auto& camera = table.config<CameraConfig>(i);
    const auto number = [&](const char* field, double value) {
      changes.push_back(set(below(table.places()[i], {field}), fmt::format("{}", value)));
    };
    const bool panorama = camera.wide.model == LensModel::equirectangular;  // exactly twice as wide as high
    const double height = std::round(factor * camera.height);
    number("width", panorama ? 2.0 * height : std::round(factor * camera.width));
    number("height", height);
    // Given in pixels they scale with the picture; a field of view stays as it is.
    if (table.has(i, "fx")) number("fx", factor * camera.fx), number("fy", factor * camera.fy);
    if (table.has(i, "cx")) number("cx", factor * camera.cx);
    if (table.has(i, "cy")) number("cy", factor * camera.cy);
  }
  return changes;
}

void add_resolution(Table& table) {
  Knob& knob =
      table.add("resolution", "pixels of the first picture's width, in the same field of view", "px");
  for (const double factor : {0.25, 0.5, 1.0, 2.0}) {
    const double width = std::round(factor * table.first<CameraConfig>().width);
    if (factor == 1.0) knob.standard = knob.settings.size();
    knob.settings.push_back({fmt::format("{:g}", width), width, scaled_pictures(table, factor)});
  }
  knob.reference = knob.settings.size() - 1;
}

/// Gives a shutter time to cameras that have none.
std::vector<YamlChange> with_shutter(const Table& table) {
  std::vector<YamlChange> changes;
  for (size_t i = 0; i < table.places().size(); ++i) {
    const Exposure& exposure = table.config<CameraConfig>(i).exposure;
    if (exposure.shutter_s) continue;
    if (table.has(i, "exposure_ev100"))
      changes.push_back({YamlChange::Kind::remove, below(table.places()[i], {"exposure_ev100"}), ""});
    const std::string how = exposure.automatic
                                ? fmt::format("auto: true, compensation_ev: {}", exposure.compensation_ev)
                                : fmt::format("ev100: {}", exposure.ev100);
    changes.push_back(
        set(below(table.places()[i], {"exposure"}), fmt::format("{{{}, shutter_s: 0.02}}", how)));
  }
  return changes;
}

void add_antialiasing(Table& table) {
  const auto& camera = table.first<CameraConfig>();
  Knob& knob = table.add("antialiasing", "how the edges of meshes are smoothed");
  for (const char* const name : {"none", "edges", "msaa4"})
    knob.settings.push_back({name, {}, table.everywhere({"antialiasing"}, name)});
  knob.reference = 2;
  knob.standard = camera.msaa > 1 ? 2 : camera.smooth_edges ? 1 : 0;
}

/// Adds the bands of rolling shutters, if every camera has one.
void add_rolling_shutter(Table& table, Knob& blur) {
  size_t rolling = 0;
  uint32_t most = 2048;
  for (size_t i = 0; i < table.places().size(); ++i) {
    const auto& camera = table.config<CameraConfig>(i);
    rolling += camera.rolling.any() ? 1 : 0;
    most = std::min(most, (camera.height + 7) / 8);
  }
  if (rolling > 0) blur.skipped = "a rolling shutter draws its own instants";
  if (rolling == 0 || rolling < table.places().size()) return;
  std::vector<double> values;
  for (uint32_t bands = 2; bands < most; bands *= 2) values.push_back(bands);
  values.push_back(most);
  table.add_numbers("rolling_shutter.bands", {"rolling_shutter", "bands"}, values,
                    table.first<CameraConfig>().rolling.bands, "bands of rows, each at its own instant");
}

void add_camera(Table& table) {
  const auto& camera = table.first<CameraConfig>();
  add_resolution(table);
  add_antialiasing(table);
  const EffectPlan& plan = table.plan();
#define GREATX_ROW(name, may_switch, passed, documentation) \
  if (plan.name.switchable) table.add_effect(plan.name, documentation);
  GREATX_CAMERA_EFFECTS(GREATX_ROW)
#undef GREATX_ROW
  Knob& blur =
      table.add_numbers("motion_blur_samples", {"motion_blur_samples"},
                        table.quick() ? std::vector<double>{3, 7, 15} : std::vector<double>{3, 7, 15, 31, 63},
                        camera.motion_blur_samples, "pictures that a blurred one is the mean of");
  const std::vector<YamlChange> shutter = with_shutter(table);
  if (!shutter.empty()) Table::within(blur, "with a shutter of 20 ms", shutter);
  add_rolling_shutter(table, blur);
}

void add_events(Table& table) {
  const uint32_t most = table.quick() ? 8 : 16;  // of adaptive steps
  Knob& even = table.add_numbers(
      "steps", {"steps"},
      table.quick() ? std::vector<double>{1, 2, 4, 8} : std::vector<double>{1, 2, 4, 8, 16, 32, 64}, 0,
      "evenly spaced pictures from one record to the next");
  const auto& events = table.first<EventCameraConfig>();
  for (size_t i = 0; i < even.settings.size(); ++i)
    if (events.steps == EventCameraConfig::Steps::fixed && even.settings[i].value == double(events.substeps))
      even.standard = i;
  const auto add = [&](const char* name, const char* by, const char* field, std::vector<double> values,
                       const char* about, const char* unit) {
    Knob& knob = table.add(name, about, unit);
    for (const double value : values)
      knob.settings.push_back({fmt::format("{:g}", value), value,
                               table.everywhere({"steps"}, fmt::format("{{by: {}, {}: {:g}, most: {}}}", by,
                                                                       field, value, most))});
    knob.settings.push_back(
        {fmt::format("{} even", most), {}, table.everywhere({"steps"}, std::to_string(most))});
    knob.reference = knob.settings.size() - 1;
  };
  add("steps by flow", "flow", "max_px", {8, 4, 2, 1, 0.5}, "adaptive steps: motion between pictures at most",
      "px");
  add("steps by brightness", "brightness", "max_change", {8, 4, 2, 1, 0.5},
      "adaptive steps: change of a pixel between pictures at most", "thresholds");
  Knob& pixel =
      table.add("steps by pixel", "reconstructed instants: motion of a pixel between two at most", "px");
  for (const double value : {4.0, 2.0, 1.0, 0.5, 0.25}) {
    if (events.steps == EventCameraConfig::Steps::by_pixel && events.max_flow_px == value)
      pixel.standard = pixel.settings.size();
    pixel.settings.push_back(
        {fmt::format("{:g}", value), value,
         table.everywhere({"steps"}, fmt::format("{{by: pixel, max_px: {:g}}}", value))});
  }
  pixel.settings.push_back({"64 even", {}, table.everywhere({"steps"}, "64")});
  pixel.reference = pixel.settings.size() - 1;
  for (const NodeConfig& node : table.scenario().nodes)
    for (const SensorConfig& sensor : node.sensors)
      if (const auto* camera = std::get_if<EventCameraConfig>(&sensor.config);
          camera && camera->distortion.any())
        pixel.skipped = "needs lenses without distortion";
  table.skip_if_quick("steps by pixel", "many steps");
  table.skip_if_quick("steps by flow", "many steps");
  table.skip_if_quick("steps by brightness", "many steps");
}

void add_lidar(Table& table) {
  const auto& lidar = table.first<LidarConfig>();
  Knob& rings = table.add_numbers("beam.rings", {"beam", "rings"}, {0, 1, 2, 3, 4}, lidar.rings,
                                  "rings of sub-rays over a beam's cross-section: 1 + 3 n (n + 1) rays");
  if (lidar.divergence == 0.0)
    Table::within(rings, "with a divergence of 3 mrad", table.everywhere({"beam", "divergence_mrad"}, "3"));
  const EffectPlan& plan = table.plan();
#define GREATX_ROW(name, may_switch, passed, documentation) \
  if (plan.name.switchable) table.add_effect(plan.name, documentation);
  GREATX_LIDAR_EFFECTS(GREATX_ROW)
#undef GREATX_ROW
}

/// Noise hides differences: maps are compared without it.
void add_radar(Table& table) {
  const auto& radar = table.first<RadarConfig>();
  const rf::EchoOptions& echoes = radar.echoes;
  const std::vector<double> finer{0.25, 0.5, 1, 2, 4};
  const auto add = [&](const char* field, std::vector<double> values, double own, const char* about,
                       const char* unit = "") {
    table.add_numbers(fmt::format("echoes.{}", field), {"echoes", field}, std::move(values), own, about,
                      unit);
  };
  add("tubes",
      around(echoes.tubes, table.quick() ? finer : std::vector<double>{0.25, 0.5, 1, 2, 4, 16}, true),
      echoes.tubes, "ray tubes over the field of view");
  add("max_bounces", {1, 2, 3, 4, 5}, echoes.max_bounces, "surfaces that a tube meets at most");
  add("updates", {1, 2, 4, 8}, radar.updates, "times that the scene is traced over a frame");
  add("merge_share", {0.5, 0.25, 0.125, 0.0625, 0}, echoes.merge_share,
      "how similar tubes are that become one echo");
  add("max_echoes", {64, 256, 1024, 4096, 65536}, echoes.max_echoes, "echoes that are kept");
  const EffectPlan& plan = table.plan();
#define GREATX_ROW(name, may_switch, passed, documentation) \
  if (plan.name.switchable) table.add_effect(plan.name, documentation);
  GREATX_RADAR_EFFECTS(GREATX_ROW)
#undef GREATX_ROW
}

/// Takes the noise away from a radar for all knobs but those of the noise itself.
void without_noise(std::vector<Knob>& knobs, const EffectPlan& plan) {
  std::vector<YamlChange> off;
  for (const Effect* const effect : {&plan.radar_noise, &plan.radar_phase_noise, &plan.radar_quantisation})
    if (effect->on) off.push_back(effect_change(effect->name, false));
  if (off.empty()) return;
  for (Knob& knob : knobs)
    if (knob.name != "radar_noise" && knob.name != "radar_phase_noise" && knob.name != "radar_quantisation")
      Table::within(knob, "without noise", off);
}

}  // namespace

std::vector<Knob> knobs_of(const Experiment& experiment, Modality modality, bool quick) {
  Table table(experiment, modality, quick);
  static constexpr void (*rows[])(Table&) = {add_csi, add_camera, add_events, add_lidar, add_radar};
  rows[static_cast<size_t>(modality)](table);
  std::vector<Knob> knobs = table.take();
  if (modality == Modality::radar) without_noise(knobs, experiment.plan);
  return knobs;
}

std::vector<AbsentKnob> absent_knobs() {
  return {
      {"clearance", "beams guarantee every path that keeps 0.5 mm from edges; this is a constant"},
      {"shadow maps",
       "their size follows from the scene; only static_shadows and moving_shadows are switched"},
      {"LiDAR tracer", "the device decides: a tree of greatx's own on a CPU's driver, else its ray queries"},
      {"fp32 against fp64", "no precision can be chosen: fields and paths are in fp64, pictures in fp32"},
      {"encoders", "files are lossless; the command greatx bench --rig measures the time of writing"}};
}

}  // namespace greatx::sim
