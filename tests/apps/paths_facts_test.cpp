// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/paths/output.h"
#include "apps/paths/text.h"
#include "core/error.h"
#include "draw/paths/facts.h"
#include "tests/apps/sample_paths.h"

namespace greatx::apps {
namespace {

using rf::InteractionType;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double carrier = 3.5e9;
constexpr double wavelength = speed_of_light / carrier;

rf::Interaction at(InteractionType type, uint32_t element) { return {type, element, 0}; }

TEST(PathFacts, GainOfALineOfSightIsFriis) {
  const rf::Path path = path_through({{0, 0, 0}, {100, 0, 0}}, {});
  // Free-space loss: 20 lg(d) + 20 lg(f) - 147.55 dB.
  EXPECT_NEAR(gain_db(path_gain(path, carrier)), -(40.0 + 20.0 * std::log10(carrier) - 147.5522), 1e-3);
}

TEST(PathFacts, GainIsTheMeanOverThePolarizationSent) {
  rf::Path path = path_through({{0, 0, 0}, {100, 0, 0}}, {});
  const double friis = path_gain(path, carrier);
  path.transfer[3] = 0.0;  // the horizontal wave is lost, which is half of the mean power
  EXPECT_NEAR(path_gain(path, carrier) / friis, 0.5, 1e-15);
  path.transfer[1] = path.transfer[0];  // half of the power comes back in the other polarization
  EXPECT_NEAR(path_gain(path, carrier) / friis, 1.0, 1e-15);
}

TEST(PathFacts, PhaseTurnsBackWithTheDelay) {
  const auto phase = [](double wavelengths) {
    return std::arg(
        vertical_amplitude(path_through({{0, 0, 0}, {wavelengths * wavelength, 0, 0}}, {}), carrier));
  };
  EXPECT_NEAR(phase(1000.0), 0.0, 1e-9);
  EXPECT_NEAR(phase(1000.25), -0.5 * pi, 1e-9);
  EXPECT_NEAR(phase(1000.75), 0.5 * pi, 1e-9);
}

TEST(PathFacts, ChainsAndKinds) {
  rf::Path path = path_through({{0, 0, 0}, {1, 0, 0}}, {});
  EXPECT_EQ(chain_of(path), "LoS");
  EXPECT_EQ(kind_of(path), InteractionType::none);
  path.interactions = {at(InteractionType::reflection, 0), at(InteractionType::transmission, 1)};
  EXPECT_EQ(chain_of(path), "RT");
  EXPECT_EQ(kind_of(path), InteractionType::transmission);
  path.interactions = {at(InteractionType::diffraction, 0), at(InteractionType::reflection, 1)};
  EXPECT_EQ(kind_of(path), InteractionType::diffraction);
  path.interactions.push_back(at(InteractionType::scattering, 1));
  EXPECT_EQ(chain_of(path), "DRS");
  EXPECT_EQ(kind_of(path), InteractionType::scattering);
}

TEST(PathFacts, InteractionsNameObjectsAndMaterials) {
  const SampleScene sample;
  rf::Path path;
  path.interactions = {at(InteractionType::reflection, 0), at(InteractionType::diffraction, 0),
                       at(InteractionType::scattering, 2)};
  EXPECT_EQ(describe_interactions(path, sample.view()),
            "R house (glass), D house | roof (glass | tile), S tree (leaves)");
  const Touched edge = touched(path.interactions[1], sample.view());
  EXPECT_THAT(edge.facets, ElementsAre(0u, 1u));
  EXPECT_EQ(describe_interactions(rf::Path{}, sample.view()), "line of sight");
  EXPECT_THROW(touched(at(InteractionType::reflection, 3), sample.view()), ContractError);
  EXPECT_THROW(touched(at(InteractionType::diffraction, 1), sample.view()), ContractError);
}

TEST(PathFacts, DelaySpreadOfTwoEqualPathsIsHalfTheirDistance) {
  PathLink link;
  link.paths = {path_through({{0, 0, 0}, {300, 0, 0}}, {}), path_through({{0, 0, 0}, {330, 0, 0}}, {}, 1.1)};
  const LinkFigures figures = figures_of(link, carrier);
  EXPECT_NEAR(*figures.delay_spread_s, 15.0 / speed_of_light, 1e-20);
  EXPECT_EQ(*figures.first_delay_s, link.paths[0].delay_s);
  EXPECT_NEAR(figures.gain, 2.0 * path_gain(link.paths[0], carrier), 1e-25);
}

TEST(PathFacts, ALinkWithoutPathsHasNoFiguresToSpeakOf) {
  const LinkFigures figures = figures_of(PathLink{}, carrier);
  EXPECT_EQ(figures.paths, 0u);
  EXPECT_FALSE(figures.first_delay_s || figures.delay_spread_s || figures.line_of_sight);
}

TEST(PathFacts, StrongPathsAreCountedFromTheStrongestOfAllLinks) {
  std::vector<PathLink> links{sample_link(), sample_link()};  // the second path is 11 dB weaker
  for (rf::Path& path : links[1].paths)
    for (rf::Complex& t : path.transfer) t *= 0.1;
  const auto counts = [&](double range_db) {
    std::vector<size_t> left;
    for (const PathLink& link : strong_paths(links, carrier, range_db)) left.push_back(link.paths.size());
    return left;
  };
  EXPECT_THAT(counts(0.0), ElementsAre(1u, 0u));
  EXPECT_THAT(counts(15.0), ElementsAre(2u, 0u));
  EXPECT_THAT(counts(25.0), ElementsAre(2u, 1u));
  EXPECT_THAT(counts(100.0), ElementsAre(2u, 2u));
}

TEST(PathFacts, PathsAreSortedByDelayThenCanonically) {
  std::vector<rf::Path> paths(3);
  paths[0].delay_s = 2.0;
  paths[1].delay_s = paths[2].delay_s = 1.0;
  paths[1].interactions = {at(InteractionType::reflection, 5)};
  paths[2].interactions = {at(InteractionType::reflection, 4)};
  sort_by_delay(paths);
  EXPECT_EQ(paths[0].interactions[0].element, 4u);
  EXPECT_EQ(paths[1].interactions[0].element, 5u);
  EXPECT_EQ(paths[2].delay_s, 2.0);
}

// ---------------------------------------------------------------------------------------------- printed text

TEST(PathText, TheTableHasUnitsAnglesAndNames) {
  const SampleScene sample;
  const std::string table = table_of(sample_link(), sample.view());
  EXPECT_THAT(
      table,
      HasSubstr("uav/antenna at (40.000, 0.000, 2.000) m, 40.000 m from the transmitter: 2 paths, with "
                "line of sight, gain "));
  EXPECT_THAT(table, HasSubstr("delay ns"));
  EXPECT_THAT(table, HasSubstr("R house (glass)"));
  EXPECT_THAT(table, HasSubstr("133.426"));  // 40 m in ns
  EXPECT_THAT(table, HasSubstr("153.43"));   // azimuth of arrival from the wall: 180 - atan(1/2)
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
}

TEST(PathText, JsonHoldsEverythingInWorldCoordinates) {
  const dvec3 origin(500000.0, 5400000.0, 30.0);
  const SampleScene sample(origin);
  const auto json = json_of(sample_link(origin), sample.view());
  EXPECT_EQ(json["position_m"], nlohmann::json({500040.0, 5400000.0, 32.0}));
  const auto& path = json["paths"][1];
  EXPECT_EQ(path["vertices_m"][1], nlohmann::json({500020.0, 5400010.0, 32.0}));
  EXPECT_EQ(path["chain"], "R");
  EXPECT_EQ(path["interactions"][0]["facets"], nlohmann::json({0}));
  EXPECT_EQ(path["interactions"][0]["materials"], nlohmann::json({"glass"}));
  EXPECT_EQ(path["transfer_per_m"].size(), 4u);
  EXPECT_EQ(path["transfer_per_m"][0][0].get<double>(), sample_link().paths[1].transfer[0].real());
  EXPECT_EQ(path["id"], id_text(sample_link().paths[1].id()));
  EXPECT_NEAR(path["departure"]["azimuth_rad"], std::atan(0.5), 1e-12);
  EXPECT_NEAR(path["departure"]["zenith_rad"], 0.5 * pi, 1e-12);
}

TEST(PathText, ADarkPathIsNullInJsonAndEmptyInCsv) {
  const SampleScene sample;
  PathLink link = sample_link();
  link.paths = {path_through({{0, 0, 2}, {40, 0, 2}}, {}, 0.0)};
  EXPECT_TRUE(json_of(link, sample.view())["paths"][0]["gain_db"].is_null());
  EXPECT_THAT(csv_row(link, sample.view()), HasSubstr(",1,1,,133."));
  link.paths.clear();
  EXPECT_EQ(csv_row(link, sample.view()), "0,40,0,2,40,0,0,,,\n");
}

TEST(PathOutput, JsonIsOneObjectAndLinesAreOneEach) {
  const SampleScene sample;
  for (const size_t receivers : {0u, 1u, 3u}) {
    std::ostringstream whole, lines;
    for (const auto& output : {json_output(whole, sample.view()), json_lines_output(lines, sample.view())}) {
      output->begin({{"tick", 7}});
      for (size_t i = 0; i < receivers; ++i) output->add(sample_link());
      output->end({{"totals", 1}, {"search", "none"}});
    }
    const auto json = nlohmann::json::parse(whole.str());
    EXPECT_EQ(json["tick"], 7);
    EXPECT_EQ(json["receivers"].size(), receivers);
    EXPECT_EQ(json["search"], "none");
    std::istringstream in(lines.str());
    std::vector<std::string> kinds;
    for (std::string line; std::getline(in, line);) kinds.push_back(nlohmann::json::parse(line)["kind"]);
    ASSERT_EQ(kinds.size(), receivers + 2);
    EXPECT_EQ(kinds.front(), "head");
    EXPECT_EQ(kinds.back(), "totals");
  }
}

TEST(PathOutput, TotalsCountKinds) {
  PathTotals totals;
  totals.add(figures_of(sample_link(), carrier));
  totals.add(figures_of(PathLink{}, carrier));
  EXPECT_EQ(totals.text(), "2 receivers, 2 paths (line of sight 1, reflection 1), 1 receiver without any");
}

}  // namespace
}  // namespace greatx::apps
