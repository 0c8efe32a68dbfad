// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs `greatx rcs` on a plate and compares the tables with the closed forms of physical optics.
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "core/vec.h"
#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using greatx::dvec3;
using greatx::pi;
using greatx::radians;
using greatx::apps::test::greatx;
using greatx::apps::test::Outcome;
using greatx::apps::test::read_file;
using testing::AllOf;
using testing::HasSubstr;
using Number = std::complex<double>;

constexpr double side_m = 0.1, carrier_hz = 30e9, wavelength_m = greatx::speed_of_light / carrier_hz;
constexpr double wave_number = 2.0 * pi / wavelength_m;

struct Line {
  std::vector<double> values;
  Number entry(size_t first) const { return {values[first], values[first + 1]}; }
  dvec3 direction(size_t first) const {
    const double theta = radians(values[first]), phi = radians(values[first + 1]);
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  }
  /// The unit vectors of theta and phi.
  std::array<dvec3, 2> basis(size_t first) const {
    const double theta = radians(values[first]), phi = radians(values[first + 1]);
    return {dvec3(std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi), -std::sin(theta)),
            dvec3(-std::sin(phi), std::cos(phi), 0.0)};
  }
};

struct Table {
  std::string comment, header;
  std::vector<Line> lines;
};

Table read_table(const fs::path& file) {
  std::istringstream in(read_file(file));
  Table table;
  std::getline(in, table.comment);
  std::getline(in, table.header);
  for (std::string text; std::getline(in, text);) {
    std::istringstream cells(text);
    Line& line = table.lines.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) line.values.push_back(std::stod(cell));
  }
  return table;
}

double sinc(double x) { return std::abs(x) < 1e-9 ? 1.0 : std::sin(x) / x; }

/// The pattern of a square in the plane x = 0 whose currents radiate with the phases of both directions.
double pattern(const dvec3& sum) {
  return sinc(0.5 * wave_number * side_m * sum.y) * sinc(0.5 * wave_number * side_m * sum.z);
}

class RcsCli : public testing::Test {
 protected:
  void SetUp() override {
    std::string bytes;
    const auto put = [&](const auto& value) {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    constexpr float h = static_cast<float>(0.5 * side_m);
    const float corners[4][2] = {{-h, -h}, {h, -h}, {h, h}, {-h, h}};
    for (const auto& [y, z] : corners) put(0.0f), put(z), put(-y);  // (x, y, z) is (x, z, -y) in glTF
    for (const uint16_t index :
         {uint16_t{0}, uint16_t{1}, uint16_t{2}, uint16_t{0}, uint16_t{2}, uint16_t{3}})
      put(index);
    write("plate.bin", bytes);
    write("plate.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0, "name": "plate"}], "materials": [{"name": "itu_metal"}],
      "meshes": [{"name": "plate", )"
                        R"("primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
      "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
      "buffers": [{"byteLength": 60, "uri": "plate.bin"}]})");
    write("plate.yaml", scenario);
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
  }
  Outcome rcs(const std::string& options) const {
    return greatx(fmt::format("rcs {} {} -o {}", path("plate.yaml"), options, path("table.csv")));
  }

  static constexpr const char* scenario = R"(greatx: 1
name: plate
ticks: 1
tick_rate_hz: 10
nodes:
  - name: bs
    trajectory: {type: static, position_m: [0, 0, 10]}
    sensors: [{name: antenna, type: antenna}]
  - name: plate
    trajectory: {type: static, position_m: [30, 0, 10], rotation_deg: [180, 0, 0]}
    model: {file: plate.gltf}
)";

 private:
  greatx::test::TemporaryFolder folder_;
};

