// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/rf/search_scenes.h"

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "rf/geometry/geometry.h"
#include "rf/reference/comparison.h"
#include "rf/reference/exhaustive_paths.h"
#include "rf/reference/occluders.h"

namespace greatx::rf::testing {

namespace {

using reference::Stretch;
using Links = std::vector<std::vector<GeometricPath>>;

const std::vector<Pose> at_rest{Pose{}};

/// Returns whether `path` passes all occluders within the budget of walls. On success the walls that it
/// passes are among its interactions and vertices.
bool pass(const reference::Occluders& occluders, const SearchScene& scene, GeometricPath& path) {
  const size_t reflections = path.interactions.size();
  if (reflections > scene.depth) return false;
  uint32_t budget = std::min(scene.walls, scene.depth - static_cast<uint32_t>(reflections));
  GeometricPath whole;
  for (size_t i = 0; i <= reflections; ++i) {
    Stretch stretch{path.vertices[i], path.vertices[i + 1]};
    if (i > 0) stretch.facet_a = path.interactions[i - 1].element;
    if (i < reflections) stretch.facet_b = path.interactions[i].element;
    std::vector<reference::WallPassed> walls;
    if (!occluders.free_but_for(stretch, budget, walls)) return false;
    budget -= static_cast<uint32_t>(walls.size());
    whole.vertices.push_back(stretch.a);
    for (const reference::WallPassed& wall : walls) {
      whole.vertices.push_back(stretch.a + wall.t * (stretch.b - stretch.a));
      whole.interactions.push_back({InteractionType::transmission, wall.facet});
    }
    if (i < reflections) whole.interactions.push_back(path.interactions[i]);
  }
  whole.vertices.push_back(path.vertices.back());
  whole.length_m = path.length_m;
  path = std::move(whole);
  return true;
}

void expect_found(const Links& reference, const Links& found, const std::string& name) {
  reference::Comparison comparison(8);
  for (uint32_t r = 0; r < found.size(); ++r)
    comparison.add(r, reference::polylines(reference[r]), reference::polylines(found[r]));
  for (const auto& mismatch : comparison.mismatches()) {
    const bool missing = mismatch.fault == reference::Comparison::Fault::missing;
    const GeometricPath& path = (missing ? reference : found)[mismatch.receiver][mismatch.path];
    std::string text;
    for (const Interaction& i : path.interactions) text += fmt::format(" {} {}", name_of(i.type), i.element);
    ADD_FAILURE() << name << ", receiver " << mismatch.receiver << ", "
                  << (missing                                                   ? "missing:"
                      : mismatch.fault == reference::Comparison::Fault::doubled ? "doubled:"
                                                                                : "extra:")
                  << text << ", " << path.length_m << " m";
  }
}

void expect_same_bits(const Links& a, const Links& b, const std::string& name) {
  ASSERT_EQ(a.size(), b.size()) << name;
  for (size_t r = 0; r < a.size(); ++r) {
    ASSERT_EQ(a[r].size(), b[r].size()) << name << ", receiver " << r;
    for (size_t i = 0; i < a[r].size(); ++i)
      EXPECT_TRUE(a[r][i].interactions == b[r][i].interactions && a[r][i].vertices == b[r][i].vertices &&
                  a[r][i].length_m == b[r][i].length_m)
          << name << ", receiver " << r << ", path " << i;
  }
}

}  // namespace

FacetKinds SearchScene::facet_kinds() const {
  return kinds.empty() ? FacetKinds(scene().facets.size(), FacetKind::opaque) : kinds;
}

std::vector<dvec3> SearchScene::points() const {
  std::vector<dvec3> list = receivers;
  RandomStream random(11, 0x62656d73u);
  for (uint32_t i = 0; i < drawn; ++i) {
    const double x = random.uniform(low.x, high.x), y = random.uniform(low.y, high.y);
    list.push_back({x, y, random.uniform(low.z, high.z)});
  }
  return list;
}

BeamSearchOptions SearchScene::options() const {
  BeamSearchOptions options;
  options.max_depth = depth;
  options.max_transmissions = walls;
  return options;
}

void SearchScene::box(const dvec3& l, const dvec3& h) {
  hand.quad({l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, {l.x, h.y, l.z});
  hand.quad({h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z}, {h.x, l.y, h.z});
  hand.quad({l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z});
  hand.quad({l.x, h.y, l.z}, {l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z});
  hand.quad({l.x, l.y, l.z}, {l.x, h.y, l.z}, {h.x, h.y, l.z}, {h.x, l.y, l.z});
  hand.quad({l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z});
}

Links solve(const SearchScene& scene, const CandidateList& list) {
  const FacetWorld world(scene.scene());
  const FacetKinds kinds = scene.facet_kinds();
  const reference::Occluders occluders(scene.scene(), world, at_rest, kinds);
  const ImageTree tree(world, scene.source, list);
  Links links;
  for (const dvec3& receiver : scene.points()) {
    std::vector<GeometricPath> lit;
    for (GeometricPath& path : tree.solve(receiver))
      if (pass(occluders, scene, path)) lit.push_back(std::move(path));
    std::stable_sort(lit.begin(), lit.end(), [](const GeometricPath& a, const GeometricPath& b) {
      return interactions_less(a.interactions, b.interactions);
    });
    links.push_back(std::move(lit));
  }
  return links;
}

std::vector<size_t> expect_perfect(const SearchScene& scene, const std::string& name) {
  const FacetWorld world(scene.scene());
  const FacetKinds kinds = scene.facet_kinds();
  const Links reference =
      reference::exhaustive_paths(scene.scene(), world, at_rest, kinds, scene.source, scene.points(),
                                  {.max_depth = scene.depth, .max_transmissions = scene.walls})
          .paths;
  BeamSearchOptions options = scene.options();
  for (const double clearance : {options.clearance_m, 0.0}) {
    const std::string which = fmt::format("{}, clearance {} m", name, clearance);
    options.clearance_m = clearance;
    options.threads = 1;
    const BeamSearchResult one = BeamSearch(world, kinds, {}, options).search(scene.source);
    options.threads = 2;
    const BeamSearchResult two = BeamSearch(world, kinds, {}, options).search(scene.source);
    EXPECT_TRUE(one.list == two.list) << which;
    EXPECT_EQ(one.overflow(), 0u) << which;
    EXPECT_TRUE(one.list.is_canonical()) << which;
    const Links found = solve(scene, one.list);
    expect_found(reference, found, which);
    CandidateList unbounded = one.list;
    unbounded.windows.clear();
    expect_same_bits(found, solve(scene, unbounded), which + ", without windows");
  }
  std::vector<size_t> counts(scene.depth + 1);
  for (const auto& link : reference)
    for (const GeometricPath& path : link) ++counts[path.interactions.size()];
  return counts;
}

}  // namespace greatx::rf::testing
