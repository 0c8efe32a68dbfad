// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/attribution.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/phase.h"
#include "rf/radar/signal/delay.h"

namespace greatx::rf {
namespace {

constexpr double reach = 2.0;  ///< bins

/// Returns `value` minus the nearest multiple of `period`.
double around(double value, double period) { return value - period * std::nearbyint(value / period); }

}  // namespace

Attribution::Attribution(const RadarSignalConfig& config, const RadarMaps& maps,
                         std::span<const EchoList> lists)
    : maps_(maps), ranges_(config.waveform.samples), velocities_(config.waveform.chirps()) {
  const RadarWaveform& w = config.waveform;
  const double frame_s = w.chirps() * w.repetition_s();
  add_patches(config, lists);
  for (const EchoList& list : lists) {
    const double share = double(list.slots) / w.slots;  // share of the slots of the frame
    const double mid_s =
        0.5 * (w.slot_middle_s(list.first_slot) + w.slot_middle_s(list.first_slot + list.slots - 1));
    for (const Echo& echo : list.echoes) {
      const DelayAt at = delay_at(list, echo.delay, w.interval_s, mid_s);
      const auto doppler_hz = [&](double rate) { return w.doppler_hz(at.delay_s, rate); };
      Tone tone{echo.instance, 0.0, doppler_hz(at.rate) * frame_s, 0.0, {}};
      if (echo.delay.table >= 0) {
        double lowest = at.rate, highest = at.rate;
        for (uint32_t s = 0; s < list.slots; ++s) {
          const double rate = list.tables[size_t(echo.delay.table) * list.slots + s][1];
          lowest = std::min(lowest, rate);
          highest = std::max(highest, rate);
        }
        tone.doppler = doppler_hz(0.5 * (lowest + highest)) * frame_s;
        tone.doppler_spread = doppler_hz(0.5 * (highest - lowest)) * frame_s;
      }
      tone.range = w.tone_hz(at.delay_s, at.rate) * w.sampled_s();
      const double turns =
          turns_of(w.carrier_hz, at.delay_s) - 0.5 * w.squared_slope() * at.delay_s * at.delay_s;
      tone.amplitude = share * std::sqrt(config.transmit_power_w) * std::conj(echo.amplitude) *
                       unit_phasor(fraction_of_turn(turns));
      tones_.push_back(tone);
    }
  }
  std::stable_sort(tones_.begin(), tones_.end(),
                   [](const Tone& a, const Tone& b) { return a.instance < b.instance; });
}

void Attribution::add_patches(const RadarSignalConfig& config, std::span<const EchoList> lists) {
  const RadarWaveform& w = config.waveform;
  const double frame_s = w.chirps() * w.repetition_s();
  std::vector<Patch> all;
  first_patch_.assign(w.samples + 1, 0);
  for (const EchoList& list : lists) {
    const PatchList& patches = list.patches;
    const double share = double(list.slots) / w.slots;
    const size_t middle = patches.size() * (patches.blocks / 2);
    all.reserve(all.size() + patches.size());
    for (size_t i = 0; i < patches.size(); ++i) {
      const double delay_s = patches.delay_s[middle + i];
      const double doppler_hz = w.doppler_hz(delay_s, patches.rate[middle + i]);
      const double range = w.tone_hz(delay_s, patches.rate[middle + i]) * w.sampled_s();
      const double power = patches.re[i] * patches.re[i] + patches.im[i] * patches.im[i];
      all.push_back({patches.instance[i], static_cast<float>(range - ranges_ * std::floor(range / ranges_)),
                     static_cast<float>(doppler_hz * frame_s),
                     static_cast<float>(share * share * config.transmit_power_w * power)});
      instances_ = std::max(instances_, patches.instance[i] + 1);
    }
  }
  // Order them by range bin, each bin in the order of the lists.
  const auto bin_of = [&](const Patch& patch) {
    return std::min(w.samples - 1, static_cast<uint32_t>(patch.range));
  };
  for (const Patch& patch : all) ++first_patch_[bin_of(patch) + 1];
  std::partial_sum(first_patch_.begin(), first_patch_.end(), first_patch_.begin());
  std::vector<uint32_t> next(first_patch_.begin(), first_patch_.end() - 1);
  patches_.resize(all.size());
  for (const Patch& patch : all) patches_[next[bin_of(patch)]++] = patch;
}

void Attribution::add_powers(uint32_t range_bin, double doppler, std::vector<double>& powers) const {
  constexpr int whole_reach = static_cast<int>(reach);
  const int bins = static_cast<int>(ranges_);
  for (int off = -std::min(whole_reach + 1, bins / 2); off <= std::min(whole_reach, (bins - 1) / 2); ++off) {
    const int bin = (static_cast<int>(range_bin) + off + bins) % bins;
    for (uint32_t i = first_patch_[bin]; i < first_patch_[bin + 1]; ++i) {
      const Patch& patch = patches_[i];
      const double range_off = around(double(patch.range) - range_bin, ranges_),
                   doppler_off = around(patch.doppler - doppler, velocities_);
      if (std::abs(range_off) > reach || std::abs(doppler_off) > reach) continue;
      powers[patch.instance] +=
          patch.power_w * maps_.range_window().power(range_off) * maps_.doppler_window().power(doppler_off);
    }
  }
}

uint32_t Attribution::instance(uint32_t range_bin, uint32_t velocity_bin, double power_w) const {
  const double doppler = doppler_turns(velocity_bin, static_cast<uint32_t>(velocities_));
  std::vector<double> of_patches(instances_, 0.0);
  if (instances_ > 0) add_powers(range_bin, doppler, of_patches);
  uint32_t best = 0;
  double largest = least_share * power_w;
  const auto compare = [&](uint32_t instance, double power) {
    if (instance == 0 || power < largest || (power == largest && (best == 0 || instance >= best))) return;
    largest = power;
    best = instance;
  };
  for (size_t i = 0; i < tones_.size();) {
    const uint32_t instance = tones_[i].instance;
    std::complex<double> sum = 0.0;
    double powers = 0.0;
    for (; i < tones_.size() && tones_[i].instance == instance; ++i) {
      const Tone& tone = tones_[i];
      const double range_off = around(tone.range - range_bin, ranges_);
      if (std::abs(range_off) > reach) continue;
      const double doppler_off = around(tone.doppler - doppler, velocities_);
      if (std::abs(doppler_off) > reach + tone.doppler_spread) continue;
      if (tone.doppler_spread > 0.0) {
        powers += std::norm(tone.amplitude) * maps_.range_window().power(range_off) /
                  std::min(velocities_, 1.0 + 2.0 * tone.doppler_spread);
        continue;
      }
      const std::complex<double> part = tone.amplitude * maps_.range_window().response(range_off) *
                                        maps_.doppler_window().response(doppler_off);
      sum += part;
      powers += std::norm(part);
    }
    double power = std::max(std::norm(sum), powers);
    if (instance < instances_) power += std::exchange(of_patches[instance], 0.0);
    compare(instance, power);
  }
  for (uint32_t instance = 1; instance < instances_; ++instance)
    if (of_patches[instance] > 0.0) compare(instance, of_patches[instance]);
  return best;
}

}  // namespace greatx::rf
