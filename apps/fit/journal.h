// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps the state of an unfinished fit, so that a stopped one goes on.
#pragma once

#include <filesystem>
#include <optional>

#include <nlohmann/json.hpp>

#include "sim/fit/solver.h"

namespace greatx::apps {

/// The file that describes a finished fit.
inline constexpr const char* fit_description = "fit.json";

/// Reads and writes FOLDER/fit.part, which holds the request and the state after the last iteration. It is
/// replaced as a whole.
class FitJournal {
 public:
  /// Opens a journal in a new or empty folder or, with `resume`, in the folder of a fit with the same
  /// request. Throws UserError, which names the folder, if it holds other files; if it holds a fit, finished
  /// or not, and `resume` is off; or if the fit in it has another request. The message names the first
  /// difference as a JSON pointer.
  FitJournal(const std::filesystem::path& folder, const nlohmann::ordered_json& request, bool resume);

  /// Whether the folder holds the finished fit.
  bool finished() const { return finished_; }
  /// Returns the state of the stopped fit.
  const std::optional<sim::FitState>& state() const { return state_; }
  void write(const sim::FitState& state);
  /// Removes the journal. Called when all files of the fit are in place.
  void finish();

 private:
  std::filesystem::path folder_;
  nlohmann::ordered_json request_;
  bool finished_ = false;
  std::optional<sim::FitState> state_;
};

}  // namespace greatx::apps
