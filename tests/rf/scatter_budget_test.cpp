// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that scatterings which are drawn within a budget have the power of all patches: in closed form on a
// plate, and over many seeds where walls hide some.
#include <algorithm>
#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "rf/channel/statistics.h"
#include "rf/paths/scatter_draw.h"
#include "tests/rf/scattering_links.h"

namespace greatx::rf {
namespace {

using namespace testing;

/// A plate of 40 m by 20 m in the plane x = 0.
TinyScene plate(ScatteringPattern pattern = ScatteringPattern::lambertian) {
  TinyScene tiny = rough_materials(pattern);
  tiny.object("plate", 0, 1).quad({0, -20, 0}, {0, 20, 0}, {0, 20, 20}, {0, -20, 20});
  return tiny;
}

size_t scatterings(const std::vector<GeometricPath>& paths) {
  return static_cast<size_t>(
      std::ranges::count_if(paths, [](const GeometricPath& path) { return scatters(path.interactions); }));
}

bool same_draws(const std::vector<Path>& a, const std::vector<Path>& b) {
  return std::ranges::equal(a, b, [](const Path& p, const Path& q) {
    return p.interactions == q.interactions && p.vertices == q.vertices && p.length_m == q.length_m &&
           p.patch_area_m2 == q.patch_area_m2 && p.stratum == q.stratum &&
           std::ranges::equal(p.transfer, q.transfer);
  });
}

TEST(ScatterBudget, APatchIsWeighedByThePowerThatItsFieldHas) {
  // S^2 Gamma^2 f_s cos(theta_i) dA/(s' s)^2, the mean over the polarization that is sent.
  for (const ScatteringPattern pattern :
       {ScatteringPattern::lambertian, ScatteringPattern::directive, ScatteringPattern::backscattering}) {
    const scene::Scene scene = plate(pattern).build();
    const dvec3 source(7, -3, 4), target(11, 9, 13);
    const Links links(scene, source, {.max_depth = 1, .patch_m = 5.0});
    const PosedFacet& facet = links.model().facets.facet(0);
    for (const Path& path : links.unhidden(target)) {
      if (!scatters(path.interactions)) continue;
      const dvec3 in = glm::normalize(path.vertices[1] - source);
      LitPatch patch{.position = path.vertices[1], .normal = dvec3(1, 0, 0)};
      patch.surface = &links.model().surfaces.surface(facet.material).scattering;
      patch.specular = in - 2.0 * in.x * dvec3(1, 0, 0);
      const ReflectionCoefficients r =
          links.model().surfaces.reflect(facet.material, facet.normal.x > 0.0, -in.x);
      const double before_m = glm::length(path.vertices[1] - source);
      patch.power = 0.16 * 0.5 * (std::norm(r.r_te) + std::norm(r.r_tm)) * -in.x * path.patch_area_m2 /
                    (before_m * before_m);
      const double after_m = glm::length(target - path.vertices[1]);
      const double weight = scattered_power(patch, (target - path.vertices[1]) / after_m, after_m);
      EXPECT_NEAR(weight / power_of(path), 1.0, 1e-9);
    }
  }
}

TEST(ScatterBudget, DrawsFromAPlateHaveThePowerOfTheIntegral) {
  const scene::Scene scene = plate().build();
  const dvec3 source(9, -4, 6), target(6, 8, 11);
  // The integral of S^2 Gamma^2 cos(theta_i) cos(theta_s)/pi/(s' s)^2 by the midpoint rule.
  const Links links(scene, source, {.max_depth = 1, .patch_m = 0.5, .scattering_budget = 300});
  const PosedFacet& facet = links.model().facets.facet(0);
  double integral = 0.0;
  constexpr double step = 0.1;
  for (double y = -20.0 + 0.5 * step; y < 20.0; y += step)
    for (double z = 0.5 * step; z < 20.0; z += step) {
      const dvec3 point(0, y, z), in = point - source, out = target - point;
      const double cos_in = -in.x / glm::length(in), cos_out = out.x / glm::length(out);
      const ReflectionCoefficients r =
          links.model().surfaces.reflect(facet.material, facet.normal.x > 0.0, cos_in);
      integral += 0.16 * 0.5 * (std::norm(r.r_te) + std::norm(r.r_tm)) * cos_in * cos_out / pi * step * step /
                  (glm::dot(in, in) * glm::dot(out, out));
    }
  EXPECT_LE(scatterings(links.geometry(target)), 300u);
  EXPECT_GT(scattering_patches(scene, links.model().kinds, 0.5).size(), 5000u);
  EXPECT_NEAR(scattered(links.unhidden(target)) / integral, 1.0, 0.01);
}

TEST(ScatterBudget, TheProfileOfDelaysIsThatOfAllPatches) {
  TinyScene tiny = rough_materials(ScatteringPattern::lambertian);
  tiny.object("ground", 0, 1).quad({-90, -90, 0}, {90, -90, 0}, {90, 90, 0}, {-90, 90, 0});
  const scene::Scene scene = tiny.build();
  const dvec3 source(0, 0, 20), target(30, 10, 2);
  const auto profile = [&](uint32_t budget) {
    const Links links(scene, source, {.max_depth = 1, .patch_m = 2.0, .scattering_budget = budget});
    std::map<int64_t, double> bins;
    for (const Path& path : links.unhidden(target))
      if (scatters(path.interactions))
        bins[static_cast<int64_t>(path.length_m / delay_bin_m)] += power_of(path);
    return bins;
  };
  const auto all = profile(0), drawn = profile(1000);
  double total = 0.0;
  for (const auto& [bin, power] : all) total += power;
  for (const auto& [bin, power] : all) {
    if (power < 0.01 * total) continue;
    ASSERT_TRUE(drawn.contains(bin)) << bin;
    EXPECT_NEAR(10.0 * std::log10(drawn.at(bin) / power), 0.0, 0.5) << bin;
  }
}

TEST(ScatterBudget, ABudgetForAllPatchesChangesNoBit) {
  const scene::Scene scene = yard().build();
  Obstacles obstacles(scene);
  const dvec3 source(1, -9, 3), target(7, 14, 2);
  for (const uint32_t after : {0u, 1u}) {
    const auto solve = [&](uint32_t budget) {
      return Links(scene, source,
                   {.max_depth = 2,
                    .max_reflections_after = after,
                    .patch_m = 4.0,
                    .scattering_budget = budget})
          .lit(target, obstacles);
    };
    const std::vector<Path> all = solve(0);
    EXPECT_GT(all.size(), 100u);
    EXPECT_TRUE(same_draws(all, solve(1'000'000)));
  }
}

TEST(ScatterBudget, TheMeanOverSeedsIsThePowerOfAllPatches) {
  constexpr uint64_t seeds = 500;
  const scene::Scene scene = yard().build();
  Obstacles obstacles(scene);
  const dvec3 source(1, -9, 3), target(7, 14, 2);
  for (const uint32_t after : {0u, 1u}) {
    PathLimits limits{.max_depth = 2, .max_reflections_after = after, .patch_m = 4.0};
    const double all = scattered(Links(scene, source, limits).lit(target, obstacles));
    limits.scattering_budget = 60;
    double sum = 0.0, squares = 0.0, variances = 0.0;
    for (uint64_t seed = 1; seed <= seeds; ++seed) {
      const std::vector<Path> paths = Links(scene, source, limits, seed).lit(target, obstacles);
      std::vector<double> powers;
      for (const Path& path : paths) powers.push_back(power_of(path));
      const double power = scattered(paths) / all, deviation = drawn_deviation(paths, powers) / all;
      sum += power, squares += power * power, variances += deviation * deviation;
    }
    const double mean = sum / seeds, variance = squares / seeds - mean * mean;
    // Four standard errors: a right program fails for one choice of the seeds in 16,000, and these are fixed.
    EXPECT_NEAR(mean, 1.0, 4.0 * std::sqrt(variance / seeds)) << after;
    EXPECT_LT(std::sqrt(variance), 0.5) << after;
    EXPECT_GT(variances / seeds, 0.8 * variance) << "the reported variance is too small on average";
  }
}

TEST(ScatterBudget, NoLinkHasMoreScatteringsThanItsBudget) {
  const scene::Scene scene = yard().build();
  for (const uint32_t budget : {1u, 2u, 3u, 5u, 17u, 60u, 200u})
    for (const uint32_t after : {0u, 1u}) {
      const Links links(
          scene, {1, -9, 3},
          {.max_depth = 2, .max_reflections_after = after, .patch_m = 2.0, .scattering_budget = budget});
      for (const dvec3& target : {dvec3(7, 14, 2), dvec3(-20, -20, 1), dvec3(1, -9, 3.001)}) {
        const size_t count = scatterings(links.geometry(target));
        EXPECT_LE(count, budget);
        EXPECT_GE(count, std::max(1u, budget / 3));
      }
    }
}

TEST(ScatterBudget, NothingIsDrawnWhereNothingScatters) {
  TinyScene smooth = rough_materials(ScatteringPattern::lambertian);
  smooth.object("plate", 0, 2).quad({0, -20, 0}, {0, 20, 0}, {0, 20, 20}, {0, -20, 20});
  const scene::Scene bare = smooth.build(), rough = plate().build();
  const PathLimits limits{.max_depth = 1, .patch_m = 1.0, .scattering_budget = 50};
  EXPECT_EQ(scatterings(Links(bare, {5, 0, 5}, limits).geometry({6, 3, 4})), 0u);
  // Behind the plate, and in its plane.
  EXPECT_EQ(scatterings(Links(rough, {5, 0, 5}, limits).geometry({-6, 3, 4})), 0u);
  EXPECT_EQ(scatterings(Links(rough, {5, 0, 5}, limits).geometry({0, 30, 4})), 0u);
  EXPECT_GT(scatterings(Links(rough, {5, 0, 5}, limits).geometry({6, 3, 4})), 20u);
}

TEST(ScatterBudget, DrawsDependOnTheLinkAloneAndStayWhenTheTargetMovesALittle) {
  const scene::Scene scene = yard().build();
  const Links links(scene, {1, -9, 3}, {.max_depth = 2, .patch_m = 1.0, .scattering_budget = 200});
  const auto chains = [](const std::vector<GeometricPath>& paths) {
    std::vector<std::vector<Interaction>> all;
    for (const GeometricPath& path : paths)
      if (scatters(path.interactions)) all.push_back(path.interactions);
    return all;
  };
  const dvec3 target(7, 14, 2);
  const auto first = chains(links.geometry(target));
  (void)links.geometry({-9, 3, 1});
  EXPECT_EQ(first, chains(links.geometry(target, 4)));
  const auto moved = chains(links.geometry(target + dvec3(0.02, 0.01, 0)));
  std::vector<std::vector<Interaction>> same;
  std::ranges::set_intersection(first, moved, std::back_inserter(same));
  EXPECT_GT(static_cast<double>(same.size()), 0.75 * static_cast<double>(first.size()));
  const auto other =
      chains(Links(scene, {1, -9, 3}, {.max_depth = 2, .patch_m = 1.0, .scattering_budget = 200}, 2)
                 .geometry(target));
  EXPECT_NE(first, other) << "another seed";
}

TEST(ScatterBudget, BothDirectionsOfALinkDrawTheSame) {
  const scene::Scene scene = yard().build();
  Obstacles obstacles(scene);
  const PathLimits limits{.max_depth = 2, .patch_m = 2.0, .scattering_budget = 80};
  const dvec3 source(1, -9, 3), target(7, 14, 2);
  std::vector<Path> down = Links(scene, source, limits).lit(target, obstacles);
  std::vector<Path> up = Links(scene, source, limits, 1, Source::receiver).lit(target, obstacles);
  ASSERT_EQ(down.size(), up.size());
  for (Path& path : up) std::ranges::reverse(path.interactions);
  const auto less = [](const Path& a, const Path& b) {
    return interactions_less(a.interactions, b.interactions);
  };
  std::ranges::sort(up, less);
  for (size_t i = 0; i < up.size(); ++i) {
    EXPECT_EQ(down[i].interactions, up[i].interactions);
    EXPECT_EQ(down[i].patch_area_m2, up[i].patch_area_m2);
    EXPECT_NEAR(power_of(down[i]), power_of(up[i]), 1e-12 * power_of(up[i]));
  }
}

TEST(ScatterBudget, ABodyThatHidesAPatchNowLeavesItInTheDraw) {
  TinyScene tiny = plate();
  const uint32_t van = tiny.body("van");
  tiny.object("van", van, 2).box({2, -15, 0}, {3, 15, 19});
  const scene::Scene with_van = tiny.build(), without = plate().build();
  const PathLimits limits{.max_depth = 1, .patch_m = 1.0, .scattering_budget = 100};
  const auto facets_of = [](const std::vector<GeometricPath>& paths) {
    std::vector<uint32_t> patches;
    for (const GeometricPath& path : paths)
      if (scatters(path.interactions)) patches.push_back(path.interactions[0].patch);
    return patches;
  };
  const dvec3 source(9, 0, 9), target(8, 5, 3);
  const auto hidden = facets_of(Links(with_van, source, limits).geometry(target));
  EXPECT_EQ(hidden, facets_of(Links(without, source, limits).geometry(target)));
  EXPECT_GT(hidden.size(), 50u);
}

}  // namespace
}  // namespace greatx::rf
