// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/text.h"

#include <clocale>
#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

#include "core/activity.h"
#include "core/error.h"

namespace greatx {
namespace {

TEST(Text, NamesThatPeopleGiveStay) {
  for (const char* name : {"", "wall", "Straße 7", "建物", "a \"b\" \\ c", "🏠"}) {
    EXPECT_EQ(printable(name), name);
    EXPECT_FALSE(find_bad_utf8(name).has_value()) << name;
  }
}

TEST(Text, ATerminalObeysNoName) {
  EXPECT_EQ(printable("a\x1b[2Jb"), "a\\u001b[2Jb");
  EXPECT_EQ(printable("a\nb\tc\r\x7f"), "a\\u000ab\\u0009c\\u000d\\u007f");
  EXPECT_EQ(printable_lines("a\nb\tc\r"), "a\nb\tc\\u000d");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\u009b31m");  // CSI in one character
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "b"),
            "a\\u202eb");  // right-to-left override
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\u0000b");
}

TEST(Text, WhatIsNotUtf8IsShownByItsBytes) {
  EXPECT_EQ(printable("a\xff"
                      "b"),
            "a\\xffb");
  EXPECT_EQ(printable("\xc3"), "\\xc3");           // cut off
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");  // overlong '/'
  EXPECT_EQ(printable("\xe0\x80\xaf"), "\\xe0\\x80\\xaf");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
  EXPECT_EQ(find_bad_utf8("ab\xff"), 2u);
}

TEST(Text, AnErrorQuotesWithoutObeying) {
  EXPECT_STREQ(UserError("mesh '\x1b[31m': x\ny").what(), "mesh '\\u001b[31m': x\ny");
  EXPECT_STREQ(UserError({"\xff.yaml", 3}, "x").what(), "\\xff.yaml:3: x");
}

TEST(Text, NumbersFollowTheCoreSchema) {
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(parse_number("+.5e3"), 500.0);
  EXPECT_EQ(parse_number("-7."), -7.0);
  for (const char* text : {"", "+", "1,5", "1.5x", "0x10", "inf", "nan", "1e999", " 1", "1 "})
    EXPECT_FALSE(parse_number(text).has_value()) << text;
}

TEST(Text, NumbersDoNotFollowTheLocale) {
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  for (const char* locale : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"})
    if (std::setlocale(LC_NUMERIC, locale) != nullptr)
      break;  // if no such locale is installed, check_locale.py shows that none matters
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_FALSE(parse_number("1,5").has_value());
  std::setlocale(LC_NUMERIC, before.c_str());
}

TEST(Activity, MemoryThatIsNotThereNamesWhatWasDone) {
  watch_memory();
  const auto ask = [] {
    const Activity outer("loading a model");
    const Activity inner("building the scene");
    std::get_new_handler()();  // as operator new does; a sanitizer's own operator new would end the test
  };
  EXPECT_THROW(ask(), std::bad_alloc);
  EXPECT_EQ(out_of_memory(), "out of memory while building the scene");
  std::set_new_handler(nullptr);
}

}  // namespace
}  // namespace greatx
