// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A study of what accuracy costs: every knob of a scenario by itself, then joint settings. It is kept in
// DIR/tradeoff.json, knob by knob, so that an interrupted study goes on.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"
#include "sim/tradeoff/knob.h"
#include "sim/tradeoff/map_study.h"
#include "sim/tradeoff/measure.h"

namespace greatx::apps {

/// The part of a study with radio maps. The other parts have the names of modalities.
inline constexpr std::string_view map_part = "map";

struct StudyOptions {
  bool quick = false;              ///< fewer ticks, no knobs that cost many times the default
  std::vector<std::string> only;   ///< names of parts; empty: all that the scenario has
  std::vector<std::string> knobs;  ///< by name; empty: all
  int64_t blocks = 2, ticks = 4;   ///< timed: so many blocks of so many ticks
  size_t joint = 8;                ///< joint settings that are measured for each modality
  /// A knob ends early after so long, when each setting has two timed ticks; see MeasurePlan.
  double knob_s = 8.0;
  /// The same of the joint settings of a modality. Knobs whose references together would take longer than
  /// that go no further than the scenario's own setting.
  double joint_s = 40.0;
  bool quiet = false;
};

struct JointKnobs;  // study_front.cpp

class Study {
 public:
  /// Reads what an earlier call has left in `folder`. Throws UserError if that is of another scenario, device
  /// or choice of ticks.
  Study(const ScenarioOptions& scenario, const RunOptions& run, const StudyOptions& options,
        std::filesystem::path folder);
  /// Measures what is missing, and keeps each result at once. Returns false if it was interrupted. Throws
  /// UserError if `options.knobs` has a name that no modality has.
  bool run();
  /// Returns the report, whose fields write_report() describes (apps/tradeoff/report.h).
  const nlohmann::json& report() const { return report_; }

 private:
  /// One modality of the scenario.
  struct Part {
    sim::Modality modality;
    sim::Experiment experiment;
    std::vector<sim::Knob> knobs;
  };
  /// The maps of the first channel.
  struct MapPart {
    sim::Experiment experiment;
    sim::MapStudy study;
    sim::Knob knob;
  };
  bool wants_part(std::string_view part) const;
  bool wants_knob(const sim::Knob& knob) const;
  /// Returns the scenario with the sensors of one modality, if it is asked for. Throws UserError if it is
  /// asked for by name and the scenario has none.
  std::optional<sim::Scenario> scenario_of(std::string_view part, sim::Modality modality) const;
  std::vector<Part> parts() const;
  std::optional<MapPart> maps() const;
  void check_names(const std::vector<Part>& parts, const std::optional<MapPart>& maps) const;
  nlohmann::json fingerprint() const;
  void read();
  void keep();
  bool has_knob(std::string_view part, const std::string& name) const;
  bool has_front(sim::Modality modality) const;
  /// Measurements end early after `most_s`.
  std::vector<sim::SettingResult> measure(const std::vector<sim::Experiment>& settings, size_t reference,
                                          const Part& part, double most_s);
  /// Measures a knob by `measure` and keeps its results. Pictures are those of sensors of `kind`.
  void add_knob(std::string_view part, std::string_view kind, const sim::Knob& knob,
                const std::function<sim::KnobResult()>& measure);
  void measure_knob(const Part& part, const sim::Knob& knob);
  void measure_maps(const MapPart& part);
  void measure_front(const Part& part);
  /// Measures joint settings together; the last two are the scenario's own and the finest one. Returns the
  /// "points" of the report.
  nlohmann::json measure_joint(const Part& part, const JointKnobs& joint, const std::string& figure);
  std::string keep_picture(const sim::SettingResult& result, std::string_view kind,
                           const std::string& name) const;
  void say(const std::string& text) const;

  const ScenarioOptions scenario_options_;
  const StudyOptions options_;
  const std::filesystem::path folder_;
  gpu::Device device_;
  const sim::Experiment whole_;
  nlohmann::json report_;
  size_t done_ = 0, all_ = 1;  ///< steps of this call
  const std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point begin_;  ///< of what the report's time does not count yet
};

}  // namespace greatx::apps
