// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/beat.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/phase.h"
#include "rf/radar/signal/delay.h"
#include "rf/radar/signal/fft.h"
#include "rf/radar/signal/lanes.h"
#include "rf/radar/signal/receiver.h"
#include "rf/radar/signal/symbols.h"
#include "rf/radar/signal/tones.h"

namespace greatx::rf {
namespace {

constexpr size_t slots_per_task = 4;

/// Holds the echoes of one list by columns. They are padded to whole blocks with echoes of amplitude 0.
struct EchoColumns {
  size_t echoes = 0, padded = 0;
  TrackColumns track;
  std::vector<double> mid_delay_s;  ///< delay at the middle of the list's slots
  /// [virtual antennas, padded]: conj(a) sqrt(P_t) with the phase of the antenna's lead, and the cells by
  /// which the lead shifts the tone.
  std::vector<float> phasor_re, phasor_im, shift;
};

EchoColumns make_columns(const RadarSignalConfig& config, const SlotScales& scales, const EchoList& list,
                         const RadarAttitude& attitude, uint32_t threads) {
  const RadarWaveform& w = config.waveform;
  const size_t receivers = config.arrays.receive_m.size(), antennas = receivers * w.transmitters;
  EchoColumns columns;
  columns.echoes = list.echoes.size();
  columns.padded = (columns.echoes + tone_block - 1) / tone_block * tone_block;
  for (auto* column : {&columns.track.c0, &columns.track.c1, &columns.track.c2, &columns.track.c3,
                       &columns.track.mid_s, &columns.mid_delay_s})
    column->resize(columns.padded, 0.0);
  for (auto* column : {&columns.phasor_re, &columns.phasor_im, &columns.shift})
    column->resize(antennas * columns.padded, 0.0f);
  const double mid_s =
      0.5 * (w.slot_middle_s(list.first_slot) + w.slot_middle_s(list.first_slot + list.slots - 1));
  parallel_for(columns.padded / tone_block, threads, [&](size_t block) {
    const size_t end = std::min(columns.echoes, (block + 1) * tone_block);
    for (size_t e = block * tone_block; e < end; ++e) {
      const Echo& echo = list.echoes[e];
      const double tau = delay_at(list, echo.delay, w.interval_s, mid_s).delay_s;
      columns.mid_delay_s[e] = tau;
      columns.track.c0[e] = echo.delay.coefficients[0];
      columns.track.c1[e] = echo.delay.coefficients[1];
      columns.track.c2[e] = echo.delay.coefficients[2];
      columns.track.c3[e] = echo.delay.coefficients[3];
      columns.track.mid_s[e] = echo.delay.mid_s;
      const auto tx = transmitter_leads(config.arrays, attitude, echo);
      const auto rx = receiver_leads(config.arrays, attitude, echo);
      const std::complex<double> amplitude = std::conj(echo.amplitude) * std::sqrt(config.transmit_power_w);
      for (size_t v = 0; v < antennas; ++v) {
        const double lead = tx[v % w.transmitters] + rx[v / w.transmitters];
        const double turns = -w.carrier_hz * lead + w.squared_slope() * lead * (tau - 0.5 * lead);
        float cosine, sine;
        cos_sin_of_turns(static_cast<float>(fraction_of_turn(turns)), cosine, sine);
        const std::complex<double> phasor = amplitude * std::complex<double>(cosine, sine);
        columns.phasor_re[v * columns.padded + e] = static_cast<float>(phasor.real());
        columns.phasor_im[v * columns.padded + e] = static_cast<float>(phasor.imag());
        columns.shift[v * columns.padded + e] =
            static_cast<float>(-w.slope_hz_per_s * lead * scales.cells_per_hz);
      }
    }
  });
  return columns;
}

SlotScales make_scales(const RadarWaveform& w, const ToneKernel& kernel) {
  return {w.carrier_hz,
          w.slope_hz_per_s,
          w.sweeps() ? 1.0 : 0.0,
          w.squared_slope() > 0.0 ? 1.0 : 0.0,
          kernel.grid() / w.sample_rate_hz,
          0.5 * w.samples / w.sample_rate_hz,
          kernel.grid()};
}

}  // namespace

struct BeatSynthesizer::Shared {
  RadarSignalConfig config;
  ToneKernel kernel;
  Fft transform;
  SlotScales scales;
  uint32_t stride;  ///< floats of one part of a grid, including the cells that are folded back

