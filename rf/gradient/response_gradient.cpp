// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/gradient/response_gradient.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/phase.h"
#include "core/units.h"
#include "rf/channel/pair_amplitudes.h"
#include "rf/gradient/cotangent_sums.h"
#include "rf/gradient/path_at_arrays.h"

namespace greatx::rf {
namespace {

constexpr Complex two_pi_j{0.0, 2.0 * pi};

double real_product(Complex a, Complex b) { return a.real() * b.real() - a.imag() * b.imag(); }

void check_gains(const std::vector<Complex>& gains, const ArrayPose& end) {
  GREATX_CHECK(gains.empty() || gains.size() == end.array.port_count(), "{} gains of {} ports", gains.size(),
               end.array.port_count());
}

double along_end(const EndCotangent& cotangent, const EndTangent& tangent) {
  double sum = glm::dot(cotangent.attitude, tangent.attitude);
  for (size_t p = 0; p < 2; ++p) sum += cotangent.slants[p] * tangent.slants[p];
  for (size_t port = 0; port < tangent.gains.size(); ++port)
    sum += real_product(cotangent.gains[port], tangent.gains[port]);
  return sum;
}

/// The sums over subcarriers and time samples of one pair of ports and one path, without the amplitude.
struct PairSums {
  Complex plain{0.0};         ///< conj(G) e^{...}
  Complex by_frequency{0.0};  ///< the same times f
  Complex by_time{0.0};       ///< the same times t
};

/// Pulls one path after the other back from the cotangents of a link.
class PathPuller {
 public:
  PathPuller(const ResponseLink& link, const ChannelGrid& grid, std::span<const Complex> cotangent)
      : link_(link),
        grid_(grid),
        squints_(link.transmitter.beam_squint),
        amplitudes_(link, grid.carrier_hz),
        leads_(link.transmitter, link.receiver),
        phasors_(grid.subcarriers),
        offsets_hz_(offsets_hz(grid)) {
    row_doubles_ = phasors_.blocks() * 2 * sum_lanes;
    rows_.resize(cotangent.size() / grid.subcarriers * row_doubles_);
    double* to = rows_.data();
    for (const Complex* from = cotangent.data(); from != cotangent.data() + cotangent.size();)
      for (size_t first = 0; first < grid.subcarriers; first += sum_lanes, to += 2 * sum_lanes) {
        const size_t count = std::min<size_t>(sum_lanes, grid.subcarriers - first);
        for (size_t lane = 0; lane < count; ++lane, ++from)
          to[lane] = from->real(), to[sum_lanes + lane] = from->imag();
      }
  }

  void pull(const Path& path, PathCotangent& out, LinkCotangent& all);

 private:
  PairSums sums_of(size_t rx_port, size_t tx_port, const std::vector<Complex>& turns) const;
  void pull_fields(const Path& path, const Complex (&weights)[2][2], PathCotangent& out,
                   LinkCotangent& all) const;

