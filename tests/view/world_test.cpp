// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the shapes that come from the experiment, and that a radio map of the viewer is that of `greatx map`.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <set>
#include <thread>

#include "core/units.h"
#include "io/formats/npy.h"
#include "sim/channel/channel_snapshot.h"
#include "sim/world/moment.h"
#include "tests/apps/program.h"
#include "tests/sim/radio_run.h"
#include "tests/view/overlay_support.h"
#include "view/world/course_shapes.h"
#include "view/world/map_job.h"
#include "view/world/map_paint.h"
#include "view/world/radio_facts.h"
#include "view/world/radio_shapes.h"

namespace greatx::view {
namespace {

using sim::testing::experiment_in;
using sim::testing::radio_material;
using test::TinyScene;
using ::testing::HasSubstr;
using testing::legend_of;
using testing::same;

const std::string two_masts =
    "greatx: 1\nname: test\nseed: 5\nticks: 11\ntick_rate_hz: 10\neffects: {diffraction: on}\nnodes:\n"
    "  - name: mast\n    trajectory: {type: static, position_m: [80, 1, 15]}\n"
    "    sensors: [{name: panel, type: antenna}]\n"
    "  - name: uav\n    trajectory: {type: waypoints, interpolation: linear, points: [{t_s: 0, position_m: "
    "[120, -2, 16]}, {t_s: 1, position_m: [130, -2, 16]}]}\n"
    "    sensors: [{name: antenna, type: antenna}]\n"
    "channels:\n  - {name: csi, tx: mast/panel, rx: [uav/antenna], rate_hz: 10, subcarriers: 4, "
    "bandwidth_hz: 20e6, carrier_hz: 3.5e9, max_depth: 2, outputs: [paths]}\n";

/// A ground and a house of concrete walls, about (100, 0).
scene::Scene yard() {
  TinyScene tiny;
  const uint32_t ground = tiny.material_as(radio_material("medium_dry_ground")),
                 wall = tiny.material_as(radio_material("concrete", 0.2));
  tiny.object("ground", 0, ground).quad({60, -40, 0}, {140, -40, 0}, {140, 40, 0}, {60, 40, 0});
  tiny.object("house", 0, wall).box({95, -5, 0}, {105, 5, 9});
  scene::Scene scene = tiny.build({100, 0, 0});
  scene.instances[0].semantic_class = scene::SemanticClass::ground;
  scene.instances[1].semantic_class = scene::SemanticClass::building;
  return scene;
}

std::shared_ptr<const sim::Experiment> shared_yard() {
  static const auto experiment = std::make_shared<const sim::Experiment>(experiment_in(two_masts, yard()));
  return experiment;
}

std::vector<Pose> rest(const sim::Experiment& experiment) {
  return std::vector<Pose>(experiment.scene().bodies.size());
}

TEST(FacetOutlines, LeaveOutTheDiagonalsOfQuads) {
  const FacetOutlines outlines(shared_yard()->scene());
  ASSERT_EQ(shared_yard()->scene().facets.size(), 7u);
  for (uint32_t facet = 0; facet < 7; ++facet) EXPECT_EQ(outlines.of(facet).size(), 4u) << facet;
}

TEST(RadioShapes, AreFacetsAndWedgesWithTheirMaterials) {
  const RadioFacts facts(shared_yard(), 0);
  const FacetOutlines outlines(facts.scene());
  const Shapes shapes = radio_shapes(facts, outlines, rest(facts.experiment()), {100, 0, 0}, {});
  // Seven facets of four edges. The house has four edges upwards and four around its roof; its foot, which
  // stands on the ground, is none.
  EXPECT_EQ(shapes.lines.size(), 7u * 4u + 8u);
  std::string rows;
  for (const ShapeRow& row : shapes.rows) rows += row.text + "\n";
  EXPECT_THAT(rows, HasSubstr("ground\nopaque, 2 triangles\nat 3.5 GHz: medium_dry_ground\n  er 13.23, "));
  EXPECT_THAT(rows, HasSubstr("house\nwall that lets waves pass, 2 triangles"));
  EXPECT_THAT(rows, HasSubstr("0.2 m thick"));
  EXPECT_THAT(rows, HasSubstr(": 9.000 m, exterior angle 270.0 deg (n = 1.500)"));
  EXPECT_THAT(legend_of(shapes), HasSubstr("facets: all 7"));
  EXPECT_THAT(legend_of(shapes), HasSubstr("opaque (1)"));
  EXPECT_THAT(legend_of(shapes), HasSubstr("wall that lets waves pass (6)"));
  for (const LineShape& line : shapes.lines) EXPECT_NEAR(line.a.x, 100.0, 40.0) << "in the world";
}

TEST(RadioShapes, TakeTheNearestAndSayHowManyThereAre) {
  const RadioFacts facts(shared_yard(), 0);
  const FacetOutlines outlines(facts.scene());
  RadioShapeOptions options;
  options.most_facets = 2;
  options.most_wedges = 1;
  const Shapes east = radio_shapes(facts, outlines, rest(facts.experiment()), {106, 0, 5}, options);
  ASSERT_EQ(east.lines.size(), 2u * 4u + 1u);
  EXPECT_THAT(legend_of(east), HasSubstr("facets: the nearest 2 of 7"));
  EXPECT_THAT(legend_of(east), HasSubstr("wedges: the nearest 1 of 8"));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(east.lines[static_cast<size_t>(i)].a.x, 105.0) << "the eastern wall";
  options.within_m = 2.0;
  options.wedges = false;
  EXPECT_EQ(radio_shapes(facts, outlines, rest(facts.experiment()), {106, 0, 5}, options).lines.size(), 4u);
}

/// What the wall returns by the room of surfaces, and by the story.
TEST(PathStory, LearnsAnglesAndLossesFromTheScene) {
  const RadioFacts facts(shared_yard(), 0);
  PathStory story;
  story.start = {110, -4, 5};
  story.end = {110, 4, 5};
  PathStop stop;
  stop.type = rf::InteractionType::reflection;
  stop.at = {105, 0, 5};
  for (uint32_t facet = 0; facet < facts.scene().facets.size(); ++facet)
    if (facts.scene().facets[facet].normal.x > 0.9) stop.facet = facet;
  story.stops.push_back(stop);
  explain(story, facts, rest(facts.experiment()));
  const PathStop& told = story.stops[0];
  const double angle = std::atan2(4.0, 5.0);
  ASSERT_TRUE(told.angle && told.loss_db);
  EXPECT_NEAR(*told.angle, angle, 1e-12);
  const rf::ReflectionCoefficients r =
      facts.model().surfaces.reflect(facts.scene().facets[*stop.facet].material, true, std::cos(angle));
  // The wall is finite, and its share of the Fresnel zones is a part of the loss. Its edges diffract.
  const rf::ReflectionSight sight{facts.scene().to_local(stop.at), glm::normalize(stop.at - story.start),
                                  glm::normalize(story.end - stop.at), std::sqrt(41.0), std::sqrt(41.0)};
  ASSERT_TRUE(facts.model().reflectors);
  const rf::Complex weight = facts.model().reflectors->weight(
      facts.model().facets, *stop.facet, sight, 2.0 * pi / facts.model().surfaces.wavelength_m(), true);
  EXPECT_NE(std::abs(weight), 1.0);
  EXPECT_NEAR(*told.loss_db, -decibels(0.5 * (std::norm(r.r_te) + std::norm(r.r_tm)) * std::norm(weight)),
              1e-9);
  // Through the wall at the same angle, and at an edge that rises beside the way.
  story.stops[0].type = rf::InteractionType::transmission;
  explain(story, facts, rest(facts.experiment()));
  EXPECT_GT(*story.stops[0].loss_db, 1.0);
  story.stops[0].type = rf::InteractionType::diffraction;
  story.stops[0].loss_db.reset();
  for (uint32_t wedge = 0; wedge < facts.model().wedges.size(); ++wedge)
    if (std::abs(facts.model().wedges[wedge].a.z - facts.model().wedges[wedge].b.z) > 1.0)
      story.stops[0].element = wedge;
  explain(story, facts, rest(facts.experiment()));
  EXPECT_NEAR(*story.stops[0].angle, 0.5 * pi, 1e-12);
  EXPECT_FALSE(story.stops[0].loss_db);
  EXPECT_THAT(story.stops[0].more, HasSubstr("edge of two faces, exterior 270 deg"));
  // A facet that the scene does not have changes nothing.
  story.stops[0] = stop;
  story.stops[0].facet = 99;
  explain(story, facts, rest(facts.experiment()));
  EXPECT_FALSE(story.stops[0].angle);
}

TEST(PathStory, OfOneReflectionLosesWhatTheSurfaceTakes) {
  const test::KeptRun run = test::keep_run(*shared_yard());
  const RecordTables tables("{}", run.sensors, "run");
  const auto record = [&](const char* sensor) -> const Record& {
    for (const Record& found : run.packets.at(0).records)
      if (run.sensors[found.sensor].name == sensor) return found;
    throw std::runtime_error(sensor);
  };
  const NodePoses poses(tables, record("poses"));
  const RadioFacts facts(shared_yard(), 0);
  const std::span<const uint64_t> ids = run.array<uint64_t>(0, "csi", "id");
  size_t reflections = 0;
  for (const uint64_t id : ids) {
    std::optional<PathStory> story = path_story(tables, run.spec("csi"), record("csi"), poses, id);
    ASSERT_TRUE(story);
    if (story->chain != "R") continue;
    ++reflections;
    const double by_points = *story->stops[0].angle;
    explain(*story, facts, rest(*shared_yard()));
    EXPECT_NEAR(*story->stops[0].angle, by_points, 1e-9) << "the normal's angle is half of the turn";
    EXPECT_NEAR(story->free_space_db - story->gain_db, *story->stops[0].loss_db, 1e-4);
  }
  EXPECT_GE(reflections, 1u);
}

TEST(CourseShapes, AreBrightBehindAndFaintAhead) {
  const SampledCourses courses = sample_courses(*shared_yard(), 0, 11);
  ASSERT_EQ(courses.nodes.size(), 1u) << "the mast rests";
  EXPECT_EQ(courses.nodes[0].name, "uav");
  for (size_t i = 0; i < 11; ++i)
    EXPECT_NEAR(courses.nodes[0].positions[i].x, 120.0 + static_cast<double>(i), 1e-9);
  const Shapes shapes = course_shapes(courses, 0.35);
  ASSERT_EQ(shapes.lines.size(), 11u) << "ten pieces, one of which is cut at the present";
  EXPECT_NEAR(shapes.lines[3].b.x, 123.5, 1e-9);
  EXPECT_FALSE(same(shapes.lines[3].color, shapes.lines[4].color));
  EXPECT_GT(shapes.lines[3].width_px, shapes.lines[4].width_px);
  EXPECT_THAT(shapes.rows[0].text, HasSubstr("the way of uav\n10.0 m in 1.00 s"));
  EXPECT_EQ(sample_courses(*shared_yard(), 0, 11, 0).left_out, 1u);
}

/// Waits for a job and returns its map.
std::shared_ptr<const ShownMap> finished(const MapJob& job) {
  while (!job.finished()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return job.map();
}

MapWish yard_wish(double cell_m) {
  MapWish wish;
  wish.request.cell_m = cell_m;
  return wish;
}

/// A picture from straight above (100, 0): a pixel for each quarter of a metre; the house is 9 m high.
ScenePicture picture_from_above() {
  ScenePicture picture;
  apps::PictureView& view = picture.request.view;
  view.width = view.height = 128;
  view.cx = view.cy = 64;
  view.fx = view.fy = 128;
  // x forward is down, y left is north.
  view.local_from_sensor = {{0, 0, 32}, orientation_from_yaw_pitch_roll(0.0, 0.5 * pi, 0.0)};
  for (uint32_t y = 0; y < view.height; ++y)
    for (uint32_t x = 0; x < view.width; ++x) {
      const double roof = 23.0 / 128.0;  // metres for each pixel at the roof's depth
      const bool house = std::abs((x + 0.5 - 64.0) * roof) < 5.0 && std::abs((y + 0.5 - 64.0) * roof) < 5.0;
      picture.depth.push_back(house ? 23.0f : 32.0f);
      picture.instance.push_back(1);
      picture.material.push_back(1);
      picture.rgb.insert(picture.rgb.end(), {10, 20, 30});
    }
  return picture;
}

TEST(MapPaint, ColoursTheGroundAndNothingThatStandsOnIt) {
  const MapJob job(shared_yard(), yard_wish(4.0), {});
  const std::shared_ptr<const ShownMap> map = finished(job);
  ASSERT_EQ(job.error(), "");
  ASSERT_TRUE(map != nullptr && map->complete());
  MapColors colors;
  colors.opacity = 1.0;
  const MapLayerPaint paint(map, colors, shared_yard()->scene().origin);
  EXPECT_EQ(paint.layer().unit, "dB");
  const ScenePicture picture = picture_from_above();
  EXPECT_FALSE(paint.cell_at(picture, 64, 64)) << "the roof";
  const std::optional<size_t> corner = paint.cell_at(picture, 2, 2);
  ASSERT_TRUE(corner);
  // Row 2 of pixels is 15.4 m along the view's upper side, which is +x of the world; column 2 is +y.
  const dvec3 at = map->cells.point(*corner);
  EXPECT_LE(std::abs(at.x - (100.0 + 15.375)), 2.0);
  EXPECT_LE(std::abs(at.y - 15.375), 2.0);
  const std::vector<uint8_t> painted = paint.painted(picture);
  const io::Color color = paint.color_at(paint.layer().values[*corner]);
  const size_t pixel = 3 * (2 * 128 + 2), roof = 3 * (64 * 128 + 64);
  EXPECT_TRUE(same({painted[pixel], painted[pixel + 1], painted[pixel + 2]}, color));
  EXPECT_EQ(painted[roof + 2], 30) << "the roof keeps its colour";
  EXPECT_THAT(paint.text_of(*corner), HasSubstr(" dB\ncell at ("));
}

TEST(MapPaint, OfAPlaneLiesInThePlane) {
  MapWish wish = yard_wish(4.0);
  wish.request.height.plane_z_m = 12.0;
  const MapJob job(shared_yard(), wish, {});
  const std::shared_ptr<const ShownMap> map = finished(job);
  ASSERT_EQ(job.error(), "");
  const MapLayerPaint paint(map, {}, shared_yard()->scene().origin);
  const std::optional<size_t> over_roof = paint.cell_at(picture_from_above(), 64, 64);
  ASSERT_TRUE(over_roof);
  EXPECT_EQ(map->cells.point(*over_roof).z, 12.0);
}

TEST(MapJob, ReportsFaultsAndCanBeCancelled) {
  MapWish wish = yard_wish(-1.0);
  const MapJob bad(shared_yard(), wish, {});
  finished(bad);
  EXPECT_THAT(bad.error(), HasSubstr("--cell"));
  MapJob large(shared_yard(), yard_wish(0.1), {});
  large.cancel();
  finished(large);
  EXPECT_EQ(large.error(), "");
  EXPECT_FALSE(large.map() != nullptr && large.map()->complete());
}

class MapOfTheProgram : public ::testing::Test {
 protected:
  /// Values of a file of `greatx map`.
  std::vector<double> values(const std::string& name) const {
    const std::string bytes = apps::test::read_file(folder_.path() / "map" / name);
    const size_t header = 10 + static_cast<uint8_t>(bytes[8]) + 256u * static_cast<uint8_t>(bytes[9]);
    std::vector<double> all((bytes.size() - header) / sizeof(double));
    std::memcpy(all.data(), bytes.data() + header, all.size() * sizeof(double));
    return all;
  }
  greatx::test::TemporaryFolder folder_;
};

TEST_F(MapOfTheProgram, HasTheBytesOfTheViewers) {
  const std::filesystem::path file = folder_.path() / "yard.yaml";
  std::string yaml = two_masts;
  yaml.insert(yaml.find("nodes:"), "scene: {generate: {kind: room}}\n");
  yaml.replace(yaml.find("[80, 1, 15]"), 11, "[-2, 1, 2]");
  yaml.replace(yaml.find("[120, -2, 16]"), 13, "[1, -1, 1.5]");
  yaml.replace(yaml.find("[130, -2, 16]"), 13, "[2, -1, 1.5]");
  std::ofstream(file) << yaml;
  const apps::test::Outcome run =
      apps::test::greatx(fmt::format("map {} -o {}/map --cell 0.7 --height 1.2 --tick 4 --no-pictures -q",
                                     file.string(), folder_.path().string()));
  ASSERT_EQ(run.code, 0) << run.err;
  const auto experiment =
      std::make_shared<const sim::Experiment>(sim::make_experiment(sim::load_scenario(file)));
  MapWish wish = yard_wish(0.7);
  wish.tick = 4;
  wish.request.height.above_m = 1.2;
  const MapJob job(experiment, wish, {});
  const std::shared_ptr<const ShownMap> map = finished(job);
  ASSERT_EQ(job.error(), "");
  ASSERT_TRUE(map->complete());
  for (const sim::MapQuantity* of_map : sim::map_quantities_of(sim::MapPrecoding::mean)) {
    const sim::MapQuantity& quantity = *of_map;
    if (quantity.dtype != DType::f64) continue;
    const Array array = sim::map_array(map->map(), quantity);
    const std::vector<double> theirs = values(quantity.name + ".npy");
    const auto ours = array.as<double>();
    ASSERT_EQ(theirs.size(), ours.size()) << quantity.name;
    EXPECT_EQ(std::memcmp(theirs.data(), ours.data(), ours.size_bytes()), 0) << quantity.name;
  }
}

}  // namespace
}  // namespace greatx::view
