// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/symbols.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/phase.h"
#include "core/units.h"
#include "rf/radar/signal/codes.h"
#include "rf/radar/signal/delay.h"

namespace greatx::rf {
namespace {

constexpr double largest_left_out = 1e-6;

/// Returns sin(pi x count)/(count sin(pi x)): the mean of `count` phasors that are x turns apart.
double periodic_sinc(double x, double count) {
  const double below = count * std::sin(pi * x);
  return std::abs(below) < 1e-12 ? 1.0 : std::sin(pi * x * count) / below;
}

double slot_phase(const RadarWaveform& w, double rate) { return pi * w.carrier_hz * rate * w.sampled_s(); }

}  // namespace

float symbol_weight(const RadarWaveform& w, double rate, uint32_t term) {
  const double phase = slot_phase(w, rate);
  double weight = w.averages > 1 ? periodic_sinc(w.carrier_hz * rate * w.sampled_s(), w.averages) : 1.0;
  for (uint32_t k = 1; k <= term; ++k) weight *= phase / k;
  return static_cast<float>(weight);
}

double symbol_gain(const RadarWaveform& w, double doppler_hz) {
  if (!w.coded()) return 1.0;
  const double turns = doppler_hz * w.sampled_s();  // over the lines' period
  const double within = periodic_sinc(turns / w.samples, w.samples);
  const double between = w.averages > 1 ? periodic_sinc(turns, w.averages) : 1.0;
  return within * within * between * between;
}

Symbols::Symbols(const RadarWaveform& waveform)
    : waveform_(waveform),
      to_signal_(waveform.samples, Fft::Direction::forward, Fft::Others::chirp),
      to_lines_(waveform.samples, Fft::Direction::backward, Fft::Others::chirp) {
  GREATX_CHECK(waveform.coded(), "a waveform without symbols");
  if (waveform.modulation != RadarModulation::pmcw) return;
  const uint32_t count = waveform.samples, middle = waveform.middle_sample();
  const std::vector<float> chips = code_chips(waveform.code, count);
  std::vector<Fft::Value> in(count), out(count);
  for (uint32_t i = 0; i < count; ++i) in[i] = Fft::Value(Four(chips[i]), Four(0.0f));
  to_signal_.transform(in.data(), out.data());
  const float factor = static_cast<float>(1.0 / std::sqrt(double(count)));
  code_.resize(count);
  for (uint32_t q = 0; q < count; ++q)
    code_[(q + middle) % count] = factor * std::complex<float>(out[q].real().lane[0], out[q].imag().lane[0]);
}

uint32_t Symbols::terms(std::span<const EchoList> lists, const std::string& radar) const {
  double largest = 0.0;
  const auto take = [&](double rate, uint32_t instance) {
    const double phase = std::abs(slot_phase(waveform_, rate));
    if (!(phase <= largest_phase))
      throw_user_error(
          "radar '{}': an echo of instance {} has a Doppler shift of {:.6g} Hz, more than the {:.6g} Hz from "
          "line to line of the waveform; widen waveform.{}",
          radar, instance, waveform_.carrier_hz * std::abs(rate), 1.0 / waveform_.sampled_s(),
          waveform_.modulation == RadarModulation::ofdm ? "spacing_hz" : "chip_rate_hz, or take fewer chips");
    largest = std::max(largest, phase);
  };
  for (const EchoList& list : lists) {
    for (const Echo& echo : list.echoes)
      for (uint32_t slot = 0; slot < list.slots; slot += std::max(1u, (list.slots - 1) / 2))
        take(delay_at(list, echo.delay, waveform_.interval_s, waveform_.slot_middle_s(list.first_slot + slot))
                 .rate,
             echo.instance);
    for (const auto& row : list.tables) take(row[1], 0);
    for (size_t i = 0; i < list.patches.rate.size(); ++i)
      take(list.patches.rate[i], list.patches.instance[i % list.patches.size()]);
  }
  // The first term that is left out: largest^k/k!.
  uint32_t count = 1;
  for (double term = largest; term > largest_left_out; ++count) term *= largest / (count + 1);
  return count;
}

std::vector<std::complex<float>> Symbols::spectrum(const RadarSeeds& seeds, uint32_t slot) const {
  if (!code_.empty()) return code_;
  std::vector<std::complex<float>> symbols(waveform_.samples);
  complex_normals(seeds, RadarDraw::symbols, slot, 0, symbols);
  constexpr float part = 0.70710678118654752440f;
  for (auto& symbol : symbols)
    symbol = {std::copysign(part, symbol.real()), std::copysign(part, symbol.imag())};
  return symbols;
}

/// Calls work(rows, count, spectrum) for the rows of each slot, at most four at a time.
template <typename Work>
void Symbols::in_slots(const RadarSeeds& seeds, uint32_t threads, size_t samples, const Work& work) const {
  const uint32_t receivers = static_cast<uint32_t>(samples / (size_t{waveform_.slots} * waveform_.samples));
  parallel_for(waveform_.slots, threads, [&](size_t index) {
    const uint32_t slot = static_cast<uint32_t>(index);
    const auto symbols = spectrum(seeds, slot);
    for (uint32_t first = 0; first < receivers; first += Fft::lanes) {
      const uint32_t count = std::min(Fft::lanes, receivers - first);
      std::array<size_t, Fft::lanes> rows;
      for (uint32_t i = 0; i < Fft::lanes; ++i)  // if there are fewer, the last receiver fills the lanes
        rows[i] = size_t{waveform_.row(first + std::min(i, count - 1), slot)} * waveform_.samples;
      work(rows, count, symbols);
    }
  });
}

void Symbols::send(const RadarSeeds& seeds, uint32_t term, uint32_t threads,
                   std::span<const std::complex<float>> lines, std::span<std::complex<float>> signal) const {
  const uint32_t count = waveform_.samples, middle = waveform_.middle_sample();
  const double scale = 1.0 / std::sqrt(double(count));
  // (j x)^term at each sample.
  std::vector<std::complex<float>> factors(count);
  constexpr std::complex<double> powers[] = {{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}};
  for (uint32_t i = 0; i < count; ++i)
    factors[i] = std::complex<float>(scale * std::pow((double(i) - middle) / (0.5 * count), double(term)) *
                                     powers[term % 4]);
  in_slots(seeds, threads, signal.size(), [&](const auto& rows, uint32_t used, const auto& symbols) {
    std::vector<Fft::Value> in(count), out(count);
    const std::complex<float>* from[Fft::lanes];
    for (uint32_t i = 0; i < Fft::lanes; ++i) from[i] = lines.data() + rows[i];
    Fft::gather(from, count, out.data());
    for (uint32_t q = 0; q < count; ++q) {
      const uint32_t n = (q + middle) % count;
      in[q] = plain_product(out[n], Fft::Value(Four(symbols[n].real()), Four(-symbols[n].imag())));
    }
    to_signal_.transform(in.data(), out.data());
    for (uint32_t i = 0; i < used; ++i)
      for (uint32_t s = 0; s < count; ++s)
        signal[rows[i] + s] +=
            plain_product(std::complex<float>(out[s].real().lane[i], out[s].imag().lane[i]), factors[s]);
  });
}

void Symbols::receive(const RadarSeeds& seeds, uint32_t threads, std::span<std::complex<float>> cube) const {
  const uint32_t count = waveform_.samples, middle = waveform_.middle_sample();
  const float scale = static_cast<float>(1.0 / std::sqrt(double(count)));
  in_slots(seeds, threads, cube.size(), [&](const auto& rows, uint32_t used, const auto& symbols) {
    std::vector<Fft::Value> in(count), out(count);
    const std::complex<float>* from[Fft::lanes];
    for (uint32_t i = 0; i < Fft::lanes; ++i) from[i] = cube.data() + rows[i];
    Fft::gather(from, count, in.data());
    to_lines_.transform(in.data(), out.data());
    for (uint32_t q = 0; q < count; ++q) {
      const uint32_t n = (q + middle) % count;
      const std::complex<float> symbol = scale * symbols[n];
      for (uint32_t i = 0; i < used; ++i)
        cube[rows[i] + n] =
            plain_product(std::complex<float>(out[q].real().lane[i], out[q].imag().lane[i]), symbol);
    }
  });
}

}  // namespace greatx::rf
