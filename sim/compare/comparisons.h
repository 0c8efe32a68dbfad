// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The table of comparisons between sensors: one row a figure, which says how it is made in a run and how it
// is found again in the files that the run left.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/compare/evidence.h"
#include "sim/compare/record_consistency.h"

namespace greatx::sim {

/// A record of a tick, and its sensor's evidence about it.
struct Witness {
  RecordView record;
  Evidence evidence;
};

/// What was compared at a tick.
struct TickEvidence {
  std::span<const Witness> witnesses;
  const Witness* poses = nullptr;  ///< one of the witnesses; null: there are no poses
  std::span<const InstanceBox> boxes;
};

/// Takes the errors of one record; `other`: the record that it is held against, null if that is not a record.
using KeepErrors =
    std::function<void(const Witness& witness, const Witness* other, const ErrorStatistics& errors)>;

/// A row of the table.
struct Comparison {
  const char* figure;
  /// Made in every run, because the sensor finds it on the way; the others need the effect `consistency`.
  bool always;
  void (*compare)(const TickEvidence& tick, const KeepErrors& keep);

  /// What must have been written so that the figure can be found again.
  struct Needs {
    std::vector<std::string> arrays, of_other;  ///< of the sensor, and of the one that it is held against
    bool boxes = false;                         ///< of instances
  };
  Needs (*needs)(const SensorSpec& other) = nullptr;
  /// Finds the figure again from records. Null: it cannot be; a run then keeps the total of the figure, but
  /// no row a record.
  ErrorStatistics (*recompute)(const RecordView& sensor, const RecordView& other,
                               std::span<const InstanceBox> boxes) = nullptr;
  const char* obstacle = nullptr;  ///< why it cannot be, if it cannot
};

/// In the order in which a run makes them.
std::span<const Comparison> comparisons();
/// Null: there is no such figure.
const Comparison* comparison_called(std::string_view figure);

/// The errors of a run by figure, which show whether the modalities see one world. All figures are there.
using Consistency = std::map<std::string, ErrorStatistics, std::less<>>;

/// Makes the comparisons of a run.
class Comparer {
 public:
  /// `all`: also those that need the effect `consistency`. The world outlives the comparer.
  Comparer(const World& world, bool all);
  /// Compares the records of a tick, in the order of their sensors.
  void compare(uint32_t sequence, int64_t tick, std::span<const Witness> witnesses);
  const Consistency& totals() const { return totals_; }
  const std::vector<ConsistencyRow>& rows() const { return rows_; }

 private:
  const World& world_;
  bool all_;
  std::vector<InstanceBox> boxes_;  ///< empty until a record needs them
  Consistency totals_;
  std::vector<ConsistencyRow> rows_;
};

}  // namespace greatx::sim
