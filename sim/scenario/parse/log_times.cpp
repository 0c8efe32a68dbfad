// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/log_times.h"

#include <cmath>

#include "core/expected.h"
#include "sim/scenario/date_time.h"
#include "sim/scenario/limits.h"
#include "sim/scenario/parse/csv.h"

namespace greatx::sim {

double LogTimes::seconds_of(std::string_view text, const EarthPositions::Fail& fail) {
  const std::optional<double> number = csv_number(text);
  const std::optional<double> date = number ? std::nullopt : parse_date_time(text);
  const std::string found = fmt::format("'{}'", text);
  if (!number && !date)
    fail("a finite number of seconds, or a date and time with its offset such as 2026-06-21T12:00:00Z",
         found);
  if (dates_ && *dates_ != date.has_value())
    fail(*dates_ ? "a date and time as in the lines before" : "a number of seconds as in the lines before",
         found);
  if (number && given_) fail("a date and time, since start_time is given", found);
  dates_ = date.has_value();
  if (number) return *number;
  if (!start_unix_s_) start_unix_s_ = *date;
  return std::round((*date - *start_unix_s_) * 1e6) / 1e6;
}

double LogTimes::next(std::string_view text, const EarthPositions::Fail& fail) {
  const double time_s = seconds_of(text, fail);
  const std::string found = fmt::format("'{}'", text);
  if (!std::isfinite(time_s)) fail("a finite number", found);
  if (std::abs(time_s) > most_time_s)
    fail(*dates_ ? fmt::format("a time within {:g} s of the start", most_time_s)
                 : number_range(-most_time_s, most_time_s),
         found);
  if (last_s_ && !(time_s > *last_s_))
    fail(fmt::format("a time greater than the one before, {}", *last_s_), found);
  last_s_ = time_s;
  return time_s;
}

}  // namespace greatx::sim
