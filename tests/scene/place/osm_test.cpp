// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks files of OpenStreetMap: ways, multipolygons of split ways, parts, and what is wrong with them.
#include <osmium/io/any_input.hpp>
#include <osmium/io/any_output.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/place/source/rings.h"
#include "tests/scene/place/place_folder.h"

namespace greatx::scene::place {
namespace {

using test::area_of;
using test::find_feature;
using test::findings_of;
using test::message_of;
using test::PlaceFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// Writes OpenStreetMap XML. Nodes lie on a lattice of about 11 m: node 100 * row + column + 1.
class Osm {
 public:
  explicit Osm(double latitude = 48.0, double longitude = 10.0) : latitude_(latitude), longitude_(longitude) {
    for (int row = 0; row < 10; ++row)
      for (int column = 0; column < 10; ++column) node(100 * row + column + 1, column, row);
  }
  Osm& node(int64_t id, double column, double row, const std::string& tags = "") {
    double longitude = longitude_ + 1e-4 * column;
    if (longitude > 180.0) longitude -= 360.0;
    nodes_ += fmt::format("<node id=\"{}\" lat=\"{:.7f}\" lon=\"{:.7f}\" version=\"1\">{}</node>\n", id,
                          latitude_ + 1e-4 * row, longitude, tags);
    return *this;
  }
  Osm& way(int64_t id, const std::vector<int64_t>& nodes, const std::string& tags = "") {
    ways_ += fmt::format("<way id=\"{}\" version=\"1\">", id);
    for (const int64_t node : nodes) ways_ += fmt::format("<nd ref=\"{}\"/>", node);
    ways_ += tags + "</way>\n";
    return *this;
  }
  Osm& relation(int64_t id, const std::vector<std::pair<int64_t, std::string>>& members,
                const std::string& tags) {
    relations_ += fmt::format("<relation id=\"{}\" version=\"1\">", id);
    for (const auto& [way, role] : members)
      relations_ += fmt::format("<member type=\"way\" ref=\"{}\" role=\"{}\"/>", way, role);
    relations_ += tags + "</relation>\n";
    return *this;
  }
  std::string text() const {
    return "<?xml version=\"1.0\"?>\n<osm version=\"0.6\" generator=\"test\" license=\"ODbL test\">\n" +
           nodes_ + ways_ + relations_ + "</osm>\n";
  }
  PlaceInput read(const std::string& more = "") const {
    const PlaceFolder folder;
    folder.write("a,b.1.osm", text());
    return folder.read("maps: [{file: \"a,b.1.osm\", name: map}]\n" + more);
  }

