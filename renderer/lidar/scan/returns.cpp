// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/lidar/scan/returns.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"

namespace greatx::render {

namespace {

using Purpose = ShotNoise::Purpose;

constexpr uint32_t chunk_shots = 4096;

/// Gives a pulse the ids of the object with the most power among its echoes. Of equal objects it takes the
/// one with the smallest ids.
void name_pulse(std::span<const WeightedEcho> echoes, const Receiver& receiver, Pulse& pulse) {
  struct Candidate {
    uint32_t instance, material;
    double power;
  };
  std::vector<Candidate> candidates;
  for (const WeightedEcho& echo : echoes) {
    const double power = echo.weight * received_power(receiver, echo.range_m, echo.intensity);
    const auto found = std::find_if(candidates.begin(), candidates.end(), [&](const Candidate& c) {
      return c.instance == echo.instance && c.material == echo.material;
    });
    if (found == candidates.end())
      candidates.push_back({echo.instance, echo.material, power});
    else
      found->power += power;
  }
  const auto best =
      std::min_element(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return std::tuple(-a.power, a.instance, a.material) < std::tuple(-b.power, b.instance, b.material);
      });
  pulse.instance = best->instance;
  pulse.material = best->material;
}

Pulse pulse_of(std::span<const WeightedEcho> echoes, const Receiver& receiver) {
  Pulse pulse;
  double moment = 0.0, middle = 0.0;
  for (const WeightedEcho& echo : echoes) {
    const double power = echo.weight * received_power(receiver, echo.range_m, echo.intensity);
    pulse.power += power;
    moment += power * (echo.range_m - echoes[0].range_m);
    middle += echo.weight * (echo.range_m - echoes[0].range_m);
    pulse.intensity += echo.weight * echo.intensity * air_transmittance(receiver, echo.range_m);
    pulse.share += echo.weight * echo.share;
  }
  // Black surfaces give nothing back. The range is then the mean over the rays.
  double weights = 0.0;
  for (const WeightedEcho& echo : echoes) weights += echo.weight;
  pulse.range_m = echoes[0].range_m + (pulse.power > 0.0 ? moment / pulse.power : middle / weights);
  name_pulse(echoes, receiver, pulse);
  return pulse;
}

/// Adds the echo of the air before `end_m`. It goes gate by gate of the range resolution to the first one in
/// which signal and noise pass the threshold. pi beta times the gate's length is the reflectance of a surface
/// that gives as much.
void add_air(uint32_t shot, double end_m, const ReturnModel& model, const ShotNoise& noise,
             std::vector<Pulse>& pulses) {
  const Receiver& receiver = model.receiver;
  const double gate_m = model.choice.resolution_m, intensity = pi * receiver.backscatter_per_m_sr * gate_m;
  constexpr double unlikely = 6.0;  // Phi(-6) = 1e-9
  uint32_t index = 0;
  for (double near = model.min_range_m; near + gate_m <= end_m; near += gate_m, ++index) {
    const double range = near + noise.uniform(shot, Purpose::air_range, index) * gate_m;
    const double power = received_power(receiver, range, intensity);
    const double ratio = power / receiver.detection->noise_equivalent_power - receiver.detection->threshold;
    if (received_power(receiver, near, intensity) / receiver.detection->noise_equivalent_power <
        receiver.detection->threshold - unlikely)
      return;
    if (ratio + noise.normal(shot, Purpose::air_detection, index) <= 0.0) continue;
    pulses.insert(pulses.begin(),
                  Pulse{range, intensity * air_transmittance(receiver, range), power, 0.0, 0, 0});
    return;
  }
}

void detect(uint32_t shot, const ReturnModel& model, const ShotNoise& noise, std::vector<Pulse>& pulses) {
  const Receiver& receiver = model.receiver;
  const double end_m = pulses.empty() ? model.max_range_m : pulses.front().range_m;
  if (receiver.detection) {
    uint32_t index = 0;
    std::erase_if(pulses, [&](const Pulse& pulse) {
      const double ratio = pulse.power / receiver.detection->noise_equivalent_power;
      return ratio + noise.normal(shot, Purpose::detection, index++) <= receiver.detection->threshold;
    });
  }
  if (receiver.backscatter_per_m_sr > 0.0 && receiver.detection) add_air(shot, end_m, model, noise, pulses);
}

double range_deviation(const Receiver& receiver, double power) {
  const double jitter =
      receiver.rise_m > 0.0 ? receiver.rise_m * receiver.detection->noise_equivalent_power / power : 0.0;
  return std::hypot(receiver.range_std_m, jitter);
}

/// Returns the indices of the pulses to deliver, ascending, for several pulses.
std::vector<uint32_t> chosen(const std::vector<Pulse>& pulses, const ReturnChoice& choice) {
  const auto count = static_cast<uint32_t>(pulses.size());
  if (choice.mode == ReturnMode::last) return {count - 1};
  if (choice.mode == ReturnMode::all) {
    std::vector<uint32_t> all(std::min(count, choice.most));
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return pulses[a].power > pulses[b].power; });
  if (choice.mode == ReturnMode::strongest) return {order[0]};
  const uint32_t second = order[0] == count - 1 ? order[1] : count - 1;
  return {std::min(order[0], second), std::max(order[0], second)};
}

