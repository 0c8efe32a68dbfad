// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/paint/lettering.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"

namespace greatx::scene::generator {

namespace {

/// The strokes of A to Z, then 0 to 9. A stroke is a chain of points: each is a column (0 to 4) and a row (0
/// to 6 from above). A blank separates strokes.
constexpr std::array<std::string_view, 36> glyphs{"062046 1434",
                                                  "060030414233 0333444536 0636",
                                                  "4130100105163645",
                                                  "06002042442606",
                                                  "40000646 0333",
                                                  "400006 0333",
                                                  "41301001051636454323",
                                                  "0006 4046 0343",
                                                  "2026",
                                                  "4045361605",
                                                  "0006 4003 1346",
                                                  "000646",
                                                  "0600234046",
                                                  "06004640",
                                                  "103041453616050110",
                                                  "06003041423303",
                                                  "103041453616050110 3446",
                                                  "06003041423303 2346",
                                                  "413010010213334445361605",
                                                  "0040 2026",
                                                  "000516364540",
                                                  "002640",
                                                  "0016233640",
                                                  "0046 4006",
                                                  "002340 2326",
                                                  "00400646",
                                                  "103041453616050110 4105",
                                                  "112026",
                                                  "01103041420646",
                                                  "01103041423323 3344453616 1605",
                                                  "36300444",
                                                  "40000213334445361605",
                                                  "413010010516364544330304",
                                                  "004016",
                                                  "1030414233130201 0110 33444536160504 0413",
                                                  "051636454130100102133343"};

size_t glyph_number(char letter) {
  if (letter >= 'A' && letter <= 'Z') return static_cast<size_t>(letter - 'A');
  GREATX_CHECK(letter >= '0' && letter <= '9', "no glyph for the character {}", static_cast<int>(letter));
  return static_cast<size_t>(26 + letter - '0');
}

/// A point in sixteenths of a pixel.
struct Spot {
  int64_t x = 0, y = 0;
};

/// Returns whether p lies within `reach` of the stroke from a to b, all in sixteenths of a pixel.
bool covers(const Spot& a, const Spot& b, const Spot& p, int64_t reach) {
  const int64_t dx = b.x - a.x, dy = b.y - a.y, px = p.x - a.x, py = p.y - a.y;
  const int64_t length2 = dx * dx + dy * dy, along = px * dx + py * dy;
  if (along <= 0) return px * px + py * py <= reach * reach;
  if (along >= length2) {
    const int64_t qx = p.x - b.x, qy = p.y - b.y;
    return qx * qx + qy * qy <= reach * reach;
  }
  const int64_t across = px * dy - py * dx;
  return across * across <= reach * reach * length2;
}

/// The strokes of one glyph at its place, as pairs of ends.
using Strokes = std::vector<std::pair<Spot, Spot>>;

Strokes strokes_of(char letter, int x, int y, int height) {
  Strokes strokes;
  const std::string_view chains = glyphs[glyph_number(letter)];
  const auto spot = [&](size_t i) {
    return Spot{16 * x + 16 * height * (chains[i] - '0') / 6,
                16 * y + 16 * height * (chains[i + 1] - '0') / 6};
  };
  std::optional<Spot> last;
  for (size_t i = 0; i < chains.size();) {
    if (chains[i] == ' ') {
      last.reset();
      ++i;
      continue;
    }
    const Spot here = spot(i);
    if (last) strokes.emplace_back(*last, here);
    last = here;
    i += 2;
  }
  return strokes;
}

void write_glyph(char letter, int x, int y, int height, int thick, const InkPixel& ink) {
  const Strokes strokes = strokes_of(letter, x, y, height);
  for (int py = y - thick; py <= y + height + thick; ++py)
    for (int px = x - thick; px <= x + height * 4 / 6 + thick; ++px) {
      int share = 0;  // of 4 x 4 samples
      for (int sample = 0; sample < 16; ++sample) {
        const Spot p{16 * px + 4 * (sample % 4) + 2, 16 * py + 4 * (sample / 4) + 2};
        share += std::any_of(strokes.begin(), strokes.end(), [&](const auto& stroke) {
          return covers(stroke.first, stroke.second, p, 8 * thick);
        });
      }
      if (share > 0) ink(px, py, share);
    }
}

/// Returns the distance between the left edges of two letters.
int advance_of(char letter, int height) { return height * (letter == ' ' || letter == 'I' ? 4 : 6) / 6; }

}  // namespace

int text_width(std::string_view text, int height) {
  int width = 0;
  for (const char letter : text) width += advance_of(letter, height);
  return width;
}

void write_text(std::string_view text, int x, int y, int height, int thick, const InkPixel& ink) {
  for (const char letter : text) {
    // An I stands in the middle of the grid, but takes less room.
    if (letter != ' ') write_glyph(letter, letter == 'I' ? x - height / 6 : x, y, height, thick, ink);
    x += advance_of(letter, height);
  }
}

}  // namespace greatx::scene::generator