  explicit Shared(const RadarSignalConfig& of)
      : config(of),
        kernel(of.waveform.samples),
        transform(kernel.grid(), Fft::Direction::backward),
        scales(make_scales(of.waveform, kernel)),
        stride(kernel.grid() + ToneKernel::taps) {}
};

namespace {

/// Sums the echoes of one slot. A task reuses the object for all its slots.
class SlotSum {
 public:
  SlotSum(const RadarSignalConfig& config, const ToneKernel& kernel, const Fft& transform,
          const SlotScales& scales, uint32_t stride, const EchoList& list, const EchoColumns& columns,
          const RadarAttitude& attitude, const PhaseWalk* walk, uint32_t term)
      : config_(config),
        w_(config.waveform),
        kernel_(kernel),
        transform_(transform),
        scales_(scales),
        stride_(stride),
        list_(list),
        columns_(columns),
        attitude_(attitude),
        walk_(walk),
        term_(term),
        receivers_(config.arrays.receive_m.size()),
        cells_(kernel.grid()),
        samples_(kernel.grid()),
        lines_(Fft::lanes * w_.samples),
        taps_(receivers_) {}

  BeatReport add(uint32_t slot, std::span<std::complex<float>> cube) {
    report_ = {};
    slot_ = slot;
    const bool all = w_.multiplexing == RadarMultiplexing::doppler;
    first_transmitter_ = all ? 0 : slot % w_.transmitters;
    last_transmitter_ = all ? w_.transmitters : first_transmitter_ + 1;
    nodes_.clear();
    bent_.clear();
    if (walk_)
      choose_nodes();
    else
      nodes_.push_back(0);
    grids_.assign(nodes_.size() * receivers_ * 2 * stride_, 0.0f);
    for (size_t first = 0; first < columns_.padded; first += tone_block) add_block(first);
    std::vector<std::vector<float>> turns;  // phase noise of each node
    if (walk_) {
      PhaseWalk::Ramp ramp = walk_->ramp(slot);
      for (const uint32_t node : nodes_) ramp.differences(node, turns.emplace_back(w_.samples));
    }
    for (size_t r = 0; r < receivers_; r += Fft::lanes)
      for (size_t i = 0; i < nodes_.size(); ++i) add_grids(i, r, walk_ ? &turns[i] : nullptr, cube);
    for (size_t r = 0; r < receivers_; ++r)
      for (const size_t e : bent_) add_bent(e, r, turns, row_of(r, cube));
    report_.bent_tones = bent_.size();
    return report_;
  }

 private:
  DelayAt middle_delay(size_t e) const {
    return delay_at(list_, list_.echoes[e].delay, w_.interval_s, w_.slot_middle_s(slot_));
  }

  void choose_nodes() {
    node_of_echo_.resize(columns_.echoes);
    for (size_t e = 0; e < columns_.echoes; ++e)
      node_of_echo_[e] = PhaseWalk::node_of(middle_delay(e).delay_s);
    nodes_ = node_of_echo_;
    std::sort(nodes_.begin(), nodes_.end());
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  }

  size_t node_index(size_t e) const {
    return walk_ ? std::lower_bound(nodes_.begin(), nodes_.end(), node_of_echo_[e]) - nodes_.begin() : 0;
  }

  void add_block(size_t first) {
    const uint32_t count = static_cast<uint32_t>(std::min<size_t>(tone_block, columns_.echoes - first));
    block_delays(columns_.track, first, w_.slot_middle_s(slot_), delays_);
    for (uint32_t i = 0; i < count; ++i)
      if (list_.echoes[first + i].delay.table >= 0) {
        const DelayAt at = middle_delay(first + i);
        delays_.delay_s[i] = at.delay_s;
        delays_.rate[i] = at.rate;
        delays_.curvature_per_s[i] = at.curvature_per_s;
      }
    block_tones(scales_, delays_, columns_.mid_delay_s.data() + first, tones_);
    if (w_.coded())
      for (uint32_t i = 0; i < count; ++i) {
        const float weight = symbol_weight(w_, delays_.rate[i], term_);
        tones_.re[i] *= weight;
        tones_.im[i] *= weight;
      }
    for (uint32_t i = 0; i < count; ++i) {
      offset_[i] = static_cast<uint32_t>(node_index(first + i) * receivers_ * 2 * stride_);
      if (tones_.orders[i] > ToneKernel::orders) {
        tones_.orders[i] = 0;
        bent_.push_back(first + i);
      }
    }
    report_.tones += count;
    for (uint32_t t = first_transmitter_; t < last_transmitter_; ++t) {
      for (size_t r = 0; r < receivers_; ++r) {
        const size_t column = (r * w_.transmitters + t) * columns_.padded + first;
        block_taps(scales_, tones_, columns_.shift.data() + column, columns_.phasor_re.data() + column,
                   columns_.phasor_im.data() + column, taps_[r]);
        if (w_.bands() > 1) turn(taps_[r], w_.band_turns(t, slot_));
      }
      spread(kernel_, tones_, taps_.data(), static_cast<uint32_t>(receivers_), offset_, count, stride_,
             grids_.data());
    }
  }

