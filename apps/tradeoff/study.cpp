// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/tradeoff/study.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include "apps/console/json_text.h"
#include "apps/console/progress.h"
#include "apps/tradeoff/report.h"
#include "apps/tradeoff/study_json.h"
#include "core/error.h"
#include "core/expected.h"
#include "core/hash.h"
#include "io/files/file.h"
#include "io/formats/png.h"

namespace greatx::apps {

namespace {

using Json = nlohmann::json;

/// Thrown by the progress of a measurement to stop it.
struct Stopped {};

Json json_of(const sim::SettingResult& result) {
  Json json{{"tick_ms", spread_json(result.wall_ms)},
            {"cpu_ms", spread_json(result.cpu_ms)},
            {"start_ms", sim::spread_of(result.start_ms).median},
            {"exact", result.exact},
            {"errors", Json::array()}};
  for (const sim::SensorError& error : result.errors)
    json["errors"].push_back({{"sensor", error.sensor},
                              {"name", error.figure.name},
                              {"unit", error.figure.unit},
                              {"value", number(error.figure.value)},
                              {"meaning", error.figure.meaning}});
  return json;
}

/// Makes file names of names.
std::string file_name(std::string name) {
  for (char& c : name)
    if (c == ' ' || c == '/' || c == '.') c = '_';
  return name;
}

std::string duration(double seconds) {
  const auto whole = static_cast<int64_t>(seconds + 0.5);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

constexpr const char* how_measured =
    "Each knob was measured by itself, with the sensors of its modality alone. A tick was run under every "
    "setting before the next one, so that all settings meet the same ticks and the same state of the "
    "machine. "
    "A tick was run alone: it was submitted, waited for, and collected. Times are medians and quartiles over "
    "the ticks after the warm-up, of which slow settings have fewer; files are not written. Errors are those "
    "of the records against the records "
    "of the reference setting at the same ticks.";
}  // namespace

Study::Study(const ScenarioOptions& scenario, const RunOptions& run, const StudyOptions& options,
             std::filesystem::path folder)
    : scenario_options_(scenario),
      options_(options),
      folder_(std::move(folder)),
      device_(run.device_options()),
      whole_(sim::make_experiment(load_scenario(scenario))),
      started_(std::chrono::steady_clock::now()),
      begin_(started_) {
  read();
}

Json Study::fingerprint() const {
  const std::string& text = whole_.scenario.text;
  return {{"greatx", GREATX_VERSION},      {"scenario_sha256", sha256_hex(std::as_bytes(std::span(text)))},
          {"device", device_.info().name}, {"driver", device_.info().driver},
          {"quick", options_.quick},       {"blocks", options_.blocks},
          {"ticks", options_.ticks},       {"knob_s", options_.knob_s},
          {"joint_s", options_.joint_s}};
}

void Study::read() {
  const Json own = fingerprint();
  const std::filesystem::path file = folder_ / "tradeoff.json";
  if (std::filesystem::exists(file)) {
    report_ = Json::parse(io::read_text_file(file), nullptr, false);
    if (!report_.is_object() || !report_.contains("fingerprint") || !report_.contains("knobs"))
      throw_user_error("{}: expected the results of `greatx tradeoff`; take another folder", file.string());
    if (report_["fingerprint"] != own)
      throw_user_error(
          "{}: these are results of another scenario, device, version or choice of ticks; take another "
          "folder",
          file.string());
    return;
  }
  report_ = {{"format", 1},
             {"scenario", whole_.scenario.name},
             {"device", device_.info().name},
             {"driver", device_.info().driver},
             {"cores", std::thread::hardware_concurrency()},
             {"greatx", GREATX_VERSION},
             {"quick", options_.quick},
             {"fingerprint", own},
             {"how", how_measured},
             {"minutes", 0.0},
             {"knobs", Json::array()},
             {"absent", Json::array()},
             {"fronts", Json::array()}};
  for (const sim::AbsentKnob& absent : sim::absent_knobs())
    report_["absent"].push_back({{"name", absent.name}, {"why", absent.why}});
}

/// Adds the time since the last call to that of the study.
void Study::keep() {
  const auto now = std::chrono::steady_clock::now();
  report_["minutes"] =
      report_["minutes"].get<double>() + std::chrono::duration<double>(now - begin_).count() / 60.0;
  begin_ = now;
  io::write_file_atomically(folder_ / "tradeoff.json", json_text(report_));
}

bool Study::has_knob(std::string_view part, const std::string& name) const {
  return std::ranges::any_of(
      report_["knobs"], [&](const Json& knob) { return knob["modality"] == part && knob["name"] == name; });
}
bool Study::has_front(sim::Modality modality) const {
  return std::ranges::any_of(report_["fronts"],
                             [&](const Json& front) { return front["modality"] == sim::name_of(modality); });
}

bool Study::wants_part(std::string_view part) const {
  return options_.only.empty() || std::ranges::find(options_.only, part) != options_.only.end();
}
bool Study::wants_knob(const sim::Knob& knob) const {
  return options_.knobs.empty() || std::ranges::find(options_.knobs, knob.name) != options_.knobs.end();
}

std::optional<sim::Scenario> Study::scenario_of(std::string_view part, sim::Modality modality) const {
  if (!wants_part(part)) return {};
  std::optional<sim::Scenario> scenario = sim::alone(whole_.scenario, modality, scenario_options_.assets);
  if (!scenario && !options_.only.empty())
    throw_user_error("{}: --only {}: the scenario has no {}", whole_.scenario.name, part,
                     modality == sim::Modality::csi ? "channel" : "such sensor");
  return scenario;
}

std::vector<Study::Part> Study::parts() const {
  std::vector<Part> parts;
  for (const sim::Modality modality : sim::all_modalities) {
    std::optional<sim::Scenario> scenario = scenario_of(sim::name_of(modality), modality);
    if (!scenario) continue;
    Part part{modality, sim::make_experiment(std::move(*scenario), whole_), {}};
    part.knobs = sim::knobs_of(part.experiment, modality, options_.quick);
    parts.push_back(std::move(part));
  }
  return parts;
}

std::optional<Study::MapPart> Study::maps() const {
  std::optional<sim::Scenario> scenario = scenario_of(map_part, sim::Modality::csi);
  if (!scenario) return {};
  sim::Experiment experiment = sim::make_experiment(std::move(*scenario), whole_);
  sim::MapStudy study = sim::plan_map_study(experiment, options_.quick);
  sim::Knob knob = sim::map_knob(study);
  return MapPart{std::move(experiment), std::move(study), std::move(knob)};
}

void Study::say(const std::string& text) const {
  if (options_.quiet) return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  const auto done = static_cast<double>(done_), all = static_cast<double>(all_);
  std::cerr << fmt::format("[{:3.0f} %, {} min left] {}\n", 100.0 * done / all,
                           duration(seconds * (all - done) / std::max(1.0, done)), text);
}

std::vector<sim::SettingResult> Study::measure(const std::vector<sim::Experiment>& settings, size_t reference,
                                               const Part& part, double most_s) {
  sim::MeasurePlan plan = sim::plan_blocks(part.experiment.scenario, options_.blocks, options_.ticks);
  plan.most_ms = 1e3 * most_s;
  // Settings that lose paths on purpose would warn of each one.
  const spdlog::level::level_enum level = spdlog::get_level();
  if (level == spdlog::level::info) spdlog::set_level(spdlog::level::err);
  const std::shared_ptr<void> restored(nullptr, [level](void*) { spdlog::set_level(level); });
  std::vector<sim::SettingResult> results =
      sim::measure_settings(device_, settings, reference, sim::kind_of(part.modality), plan, [](double) {
        if (interrupted()) throw Stopped();
      });
  check_validation(device_);
  return results;
}

std::string Study::keep_picture(const sim::SettingResult& result, std::string_view kind,
                                const std::string& name) const {
  for (size_t i = 0; i < result.specs.size(); ++i) {
    if (result.specs[i].kind != kind) continue;
    const auto record = std::ranges::find(result.last.records, static_cast<uint32_t>(i), &Record::sensor);
    if (record == result.last.records.end()) return {};
    const Array picture = picture_of(result.specs[i], *record);
    if (picture.bytes.empty()) return {};
    const std::string file = "pictures/" + name + ".png";
    io::write_file_atomically(folder_ / file, io::encode_png(picture));
    return file;
  }
  return {};
}

void Study::add_knob(std::string_view part, std::string_view kind, const sim::Knob& knob,
                     const std::function<sim::KnobResult()>& measure) {
  Json json{{"name", knob.name},
            {"modality", part},
            {"timed", knob.timed},
            {"about", knob.about},
            {"context", knob.context},
            {"unit", knob.unit},
            {"reference", knob.settings.empty() ? "" : knob.settings[knob.reference].label},
            {"default", knob.standard ? knob.settings[*knob.standard].label : ""},
            {"skipped", knob.skipped},
            {"settings", Json::array()}};
  const auto begin = std::chrono::steady_clock::now();
  std::string words = knob.skipped;
  if (knob.skipped.empty()) try {
      const sim::KnobResult measured = measure();
      const std::vector<sim::SettingResult>& results = measured.results;
      if (!measured.refused.empty()) {
        json["reference"] = knob.settings[measured.reference].label;
        json["about"] = fmt::format("{} (without finer settings: {})", knob.about, measured.refused);
      }
      const bool differs = std::ranges::any_of(results, [](const auto& result) { return !result.exact; });
      for (const SensorSpec& spec : results.front().specs)
        if (spec.kind == kind) json["legend"] = legend_of(spec);
      std::vector<std::string> said;
      for (size_t i = 0; i < results.size(); ++i) {
        Json setting = json_of(results[i]);
        setting["label"] = knob.settings[i].label;
        setting["value"] = knob.settings[i].value ? Json(*knob.settings[i].value) : Json(nullptr);
        setting["picture"] =
            differs ? keep_picture(results[i], kind, file_name(fmt::format("{}-{}-{}", part, knob.name, i)))
                    : "";
        said.push_back(
            fmt::format("{}: {:.1f} ms", knob.settings[i].label, setting["tick_ms"]["median"].get<double>()));
        if (!results[i].exact && !results[i].errors.empty())
          said.back() += fmt::format(" {:.3g} {}", results[i].errors.front().figure.value,
                                     results[i].errors.front().figure.unit);
        json["settings"].push_back(std::move(setting));
      }
      words = fmt::format("{}", fmt::join(said, ", "));
    } catch (const UserError& error) {
      json["skipped"] = words = fmt::format("cannot be set here: {}", error.what());
      json["settings"] = Json::array();
    }
  report_["knobs"].push_back(std::move(json));
  keep();
  ++done_;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  say(fmt::format("{} {} ({:.1f} s): {}", part, knob.name, seconds, words));
}

void Study::measure_knob(const Part& part, const sim::Knob& knob) {
  add_knob(sim::name_of(part.modality), sim::kind_of(part.modality), knob, [&] {
    return sim::measure_knob(part.experiment, knob, whole_, scenario_options_.assets,
                             [&](const auto& settings, size_t reference) {
                               return measure(settings, reference, part, options_.knob_s);
                             });
  });
}

void Study::measure_maps(const MapPart& part) {
  add_knob(map_part, map_part, part.knob, [&] {
    sim::KnobResult result{
        sim::measure_maps(device_, part.experiment, part.study, [] { return !interrupted(); }),
        part.knob.reference,
        {}};
    if (result.results.empty()) throw Stopped();
    check_validation(device_);
    return result;
  });
}

void Study::check_names(const std::vector<Part>& parts, const std::optional<MapPart>& maps) const {
  std::vector<std::string> known;
  for (const Part& part : parts)
    for (const sim::Knob& knob : part.knobs) known.push_back(knob.name);
  if (maps) known.push_back(maps->knob.name);
  for (const std::string& name : options_.knobs)
    if (std::ranges::find(known, name) == known.end())
      throw_user_error("--knob: {}", expected_one_of(known, name));
}

bool Study::run() {
  std::filesystem::create_directories(folder_ / "pictures");
  const std::vector<Part> all = parts();
  const std::optional<MapPart> map = maps();
  check_names(all, map);
  const auto is_due = [&](std::string_view part, const sim::Knob& knob) {
    return wants_knob(knob) && !has_knob(part, knob.name);
  };
  const auto front_is_due = [&](const Part& part) {
    return options_.knobs.empty() && !has_front(part.modality);
  };
  const bool map_is_due = map && is_due(map_part, map->knob);
  all_ = map_is_due;
  for (const Part& part : all) {
    for (const sim::Knob& knob : part.knobs) all_ += is_due(sim::name_of(part.modality), knob);
    all_ += front_is_due(part);
  }
  try {
    if (map_is_due) measure_maps(*map);
    for (const Part& part : all) {
      for (const sim::Knob& knob : part.knobs)
        if (is_due(sim::name_of(part.modality), knob)) measure_knob(part, knob);
      if (front_is_due(part)) measure_front(part);
    }
  } catch (const Stopped&) {
    return false;
  }
  keep();
  return true;
}

}  // namespace greatx::apps
