// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/box_tree.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/random.h"

namespace greatx::scene {
namespace {

std::vector<Bounds> random_boxes(size_t count) {
  RandomStream random(7, 1, 0);
  std::vector<Bounds> boxes(count);
  for (Bounds& box : boxes) {
    const dvec3 corner(100.0 * random.uniform(), 100.0 * random.uniform(), 10.0 * random.uniform());
    box.add(corner);
    box.add(corner + dvec3(3.0 * random.uniform(), 3.0 * random.uniform(), 0.0));
  }
  return boxes;
}

TEST(BoxTree, GathersAllThatIsNotOutsideAndLittleElse) {
  for (const size_t count : {1u, 4u, 5u, 1000u}) {
    const std::vector<Bounds> boxes = random_boxes(count);
    const BoxTree tree(boxes);
    EXPECT_FALSE(tree.empty());
    for (const double x : {-1.0, 20.0, 50.0, 200.0}) {
      const auto outside = [&](const Bounds& box) { return box.max.x < x - 2.0 || box.min.x > x + 2.0; };
      std::vector<uint32_t> found{~0u};
      tree.gather(outside, found);
      EXPECT_EQ(found[0], ~0u) << "what was there stays in front";
      EXPECT_TRUE(std::is_sorted(found.begin() + 1, found.end()));
      size_t expected = 0;
      for (uint32_t i = 0; i < count; ++i) {
        if (outside(boxes[i])) continue;
        ++expected;
        EXPECT_TRUE(std::binary_search(found.begin() + 1, found.end(), i)) << i;
      }
      if (count == 1000) {
        EXPECT_LE(found.size() - 1, 2 * expected + 8);
      }
    }
  }
}

TEST(BoxTree, EndsWhereAVisitSaysSo) {
  const std::vector<Bounds> boxes = random_boxes(100);
  const auto nowhere = [](const Bounds&) { return false; };
  size_t visits = 0;
  EXPECT_TRUE(BoxTree(boxes).visit_until(nowhere, [&](uint32_t) { return ++visits == 7; }));
  EXPECT_EQ(visits, 7u);
  EXPECT_FALSE(BoxTree(boxes).visit_until(nowhere, [](uint32_t) { return false; }));
  EXPECT_TRUE(BoxTree().empty() && BoxTree(std::span<const Bounds>()).empty());
  EXPECT_FALSE(BoxTree().visit_until(nowhere, [](uint32_t) { return true; }));
}

}  // namespace
}  // namespace greatx::scene
