// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The grid of contact sheets and animations, for many numbers of panels, keys, moments and plots.
#include "draw/sheet/sheet_layout.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace greatx::io {
namespace {

struct NamedRect {
  std::string name;
  Rect rect;
};

std::vector<NamedRect> rects_of(const SheetLayout& layout) {
  std::vector<NamedRect> rects;
  const auto add = [&](std::string name, const Rect& rect) {
    if (rect.width > 0 && rect.height > 0) rects.push_back({std::move(name), rect});
  };
  add("header", layout.header);
  for (size_t t = 0; t < layout.tiles.size(); ++t) {
    const SheetLayout::Tile& tile = layout.tiles[t];
    add(fmt::format("title {}", t), tile.title);
    add(fmt::format("key {}", t), tile.key);
    for (size_t m = 0; m < tile.pictures.size(); ++m) {
      // The frame of a picture is one pixel around it.
      const Rect& p = tile.pictures[m];
      add(fmt::format("picture {} {}", t, m), {p.x - 1, p.y, p.width + 2, p.height + 1});
      add(fmt::format("legend {} {}", t, m), tile.legends[m]);
    }
  }
  for (size_t i = 0; i < layout.plots.size(); ++i) {
    add(fmt::format("plot title {}", i), layout.plots[i].title);
    add(fmt::format("plot {}", i), layout.plots[i].area);
  }
  for (size_t b = 0; b < layout.times.size(); ++b)
    for (size_t m = 0; m < layout.times[b].size(); ++m)
      add(fmt::format("time {} {}", b, m), layout.times[b][m]);
  return rects;
}

/// Returns what is wrong with a layout; empty: nothing.
std::string fault_of(const SheetLayout& layout) {
  const std::vector<NamedRect> rects = rects_of(layout);
  const Rect page{0, 0, layout.width, layout.height};
  for (size_t i = 0; i < rects.size(); ++i) {
    if (!page.contains(rects[i].rect)) return rects[i].name + " is not inside";
    for (size_t j = i + 1; j < rects.size(); ++j)
      if (rects[i].rect.overlaps(rects[j].rect)) return rects[i].name + " overlaps " + rects[j].name;
  }
  return {};
}

LayoutWish wish_of(uint64_t seed, size_t panels, size_t plots, bool animation) {
  LayoutWish wish;
  RandomStream random(seed, 1);
  for (size_t i = 0; i < panels; ++i) {
    // Pictures from 1 x 4000 to 4000 x 1, and common ones.
    const double aspects[] = {1.0 / 4000, 0.5, 0.75, 1.0, 4000.0};
    wish.aspects.push_back(aspects[random.below(5)]);
    wish.key_lines.push_back(random.below(10));
  }
  wish.moments = animation ? 1 : std::min<size_t>(moments_for(panels), 1 + random.below(4));
  wish.plots = plots;
  wish.header = animation ? 84 : 74;
  wish.animation = animation;
  wish.least_columns = animation ? 1 : 3;
  return wish;
}

TEST(SheetLayout, NothingOverlapsAndEverythingIsInside) {
  for (const bool animation : {false, true})
    for (size_t panels = 0; panels <= 40; ++panels)
      for (size_t plots = 0; plots <= 9; ++plots) {
        if (animation && panels == 0) continue;
        const LayoutWish wish = wish_of(panels * 10 + plots, panels, plots, animation);
        const SheetLayout layout = sheet_layout(wish);
        ASSERT_EQ(fault_of(layout), "") << panels << " panels, " << plots << " plots, " << animation;
        ASSERT_EQ(layout.tiles.size(), panels);
        ASSERT_EQ(layout.plots.size(), plots);
        ASSERT_EQ(layout.width % 2 + layout.height % 2, 0);
        for (size_t i = 0; i < panels; ++i)
          ASSERT_EQ(layout.tiles[i].key.height, static_cast<int>(wish.key_lines[i]) * 22);
      }
}

/// One, three and six cameras with three pictures each, beside LiDAR, radar, channel and poses.
TEST(SheetLayout, CamerasLeaveRoomForAllOtherSensors) {
  for (const size_t cameras : {1, 3, 6, 12}) {
    const size_t panels = 3 * cameras + 4;
    LayoutWish wish = wish_of(1, panels, 5, false);
    wish.moments = moments_for(panels);
    const SheetLayout sheet = sheet_layout(wish);
    EXPECT_EQ(sheet.plots.size(), 5u);
    size_t rows = 0;
    for (const auto& band : sheet.times) rows += band.size();
    EXPECT_LE(rows, sheet::most_rows);
    EXPECT_GE(rows, 4u);
    EXPECT_EQ(sheet_layout(wish_of(1, panels, 5, true)).plots.size(), 5u);
  }
}

TEST(SheetLayout, FewPanelsKeepFourMoments) {
  for (size_t panels = 0; panels <= 12; ++panels) EXPECT_EQ(moments_for(panels), 4u) << panels;
  EXPECT_EQ(moments_for(24), 3u);
  EXPECT_EQ(moments_for(1000), 1u);
}

TEST(SheetLayout, APictureFitsItsTile) {
  const Rect tile{10, 20, 400, 300};
  for (const double aspect : {0.0, 1e-9, 1.0 / 4000, 0.3, 0.75, 1.0, 3.0, 4000.0, 1e300}) {
    const Rect picture = fit(tile, aspect);
    EXPECT_TRUE(tile.contains(picture)) << aspect;
    EXPECT_GE(picture.width, 1);
    EXPECT_GE(picture.height, 1);
  }
  const Rect square = fit(tile, 1.0);
  EXPECT_EQ(square.x, 60);
  EXPECT_EQ(square.width, 300);
  EXPECT_EQ(square.height, 300);
}

}  // namespace
}  // namespace greatx::io
