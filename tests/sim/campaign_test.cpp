// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks campaigns: axes, cells, splits, and what is said of faults.
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/fields/named_path.h"
#include "core/fields/yaml.h"
#include "sim/campaign/cells.h"

namespace greatx::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* base_text = R"(greatx: 1  # the base
name: base
ticks: 5
tick_rate_hz: 10
scene: {generate: {kind: city, seed: 7, size_m: 200}}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [0, 0, 25]}
    sensors: [{name: a, type: antenna}]
  - name: uav
    trajectory: {type: static, position_m: [20, 0, 30]}
    sensors: [{name: a, type: antenna}]
channels:
  - {name: csi, tx: bs/a, rx: [uav/a], rate_hz: 10, bandwidth_hz: 20e6, subcarriers: 16, max_depth: 1}
)";

BaseScenario find_base(const std::string& name) {
  if (name != "base.yaml") throw_user_error("{}: no such scenario", name);
  return {base_text, "base.yaml", ".", {}};
}

Campaign parse(const std::string& rest) {
  return parse_campaign("greatx_campaign: 1\nname: c\nbase: base.yaml\n" + rest, "c.yaml", ".");
}
std::vector<CampaignCell> cells_of(const std::string& rest) { return campaign_cells(parse(rest), find_base); }

std::string fault_of(const std::string& rest) {
  try {
    cells_of(rest);
  } catch (const UserError& error) {
    return error.what();
  }
  return "no fault";
}

const std::string axes =
    "axes:\n"
    "  scene:\n"
    "    near:\n      seed: 3\n      nodes[uav].trajectory.position_m: [10, 0, 30]\n"
    "    far:\n      seed: 4\n      nodes[uav].trajectory.position_m: [90, 0, 30]\n      sequences: 7\n"
    "  carrier:\n"
    "    low:\n      channels[csi].carrier_hz: 3.5e9\n"
    "    high:\n      channels[csi].carrier_hz: 28e9\n"
    "sequences: 4\n";

TEST(Campaign, CellsAreTheChoicesOfAllAxes) {
  const std::vector<CampaignCell> cells = cells_of(axes);
  std::vector<std::string> names;
  for (const CampaignCell& cell : cells) names.push_back(cell.name);
  EXPECT_THAT(names, ElementsAre("near.low", "near.high", "far.low", "far.high"));
  EXPECT_EQ(cells[3].scenario.name, "far.high");
  EXPECT_EQ(cells[3].scenario.seed, 4u);
  EXPECT_EQ(cells[3].scenario.sequences, 7u);
  EXPECT_EQ(cells[0].scenario.sequences, 4u);
  EXPECT_EQ(cells[3].scenario.channels[0].carrier_hz, 28e9);
  const auto& place = std::get<StaticTrajectory>(cells[3].scenario.nodes[1].trajectory);
  EXPECT_EQ(place.position_m.x, 90.0);
  EXPECT_THAT(cells[3].scenario.text, HasSubstr("# the base"));  // comments stay
  EXPECT_EQ(cells_of("").front().name, "all");
}

TEST(Campaign, ExclusionsLeaveCellsOut) {
  std::vector<std::string> names;
  for (const CampaignCell& cell : cells_of(axes + "exclude: [{scene: far, carrier: [high]}]\n"))
    names.push_back(cell.name);
  EXPECT_THAT(names, ElementsAre("near.low", "near.high", "far.low"));
}

TEST(Campaign, ASequenceKeepsItsSplitHoweverManyThereAre) {
  const Campaign campaign = parse(axes + "split: {by: trajectory, train: 0.8, validation: 0.1, test: 0.1}\n");
  std::map<Split, int> counts;
  for (uint32_t s = 0; s < 1000; ++s) {
    const Split split = split_of(campaign, {0, 0}, s);
    EXPECT_EQ(split, split_of(campaign, {1, 1}, s));  // the same trajectory in another cell
    ++counts[split];
    if (s == 9) {
      EXPECT_EQ(counts.size(), 3u);  // ten sequences have all three
    }
  }
  EXPECT_NEAR(counts[Split::train], 800, 3);
  EXPECT_NEAR(counts[Split::validation], 100, 3);
  EXPECT_NEAR(counts[Split::test], 100, 3);
}