  static void turn(BlockTaps& taps, double turns) {
    const std::complex<float> phasor(unit_phasor(turns));
    for (uint32_t i = 0; i < tone_block; ++i) {
      const auto turned = plain_product({taps.re[i], taps.im[i]}, phasor);
      taps.re[i] = turned.real();
      taps.im[i] = turned.imag();
    }
  }

  /// Transforms the grids to samples, four receivers at a time.
  void add_grids(size_t node, size_t first, const std::vector<float>* turns,
                 std::span<std::complex<float>> cube) {
    constexpr size_t together = Fft::lanes;
    const uint32_t grid = kernel_.grid(), middle = w_.middle_sample();
    const size_t count = std::min(together, receivers_ - first);
    const float* parts[2][together];
    for (size_t i = 0; i < together; ++i) {  // if there are fewer, the last receiver fills the lanes
      float* re = grids_.data() + (node * receivers_ + first + std::min(i, count - 1)) * 2 * stride_;
      parts[0][i] = re, parts[1][i] = re + stride_;
      for (uint32_t k = 0; i < count && k < stride_ - grid; ++k) {
        re[k] += re[grid + k];
        re[stride_ + k] += re[stride_ + grid + k];
      }
    }
    for (uint32_t k = 0; k < grid; k += together) {  // M is a multiple of four
      Four value[2][together];
      for (int part = 0; part < 2; ++part) {
        for (size_t i = 0; i < together; ++i) value[part][i] = Four::at(parts[part][i] + k);
        transpose(value[part][0], value[part][1], value[part][2], value[part][3]);
      }
      for (size_t i = 0; i < together; ++i) cells_[k + i] = {value[0][i], value[1][i]};
    }
    transform_.transform(cells_.data(), samples_.data());
    for (uint32_t n = 0; n < w_.samples; ++n)
      cells_[n] = samples_[n >= middle ? n - middle : n + grid - middle] * Four(kernel_.correction()[n]);
    std::complex<float>* rows[together];
    for (size_t i = 0; i < together; ++i) rows[i] = lines_.data() + i * w_.samples;
    Fft::scatter(cells_.data(), w_.samples, rows);
    for (size_t i = 0; i < count; ++i) {
      const auto row = row_of(first + i, cube);
      for (uint32_t n = 0; n < w_.samples; ++n)
        row[n] += turns ? turned_sample(rows[i][n], (*turns)[n]) : rows[i][n];
    }
  }

  std::span<std::complex<float>> row_of(size_t receiver, std::span<std::complex<float>> cube) const {
    return cube.subspan(size_t{w_.row(static_cast<uint32_t>(receiver), slot_)} * w_.samples, w_.samples);
  }

  /// Adds an echo that bends too much for the kernels, sample by sample.
  void add_bent(size_t e, size_t r, const std::vector<std::vector<float>>& turns,
                std::span<std::complex<float>> row) {
    const Echo& echo = list_.echoes[e];
    const std::complex<double> amplitude = std::conj(echo.amplitude) * std::sqrt(config_.transmit_power_w);
    const double square = scales_.square;
    for (uint32_t t = first_transmitter_; t < last_transmitter_; ++t) {
      const double lead = transmitter_leads(config_.arrays, attitude_, echo)[t] +
                          receiver_leads(config_.arrays, attitude_, echo)[r];
      for (uint32_t n = 0; n < w_.samples; ++n) {
        const double u = (double(n) - w_.middle_sample()) / w_.sample_rate_hz;
        const double tau =
            delay_at(list_, echo.delay, w_.interval_s, w_.slot_middle_s(slot_) + u).delay_s - lead;
        const double phase = w_.carrier_hz * tau + w_.slope_hz_per_s * tau * (u - 0.5 * square * tau) +
                             w_.band_turns(t, slot_);
        const std::complex<float> sample(amplitude * unit_phasor(fraction_of_turn(phase)));
        row[n] += walk_ ? turned_sample(sample, turns[node_index(e)][n]) : sample;
      }
    }
  }

