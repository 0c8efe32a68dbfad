// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "rf/channel/pair_amplitudes.h"
#include "rf/channel/received.h"
#include "rf/channel/statistics.h"
#include "tests/rf/channel_paths.h"

namespace greatx::rf {
namespace {

using testing::antenna;
using testing::plain_path;
using testing::random_paths;

constexpr double received_carrier_hz = 3.5e9;
const double wavelength_m = speed_of_light / received_carrier_hz;
constexpr double dipole_directivity = 1.6409223770;

Path line_of_sight(double distance_m) { return plain_path(distance_m / speed_of_light, 1.0 / distance_m); }

Received receive(const Path& path, const ArrayPose& tx, const ArrayPose& rx, const RadioLink& link) {
  return received(std::span(&path, 1), tx, rx, link);
}

TEST(Received, FreeSpace) {
  for (const double distance : {1.0, 250.0, 12'345.6})
    for (const Pattern pattern : {Pattern::isotropic, Pattern::half_wave_dipole}) {
      const double gain = pattern == Pattern::isotropic ? 1.0 : dipole_directivity, power = 20.0;
      const auto found = receive(line_of_sight(distance), antenna(pattern), antenna(pattern),
                                 {.carrier_hz = received_carrier_hz, .transmit_power_w = power});
      // Friis' equation.
      const double expected = power * std::pow(gain * wavelength_m / (4 * pi * distance), 2);
      EXPECT_NEAR(found.power_w / expected, 1.0, 1e-9);
      EXPECT_NEAR(found.paths[0].power_w / expected, 1.0, 1e-9);
      EXPECT_NEAR(found.mean_power_w / expected, 1.0, 1e-9);
      // P.525-4, eq. 1, rounds eta_0/4 pi = 29.979 ohm to 30 ohm.
      const double field = std::abs(found.paths[0].field_v_per_m.theta);
      EXPECT_NEAR(field * distance / std::sqrt(30.0 * power * gain), 1.0, 4e-4);
      EXPECT_NEAR(field * distance / std::sqrt(vacuum_impedance_ohm / (4 * pi) * power * gain), 1.0, 1e-9);
      EXPECT_NEAR(std::abs(found.paths[0].field_v_per_m.phi), 0.0, 1e-12);
      // The phase is that of the path.
      EXPECT_NEAR(
          std::abs(std::arg(found.paths[0].field_v_per_m.theta /
                            Complex(testing::wide_phasor(received_carrier_hz, distance / speed_of_light)))),
          0.0, 1e-9);
      // The power is the power density times the effective area (gain lambda^2/4 pi).
      const double density = field * field / vacuum_impedance_ohm;
      EXPECT_NEAR(density * gain * wavelength_m * wavelength_m / (4 * pi) / found.power_w, 1.0, 1e-9);
    }
}

TEST(Received, HalfWaveDipoleHasALengthOfLambdaOverPi) {
  // R = (eta_0/4 pi) Cin(2 pi) = 73.08 ohm and D = 4/Cin(2 pi); the open-circuit voltage is E lambda/pi.
  const double resistance = vacuum_impedance_ohm / (4 * pi) * 4.0 / dipole_directivity;
  EXPECT_NEAR(resistance, 73.08, 0.005);
  const auto found =
      receive(line_of_sight(40.0), antenna(), antenna(Pattern::half_wave_dipole),
              {.carrier_hz = received_carrier_hz, .transmit_power_w = 2.0, .resistance_ohm = resistance});
  const double field = std::abs(found.paths[0].field_v_per_m.theta);
  EXPECT_NEAR(std::abs(found.open_circuit_v) / (field * wavelength_m / pi), 1.0, 1e-9);
  // A matched load receives this power.
  EXPECT_NEAR(std::norm(found.open_circuit_v) / (4 * resistance) / found.power_w, 1.0, 1e-12);
}

TEST(Received, TotalsAreSumsOfPhasors) {
  // The paths differ by half a wavelength: the phasors cancel, the powers add.
  const double distance = 1000 * wavelength_m;
  std::vector<Path> paths{line_of_sight(distance), line_of_sight(distance)};
  paths[1].delay_s += 0.5 / received_carrier_hz;
  const RadioLink link{.carrier_hz = received_carrier_hz, .transmit_power_w = 0.1};
  const Received found = received(paths, antenna(), antenna(), link);
  EXPECT_LT(found.power_w, 1e-18 * found.mean_power_w);
  EXPECT_NEAR(found.mean_power_w / (2 * found.paths[0].power_w), 1.0, 1e-12);
  EXPECT_LT(std::abs(found.open_circuit_v), 1e-9 * std::abs(found.paths[0].open_circuit_v));
  EXPECT_LT(glm::length(found.field_v_per_m.re) + glm::length(found.field_v_per_m.im),
            1e-9 * std::abs(found.paths[0].field_v_per_m.theta));
}

TEST(Received, FieldsFromSeveralSidesAddAsVectors) {
  // A vertical field from the west and a field along y from above have separate components.
  std::vector<Path> paths{plain_path(0.0, 0.5), plain_path(0.0, 0.25, false)};
  paths[1].arrival = {0.0, 0.0, 1.0};  // theta-hat +x, phi-hat +y
  paths[1].transfer[0] = 0.0;
  paths[1].transfer[2] = Complex(0.0, 0.25);  // V to phi
  paths[1].transfer[3] = 0.0;
  const Received found =
      received(paths, antenna(), antenna(), {.carrier_hz = received_carrier_hz, .transmit_power_w = 4.0});
  const double scale = std::sqrt(vacuum_impedance_ohm * 4.0 / (4 * pi));
  EXPECT_NEAR(found.field_v_per_m.re.z, -0.5 * scale, 1e-12);
  EXPECT_NEAR(found.field_v_per_m.im.y, 0.25 * scale, 1e-12);
  EXPECT_NEAR(found.field_v_per_m.re.x, 0.0, 1e-12);
}

TEST(Received, AgreesWithTheImpulseResponseAtEveryPort) {
  auto paths = random_paths(9, 1e-6, 11);
  ArrayPose tx = antenna(Pattern::half_wave_dipole, Polarization::slant),
            rx = antenna(Pattern::isotropic, Polarization::vh);
  tx.array.columns = rx.array.rows = 2;
  tx.array.column_spacing_m = rx.array.row_spacing_m = 0.05;
  tx.orientation = orientation_from_yaw_pitch_roll(0.7, 0.2, -0.4);
  const ImpulseResponse impulse = impulse_response(paths, tx, rx, received_carrier_hz);
  const uint32_t tx_ports = tx.array.port_count(), rx_ports = rx.array.port_count();
  for (uint32_t u = 0; u < rx_ports; ++u)
    for (uint32_t s = 0; s < tx_ports; ++s) {
      const Received found = received(paths, tx, rx,
                                      {.carrier_hz = received_carrier_hz,
                                       .transmit_power_w = 3.0,
                                       .resistance_ohm = 50.0,
                                       .transmit_port = s,
                                       .receive_port = u});
      for (size_t i = 0; i < paths.size(); ++i) {
        const Complex amplitude = impulse.amplitude[(i * rx_ports + u) * tx_ports + s];
        EXPECT_LT(std::abs(found.paths[i].amplitude - amplitude), 1e-6 * std::abs(amplitude));
        // V = h^T E, where h is that of the port alone: the field is the one at the element of the port.
        std::vector<Jones> pattern;
        Ports(rx, received_carrier_hz).fields(paths[i].arrival, pattern);
        const Jones& own = pattern[u % 2];
        const Jones& field = found.paths[i].field_v_per_m;
        const Complex voltage = wavelength_m * std::sqrt(50.0 / (pi * vacuum_impedance_ohm)) *
                                (own.theta * field.theta + own.phi * field.phi);
        EXPECT_LT(std::abs(found.paths[i].open_circuit_v - voltage), 1e-9 * std::abs(voltage) + 1e-18);
      }
    }
}

TEST(Received, AnyOrderOfPathsGivesTheSameBits) {
  auto paths = random_paths(500, 1e-6, 12);
  const RadioLink link{.carrier_hz = received_carrier_hz};
  const Received first = received(paths, antenna(), antenna(), link);
  testing::shuffle(paths, 12);
  const Received second = received(paths, antenna(), antenna(), link);
  EXPECT_EQ(first.amplitude, second.amplitude);
  EXPECT_EQ(first.mean_power_w, second.mean_power_w);
  EXPECT_EQ(first.field_v_per_m.re, second.field_v_per_m.re);
  EXPECT_EQ(first.field_v_per_m.im, second.field_v_per_m.im);
}

TEST(Received, Decibels) {
  EXPECT_DOUBLE_EQ(dbm(0.2), 10 * std::log10(200.0));
  EXPECT_EQ(dbm(0.0), -std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(watts(dbm(0.2)), 0.2);
  // The basic transmission loss of 100 m at 2.4 GHz is 80.05 dB (P.525-4, eq. 3).
  const Path path = line_of_sight(100.0);
  EXPECT_NEAR(-decibels(path_powers(std::span(&path, 1), antenna(), antenna(), 2.4e9)[0]), 80.05, 0.005);
}

TEST(Received, NothingArrives) {
  const Received found = received({}, antenna(), antenna(), {});
  EXPECT_EQ(found.power_w, 0.0);
  EXPECT_EQ(found.mean_power_w, 0.0);
  EXPECT_EQ(found.open_circuit_v, Complex(0.0));
  EXPECT_TRUE(found.paths.empty());
}

TEST(Received, RefusesWhatIsNoLink) {
  const Path path = line_of_sight(1.0);
  EXPECT_THROW(receive(path, antenna(), antenna(), {.transmit_power_w = -1.0}), ContractError);
  EXPECT_THROW(receive(path, antenna(), antenna(), {.resistance_ohm = 0.0}), ContractError);
  EXPECT_THROW(receive(path, antenna(), antenna(), {.transmit_port = 1}), ContractError);
  EXPECT_THROW(receive(path, antenna(), antenna(), {.receive_port = 1}), ContractError);
}

}  // namespace
}  // namespace greatx::rf
