// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that a plate behind a thin pane or a crown of foliage is seen through it, weaker by what the models
// of both take twice.
#include <gtest/gtest.h>

#include "rf/atmosphere/foliage.h"
#include "rf/radar/echoes/veils.h"
#include "scene/material/material.h"
#include "tests/rf/radar_reflectors.h"

namespace greatx::rf {
namespace {

using namespace rf::testing;

constexpr double plate_m = 40.0;

/// Adds a plate of 0.1 m that faces the radar at the origin.
void add_plate(TinyScene& tiny) {
  const double h = 0.5 * a;
  tiny.object("plate").quad({plate_m, h, -h}, {plate_m, -h, -h}, {plate_m, -h, h}, {plate_m, h, h});
}

/// Adds a crown with the material after the default one, a volume().
void add_crown(TinyScene& tiny, const scene::Foliage& foliage, const dvec3& low, const dvec3& high) {
  scene::Material leaves;
  leaves.name = "leaves";
  leaves.radio.emplace().foliage = foliage;
  tiny.object("crown", 0, tiny.material_as(leaves)).box(low, high);
}

RadioSurface volume() {
  RadioSurface surface;
  surface.foliage = true;
  return surface;
}

/// Returns the echo of the plate, and the number of echoes of everything.
struct Seen {
  double section_db = -300.0;
  size_t echoes = 0;
};
Seen seen(const TinyScene& tiny, std::vector<RadioSurface> surfaces, bool transmission) {
  EchoScene scene(tiny, std::move(surfaces));
  EchoOptions options;
  options.merge_share = 0.0;
  options.transmission = transmission;
  const EchoList list = scene.find(options, Pose{});
  EchoList plate;
  for (const Echo& echo : list.echoes)
    if (echo.point.x > plate_m - 0.5) plate.echoes.push_back(echo);
  return {section_db(field_of(plate), plate_m, plate_m), list.echoes.size()};
}

class RadarVeils : public ::testing::Test {
 protected:
  RadarVeils() {
    TinyScene tiny;
    add_plate(tiny);
    open_db_ = seen(tiny, {}, true).section_db;
  }
  double open_db_;
};

TEST_F(RadarVeils, APaneTakesItsTransmissionTwice) {
  scene::RadioMaterial glass;
  glass.layers = {{*scene::itu_medium("glass"), 0.005}};
  for (const double turn : {0.0, 0.5}) {
    TinyScene tiny;
    const uint32_t pane = tiny.material("pane", 0.1f);
    const double c = std::cos(turn), s = std::sin(turn);
    tiny.object("pane", 0, pane).quad({20 - s, -c, -1}, {20 + s, c, -1}, {20 + s, c, 1}, {20 - s, -c, 1});
    add_plate(tiny);
    const std::vector<RadioSurface> surfaces{conductor(), radio_surface(glass, radar_carrier_hz, "glass")};
    const RadioSurfaces walls(surfaces, radar_carrier_hz);
    const SheetTransmission t = walls.transmit(1, true, c);
    // The radar is vertical, so that the field is across the plane of incidence of a pane turned about z.
    const double through = decibels(std::norm(0.5 * (t.te + t.tm)));
    EXPECT_NEAR(decibels(std::norm(t.te)), through, turn == 0.0 ? 1e-9 : 1.5);
    const Seen with = seen(tiny, surfaces, true), without = seen(tiny, surfaces, false);
    EXPECT_NEAR(with.section_db, open_db_ + 2.0 * through, 0.05) << turn;
    EXPECT_LT(without.section_db, open_db_ - 40.0) << turn;
    EXPECT_GT(without.echoes, 0u);  // the pane itself
  }
}

/// Windows in a wall that lets nothing else pass. With few windows too little passes: the wall is no veil.
TEST_F(RadarVeils, WindowsTakeTheirShareTwice) {
  scene::RadioMaterial wall;
  wall.layers = {{*scene::itu_medium("concrete"), 0.0}};
  for (const double share : {0.6, 0.1}) {
    wall.windows = scene::RadioWindows{share, {{*scene::itu_medium("glass"), 0.005}}};
    TinyScene tiny;
    const uint32_t facade = tiny.material("facade", 0.1f);
    tiny.object("facade", 0, facade).quad({20, -1, -1}, {20, 1, -1}, {20, 1, 1}, {20, -1, 1});
    add_plate(tiny);
    const std::vector<RadioSurface> surfaces{conductor(), radio_surface(wall, radar_carrier_hz, "facade")};
    scene::RadioMaterial glass;
    glass.layers = wall.windows->layers;
    const RadioSurfaces pane({radio_surface(glass, radar_carrier_hz, "glass")}, radar_carrier_hz);
    const double through = decibels(share * share * std::norm(pane.transmit(0, true, 1.0).te));
    const bool veil = through > decibels(Veils::least_share);
    EXPECT_EQ(veil, share > 0.5);
    const double section = seen(tiny, surfaces, true).section_db;
    if (veil)
      EXPECT_NEAR(section, open_db_ + 2.0 * through, 0.05);
    else
      EXPECT_LT(section, open_db_ - 40.0);
    EXPECT_LT(seen(tiny, surfaces, false).section_db, open_db_ - 40.0);
  }
}

TEST_F(RadarVeils, ACrownTakesItsDepthOutAndHome) {
  TinyScene tiny;
  add_crown(tiny, {}, {20, -2, -2}, {23, 2, 2});
  add_plate(tiny);
  const std::vector<RadioSurface> surfaces{conductor(), volume()};
  const double depth_db = foliage_db({}, radar_carrier_hz, 3.0);
  EXPECT_GT(depth_db, 4.0);
  EXPECT_NEAR(seen(tiny, surfaces, true).section_db, open_db_ - 2.0 * depth_db, 0.05);
  EXPECT_EQ(seen(tiny, surfaces, false).echoes, 0u);
}

TEST_F(RadarVeils, LeavesWithoutLossesAreNotThere) {
  for (const bool transmission : {true, false}) {
    TinyScene tiny;
    scene::Material leaves;
    leaves.name = "sprays";
    leaves.radio.emplace().foliage = scene::Foliage{.attenuation_db_per_m = 0.0};
    // Open sheets before, around and behind the plate; one of them is square to the radar.
    const uint32_t unseen = tiny.material_as(leaves);
    for (const double x : {12.0, 25.0, plate_m - 0.2, plate_m + 0.3})
      tiny.object("spray", 0, unseen).quad({x, -2, -2}, {x, -2, 2}, {x, 2, 2}, {x, 2, -2});
    add_plate(tiny);
    const Seen with = seen(tiny, {conductor(), volume()}, transmission);
    TinyScene bare;
    add_plate(bare);
    const Seen without = seen(bare, {conductor()}, transmission);
    EXPECT_EQ(with.section_db, without.section_db);
    EXPECT_EQ(with.echoes, without.echoes);
  }
}

TEST_F(RadarVeils, ThreadsChangeNoByte) {
  TinyScene tiny;
  add_crown(tiny, {}, {20, -3, -2}, {22, 3, 2});
  for (int i = 0; i < 300; ++i) {
    const double x = 30.0 + 0.1 * i, y = 0.03 * (i % 17) - 0.2, z = 0.05 * (i % 11) - 0.3;
    tiny.object("plate").quad({x, y + 0.04, z}, {x, y, z}, {x, y, z + 0.04}, {x, y + 0.04, z + 0.04});
  }
  EchoScene scene(tiny, {conductor(), volume()});
  std::vector<EchoList> lists;
  for (const uint32_t threads : {1u, 2u, 7u}) {
    EchoOptions options;
    options.transmission = options.edges = true;
    options.threads = threads;
    lists.push_back(scene.find(options, Pose{}));
  }
  ASSERT_GT(lists[0].echoes.size(), 50u);
  for (const EchoList& list : lists) {
    ASSERT_EQ(list.echoes.size(), lists[0].echoes.size());
    for (size_t i = 0; i < list.echoes.size(); ++i) {
      EXPECT_EQ(list.echoes[i].amplitude, lists[0].echoes[i].amplitude);
      EXPECT_EQ(list.echoes[i].point, lists[0].echoes[i].point);
    }
  }
}

TEST_F(RadarVeils, APlateHalfBehindACrownIsSeenOnceAndNotTwice) {
  TinyScene tiny;
  // A crown that takes nothing hides half of the plate: the sum is the whole plate.
  add_crown(tiny, {.attenuation_db_per_m = 0.0}, {20, 0, -2}, {23, 2, 2});
  add_plate(tiny);
  EXPECT_NEAR(seen(tiny, {conductor(), volume()}, true).section_db, open_db_, 0.1);
}

}  // namespace
}  // namespace greatx::rf
