// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The canvas's shapes, themes, factors, texts, labels and keys, and the axes and colours of plots.
#include "draw/canvas/canvas.h"

#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "draw/canvas/labels.h"
#include "draw/canvas/plot.h"
#include "draw/sheet/map_marks.h"

namespace greatx::io {
namespace {

using testing::ElementsAre;

using Linear = std::array<double, 3>;

/// sRGB to linear (IEC 61966-2-1).
Linear linear_of(Color color) {
  const auto channel = [](uint8_t value) {
    const double c = value / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return {channel(color.r), channel(color.g), channel(color.b)};
}

double luminance_of(Color color) {
  const Linear c = linear_of(color);
  return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

/// The contrast of two colours (WCAG 2.1): 1 to 21.
double contrast(Color a, Color b) {
  const double high = std::max(luminance_of(a), luminance_of(b)),
               low = std::min(luminance_of(a), luminance_of(b));
  return (high + 0.05) / (low + 0.05);
}

/// CIE L*a*b* (D65) of linear sRGB.
Linear lab_of(const Linear& rgb) {
  const double xyz[] = {(0.4124 * rgb[0] + 0.3576 * rgb[1] + 0.1805 * rgb[2]) / 0.9505,
                        0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2],
                        (0.0193 * rgb[0] + 0.1192 * rgb[1] + 0.9505 * rgb[2]) / 1.089};
  double f[3];
  for (int i = 0; i < 3; ++i) {
    const double t = std::clamp(xyz[i], 0.0, 2.0);
    f[i] = t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0;
  }
  return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

/// Matrices of linear sRGB for full protanopia, deuteranopia and tritanopia (G. M. Machado et al., "A
/// Physiologically-based Model for Simulation of Color Vision Deficiency", IEEE TVCG 15, 2009, table 1).
constexpr double blindness[3][3][3] = {
    {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}},
    {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}},
    {{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}};

double distance_seen(Color a, Color b, const double (*matrix)[3]) {
  const auto seen = [&](Color color) {
    const Linear c = linear_of(color);
    if (matrix == nullptr) return lab_of(c);
    Linear out{};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) out[i] += matrix[i][k] * c[k];
    return lab_of(out);
  };
  const Linear p = seen(a), q = seen(b);
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

TEST(Theme, LinesOnPaperDifferForEveryEye) {
  const std::span<const Color> lines = light_theme().series;
  ASSERT_EQ(lines.size(), 8u);
  for (size_t i = 0; i < lines.size(); ++i) {
    EXPECT_GT(contrast(lines[i], light_theme().panel), 1.9) << i;
    for (size_t j = i + 1; j < lines.size(); ++j) {
      EXPECT_GT(distance_seen(lines[i], lines[j], nullptr), 15.0) << i << ' ' << j;
      // 2.3 is a just noticeable difference.
      for (const auto& kind : blindness)
        EXPECT_GT(distance_seen(lines[i], lines[j], kind), 7.0) << i << ' ' << j;
    }
  }
}

TEST(Theme, TextCanBeRead) {
  for (const Theme* theme : {&dark_theme(), &light_theme()}) {
    EXPECT_GT(contrast(theme->text, theme->page), 12.0) << theme->name;
    EXPECT_GT(contrast(theme->dim, theme->page), 4.5) << theme->name;
    EXPECT_GT(contrast(theme->over, theme->halo), 12.0) << theme->name;
    EXPECT_EQ(theme_called(theme->name), theme);
  }
  EXPECT_EQ(theme_called("grey"), nullptr);
}

/// A print without colours shows the order of values.
TEST(Theme, MapsOnPaperRiseInLightness) {
  for (const ColorMap map : {light_theme().heights, light_theme().power})
    for (int i = 0; i < 20; ++i)
      EXPECT_LT(luminance_of(map(i / 20.0)), luminance_of(map((i + 1) / 20.0))) << i;
  EXPECT_GT(distance_seen(light_theme().velocities(0.0), light_theme().velocities(1.0), blindness[1]), 30.0);
}

TEST(Theme, NeighbouringIdsDiffer) {
  for (const Theme* theme : {&dark_theme(), &light_theme()})
    for (uint32_t id = 0; id < 60; ++id) {
      const Color a = color_of_id(*theme, id), b = color_of_id(*theme, id + 1);
      EXPECT_GT(distance_seen(a, b, nullptr), 8.0) << theme->name << ' ' << id;
    }
}

TEST(Canvas, AFactorMultipliesThePixelsAndKeepsThePlaces) {
  Canvas once(40, 30, light_theme()), twice(40, 30, light_theme(), 2);
  for (Canvas* canvas : {&once, &twice}) {
    canvas->fill({10, 5, 20, 10}, {200, 0, 0});
    canvas->blend(3, 3, {0, 0, 200});
    canvas->raster({0, 20, 8, 8}, 2, 1, [](int x, int) {
      return Color{0, static_cast<uint8_t>(100 + x), 0};
    });
  }
  EXPECT_EQ(twice.image().shape, (std::vector<int64_t>{60, 80, 3}));
  const Array small = once.image(), large = twice.image();
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x)
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(large.as<uint8_t>()[(y * 80 + x) * 3 + c],
                  small.as<uint8_t>()[(y / 2 * 40 + x / 2) * 3 + c])
            << x << ' ' << y;
}

/// The strokes of large text cover the dots of small text.
TEST(Canvas, LargeTextHasTheSameShape) {
  const Theme& theme = light_theme();
  Canvas once(80, 30, theme), fourfold(80, 30, theme, 4);
  for (Canvas* canvas : {&once, &fourfold}) canvas->text(2, 2, "Rx 8", 2, theme.text);
  const Array small = once.image(), large = fourfold.image();
  int dark = 0, agree = 0;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 80; ++x) {
      if (small.as<uint8_t>()[(y * 80 + x) * 3] > 100) continue;
      ++dark;
      // The middle of the four by four pixels may be rounded off at a corner.
      int inked = 0;
      for (int k = 0; k < 16; ++k)
        inked += large.as<uint8_t>()[((4 * y + k / 4) * 320 + 4 * x + k % 4) * 3] < 128;
      agree += inked >= 8;
    }
  EXPECT_GT(dark, 100);
  EXPECT_GT(agree, 9 * dark / 10);
}

TEST(Canvas, RemembersItsTexts) {
  Canvas canvas(100, 50, dark_theme());
  canvas.text(10, 10, "abc", 2, {255, 255, 255});
  canvas.text(90, 10, "abc", 2, {255, 255, 255});
  canvas.text(50, 30, "", 2, {255, 255, 255});
  canvas.vertical_text(5, 25, "ab", 1, {255, 255, 255});
  ASSERT_EQ(canvas.texts().size(), 3u);
  EXPECT_TRUE(canvas.texts()[0].whole);
  EXPECT_EQ(canvas.texts()[0].rect.width, 34);
  EXPECT_EQ(canvas.texts()[0].rect.height, 14);
  EXPECT_FALSE(canvas.texts()[1].whole) << "it leaves the canvas";
  EXPECT_EQ(canvas.texts()[2].rect.height, 11) << "it reads upwards";
}

TEST(Canvas, LongTextsLoseTheirMiddle) {
  EXPECT_EQ(fitted("short", 100, 2), "short");
  EXPECT_EQ(fitted("a_rather_long_name", 12 * 11 - 2, 2), "a_ra...name");
  EXPECT_EQ(fitted("abcdefgh", 40, 2), "abc");
  EXPECT_EQ(fitted("abcdefgh", 1, 2), "a");
  for (int width = 12; width < 300; width += 7)
    EXPECT_LE(Canvas::text_width(fitted("a_rather_long_name_of_a_thing", width, 2), 2) - 2, width);
}

/// Labels of a crowd of marks cover neither each other nor a text that was there, and stay inside.
TEST(Labels, NeverOverlap) {
  for (int seed = 0; seed < 40; ++seed) {
    Canvas canvas(400, 300, dark_theme());
    const Rect picture{20, 10, 360, 280};
    canvas.text(200, 140, "100 m", 2, {255, 255, 255});
    std::vector<MapMark> marks;
    for (int i = 0; i < 12; ++i) {
      const int x = (seed * 7919 + i * 104729) % 360, y = (seed * 6841 + i * 27644437 % 100003) % 280;
      marks.push_back(
          {MapMark::Kind::detection, {20.0 + x, 10.0 + y}, true, mark_label("a thing", 12.0 + i, -3.5)});
    }
    draw_map_marks(canvas, marks);
    label_map_marks(canvas, picture, marks);
    const std::vector<DrawnText>& texts = canvas.texts();
    EXPECT_GT(texts.size(), 3u) << "some labels have room";
    for (size_t i = 0; i < texts.size(); ++i) {
      EXPECT_TRUE(picture.contains(texts[i].rect)) << seed;
      for (size_t j = i + 1; j < texts.size(); ++j)
        EXPECT_FALSE(texts[i].rect.overlaps(texts[j].rect))
            << seed << ": " << texts[i].text << ", " << texts[j].text;
    }
  }
}

TEST(Labels, TheFirstMarkIsNamedFirst) {
  Canvas canvas(230, 40, dark_theme());
  label_map_marks(canvas, {0, 0, 230, 40},
                  {{MapMark::Kind::truth, {20, 20}, true, mark_label("one", 123.4, 5.0)},
                   {MapMark::Kind::detection, {16, 20}, true, mark_label("two", 5.06, -1.0)}});
  ASSERT_EQ(canvas.texts().size(), 2u) << "there is no room for the second label";
  EXPECT_EQ(canvas.texts()[0].text, "one");
  EXPECT_EQ(canvas.texts()[1].text, "123 m +5.0 m/s");
}

/// A wall ahead is drawn at its distance in space and its azimuth in the sensor's frame, however long it is;
/// what lies behind the sensor or beyond the map is not drawn.
TEST(Outlines, LieWhereTheirEchoesDo) {
  const Pose sensor{{100.0, 200.0, 30.0},
                    glm::angleAxis(0.5 * 3.14159265358979, dvec3(0, 0, 1))};  // looks north
  const auto places_of = [&](const OutlineLine& line) {
    Canvas canvas(10, 10, dark_theme());
    std::vector<dvec2> places;
    draw_outlines(canvas, {line}, sensor, 50.0, -1.5, 1.5, [&](double range, double azimuth) {
      places.emplace_back(range, azimuth);
      return dvec2(0.0);
    });
    return places;
  };
  // 40 m north and 30 m lower: 50 m at the nearest point, so that nothing is within the map.
  EXPECT_TRUE(places_of({{60, 240.1, 0}, {140, 240.1, 0}}).empty());
  const std::vector<dvec2> wall = places_of({{-1e6, 224, 12}, {1e6, 224, 12}});
  ASSERT_GT(wall.size(), 20u);
  ASSERT_LT(wall.size(), 200u) << "a long wall costs no more than its part in the map";
  double nearest = 1e9;
  for (const dvec2& at : wall) {
    nearest = std::min(nearest, at.x);
    EXPECT_LT(at.x, 50.001);
    // Forward 24 m, down 18 m, so range and azimuth determine each other: (24 / cos a)^2 + 18^2 = r^2.
    EXPECT_NEAR(std::hypot(24.0 / std::cos(at.y), 18.0), at.x, 1e-3);
  }
  EXPECT_NEAR(nearest, 30.0, 0.1);
  EXPECT_GT(wall.front().y, 0.5) << "west is to the left";
  EXPECT_TRUE(places_of({{90, 190, 30}, {110, 190, 30}}).empty()) << "behind the sensor";
}

TEST(Key, StaysInItsArea) {
  Canvas canvas(300, 200, light_theme());
  std::vector<KeyEntry> entries;
  for (int i = 0; i < 12; ++i)
    entries.push_back({static_cast<KeyEntry::Mark>(i % 6),
                       {200, 30, 30},
                       "entry " + std::to_string(i) + " with a name that is longer than the area is wide"});
  const Rect area{40, 20, 220, 5 * theme::line_height};
  draw_key(canvas, area, entries);
  EXPECT_EQ(canvas.texts().size(), 5u);
  for (const DrawnText& text : canvas.texts()) EXPECT_TRUE(area.contains(text.rect)) << text.text;
  const Array image = canvas.image();
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 300; ++x)
      if (!area.contains({x, y, 1, 1})) {
        ASSERT_EQ(image.as<uint8_t>()[(y * 300 + x) * 3 + 1], 255) << x << ' ' << y;
      }
}