TEST(Campaign, SplitsByAnAxisWhoseValuesSharePlacesAreRefused) {
  const Campaign campaign = parse(axes + "split: {by: scene, train: near, test: [far]}\n");
  EXPECT_EQ(split_of(campaign, {0, 1}, 3), Split::train);
  EXPECT_EQ(split_of(campaign, {1, 1}, 3), Split::test);
  EXPECT_THAT(fault_of(axes + "split: {by: carrier, train: low, test: high}\n"), HasSubstr("share places"));
  EXPECT_THAT(fault_of(axes + "split: {by: scene, train: near}\n"), HasSubstr("'far' is in none"));
  EXPECT_THAT(fault_of(axes + "split: {by: scene, train: [near, far], test: far}\n"),
              HasSubstr("'far' is in train already"));
  EXPECT_THAT(fault_of(axes + "split: {train: 0.8, test: 0.1}\n"), HasSubstr("sum to 1"));
}

TEST(Campaign, FaultsNameTheLineAndTheField) {
  EXPECT_THAT(fault_of("axes:\n  a:\n    x:\n      nodes[drone].model: {}\n"),
              AllOf(HasSubstr("c.yaml:7"), HasSubstr("bs, uav"), HasSubstr("'drone'")));
  EXPECT_THAT(fault_of("axes: {a: {x: {ticks: -3}}}\n"), HasSubstr("cell x"));
  EXPECT_THAT(fault_of("axes: {a: {x: {tickz: 3}}}\n"), HasSubstr("tickz"));
  EXPECT_THAT(fault_of(axes + "exclude: [{scene: middle}]\n"), HasSubstr("near, far"));
  EXPECT_THAT(fault_of(axes + "exclude: [{place: near}]\n"), HasSubstr("scene, carrier"));
  EXPECT_THAT(fault_of(axes + "exclude: [{scene: [near, far]}]\n"), HasSubstr("nothing is left"));
  EXPECT_THAT(fault_of(axes + "exclude: [{scene: near}, {scene: near, carrier: low}, {scene: [far, near], "
                              "carrier: low}]\n"),
              HasSubstr("no fault"));
  EXPECT_THAT(fault_of("axes: {a: {x: 3}}\n"), HasSubstr("a map"));
  EXPECT_THAT(fault_of("axes: {'a/b': {x: {}}}\n"), HasSubstr("letters, digits"));
  EXPECT_THAT(fault_of("sequences: 0\n"), HasSubstr("sequences"));
  EXPECT_THAT(fault_of("axes: {a: {x: {base: other.yaml}}}\n"), HasSubstr("other.yaml"));
}

TEST(Campaign, AUnitsScenarioDoesNotDependOnTheirNumber) {
  const CampaignCell few = cells_of(axes)[0];
  std::string more = axes;
  more.replace(more.find("sequences: 4"), 12, "sequences: 9");
  const CampaignCell many = cells_of(more)[0];
  EXPECT_NE(few.scenario.text, many.scenario.text);
  EXPECT_EQ(with_sequences(few.scenario, 3).text, with_sequences(many.scenario, 3).text);
  EXPECT_EQ(with_sequences(few.scenario, 3).sequences, 3u);
}

TEST(NamedPath, ItemsHaveNumbersAndNames) {
  const auto root = read_yaml(base_text, "base.yaml");
  EXPECT_EQ(yaml_path_text(named_yaml_path("nodes[uav].sensors[a].type", root)), "nodes[1].sensors[0].type");
  EXPECT_EQ(yaml_path_text(named_yaml_path("nodes[1].sensors[0]", root)), "nodes[1].sensors[0]");
  EXPECT_THROW(named_yaml_path("nodes[car]", root), UserError);
  EXPECT_THROW(named_yaml_path("seed[car]", root), UserError);
  EXPECT_THAT(set_yaml_value(base_text, "nodes[uav].trajectory.position_m", "[1, 2, 3]", "test"),
              HasSubstr("[1, 2, 3]"));
}

}  // namespace
}  // namespace greatx::sim
