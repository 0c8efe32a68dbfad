// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_folder.h"
#include "view/settings/viewer_settings.h"

namespace greatx::view {
namespace {

using testing::HasSubstr;

ViewerSettings changed() {
  ViewerSettings settings;
  settings.width = 1600;
  settings.height = 900;
  settings.side_open = settings.legend = false;
  settings.side_share = 0.3;
  settings.speed = 0.25;
  settings.shows = {{"lidar", true}, {"paths", false}};
  settings.paths_by_kind = true;
  settings.set_panels("city", {"uav/front: rgb", "csi: arrivals"});
  settings.set_panels("bad \xff name", {});
  return settings;
}

std::string fault_of(const std::string& text) {
  try {
    parse_settings(text, "viewer.json");
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ViewerSettings, AreReadAsTheyAreWritten) {
  const ViewerSettings read = parse_settings(text_of(changed()), "viewer.json");
  EXPECT_EQ(read.width, 1600);
  EXPECT_EQ(read.height, 900);
  EXPECT_FALSE(read.side_open);
  EXPECT_FALSE(read.legend);
  EXPECT_EQ(read.side_share, 0.3);
  EXPECT_EQ(read.speed, 0.25);
  EXPECT_EQ(read.shows, changed().shows);
  EXPECT_TRUE(read.paths_by_kind);
  EXPECT_THAT(*read.panels_of("city"), testing::ElementsAre("uav/front: rgb", "csi: arrivals"));
  EXPECT_FALSE(read.panels_of("room"));
  EXPECT_EQ(text_of(read), text_of(parse_settings(text_of(read), "viewer.json")));
}

TEST(ViewerSettings, TheScenariosUsedLongestAgoAreForgotten) {
  ViewerSettings settings;
  for (size_t i = 0; i <= ViewerSettings::most_scenarios; ++i) {
    settings.set_panels("kept", {"a"});
    settings.set_panels(fmt::format("{}", i), {});
  }
  EXPECT_EQ(settings.panels.size(), ViewerSettings::most_scenarios);
  EXPECT_TRUE(settings.panels_of("kept"));
  EXPECT_FALSE(settings.panels_of("0"));
}

TEST(ViewerSettings, DamagedOnesNameWhatIsWrong) {
  EXPECT_EQ(fault_of("{\"version\": 1}"), "accepted");
  for (const char* const text :
       {"", "[]", "{", "{\"version\": 2}", "{\"version\": 1, \"width\": 3}",
        "{\"version\": 1, \"side_share\": 1e300}", "{\"version\": 1, \"speed\": -1}",
        "{\"version\": 1, \"shows\": {\"lidar\": 7}}", "{\"version\": 1, \"panels\": [{\"title\": 3}]}",
        "{\"version\": 1, \"panels\": {}}", "\x01\x02\xff"})
    EXPECT_THAT(fault_of(text), HasSubstr("viewer.json")) << text;
}

TEST(ViewerSettings, ADamagedFileGivesThoseOfTheFirstStart) {
  const greatx::test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "viewer.json";
  std::string message;
  EXPECT_EQ(load_settings(file, message).side_share, 0.42);
  EXPECT_EQ(message, "");
  std::ofstream(file) << "{\"version\": 1, \"side_share\": \"wide\"}";
  EXPECT_EQ(load_settings(file, message).side_share, 0.42);
  EXPECT_THAT(message, HasSubstr("the viewer's settings are ignored: "));
  EXPECT_THAT(message, HasSubstr("side_share: expected a number"));
  save_settings(file, changed());
  message.clear();
  EXPECT_EQ(load_settings(file, message).side_share, 0.3);
  EXPECT_EQ(message, "");
}

}  // namespace
}  // namespace greatx::view
