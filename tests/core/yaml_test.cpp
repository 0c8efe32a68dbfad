// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/yaml/yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace greatx {
namespace {

using testing::HasSubstr;

std::string message_of(const std::string& text) {
  try {
    load_yaml(text, "x.yaml");
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Yaml, AliasesAreFine) {
  const auto documents = load_yaml("a: &a {x: 1}\nb: [*a, *a]\n", "x.yaml");
  ASSERT_EQ(documents.size(), 1u);
  EXPECT_EQ(documents[0]["b"][1]["x"].Scalar(), "1");
}

TEST(Yaml, AliasesOfAliasesAreCountedBeforeAnyoneWalksOverThem) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 9; ++i) {
    text += fmt::format("a{0}: &a{0} [", i);
    for (int k = 0; k < 9; ++k) text += fmt::format("{}*a{}", k == 0 ? "" : ", ", i - 1);
    text += "]\n";
  }
  ASSERT_LT(text.size(), 600u);
  EXPECT_THAT(message_of(text),
              testing::AllOf(HasSubstr("x.yaml:"), HasSubstr("expected at most 1000000 values"),
                             HasSubstr("aliases")));
}

TEST(Yaml, AnAliasInsideItselfIsRefused) {
  EXPECT_THAT(message_of("a: &a [1, *a]\n"), HasSubstr("x.yaml:1: expected values, found an alias inside"));
}

TEST(Yaml, BytesThatAreNotUtf8AreRefusedByLine) {
  EXPECT_EQ(message_of("a: 1\nb: \xff\n"), "x.yaml:2: expected UTF-8, found the byte 0xff");
}

TEST(Yaml, DeepNestingIsAnError) {
  EXPECT_THROW(load_yaml(std::string(100000, '['), "x.yaml"), YAML::Exception);
}

TEST(Yaml, PlainScalarsFollowTheCoreSchemaAndQuotedOnesAreTexts) {
  const YAML::Node map =
      load_yaml("a: -1.5e3\nb: '2'\nc: True\nd: \"true\"\ne: yes\nf:\ng: [1]\nh: FALSE\n", "x.yaml")[0];
  EXPECT_EQ(plain_number(map["a"]), -1500.0);
  EXPECT_EQ(plain_boolean(map["c"]), true);
  EXPECT_EQ(plain_boolean(map["h"]), false);
  for (const char* const key : {"b", "c", "d", "e", "f", "g"}) EXPECT_FALSE(plain_number(map[key])) << key;
  for (const char* const key : {"a", "b", "d", "e", "f", "g"}) EXPECT_FALSE(plain_boolean(map[key])) << key;
  EXPECT_EQ(line_of(map["c"]), 3);
  EXPECT_EQ(line_of(YAML::Node(), 7), 7);
}

}  // namespace
}  // namespace greatx
