// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/received.h"

#include <cmath>

#include "core/error.h"
#include "core/phase.h"
#include "rf/channel/pair_amplitudes.h"
#include "rf/channel/summing_order.h"
#include "rf/channel/wavefront.h"

namespace greatx::rf {
namespace {

void check_link(const ArrayPose& transmitter, const ArrayPose& receiver, const RadioLink& link) {
  GREATX_CHECK(link.transmit_power_w >= 0.0 && std::isfinite(link.transmit_power_w) &&
                   link.resistance_ohm > 0.0 && std::isfinite(link.resistance_ohm),
               "{} W into {} ohm", link.transmit_power_w, link.resistance_ohm);
  GREATX_CHECK(
      link.transmit_port < transmitter.array.port_count() && link.receive_port < receiver.array.port_count(),
      "ports {} and {} of {} and {}", link.transmit_port, link.receive_port, transmitter.array.port_count(),
      receiver.array.port_count());
}

/// Computes the received quantities of paths between one port of each end.
class PortPair {
 public:
  PortPair(const ArrayPose& transmitter, const ArrayPose& receiver, const RadioLink& link)
      : tx_(transmitter, link.carrier_hz),
        rx_(receiver, link.carrier_hz),
        leads_(transmitter, receiver),
        leads_s_(leads_.pairs()),
        link_(link),
        field_scale_(std::sqrt(vacuum_impedance_ohm * link.transmit_power_w / (4.0 * pi))),
        voltage_scale_(std::sqrt(4.0 * link.resistance_ohm * link.transmit_power_w)) {}

  ReceivedPath operator()(const Path& path) {
    tx_.fields(path.departure, tx_fields_);
    rx_.fields(path.arrival, rx_fields_);
    leads_(path, leads_s_.data());
    const Jones& sent = tx_fields_[link_.transmit_port % tx_.polarizations()];
    const Jones& taken = rx_fields_[link_.receive_port % rx_.polarizations()];
    // The phase of the wave between the elements of the ports.
    const size_t u = link_.receive_port / rx_.polarizations(), s = link_.transmit_port / tx_.polarizations();
    const Complex carrier = unit_phasor(-turns_of(link_.carrier_hz, path.delay_s)) *
                            unit_phasor(turns_of(link_.carrier_hz, leads_s_[u * leads_.tx_elements() + s]));
    const Complex* t = path.transfer;
    const Jones arriving{(t[0] * sent.theta + t[1] * sent.phi) * carrier,
                         (t[2] * sent.theta + t[3] * sent.phi) * carrier};
    ReceivedPath result;
    result.amplitude =
        wavelength_factor(link_.carrier_hz) * (taken.theta * arriving.theta + taken.phi * arriving.phi);
    result.field_v_per_m = {field_scale_ * arriving.theta, field_scale_ * arriving.phi};
    result.power_w = link_.transmit_power_w * std::norm(result.amplitude);
    result.open_circuit_v = voltage_scale_ * result.amplitude;
    return result;
  }

 private:
  Ports tx_, rx_;
  Leads leads_;
  std::vector<double> leads_s_;
  RadioLink link_;
  double field_scale_, voltage_scale_;
  std::vector<Jones> tx_fields_, rx_fields_;
};

}  // namespace

Received received(std::span<const Path> paths, const ArrayPose& transmitter, const ArrayPose& receiver,
                  const RadioLink& link) {
  check_link(paths, transmitter, receiver, link.carrier_hz);
  check_link(transmitter, receiver, link);
  PortPair receive(transmitter, receiver, link);
  Received result;
  result.paths.reserve(paths.size());
  for (const Path& path : paths) result.paths.push_back(receive(path));
  for (const uint32_t index : summing_order(paths)) {
    const ReceivedPath& path = result.paths[index];
    result.amplitude += path.amplitude;
    result.open_circuit_v += path.open_circuit_v;
    result.mean_power_w += path.power_w;
    result.field_v_per_m.add(path.field_v_per_m.theta, theta_hat(paths[index].arrival));
    result.field_v_per_m.add(path.field_v_per_m.phi, phi_hat(paths[index].arrival));
  }
  result.power_w = link.transmit_power_w * std::norm(result.amplitude);
  return result;
}

void arriving_fields(std::span<const Path> paths, const ArrayPose& transmitter, double carrier_hz,
                     double power_w, std::span<std::complex<float>> out) {
  const size_t ports = transmitter.array.port_count();
  GREATX_CHECK(out.size() == paths.size() * ports * 2, "{} values for {} paths and {} ports", out.size(),
               paths.size(), ports);
  const Ports from(transmitter, carrier_hz);
  Leads leads(transmitter, ArrayPose{.wavefront = transmitter.wavefront});
  std::vector<double> leads_s(leads.pairs());
  const double scale = std::sqrt(vacuum_impedance_ohm * power_w / (4.0 * pi));
  std::vector<Jones> sent;
  size_t next = 0;
  for (const Path& path : paths) {
    from.fields(path.departure, sent);
    leads(path, leads_s.data());
    const Complex carrier = scale * unit_phasor(-turns_of(carrier_hz, path.delay_s));
    const Complex* t = path.transfer;
    for (const double lead_s : leads_s) {
      const Complex turned = carrier * unit_phasor(turns_of(carrier_hz, lead_s));
      for (const Jones& field : sent) {
        out[next++] = std::complex<float>((t[0] * field.theta + t[1] * field.phi) * turned);
        out[next++] = std::complex<float>((t[2] * field.theta + t[3] * field.phi) * turned);
      }
    }
  }
}

double dbm(double power_w) { return decibels(power_w / 1e-3); }
double watts(double dbm) { return 1e-3 * from_decibels(dbm); }

}  // namespace greatx::rf
