// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The commands share this: from the command line to a scenario and a device.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "gpu/device.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/scenario.h"

namespace greatx::apps {

/// Options that choose and change a scenario.
struct ScenarioOptions {
  std::string scenario = "city";  ///< a file, or the name of an embedded one
  std::string assets;             ///< where its relative paths are looked for, beside its own folder
  std::optional<uint64_t> seed;
  std::optional<int64_t> ticks;
  std::optional<uint32_t> sequences;
  void add_to(CLI::App& command);
};

/// Options that choose the device.
struct RunOptions {
  std::string device;
  bool validation = false;
  void add_to(CLI::App& command);
  gpu::DeviceOptions device_options() const { return {device, validation}; }
};

/// Reads the scenario and applies the options.
sim::Scenario load_scenario(const ScenarioOptions& options);

/// Index of the channel of that name (--channel); of the first one if `name` is empty. Throws UserError.
uint32_t find_channel(const std::string& name, const sim::Scenario& scenario);

/// Throws UserError if the scenario has no such sequence (--sequence) or tick (--tick).
void check_instant(uint32_t sequence, int64_t tick, const sim::Scenario& scenario);

/// Throws if the validation layer had anything to say.
void check_validation(const gpu::Device& device);

}  // namespace greatx::apps