TEST(Canvas, DrawsInsideItsClipOnly) {
  Canvas canvas(20, 10, Color{0, 0, 0});
  canvas.clip({5, 2, 4, 4});
  canvas.fill({0, 0, 20, 10}, {255, 0, 0});
  const Array image = canvas.image();
  int red = 0;
  for (size_t i = 0; i < image.bytes.size(); i += 3) red += image.as<uint8_t>()[i] == 255;
  EXPECT_EQ(red, 16);
}

TEST(Canvas, TextHasTheGlyphsDots) {
  Canvas canvas(20, 20, Color{0, 0, 0});
  canvas.text(0, 0, "!", 2,
              {255, 255, 255});  // the glyph is one column of seven rows, of which the sixth is empty
  const Array image = canvas.image();
  int white = 0;
  for (size_t i = 0; i < image.bytes.size(); i += 3) white += image.as<uint8_t>()[i] == 255;
  EXPECT_EQ(white, 6 * 4);
}

TEST(Canvas, PictureKeepsTheMeanWhenItShrinks) {
  Array rgb(DType::u8, {4, 4, 3});
  for (size_t i = 0; i < 48; ++i) rgb.as<uint8_t>()[i] = i / 3 % 2 == 0 ? 200 : 100;
  Canvas canvas(2, 2, Color{0, 0, 0});
  canvas.picture({0, 0, 2, 2}, rgb);
  const Array image = canvas.image();
  for (const uint8_t value : image.as<uint8_t>()) EXPECT_EQ(value, 150);
}

