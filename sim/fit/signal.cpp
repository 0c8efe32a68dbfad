// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/fit/signal.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "core/phase.h"
#include "core/units.h"
#include "rf/channel/pair_amplitudes.h"

namespace greatx::sim {
namespace {

using rf::Complex;
using rf::fraction_of_turn;
using rf::plain_product;
using rf::turns_of;
using rf::unit_phasor;

constexpr double db_per_neper = 10.0 / std::numbers::ln10;

double subcarrier_number(uint32_t k, uint32_t subcarriers) {
  return static_cast<double>(k) - static_cast<double>(subcarriers / 2);
}

rf::ArrayPose turned(rf::ArrayPose end, double yaw) {
  if (yaw != 0.0) end.orientation = glm::angleAxis(yaw, dvec3(0.0, 0.0, 1.0)) * end.orientation;
  return end;
}

rf::ArrayPose one_element(rf::ArrayPose end) {
  end.array.rows = end.array.columns = 1;
  end.array.positions_m.clear();
  return end;
}

/// Returns the phasors of a delay at all subcarriers. Every 32nd one is computed afresh, so that roundings do
/// not add up.
void phasors_of(double delay_s, const FitBand& band, double carrier_hz, std::vector<Complex>& out) {
  constexpr uint32_t afresh = 32;
  const Complex step = unit_phasor(-turns_of(band.spacing_hz, delay_s));
  const double at_carrier = turns_of(carrier_hz, delay_s);
  Complex phasor;
  for (uint32_t k = 0; k < band.subcarriers; ++k) {
    phasor = k % afresh == 0 ? unit_phasor(-at_carrier - turns_of(subcarrier_number(k, band.subcarriers),
                                                                  band.spacing_hz, delay_s))
                             : plain_product(phasor, step);
    out[k] = phasor;
  }
}

std::vector<double> window_of(const FitBand& band) {
  std::vector<double> window(band.subcarriers, 1.0);
  if (!band.hann) return window;
  double sum = 0.0;
  for (uint32_t k = 0; k < band.subcarriers; ++k) {
    window[k] = 0.5 - 0.5 * std::cos(2.0 * pi * (k + 0.5) / band.subcarriers);
    sum += window[k];
  }
  for (double& w : window) w *= band.subcarriers / sum;
  return window;
}

}  // namespace

FitWeights weights_of(const FitLink& link, const FitSet& set, double carrier_hz, double transmitter_yaw,
                      double receiver_yaw) {
  const bool one_pair = set.quantity == FitQuantity::cir || set.quantity == FitQuantity::cfr;
  const bool powers_add = !one_pair && !set.coherent && !set.from_response;
  rf::ArrayPose transmitter = turned(link.transmitter, transmitter_yaw),
                receiver = turned(link.receiver, receiver_yaw);
  if (powers_add) transmitter = one_element(transmitter), receiver = one_element(receiver);
  rf::PairAmplitudes amplitudes(transmitter, receiver, carrier_hz);
  const size_t all = amplitudes.pairs();
  const size_t chosen = size_t{set.receive_port} * transmitter.array.port_count() + set.transmit_port;
  FitWeights weights;
  weights.pairs = one_pair ? 1 : all;
  weights.of.resize(link.paths.size() * weights.pairs);
  std::vector<Complex> out(all);
  for (size_t i = 0; i < link.paths.size(); ++i)
    for (size_t e = 0; e < 4; ++e) {
      Complex unit[4]{};
      unit[e] = 1.0;
      amplitudes(link.paths[i], unit, out.data());
      for (size_t p = 0; p < weights.pairs; ++p)
        weights.of[i * weights.pairs + p][e] = out[one_pair ? chosen : p];
    }
  return weights;
}

Signal response_of(const PathTerms& terms, const FitBand& band, double carrier_hz, bool slopes) {
  const size_t count = band.subcarriers, pairs = terms.pairs;
  Signal signal;
  signal.value.resize(pairs * count);
  if (slopes) signal.slopes.assign(terms.columns, std::vector<Complex>(pairs * count));
  std::vector<Complex> phasors(count);
  size_t next = 0;  // the slopes of the amplitudes are in the order of the paths
  const auto add = [&](std::vector<Complex>& to, std::span<const Complex> amplitudes) {
    for (size_t p = 0; p < pairs; ++p)
      for (size_t k = 0; k < count; ++k) to[p * count + k] += plain_product(amplitudes[p], phasors[k]);
  };
  for (size_t i = 0; i < terms.delays_s.size(); ++i) {
    const std::span amplitudes = std::span(terms.amplitudes).subspan(i * pairs, pairs);
    phasors_of(terms.delays_s[i], band, carrier_hz, phasors);
    add(signal.value, amplitudes);
    if (!slopes) continue;
    for (; next < terms.amplitude_slopes.size() && terms.amplitude_slopes[next].path == i; ++next)
      add(signal.slopes[terms.amplitude_slopes[next].column], terms.amplitude_slopes[next].of);
    for (const PathTerms::DelaySlope& slope : terms.delay_slopes)
      for (size_t p = 0; p < pairs; ++p)
        for (size_t k = 0; k < count; ++k) {
          const double hz =
              carrier_hz + subcarrier_number(static_cast<uint32_t>(k), band.subcarriers) * band.spacing_hz;
          signal.slopes[slope.column][p * count + k] += plain_product(
              plain_product(amplitudes[p], phasors[k]), Complex(0.0, -2.0 * pi * hz * slope.of[i]));
        }
  }
  return signal;
}

Signal taps_of(const Signal& response, const FitBand& band, size_t pairs) {
  const size_t count = band.subcarriers;
  const std::vector<double> window = window_of(band);
  Eigen::FFT<double> fft;
  std::vector<Complex> in(count), out(count);
  const auto transformed = [&](const std::vector<Complex>& of) {
    std::vector<Complex> taps(pairs * band.taps);
    for (size_t p = 0; p < pairs; ++p) {
      for (size_t k = 0; k < count; ++k) in[k] = of[p * count + k] * window[k];
      fft.inv(out, in);  // with the factor 1/count
      for (uint32_t t = 0; t < band.taps; ++t) {
        const int64_t tap = int64_t{band.first_tap} + t, all = static_cast<int64_t>(count);
        const int64_t place = ((tap % all) + all) % all;
        const double turns = static_cast<double>(place) * (band.subcarriers / 2) / static_cast<double>(count);
        taps[p * band.taps + t] = out[static_cast<size_t>(place)] * unit_phasor(-fraction_of_turn(turns));
      }
    }
    return taps;
  };
  Signal taps;
  taps.value = transformed(response.value);
  for (const std::vector<Complex>& slope : response.slopes) taps.slopes.push_back(transformed(slope));
  return taps;
}

std::vector<rf::Complex> response_of_taps(std::span<const rf::Complex> taps) {
  const size_t count = taps.size();
  std::vector<Complex> in(count), out(count);
  for (size_t l = 0; l < count; ++l) {
    const double turns = static_cast<double>(l) * static_cast<double>(count / 2) / static_cast<double>(count);
    in[l] = taps[l] * unit_phasor(fraction_of_turn(turns));
  }
  Eigen::FFT<double> fft;
  fft.fwd(out, in);
  return out;
}

FitRows powers_of(const PathTerms& terms, bool slopes) {
  const auto paths = static_cast<Eigen::Index>(terms.delays_s.size());
  const double share = 1.0 / static_cast<double>(terms.pairs);
  FitRows rows{Eigen::VectorXd::Zero(paths),
               Eigen::MatrixXd::Zero(paths, slopes ? static_cast<Eigen::Index>(terms.columns) : 0)};
  for (Eigen::Index i = 0; i < paths; ++i)
    for (size_t p = 0; p < terms.pairs; ++p)
      rows.value[i] += share * std::norm(terms.amplitudes[static_cast<size_t>(i) * terms.pairs + p]);
  if (!slopes) return rows;
  for (const PathTerms::AmplitudeSlope& slope : terms.amplitude_slopes)
    for (size_t p = 0; p < terms.pairs; ++p)
      rows.slopes(slope.path, slope.column) +=
          share * 2.0 * (std::conj(terms.amplitudes[slope.path * terms.pairs + p]) * slope.of[p]).real();
  return rows;
}

FitRows powers_of(const Signal& signal, size_t pairs) {
  const auto count = static_cast<Eigen::Index>(signal.value.size() / pairs);
  const double share = 1.0 / static_cast<double>(pairs);
  FitRows rows{Eigen::VectorXd::Zero(count),
               Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(signal.slopes.size()))};
  for (size_t i = 0; i < signal.value.size(); ++i) {
    const Eigen::Index row = static_cast<Eigen::Index>(i) % count;
    rows.value[row] += share * std::norm(signal.value[i]);
    for (size_t c = 0; c < signal.slopes.size(); ++c)
      rows.slopes(row, static_cast<Eigen::Index>(c)) +=
          share * 2.0 * (std::conj(signal.value[i]) * signal.slopes[c][i]).real();
  }
  return rows;
}