/// S = -j A/lambda cos(theta) sinc sinc in physical optics, for both polarizations and from both sides, with
/// phases about the middle (C. A. Balanis, Advanced Engineering Electromagnetics, 11.3).
TEST_F(RcsCli, APlateHasItsClosedForm) {
  const Outcome outcome = rcs("--node plate --carrier 30e9 --step 15 --width 0.003");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("312 directions at 30 GHz"));
  const Table table = read_table(path("table.csv"));
  EXPECT_THAT(table.comment, AllOf(HasSubstr("# plate at 3e+10 Hz"), HasSubstr("tubes of 0.003 m")));
  EXPECT_EQ(table.header, "theta_deg,phi_deg,s_tt_re,s_tt_im,s_tp_re,s_tp_im,s_pp_re,s_pp_im");
  ASSERT_EQ(table.lines.size(), 13u * 24);
  const double peak = side_m * side_m / wavelength_m;
  size_t compared = 0;
  for (const Line& line : table.lines) {
    ASSERT_EQ(line.values.size(), 8u);
    const dvec3 d = line.direction(0);
    const Number expected(0.0, -peak * std::abs(d.x) * pattern(2.0 * d));
    const std::string where = fmt::format("theta {}, phi {}", line.values[0], line.values[1]);
    EXPECT_LT(std::abs(line.entry(4)), 1e-4 * peak) << where;
    for (const size_t copolar : {size_t{2}, size_t{6}}) {
      EXPECT_LT(std::abs(line.entry(copolar) - expected), 0.01 * std::abs(expected) + 1e-4 * peak) << where;
      if (std::abs(expected) < 1e-3 * peak) continue;
      EXPECT_NEAR(20.0 * std::log10(std::abs(line.entry(copolar) / expected)), 0.0, 0.05) << where;
      ++compared;
    }
  }
  EXPECT_GT(compared, 40u);
}

/// A channel reads the table and obeys the radar equation with 4 pi A^2/lambda^2.
TEST_F(RcsCli, AChannelReadsTheTable) {
  ASSERT_EQ(rcs("--node plate --carrier 30e9 --step 30 --width 0.003").code, 0);
  write("plate.yaml", std::string(scenario) + R"(channels:
  - {name: csi, tx: bs/antenna, rx: bs/antenna, rate_hz: 10, carrier_hz: 30e9,
     targets: [{nodes: plate, table: table.csv}]}
effects: {gas: off}
)");
  const Outcome outcome = greatx("paths " + path("plate.yaml") + " --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto paths = nlohmann::json::parse(outcome.out)["receivers"][0]["paths"];
  ASSERT_EQ(paths.size(), 1u);
  const double section = 4.0 * pi * std::pow(side_m, 4) / (wavelength_m * wavelength_m);
  const double gain = wavelength_m * wavelength_m * section / (std::pow(4.0 * pi, 3) * std::pow(30.0, 4));
  EXPECT_NEAR(paths[0]["gain_db"].get<double>(), 10.0 * std::log10(gain), 0.02);
}

/// S_qp = -j k A/(2 pi) e_q . (n x (-i x e_p)) sinc sinc where both directions are in front of the plate.
TEST_F(RcsCli, ABistaticTableHasTheClosedFormOfAPlate) {
  const Outcome outcome = rcs("--node plate --carrier 30e9 --step 60 --width 0.003 --bistatic");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("576 pairs of directions at 30 GHz"));
  const Table table = read_table(path("table.csv"));
  EXPECT_EQ(
      table.header,
      "theta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg,s_tt_re,s_tt_im,s_tp_re,s_tp_im,s_pt_re,s_pt_im,"
      "s_pp_re,s_pp_im");
  ASSERT_EQ(table.lines.size(), 24u * 24);
  const double peak = side_m * side_m / wavelength_m;
  const dvec3 normal(1.0, 0.0, 0.0);
  size_t compared = 0;
  for (const Line& line : table.lines) {
    ASSERT_EQ(line.values.size(), 12u);
    const dvec3 in = line.direction(0), out = line.direction(2);
    if (in.x < 0.1 || out.x < 0.1) continue;
    const auto sent = line.basis(0), received = line.basis(2);
    for (size_t q = 0; q < 2; ++q)
      for (size_t p = 0; p < 2; ++p) {
        const double current = glm::dot(received[q], glm::cross(normal, glm::cross(-in, sent[p])));
        const Number expected(0.0, -peak * current * pattern(in + out));
        EXPECT_LT(std::abs(line.entry(4 + 4 * q + 2 * p) - expected), 0.01 * std::abs(expected) + 2e-4 * peak)
            << fmt::format("in {} {}, out {} {}, {}{}", line.values[0], line.values[1], line.values[2],
                           line.values[3], q, p);
        compared += std::abs(expected) > 0.02 * peak;
      }
  }
  EXPECT_GT(compared, 8u);
}

