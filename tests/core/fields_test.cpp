// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/fields/field.h"
#include "core/fields/yaml.h"

namespace greatx {
namespace {

using testing::HasSubstr;

std::string message_of(const std::string& text) {
  try {
    read_yaml(text, "x.yaml");
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Yaml, AliasesShareTheValueThatTheyName) {
  const auto root = read_yaml("a: &a {x: 1}\nb: [*a, *a]\n", "x.yaml");
  ASSERT_EQ(root->members.size(), 2u);
  const auto& items = root->members[1].value->items;
  ASSERT_EQ(items.size(), 2u);
  EXPECT_EQ(items[0], root->members[0].value);
  EXPECT_EQ(items[1], items[0]);
  EXPECT_EQ(items[1]->members.at(0).value->text, "1");
}

TEST(Yaml, ALongTextWithManyAliasesTakesItsMemoryOnce) {
  std::string text = "- &a " + std::string(1 << 20, 'x') + "\n";
  for (int i = 0; i < 100'000; ++i) text += "- *a\n";
  const auto root = read_yaml(text, "x.yaml");
  ASSERT_EQ(root->items.size(), 100'001u);
  EXPECT_EQ(root->items.front(), root->items.back());
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

TEST(Yaml, DeepNestingSeveralDocumentsAndOddKeysAreErrors) {
  EXPECT_THAT(message_of(std::string(100000, '[')), HasSubstr("x.yaml:1: expected well-formed YAML"));
  EXPECT_EQ(message_of("a: 1\n---\nb: 2\n"), "x.yaml:3: expected one YAML document, found 2 or more");
  // yaml-cpp would find documents without end.
  EXPECT_NE(message_of(",m directive}\n  \"leaals ").find("expected one YAML document"), std::string::npos);
  EXPECT_EQ(message_of("a: 1\n[b]: 2\n"), "x.yaml:2: expected a text as key, found a list");
}

TEST(Field, PlainScalarsFollowTheCoreSchemaAndQuotedOnesAreTexts) {
  const Field root = Field::parse_yaml(
      "a: -1.5e3\nb: '2'\nc: True\nd: \"true\"\ne: yes\nf:\ng: [1]\nh: FALSE\n", {"x.yaml", {}, {}});
  const auto message = [](const Field& field, auto get) -> std::string {
    try {
      get(field);
    } catch (const UserError& error) {
      return error.what();
    }
    return "accepted";
  };
  for (const auto& [key, field] : root.entries()) {
    const std::string number = message(field, [](const Field& f) { return f.number(); });
    const std::string boolean = message(field, [](const Field& f) { return f.boolean(); });
    EXPECT_EQ(number == "accepted", key == "a") << number;
    EXPECT_EQ(boolean == "accepted", key == "c" || key == "h") << boolean;
  }
  const auto entries = root.entries();
  EXPECT_EQ(entries[0].second.number(), -1500.0);
  EXPECT_TRUE(entries[2].second.boolean());
  EXPECT_FALSE(entries[7].second.boolean());
  EXPECT_EQ(entries[2].second.where().line, 3);
  EXPECT_EQ(message(entries[5].second, [](const Field& f) { return f.number(); }),
            "x.yaml:6: f: expected a finite number, found nothing");
  EXPECT_EQ(message(entries[6].second, [](const Field& f) { return f.list("numbers", 2); }),
            "x.yaml:7: g: expected a list of 2 or more numbers, found a list of 1");
}

TEST(Field, ABoundedNumberKeepsItsBounds) {
  const Field root = Field::parse_yaml("[1e-31, 1e31, 2.5, 7]", {"x.yaml", {}, {}});
  const auto items = root.list("numbers");
  EXPECT_THROW(items[0].number(), UserError);
  EXPECT_THROW(items[1].number(), UserError);
  EXPECT_EQ(items[0].finite(), 1e-31);
  EXPECT_EQ(items[2].between(2, 3), 2.5);
  EXPECT_THROW(items[2].integer(0), UserError);
  EXPECT_EQ(items[3].integer(7, 7), 7u);
}

}  // namespace
}  // namespace greatx
