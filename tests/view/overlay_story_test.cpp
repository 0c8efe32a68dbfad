// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the story of a path and its Fresnel zone, and what is drawn over the pictures of cameras.
#include <algorithm>
#include <cmath>

#include "tests/view/made_csi.h"
#include "view/overlay/path_story.h"
#include "view/overlay/picture_shapes.h"
#include "view/overlay/tube_shapes.h"

namespace greatx::view {
namespace {

using testing::expect_user_error;
using ::testing::HasSubstr;
using testing::legend_of;
using testing::Made;
using testing::MadePath;
using testing::same;
using testing::Shown;

std::optional<PathStory> story_of(const Shown& shown, uint64_t row_id) {
  return path_story(shown.tables, shown.csi.spec, shown.csi.record, shown.at, row_id);
}

TEST(PathStory, TellsEachInteractionInOrder) {
  const Shown shown({{0, 0, 7, -60.0, {}}, {0, 0, 42, -80.0, {1, 3}}});
  const std::optional<PathStory> story = story_of(shown, 42);
  ASSERT_TRUE(story);
  EXPECT_EQ(story->chain, "RD");
  EXPECT_EQ(story->from, "mast/left");
  EXPECT_EQ(story->to, "uav/antenna");
  ASSERT_EQ(story->stops.size(), 2u);
  EXPECT_EQ(story->stops[0].object, "ground");
  EXPECT_EQ(story->stops[1].material, "itu_glass");
  // From (-1, 0, 11) over (1, 0, 5) and (1, 1, 5) to (40, 0.5, 21).
  EXPECT_NEAR(story->stops[0].leg_m, std::sqrt(4.0 + 36.0), 1e-12);
  EXPECT_NEAR(story->stops[1].leg_m, 1.0, 1e-12);
  EXPECT_NEAR(story->last_leg_m, std::sqrt(39.0 * 39.0 + 0.25 + 256.0), 1e-9);
  // Half of the right angle by which the path turns; of an edge, points alone do not tell it.
  ASSERT_TRUE(story->stops[0].angle);
  EXPECT_NEAR(*story->stops[0].angle, 0.25 * pi, 1e-12);
  EXPECT_FALSE(story->stops[1].angle);
  EXPECT_FALSE(story->stops[0].loss_db);
  EXPECT_NEAR(story->gain_db, -80.0, 1e-4);
  EXPECT_NEAR(story->free_space_db, 20.0 * std::log10(story->wavelength_m / (4.0 * pi * story->length_m)),
              1e-12);
}

TEST(PathStory, IsToldInWords) {
  const Shown shown({{0, 0, 42, -80.0, {1, 3}}});
  const std::vector<std::string> words = words_of(*story_of(shown, 42));
  ASSERT_EQ(words.size(), 4u);
  EXPECT_EQ(words[0], "leaves mast/left at azimuth 45.0 deg, elevation 0.0 deg");
  EXPECT_EQ(words[1], "after 6.08 m is reflected at ground (itu_glass, 45.0 deg from the normal)");
  EXPECT_EQ(words[2], "after 1.00 m is diffracted at an edge of tower (itu_glass)");
  // 29.98 m of free space are 72.86 dB at 3.5 GHz.
  EXPECT_THAT(words[3],
              HasSubstr("reaches uav/antenna from azimuth -90.0 deg, elevation 30.0 deg: 29.98 m in "
                        "all (100.00 ns), -80.0 dB, which is 7.1 dB below free space"));
  EXPECT_THAT(words[3], HasSubstr("Doppler +25.5 Hz"));
}

TEST(PathStory, BelongsToOneLink) {
  const Shown shown({{0, 0, 5, -60.0, {}}, {1, 1, 5, -70.0, {}}});
  EXPECT_EQ(story_of(shown, 5)->to, "uav/antenna");
  EXPECT_EQ(story_of(shown, path_row_id(5, 3))->to, "point 0");
  EXPECT_FALSE(story_of(shown, 6));
  EXPECT_FALSE(story_of(shown, 0));
}

TEST(PathStory, NeedsPathsInTheRecord) {
  Shown shown({{0, 0, 5, -60.0, {}}});
  Made without = shown.csi;
  without.without("id");
  EXPECT_FALSE(path_story(shown.tables, without.spec, without.record, shown.at, 5));
  Made bad = shown.csi;
  bad.array("transfer") = Array(DType::i8, {1});
  expect_user_error([&] { path_story(shown.tables, bad.spec, bad.record, shown.at, 5); }, {"transfer"});
}

TEST(FresnelZone, HasTheRadiusOfTheClosedForm) {
  EXPECT_NEAR(fresnel_radius_m(0.1, 50.0, 50.0), std::sqrt(0.1 * 25.0), 1e-12);
  EXPECT_NEAR(fresnel_radius_m(0.1, 10.0, 90.0), std::sqrt(0.1 * 9.0), 1e-12);
  EXPECT_EQ(fresnel_radius_m(0.1, 0.0, 90.0), 0.0);
  EXPECT_EQ(fresnel_radius_m(0.1, 0.0, 0.0), 0.0);
}

/// The largest distance of the shapes' points from the straight line a to b.
double widest(const Shapes& shapes, const dvec3& a, const dvec3& b) {
  double most = 0.0;
  const dvec3 along = glm::normalize(b - a);
  for (const LineShape& line : shapes.lines)
    most = std::max(most, glm::length(glm::cross(line.a - a, along)));
  return most;
}

TEST(FresnelZone, GoesOnBeyondReflectionsAndEndsAtDiffractions) {
  PathStory story;
  story.wavelength_m = 0.1;
  story.start = {0, 0, 0};
  story.end = {100, 0, 0};
  // A stop in the middle of a straight way, so that all points have one axis.
  story.stops.push_back({});
  story.stops[0].at = {50, 0, 0};
  story.stops[0].type = rf::InteractionType::transmission;
  EXPECT_NEAR(widest(fresnel_shapes(story), story.start, story.end), fresnel_radius_m(0.1, 50, 50), 1e-9);
  story.stops[0].type = rf::InteractionType::diffraction;
  EXPECT_NEAR(widest(fresnel_shapes(story), story.start, story.end), fresnel_radius_m(0.1, 25, 25), 1e-9);
  // Both zones end in the edge.
  for (const LineShape& line : fresnel_shapes(story).lines)
    if (line.a.x == 50.0) {
      EXPECT_LT(glm::distance(line.a, story.stops[0].at), 1e-9);
    }
}

/// A camera with two boxes, of which the second one is hidden.
Made made_boxes() {
  Made made;
  made.spec.name = "uav/camera";
  made.spec.kind = "camera";
  made.spec.metadata_json =
      R"({"width": 64, "height": 48, "fx": 50, "fy": 50, "cx": 32, "cy": 24, "near_m": 0.1})";
  made.add<uint32_t>("box_instance", {2}, {2, 3}).add<uint8_t>("box_semantic", {2}, {0, 1});
  made.add<float>("box_visibility", {2}, {0.75f, 0.0f}).add<float>("box_truncation", {2}, {0.5f, 0.0f});
  made.add<int32_t>("box_modal", {2, 4}, {3, 4, 20, 30, 0, 0, 0, 0});
  made.add<float>("box_amodal", {2, 4}, {2.5f, 4.0f, 25.0f, 30.0f, 7.0f, 8.0f, 9.0f, 12.0f});
  return made;
}

RecordTables tables_of(const SensorSpec& spec) {
  return RecordTables(R"({"instances": [{"name": "ground"}, {"name": "van"}, {"name": "cone"}],
                          "semantic_classes": ["unlabeled", "vehicle"]})",
                      std::vector{spec}, "test");
}

