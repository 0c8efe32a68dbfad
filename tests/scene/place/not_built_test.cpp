// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the message of a program that was built without GDAL, PROJ and libosmium.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/place/place_folder.h"

namespace greatx::scene::place {
namespace {

TEST(PlaceNotBuilt, SaysWhatToInstall) {
  EXPECT_FALSE(places_built_in());
  const test::PlaceFolder folder;
  folder.write("m.osm", "<osm version=\"0.6\"/>");
  EXPECT_THAT(
      test::message_of([&] { folder.read("maps: [{file: m.osm}]\n"); }),
      testing::AllOf(testing::HasSubstr("place.yaml"), testing::HasSubstr("libgdal-dev libproj-dev")));
}

}  // namespace
}  // namespace greatx::scene::place