  const RadarSignalConfig& config_;
  const RadarWaveform& w_;
  const ToneKernel& kernel_;
  const Fft& transform_;
  const SlotScales& scales_;
  const uint32_t stride_;
  const EchoList& list_;
  const EchoColumns& columns_;
  const RadarAttitude& attitude_;
  const PhaseWalk* walk_;
  const uint32_t term_;
  const size_t receivers_;

  uint32_t slot_ = 0, first_transmitter_ = 0, last_transmitter_ = 0;
  BeatReport report_;
  std::vector<uint32_t> node_of_echo_, nodes_;
  std::vector<size_t> bent_;
  std::vector<float> grids_;  ///< [nodes, receivers, re | im, stride]
  std::vector<Fft::Value> cells_, samples_;
  std::vector<std::complex<float>> lines_;
  BlockDelays delays_;
  BlockTones tones_;
  std::vector<BlockTaps> taps_;  ///< [receivers]
  uint32_t offset_[tone_block] = {};
};

}  // namespace

BeatSynthesizer::BeatSynthesizer(const RadarSignalConfig& config)
    : shared_(std::make_unique<Shared>(config)) {}
BeatSynthesizer::~BeatSynthesizer() = default;

BeatReport BeatSynthesizer::add(const EchoList& list, const RadarAttitude& attitude, const PhaseWalk* walk,
                                uint32_t threads, std::span<std::complex<float>> cube, uint32_t term) const {
  const Shared& s = *shared_;
  const RadarWaveform& w = s.config.waveform;
  GREATX_CHECK(cube.size() == s.config.arrays.receive_m.size() * w.slots * w.samples, "{} samples",
               cube.size());
  GREATX_CHECK(list.first_slot + list.slots <= w.slots, "slots {} + {} of {}", list.first_slot, list.slots,
               w.slots);
  BeatReport sum;
  if (list.echoes.empty()) return sum;
  const EchoColumns columns = make_columns(s.config, s.scales, list, attitude, threads);
  for (const float shift : columns.shift)
    GREATX_CHECK(
        std::abs(shift) + 2 * ToneKernel::taps < std::min<float>(1024.0f, static_cast<float>(s.scales.grid)),
        "elements shift a tone by {} of {} grid frequencies", shift, s.scales.grid);
  const size_t tasks = (list.slots + slots_per_task - 1) / slots_per_task;
  std::vector<BeatReport> reports(tasks);
  parallel_for(tasks, threads, [&](size_t task) {
    SlotSum slots(s.config, s.kernel, s.transform, s.scales, s.stride, list, columns, attitude, walk, term);
    for (size_t i = task * slots_per_task; i < std::min<size_t>(list.slots, (task + 1) * slots_per_task);
         ++i) {
      const BeatReport report = slots.add(list.first_slot + static_cast<uint32_t>(i), cube);
      reports[task].tones += report.tones;
      reports[task].bent_tones += report.bent_tones;
    }
  });
  for (const BeatReport& report : reports) {
    sum.tones += report.tones;
    sum.bent_tones += report.bent_tones;
  }
  return sum;
}

std::vector<double> element_leads(const std::vector<dvec3>& elements, const dquat& orientation,
                                  const dvec3& direction) {
  std::vector<double> leads;
  for (const dvec3& at : elements) leads.push_back(glm::dot(direction, orientation * at) / speed_of_light);
  return leads;
}

std::vector<double> transmitter_leads(const RadarArrays& arrays, const RadarAttitude& attitude,
                                      const Echo& echo) {
  return element_leads(arrays.transmit_m, attitude.transmitter, echo.departure);
}

std::vector<double> receiver_leads(const RadarArrays& arrays, const RadarAttitude& attitude,
                                   const Echo& echo) {
  return element_leads(arrays.receive_m, attitude.receiver, echo.arrival);
}

}  // namespace greatx::rf