void deliver(const ScanPattern& pattern, uint32_t shot, const std::vector<Pulse>& pulses,
             const ReturnModel& model, const ShotNoise& noise, LidarScan& scan) {
  const auto add = [&](uint32_t i) {
    const Pulse& pulse = pulses[i];
    double range = pulse.range_m;
    if (const double deviation = range_deviation(model.receiver, pulse.power); deviation > 0.0)
      range += deviation * noise.normal(shot, Purpose::range, i);
    const auto rounded = static_cast<float>(range);
    scan.points.push_back(
        vec4(rounded * vec3(pattern.directions[shot]), static_cast<float>(pulse.intensity)));
    scan.shot.push_back(shot);
    scan.ring.push_back(pattern.rings[shot]);
    scan.time_offset_s.push_back(static_cast<float>(pattern.times_s[pattern.instants[shot]]));
    scan.range_m.push_back(rounded);
    scan.power.push_back(static_cast<float>(pulse.power));
    scan.share.push_back(static_cast<float>(pulse.share));
    scan.return_number.push_back(static_cast<uint16_t>(i + 1));
    scan.return_count.push_back(static_cast<uint16_t>(pulses.size()));
    scan.instance.push_back(pulse.instance);
    scan.material.push_back(pulse.material);
  };
  if (pulses.size() == 1) return add(0);  // most shots have one pulse: no list on the heap
  if (pulses.empty()) return;
  for (const uint32_t i : chosen(pulses, model.choice)) add(i);
}

void collect_shots(const ScanPattern& pattern, const EchoView& view, const ReturnModel& model,
                   const ShotNoise& noise, uint32_t first, uint32_t last, LidarScan& scan) {
  std::vector<WeightedEcho> echoes;
  std::vector<Pulse> pulses;
  for (uint32_t shot = first; shot < last; ++shot) {
    echoes.clear();
    for (uint32_t ray = 0; ray < view.sub_rays; ++ray) {
      for (uint32_t slot = 0; slot < view.slots; ++slot) {
        const shared::LidarEcho& echo = view.at(shot, ray, slot);
        if (echo.instance == shared::lidar_no_object) break;
        echoes.push_back(
            {echo.range, model.weights[ray], echo.intensity, echo.share, echo.instance, echo.material});
      }
    }
    if (echoes.size() == 1) {  // most shots; without glass all shots of single rays
      const WeightedEcho& e = echoes[0];
      pulses.assign(1, {e.range_m, e.weight * e.intensity * air_transmittance(model.receiver, e.range_m),
                        e.weight * received_power(model.receiver, e.range_m, e.intensity), e.weight * e.share,
                        e.instance, e.material});
    } else {
      pulses = pulses_of(echoes, model.receiver, model.choice.resolution_m);
    }
    detect(shot, model, noise, pulses);
    deliver(pattern, shot, pulses, model, noise, scan);
  }
}

/// Calls `each` with every column of `scan` and the same column of `other`.
template <typename Each>
void each_column(LidarScan& scan, const LidarScan& other, const Each& each) {
  each(scan.points, other.points);
  each(scan.shot, other.shot);
  each(scan.ring, other.ring);
  each(scan.time_offset_s, other.time_offset_s);
  each(scan.range_m, other.range_m);
  each(scan.power, other.power);
  each(scan.share, other.share);
  each(scan.return_number, other.return_number);
  each(scan.return_count, other.return_count);
  each(scan.instance, other.instance);
  each(scan.material, other.material);
}
void append(LidarScan& to, const LidarScan& from) {
  each_column(to, from, [](auto& a, const auto& b) { a.insert(a.end(), b.begin(), b.end()); });
}
void reserve(LidarScan& scan, size_t returns) {
  each_column(scan, scan, [returns](auto& column, const auto&) { column.reserve(returns); });
}

}  // namespace

std::vector<Pulse> pulses_of(std::vector<WeightedEcho>& echoes, const Receiver& receiver,
                             double resolution_m) {
  std::stable_sort(echoes.begin(), echoes.end(), [](const WeightedEcho& a, const WeightedEcho& b) {
    return std::tuple(a.range_m, a.instance, a.material) < std::tuple(b.range_m, b.instance, b.material);
  });
  std::vector<Pulse> pulses;
  for (size_t first = 0; first < echoes.size();) {
    size_t last = first + 1;
    while (last < echoes.size() && echoes[last].range_m - echoes[last - 1].range_m < resolution_m) ++last;
    pulses.push_back(pulse_of(std::span(echoes).subspan(first, last - first), receiver));
    first = last;
  }
  return pulses;
}

LidarScan make_scan(const ScanPattern& pattern, const EchoView& echoes, const ReturnModel& model,
                    const ShotNoise& noise) {
  GREATX_CHECK(model.weights.size() == echoes.sub_rays && pattern.size() == echoes.shots,
               "{} weights for {} rays, {} shots of {}", model.weights.size(), echoes.sub_rays, echoes.shots,
               pattern.size());
  LidarScan scan;
  reserve(scan, echoes.shots);
  if (echoes.sub_rays * echoes.slots == 1 && !model.receiver.noisy()) {
    collect_shots(pattern, echoes, model, noise, 0, echoes.shots, scan);
    return scan;
  }
  std::vector<LidarScan> parts((echoes.shots + chunk_shots - 1) / chunk_shots);
  parallel_for(parts.size(), 0, [&](size_t i) {
    const auto first = static_cast<uint32_t>(i) * chunk_shots;
    reserve(parts[i], chunk_shots);
    collect_shots(pattern, echoes, model, noise, first, std::min(first + chunk_shots, echoes.shots),
                  parts[i]);
  });
  for (const LidarScan& part : parts) append(scan, part);
  return scan;
}

}  // namespace greatx::render
