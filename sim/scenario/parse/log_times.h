// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "sim/scenario/parse/earth_positions.h"

namespace greatx::sim {

/// Says what a file of way-points leaves open.
struct WayPointLog {
  EarthPositions earth;
  /// The instant that is t = 0 if the times are dates, UTC seconds since 1970; none: the first of them.
  std::optional<double> start_unix_s;
};

/// Turns the times of a log into seconds. All are numbers of seconds, or all are dates and times with their
/// offsets (RFC 3339), which count from the start.
class LogTimes {
 public:
  explicit LogTimes(const WayPointLog& log)
      : start_unix_s_(log.start_unix_s), given_(log.start_unix_s.has_value()) {}
  /// Returns the next time of the log, s. Differences of dates are exact to a microsecond. It calls `fail` if
  /// the text is of neither kind or of the other one, is out of range, or is not later than the one before.
  double next(std::string_view text, const EarthPositions::Fail& fail);

 private:
  double seconds_of(std::string_view text, const EarthPositions::Fail& fail);

  std::optional<double> start_unix_s_;
  bool given_ = false;                 ///< whether the scenario says what the start is
  std::optional<bool> dates_;          ///< whether the first time was a date
  std::optional<double> last_s_ = {};  ///< the time before
};

}  // namespace greatx::sim
