// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/patches.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "core/phase.h"
#include "rf/radar/signal/beat.h"
#include "rf/radar/signal/fft.h"
#include "rf/radar/signal/lanes.h"
#include "rf/radar/signal/patch_kernel.h"
#include "rf/radar/signal/receiver.h"
#include "rf/radar/signal/symbols.h"

namespace greatx::rf {
namespace {

constexpr int kernel_taps = PatchKernel::taps;
/// Rows of a grid that one task adds patches to. The sums do not depend on it.
constexpr uint32_t stripe_rows = 24;
constexpr uint32_t transform_chunk = 16;  ///< rows or chirps that one task transforms

using Eight [[gnu::vector_size(32), gnu::aligned(4), gnu::may_alias]] = float;

/// Adds a patch to the rows of a grid. `rows` holds the places of its first column in each row of the first
/// group, or null for a row that another task adds to; the groups are `group_stride` floats apart. `values`
/// is [groups, 8].
GREATX_LANES void spread_patch(float* const* rows, size_t group_stride, uint32_t groups, const float* values,
                               const float* range_weights, const float* doppler_weights) {
  for (uint32_t group = 0; group < groups; ++group) {
    const Eight value = *reinterpret_cast<const Eight*>(values + 8 * group);
    Eight along[kernel_taps];
    for (int d = 0; d < kernel_taps; ++d) along[d] = value * doppler_weights[d];
    for (int r = 0; r < kernel_taps; ++r) {
      if (rows[r] == nullptr) continue;
      Eight* const cells = reinterpret_cast<Eight*>(rows[r] + group * group_stride);
      for (int d = 0; d < kernel_taps; ++d) cells[d] += along[d] * range_weights[r];
    }
  }
}

/// Computes cos and sin of 2 pi `turns`, [count].
GREATX_LANES void phasors_of(const float* turns, uint32_t count, float* re, float* im) {
  for (uint32_t i = 0; i < count; ++i) cos_sin_of_turns(turns[i], re[i], im[i]);
}

/// Holds the elements of both arrays in world axes.
struct Leads {
  std::vector<dvec3> transmit, receive;  ///< m/c, s
  Leads(const RadarArrays& arrays, const RadarAttitude& attitude) {
    for (const dvec3& p : arrays.transmit_m) transmit.push_back(attitude.transmitter * p / speed_of_light);
    for (const dvec3& p : arrays.receive_m) receive.push_back(attitude.receiver * p / speed_of_light);
  }
};

/// The transforms along one axis of a block.
struct PatchAxis {
  PatchKernel kernel;
  Fft transform;
  explicit PatchAxis(uint32_t count) : kernel(count), transform(kernel.grid(), Fft::Direction::backward) {}
  /// Reads [grid] cells and writes the outputs, [count], in order.
  void outputs(const Fft::Value* cells, Fft::Value* room, Fft::Value* out) const {
    transform.transform(cells, room);
    const uint32_t count = kernel.count(), middle = count / 2, grid = kernel.grid();
    for (uint32_t i = 0; i < count; ++i)
      out[i] = room[i >= middle ? i - middle : i + grid - middle] * Four(kernel.correction()[i]);
  }
};

}  // namespace

PatchBlock patch_block(const RadarWaveform& w, uint32_t first_slot, uint32_t slots, uint32_t blocks,
                       uint32_t block) {
  const uint32_t first = first_slot / w.loop();
  const uint64_t chirps = slots / w.loop();
  PatchBlock result;
  result.first = first + static_cast<uint32_t>(chirps * block / blocks);
  result.last = first + static_cast<uint32_t>(chirps * (block + 1) / blocks);
  const uint32_t middle = result.first + (result.last - result.first) / 2;
  result.middle_s = w.slot_middle_s(middle * w.loop()) + 0.5 * (w.loop() - 1) * w.interval_s;
  return result;
}

uint32_t patch_blocks(const RadarWaveform& w, uint32_t slots, double rate, double curvature_per_s) {
  const double frame_s = slots * w.interval_s;
  // 2 pi S rate (T/2)(N/2 f_s), and pi f_c curvature (T/2)^2.
  const double crossed = 0.5 * pi * w.bandwidth_hz() * rate * frame_s;
  const double bent = 0.25 * pi * w.carrier_hz * curvature_per_s * frame_s * frame_s;
  const double blocks = std::max(crossed / largest_patch_phase, std::sqrt(bent / largest_patch_phase));
  const uint32_t most = std::max(1u, slots / w.loop());
  return blocks >= most ? most : std::max(1u, static_cast<uint32_t>(std::ceil(blocks)));
}

/// Holds the axes that were asked for, by their numbers of outputs. A radar without patches has none.
struct PatchSynthesizer::Shared {
  RadarSignalConfig config;
  explicit Shared(const RadarSignalConfig& of) : config(of) {}
  const PatchAxis& axis(uint32_t count) {
    const std::lock_guard lock(mutex_);
    return axes_.try_emplace(count, count).first->second;
  }

