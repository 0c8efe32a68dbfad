// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/delay.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace greatx::rf {
namespace {

DelayAt table_at(const EchoList& list, uint32_t row, double interval_s, double time_s) {
  const auto* table = list.tables.data() + size_t{row} * list.slots;
  const double place = time_s / interval_s - list.first_slot;  // in slots
  if (list.slots == 1) return {table[0][0] + table[0][1] * place * interval_s, table[0][1], 0.0};
  const double first = std::clamp(std::floor(place), 0.0, double(list.slots - 2));
  const auto& a = table[static_cast<size_t>(first)];
  const auto& b = table[static_cast<size_t>(first) + 1];
  const double u = place - first, h = interval_s;
  // The polynomial a + slope u + bend u^2 + twist u^3 matches the delays and the rates at both ends.
  const double slope = a[1] * h, end_slope = b[1] * h, rise = b[0] - a[0];
  const double bend = 3.0 * rise - 2.0 * slope - end_slope, twist = slope + end_slope - 2.0 * rise;
  return {a[0] + u * (slope + u * (bend + u * twist)), (slope + u * (2.0 * bend + u * 3.0 * twist)) / h,
          (2.0 * bend + 6.0 * u * twist) / (h * h)};
}

double reach(const std::vector<dvec3>& positions) {
  double longest = 0.0;
  for (const dvec3& p : positions) longest = std::max(longest, glm::length(p));
  return longest;
}

bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_echo(const EchoList& list, const Echo& echo, const RadarSignalConfig& config, double shortest_s,
                const std::string& radar) {
  const double interval_s = config.waveform.interval_s;
  if (!std::isfinite(echo.amplitude.real()) || !std::isfinite(echo.amplitude.imag()) ||
      !finite(echo.departure) || !finite(echo.arrival))
    throw_user_error("radar '{}': an echo of instance {} has an amplitude or a direction that is not finite",
                     radar, echo.instance);
  GREATX_CHECK(echo.delay.table < 0 || (size_t(echo.delay.table) + 1) * list.slots <= list.tables.size(),
               "row {} of {} delays in tables of {} slots", echo.delay.table, list.tables.size(), list.slots);
  const double start_s = list.first_slot * interval_s, end_s = (list.first_slot + list.slots) * interval_s;
  for (const double time_s : {start_s, 0.5 * (start_s + end_s), end_s}) {
    const DelayAt at = delay_at(list, echo.delay, interval_s, time_s);
    if (!std::isfinite(at.delay_s) || !std::isfinite(at.rate))
      throw_user_error("radar '{}': an echo of instance {} has a delay that is not finite", radar,
                       echo.instance);
    if (at.delay_s <= shortest_s)
      throw_user_error(
          "radar '{}': a target (instance {}) stands inside the antenna: its echo takes {} s, light needs {} "
          "s "
          "to cross the elements",
          radar, echo.instance, at.delay_s, shortest_s);
    if (std::abs(at.rate) >= 1.0)
      throw_user_error(
          "radar '{}': an echo of instance {} has a delay that changes by {} s/s, faster than light", radar,
          echo.instance, at.rate);
  }
}

}  // namespace

DelayAt delay_at(const EchoList& list, const DelayTrack& track, double interval_s, double time_s) {
  if (track.table >= 0) return table_at(list, static_cast<uint32_t>(track.table), interval_s, time_s);
  const auto& c = track.coefficients;
  const double d = time_s - track.mid_s;
  return {c[0] + d * (c[1] + d * (c[2] + d * c[3])), c[1] + d * (2.0 * c[2] + d * 3.0 * c[3]),
          2.0 * c[2] + d * 6.0 * c[3]};
}

void check_echoes(const EchoList& list, const RadarSignalConfig& config, const std::string& radar) {
  GREATX_CHECK(list.slots > 0 && uint64_t{list.first_slot} + list.slots <= config.waveform.slots,
               "slots {} + {} of {}", list.first_slot, list.slots, config.waveform.slots);
  const double shortest_s =
      (reach(config.arrays.transmit_m) + reach(config.arrays.receive_m)) / speed_of_light;
  for (const Echo& echo : list.echoes) check_echo(list, echo, config, shortest_s, radar);
}

}  // namespace greatx::rf
