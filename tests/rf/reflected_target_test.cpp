// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that reflections behind a scattering which are drawn within a budget have the power of all of them:
// in closed form over a mirror, chain by chain where nearly all are drawn, and over many seeds in a corridor.
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

/// A corridor of rough walls, which are cut into pieces of 10 m, with a box that hides parts of them.
TinyScene corridor() {
  TinyScene tiny = rough_materials(ScatteringPattern::lambertian);
  const double a = 30.0, b = 2.3, c = 2.9;
  tiny.object("floor", 0, 1).quad({0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0});
  tiny.object("ceiling", 0, 1).quad({0, 0, c}, {0, b, c}, {a, b, c}, {a, 0, c});
  tiny.object("west", 0, 1).quad({0, 0, 0}, {0, b, 0}, {0, b, c}, {0, 0, c});
  tiny.object("east", 0, 1).quad({a, 0, 0}, {a, 0, c}, {a, b, c}, {a, b, 0});
  for (int i = 0; i < 3; ++i) {
    const double from = 10.0 * i, to = from + 10.0;
    const std::string number = std::to_string(i);
    tiny.object("south" + number, 0, 1).quad({from, 0, 0}, {from, 0, c}, {to, 0, c}, {to, 0, 0});
    tiny.object("north" + number, 0, 1).quad({from, b, 0}, {to, b, 0}, {to, b, c}, {from, b, c});
  }
  tiny.object("box", 0, 1).box({12, 0.5, 0}, {12.3, 1.2, 1.8});
  return tiny;
}

const dvec3 from(3, 1.2, 2.0);
const dvec3 places[] = {dvec3(17, 1.1, 1.5), dvec3(27, 2.0, 1.2)};

bool reflects_behind(const Path& path) {
  return scatters(path.interactions) && path.interactions.back().type == InteractionType::reflection;
}

TEST(ReflectedTarget, DrawsOverAMirrorHaveThePowerOfTheIntegralToTheImage) {
  TinyScene tiny = rough_materials(ScatteringPattern::lambertian);
  scene::Material metal;
  metal.name = "metal";
  metal.radio.emplace().layers.push_back({*scene::itu_medium("metal"), 0.0});
  tiny.material_as(metal);
  tiny.object("plate", 0, 1).quad({0, -20, 0}, {0, 20, 0}, {0, 20, 20}, {0, -20, 20});
  tiny.object("mirror", 0, 3).quad({15, -60, -40}, {15, -60, 60}, {15, 60, 60}, {15, 60, -40});
  const scene::Scene scene = tiny.build();
  const dvec3 source(9, -4, 6), target(6, 8, 11), image(24, 8, 11);
  const PathLimits limits{.max_depth = 2,
                          .max_reflections_after = 1,
                          .max_reflections_before_scattering = 0,
                          .patch_m = 0.25,
                          .scattering_budget = 4000};
  const Links links(scene, source, limits);
  const RadioModel& model = links.model();
  const PosedFacet& facet = model.facets.facet(0);
  // The integral of S^2 Gamma^2 cos(theta_i) cos(theta_s)/pi/(s' s)^2 by the midpoint rule, with the unfolded
  // way to the image. Metal reflects both polarizations whole, to 1e-3.
  double integral = 0.0;
  constexpr double step = 0.1;
  for (double y = -20.0 + 0.5 * step; y < 20.0; y += step)
    for (double z = 0.5 * step; z < 20.0; z += step) {
      const dvec3 point(0, y, z), in = point - source, out = image - point;
      const double cos_in = -in.x / glm::length(in), cos_out = out.x / glm::length(out);
      const ReflectionCoefficients r = model.surfaces.reflect(facet.material, facet.normal.x > 0.0, cos_in);
      integral += 0.16 * 0.5 * (std::norm(r.r_te) + std::norm(r.r_tm)) * cos_in * cos_out / pi * step * step /
                  (glm::dot(in, in) * glm::dot(out, out));
    }
  constexpr uint64_t seeds = 4;
  double power = 0.0;
  size_t count = 0;
  for (uint64_t seed = 1; seed <= seeds; ++seed)
    for (const Path& path : Links(scene, source, limits, seed).unhidden(target))
      if (reflects_behind(path)) power += power_of(path) / seeds, ++count;
  EXPECT_GT(count, seeds * 200u);
  EXPECT_LT(count, seeds * 4000u) << "fewer than there are patches";
  EXPECT_NEAR(power / integral, 1.0, 0.01);
}

