// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Records how data came to be: the program and its command line, the machine, the time, the losses. These
// facts differ from run to run, so they stand beside the data and not in dataset.json.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "gpu/device.h"

namespace greatx::apps {

/// Keeps the arguments of the program for records. Called once, by main().
void set_command_line(int argc, char** argv);

/// The record of one run of the program. It is written when the run begins and again when it ends, so that a
/// run that was killed has one, too, without an end.
class RunRecord {
 public:
  /// Begins a record: command line, folder, host, system, processor, memory, versions, begin (UTC).
  RunRecord();
  void set_device(const gpu::Device& device);
  /// Adds a member.
  void set(const std::string& name, nlohmann::json value) { json_[name] = std::move(value); }
  /// Adds end (UTC), seconds, whether the work is complete, and what was lost.
  void end(bool complete, const std::vector<std::string>& warnings);
  const nlohmann::json& json() const { return json_; }

  /// Puts the record into a file that has an object {"runs": [...]}, behind the records that are there; the
  /// second call replaces the first one's. A file that is no such object is replaced, with a warning.
  void write_to(const std::filesystem::path& file);
  /// Writes the record to a file of its own in `folder`, named by begin, host and process, so that machines
  /// which share the folder do not meet.
  void write_into(const std::filesystem::path& folder) const;

 private:
  nlohmann::json json_;
  std::string name_;
};

/// Returns a text of the last record that write_to() put into a file; empty if there is none.
std::string last_value(const std::filesystem::path& file, const std::string& name);

}  // namespace greatx::apps