 private:
  std::mutex mutex_;
  std::map<uint32_t, PatchAxis> axes_;
};

namespace {

/// Adds the patches of one block, or those of a block that share a node of the phase noise.
class BlockSum {
 public:
  BlockSum(const RadarSignalConfig& config, const PatchAxis& range, const PatchAxis& doppler,
           const PatchList& patches, const PatchBlock& block, uint32_t index, const Leads& leads,
           uint32_t threads, uint32_t term)
      : config_(config),
        w_(config.waveform),
        range_(range),
        doppler_(doppler),
        patches_(patches),
        block_(block),
        delay_(patches.delay_s.data() + index * patches.size()),
        rate_(patches.rate.data() + index * patches.size()),
        leads_(leads),
        threads_(threads),
        term_(term),
        antennas_(static_cast<uint32_t>(config.arrays.receive_m.size()) * w_.transmitters),
        groups_((antennas_ + Fft::lanes - 1) / Fft::lanes),
        rows_(range.kernel.grid()),
        columns_(doppler.kernel.grid()),
        stride_(columns_ + kernel_taps - 1),
        amplitude_scale_(static_cast<float>(std::sqrt(config.transmit_power_w))) {}

  /// `turns` [slots of the block, samples] is added to the phase of every sample; empty: nothing is.
  void add(std::span<const uint32_t> members, std::span<const float> turns,
           std::span<std::complex<float>> cube) {
    sort(members);
    grid_.assign(size_t{groups_} * rows_ * stride_, Fft::Value{});
    parallel_for((rows_ + stripe_rows - 1) / stripe_rows, threads_, [&](size_t stripe) {
      const uint32_t begin = static_cast<uint32_t>(stripe) * stripe_rows;
      spread(begin, std::min(rows_, begin + stripe_rows));
    });
    in_chunks(rows_, [&](uint32_t begin, uint32_t end) { transform_rows(begin, end); });
    in_chunks(block_.last - block_.first,
              [&](uint32_t begin, uint32_t end) { transform_chirps(begin, end, turns, cube); });
  }

 private:
  double doppler_hz(uint32_t i) const { return w_.doppler_hz(delay_[i], rate_[i]); }
  double range_turns(uint32_t i) const { return w_.tone_hz(delay_[i], rate_[i]) / w_.sample_rate_hz; }

  static float turn_part(double turns) { return static_cast<float>(turns - nearest(turns)); }

