// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/receiver_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace greatx::sim {
namespace {

using ::testing::ElementsAre;

std::string list_refusal(const std::string& text) {
  try {
    parse_receiver_list(text, "r.csv");
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ReceiverList, ReadsPositionsInTheOrderOfTheFile) {
  EXPECT_THAT(parse_receiver_list("1,2,3\n -4e1 , +5,\t.5\n1,2,3\n", "r.csv"),
              ElementsAre(dvec3(1, 2, 3), dvec3(-40, 5, 0.5), dvec3(1, 2, 3)));
}

TEST(ReceiverList, KeepsEveryDigitOfLargeCoordinates) {
  EXPECT_THAT(parse_receiver_list("500000.123456789,5400000.000000001,35.1", "r.csv"),
              ElementsAre(dvec3(500000.123456789, 5400000.000000001, 35.1)));
}

TEST(ReceiverList, HeaderCommentsBlankLinesAndWindowsEndsAreFine) {
  EXPECT_THAT(
      parse_receiver_list("\xEF\xBB\xBF# grid\r\n\r\nX_m, y, Z\r\n0,0,1\r\n  # half\r\n1,0,2", "r.csv"),
      ElementsAre(dvec3(0, 0, 1), dvec3(1, 0, 2)));
}

TEST(ReceiverList, FaultsNameLineColumnAndField) {
  EXPECT_EQ(list_refusal(""), "r.csv: expected one position (x, y, z) or more, found none");
  EXPECT_EQ(list_refusal("# none\nx,y,z\n"), "r.csv: expected one position (x, y, z) or more, found none");
  EXPECT_EQ(list_refusal("0,0,0\n1,,3\n"), "r.csv:2:3: y: expected a finite number, found a gap");
  EXPECT_EQ(list_refusal(",0,0\n"), "r.csv:1:1: x: expected a finite number, found a gap");
  EXPECT_EQ(list_refusal("0,0,0\n0,0,nan\n"), "r.csv:2:5: z: expected a finite number, found 'nan'");
  EXPECT_EQ(list_refusal("nan,0,0\n"), "r.csv:1:1: x: expected a finite number, found 'nan'");
  EXPECT_EQ(list_refusal("0,-inf,0\n"), "r.csv:1:3: y: expected a finite number, found '-inf'");
  EXPECT_EQ(list_refusal("0,0,1e999\n"), "r.csv:1:5: z: expected a finite number, found '1e999'");
  EXPECT_EQ(list_refusal("0,0,3 m\n"), "r.csv:1:5: z: expected a finite number, found '3 m'");
  EXPECT_EQ(list_refusal("0,0\n"), "r.csv:1:3: expected 3 values (x, y, z), found 2");
  EXPECT_EQ(list_refusal("0,0,0,0\n"), "r.csv:1:7: expected 3 values (x, y, z), found 4");
  EXPECT_EQ(list_refusal("0;0;0\n"), "r.csv:1:1: expected 3 values (x, y, z), found 1");
  EXPECT_EQ(list_refusal("y,x,z\n0,0,0\n"),
            "r.csv:1:1: x: expected a number, or 'x' in a header line, found 'y'");
  EXPECT_EQ(list_refusal("x,y,z\nx,y,z\n"), "r.csv:2:1: x: expected a finite number, found 'x'");
}

TEST(ReceiverList, AFileThatIsNotThereIsNamed) {
  try {
    load_receiver_list("absent.csv");
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("absent.csv: expected a readable file"));
  }
}

}  // namespace
}  // namespace greatx::sim
