// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the nodes were and will be, as far as records of poses are known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "core/record.h"
#include "view/overlay/record_tables.h"
#include "view/overlay/shapes.h"

namespace greatx::view {

/// The records of poses that were met so far, of one sequence. Keeps at most `most_bytes` of them: of more,
/// those farthest in time from the one added last go.
class PoseHistory {
 public:
  explicit PoseHistory(uint64_t most_bytes = uint64_t{256} << 20) : most_bytes_(most_bytes) {}

  /// Another sequence than before begins a new history. A tick that is there is replaced.
  void add(uint32_t sequence, std::shared_ptr<const Record> poses);
  /// Null: none.
  std::shared_ptr<const Record> at(int64_t tick) const;
  std::shared_ptr<const Record> at_or_before(int64_t tick) const;
  /// Those from one time to another, both included, in order.
  std::vector<std::shared_ptr<const Record>> between(int64_t first_ns, int64_t last_ns) const;
  size_t size() const { return records_.size(); }
  uint64_t bytes() const { return bytes_; }

 private:
  std::deque<std::shared_ptr<const Record>> records_;  ///< by tick, ascending; so do times
  uint64_t most_bytes_, bytes_ = 0;
  uint32_t sequence_ = 0;
};

struct TrajectoryOptions {
  double past_s = 10.0, future_s = 10.0;
  bool labels = true;
  size_t most_lines = 1'000;  ///< of a node; of more records every n-th is used, which the legend says
  size_t most_labels = 200;   ///< the legend says how many nodes have none
};

/// A line for each node through its positions, future ones darker, with a dot at each whole second of the
/// sequence's time and the node's name at its place now. Nodes that rest have the name alone. There is no
/// line where more than four usual intervals between records are not known. Throws UserError if a record is
/// not as docs/dataset.md has it.
Shapes trajectory_shapes(const RecordTables& tables, const PoseHistory& history, int64_t now_ns,
                         const TrajectoryOptions& options);

}  // namespace greatx::view