TEST(ReflectedTarget, ABudgetOfNearlyAllChainsHasEveryOne) {
  const scene::Scene scene = corridor().build();
  Obstacles obstacles(scene);
  PathLimits limits{
      .max_depth = 3, .max_reflections_after = 1, .max_reflections_before_scattering = 1, .patch_m = 2.5};
  for (const dvec3& target : places) {
    const Links every(scene, from, limits);
    const std::vector<Path> all = every.lit(target, obstacles);
    limits.scattering_budget = 1'000'000;
    const size_t chains = static_cast<size_t>(std::ranges::count_if(
        Links(scene, from, limits).geometry(target), [](const auto& p) { return scatters(p.interactions); }));
    limits.scattering_budget =
        static_cast<uint32_t>(chains - 1);  // one too few for all, so that they are drawn
    const std::vector<Path> drawn = Links(scene, from, limits).lit(target, obstacles);
    limits.scattering_budget = 0;
    EXPECT_GT(chains, 2000u);
    EXPECT_GT(2 * drawn.size(), all.size());
    EXPECT_LT(drawn.size(), all.size());
    EXPECT_NEAR(scattered(drawn) / scattered(all), 1.0, 1e-3);
  }
}

TEST(ReflectedTarget, TheMeanOverSeedsIsThePowerOfAllChainsInEveryBin) {
  constexpr uint64_t seeds = 100;
  constexpr uint32_t bins = 6;
  const scene::Scene scene = corridor().build();
  Obstacles obstacles(scene);
  for (const uint32_t after : {1u, 2u, 3u}) {
    PathLimits limits{.max_depth = 4,
                      .max_reflections_after = after,
                      .max_reflections_before_scattering = 1,
                      .patch_m = 4.0};
    for (const dvec3& target : places) {
      const double direct_m = glm::distance(from, target);
      const auto bin_of = [&](const Path& path) {
        return std::min(bins - 1, static_cast<uint32_t>((path.length_m - direct_m) / delay_bin_m));
      };
      std::vector<double> all(bins + 1, 0.0), sum(bins + 1, 0.0), squares(bins + 1, 0.0);
      limits.scattering_budget = 0;
      for (const Path& path : Links(scene, from, limits).lit(target, obstacles))
        if (scatters(path.interactions)) all[bin_of(path)] += power_of(path), all[bins] += power_of(path);
      limits.scattering_budget = 300;
      double variances = 0.0;
      for (uint64_t seed = 1; seed <= seeds; ++seed) {
        const std::vector<Path> paths = Links(scene, from, limits, seed).lit(target, obstacles);
        std::vector<double> powers, of_seed(bins + 1, 0.0);
        for (const Path& path : paths) {
          powers.push_back(power_of(path));
          if (scatters(path.interactions))
            of_seed[bin_of(path)] += powers.back(), of_seed[bins] += powers.back();
        }
        for (uint32_t i = 0; i <= bins; ++i) sum[i] += of_seed[i], squares[i] += of_seed[i] * of_seed[i];
        const double deviation = drawn_deviation(paths, powers);
        variances += deviation * deviation;
      }
      for (uint32_t i = 0; i <= bins; ++i) {
        const double mean = sum[i] / seeds, variance = squares[i] / seeds - mean * mean;
        // Four standard errors, and a power of 0 in bins that no path has.
        EXPECT_NEAR(mean, all[i], 4.0 * std::sqrt(variance / seeds) + 1e-9 * all[bins])
            << after << " bin " << i;
        if (i == bins) {
          EXPECT_LT(std::sqrt(variance), 0.1 * all[i]) << after;
          EXPECT_GT(variances / seeds, 0.8 * variance) << "the reported variance is too small on average";
        }
      }
    }
  }
}

