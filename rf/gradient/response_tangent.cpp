// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/error.h"
#include "core/phase.h"
#include "core/units.h"
#include "rf/channel/link_sum.h"
#include "rf/gradient/cotangent_sums.h"
#include "rf/gradient/path_at_arrays.h"
#include "rf/gradient/response_gradient.h"

namespace greatx::rf {
namespace {

constexpr size_t paths_at_once = 32;
constexpr size_t rows_at_once = 64;

/// One path of a chunk at both arrays.
struct LoadedPath {
  uint32_t index = 0;
  PathAmplitudes amplitudes;
  PathLeads leads;
  std::vector<Complex> turns;  ///< [time samples]
};

/// The amplitudes of a pair of ports and a path at one time: those of e^{-j 2 pi f tau}, and of f times it.
struct PairSlopes {
  Complex plain, by_frequency;
};

/// Adds the changes of a response along tangents, chunk after chunk of the paths.
class TangentSum {
 public:
  TangentSum(const ResponseLink& link, const ChannelGrid& grid)
      : link_(link),
        grid_(grid),
        squints_(link.transmitter.beam_squint),
        tx_ports_(link.transmitter.array.port_count()),
        rx_ports_(link.receiver.array.port_count()),
        offsets_hz_(offsets_hz(grid)),
        phasors_(grid.subcarriers) {}

  void add_chunk(std::span<const uint32_t> chunk, std::span<const LinkTangent> tangents,
                 std::span<Complex> out);

 private:
  void set_factor(double delay_s, size_t place, ColumnFactors& factors);
  PairSlopes slopes_of(const LoadedPath& loaded, size_t rx_port, size_t tx_port, const LinkTangent& tangent,
                       double time_s) const;
  void add_rows_of(std::span<const size_t> pairs, const std::vector<LoadedPath>& loaded,
                   const ColumnFactors& factors, const LinkTangent& tangent, Complex* out);

