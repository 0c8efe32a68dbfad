// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the shapes of paths of records made by hand.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/units.h"
#include "tests/view/made_csi.h"
#include "view/overlay/path_shapes.h"

namespace greatx::view {
namespace {

using testing::expect_user_error;
using ::testing::HasSubstr;
using testing::legend_of;
using testing::Made;
using testing::MadePath;
using ::testing::Not;
using testing::same;
using testing::Shown;

/// One path of each kind and order, all of the first link.
const std::vector<MadePath> all_kinds{{0, 0, 11, -60.0, {}},         {0, 0, 12, -70.0, {1}},
                                      {0, 0, 13, -80.0, {1, 2}},     {0, 0, 14, -90.0, {1, 3}},
                                      {0, 0, 15, -100.0, {2, 1, 4}}, {0, 0, 16, -110.0, {1, 1, 1}}};

/// The ids of the paths shown: rows that lines belong to.
std::set<uint64_t> ids_of(const Shapes& shapes) {
  std::set<uint64_t> ids;
  for (const LineShape& line : shapes.lines) ids.insert(shapes.rows.at(line.row).id);
  return ids;
}

PathFilter only(std::initializer_list<rf::InteractionType> kinds) {
  PathFilter filter;
  filter.kinds.fill(false);
  for (const rf::InteractionType kind : kinds) filter.kinds[static_cast<size_t>(kind)] = true;
  return filter;
}

TEST(PathShapes, RunFromEndToEndOverTheirVertices) {
  const Shown shown({{0, 0, 42, -80.0, {1, 3}}});
  const Shapes shapes = shown.shapes();
  ASSERT_EQ(shapes.lines.size(), 3u);
  // The mounts: of the mast (-1, 0, 1); of the uav, which looks north, (0.5, 0, 1) becomes (0, 0.5, 1).
  EXPECT_LT(glm::distance(shapes.lines[0].a, dvec3(-1, 0, 11)), 1e-12);
  EXPECT_EQ(shapes.lines[0].b, dvec3(0, 0, 5));
  EXPECT_EQ(shapes.lines[1].a, dvec3(0, 0, 5));
  EXPECT_EQ(shapes.lines[1].b, dvec3(0, 1, 5));
  EXPECT_EQ(shapes.lines[2].a, dvec3(0, 1, 5));
  EXPECT_LT(glm::distance(shapes.lines[2].b, dvec3(40, 0.5, 21)), 1e-12);
  std::vector<PointShape::Mark> marks;
  for (const PointShape& point : shapes.points)
    if (point.row == shapes.lines[0].row) marks.push_back(point.mark);
  EXPECT_THAT(marks, ::testing::ElementsAre(PointShape::Mark::dot, PointShape::Mark::triangle));
}

TEST(PathShapes, HaveTheRowThatGreatxPathsPrints) {
  const Shown shown({{0, 0, 0xabc, -80.0, {1, 3}}});
  const Shapes shapes = shown.shapes();
  const std::string text = shapes.rows.at(shapes.lines.at(0).row).text;
  for (const char* part :
       {"RD (diffraction), 2 interactions", "id 0000000000000abc", "from mast/left to uav/antenna",
        "length 29.979 m", "delay 100.000 ns", "gain -80.00 dB",
        "departure: azimuth 45.00 deg, zenith 90.00 deg", "arrival: azimuth -90.00 deg, zenith 60.00 deg",
        "Doppler 25.500 Hz", "1: R ground (itu_glass)", "2: D tower (itu_glass)"})
    EXPECT_THAT(text, HasSubstr(part));
  // 350 turns of 3.5 GHz over 100 ns: no phase is left.
  EXPECT_THAT(text, ::testing::AnyOf(HasSubstr("phase 0.00 deg"), HasSubstr("phase -0.00 deg")));
}

TEST(PathShapes, AFilterKeepsWhatItSays) {
  using enum rf::InteractionType;
  const Shown shown(all_kinds);
  const auto kept = [&](const PathFilter& filter) { return ids_of(shown.shapes({filter})); };
  EXPECT_EQ(kept({}), (std::set<uint64_t>{11, 12, 13, 14, 15, 16}));
  EXPECT_EQ(kept(only({none})), (std::set<uint64_t>{11}));
  EXPECT_EQ(kept(only({reflection})), (std::set<uint64_t>{12, 16}));
  EXPECT_EQ(kept(only({transmission, scattering})), (std::set<uint64_t>{13, 15}));
  EXPECT_EQ(kept(only({})), (std::set<uint64_t>{}));
  PathFilter order;
  order.min_order = 1;
  order.max_order = 2;
  EXPECT_EQ(kept(order), (std::set<uint64_t>{12, 13, 14}));
  PathFilter strong;
  strong.within_db = 20.001;
  EXPECT_EQ(kept(strong), (std::set<uint64_t>{11, 12, 13}));
  // Of the strongest of the link, also where that one's kind is switched off.
  PathFilter both = only({reflection, transmission});
  both.within_db = 10.001;
  EXPECT_EQ(kept(both), (std::set<uint64_t>{12}));
  strong.within_db = 0.0;
  EXPECT_EQ(kept(strong), (std::set<uint64_t>{11}));
}

TEST(PathShapes, OfOneLinkAloneWithItsOwnStrongest) {
  const Shown shown(
      {{0, 0, 5, -60.0, {}}, {0, 1, 5, -70.0, {}}, {1, 0, 5, -90.0, {}}, {1, 1, 6, -95.0, {1}}});
  PathOptions options;
  options.filter.within_db = 10.0;
  options.filter.receiver = 1;
  const Shapes of_receiver = shown.shapes(options);
  EXPECT_EQ(of_receiver.lines.size(), 3u);  // a line of sight and a reflection
  for (const LineShape& line : of_receiver.lines)
    EXPECT_TRUE(line.b == dvec3(77, 0, 1) || line.a == dvec3(-1, 0, 11) || line.a == dvec3(1, 0, 11));
  options.filter.transmitter = 1;
  EXPECT_EQ(shown.shapes(options).lines.size(), 2u);
  EXPECT_THAT(legend_of(shown.shapes(options)), HasSubstr("csi: 1 of 1 paths"));
  options.filter.receiver = 9;
  EXPECT_TRUE(shown.shapes(options).lines.empty());
}

TEST(PathShapes, HaveIdentitiesThatDifferByLink) {
  const Shown shown({{0, 0, 5, -60.0, {}}, {0, 1, 5, -70.0, {}}, {1, 0, 5, -90.0, {}}, {1, 1, 5, -95.0, {}}});
  EXPECT_EQ(ids_of(shown.shapes()).size(), 4u) << "four lines of sight, which have one identity";
  EXPECT_EQ(path_row_id(5, 0), 5u);
  PathOptions options;
  options.filter.receiver = 0;
  options.filter.transmitter = 0;
  EXPECT_EQ(ids_of(shown.shapes(options)), (std::set<uint64_t>{5}));
}

/// Where a colour lies in the range that gains are drawn in.
double place_of(io::Color color) {
  double best = 0.0, least = 1e9;
  for (int i = 0; i <= 1000; ++i) {
    const io::Color at = io::turbo(0.12 + 0.8 * i / 1000.0);
    const double distance = std::abs(at.r - color.r) + std::abs(at.g - color.g) + std::abs(at.b - color.b);
    if (distance < least) {
      least = distance;
      best = i / 1000.0;
    }
  }
  return best;
}

TEST(PathShapes, HaveColoursThatRiseWithTheGain) {
  std::vector<MadePath> paths;
  for (uint64_t i = 0; i < 30; ++i) paths.push_back({0, 0, i + 1, -120.0 + 2.0 * static_cast<double>(i), {}});
  const Shown shown(paths);
  const Shapes shapes = shown.shapes();
  ASSERT_EQ(shapes.lines.size(), 30u);
  std::map<uint64_t, double> places;
  for (const LineShape& line : shapes.lines) places[shapes.rows[line.row].id] = place_of(line.color);
  for (uint64_t i = 1; i < 30; ++i) EXPECT_GT(places[i + 1], places[i]);
  // The strongest come last, over the others.
  EXPECT_EQ(shapes.rows[shapes.lines.back().row].id, 30u);
  // Filters change no colour, and a scale given from outside is kept to.
  PathOptions options;
  options.filter.within_db = 20.0;
  const Shapes strong = shown.shapes(options);
  EXPECT_TRUE(
      same(strong.lines.front().color, shapes.lines[shapes.lines.size() - strong.lines.size()].color));
  options.scale = apps::GainScale{-200.0, -100.0, false};
  EXPECT_TRUE(same(shown.shapes(options).lines.back().color, io::turbo(0.92)));
}

TEST(PathShapes, HaveTheColoursOfTheirKinds) {
  const Shown shown(all_kinds);
  PathOptions options;
  options.colors = PathColors::kind;
  const Shapes shapes = shown.shapes(options);
  for (const LineShape& line : shapes.lines)
    if (shapes.rows[line.row].id == 14) {
      EXPECT_TRUE(same(line.color, apps::color_of_kind(rf::InteractionType::diffraction)));
    }
  for (const char* part : {"line of sight (1)", "reflection (2)", "transmission (1)", "scattering (1)"})
    EXPECT_THAT(legend_of(shapes), HasSubstr(part));
}

TEST(PathShapes, SayWhatIsMissing) {
  Shown shown(all_kinds);
  const Shapes unplaced = path_shapes(shown.tables, shown.csi.spec, shown.csi.record, nullptr, {});
  EXPECT_TRUE(unplaced.empty());
  EXPECT_THAT(legend_of(unplaced), HasSubstr("poses"));
  Made other = shown.csi;
  other.record.tick = 3;
  EXPECT_THAT(legend_of(path_shapes(shown.tables, other.spec, other.record, &shown.at, {})),
              HasSubstr("of tick 3, placed by the poses of tick 0"));
  Made without = shown.csi;
  without.without("id");
  const Shapes unrecorded = path_shapes(shown.tables, without.spec, without.record, &shown.at, {});
  EXPECT_TRUE(unrecorded.empty());
  EXPECT_THAT(legend_of(unrecorded), HasSubstr("add 'paths' to its outputs"));
  Made bounded = shown.csi;
  bounded.add<uint64_t>("paths_left_out", {2, 2}, {7, 0, 100, 0});
  bounded.add<uint64_t>("sequences_left_out", {2, 2}, {0, 0, 3, 0});
  PathOptions first;
  first.filter.receiver = 0;
  const std::string legend =
      legend_of(path_shapes(shown.tables, bounded.spec, bounded.record, &shown.at, first));
  EXPECT_THAT(legend, HasSubstr("7 left out by max_paths"));
  EXPECT_THAT(legend, Not(HasSubstr("sequences")));
}

TEST(PathShapes, OfARecordWithoutPathsAreTheEndsAlone) {
  const Shown shown(std::vector<MadePath>{});
  const Shapes shapes = shown.shapes();
  EXPECT_TRUE(shapes.lines.empty());
  EXPECT_EQ(shapes.points.size(), 4u);
  EXPECT_THAT(legend_of(shapes), HasSubstr("csi: 0 of 0 paths"));
}

TEST(PathShapes, RefuseDamagedArrays) {
  const Shown shown(all_kinds);
  const auto refuse = [&](const Made& made, std::initializer_list<const char*> parts) {
    expect_user_error([&] { path_shapes(shown.tables, made.spec, made.record, &shown.at, {}); }, parts);
  };
  Made bad = shown.csi;
  for (const std::string name : {"rx", "tx", "delay", "doppler", "departure", "arrival", "transfer",
                                 "interaction", "vertex", "object", "object_material"}) {
    bad = shown.csi;
    bad.array(name).shape[0] = 5;  // rows that the bytes do not have, and the other arrays neither
    refuse(bad, {"csi: ", name.c_str()});
    bad = shown.csi;
    bad.array(name) = Array(DType::i8, bad.array(name).shape);
    refuse(bad, {"csi: ", name.c_str(), "|i1"});
  }
  bad = shown.csi;
  bad.array("id") = Array(DType::i64, {6});
  refuse(bad, {"csi: id", "<u8 [6]", "<i8 [6]"});
  bad = shown.csi;
  bad.array("interaction").as<uint8_t>()[3] = 9;
  refuse(bad, {"interaction", "0 to 4", "9 in row 1"});
  bad = shown.csi;
  bad.array("vertex").as<double>()[9] = std::numeric_limits<double>::quiet_NaN();
  refuse(bad, {"vertex", "row 1"});
  for (const char* name : {"rx", "tx"}) {
    bad = shown.csi;
    bad.array(name).as<int32_t>()[2] = 2;
    refuse(bad, {name, "2 in row 2"});
    bad.array(name).as<int32_t>()[2] = -1;
    refuse(bad, {name, "-1 in row 2"});
  }
  bad = shown.csi;
  bad.array("transfer").as<std::complex<float>>()[0] = {std::numeric_limits<float>::infinity(), 0.0f};
  refuse(bad, {"transfer", "row 0"});
  bad = shown.csi;
  bad.record.arrays.pop_back();
  refuse(bad, {"csi", "12 arrays, found 11"});
}

}  // namespace
}  // namespace greatx::view
