// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/canvas/theme.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace greatx::io {

namespace {

uint8_t byte_of(double value) { return static_cast<uint8_t>(255.0 * std::clamp(value, 0.0, 1.0) + 0.5); }

/// Evaluates c[0] + c[1] t + ..., one polynomial for each channel.
template <size_t N>
Color polynomial(const double (&c)[N][3], double t) {
  t = std::clamp(t, 0.0, 1.0);
  double value[3] = {0, 0, 0};
  for (size_t i = N; i-- > 0;)
    for (int k = 0; k < 3; ++k) value[k] = value[k] * t + c[i][k];
  return {byte_of(value[0]), byte_of(value[1]), byte_of(value[2])};
}

Color from_hsv(double hue, double saturation, double value) {
  const auto channel = [&](double n) {
    const double k = std::fmod(n + 6.0 * hue, 6.0);
    return byte_of(value * (1.0 - saturation * std::max(0.0, std::min({k, 4.0 - k, 1.0}))));
  };
  return {channel(5.0), channel(3.0), channel(1.0)};
}

Color between(Color from, Color to, double t) {
  const auto channel = [t](uint8_t a, uint8_t b) {
    return static_cast<uint8_t>(std::lround(a + std::clamp(t, 0.0, 1.0) * (b - a)));
  };
  return {channel(from.r, to.r), channel(from.g, to.g), channel(from.b, to.b)};
}

/// The ends of Turbo are too dark on a dark page.
Color bright_turbo(double t) { return turbo(0.08 + 0.84 * std::clamp(t, 0.0, 1.0)); }
Color turbo_back(double t) { return turbo(1.0 - t); }
/// The end of Viridis is too bright on a white page.
Color dark_viridis(double t) { return viridis(0.9 * std::clamp(t, 0.0, 1.0)); }
Color dark_viridis_back(double t) { return dark_viridis(1.0 - t); }
/// From blue over grey to orange: hues that all common kinds of colour blindness keep apart.
Color blue_to_orange(double t) {
  constexpr Color blue{0, 84, 166}, grey{150, 150, 150}, orange{222, 96, 0};
  return t < 0.5 ? between(blue, grey, 2.0 * t) : between(grey, orange, 2.0 * t - 1.0);
}

constexpr Color dark_series[] = {{255, 166, 64},  {86, 180, 233}, {120, 220, 130}, {240, 110, 150},
                                 {190, 150, 255}, {240, 228, 90}, {110, 220, 215}, {215, 140, 100}};
constexpr Color light_series[] = {{0, 114, 178},   {213, 94, 0},   {0, 158, 115}, {204, 121, 167},
                                  {120, 120, 120}, {86, 180, 233}, {230, 159, 0}, {90, 40, 110}};
/// 0 is nothing; then three times the eight hues of the lines and one brown: as they are, light, dark.
constexpr Color light_ids[] = {
    {235, 237, 240}, {0, 114, 178},   {230, 159, 0},   {0, 158, 115},   {204, 121, 167},
    {213, 94, 0},    {86, 180, 233},  {140, 105, 70},  {150, 150, 150}, {153, 199, 224},
    {247, 217, 153}, {153, 216, 199}, {235, 201, 220}, {238, 191, 153}, {187, 225, 246},
    {209, 195, 181}, {208, 208, 208}, {0, 57, 89},     {115, 80, 0},    {0, 79, 58},
    {102, 60, 84},   {107, 47, 0},    {43, 90, 116},   {70, 52, 35},    {75, 75, 75}};

/// The table: a line for each purpose, dark and light.
struct Row {
  Color dark, light;
};
constexpr Row page{{17, 19, 24}, {255, 255, 255}}, panel{{26, 29, 36}, {250, 250, 251}},
    border{{62, 67, 78}, {120, 124, 132}}, grid{{44, 48, 58}, {218, 221, 226}},
    text{{226, 230, 238}, {17, 19, 24}}, dim{{150, 157, 170}, {84, 90, 102}},
    sky{{48, 52, 62}, {228, 232, 238}}, outline{{112, 120, 136}, {146, 150, 158}},
    detection{{255, 92, 92}, {255, 92, 92}}, false_alarm{{170, 176, 188}, {170, 176, 188}},
    truth{{255, 255, 255}, {255, 255, 255}}, over{{238, 241, 246}, {238, 241, 246}},
    halo{{12, 13, 17}, {12, 13, 17}};

Theme make(bool is_dark) {
  const auto pick = [is_dark](const Row& row) { return is_dark ? row.dark : row.light; };
  Theme theme{};
  theme.name = is_dark ? "dark" : "light";
  theme.page = pick(page), theme.panel = pick(panel), theme.border = pick(border), theme.grid = pick(grid);
  theme.text = pick(text), theme.dim = pick(dim), theme.sky = pick(sky), theme.outline = pick(outline);
  theme.detection = pick(detection), theme.false_alarm = pick(false_alarm), theme.truth = pick(truth);
  theme.over = pick(over), theme.halo = pick(halo);
  theme.heights = is_dark ? bright_turbo : dark_viridis;
  theme.depths = is_dark ? turbo_back : dark_viridis_back;
  theme.power = viridis;
  theme.velocities = is_dark ? bright_turbo : blue_to_orange;
  theme.series = is_dark ? std::span<const Color>(dark_series) : std::span<const Color>(light_series);
  if (!is_dark) theme.ids = light_ids;
  return theme;
}

}  // namespace