FitRows sum_of(const FitRows& powers) {
  return {Eigen::VectorXd::Constant(1, powers.value.sum()), powers.slopes.colwise().sum()};
}

FitRows mean_of(const FitRows& powers) {
  const double share = 1.0 / static_cast<double>(powers.value.size());
  return {Eigen::VectorXd::Constant(1, share * powers.value.sum()), share * powers.slopes.colwise().sum()};
}

FitRows delay_spread_of(const FitRows& powers, std::span<const double> delays_s,
                        std::span<const PathTerms::DelaySlope> delay_slopes) {
  constexpr double ns = 1e9;
  const double total = powers.value.sum(), origin = delays_s[0];
  double mean = 0.0, second = 0.0;
  for (Eigen::Index i = 0; i < powers.value.size(); ++i)
    mean += powers.value[i] * (delays_s[static_cast<size_t>(i)] - origin) / total;
  for (Eigen::Index i = 0; i < powers.value.size(); ++i) {
    const double off = delays_s[static_cast<size_t>(i)] - origin - mean;
    second += powers.value[i] * off * off / total;
  }
  const double spread = std::sqrt(second);
  FitRows rows{Eigen::VectorXd::Constant(1, ns * spread), Eigen::MatrixXd::Zero(1, powers.slopes.cols())};
  if (!(spread > 0.0)) return rows;
  for (Eigen::Index i = 0; i < powers.value.size(); ++i) {
    const double off = delays_s[static_cast<size_t>(i)] - origin - mean;
    rows.slopes.row(0) += ns * (off * off - second) / (2.0 * spread * total) * powers.slopes.row(i);
    if (powers.slopes.cols() == 0) continue;
    for (const PathTerms::DelaySlope& slope : delay_slopes)
      rows.slopes(0, slope.column) +=
          ns * powers.value[i] * off / (spread * total) * slope.of[static_cast<size_t>(i)];
  }
  return rows;
}

FitRows levels_of(const FitRows& powers, double scale_db, std::span<const double> floors, int scale_column) {
  const double scale = from_decibels(scale_db);
  FitRows rows = powers;
  for (Eigen::Index i = 0; i < powers.value.size(); ++i) {
    const double power = scale * powers.value[i];
    const double level = power + (floors.empty() ? 0.0 : floors[static_cast<size_t>(i)]);
    rows.value[i] = decibels(level);
    rows.slopes.row(i) *= db_per_neper * scale / level;
    if (scale_column >= 0 && powers.slopes.cols() > 0) rows.slopes(i, scale_column) = power / level;
  }
  return rows;
}

}  // namespace greatx::sim
