// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the table of comparisons between sensors. A row describes one figure: how a run computes it, and
// how it is recomputed from the files of the run.
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

/// Holds a record of a tick, and the evidence of its sensor about it.
struct Witness {
  RecordView record;
  Evidence evidence;
};

/// Holds everything that is compared at a tick.
struct TickEvidence {
  std::span<const Witness> witnesses;
  const Witness* poses = nullptr;  ///< one of the witnesses; null: no poses
  std::span<const InstanceBox> boxes;
};

/// Takes the errors of one record against the record `other`, which is null if the record is compared with
/// something else.
using KeepErrors =
    std::function<void(const Witness& witness, const Witness* other, const ErrorStatistics& errors)>;

/// A row of the table of comparisons.
struct Comparison {
  const char* figure;
  /// Whether every run makes the comparison, because the sensor finds the errors anyway. Otherwise it needs
  /// the effect `consistency`.
  bool always;
  void (*compare)(const TickEvidence& tick, const KeepErrors& keep);

  /// Lists what must have been written to recompute the figure.
  struct Needs {
    std::vector<std::string> arrays, of_other;  ///< arrays of the sensor, and of the other one
    bool boxes = false;                         ///< whether boxes of instances are needed
  };
  Needs (*needs)(const SensorSpec& other) = nullptr;
  /// Recomputes the figure from records. If it is null, this is not possible. A run then keeps the total of
  /// the figure, but no row for each record.
  ErrorStatistics (*recompute)(const RecordView& sensor, const RecordView& other,
                               std::span<const InstanceBox> boxes) = nullptr;
  const char* obstacle = nullptr;  ///< why it cannot be recomputed, if so
};

/// Returns all comparisons in the order in which a run makes them.
std::span<const Comparison> comparisons();
/// Returns the comparison of a figure; null: there is none.
const Comparison* comparison_called(std::string_view figure);

/// Holds the errors of a run for every figure. They show whether the modalities see one world.
using Consistency = std::map<std::string, ErrorStatistics, std::less<>>;

/// Makes the comparisons of a run.
class Comparer {
 public:
  /// With `all`, it also makes the comparisons that need the effect `consistency`. The world outlives the
  /// comparer.
  Comparer(const World& world, bool all);
  /// Compares the records of a tick, given in the order of their sensors.
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