/// Over a bistatic table a channel gets what it gets from the target's surfaces themselves, with the signs of
/// the cross-polar parts.
TEST_F(RcsCli, TheTableStandsForTheSurfaces) {
  ASSERT_EQ(rcs("--node plate --carrier 30e9 --step 60 --width 0.003 --bistatic").code, 0);
  // 300 m away in the directions (60, 60) and (120, 0) of a plate that faces +x.
  const auto echo_of = [&](const std::string& model) {
    write("plate.yaml", fmt::format(R"(greatx: 1
name: plate
ticks: 1
tick_rate_hz: 10
nodes:
  - name: bs
    trajectory: {{type: static, position_m: [129.903810567666, 225, 350]}}
    sensors: [{{name: antenna, type: antenna}}]
  - name: ue
    trajectory: {{type: static, position_m: [259.807621135332, 0, 50]}}
    sensors: [{{name: antenna, type: antenna}}]
  - name: plate
    trajectory: {{type: static, position_m: [0, 0, 200]}}
    model: {{file: plate.gltf}}
channels:
  - {{name: csi, tx: bs/antenna, rx: ue/antenna, rate_hz: 10, carrier_hz: 30e9,
     targets: [{{nodes: plate, {}}}]}}
effects: {{gas: off}}
)",
                                    model));
    const Outcome outcome = greatx("paths " + path("plate.yaml") + " --json");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::array<Number, 4> sum{};
    const auto document = nlohmann::json::parse(outcome.out);
    for (const auto& path : document["receivers"][0]["paths"]) {
      if (path["chain"] != "E") continue;
      const double turns = carrier_hz * (path["delay_s"].get<double>() - 600.0 / greatx::speed_of_light);
      for (size_t i = 0; i < 4; ++i)
        sum[i] +=
            Number(path["transfer_per_m"][i][0].get<double>(), path["transfer_per_m"][i][1].get<double>()) *
            std::polar(1.0, -2.0 * pi * turns);
    }
    return sum;
  };
  const auto table = echo_of("table: table.csv"), tubes = echo_of("tubes: {width_m: 0.003}");
  const double strongest = std::abs(tubes[3]);
  EXPECT_GT(std::abs(tubes[1]), 0.3 * strongest);
  for (size_t i = 0; i < 4; ++i) EXPECT_LT(std::abs(table[i] - tubes[i]), 0.03 * strongest) << i;
}

TEST_F(RcsCli, BadArgumentsAreNamed) {
  const auto refused = [&](const std::string& options, const std::string& message) {
    const Outcome outcome = rcs(options);
    EXPECT_EQ(outcome.code, 1) << options;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << options;
    EXPECT_EQ(outcome.out, "") << options;
    EXPECT_FALSE(fs::exists(path("table.csv"))) << options;
  };
  refused("", "greatx rcs: expected --node (");
  refused("--node nobody", "--node: expected one of bs, plate, found 'nobody'");
  refused("--node bs", "--node: expected a node with a model, found 'bs'");
  refused("--node plate --step 7", "--step: expected a step that divides 180 degrees, found 7");
  refused("--node plate --step 0", "--step: expected a number from 0.1 to 90, found '0'");
  refused("--node plate --step 5 --bistatic",
          "--step: expected a step that gives at most 2097152 lines of the table, found 7096896 with 5");
  refused("--node plate --bounces 9", "--bounces: expected an integer from 1 to 6, found '9'");
  refused("--node plate --width -1", "--width: expected a number from 0.0001 to 10000, found '-1'");
  refused("--node plate --budget 3", "--budget: expected an integer from 100 to 4000000, found '3'");
  refused("--node plate --carrier x", "--carrier: expected a finite number, found 'x'");
  fs::remove(path("plate.gltf"));
  refused("--node plate", "plate.gltf");
}

}  // namespace
