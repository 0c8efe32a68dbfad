// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/date_time.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {
namespace {

TEST(DateTime, ReadsTheExamplesOfTheStandard) {
  // RFC 3339, section 5.8.
  EXPECT_EQ(parse_date_time("1985-04-12T23:20:50.52Z"), 482196050.52);
  EXPECT_EQ(parse_date_time("1996-12-19T16:39:57-08:00"), 851042397.0);
  EXPECT_EQ(parse_date_time("1990-12-31T23:59:60Z"), 662688000.0);  // a leap second
  EXPECT_DOUBLE_EQ(*parse_date_time("1937-01-01T12:00:27.87+00:20"), -1041337172.13);
  EXPECT_EQ(parse_date_time("2026-06-21t12:00:00+02:00"), parse_date_time("2026-06-21 10:00:00z"));
  EXPECT_EQ(parse_date_time("1970-01-01T00:00:00Z"), 0.0);
  EXPECT_EQ(parse_date_time("1900-01-01T00:00:00Z"), first_known_instant);
  EXPECT_EQ(parse_date_time("2151-01-01T00:00:00Z"), last_known_instant);
  EXPECT_EQ(*parse_date_time("2024-02-29T00:00:00Z") + 86400.0, parse_date_time("2024-03-01T00:00:00Z"));
}

TEST(DateTime, RefusesWhatIsNone) {
  for (const char* text : {"",
                           "2026-06-21",
                           "2026-06-21T12:00Z",
                           "2026-06-21T12:00:00",
                           "26-06-21T12:00:00Z",
                           "2026-13-01T12:00:00Z",
                           "2026-00-01T12:00:00Z",
                           "2026-06-00T12:00:00Z",
                           "2026-06-31T12:00:00Z",
                           "2023-02-29T12:00:00Z",
                           "2026-06-21T24:00:00Z",
                           "2026-06-21T12:60:00Z",
                           "2026-06-21T12:00:61Z",
                           "2026-06-21T12:00:00.Z",
                           "2026-06-21T12:00:00+2:00",
                           "2026-06-21T12:00:00+0200",
                           "2026-06-21T12:00:00+24:00",
                           "2026-06-21T12:00:00Z ",
                           "+2026-06-21T12:00:00Z",
                           "2026/06/21T12:00:00Z"})
    EXPECT_FALSE(parse_date_time(text)) << text;
}

TEST(DateTime, OfAScenario) {
  const Environment e = load_scenario(std::filesystem::path(GREATX_SCENARIOS) / "night.yaml").environment;
  ASSERT_TRUE(e.place);
  EXPECT_DOUBLE_EQ(e.place->latitude, radians(48.8738));
  EXPECT_DOUBLE_EQ(e.place->longitude, radians(2.295));
  EXPECT_EQ(e.place->height_m, 60.0);
  EXPECT_EQ(e.place->unix_s, *parse_date_time("2026-11-24T20:30:00Z"));
  EXPECT_EQ(e.sun_illuminance_lux, 0.0);
  EXPECT_EQ(e.moon_illuminance_lux, 0.25);
  EXPECT_EQ(e.sky, SkyKind::clear);
  EXPECT_EQ(e.sky_glow_cd_m2, 0.01);
  EXPECT_EQ(e.turbidity, 3.0);
  EXPECT_EQ(e.fog_height_m, 60.0);
}

}  // namespace
}  // namespace greatx::sim