  /// Orders the members by the first row of their kernels; first_ [rows + 1] says where each row begins.
  void sort(std::span<const uint32_t> members) {
    std::vector<uint32_t> row(members.size());
    first_.assign(rows_ + 1, 0);
    for (size_t k = 0; k < members.size(); ++k) {
      row[k] = range_.kernel.first_cell(range_turns(members[k]));
      ++first_[row[k] + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    order_.resize(members.size());
    std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
    for (size_t k = 0; k < members.size(); ++k) order_[next[row[k]]++] = members[k];
  }

  /// Room for the amplitudes of a patch.
  struct Room {
    std::vector<float> turns, re, im;  ///< [1 + transmitters + receivers]
    std::vector<float> values;         ///< [groups, re 4 | im 4] virtual antennas
  };

  /// Computes the amplitudes of a patch at all virtual antennas.
  void amplitudes(uint32_t i, Room& room) const {
    const double tau = delay_[i], doppler = doppler_hz(i);
    const double square = w_.squared_slope(), lead_hz = square * tau - w_.carrier_hz;
    const float scale = w_.coded() ? amplitude_scale_ * symbol_weight(w_, rate_[i], term_) : amplitude_scale_;
    const dvec3 out(patches_.departure[i]), in(patches_.arrival_of(i));
    const uint32_t transmitters = w_.transmitters, receivers = static_cast<uint32_t>(leads_.receive.size());
    float* turns = room.turns.data();
    const auto add = [&](double value) { *turns++ = turn_part(value); };
    const ExactProduct carrier = exact_product(w_.carrier_hz, tau);
    add((carrier.value - nearest(carrier.value)) + carrier.error - 0.5 * square * tau * tau);
    for (uint32_t t = 0; t < transmitters; ++t)
      add(lead_hz * glm::dot(leads_.transmit[t], out) +
          (w_.loop() > 1 ? doppler * (t - 0.5 * (transmitters - 1)) * w_.interval_s : 0.0));
    for (uint32_t r = 0; r < receivers; ++r) add(lead_hz * glm::dot(leads_.receive[r], in));
    phasors_of(room.turns.data(), 1 + transmitters + receivers, room.re.data(), room.im.data());
    const auto phasor = [&](uint32_t at) { return std::complex<float>(room.re[at], room.im[at]); };
    const std::complex<float> conjugate(scale * patches_.re[i], -scale * patches_.im[i]),
        base = plain_product(conjugate, phasor(0));
    for (uint32_t t = 0; t < transmitters; ++t) {
      const std::complex<float> sent = plain_product(base, phasor(1 + t));
      for (uint32_t r = 0; r < receivers; ++r) {
        const std::complex<float> value = plain_product(sent, phasor(1 + transmitters + r));
        const uint32_t antenna = r * transmitters + t;
        room.values[8 * (antenna / 4) + antenna % 4] = value.real();
        room.values[8 * (antenna / 4) + antenna % 4 + 4] = value.imag();
      }
    }
  }

  /// Adds to rows [begin, end) what all patches have there, in the order of the patches.
  void spread(uint32_t begin, uint32_t end) {
    Room room;
    for (auto* column : {&room.turns, &room.re, &room.im})
      column->resize(1 + w_.transmitters + leads_.receive.size());
    room.values.resize(8 * groups_, 0.0f);
    std::array<float, kernel_taps> range_weights, doppler_weights;
    std::array<float*, kernel_taps> rows;
    for (uint32_t k = 0; k < std::min(rows_, end - begin + kernel_taps - 1); ++k) {
      const uint32_t row = (begin + rows_ + k - (kernel_taps - 1)) % rows_;
      for (uint32_t at = first_[row]; at < first_[row + 1]; ++at) {
        const uint32_t i = order_[at];
        range_.kernel.spread(range_turns(i), range_weights);
        const uint32_t column = doppler_.kernel.spread(doppler_hz(i) * w_.repetition_s(), doppler_weights);
        for (int tap = 0; tap < kernel_taps; ++tap) {
          const uint32_t to = (row + tap) % rows_;
          rows[tap] = to >= begin && to < end ? reinterpret_cast<float*>(row_of(0, to) + column) : nullptr;
        }
        amplitudes(i, room);
        spread_patch(rows.data(), size_t{8} * rows_ * stride_, groups_, room.values.data(),
                     range_weights.data(), doppler_weights.data());
      }
    }
  }

  Fft::Value* row_of(uint32_t group, uint32_t row) {
    return grid_.data() + (size_t{group} * rows_ + row) * stride_;
  }
  bool empty(uint32_t row) const {
    for (uint32_t k = 0; k < kernel_taps; ++k) {
      const uint32_t from = (row + rows_ - k) % rows_;
      if (first_[from] != first_[from + 1]) return false;
    }
    return true;
  }

  template <typename Work>
  void in_chunks(uint32_t count, const Work& work) const {
    parallel_for((count + transform_chunk - 1) / transform_chunk, threads_, [&](size_t chunk) {
      const uint32_t begin = static_cast<uint32_t>(chunk) * transform_chunk;
      work(begin, std::min(count, begin + transform_chunk));
    });
  }

  /// Replaces rows of Doppler frequencies by the chirps of the block.
  void transform_rows(uint32_t begin, uint32_t end) {
    std::vector<Fft::Value> room(columns_), out(doppler_.kernel.count());
    for (uint32_t row = begin; row < end; ++row) {
      if (empty(row)) continue;
      for (uint32_t group = 0; group < groups_; ++group) {
        Fft::Value* const cells = row_of(group, row);
        for (uint32_t k = columns_; k < stride_; ++k) cells[k - columns_] += cells[k];
        doppler_.outputs(cells, room.data(), out.data());
        std::copy(out.begin(), out.end(), cells);
      }
    }
  }

  /// Transforms the beat frequencies of chirps to their samples, and adds them.
  void transform_chirps(uint32_t begin, uint32_t end, std::span<const float> turns,
                        std::span<std::complex<float>> cube) {
    std::vector<Fft::Value> cells(rows_), room(rows_), out(w_.samples);
    std::vector<std::complex<float>> lines(size_t{Fft::lanes} * w_.samples);
    std::complex<float>* rows[Fft::lanes];
    for (uint32_t lane = 0; lane < Fft::lanes; ++lane) rows[lane] = lines.data() + lane * w_.samples;
    for (uint32_t chirp = begin; chirp < end; ++chirp)
      for (uint32_t group = 0; group < groups_; ++group) {
        const Fft::Value* from = row_of(group, 0) + chirp;
        for (uint32_t row = 0; row < rows_; ++row) cells[row] = from[size_t{row} * stride_];
        range_.outputs(cells.data(), room.data(), out.data());
        Fft::scatter(out.data(), w_.samples, rows);
        for (uint32_t lane = 0; lane < Fft::lanes && group * Fft::lanes + lane < antennas_; ++lane)
          add_line(group * Fft::lanes + lane, chirp, rows[lane], turns, cube);
      }
  }
  void add_line(uint32_t antenna, uint32_t chirp, const std::complex<float>* line,
                std::span<const float> turns, std::span<std::complex<float>> cube) const {
    if (w_.bands() > 1) return add_band(antenna, chirp, line, turns, cube);
    std::complex<float>* const to =
        cube.data() + (size_t{antenna} * w_.chirps() + block_.first + chirp) * w_.samples;
    if (turns.empty()) {
      for (uint32_t n = 0; n < w_.samples; ++n) to[n] += line[n];
      return;
    }
    const uint32_t slot = chirp * w_.transmitters + antenna % w_.transmitters;
    const float* const turn = turns.data() + size_t{slot} * w_.samples;
    for (uint32_t n = 0; n < w_.samples; ++n) to[n] += turned_sample(line[n], turn[n]);
  }

  /// The same for a transmitter that sends together with the others.
  void add_band(uint32_t antenna, uint32_t chirp, const std::complex<float>* line,
                std::span<const float> turns, std::span<std::complex<float>> cube) const {
    const uint32_t slot = block_.first + chirp;
    std::complex<float>* const to =
        cube.data() + size_t{w_.row(antenna / w_.transmitters, slot)} * w_.samples;
    const float band = static_cast<float>(w_.band_turns(antenna % w_.transmitters, slot));
    const float* const turn = turns.empty() ? nullptr : turns.data() + size_t{chirp} * w_.samples;
    for (uint32_t n = 0; n < w_.samples; ++n) to[n] += turned_sample(line[n], turn ? turn[n] + band : band);
  }

  const RadarSignalConfig& config_;
  const RadarWaveform& w_;
  const PatchAxis &range_, &doppler_;
  const PatchList& patches_;
  const PatchBlock block_;
  const double *delay_, *rate_;
  const Leads& leads_;
  const uint32_t threads_, term_, antennas_, groups_, rows_, columns_, stride_;
  const float amplitude_scale_;
  std::vector<uint32_t> order_, first_;
  std::vector<Fft::Value>
      grid_;  ///< [groups][rows][stride]: the last cells of a row belong to its first ones
};

/// Returns the phases of the oscillator over the slots of a block for a node, [slots, samples] turns.
std::vector<float> walk_turns(const PhaseWalk& walk, const RadarWaveform& w, const PatchBlock& block,
                              uint32_t node, uint32_t threads) {
  const uint32_t first = block.first * w.loop(), slots = (block.last - block.first) * w.loop();
  std::vector<float> turns(size_t{slots} * w.samples);
  parallel_for(slots, threads, [&](size_t slot) {
    PhaseWalk::Ramp ramp = walk.ramp(first + static_cast<uint32_t>(slot));
    ramp.differences(node, std::span(turns).subspan(slot * w.samples, w.samples));
  });
  return turns;
}

}  // namespace

PatchSynthesizer::PatchSynthesizer(const RadarSignalConfig& config)
    : shared_(std::make_unique<Shared>(config)) {}
PatchSynthesizer::~PatchSynthesizer() = default;
PatchSynthesizer::PatchSynthesizer(PatchSynthesizer&&) noexcept = default;

void PatchSynthesizer::add(const PatchList& patches, uint32_t first_slot, uint32_t slots,
                           const RadarAttitude& attitude, const PhaseWalk* walk, uint32_t threads,
                           std::span<std::complex<float>> cube, uint32_t term) const {
  const RadarSignalConfig& config = shared_->config;
  const RadarWaveform& w = config.waveform;
  if (patches.empty()) return;
  GREATX_CHECK(patches.delay_s.size() == patches.blocks * patches.size(), "{} delays of {} patches",
               patches.delay_s.size(), patches.size());
  GREATX_CHECK(first_slot % w.loop() == 0 && slots % w.loop() == 0, "slots {} + {} of {}", first_slot, slots,
               w.transmitters);
  const Leads leads(config.arrays, attitude);
  for (uint32_t index = 0; index < patches.blocks; ++index) {
    const PatchBlock block = patch_block(w, first_slot, slots, patches.blocks, index);
    BlockSum sum(config, shared_->axis(w.samples), shared_->axis(block.last - block.first), patches, block,
                 index, leads, threads, term);
    std::vector<uint32_t> members(patches.size());
    std::iota(members.begin(), members.end(), 0u);
    if (walk == nullptr) {
      sum.add(members, {}, cube);
      continue;
    }
    const auto node_of = [&](uint32_t i) {
      return PhaseWalk::node_of(patches.delay_s[index * patches.size() + i]);
    };
    std::stable_sort(members.begin(), members.end(),
                     [&](uint32_t a, uint32_t b) { return node_of(a) < node_of(b); });
    for (size_t begin = 0, end = 0; begin < members.size(); begin = end) {
      const uint32_t node = node_of(members[begin]);
      while (end < members.size() && node_of(members[end]) == node) ++end;
      sum.add(std::span(members).subspan(begin, end - begin), walk_turns(*walk, w, block, node, threads),
              cube);
    }
  }
}

}  // namespace greatx::rf