  const ResponseLink& link_;
  const ChannelGrid& grid_;
  const bool squints_;
  const size_t tx_ports_, rx_ports_;
  std::vector<double> offsets_hz_;
  BlockedRow phasors_;
  std::vector<Complex> amplitudes_;  ///< [rows, terms]
};

void TangentSum::set_factor(double delay_s, size_t place, ColumnFactors& factors) {
  set_path_phasors(grid_, delay_s, phasors_);
  for (size_t block = 0; block < factors.blocks(); ++block) {
    const double* const from = phasors_.data() + block * 2 * sum_lanes;
    double* const plain = factors.at(block, 2 * place);
    double* const by_frequency = factors.at(block, 2 * place + 1);
    for (size_t i = 0; i < 2 * sum_lanes; ++i) {
      plain[i] = from[i];
      by_frequency[i] = from[i] * offsets_hz_[block * sum_lanes + i % sum_lanes];
    }
  }
}

PairSlopes TangentSum::slopes_of(const LoadedPath& loaded, size_t rx_port, size_t tx_port,
                                 const LinkTangent& tangent, double time_s) const {
  const PathTangent& change = tangent.paths[loaded.index];
  const size_t rx_pols = loaded.amplitudes.rx_polarizations(), tx_pols = loaded.amplitudes.tx_polarizations();
  const size_t u = rx_port / rx_pols, s = tx_port / tx_pols, r = rx_port % rx_pols, t = tx_port % tx_pols;
  const double lead_s = loaded.leads.lead_m(u, s) / speed_of_light,
               d_lead_s = loaded.leads.slope_m(u, s, change, tangent) / speed_of_light,
               delay_s = link_.paths[loaded.index].delay_s,
               d_delay_s = change.slope.length_m / speed_of_light;
  const double d_turns = grid_.carrier_hz * (d_lead_s - d_delay_s) + tangent.carrier_hz * (lead_s - delay_s) +
                         change.slope.doppler_hz * time_s;
  const Complex amplitude = loaded.amplitudes.amplitude(r, t);
  const Complex rx_gain = gain_of(link_.receiver_gains, rx_port),
                tx_gain = gain_of(link_.transmitter_gains, tx_port);
  const auto change_of = [](const std::vector<Complex>& changes, size_t port) {
    return changes.empty() ? Complex(0.0) : changes[port];
  };
  const Complex d_gain = change_of(tangent.receiver.gains, rx_port) * tx_gain +
                         rx_gain * change_of(tangent.transmitter.gains, tx_port);
  const Complex gain = rx_gain * tx_gain, turn = unit_phasor(turns_of(grid_.carrier_hz, lead_s));
  const Complex d_amplitude =
      loaded.amplitudes.slope(r, t, change.slope, tangent) + amplitude * Complex(0.0, 2.0 * pi * d_turns);
  return {(gain * d_amplitude + d_gain * amplitude) * turn,
          gain * amplitude * Complex(0.0, 2.0 * pi * ((squints_ ? d_lead_s : 0.0) - d_delay_s)) * turn};
}

/// Adds the rows of these pairs of ports, which share the factors.
void TangentSum::add_rows_of(std::span<const size_t> pairs, const std::vector<LoadedPath>& loaded,
                             const ColumnFactors& factors, const LinkTangent& tangent, Complex* out) {
  const size_t samples = grid_.time_samples, rows = pairs.size() * samples, terms = 2 * loaded.size();
  amplitudes_.resize(rows * terms);
  for (size_t i = 0; i < rows; ++i)
    for (size_t place = 0; place < loaded.size(); ++place) {
      const size_t pair = pairs[i / samples], m = i % samples;
      const PairSlopes slopes = slopes_of(loaded[place], pair / tx_ports_, pair % tx_ports_, tangent,
                                          static_cast<double>(m) * grid_.time_spacing_s);
      amplitudes_[i * terms + 2 * place] = slopes.plain * loaded[place].turns[m];
      amplitudes_[i * terms + 2 * place + 1] = slopes.by_frequency * loaded[place].turns[m];
    }
  static const AddRows add = add_rows();
  double tile[rows_at_once * 2 * sum_lanes];
  for (size_t first = 0; first < rows; first += rows_at_once)
    for (size_t block = 0; block < factors.blocks(); ++block) {
      const size_t count = std::min(rows_at_once, rows - first);
      std::fill_n(tile, count * 2 * sum_lanes, 0.0);
      add(amplitudes_.data() + first * terms, terms, count, factors.block(block), terms, tile);
      const size_t column = block * sum_lanes, columns = std::min(sum_lanes, grid_.subcarriers - column);
      for (size_t i = 0; i < count; ++i) {
        const size_t row = pairs[(first + i) / samples] * samples + (first + i) % samples;
        const double* const sums = tile + i * 2 * sum_lanes;
        for (size_t lane = 0; lane < columns; ++lane)
          out[row * grid_.subcarriers + column + lane] += Complex(sums[lane], sums[sum_lanes + lane]);
      }
    }
}

void TangentSum::add_chunk(std::span<const uint32_t> chunk, std::span<const LinkTangent> tangents,
                           std::span<Complex> out) {
  std::vector<LoadedPath> loaded;
  for (const uint32_t index : chunk) {
    const Path& path = link_.paths[index];
    LoadedPath one{index, {link_, grid_.carrier_hz}, {link_.transmitter, link_.receiver}, {}};
    one.amplitudes.load(path);
    one.leads.load(path);
    const Complex carrier = unit_phasor(-turns_of(grid_.carrier_hz, path.delay_s));
    for (uint32_t m = 0; m < grid_.time_samples; ++m)
      one.turns.push_back(
          carrier * unit_phasor(turns_of(static_cast<double>(m), grid_.time_spacing_s, path.doppler_hz)));
    loaded.push_back(std::move(one));
  }
  ColumnFactors factors(grid_.subcarriers, 2 * loaded.size());
  const size_t size = out.size() / std::max<size_t>(1, tangents.size());
  const auto add_all = [&](std::span<const size_t> pairs) {
    for (size_t n = 0; n < tangents.size(); ++n)
      add_rows_of(pairs, loaded, factors, tangents[n], out.data() + n * size);
  };
  std::vector<size_t> pairs;
  if (!squints_) {
    for (size_t place = 0; place < loaded.size(); ++place)
      set_factor(link_.paths[loaded[place].index].delay_s, place, factors);
    for (size_t pair = 0; pair < rx_ports_ * tx_ports_; ++pair) pairs.push_back(pair);
    return add_all(pairs);
  }
  const size_t rx_pols = link_.receiver.array.polarization_count(),
               tx_pols = link_.transmitter.array.polarization_count();
  for (size_t u = 0; u < rx_ports_ / rx_pols; ++u)
    for (size_t s = 0; s < tx_ports_ / tx_pols; ++s) {
      for (size_t place = 0; place < loaded.size(); ++place)
        set_factor(
            link_.paths[loaded[place].index].delay_s - loaded[place].leads.lead_m(u, s) / speed_of_light,
            place, factors);
      pairs.clear();
      for (size_t r = 0; r < rx_pols; ++r)
        for (size_t t = 0; t < tx_pols; ++t) pairs.push_back((u * rx_pols + r) * tx_ports_ + s * tx_pols + t);
      add_all(pairs);
    }
}

}  // namespace

void ResponseGradient::push_forward(std::span<const LinkTangent> tangents, std::span<Complex> out) const {
  GREATX_CHECK(out.size() == tangents.size() * size(), "room for {} of {} values", out.size(),
               tangents.size() * size());
  for (const LinkTangent& tangent : tangents)
    GREATX_CHECK(tangent.paths.size() == link_.paths.size(), "tangents of {} of {} paths",
                 tangent.paths.size(), link_.paths.size());
  std::vector<uint32_t> selected;
  for (uint32_t i = 0; i < link_.paths.size(); ++i)
    if (is_selected(link_.paths[i], selection_)) selected.push_back(i);
  TangentSum sum(link_, grid_);
  for (size_t first = 0; first < selected.size(); first += paths_at_once)
    sum.add_chunk(std::span(selected).subspan(first, std::min(paths_at_once, selected.size() - first)),
                  tangents, out);
}

}  // namespace greatx::rf
