// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/pair_amplitudes.h"

#include <cmath>

#include "core/error.h"
#include "core/phase.h"
#include "core/units.h"

namespace greatx::rf {

void check_link(std::span<const Path> paths, const ArrayPose& transmitter, const ArrayPose& receiver,
                double carrier_hz) {
  GREATX_CHECK(carrier_hz > 0.0 && std::isfinite(carrier_hz), "carrier {} Hz", carrier_hz);
  GREATX_CHECK(transmitter.array.port_count() > 0 && receiver.array.port_count() > 0,
               "arrays of {} and {} ports", transmitter.array.port_count(), receiver.array.port_count());
  for (const Path& path : paths) {
    bool finite = std::isfinite(path.delay_s) && std::isfinite(path.doppler_hz);
    for (const Complex& value : path.transfer)
      finite = finite && std::isfinite(value.real()) && std::isfinite(value.imag());
    GREATX_CHECK(finite, "path of {} interactions, {} m long, is not finite", path.interactions.size(),
                 path.length_m);
  }
}

double wavelength_factor(double carrier_hz) { return speed_of_light / carrier_hz / (4.0 * pi); }

Ports::Ports(const ArrayPose& end, double carrier_hz)
    : element_(end.array.turned_element(end.orientation)), count_(end.array.port_count()) {
  const double per_wavelength = carrier_hz / speed_of_light;
  for (uint32_t port = 0; port < count_; port += end.array.polarization_count())
    positions_.push_back(end.orientation * end.array.element_position(port) * per_wavelength);
}

void Ports::fields(const dvec3& direction, std::vector<Jones>& out) const {
  out.resize(element_.polarization_count());
  element_.respond(direction, out);
}

void Ports::respond(const dvec3& direction, std::vector<Jones>& out) const {
  fields(direction, out);
  const size_t polarizations = element_.polarization_count();
  out.resize(count_);
  // The loop goes from the last element to the first, whose entries hold the patterns of all elements.
  for (size_t element = positions_.size(); element-- > 0;) {
    const Complex turn = phase(direction, static_cast<uint32_t>(element * polarizations));
    for (size_t p = 0; p < polarizations; ++p)
      out[element * polarizations + p] = {out[p].theta * turn, out[p].phi * turn};
  }
}

Complex Ports::phase(const dvec3& direction, uint32_t port) const {
  return unit_phasor(fraction_of_turn(glm::dot(direction, positions_[port / element_.polarization_count()])));
}

PairAmplitudes::PairAmplitudes(const ArrayPose& transmitter, const ArrayPose& receiver, double carrier_hz)
    : tx_(transmitter, carrier_hz),
      rx_(receiver, carrier_hz),
      leads_(transmitter, receiver),
      carrier_hz_(carrier_hz),
      scale_(wavelength_factor(carrier_hz)),
      leads_s_(leads_.curved() ? leads_.pairs() : 0) {}

/// The fields of one element at each end give the amplitudes; the phase depends on the pair of elements.
void PairAmplitudes::of_curved(const Path& path, const Complex* t, Complex* out) {
  tx_.fields(path.departure, tx_response_);
  rx_.fields(path.arrival, rx_response_);
  leads_(path, leads_s_.data());
  std::vector<Complex> turns;
  for (const double lead_s : leads_s_) turns.push_back(unit_phasor(turns_of(carrier_hz_, lead_s)));
  for (size_t u = 0; u < leads_.rx_elements(); ++u)
    for (const Jones& rx : rx_response_) {
      const Complex to_theta = scale_ * (rx.theta * t[0] + rx.phi * t[2]);
      const Complex to_phi = scale_ * (rx.theta * t[1] + rx.phi * t[3]);
      for (size_t s = 0; s < leads_.tx_elements(); ++s)
        for (const Jones& tx : tx_response_)
          *out++ = (to_theta * tx.theta + to_phi * tx.phi) * turns[u * leads_.tx_elements() + s];
    }
}

void PairAmplitudes::operator()(const Path& path, const Complex* t, Complex* out) {
  if (leads_.curved()) return of_curved(path, t, out);
  tx_.respond(path.departure, tx_response_);
  rx_.respond(path.arrival, rx_response_);
  for (const Jones& rx : rx_response_) {
    const Complex to_theta = scale_ * (rx.theta * t[0] + rx.phi * t[2]);
    const Complex to_phi = scale_ * (rx.theta * t[1] + rx.phi * t[3]);
    for (const Jones& tx : tx_response_) *out++ = to_theta * tx.theta + to_phi * tx.phi;
  }
}

double PairAmplitudes::mean_power(const Path& path) {
  tx_.fields(path.departure, tx_response_);
  rx_.fields(path.arrival, rx_response_);
  const Complex* t = path.transfer;
  double sum = 0.0;
  for (const Jones& rx : rx_response_) {
    const Complex to_theta = scale_ * (rx.theta * t[0] + rx.phi * t[2]);
    const Complex to_phi = scale_ * (rx.theta * t[1] + rx.phi * t[3]);
    for (const Jones& tx : tx_response_) sum += std::norm(to_theta * tx.theta + to_phi * tx.phi);
  }
  return sum / static_cast<double>(rx_response_.size() * tx_response_.size());
}

}  // namespace greatx::rf
