// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The errors that a scenario may allow under `accuracy:`, by name. sim/tradeoff/error defines their figures.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace greatx::sim {

/// Describes one name under `accuracy:`.
struct AccuracyKind {
  std::string_view name;      ///< "csi_nmse_db"
  std::string_view modality;  ///< name_of(Modality)
  std::string_view figure;    ///< ErrorFigure::name
  std::string_view unit;
  double least, most;  ///< of what a scenario may allow
  /// The error that counts as much as those of the other modalities if a scenario gives a time budget and no
  /// error of this modality. NaN: the modality has other figures for that.
  double weight;
  /// Whether the weight holds, too, if the scenario gives another error of the modality: it is of something
  /// that the other figures do not see.
  bool guards;
  std::string_view about;
};

/// Returns every kind, those of one modality side by side, in the order of the modalities.
std::span<const AccuracyKind> accuracy_kinds();

/// Holds one error that a scenario allows.
struct AccuracyTarget {
  const AccuracyKind* kind = nullptr;  ///< never null
  double value = 0.0;                  ///< in the kind's unit
  bool asked = true;                   ///< false: it is the kind's weight
};

/// Holds what a scenario asks for instead of settings.
struct AccuracyWish {
  std::vector<AccuracyTarget> targets;  ///< in the order of accuracy_kinds()
  double budget_ms = 0.0;               ///< of wall time for a tick; 0: no budget
  bool empty() const { return targets.empty() && budget_ms == 0.0; }
};

}  // namespace greatx::sim