TEST(Plot, TicksAreRoundAndInside) {
  EXPECT_THAT((Scale{0.0, 1.0}.ticks(5)),
              testing::Pointwise(testing::DoubleNear(1e-12), {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}));
  EXPECT_THAT((Scale{-32.0, 41.0}.ticks(4)), ElementsAre(-20.0, 0.0, 20.0, 40.0));
  EXPECT_THAT((Scale{0.5, 60.0, true}.ticks(5)),
              testing::Pointwise(testing::DoubleNear(1e-9), {0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0}));
  EXPECT_EQ(round_down(73.0), 50.0);
  EXPECT_EQ(tick_text(0.0), "0");
}

TEST(Colors, NeighbouringIdsDiffer) {
  std::set<std::tuple<int, int, int>> colors;
  for (uint32_t id = 0; id < 100; ++id) {
    const Color c = color_of_id(id);
    colors.insert({c.r, c.g, c.b});
  }
  EXPECT_GT(colors.size(), 95u);
}

TEST(Colors, FlowHasDirectionsAndLengths) {
  const auto rgb = [](Color c) { return std::array<int, 3>{c.r, c.g, c.b}; };
  EXPECT_THAT(rgb(flow_color(0, 0)), ElementsAre(255, 255, 255));
  EXPECT_THAT(rgb(flow_color(1, 0)), ElementsAre(255, 0, 0));
  EXPECT_THAT(rgb(flow_color(-1, 0)), ElementsAre(0, 255, 255));
  EXPECT_THAT(rgb(flow_color(0, 1)), ElementsAre(128, 255, 0));
  EXPECT_THAT(rgb(flow_color(0, -1)), ElementsAre(128, 0, 255));
  EXPECT_THAT(rgb(flow_color(0.5, 0)), ElementsAre(255, 128, 128));
  EXPECT_THAT(rgb(flow_color(std::nan(""), 0)), ElementsAre(0, 0, 0));
}

}  // namespace
}  // namespace greatx::io
