// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/calibration/resolve.h"

#include <chrono>
#include <cmath>
#include <iostream>
#include <span>
#include <thread>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "apps/console/json_text.h"
#include "apps/console/progress.h"
#include "core/cache_folder.h"
#include "core/error.h"
#include "core/hash.h"
#include "io/files/file.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/tradeoff/calibration/calibration.h"

namespace greatx::apps {

namespace {

using Json = nlohmann::json;

std::string hash_of(const std::string& text) { return sha256_hex(std::as_bytes(std::span(text))); }

Json fingerprint_of(const sim::Experiment& experiment, const gpu::Device& device) {
  return {{"greatx", GREATX_VERSION},
          {"scenario_sha256", hash_of(experiment.scenario.text)},
          {"scene_sha256", experiment.scene().hash},
          {"device", device.info().name},
          {"driver", device.info().driver},
          {"processors", std::thread::hardware_concurrency()}};
}

/// JSON has no infinity and no NaN: null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json json_of(const sim::Spread& spread) {
  return {{"median", spread.median}, {"low", spread.low}, {"high", spread.high}};
}

Json json_of(const sim::CalibratedPart& part) {
  Json json{{"modality", sim::name_of(part.modality)},
            {"reference", part.reference},
            {"finest", part.finest},
            {"chosen", Json::array()},
            {"kept", Json::array()},
            {"errors", Json::array()},
            {"figures", Json::array()},
            {"tick_ms",
             {{"chosen", json_of(part.chosen_ms)},
              {"own", json_of(part.own_ms)},
              {"reference", json_of(part.reference_ms)}}},
            {"checked_ticks", part.checked_ticks},
            {"met_ticks", part.met_ticks},
            {"least_share", sim::least_share(part.met_ticks, part.checked_ticks)}};
  for (const sim::ChosenSetting& chosen : part.chosen)
    json["chosen"].push_back({{"knob", chosen.knob}, {"own", chosen.own}, {"chosen", chosen.chosen}});
  for (const sim::KeptKnob& kept : part.kept)
    json["kept"].push_back({{"knob", kept.knob}, {"why", kept.why}});
  for (const sim::TargetOutcome& outcome : part.outcomes) {
    json["errors"].push_back({{"name", outcome.target.kind->name},
                              {"unit", outcome.target.kind->unit},
                              {"asked", outcome.target.asked},
                              {"allowed", outcome.target.value},
                              {"checked", number(outcome.validated)},
                              {"own", number(outcome.own)}});
    if (!std::isnan(outcome.calibrated)) json["errors"].back()["calibrated"] = number(outcome.calibrated);
  }
  for (const sim::SensorError& error : part.errors)
    json["figures"].push_back({{"sensor", error.sensor},
                               {"name", error.figure.name},
                               {"unit", error.figure.unit},
                               {"value", number(error.figure.value)}});
  return json;
}

Json wish_of(const sim::Scenario& scenario) {
  Json wish = Json::object();
  for (const sim::AccuracyTarget& target : scenario.accuracy.targets) wish[target.kind->name] = target.value;
  if (scenario.accuracy.budget_ms > 0.0) wish["time_budget_ms_per_tick"] = scenario.accuracy.budget_ms;
  return wish;
}

/// Returns the calibration in a file if it is whole and, unless `fingerprint` is null, of this fingerprint.
Json read(const std::filesystem::path& file, const Json& fingerprint) {
  std::error_code error;
  if (file.empty() || !std::filesystem::is_regular_file(file, error)) return nullptr;
  Json json = Json::parse(io::read_text_file(file), nullptr, false);
  const bool whole = json.is_object() && json.contains("fingerprint") && json["fingerprint"].is_object() &&
                     json.contains("parts") && json.contains("wish") && json.contains("scenario") &&
                     json["scenario"].is_string();
  if (!whole) {
    spdlog::warn("{}: expected a calibration; it is left aside", file.string());
    return nullptr;
  }
  return json["fingerprint"] == fingerprint ? json : Json(nullptr);
}

/// What is kept in the cache is an advantage and no more: a folder that cannot be written is reported.
void store(const std::filesystem::path& file, const Json& json) try {
  if (file.empty()) return;
  std::filesystem::create_directories(file.parent_path());
  io::write_file_atomically(file, json_text(json));
} catch (const std::exception& error) {
  spdlog::warn("the calibration is not kept: {}", error.what());
}

Json calibrated(const sim::Experiment& experiment, gpu::Device& device, const std::filesystem::path& assets,
                const Json& fingerprint, bool quiet) {
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  // Settings that lose paths on purpose would warn of each one.
  const spdlog::level::level_enum level = spdlog::get_level();
  if (level == spdlog::level::info) spdlog::set_level(spdlog::level::err);
  const std::shared_ptr<void> restored(nullptr, [level](void*) { spdlog::set_level(level); });
  const sim::Calibration calibration =
      sim::calibrate(device, experiment, assets, [&](const std::string& words) {
        if (interrupted()) throw Interrupted("the calibration was interrupted; nothing is kept");
        if (!quiet && !words.empty())
          std::cerr << fmt::format("calibration [{:4.0f} s] {}\n", seconds(), words);
      });
  Json json{{"fingerprint", fingerprint},
            {"wish", wish_of(experiment.scenario)},
            {"minutes", seconds() / 60.0},
            {"parts", Json::array()},
            {"scenario", ""}};
  // The text says for whom it was chosen, and holds no times: equal choices give equal texts.
  json["scenario"] = fmt::format("# Settings chosen by greatx {} on {} for {}\n{}", GREATX_VERSION,
                                 device.info().name, json["wish"].dump(), calibration.text);
  if (calibration.budget_ms > 0.0) json["tick_ms"] = json_of(calibration.tick_ms);
  for (const sim::CalibratedPart& part : calibration.parts) json["parts"].push_back(json_of(part));
  return json;
}

}  // namespace

Resolved resolve(const sim::Experiment& experiment, gpu::Device& device, const std::filesystem::path& assets,
                 const std::filesystem::path& kept, bool again, bool quiet) {
  const Json fingerprint = fingerprint_of(experiment, device);
  const std::filesystem::path folder = cache_folder();
  const std::filesystem::path cached =
      folder.empty() ? folder : folder / "calibration" / (hash_of(fingerprint.dump()) + ".json");
  Resolved resolved;
  if (!again) {
    resolved.json = read(kept, fingerprint);
    resolved.source = kept.string();
    if (resolved.json.is_null()) resolved.json = read(cached, fingerprint), resolved.source = "cache";
  }
  if (resolved.json.is_null()) {
    resolved.json = calibrated(experiment, device, assets, fingerprint, quiet);
    resolved.source = "calibrated";
    store(cached, resolved.json);
  }
  const sim::Scenario& before = experiment.scenario;
  const bool embedded = before.file.empty();
  resolved.scenario = sim::parse_scenario(resolved.json["scenario"].get<std::string>(),
                                          embedded ? before.name + ".yaml" : before.file.string(),
                                          embedded ? "." : before.file.parent_path(), assets);
  resolved.scenario.file = before.file;
  return resolved;
}

}  // namespace greatx::apps
