// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/date_time.h"

#include <chrono>
#include <cstdint>

namespace greatx::sim {

namespace {

/// Reads a text from its front.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}
  bool done() const { return text_.empty(); }
  bool take(std::string_view any_of) {
    if (text_.empty() || any_of.find(text_.front()) == std::string_view::npos) return false;
    text_.remove_prefix(1);
    return true;
  }
  /// Reads exactly `digits` digits whose value is at most `most`. Returns -1 if there are none.
  int number(int digits, int most) {
    if (text_.size() < static_cast<size_t>(digits)) return -1;
    int value = 0;
    for (int i = 0; i < digits; ++i) {
      if (text_[i] < '0' || text_[i] > '9') return -1;
      value = 10 * value + (text_[i] - '0');
    }
    text_.remove_prefix(digits);
    return value <= most ? value : -1;
  }
  /// Reads the digits after a decimal point, at least one.
  std::optional<double> fraction() {
    double value = 0.0, scale = 0.1;
    bool any = false;
    for (; !text_.empty() && text_.front() >= '0' && text_.front() <= '9';
         text_.remove_prefix(1), scale *= 0.1) {
      value += scale * (text_.front() - '0');
      any = true;
    }
    return any ? std::optional(value) : std::nullopt;
  }

 private:
  std::string_view text_;
};

}  // namespace

std::optional<double> parse_date_time(std::string_view text) {
  Reader reader(text);
  const int year = reader.number(4, 9999);
  if (year < 0 || !reader.take("-")) return std::nullopt;
  const int month = reader.number(2, 12);
  if (month < 1 || !reader.take("-")) return std::nullopt;
  const int day = reader.number(2, 31);
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(unsigned(month)),
                                         std::chrono::day(day < 0 ? 0u : unsigned(day))};
  if (!date.ok() || !reader.take("Tt ")) return std::nullopt;
  const int hour = reader.number(2, 23);
  if (hour < 0 || !reader.take(":")) return std::nullopt;
  const int minute = reader.number(2, 59);
  if (minute < 0 || !reader.take(":")) return std::nullopt;
  const int second = reader.number(2, 60);
  if (second < 0) return std::nullopt;
  double fraction = 0.0;
  if (reader.take(".")) {
    const auto digits = reader.fraction();
    if (!digits) return std::nullopt;
    fraction = *digits;
  }
  int64_t offset_minutes = 0;
  if (!reader.take("Zz")) {
    const int sign = reader.take("+") ? 1 : reader.take("-") ? -1 : 0;
    const int hours = sign != 0 ? reader.number(2, 23) : -1;
    if (hours < 0 || !reader.take(":")) return std::nullopt;
    const int minutes = reader.number(2, 59);
    if (minutes < 0) return std::nullopt;
    offset_minutes = sign * (60 * hours + minutes);
  }
  if (!reader.done()) return std::nullopt;
  const int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return double(days * 86400 + (hour * 60 + minute - offset_minutes) * 60 + second) + fraction;
}

}  // namespace greatx::sim