  const ResponseLink& link_;
  const ChannelGrid& grid_;
  const bool squints_;
  PathAmplitudes amplitudes_;
  PathLeads leads_;
  BlockedRow phasors_;
  std::vector<double> offsets_hz_;
  size_t row_doubles_ = 0;
  std::vector<double> rows_;  ///< [rx_ant, tx_ant, time] cotangents as BlockedRow has them
};

PairSums PathPuller::sums_of(size_t rx_port, size_t tx_port, const std::vector<Complex>& turns) const {
  static const CotangentSum sum = cotangent_sums();
  const size_t first = (rx_port * link_.transmitter.array.port_count() + tx_port) * turns.size();
  PairSums sums;
  for (size_t m = 0; m < turns.size(); ++m) {
    const CotangentSums one = sum(rows_.data() + (first + m) * row_doubles_, phasors_.data(),
                                  offsets_hz_.data(), phasors_.blocks());
    const Complex plain = plain_product(one.plain, turns[m]);
    sums.plain += plain;
    sums.by_frequency += plain_product(one.by_frequency, turns[m]);
    sums.by_time += plain * (static_cast<double>(m) * grid_.time_spacing_s);
  }
  return sums;
}

/// Goes from the weights of the products F_R^T T F_T, [rx polarization][tx polarization], to transfer and
/// fields, and from the fields to directions, attitudes and slants.
void PathPuller::pull_fields(const Path& path, const Complex (&weights)[2][2], PathCotangent& out,
                             LinkCotangent& all) const {
  Jones by_received[2], by_sent[2];
  for (size_t r = 0; r < amplitudes_.rx_polarizations(); ++r)
    for (size_t s = 0; s < amplitudes_.tx_polarizations(); ++s) {
      const Complex weight = amplitudes_.scale() * weights[r][s];
      const Jones &received = amplitudes_.received(r).field, &sent = amplitudes_.sent(s).field;
      out.transfer[0] += weight * received.theta * sent.theta;
      out.transfer[1] += weight * received.theta * sent.phi;
      out.transfer[2] += weight * received.phi * sent.theta;
      out.transfer[3] += weight * received.phi * sent.phi;
      const Complex* const t = path.transfer;
      by_received[r].theta += weight * (t[0] * sent.theta + t[1] * sent.phi);
      by_received[r].phi += weight * (t[2] * sent.theta + t[3] * sent.phi);
      by_sent[s].theta += weight * (received.theta * t[0] + received.phi * t[2]);
      by_sent[s].phi += weight * (received.theta * t[1] + received.phi * t[3]);
    }
  const auto pull_end = [](const FieldSlopes& field, const Jones& by, size_t p, dvec3& direction,
                           EndCotangent& end) {
    const auto times = [&](const Jones& slope) {
      return real_product(by.theta, slope.theta) + real_product(by.phi, slope.phi);
    };
    for (int x = 0; x < 3; ++x) {
      direction[x] += times(field.by_direction[static_cast<size_t>(x)]);
      end.attitude[x] += times(field.by_attitude[static_cast<size_t>(x)]);
    }
    end.slants[p] += times(field.by_slant);
  };
  for (size_t r = 0; r < amplitudes_.rx_polarizations(); ++r)
    pull_end(amplitudes_.received(r), by_received[r], r, out.arrival, all.receiver);
  for (size_t s = 0; s < amplitudes_.tx_polarizations(); ++s)
    pull_end(amplitudes_.sent(s), by_sent[s], s, out.departure, all.transmitter);
}

void PathPuller::pull(const Path& path, PathCotangent& out, LinkCotangent& all) {
  amplitudes_.load(path);
  leads_.load(path);
  const double carrier_hz = grid_.carrier_hz, delay_s = path.delay_s;
  std::vector<Complex> turns;
  const Complex carrier = unit_phasor(-turns_of(carrier_hz, delay_s));
  for (uint32_t m = 0; m < grid_.time_samples; ++m)
    turns.push_back(carrier *
                    unit_phasor(turns_of(static_cast<double>(m), grid_.time_spacing_s, path.doppler_hz)));
  if (!squints_) set_path_phasors(grid_, delay_s, phasors_);
  const size_t rx_pols = amplitudes_.rx_polarizations(), tx_pols = amplitudes_.tx_polarizations();
  Complex weights[2][2] = {}, amplitudes[2][2];
  for (size_t r = 0; r < rx_pols; ++r)
    for (size_t t = 0; t < tx_pols; ++t) amplitudes[r][t] = amplitudes_.amplitude(r, t);
  for (size_t u = 0; u < leads_.rx_elements(); ++u)
    for (size_t s = 0; s < leads_.tx_elements(); ++s) {
      const double lead_m = leads_.lead_m(u, s), lead_s = lead_m / speed_of_light;
      if (squints_) set_path_phasors(grid_, delay_s - lead_s, phasors_);
      const Complex turn = unit_phasor(turns_of(carrier_hz, lead_s));
      PairSums element;  // of all ports of this pair of elements, with gains and amplitudes
      for (size_t r = 0; r < rx_pols; ++r)
        for (size_t t = 0; t < tx_pols; ++t) {
          const size_t rx_port = u * rx_pols + r, tx_port = s * tx_pols + t;
          const PairSums sums = sums_of(rx_port, tx_port, turns);
          const Complex rx_gain = gain_of(link_.receiver_gains, rx_port),
                        tx_gain = gain_of(link_.transmitter_gains, tx_port);
          const Complex amplitude = plain_product(amplitudes[r][t], turn),
                        gained = plain_product(rx_gain, tx_gain), both = plain_product(gained, amplitude),
                        without_gains = plain_product(amplitude, sums.plain);
          weights[r][t] += plain_product(gained, plain_product(turn, sums.plain));
          all.receiver.gains[rx_port] += plain_product(tx_gain, without_gains);
          all.transmitter.gains[tx_port] += plain_product(rx_gain, without_gains);
          element.plain += plain_product(both, sums.plain);
          element.by_frequency += plain_product(both, sums.by_frequency);
          element.by_time += plain_product(both, sums.by_time);
        }
      // Re(2 pi j x) of the phases
      const double plain = (two_pi_j * element.plain).real(),
                   by_frequency = (two_pi_j * element.by_frequency).real();
      out.length_m -= (carrier_hz * plain + by_frequency) / speed_of_light;
      out.doppler_hz += (two_pi_j * element.by_time).real();
      all.carrier_hz += plain * (lead_s - delay_s) - element.plain.real() / carrier_hz;
      const double weight = (carrier_hz * plain + (squints_ ? by_frequency : 0.0)) / speed_of_light;
      leads_.pull_back(u, s, weight, out, all);
    }
  pull_fields(path, weights, out, all);
}

}  // namespace

double PathCotangent::along(const PathTangent& tangent) const {
  const PathSlope& slope = tangent.slope;
  double sum = length_m * slope.length_m + doppler_hz * slope.doppler_hz +
               glm::dot(departure, slope.departure) + glm::dot(arrival, slope.arrival) +
               transmitter_radius_m * tangent.transmitter_radius_m +
               receiver_radius_m * tangent.receiver_radius_m;
  for (int entry = 0; entry < 4; ++entry) sum += real_product(transfer[entry], slope.transfer[entry]);
  return sum;
}

double LinkCotangent::along(const LinkTangent& tangent) const {
  double sum = along_end(transmitter, tangent.transmitter) + along_end(receiver, tangent.receiver) +
               carrier_hz * tangent.carrier_hz;
  for (size_t i = 0; i < tangent.paths.size(); ++i) sum += paths[i].along(tangent.paths[i]);
  return sum;
}

ResponseGradient::ResponseGradient(ResponseLink link, const ChannelGrid& grid, PathSelection selection)
    : link_(std::move(link)), grid_(grid), selection_(selection) {
  check_link(link_.paths, link_.transmitter, link_.receiver, grid.carrier_hz);
  check_gains(link_.transmitter_gains, link_.transmitter);
  check_gains(link_.receiver_gains, link_.receiver);
  GREATX_CHECK(link_.transmitter.beam_squint == link_.receiver.beam_squint,
               "the ends of a link take waves differently");
  for (const Path& path : link_.paths)
    GREATX_CHECK(!path.echo, "the derivatives of an echo of a target are not known");
}

size_t ResponseGradient::size() const { return response_size(link_.transmitter, link_.receiver, grid_); }

std::vector<Complex> ResponseGradient::response() const {
  if (!link_.transmitter_slants.empty() || !link_.receiver_slants.empty()) return response_by_gains();
  std::vector<Path> selected;
  if (selection_ != PathSelection::all)
    for (const Path& path : link_.paths)
      if (is_selected(path, selection_)) selected.push_back(path);
  std::vector<Complex> values = frequency_response_fp64(
      selection_ == PathSelection::all ? link_.paths : std::span<const Path>(selected), link_.transmitter,
      link_.receiver, grid_);
  if (link_.transmitter_gains.empty() && link_.receiver_gains.empty()) return values;
  const size_t tx_ports = link_.transmitter.array.port_count(), per_pair = grid_.size_per_pair();
  for (size_t i = 0; i < values.size(); ++i) {
    const size_t pair = i / per_pair;
    values[i] *=
        gain_of(link_.receiver_gains, pair / tx_ports) * gain_of(link_.transmitter_gains, pair % tx_ports);
  }
  return values;
}

/// H is linear in the gains of the receiver's ports: H = sum over ports of g dH/dg.
std::vector<Complex> ResponseGradient::response_by_gains() const {
  LinkTangent gains;
  gains.paths.resize(link_.paths.size());
  gains.receiver.gains = link_.receiver_gains;
  if (gains.receiver.gains.empty()) gains.receiver.gains.assign(link_.receiver.array.port_count(), 1.0);
  std::vector<Complex> values(size());
  push_forward({&gains, 1}, values);
  return values;
}

LinkCotangent ResponseGradient::pull_back(std::span<const Complex> cotangent) const {
  GREATX_CHECK(cotangent.size() == size(), "{} cotangents of {} values", cotangent.size(), size());
  LinkCotangent all;
  all.paths.resize(link_.paths.size());
  all.transmitter.gains.resize(link_.transmitter.array.port_count());
  all.receiver.gains.resize(link_.receiver.array.port_count());
  PathPuller puller(link_, grid_, cotangent);
  for (size_t i = 0; i < link_.paths.size(); ++i)
    if (is_selected(link_.paths[i], selection_)) puller.pull(link_.paths[i], all.paths[i], all);
  return all;
}

PowerSlopes power_slopes(const ResponseLink& link, double carrier_hz, std::span<const LinkTangent> tangents) {
  check_link(link.paths, link.transmitter, link.receiver, carrier_hz);
  PathAmplitudes amplitudes(link, carrier_hz);
  const size_t rx_pols = amplitudes.rx_polarizations(), tx_pols = amplitudes.tx_polarizations();
  const size_t rx_ports = link.receiver.array.port_count(), tx_ports = link.transmitter.array.port_count();
  const double pairs = static_cast<double>(rx_ports * tx_ports);
  // Sum over the elements of |g|^2 and of Re(conj(g) dg) for each polarization.
  const auto gain_power = [](const std::vector<Complex>& gains, size_t ports, size_t pols, size_t p) {
    double sum = 0.0;
    for (size_t port = p; port < ports; port += pols) sum += std::norm(gain_of(gains, port));
    return sum;
  };
  const auto gain_slope = [](const std::vector<Complex>& gains, const std::vector<Complex>& changes,
                             size_t pols, size_t p) {
    double sum = 0.0;
    for (size_t port = p; port < changes.size(); port += pols)
      sum += real_product(std::conj(gain_of(gains, port)), changes[port]);
    return sum;
  };
  PowerSlopes out;
  for (size_t i = 0; i < link.paths.size(); ++i) {
    amplitudes.load(link.paths[i]);
    double power = 0.0;
    std::vector<double> slopes(tangents.size());
    for (size_t r = 0; r < rx_pols; ++r)
      for (size_t t = 0; t < tx_pols; ++t) {
        const Complex amplitude = amplitudes.amplitude(r, t);
        const double rx_gain = gain_power(link.receiver_gains, rx_ports, rx_pols, r),
                     tx_gain = gain_power(link.transmitter_gains, tx_ports, tx_pols, t);
        power += std::norm(amplitude) * rx_gain * tx_gain;
        for (size_t n = 0; n < tangents.size(); ++n) {
          const LinkTangent& tangent = tangents[n];
          const PathSlope slope = tangent.paths.empty() ? PathSlope{} : tangent.paths[i].slope;
          slopes[n] += 2.0 * real_product(std::conj(amplitude), amplitudes.slope(r, t, slope, tangent)) *
                       rx_gain * tx_gain;
          slopes[n] += 2.0 * std::norm(amplitude) *
                       (gain_slope(link.receiver_gains, tangent.receiver.gains, rx_pols, r) * tx_gain +
                        gain_slope(link.transmitter_gains, tangent.transmitter.gains, tx_pols, t) * rx_gain);
        }
      }
    out.powers.push_back(power / pairs);
    for (const double slope : slopes) out.slopes.push_back(slope / pairs);
  }
  return out;
}

DelaySlopes delay_slopes(std::span<const double> powers, std::span<const double> power_slopes,
                         std::span<const double> delays_s, std::span<const double> delay_slopes_s) {
  GREATX_CHECK(power_slopes.size() == powers.size() && delays_s.size() == powers.size() &&
                   delay_slopes_s.size() == powers.size(),
               "{} powers", powers.size());
  DelaySlopes out;
  double power = 0.0, first = 0.0;
  for (size_t i = 0; i < powers.size(); ++i) {
    power += powers[i];
    first += powers[i] * delays_s[i];
    out.path_gain += power_slopes[i];
  }
  if (!(power > 0.0)) {
    out.mean_delay_s = out.delay_spread_s = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  const double mean_s = first / power;
  double variance = 0.0, variance_slope = 0.0;
  for (size_t i = 0; i < powers.size(); ++i) {
    const double from_mean = delays_s[i] - mean_s;
    out.mean_delay_s += (power_slopes[i] * from_mean + powers[i] * delay_slopes_s[i]) / power;
    variance += powers[i] * from_mean * from_mean / power;
  }
  for (size_t i = 0; i < powers.size(); ++i) {
    const double from_mean = delays_s[i] - mean_s;
    variance_slope += (power_slopes[i] * (from_mean * from_mean - variance) +
                       2.0 * powers[i] * from_mean * delay_slopes_s[i]) /
                      power;
  }
  out.delay_spread_s = variance > 0.0 ? variance_slope / (2.0 * std::sqrt(variance))
                                      : std::numeric_limits<double>::quiet_NaN();
  return out;
}

}  // namespace greatx::rf