TEST(PictureBoxes, AreTheRectanglesOfTheRecord) {
  const Made made = made_boxes();
  const RecordTables tables = tables_of(made.spec);
  const Shapes visible = picture_box_shapes(tables, made.spec, made.record, BoxRectangle::visible);
  ASSERT_EQ(visible.picture.size(), 1u) << "what nothing shows has no rectangle";
  EXPECT_EQ(visible.picture_width, 64.0);
  EXPECT_EQ(visible.picture[0].low, dvec2(3, 4));
  EXPECT_EQ(visible.picture[0].high, dvec2(20, 30));
  EXPECT_THAT(visible.rows[visible.picture[0].row].text, HasSubstr("van (unlabeled)\n17 x 26 pixels"));
  EXPECT_THAT(visible.rows[visible.picture[0].row].text, HasSubstr("75 % visible, 50 % cut off"));
  EXPECT_THAT(legend_of(visible), HasSubstr("1 boxes of 2"));
  const Shapes whole = picture_box_shapes(tables, made.spec, made.record, BoxRectangle::whole);
  ASSERT_EQ(whole.picture.size(), 2u);
  EXPECT_EQ(whole.picture[1].low, dvec2(7, 8));
}

TEST(PictureBoxes, SayWhatIsMissingAndRefuseDamage) {
  Made made = made_boxes();
  const RecordTables tables = tables_of(made.spec);
  Made without = made;
  without.without("box_instance");
  const Shapes none = picture_box_shapes(tables, without.spec, without.record, BoxRectangle::visible);
  EXPECT_TRUE(none.empty());
  EXPECT_THAT(legend_of(none), HasSubstr("add 'boxes' to its outputs"));
  made.array("box_modal").shape[0] = 1;
  expect_user_error([&] { picture_box_shapes(tables, made.spec, made.record, BoxRectangle::visible); },
                    {"box_modal"});
}

