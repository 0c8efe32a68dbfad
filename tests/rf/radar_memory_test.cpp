// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the searches of a radar that keeps what it has found of facets at rest against searches anew.
#include <cstring>

#include <gtest/gtest.h>

#include "rf/radar/echoes/beam_memory.h"
#include "tests/rf/radar_echo_scenes.h"

namespace greatx::rf {
namespace {

using test::TinyScene;
using testing::EchoScene;
using testing::looking;

/// A wall of small plates, a few of which face the radar over a floor, and a box that moves.
TinyScene plates_and_box() {
  TinyScene tiny;
  tiny.object("floor").quad({-40, -40, 0}, {40, -40, 0}, {40, 40, 0}, {-40, 40, 0});
  tiny.object("plates");
  for (int i = 0; i < 12; ++i)
    for (int k = 0; k < 4; ++k) {
      const double y = 1.5 * (i - 6), z = 0.5 + k, turn = 0.1 * ((7 * i + 3 * k) % 5 - 2);
      tiny.quad({30 + turn, y, z}, {30 + turn, y, z + 0.6}, {30 - turn, y + 0.6, z + 0.6},
                {30 - turn, y + 0.6, z});
    }
  const uint32_t body = tiny.body("box");
  tiny.object("box", body).box({-0.5, -0.5, 0}, {0.5, 0.5, 1.5});
  return tiny;
}

void expect_same(const EchoList& a, const EchoList& b, const std::string& when) {
  ASSERT_EQ(a.echoes.size(), b.echoes.size()) << when;
  for (size_t i = 0; i < a.echoes.size(); ++i) {
    const Echo &x = a.echoes[i], &y = b.echoes[i];
    EXPECT_EQ(x.amplitude, y.amplitude) << when << ", echo " << i;
    EXPECT_EQ(x.point, y.point) << when << ", echo " << i;
    EXPECT_EQ(x.departure, y.departure) << when << ", echo " << i;
    EXPECT_EQ(x.arrival, y.arrival) << when << ", echo " << i;
    EXPECT_EQ(x.delay.coefficients, y.delay.coefficients) << when << ", echo " << i;
    EXPECT_EQ(x.instance, y.instance) << when << ", echo " << i;
    EXPECT_EQ(x.bounces, y.bounces) << when << ", echo " << i;
  }
}

TEST(RadarMemory, SearchesAreThoseAnewWhereverTheBoxIs) {
  EchoScene scene(plates_and_box());
  EchoOptions options = testing::around(9.0, 30.0, 400);
  options.tracing = EchoTracing::host;
  const Pose mast = looking({0, 0, 4}, {30, 0, 1.5}), aside = looking({0, 1, 4}, {30, 0, 1.5});
  EchoFinder keeps(scene.gpu, scene.surfaces(), {}, std::nullopt, options);
  struct Frame {
    const char* when;
    Pose radar;
    dvec3 box;
    bool some, all;  ///< facets whose echoes have been kept
  };
  // No cone leads high up above the radar.
  const dvec3 away{-20, 0, 500}, between{20, 0, 0}, nearer{12, 0.4, 1.0}, at_plates{29, 1.0, 0.0};
  uint32_t facets = 0;
  for (const Frame& frame : {Frame{"a new pose", mast, away, false, false},
                             {"the same pose", mast, away, false, false},
                             {"again", mast, away, true, true},
                             {"the box has moved up there", mast, away + dvec3(0, 3, 0), true, true},
                             {"the box stands between", mast, between, true, false},
                             {"the box stands nearer", mast, nearer, true, false},
                             {"the box stands at the plates", mast, at_plates, true, false},
                             {"the box has gone", mast, away, true, true},
                             {"the radar has moved", aside, away, false, false},
                             {"it stands still, the box between", aside, between, false, false},
                             {"still", aside, between, true, false},
                             {"the box has gone", aside, away, true, false},
                             {"all is kept", aside, away, true, true}}) {
    EchoMotion motion = testing::at_rest(frame.radar, frame.radar);
    motion.body = [at = frame.box](uint32_t, double) { return Pose{at, {1, 0, 0, 0}}; };
    EchoStatistics statistics, anew;
    const EchoList found = testing::trace_echoes(keeps, scene.gpu, 2, motion, &statistics);
    EchoFinder fresh(scene.gpu, scene.surfaces(), {}, std::nullopt, options);
    expect_same(found, testing::trace_echoes(fresh, scene.gpu, 2, motion, &anew), frame.when);
    EXPECT_EQ(anew.remembered, 0u);
    EXPECT_EQ(statistics.facets, anew.facets) << frame.when;
    EXPECT_EQ(statistics.contributions, anew.contributions) << frame.when;
    EXPECT_EQ(statistics.below_floor, anew.below_floor) << frame.when;
    EXPECT_EQ(statistics.remembered > 0, frame.some) << frame.when;
    if (frame.box == away) facets = statistics.facets;
    EXPECT_EQ(statistics.remembered == facets, frame.all) << frame.when;
  }
  EXPECT_GT(facets, 20u);
}

}  // namespace
}  // namespace greatx::rf
