// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Functions that the commands share: they turn the command line into a scenario and a device.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "gpu/device.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/scenario.h"

namespace greatx::apps {

/// Holds the options that choose and change a scenario.
struct ScenarioOptions {
  std::string scenario = "city";  ///< a file, or the name of an embedded scenario
  std::string assets;             ///< folder for relative paths that are not found beside the scenario
  std::optional<uint64_t> seed;
  std::optional<int64_t> ticks;
  std::optional<uint32_t> sequences;
  std::vector<std::string> set;  ///< "path=value", in this order, before the options above
  void add_to(CLI::App& command);
};

/// Holds the options that choose the device.
struct RunOptions {
  std::string device;
  bool validation = false;
  gpu::Tracer tracer = gpu::Tracer::automatic;
  void add_to(CLI::App& command);
  gpu::DeviceOptions device_options() const { return {device, validation, tracer}; }
};

/// Reads the scenario and applies the options. If the scenario gives errors or a time budget and the command
/// does not choose settings (`chooses`), it warns. Throws UserError if there is no such scenario.
sim::Scenario load_scenario(const ScenarioOptions& options, bool chooses = false);

/// Returns the folder in which a scenario's relative paths are looked for last: that of --assets, else its
/// own.
std::string assets_folder(const ScenarioOptions& options);

/// Returns the index of the channel `name` (--channel), or of the first one if `name` is empty. Throws
/// UserError if there is no such channel.
uint32_t find_channel(const std::string& name, const sim::Scenario& scenario);

/// Throws UserError if the scenario does not have the sequence (--sequence) or the tick (--tick).
void check_instant(uint32_t sequence, int64_t tick, const sim::Scenario& scenario);

/// Throws runtime_error if the validation layer has reported anything.
void check_validation(const gpu::Device& device);

}  // namespace greatx::apps