TEST(ReflectedTarget, AWallMayBePassedBehindTheScattering) {
  // source and target are in front of a rough plate, and a thin wall is between it and a mirror behind them.
  TinyScene tiny = rough_materials(ScatteringPattern::lambertian);
  scene::Material pane;
  pane.name = "pane";
  pane.radio.emplace().layers.push_back({*scene::itu_medium("glass"), 0.004});
  tiny.material_as(pane);
  tiny.object("plate", 0, 1).quad({0, -20, 0}, {0, 20, 0}, {0, 20, 20}, {0, -20, 20});
  tiny.object("pane", 0, 3).quad({12, -60, -40}, {12, -60, 60}, {12, 60, 60}, {12, 60, -40});
  tiny.object("mirror", 0, 2).quad({15, -60, -40}, {15, -60, 60}, {15, 60, 60}, {15, 60, -40});
  const scene::Scene scene = tiny.build();
  RadioEffects effects = with_scattering();
  effects.transmission = true;
  Obstacles obstacles(scene, effects);
  const dvec3 source(9, -4, 6), target(6, 8, 11);
  PathLimits limits{.max_depth = 4,
                    .max_transmissions = 2,
                    .max_reflections_after = 1,
                    .max_reflections_before_scattering = 0,
                    .patch_m = 2.0};
  const auto behind_the_pane = [&](uint32_t budget) {
    limits.scattering_budget = budget;
    double power = 0.0;
    for (const Path& path : Links(scene, source, limits, effects).lit(target, obstacles))
      if (path.interactions.size() == 4 && scatters(path.interactions) &&
          path.interactions[2].type == InteractionType::reflection)
        power += power_of(path);
    return power;
  };
  const double all = behind_the_pane(0);
  EXPECT_GT(all, 0.0);
  EXPECT_EQ(all, behind_the_pane(1'000'000));
  EXPECT_NEAR(behind_the_pane(400) / all, 1.0, 0.1);
}

TEST(ReflectedTarget, DrawsDependOnTheLinkAlone) {
  const scene::Scene scene = corridor().build();
  const PathLimits limits{.max_depth = 4,
                          .max_reflections_after = 2,
                          .max_reflections_before_scattering = 1,
                          .patch_m = 1.0,
                          .scattering_budget = 200};
  const auto chains = [](const std::vector<GeometricPath>& paths) {
    std::vector<std::pair<std::vector<Interaction>, double>> all;
    for (const GeometricPath& path : paths)
      if (scatters(path.interactions)) all.emplace_back(path.interactions, path.patch_area_m2);
    return all;
  };
  const Links links(scene, from, limits);
  const auto first = chains(links.geometry(places[0]));
  (void)links.geometry(places[1]);
  EXPECT_EQ(first, chains(links.geometry(places[0], 4)));
  EXPECT_LE(first.size(), 200u);
  EXPECT_GT(first.size(), 150u);
  auto up = chains(Links(scene, from, limits, 1, Source::receiver).geometry(places[0]));
  for (auto& [interactions, area] : up) std::ranges::reverse(interactions);
  EXPECT_THAT(up, ::testing::UnorderedElementsAreArray(first)) << "the other direction";
  EXPECT_NE(first, chains(Links(scene, from, limits, 2).geometry(places[0]))) << "another seed";
}

TEST(ReflectedTarget, DrawsStayWhenTheTargetMovesALittle) {
  const scene::Scene scene = corridor().build();
  const Links links(scene, from,
                    {.max_depth = 4,
                     .max_reflections_after = 1,
                     .max_reflections_before_scattering = 1,
                     .patch_m = 1.0,
                     .scattering_budget = 200});
  const auto chains = [&](const dvec3& target) {
    std::vector<std::vector<Interaction>> all;
    for (const GeometricPath& path : links.geometry(target))
      if (scatters(path.interactions)) all.push_back(path.interactions);
    return all;
  };
  const auto first = chains(places[0]), moved = chains(places[0] + dvec3(0.01, 0.005, 0));
  std::vector<std::vector<Interaction>> same;
  std::ranges::set_intersection(first, moved, std::back_inserter(same));
  EXPECT_GT(static_cast<double>(same.size()), 0.5 * static_cast<double>(first.size()));
}

}  // namespace
}  // namespace greatx::rf
