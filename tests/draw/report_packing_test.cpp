// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "draw/report/blobs.h"
#include "draw/report/parts.h"
#include "io/formats/html_text.h"

namespace greatx::io {
namespace {

TEST(ReportPacking, LogarithmicCodesAreWithinHalfAStep) {
  std::vector<float> values;
  for (float x = 0.05f; x < 2e5f; x *= 1.00713f) values.push_back(x);
  const report::LogCode code = report::LogCode::of(values, 1.002);
  EXPECT_EQ(code.ratio, 1.002);
  for (const float value : values) {
    const double back = code.low * std::pow(code.ratio, static_cast<double>(code.code(value)) - 1.0);
    EXPECT_LE(std::abs(back / double{value} - 1.0), 0.00101);
  }
  EXPECT_EQ(code.code(std::numeric_limits<double>::infinity()), 0u);
  EXPECT_EQ(code.code(0.0), 0u);
  EXPECT_EQ(code.code(-1.0), 0u);
}

TEST(ReportPacking, AWideSpanWidensTheSteps) {
  const std::vector<float> values{1e-38f, 1.0f, 1e38f};
  const report::LogCode code = report::LogCode::of(values, 1.0001);
  EXPECT_GT(code.ratio, 1.0001);
  EXPECT_EQ(code.code(values[0]), 1u);
  EXPECT_LE(code.code(values[2]), 65535u);
  EXPECT_NEAR(code.low * std::pow(code.ratio, double{65533.0}), 1e38, 1e35);
}

TEST(ReportPacking, NumbersAreShort) {
  EXPECT_EQ(report::rounded(1.23456, 2).dump(), "1.23");
  EXPECT_EQ(report::rounded(-0.0001, 2).dump(), "0");
  EXPECT_EQ(report::rounded(5.4e6, 3).dump(), "5400000");
  EXPECT_TRUE(report::rounded(std::nan(""), 2).is_null());
  EXPECT_EQ(report::shown_name(std::string(300, 'x')).size(), report::most_name + 3);
  std::string umlauts;
  for (int i = 0; i < 150; ++i) umlauts += "\xc3\xa4";
  EXPECT_EQ(report::shown_name("y" + umlauts).size() % 2, 0u) << "no half of a character";
}

TEST(ReportPacking, TextIsSafeInAPage) {
  EXPECT_EQ(html_escaped("<b a=\"1\" c='2'>&</b>"), "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;&lt;/b&gt;");
  EXPECT_EQ(json_for_script(R"({"a":"</script><!--&"})"), R"({"a":"\u003c/script\u003e\u003c!--\u0026"})");
  // RFC 4648, section 10.
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, coded] : vectors) {
    EXPECT_EQ(base64(bytes_of(plain)), coded);
    EXPECT_EQ(base64_size(std::string_view(plain).size()), std::string_view(coded).size());
  }
}

}  // namespace
}  // namespace greatx::io
