// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/pattern_file.h"

#include <cmath>
#include <fstream>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "rf/antenna/element.h"
#include "rf/antenna/pattern_cuts.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/temporary_folder.h"

namespace greatx::sim {
namespace {

using ::testing::HasSubstr;

double gain_dbi(const rf::Jones& field) { return decibels(std::norm(field.theta) + std::norm(field.phi)); }

rf::Jones exact(rf::Pattern shape, double theta, double phi) {
  const dvec3 direction(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  return rf::element_field(shape, 0.0, direction);
}

std::string refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

/// Attenuation in dB of a cut at an angle in degrees.
using Cut = std::function<double(double)>;

std::string msi(const std::string& gain, const Cut& horizontal, const Cut& vertical, int steps = 360) {
  std::string text = "NAME An antenna\nMAKE Somebody\nFREQUENCY 2100\n" + gain +
                     "\nTILT ELECTRICAL\nCOMMENT HORIZONTAL and vertical\n";
  for (const auto& [name, cut] : {std::pair("HORIZONTAL", horizontal), std::pair("VERTICAL", vertical)}) {
    text += fmt::format("{} {}\n", name, steps);
    for (int i = 0; i < steps; ++i)
      text += fmt::format("{:.2f}\t{:.6f}\n", i * 360.0 / steps, cut(i * 360.0 / steps));
  }
  return text;
}
std::string msi_refusal(const std::string& text) {
  return refusal([&] { parse_pattern_msi(text, "a.msi", {}); });
}
double everywhere(double) { return 0.0; }

/// Attenuation of a half-wave dipole along z at an elevation.
double dipole_cut(double elevation_deg) {
  const double field =
      std::abs(exact(rf::Pattern::half_wave_dipole, radians(90.0 - elevation_deg), 0.0).theta);
  const double peak = exact(rf::Pattern::half_wave_dipole, pi / 2, 0.0).theta.real();
  return std::min(300.0, -20.0 * std::log10(field / peak + 1e-30));
}
double squared(double x) { return x * x; }
double wrapped(double degrees) { return std::remainder(degrees, 360.0); }

TEST(PatternMsi, DipoleIsExactInEveryDirection) {
  const rf::PatternTable table =
      parse_pattern_msi(msi("GAIN 0 dBd", everywhere, dipole_cut), "folder/d.msi", {});
  EXPECT_EQ(table.name(), "d.msi");
  EXPECT_EQ(table.grid().zeniths, 181u);
  EXPECT_EQ(table.grid().azimuths, 360u);
  for (uint32_t i = 1; i < 180; ++i)
    for (uint32_t j = 0; j < 360; j += 7) {
      const rf::Jones& sample = table.samples()[i * 360 + j];
      EXPECT_EQ(sample.phi, 0.0);
      // 2.15 dB stand for the dipole's gain of 2.15088 dBi; the file has six decimals.
      EXPECT_NEAR(gain_dbi(sample), gain_dbi(exact(rf::Pattern::half_wave_dipole, radians(i), 0.0)), 0.00094);
    }
  EXPECT_NEAR(decibels(rf::mean_gain(table)), 2.15 - decibels(1.6409223770), 1e-6);
}

TEST(PatternMsi, UnitsOfTheGain) {
  const auto gain = [](const std::string& line) {
    return gain_dbi(parse_pattern_msi(msi(line, everywhere, everywhere), "a.msi", {}).at(pi / 2, 0.0));
  };
  EXPECT_NEAR(gain("GAIN 15.5 dBi"), 15.5, 1e-12);
  EXPECT_NEAR(gain("GAIN 15.5 dBd"), 17.65, 1e-12);
  EXPECT_NEAR(gain("GAIN 15.5"), 17.65, 1e-12);
  EXPECT_NEAR(gain("gain 15.5dBi"), 15.5, 1e-12);
}

TEST(PatternMsi, AnglesAreClockwiseAndDownwards) {
  // The main lobe is 20 degrees clockwise (to the right, azimuth -20) and 10 degrees down (zenith 100).
  const Cut right = [](double angle) { return squared(wrapped(angle - 20.0)) / 400.0; };
  const Cut down = [](double angle) { return squared(wrapped(angle - 10.0)) / 400.0; };
  const std::string text = msi("GAIN 10 dBi", right, down);
  const auto at = [](const rf::PatternTable& table, double zenith_deg, double azimuth_deg) {
    return gain_dbi(table.at(radians(zenith_deg), radians(azimuth_deg)));
  };
  const rf::PatternTable table = parse_pattern_msi(text, "a.msi", {});
  EXPECT_GT(at(table, 100.0, 0.0), at(table, 80.0, 0.0) + 0.9);
  EXPECT_GT(at(table, 90.0, -20.0), at(table, 90.0, 20.0) + 3.9);
  const rf::PatternTable up = parse_pattern_msi(text, "a.msi", {.vertical_up = true});
  EXPECT_NEAR(at(up, 80.0, 0.0), at(table, 100.0, 0.0), 1e-9);
  EXPECT_NE(up.sha256(), table.sha256());
}

TEST(PatternMsi, CutsComeBackAndSumsOfThemAreExact) {
  // Attenuations that add up, different on every side. The vertical cut behind the antenna is that of a sum.
  const auto sum = [](double azimuth, double elevation) {
    return squared(wrapped(azimuth)) / 900.0 + 0.02 * std::abs(wrapped(azimuth)) * (azimuth < 180.0) +
           squared(elevation) / 200.0 + (elevation > 0.0 ? 0.1 * elevation : 0.0);
  };
  const Cut horizontal = [&](double angle) { return sum(angle, 0.0); };
  const Cut vertical = [&](double angle) {  // downwards
    const double turn = wrapped(angle);
    return std::abs(turn) <= 90.0 ? sum(0.0, -turn) : sum(180.0, turn > 0.0 ? turn - 180.0 : turn + 180.0);
  };
  const rf::PatternTable table = parse_pattern_msi(msi("GAIN 12 dBi", horizontal, vertical), "a.msi", {});
  for (int elevation = -89; elevation <= 89; ++elevation)
    for (int clockwise = 0; clockwise < 360; ++clockwise) {
      const rf::Jones sample = table.samples()[(90 - elevation) * 360 + (360 - clockwise) % 360];
      ASSERT_NEAR(gain_dbi(sample), 12.0 - sum(clockwise, elevation), 1e-5) << elevation << ' ' << clockwise;
    }
  for (int j = 0; j < 360; ++j) {  // a pole is one direction
    EXPECT_NEAR(gain_dbi(table.samples()[j]), 12.0 - vertical(270.0), 1e-5);
    EXPECT_NEAR(gain_dbi(table.samples()[180 * 360 + j]), 12.0 - vertical(90.0), 1e-5);
  }
}

TEST(PatternMsi, Tr38901ElementWithinTheStatedError) {
  // docs/scenario.md: the element is no sum where its floor acts.
  const auto attenuation = [](double theta, double phi) {
    return 8.0 - gain_dbi(exact(rf::Pattern::tr38901, radians(theta), radians(phi)));
  };
  const Cut horizontal = [&](double angle) { return attenuation(90.0, wrapped(angle)); };
  const Cut vertical = [&](double angle) {
    const double turn = wrapped(angle);
    return std::abs(turn) <= 90.0 ? attenuation(90.0 + turn, 0.0)
                                  : attenuation(90.0 + (turn > 0.0 ? 180.0 - turn : -180.0 - turn), 180.0);
  };
  const rf::PatternTable table = parse_pattern_msi(msi("GAIN 8 dBi", horizontal, vertical), "a.msi", {});
  double worst = 0.0, mean = 0.0, worst_front = 0.0, weight = 0.0;
  for (int theta = 1; theta < 180; ++theta)
    for (int phi = 0; phi < 360; ++phi) {
      const double error =
          std::abs(gain_dbi(table.samples()[theta * 360 + phi]) - 8.0 + attenuation(theta, wrapped(phi)));
      const double area = std::sin(radians(theta));
      worst = std::max(worst, error);
      mean += error * area;
      weight += area;
      if (attenuation(theta, wrapped(phi)) <= 15.0) worst_front = std::max(worst_front, error);
    }
  EXPECT_LT(worst, 9.7);
  EXPECT_LT(mean / weight, 0.99);
  EXPECT_LT(worst_front, 2.4);
  EXPECT_NEAR(decibels(rf::mean_gain(table) / 0.656798), 0.22, 0.01);
}

TEST(PatternMsi, FaultsNameLineColumnAndField) {
  const std::string good = msi("GAIN 8 dBi", everywhere, everywhere, 4);
  const auto with = [&](const std::string& old, const std::string& text) {
    std::string changed = good;
    changed.replace(changed.find(old), old.size(), text);
    return msi_refusal(changed);
  };
  EXPECT_EQ(msi_refusal(good), "accepted");
  EXPECT_EQ(with("GAIN 8 dBi", "GAIN 8 dB"), "a.msi:4:8: GAIN: expected dBd or dBi (none: dBd), found 'db'");
  EXPECT_EQ(with("GAIN 8 dBi", "GAIN"), "a.msi:4:1: GAIN: expected a number, found nothing");
  EXPECT_EQ(with("GAIN 8 dBi", "GAIN much"),
            "a.msi:4:6: GAIN: expected a number from -100 to 100, found 'much'");
  EXPECT_EQ(with("GAIN 8 dBi", "GAIN 8\nGAIN 9"), "a.msi:5:1: GAIN: expected one gain, found a second one");
  EXPECT_EQ(with("GAIN 8 dBi", "PROFIT 8"), "a.msi:16: GAIN: expected a line, found none");
  EXPECT_EQ(with("90.00\t0.000000", "90.00\t-1"),
            "a.msi:9:7: HORIZONTAL: expected an attenuation from 0 to 1000 dB, found -1");
  EXPECT_EQ(with("90.00\t0.000000", "90.00\tnan"),
            "a.msi:9:7: HORIZONTAL: expected a finite number, found 'nan'");
  EXPECT_EQ(with("90.00\t0.000000", "91.00\t0"),
            "a.msi:9:1: HORIZONTAL: expected a multiple of 90 degrees, found 91");
  EXPECT_EQ(with("90.00\t0.000000", "0.00\t0"),
            "a.msi:9:1: HORIZONTAL: expected every angle once, found 0 again (line 8)");
  EXPECT_EQ(with("90.00\t0.000000\n", ""),
            "a.msi:11:1: HORIZONTAL: expected line 4 of 4, 'angle attenuation', found 'VERTICAL ...'");
  EXPECT_EQ(with("90.00\t0.000000\n", "45.00\t0.000000\n90.00\t0.000000\n"),
            "a.msi:9:1: HORIZONTAL: expected a multiple of 90 degrees, found 45");
  EXPECT_EQ(with("VERTICAL 4", "VERTICAL 3"),
            "a.msi:12:10: VERTICAL: expected the number of its values, a multiple of 4 from 4 to 3600, found "
            "'3'");
  EXPECT_THAT(with("VERTICAL 4", "VERTICAL 8"),
              HasSubstr("a.msi:16: VERTICAL: expected 8 lines 'angle attenuation', found 4"));
  EXPECT_EQ(msi_refusal(good + "5 3\n"), "a.msi:17:1: expected 'KEY value', found '5'");
  EXPECT_EQ(msi_refusal(""), "a.msi:0: GAIN: expected a line, found none");
  EXPECT_THAT(msi_refusal("theta_deg,phi_deg,gain_dbi\n0,0,1\n"),
              HasSubstr("a.msi:2: GAIN: expected a line"));
}

/// Field of an antenna in V for one volt of amplitude.
using FieldOf = std::function<rf::Jones(double theta, double phi)>;

struct FfdShape {
  int thetas = 37, phis = 25;
  double theta_start = 0.0, theta_stop = 180.0, phi_start = -180.0, phi_stop = 180.0;
  const char* separator = " ";
};
std::string ffd_rows(const FfdShape& shape, const FieldOf& field) {
  std::string text;
  for (int i = 0; i < shape.thetas; ++i)
    for (int j = 0; j < shape.phis; ++j) {
      const double theta =
          shape.theta_start + (shape.theta_stop - shape.theta_start) * i / (shape.thetas - 1);
      const double phi = shape.phi_start + (shape.phi_stop - shape.phi_start) * j / (shape.phis - 1);
      const rf::Jones f = field(radians(theta), radians(phi));
      const char* s = shape.separator;
      text += fmt::format("{:.9e}{}{:.9e}{}{:.9e}{}{:.9e}\n", f.theta.real(), s, f.theta.imag(), s,
                          f.phi.real(), s, f.phi.imag());
    }
  return text;
}
std::string ffd_head(const FfdShape& shape) {
  const char* s = shape.separator;
  return fmt::format("{}{}{}{}{}\n{}{}{}{}{}\n", shape.theta_start, s, shape.theta_stop, s, shape.thetas,
                     shape.phi_start, s, shape.phi_stop, s, shape.phis);
}
constexpr double impedance = 376.730313668;

/// r E in V of a half-wave dipole along z that radiates `power_w`, with a phase of 40 degrees.
FieldOf dipole_field(double power_w) {
  return [power_w](double theta, double) {
    const double gain = std::norm(exact(rf::Pattern::half_wave_dipole, theta, 0.0).theta);
    return rf::Jones{std::polar(std::sqrt(gain * power_w * 2.0 * impedance / (4.0 * pi)), radians(40.0)),
                     0.0};
  };
}

TEST(PatternFfd, DipoleOfOneWattHasItsGain) {
  const FfdShape shape;
  const std::string text =
      ffd_head(shape) + "Frequencies 1\nFrequency 2.1e9\n" + ffd_rows(shape, dipole_field(1.0));
  for (const PatternOptions& options : {PatternOptions{}, PatternOptions{.power_w = 1.0},
                                        PatternOptions{.frequency_hz = 2.1e9, .power_w = 1.0}}) {
    const rf::PatternTable table = parse_pattern_ffd(text, "folder/d.ffd", options);
    EXPECT_EQ(table.name(), "d.ffd");
    EXPECT_EQ(table.grid().azimuths, 24u);
    for (uint32_t i = 0; i < 37; ++i) {
      const rf::Jones& sample = table.samples()[i * 24 + 5];
      EXPECT_LT(
          std::abs(sample.theta - std::polar(1.0, radians(40.0)) *
                                      exact(rf::Pattern::half_wave_dipole, radians(5.0 * i), 0.0).theta),
          1e-7);
    }
    EXPECT_NEAR(rf::mean_gain(table), 1.0, 1e-7);
  }
}

TEST(PatternFfd, PowerThatIsLostLowersTheGain) {
  // The fields of 0.8 W, made by 1 W: a realized gain of 0.8 times the directivity.
  const FfdShape shape;
  const std::string text = ffd_head(shape) + ffd_rows(shape, dipole_field(0.8));
  EXPECT_NEAR(std::norm(parse_pattern_ffd(text, "d.ffd", {.power_w = 1.0}).at(pi / 2, 0.3).theta),
              0.8 * 1.6409223770, 1e-6);
  EXPECT_NEAR(std::norm(parse_pattern_ffd(text, "d.ffd", {}).at(pi / 2, 0.3).theta), 1.6409223770, 1e-6);
  EXPECT_EQ(
      refusal([&] { parse_pattern_ffd(text, "d.ffd", {.power_w = 0.5}); }),
      "d.ffd: pattern_power_w: expected the power that makes the fields, which radiate 0.8 W, found 0.5 "
      "W");
}

TEST(PatternFfd, PolarizationOrderAndSeparatorsSurvive) {
  // A crossed pair of short dipoles along x and y, a quarter of a period apart: a field that differs
  // everywhere and in both components.
  const FieldOf turnstile = [](double theta, double phi) {
    const rf::Complex turn = std::polar(1.0, phi);
    return rf::Jones{std::cos(theta) * turn, rf::Complex(0.0, 1.0) * turn};
  };
  const double scale = std::sqrt(0.75);  // the mean of (cos^2 + 1) is 4/3
  FfdShape up;
  up.theta_start = 180.0;
  up.theta_stop = 0.0;
  FfdShape open{19, 36, 0.0, 180.0, 0.0, 350.0, ", "};
  FfdShape semicolons{19, 37, 0.0, 180.0, 0.0, 360.0, ";"};
  for (const FfdShape& shape : {FfdShape{}, up, open, semicolons}) {
    const rf::PatternTable table =
        parse_pattern_ffd(ffd_head(shape) + ffd_rows(shape, turnstile), "t.ffd", {});
    EXPECT_EQ(table.grid().azimuths,
              static_cast<uint32_t>(shape.phis - (shape.phi_stop - shape.phi_start == 360.0)));
    for (int i = 0; i < shape.thetas; ++i)
      for (int j = 0; j < shape.phis; ++j) {
        const double theta = i * pi / (shape.thetas - 1);
        const double phi =
            radians(shape.phi_start + (shape.phi_stop - shape.phi_start) * j / (shape.phis - 1));
        const rf::Jones expected = turnstile(theta, phi), found = table.at(theta, phi);
        EXPECT_LT(std::abs(found.theta - scale * expected.theta) + std::abs(found.phi - scale * expected.phi),
                  1e-8);
      }
  }
}

TEST(PatternFfd, MeanGainIsExactForFewSamples) {
  // sin^2 has a mean of 2/3 over the sphere, on any grid that resolves it.
  for (const uint32_t zeniths : {4u, 5u, 8u, 19u}) {
    std::vector<rf::Jones> samples;
    for (uint32_t i = 0; i < zeniths; ++i)
      for (int j = 0; j < 4; ++j) samples.push_back({std::sin(pi * i / (zeniths - 1)), 0.0});
    EXPECT_NEAR(rf::mean_gain(rf::PatternTable({zeniths, 4, 0.0}, samples)), 2.0 / 3.0, 1e-14) << zeniths;
  }
}

TEST(PatternFfd, FrequenciesAreChosen) {
  const FfdShape shape{5, 5};
  std::string text = ffd_head(shape) + "Frequencies 2\n";
  for (const double scale : {1.0, 3.0}) {
    text += fmt::format("Frequency {}\n", scale * 1e9);
    text += ffd_rows(shape, [&](double, double) { return rf::Jones{scale, 0.0}; });
  }
  const double power_w = 4.0 * pi / (2.0 * impedance);  // of 1 V in every direction
  EXPECT_NEAR(std::abs(parse_pattern_ffd(text, "f.ffd", {1e9, 9.0 * power_w}).at(1.0, 1.0).theta), 1.0 / 3.0,
              1e-9);
  EXPECT_NEAR(std::abs(parse_pattern_ffd(text, "f.ffd", {3e9, 9.0 * power_w}).at(1.0, 1.0).theta), 1.0, 1e-9);
  EXPECT_NE(parse_pattern_ffd(text, "f.ffd", {1e9}).sha256(),
            parse_pattern_ffd(text, "f.ffd", {3e9}).sha256());
  EXPECT_EQ(refusal([&] { parse_pattern_ffd(text, "f.ffd", {}); }),
            "f.ffd: pattern_frequency_hz: expected one of the file's 2 frequencies (1000000000, 3000000000), "
            "found none");
  EXPECT_THAT(refusal([&] { parse_pattern_ffd(text, "f.ffd", {2e9}); }), HasSubstr("found 2000000000"));
  EXPECT_THAT(refusal([&] {
                parse_pattern_ffd(ffd_head(shape) + ffd_rows(shape, dipole_field(1.0)), "f.ffd", {2e9});
              }),
              HasSubstr("pattern_frequency_hz: expected no frequency, since the file names none"));
}

TEST(PatternFfd, FaultsNameLineColumnAndField) {
  const auto fault = [](const std::string& text) {
    return refusal([&] { parse_pattern_ffd(text, "f.ffd", {}); });
  };
  const std::string row = "1 0 0 0\n", rows = [&] {
    std::string all;
    for (int i = 0; i < 15; ++i) all += row;
    return all;
  }();
  const std::string head = "0 180 3\n0 360 5\n";
  EXPECT_EQ(fault(head + rows), "accepted");
  EXPECT_EQ(fault(""), "f.ffd:0: expected theta as 'start stop count', found the end of the file");
  EXPECT_EQ(fault("theta_deg,phi_deg\n"), "f.ffd:1:1: theta: expected 'start stop count', found 2 words");
  EXPECT_EQ(fault("0 180 x\n"), "f.ffd:1:7: theta: expected a finite number, found 'x'");
  EXPECT_EQ(fault("0 180 2\n"), "f.ffd:1:7: theta: expected 3 angles or more, found 2");
  EXPECT_EQ(fault("-180 180 5\n"),
            "f.ffd:1: theta: expected 0 to 180 degrees or 180 to 0, found -180 to 180");
  EXPECT_EQ(fault("0 180 3\n0 180 5\n"),
            "f.ffd:2: phi: expected azimuths once around (360 degrees), found 5 from 0 to 180");
  EXPECT_EQ(fault("0 180 3\n0 360 4\n"), "f.ffd:2: phi: expected 4 azimuths or more, found 3");
  EXPECT_EQ(fault("0 180 3000\n0 360 3000\n"),
            "f.ffd:2: phi: expected at most 4194304 directions, found 3000 by 3000");
  EXPECT_EQ(fault(head + "Frequencies 0\n"),
            "f.ffd:3:13: Frequencies: expected their number, 1 to 100000, found '0'");
  EXPECT_EQ(fault(head + "Frequencies 1\n" + rows), "f.ffd:4:1: expected 'Frequency' 1 of 1, found '1'");
  EXPECT_EQ(fault(head + "Frequencies 1\nFrequency -3\n"),
            "f.ffd:4:11: Frequency: expected a positive number, found -3");
  EXPECT_EQ(fault(head + rows + row), "f.ffd:18:1: expected the end of the file, found '1'");
  EXPECT_EQ(fault(head + rows.substr(row.size())),
            "f.ffd:16: expected row 15 of 15, found the end of the file");
  EXPECT_EQ(
      fault(head + "1 0 0\n" + rows),
      "f.ffd:3:1: expected row 1 of 15, 4 numbers (E_theta_re, E_theta_im, E_phi_re, E_phi_im), found '1' "
      "and 3 words");
  EXPECT_EQ(fault(head + "1 0 inf 0\n" + rows.substr(row.size())),
            "f.ffd:3:5: E_phi_re: expected a finite number, found 'inf'");
  EXPECT_EQ(fault(head + "1 0 1e20 0\n" + rows.substr(row.size())),
            "f.ffd:3:5: E_phi_re: expected at most 1e15 V, found 1e20");
  EXPECT_EQ(
      fault(head + row + "2 0 0 0\n" + rows.substr(2 * row.size())),
      "f.ffd:4: expected the strength of line 3 at a pole, which is one direction, found 2 V beside 1 V");
  EXPECT_EQ(fault(head + rows.substr(0, 9 * row.size()) + "0 1 0 0\n" + rows.substr(0, 5 * row.size())),
            "f.ffd:12: expected the field of line 8 again, 360 degrees later, found another one");
  std::string nothing = head;
  for (int i = 0; i < 15; ++i) nothing += "0 0 0 0\n";
  EXPECT_EQ(fault(nothing), "f.ffd:3: expected a field somewhere, found none");
}

TEST(PatternFile, AScenarioChoosesByTheEnding) {
  const test::TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder.path() / name) << text;
  };
  const FfdShape shape;
  write("a.MSI", msi("GAIN 3 dBi", everywhere, dipole_cut));
  write("b.pln", msi("GAIN 3 dBi", everywhere, dipole_cut));
  write("c.ffd", ffd_head(shape) + ffd_rows(shape, dipole_field(1.0)));
  write("two.ffd", ffd_head(shape) + "Frequencies 2\nFrequency 1e9\n" + ffd_rows(shape, dipole_field(1.0)) +
                       "Frequency 2e9\n" + ffd_rows(shape, dipole_field(1.0)));
  const auto scenario = [&](const std::string& keys) {
    return parse_scenario(
        "greatx: 1\nname: p\nticks: 1\nnodes:\n  - name: a\n    trajectory: {type: static, "
        "position_m: [0, 0, 0]}\n    sensors:\n      - {name: x, type: antenna, " +
            keys + "}\n      - {name: y, type: antenna, " + keys + "}\n",
        "s.yaml", folder.path());
  };
  const auto table = [&](const std::string& keys, size_t sensor = 0) {
    return std::get<AntennaConfig>(scenario(keys).nodes[0].sensors[sensor].config).pattern.table;
  };
  EXPECT_NEAR(gain_dbi(table("pattern_file: a.MSI")->at(pi / 2, 1.0)), 3.0, 1e-9);
  EXPECT_NEAR(gain_dbi(table("pattern_file: b.pln, pattern_vertical: up")->at(pi / 2, 1.0)), 3.0, 1e-9);
  EXPECT_NEAR(gain_dbi(table("pattern_file: c.ffd, pattern_power_w: 2")->at(pi / 2, 1.0)),
              2.15088 - decibels(2.0), 1e-4);
  EXPECT_NEAR(gain_dbi(table("pattern_file: two.ffd, pattern_frequency_hz: 2e9")->at(pi / 2, 1.0)), 2.15088,
              1e-4);
  const Scenario both = scenario("pattern_file: c.ffd");
  EXPECT_EQ(std::get<AntennaConfig>(both.nodes[0].sensors[0].config).pattern.table,
            std::get<AntennaConfig>(both.nodes[0].sensors[1].config).pattern.table);
  const auto fault = [&](const std::string& keys) { return refusal([&] { scenario(keys); }); };
  const std::string place = "s.yaml:8: nodes[0].sensors[0].";
  EXPECT_EQ(fault("pattern_power_w: 2"),
            place + "pattern_power_w: expected 'pattern_file' beside it, found none");
  EXPECT_EQ(fault("pattern_file: a.MSI, pattern_power_w: 2"),
            place +
                "pattern_power_w: expected 'pattern_power_w' with a pattern_file .ffd alone, found another "
                "one");
  EXPECT_EQ(fault("pattern_file: c.ffd, pattern_vertical: up"),
            place +
                "pattern_vertical: expected 'pattern_vertical' with a pattern_file .msi or .pln alone, found "
                "another one");
  EXPECT_EQ(
      fault("pattern_file: c.ffd, pattern_power_w: 0.5"),
      place + "pattern_power_w: expected the power that makes the fields, which radiate 1 W, found 0.5 W");
  EXPECT_EQ(fault("pattern_file: two.ffd"),
            place +
                "pattern_file: expected 'pattern_frequency_hz' beside it: one of the file's 2 frequencies "
                "(1000000000, 2000000000), found none");
}

}  // namespace
}  // namespace greatx::sim