Made made_events() {
  Made made;
  made.spec.name = "uav/dvs";
  made.spec.kind = "event_camera";
  made.spec.metadata_json =
      R"({"width": 8, "height": 6, "fx": 5, "fy": 5, "cx": 4, "cy": 3, "camera": "uav/camera"})";
  made.record.time_ns = 1'000'000;
  made.add<int64_t>("t", {4}, {100, 200, 999'000, 1'000'000});
  made.add<uint16_t>("x", {4}, {1, 7, 1, 2}).add<uint16_t>("y", {4}, {2, 5, 2, 0});
  made.add<uint8_t>("p", {4}, {1, 1, 0, 1});
  return made;
}

TEST(EventShapes, AreTheNewestOfEachPixel) {
  const Made made = made_events();
  const RecordTables tables = tables_of(made.spec);
  const Shapes all = event_shapes(tables, made.spec, made.record, {});
  ASSERT_EQ(all.picture.size(), 3u) << "pixel (1, 2) fired twice";
  EXPECT_EQ(all.picture[0].low, dvec2(2, 0));
  EXPECT_EQ(all.picture[1].low, dvec2(1, 2));
  EXPECT_EQ(all.picture[1].high, dvec2(2, 3));
  EXPECT_FALSE(same(all.picture[0].color, all.picture[1].color)) << "brighter and darker";
  EXPECT_TRUE(same(all.picture[0].color, all.picture[2].color));
  EXPECT_THAT(legend_of(all), HasSubstr("3 pixels fired, 4 events"));
  EventOptions last;
  last.window_s = 1e-5;
  EXPECT_EQ(event_shapes(tables, made.spec, made.record, last).picture.size(), 2u);
  last = {};
  last.most = 1;
  const Shapes one = event_shapes(tables, made.spec, made.record, last);
  EXPECT_EQ(one.picture.size(), 1u);
  EXPECT_THAT(legend_of(one), HasSubstr("the newest 1 of 3 pixels"));
}

TEST(EventShapes, RefusePixelsThatTheCameraDoesNotHave) {
  Made made = made_events();
  made.array("x").as<uint16_t>()[3] = 8;
  const RecordTables tables = tables_of(made.spec);
  expect_user_error([&] { event_shapes(tables, made.spec, made.record, {}); }, {"pixels of 8 x 6", "(8, 0)"});
}

TEST(Shapes, KeepTheirPicturesWhenTheyAreJoined) {
  const Made made = made_events();
  const RecordTables tables = tables_of(made.spec);
  Shapes joined;
  joined.add_row("first");
  joined.append(event_shapes(tables, made.spec, made.record, {}));
  EXPECT_EQ(joined.picture_width, 8.0);
  EXPECT_EQ(joined.picture.size(), 3u);
}

}  // namespace
}  // namespace greatx::view
