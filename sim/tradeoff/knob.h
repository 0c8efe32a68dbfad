// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The knobs of a scenario that trade time for accuracy, as changes of its text. Data flows one way:
//
//   Scenario ─► alone() ─► knobs_of() ─► experiments_of() ─► measure_settings() ─► front_of()
//
// alone() leaves the sensors of one modality; the records of a sensor do not depend on other sensors. A
// setting of a knob is a change that a user could write, so the parser checks it like any other text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields/edit_yaml.h"
#include "sim/experiment/experiment.h"

namespace greatx::sim {

enum class Modality : uint8_t { csi, camera, events, lidar, radar };
inline constexpr Modality all_modalities[] = {Modality::csi, Modality::camera, Modality::events,
                                              Modality::lidar, Modality::radar};
/// "csi", "camera", "events", "lidar", "radar".
std::string_view name_of(Modality modality);
/// SensorSpec::kind of the records that the modality is judged by.
std::string_view kind_of(Modality modality);
/// Returns none for an unknown name.
std::optional<Modality> modality_of(std::string_view name);

/// One setting of a knob.
struct Setting {
  std::string label;            ///< "3", "on", "rays 2^15"
  std::optional<double> value;  ///< for an axis; none: the knob has names
  std::vector<YamlChange> changes;
};

struct Knob {
  std::string name;     ///< of the field or the effect: "max_depth"
  std::string about;    ///< one line
  std::string unit;     ///< of the values; may be empty
  std::string context;  ///< in words: what is set beside it for all of its settings; may be empty
  std::vector<YamlChange> context_changes;
  std::vector<Setting> settings;
  size_t reference = 0;            ///< index of the exhaustive or finest setting
  std::optional<size_t> standard;  ///< index of the scenario's own setting, if it is one of them
  std::string skipped;             ///< why it is not measured; empty: it is
  std::string timed = "tick";      ///< what a time is of: "tick", or "map" (map_study.h)
};

/// Whether a knob switches one effect: its settings are off and on, and `auto` between where that differs.
bool is_effect(const Knob& knob);

/// Whether the scenario has sensors of the modality, or a channel.
bool has(const Scenario& scenario, Modality modality);

/// Returns the scenario with the sensors of one modality alone, and without the consistency check. Antennas
/// stay. An event camera keeps the camera whose pixels it has. None if it has no such sensor.
std::optional<Scenario> alone(const Scenario& scenario, Modality modality,
                              const std::filesystem::path& assets);

/// Returns the knobs of a scenario that alone() has made, in the order of the report. `quick` leaves out what
/// costs many times the default.
std::vector<Knob> knobs_of(const Experiment& experiment, Modality modality, bool quick);

/// Parses the scenario's text with changes. Throws UserError if the parser refuses it.
Scenario changed(const Scenario& scenario, const std::vector<YamlChange>& changes,
                 const std::filesystem::path& assets);

/// A name that a reader may look for, and why it is not a knob.
struct AbsentKnob {
  const char *name, *why;
};
std::vector<AbsentKnob> absent_knobs();

}  // namespace greatx::sim
