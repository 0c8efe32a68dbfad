// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/files/untrusted_json.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace greatx::io {
namespace {

std::string refusal_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

const char* const text = R"({
  "name": "a \"quoted\": name",
  "sensors": [
    {"rate": 30, "on": true},
    {"rate": 1e300,
     "on": 1}
  ]
})";

TEST(UntrustedJson, GettersGiveWhatIsThere) {
  const JsonDocument document(text, {"x.json", 1});
  const JsonValue root = document.root();
  EXPECT_EQ(root.at("name").text(), "a \"quoted\": name");
  const std::vector<JsonValue> sensors = root.at("sensors").list(2);
  EXPECT_EQ(sensors[0].at("rate").integer(0, 30), 30);
  EXPECT_TRUE(sensors[0].at("on").boolean());
  EXPECT_EQ(sensors[1].at("rate").number(0, 1e301), 1e300);
  EXPECT_TRUE(root.has("name"));
  EXPECT_FALSE(root.has("other"));
}

TEST(UntrustedJson, FaultsNameFileLineAndField) {
  const JsonDocument document(text, {"x.json", 1});
  const JsonValue root = document.root();
  const std::vector<JsonValue> sensors = root.at("sensors").list(2);
  EXPECT_EQ(refusal_of([&] { root.at("name").integer(0, 1); }),
            "x.json:2: name: expected an integer from 0 to 1, found \"a \\\"quoted\\\": name\"");
  EXPECT_EQ(refusal_of([&] { sensors[1].at("on").boolean(); }),
            "x.json:6: sensors[1].on: expected true or false, found 1");
  EXPECT_EQ(refusal_of([&] { sensors[1].at("rate").integer(0, 99); }),
            "x.json:5: sensors[1].rate: expected an integer from 0 to 99, found 1e+300");
  EXPECT_EQ(refusal_of([&] { sensors[0].at("rate").integer(31, 99); }),
            "x.json:4: sensors[0].rate: expected an integer from 31 to 99, found 30");
  EXPECT_EQ(refusal_of([&] { sensors[0].at("kind"); }),
            "x.json:4: sensors[0].kind: expected a value, found none");
  EXPECT_EQ(refusal_of([&] { root.at("sensors").list(1); }),
            "x.json:3: sensors: expected a list of at most 1, found a list of 2");
  EXPECT_EQ(refusal_of([&] { root.text(); }), "x.json:1: expected a string, found an object");
}

TEST(UntrustedJson, NumbersBeyondTheirTypeAreFaults) {
  for (const char* number : {"9223372036854775808", "18446744073709551615", "-1", "1.0", "\"1\"", "null"}) {
    const JsonDocument document(number, {"x", 1});
    EXPECT_THROW(document.root().integer(0, INT64_MAX), UserError) << number;
  }
  const JsonDocument most("9223372036854775807", {"x", 1});
  EXPECT_EQ(most.root().integer(0, INT64_MAX), INT64_MAX);
}

TEST(UntrustedJson, DepthSizeAndCountAreBoundedBeforeAnythingIsBuilt) {
  for (const char* opening : {"[", "{\"a\":"}) {
    std::string deep = "\n";
    for (int i = 0; i < 100'000; ++i) deep += opening;
    EXPECT_EQ(refusal_of([&] {
                JsonDocument(deep, {"x.json", 1});
              }),
              "x.json:2: expected JSON nested at most 64 deep, found more");
  }
  EXPECT_THAT(refusal_of([&] {
                JsonDocument("[1, 2, 3]", {"x.json", 1}, {100, 3, 64});
              }),
              testing::HasSubstr("at most 3 values"));
  EXPECT_THAT(refusal_of([&] {
                JsonDocument("[1, 2, 3]", {"x.json", 1}, {8, 100, 64});
              }),
              testing::HasSubstr("at most 8 bytes"));
  EXPECT_NO_THROW(JsonDocument("[1, 2, 3]", {"x.json", 1}, {9, 4, 1}));
}

TEST(UntrustedJson, WhatIsNoJsonIsNamedByLine) {
  EXPECT_THAT(
      refusal_of([&] {
        JsonDocument("{\n\"a\": 1,\n\x1b[31m}", {"x.json", 1});
      }),
      testing::AllOf(testing::HasSubstr("x.json:3: is no JSON"), testing::Not(testing::HasSubstr("\x1b"))));
  EXPECT_THAT(refusal_of([&] {
                JsonDocument("[1, ]", {"journal.txt", 7});
              }),
              testing::HasSubstr("journal.txt:7: is no JSON"));
  EXPECT_THROW(JsonDocument("", {"x", 1}), UserError);
  EXPECT_THROW(JsonDocument("\"\xff\xfe\"", {"x", 1}), UserError);
}

}  // namespace
}  // namespace greatx::io