const Theme& dark_theme() {
  static const Theme theme = make(true);
  return theme;
}

const Theme& light_theme() {
  static const Theme theme = make(false);
  return theme;
}

const Theme* theme_called(std::string_view name) {
  for (const Theme* theme : {&dark_theme(), &light_theme()})
    if (name == theme->name) return theme;
  return nullptr;
}

Color turbo(double t) {
  static constexpr double c[6][3] = {
      {0.13572138, 0.09140261, 0.10667330},      {4.61539260, 2.19418839, 12.64194608},
      {-42.66032258, 4.84296658, -60.58204836},  {132.13108234, -14.18503333, 110.36276771},
      {-152.94239396, 4.27729857, -89.90310912}, {59.28637943, 2.82956604, 27.34824973}};
  return polynomial(c, t);
}

Color viridis(double t) {
  static constexpr double c[7][3] = {
      {0.2777273272, 0.0054073445, 0.3340998053},   {0.1050930431, 1.4046135299, 1.3845901626},
      {-0.3308618287, 0.2148475595, 0.0950951630},  {-4.6342304990, -5.7991009734, -19.3324409563},
      {6.2282699363, 14.1799333668, 56.6905526007}, {4.7763849977, -13.7451453777, -65.3530326334},
      {-5.4354558559, 4.6458526122, 26.3124352496}};
  return polynomial(c, t);
}

Color color_of_id(uint32_t id) {
  if (id == 0) return {40, 43, 50};
  // Steps of the golden ratio around the circle of hues separate the hues of successive ids. Saturation and
  // value vary slowly.
  const double hue = std::fmod(id * 0.6180339887498949, 1.0);
  return from_hsv(hue, 0.45 + 0.15 * ((id / 3) % 3), 0.95 - 0.18 * ((id / 7) % 3));
}

Color color_of_id(const Theme& theme, uint32_t id) {
  if (theme.ids.empty()) return color_of_id(id);
  return id == 0 ? theme.ids[0] : theme.ids[1 + (id - 1) % (theme.ids.size() - 1)];
}

Color color_of_series(size_t n) { return dark_series[n % std::size(dark_series)]; }
Color color_of_series(const Theme& theme, size_t n) { return theme.series[n % theme.series.size()]; }

}  // namespace greatx::io