 private:
  double latitude_, longitude_;
  std::string nodes_, ways_, relations_;
};

std::string tag(const std::string& key, const std::string& value) {
  return fmt::format("<tag k=\"{}\" v=\"{}\"/>", key, value);
}
const std::string building = tag("building", "yes");
const std::string multipolygon = tag("type", "multipolygon");

TEST(PlaceOsm, AreasLinesAndPoints) {
  const PlaceInput input =
      Osm()
          .node(5001, 4.5, 4.5, tag("natural", "tree"))
          .node(5002, 4.5, 4.6, tag("created_by", "x"))
          .way(1, {1, 3, 203, 201, 1}, building)
          .way(2, {1, 401, 805}, tag("highway", "residential"))
          .way(3, {501, 503, 703, 501}, tag("highway", "footway"))
          .way(4, {501, 503, 703, 501}, tag("highway", "pedestrian") + tag("area", "yes"))
          .way(5, {501, 503, 703, 501}, tag("barrier", "fence"))
          .way(6, {501, 503, 703, 501}, tag("natural", "tree_row"))
          .way(7, {501, 503, 703, 501}, tag("natural", "wood"))
          .way(8, {501, 503, 703, 501})
          .read();
  EXPECT_EQ(input.features.size(), 8u);
  ASSERT_TRUE(find_feature(input, "node/5001"));
  EXPECT_TRUE(find_feature(input, "node/5001")->point);
  EXPECT_FALSE(find_feature(input, "node/5002"));
  const Feature& house = *find_feature(input, "way/1");
  EXPECT_EQ(house.source, "map");
  EXPECT_EQ(*house.tag("building"), "yes");
  ASSERT_EQ(house.polygons.size(), 1u);
  EXPECT_EQ(house.polygons[0].outer.size(), 4u);  // the first corner is not repeated
  // 2e-4 degrees each way at 48 degrees north: the radii of curvature of WGS 84 there.
  EXPECT_NEAR(area_of(house.polygons[0].outer), 22.24 * 14.92, 0.2);
  EXPECT_EQ(find_feature(input, "way/2")->lines.at(0).size(), 3u);
  EXPECT_EQ(find_feature(input, "way/3")->lines.at(0).size(), 4u);
  EXPECT_EQ(find_feature(input, "way/4")->polygons.size(), 1u);
  EXPECT_EQ(find_feature(input, "way/5")->lines.size(), 1u);
  EXPECT_EQ(find_feature(input, "way/6")->lines.size(), 1u);
  EXPECT_EQ(find_feature(input, "way/7")->polygons.size(), 1u);
  EXPECT_TRUE(input.findings.empty());
  EXPECT_THAT(input.licences, ElementsAre("map: ODbL test"));
}

TEST(PlaceOsm, MultipolygonOfSplitWaysWithTwoCourtsAndTwoOutlines) {
  const PlaceInput input =
      Osm()
          .way(1, {1, 6, 506})  // outline in three pieces,
          .way(2, {1, 501})     // the second backwards
          .way(3, {501, 506})
          .way(4, {102, 103, 203})  // first court in two
          .way(5, {102, 202, 203})
          .way(6, {304, 305, 405, 404, 304}, tag("building", "kiosk"))  // second court
          .way(7, {8, 10, 210, 8})                                      // another outline
          .relation(
              9,
              {{1, "outer"}, {4, "inner"}, {2, "outer"}, {5, "inner"}, {3, ""}, {6, "inner"}, {7, "outer"}},
              multipolygon + building)
          .read();
  const Feature* house = find_feature(input, "relation/9");
  ASSERT_TRUE(house);
  ASSERT_EQ(house->polygons.size(), 2u);
  EXPECT_EQ(house->polygons[0].outer.size(), 4u);
  EXPECT_EQ(house->polygons[0].holes.size(), 2u);
  EXPECT_EQ(house->polygons[1].holes.size(), 0u);
  EXPECT_FALSE(house->tag("type"));
  EXPECT_TRUE(find_feature(input, "way/6"));  // a building in the court is its own
  EXPECT_EQ(input.features.size(), 2u);
  EXPECT_TRUE(input.findings.empty());
}

TEST(PlaceOsm, TagsOfOuterWaysAreThoseOfTheRelation) {
  const Osm old = Osm()
                      .way(1, {1, 5, 405, 401, 1}, building)
                      .way(2, {102, 103, 203, 102})
                      .relation(3, {{1, "outer"}, {2, "inner"}}, multipolygon);
  const PlaceInput input = old.read();
  ASSERT_EQ(input.features.size(), 1u);
  EXPECT_EQ(input.features[0].id, "relation/3");
  EXPECT_EQ(*input.features[0].tag("building"), "yes");
  const PlaceInput twice =
      Osm()
          .way(1, {1, 5, 405, 401, 1}, building)
          .way(2, {102, 103, 203, 102})
          .relation(3, {{1, "outer"}, {2, "inner"}}, multipolygon + tag("building", "school"))
          .read();
  ASSERT_EQ(twice.features.size(), 1u);
  EXPECT_EQ(*twice.features[0].tag("building"), "school");
  EXPECT_EQ(findings_of(twice, "outline_tagged_twice").size(), 1u);
}

TEST(PlaceOsm, PartsOfABuildingRelation) {
  const PlaceInput input = Osm()
                               .way(1, {1, 5, 405, 401, 1}, building)
                               .way(2, {1, 3, 203, 1}, tag("building:part", "yes") + tag("min_height", "5"))
                               .relation(3, {{1, "outline"}, {2, "part"}}, tag("type", "building"))
                               .read();
  EXPECT_EQ(find_feature(input, "way/2")->part_of, "way/1");
  EXPECT_EQ(find_feature(input, "way/1")->part_of, "");
  EXPECT_EQ(find_feature(input, "way/2")->polygons.size(), 1u);
}

TEST(PlaceOsm, APartWhoseBuildingIsNotInTheAreaIsABuilding) {
  const PlaceInput input = Osm()
                               .way(1, {505, 509, 909, 905, 505}, building)
                               .way(2, {1, 3, 203, 1}, tag("building:part", "roof"))
                               .relation(3, {{1, "outline"}, {2, "part"}}, tag("type", "building"))
                               .read("area: {bounds_deg: [47.9999, 9.9999, 48.0003, 10.0003]}\n");
  ASSERT_EQ(input.features.size(), 1u);
  EXPECT_EQ(input.features[0].part_of, "");
  EXPECT_EQ(*input.features[0].tag("building"), "roof");
  EXPECT_EQ(findings_of(input, "part_without_building").size(), 1u);
}

TEST(PlaceOsm, FaultsAreFindings) {
  const PlaceInput input =
      Osm()
          .way(1, {1, 3, 203, 201, 1}, building)
          .way(2, {5}, building)
          .way(3, {5, 6, 5}, building)
          .way(4, {5, 7, 207, 205}, building)  // open
          .way(5, {9}, tag("highway", "service"))
          .way(6, {1, 99999, 3, 203, 1}, building)  // a node is missing
          .way(7, {301, 302}, "")                   // of relation 12
          .way(8, {501, 509, 909, 901}, "")         // of relation 13
          .way(9, {601, 602, 702, 601}, "")
          .relation(10, {{777, "outer"}, {778, "inner"}}, multipolygon + building)
          .relation(11, {{9, "inner"}}, multipolygon + building)
          .relation(12, {{7, "outer"}, {779, "outer"}}, multipolygon + tag("natural", "wood"))
          .relation(13, {{8, "outer"}}, multipolygon + tag("natural", "wood"))
          .relation(14, {{780, "outer"}}, tag("type", "route"))
          .read();
  const auto objects = [&](const char* topic) {
    std::vector<std::string> ids;
    for (const Finding& finding : findings_of(input, topic)) ids.push_back(finding.object);
    return ids;
  };
  EXPECT_THAT(objects("way_of_too_few_nodes"), ElementsAre("map: way/2", "map: way/3", "map: way/5"));
  EXPECT_THAT(objects("ring_not_closed"), ElementsAre("map: way/4", "map: relation/13"));
  EXPECT_THAT(objects("nodes_missing"), ElementsAre("map: way/6"));
  EXPECT_THAT(objects("relation_without_members"), ElementsAre("map: relation/10"));
  EXPECT_THAT(objects("members_missing"), ElementsAre("map: relation/12"));
  EXPECT_THAT(objects("ring_of_too_few_nodes"), ElementsAre("map: relation/12"));
  EXPECT_THAT(objects("relation_without_outline"), ElementsAre("map: relation/11", "map: relation/12"));
  EXPECT_EQ(find_feature(input, "way/4")->polygons[0].outer.size(), 4u);
  EXPECT_EQ(input.features.size(), 4u);
}

TEST(PlaceOsm, AnOpenRingWhoseGapIsMostOfItIsLeftOut) {
  const PlaceInput input = Osm()
                               .way(1, {1, 3, 203, 1}, building)
                               .way(2, {501, 102, 509}, tag("landuse", "forest"))  // the gap is 0.53 of it
                               .way(3, {501, 605, 509}, tag("landuse", "forest"))  // 0.94
                               .read();
  EXPECT_EQ(find_feature(input, "way/2")->polygons.size(), 1u);
  EXPECT_FALSE(find_feature(input, "way/3"));
  const auto open = findings_of(input, "ring_not_closed");
  ASSERT_EQ(open.size(), 2u);
  EXPECT_EQ(open[0].kind, Finding::Kind::repaired);
  EXPECT_EQ(open[1].kind, Finding::Kind::left_out);
}

/// Every form of file gives the same input.
TEST(PlaceOsm, PackedFilesAndPbfGiveTheSame) {
  Osm osm;
  osm.node(5001, 4.5, 4.5, tag("natural", "tree"))
      .way(1, {1, 3, 203, 201, 1}, building)
      .way(2, {1, 6, 506})
      .way(3, {506, 1});
  osm.relation(4, {{2, "outer"}, {3, "outer"}}, multipolygon + building);
  const PlaceFolder folder;
  const auto xml = folder.write("m.osm", osm.text());
  const PlaceInput plain = folder.read("maps: [{file: m.osm}]\n");
  ASSERT_EQ(plain.features.size(), 3u);
  for (const char* name : {"m.osm.pbf", "m.osm.gz", "m.osm.bz2", "n.pbf"}) {
    osmium::io::Reader reader(osmium::io::File(xml.string()));
    osmium::io::Writer writer(osmium::io::File(folder.path(name).string()), reader.header());
    while (osmium::memory::Buffer buffer = reader.read()) writer(std::move(buffer));
    writer.close();
    const PlaceInput packed = folder.read(fmt::format("maps: [{{file: {}}}]\n", name));
    ASSERT_EQ(packed.features.size(), 3u) << name;
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(packed.features[i].id, plain.features[i].id);
      EXPECT_EQ(packed.features[i].tags, plain.features[i].tags);
      ASSERT_EQ(packed.features[i].polygons.size(), plain.features[i].polygons.size());
      for (size_t k = 0; k < plain.features[i].polygons.size(); ++k)
        EXPECT_EQ(packed.features[i].polygons[k].outer, plain.features[i].polygons[k].outer);
    }
  }
}

TEST(PlaceOsm, RingsThatTouchStayApart) {
  const auto rings =
      join_ways(std::vector<NodeIds>{{1, 2, 3}, {3, 1}, {3, 4}, {4, 5, 3}, {7, 8, 9}, {9, 10}});
  ASSERT_EQ(rings.closed.size(), 2u);
  EXPECT_THAT(rings.closed[0], ElementsAre(1, 2, 3));
  EXPECT_EQ(rings.closed[1].size(), 3u);
  ASSERT_EQ(rings.open.size(), 1u);
  EXPECT_EQ(rings.open[0].size(), 4u);
  // A chain that meets itself in the middle gives its loop.
  const auto loop = join_ways(std::vector<NodeIds>{{1, 2}, {2, 3}, {3, 4, 2}});
  ASSERT_EQ(loop.closed.size(), 1u);
  EXPECT_THAT(loop.closed[0], ElementsAre(2, 3, 4));
  EXPECT_THAT(loop.open, ElementsAre(testing::UnorderedElementsAre(1, 2)));
}

TEST(PlaceOsm, WaysThatCarryTheirPlaces) {
  const PlaceFolder folder;
  folder.write("m.osm", R"(<osm version="0.6"><note>Overpass, out geom</note>
<way id="1"><bounds minlat="48" minlon="10" maxlat="48.001" maxlon="10.001"/>
<nd ref="1" lat="48" lon="10"/><nd ref="2" lat="48" lon="10.001"/><nd ref="3" lat="48.001" lon="10.001"/>
<nd ref="1" lat="48" lon="10"/><tag k="building" v="yes"/></way></osm>)");
  const PlaceInput input = folder.read("maps: [{file: m.osm}]\n");
  ASSERT_EQ(input.features.size(), 1u);
  EXPECT_NEAR(area_of(input.features[0].polygons.at(0).outer), 111.2 * 74.6 / 2.0, 10.0);
  EXPECT_TRUE(input.findings.empty());
}

TEST(PlaceOsm, CutsToTheAreaAndKeepsBuildingsWhole) {
  Osm osm;
  osm.way(1, {1, 3, 203, 201, 1}, building)
      .way(2, {305, 307, 507, 505, 305}, building)
      .way(3, {807, 809, 909, 807}, building);
  // The area ends in the middle of way/2.
  const PlaceInput input = osm.read("area: {bounds_deg: [48.0, 10.0, 48.0004, 10.0005]}\n");
  EXPECT_TRUE(find_feature(input, "way/1"));
  ASSERT_TRUE(find_feature(input, "way/2"));
  EXPECT_NEAR(area_of(find_feature(input, "way/2")->polygons[0].outer), 22.24 * 14.92, 0.2);
  EXPECT_FALSE(find_feature(input, "way/3"));
  EXPECT_TRUE(input.findings.empty());
  EXPECT_NEAR(input.reference.origin.latitude_deg, 48.0002, 1e-12);
  EXPECT_NEAR(input.reference.origin.longitude_deg, 10.00025, 5.1e-6);
}

TEST(PlaceOsm, AcrossTheAntimeridianAndInTheSouth) {
  const Osm osm = Osm(-16.5, 179.9996).way(1, {1, 9, 309, 301, 1}, building);
  for (const char* area : {"area: {bounds_deg: [-16.51, 179.99, -16.49, -179.99]}\n", ""}) {
    const PlaceInput input = osm.read(area);
    const Feature* house = find_feature(input, "way/1");
    ASSERT_TRUE(house);
    // 8e-4 degrees of longitude at 16.5 degrees south, 3e-4 degrees of latitude.
    EXPECT_NEAR(area_of(house->polygons[0].outer), 85.40 * 33.19, 5.0) << area;
    EXPECT_LT(glm::length(house->polygons[0].outer[0]), 200.0);
  }
}

TEST(PlaceOsm, NothingInTheAreaNamesTheExtents) {
  const Osm osm = Osm().way(1, {1, 3, 203, 1}, building);
  EXPECT_THAT(message_of([&] { osm.read("area: {bounds_deg: [50.0, 10.0, 50.01, 10.01]}\n"); }),
              AllOf(HasSubstr("none of 1 objects"), HasSubstr("latitude 50.00000 to 50.01000"),
                    HasSubstr("map covers latitude 48.00000 to 48.00090, longitude 10.00000 to 10.00090")));
  EXPECT_THAT(message_of([&] { osm.read("area: {bounds_deg: [10.0, 48.0, 10.01, 48.01]}\n"); }),
              AllOf(HasSubstr("swapped"), HasSubstr("a,b.1.osm")));
  const PlaceFolder folder;
  folder.write("m.osm", "<osm version=\"0.6\"><node id=\"7\" lat=\"122.4\" lon=\"37.8\"/></osm>");
  EXPECT_THAT(message_of([&] { folder.read("maps: [{file: m.osm}]\n"); }),
              AllOf(HasSubstr("node 7"), HasSubstr("swapped")));
}

TEST(PlaceOsm, DamagedFilesAreErrors) {
  const PlaceFolder folder;
  for (const char* text :
       {"", "<osm", "<html/>", "<osm version=\"0.6\"><node id=\"1\" lat=\"x\" lon=\"1\"/></osm>",
        "<osm version=\"0.5\"></osm>", "<osm version=\"0.6\"><node id=\"z\"/></osm>"}) {
    folder.write("m.osm", text);
    EXPECT_THAT(message_of([&] { folder.read("maps: [{file: m.osm}]\n"); }), HasSubstr("m.osm")) << text;
  }
  folder.write("m.osm.pbf", "no pbf at all, but a text");
  EXPECT_THAT(message_of([&] { folder.read("maps: [{file: m.osm.pbf}]\n"); }), HasSubstr("m.osm.pbf"));
  folder.write("e.osm", "<osm version=\"0.6\"></osm>");
  EXPECT_THAT(message_of([&] { folder.read("maps: [{file: e.osm}]\n"); }),
              HasSubstr("no source has an object"));
  folder.write("m.osm", Osm().text());
  EXPECT_THAT(message_of([&] { folder.read("maps: [{file: m.osm, crs: \"EPSG:25832\"}]\n"); }),
              HasSubstr("crs"));
}

}  // namespace
}  // namespace greatx::scene::place
