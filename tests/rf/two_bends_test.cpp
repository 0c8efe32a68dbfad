// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks paths with a scattering and another bend: the fields in closed form, and the draws against all pairs
// of patches, and of edges and patches, over many seeds.
#include "tests/rf/two_bends.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "rf/edges/diffraction.h"

namespace greatx::rf {
namespace {

using namespace testing;

std::string path_name(const Path& path) {
  std::string name;
  for (const Interaction& i : path.interactions)
    name +=
        std::string(name_of(i.type)) + " " + std::to_string(i.element) + "/" + std::to_string(i.patch) + ", ";
  return name;
}

/// Sums over seeds, for the mean, its variance and the variance of the variance.
struct Moments {
  double sum[5]{};
  void add(double value) {
    for (int k = 0; k < 5; ++k) sum[k] += std::pow(value, k);
  }
  double raw(int k) const { return sum[k] / sum[0]; }
  double mean() const { return raw(1); }
  double variance() const { return raw(2) - raw(1) * raw(1); }
  double error() const { return std::sqrt(variance() / sum[0]); }
  double kurtosis() const {
    const double m = raw(1), v = variance();
    return (raw(4) - 4.0 * m * raw(3) + 6.0 * m * m * raw(2) - 3.0 * m * m * m * m) / (v * v);
  }
};

constexpr Kind kinds[] = {Kind::two_patches, Kind::edge_and_patch, Kind::patch_and_edge};

/// A case of the test below.
struct YardCase {
  uint32_t depth = 2;
  bool pane = false;  ///< waves pass a pane of glass between the ends
};
scene::Scene yard_of(const YardCase& which) {
  TinyScene tiny = yard(ScatteringPattern::lambertian);
  if (!which.pane) return tiny.build();
  scene::Material glass;
  glass.name = "glass";
  scene::RadioMaterial radio;
  radio.layers.push_back({*scene::itu_medium("glass"), 0.01});
  glass.radio = radio;
  const uint32_t material = tiny.material_as(glass);
  tiny.object("pane", 0, material).quad({-25, -4, 0}, {25, -4, 0}, {25, -4, 9}, {-25, -4, 9});
  return tiny.build();
}

TEST(TwoBends, TheMeanOverSeedsIsThePowerOfAllPairs) {
  constexpr uint64_t seeds = 150;
  const dvec3 source(1, -9, 3), target(7, 14, 2);
  for (const YardCase& which : {YardCase{2}, YardCase{3}, YardCase{3, true}}) {
    const uint32_t depth = which.depth;
    SCOPED_TRACE(fmt::format("depth {}, pane {}", depth, which.pane));
    const scene::Scene scene = yard_of(which);
    Obstacles obstacles(scene, edges_and_patches(1, which.pane));
    const AllPairs pairs(scene, source, depth, 6.0, which.pane);
    const std::vector<Path> all = pairs.links().lit(pairs.to(target), target, obstacles);
    std::map<Kind, Sums> should;
    for (const Kind kind : kinds) should[kind] = sums_of(all, kind);
    std::vector<std::vector<Interaction>> known;
    for (const Path& path : all) known.push_back(path.interactions);
    std::ranges::sort(known);
    std::map<Kind, Moments> powers, variances;
    std::map<std::pair<Kind, int64_t>, Moments> bins;
    for (uint64_t seed = 1; seed <= seeds; ++seed) {
      const Links links(scene, source, both_kinds(depth, 400), edges_and_patches(seed, which.pane));
      const std::vector<Path> drawn = links.lit(target, obstacles);
      for (const Path& path : drawn) {
        if (kind_of(path.interactions) == Kind::other) continue;
        EXPECT_TRUE(std::ranges::binary_search(known, path.interactions)) << path_name(path);
      }
      for (const Kind kind : kinds) {
        const Sums is = sums_of(drawn, kind);
        powers[kind].add(is.power / should[kind].power);
        variances[kind].add(std::pow(is.deviation / should[kind].power, 2));
        for (const auto& [bin, power] : should[kind].bins)
          bins[{kind, bin}].add(is.bins.contains(bin) ? is.bins.at(bin) / power : 0.0);
      }
    }
    for (const Kind kind : kinds) {
      SCOPED_TRACE(static_cast<int>(kind));
      const Moments& power = powers[kind];
      const double variance = power.variance(), kurtosis = power.kurtosis();
      // Four standard errors: a right program fails for one choice of the seeds in 16,000.
      EXPECT_NEAR(power.mean(), 1.0, 4.0 * power.error());
      EXPECT_LT(std::sqrt(variance), 0.5);
      const double error_of_variance = variance * std::sqrt((kurtosis - 1.0) / double(seeds));
      // The strata also show their true difference, so that the estimate is on average too large.
      EXPECT_GT(variances[kind].mean(),
                variance - 4.0 * std::hypot(error_of_variance, variances[kind].error()));
      EXPECT_LT(std::sqrt(variances[kind].mean()), 2.0 * std::sqrt(variance));
      for (const auto& [bin, should_be] : should[kind].bins) {
        const Moments& of_bin = bins[{kind, bin}];
        if (should_be > 0.02 * should[kind].power) {
          EXPECT_NEAR(of_bin.mean(), 1.0, 4.0 * of_bin.error()) << bin;
        }
      }
    }
  }
}

/// A conductor without loss that scatters the share S^2 = 0.36 of what it reflects, by Lambert's law (index
/// 1).
TinyScene bright() {
  TinyScene tiny;
  scene::Material material;
  material.name = "bright";
  scene::RadioMaterial radio;
  radio.layers.push_back({{"explicit a, b, c, d", {{1.0, 0.0, 1e15, 0.0, 1e6, 1e12}}}, 0.0});
  radio.scattering_coefficient = 0.6;
  radio.cross_polarization = 0.2;
  material.radio = radio;
  tiny.material_as(material);
  return tiny;
}
constexpr double bright_share = 0.36;

/// A wall and a ridge in front of it.
TinyScene behind_a_ridge() {
  TinyScene tiny = bright();
  tiny.object("wall", 0, 1).quad({10, -3, 0}, {10, -3, 6}, {10, 3, 6}, {10, 3, 0});
  tiny.object("ridge", 0, 1)
      .quad({-6, 30, 0}, {-6, -30, 0}, {0, -30, 8}, {0, 30, 8})
      .quad({6, -30, 0}, {6, 30, 0}, {0, 30, 8}, {0, -30, 8});
  return tiny;
}

/// The cosine at a patch between its normal and the direction to a point.
double cosine_at(const Links& links, const Path& path, size_t interaction, const dvec3& to) {
  const PosedFacet& facet = links.model().facets.facet(path.interactions[interaction].element);
  return std::abs(glm::dot(facet.normal, glm::normalize(to - path.vertices[interaction + 1])));
}

TEST(TwoBends, APatchBesideAnEdgeHasThePowerOfTheEdgeTimesItsLobe) {
  // The patch takes |E|^2 S^2 cos(theta_i) dA of the field behind the edge, and sends cos(theta_s)/(pi s^2)
  // of it. Its matrix is unitary, so that the sum over both polarizations does not depend on its phases.
  const scene::Scene scene = behind_a_ridge().build();
  const dvec3 source(-12, 1, 3), target(7, 5, 2);
  const AllPairs pairs(scene, source, 2, 4.0);
  const AllPairs from_target(scene, target, 2, 4.0);
  size_t found[2] = {};
  for (const GeometricPath& geometry : pairs.to(target)) {
    const Kind kind = kind_of(geometry.interactions);
    if (kind != Kind::edge_and_patch && kind != Kind::patch_and_edge) continue;
    const bool edge_first = kind == Kind::edge_and_patch;
    const std::vector<Path> fields = pairs.links().unhidden({geometry}, target);
    ASSERT_EQ(fields.size(), 1u);
    const Path& path = fields[0];
    const dvec3 patch = path.vertices[edge_first ? 2 : 1];
    const size_t at = edge_first ? 1 : 0;
    const double cosines = cosine_at(pairs.links(), path, at, path.vertices[at]) *
                           cosine_at(pairs.links(), path, at, path.vertices[at + 2]);
    const double straight_m = glm::distance(patch, edge_first ? target : source);
    // The same edge between the patch as an end and the other end, whose field does not scatter.
    const Links& bent = edge_first ? pairs.links() : from_target.links();
    double over_edge = 0.0;
    for (GeometricPath& one : bent.geometry(patch)) {
      if (one.interactions != std::vector{geometry.interactions[edge_first ? 0 : 1]}) continue;
      if (!edge_first) {
        std::ranges::reverse(one.vertices);
        for (const Path& p : pairs.links().unhidden_between({one}, patch, target)) over_edge += power_of(p);
      } else {
        for (const Path& p : bent.unhidden({one}, patch)) over_edge += power_of(p);
      }
    }
    ASSERT_GT(over_edge, 0.0);
    const double expected =
        over_edge * bright_share * cosines * path.patch_area_m2 / (pi * straight_m * straight_m);
    EXPECT_NEAR(power_of(path) / expected, 1.0, 1e-6);
    EXPECT_NEAR(path.delay_s * speed_of_light, geometry.length_m, 1e-9);
    ++found[edge_first];
  }
  EXPECT_GT(found[0], 3u);
  EXPECT_GT(found[1], 3u);
}

TEST(TwoBends, TwoPatchesHaveTheProductOfTheirLobes) {
  TinyScene tiny = bright();
  tiny.object("wall", 0, 1).quad({0, -4, 0}, {0, 4, 0}, {0, 4, 8}, {0, -4, 8});
  tiny.object("other", 0, 1).quad({-8, 9, 0}, {-8, 9, 8}, {0, 9, 8}, {0, 9, 0});
  tiny.object("third", 0, 1).quad({9, -4, 0}, {9, -4, 8}, {9, 4, 8}, {9, 4, 0});
  const scene::Scene scene = tiny.build();
  const dvec3 source(5, -3, 4), target(4, 3, 2);
  const AllPairs pairs(scene, source, 2, 5.0);
  size_t found = 0;
  for (const Path& path : pairs.links().unhidden(pairs.to(target), target)) {
    ASSERT_EQ(kind_of(path.interactions), Kind::two_patches);
    double expected =
        bright_share * bright_share * path.patch_area_m2 * path.second_patch_area_m2 / (pi * pi);
    for (size_t i : {0, 1})
      for (const size_t next : {i, i + 2}) expected *= cosine_at(pairs.links(), path, i, path.vertices[next]);
    // The first patch is a disk to the second one.
    const double disk_m2 = path.patch_area_m2 / pi;
    for (size_t i = 0; i < 3; ++i)
      expected /=
          std::pow(glm::distance(path.vertices[i], path.vertices[i + 1]), 2) + (i == 1 ? disk_m2 : 0.0);
    EXPECT_NEAR(power_of(path) / expected, 1.0, 1e-6);
    ++found;
  }
  EXPECT_GT(found, 50u);
}

/// Divides an octahedron into 8 * 4^steps triangles, with their corners on a sphere.
TinyScene sphere(double radius_m, int steps) {
  TinyScene tiny = bright();
  tiny.object("sphere", 0, 1);
  const std::function<void(dvec3, dvec3, dvec3, int)> divide = [&](dvec3 a, dvec3 b, dvec3 c, int left) {
    if (left == 0) {
      tiny.triangle(radius_m * a, radius_m * c, radius_m * b);
      return;
    }
    const dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
    divide(a, ab, ca, left - 1);
    divide(ab, b, bc, left - 1);
    divide(ca, bc, c, left - 1);
    divide(ab, bc, ca, left - 1);
  };
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) {
        const dvec3 a(x, 0, 0), b(0, y, 0), c(0, 0, z);
        x* y* z > 0 ? divide(a, b, c, steps) : divide(a, c, b, steps);
      }
  return tiny;
}

TEST(TwoBends, TheSecondScatteringInASphereIsThatOfAnIntegratingSphere) {
  // A Lambertian sphere lights itself evenly: of the power 4 pi that an isotropic source sends, the share rho
  // comes back, E_2 = rho 4 pi/(4 pi R^2), and the radiance rho E_2/pi from everywhere gives 4 rho^2/R^2 to
  // an isotropic receiver at any place inside. The second order is rho times the first if the source is in
  // the middle, where the first order is even, too: 4 rho/R^2.
  constexpr double radius_m = 10.0;
  const scene::Scene scene = sphere(radius_m, 3).build();
  double area_m2 = 0.0;
  for (const Patch& patch :
       scattering_patches(scene, Links(scene, {0, 0, 0}, {.max_depth = 0}).model().kinds, 100.0))
    area_m2 += patch.area_m2;
  const double expected = 16.0 * pi * bright_share * bright_share / area_m2;
  for (const dvec3& source : {dvec3(0.1, 0, 0), dvec3(0, 4, 3)})
    for (const dvec3& target : {dvec3(1, 2, -3), dvec3(-4, -3, 1)}) {
      const Links links(scene, source,
                        {.max_depth = 2,
                         .max_reflections_before_scattering = 0,
                         .patch_m = 100.0,
                         .scattering_budget = 8000,
                         .max_scatterings = 2});
      const Sums second = sums_of(links.unhidden(target), Kind::two_patches);
      EXPECT_NEAR(second.power / expected, 1.0, 0.03 + 4.0 * second.deviation / expected);
      EXPECT_LT(second.deviation / expected, 0.03);
    }
}

TEST(TwoBends, NothingIsDrawnWithoutTheOptions) {
  const scene::Scene scene = yard().build();
  const dvec3 source(1, -9, 3), target(7, 14, 2);
  PathLimits limits = both_kinds(3, 400);
  const auto count = [&] {
    std::map<Kind, size_t> counts;
    for (const GeometricPath& path : Links(scene, source, limits, edges_and_patches()).geometry(target))
      ++counts[kind_of(path.interactions)];
    return counts;
  };
  auto counts = count();
  for (const Kind kind : kinds) EXPECT_GT(counts[kind], 20u) << static_cast<int>(kind);
  limits.max_scatterings = 1;
  counts = count();
  EXPECT_EQ(counts[Kind::two_patches], 0u);
  EXPECT_GT(counts[Kind::edge_and_patch], 20u);
  limits.scattering_beside_diffraction = false;
  counts = count();
  EXPECT_EQ(counts[Kind::edge_and_patch] + counts[Kind::patch_and_edge] + counts[Kind::two_patches], 0u);
  limits.max_depth = 1;
  limits.max_scatterings = 2;
  limits.scattering_beside_diffraction = true;
  counts = count();
  EXPECT_EQ(counts[Kind::edge_and_patch] + counts[Kind::patch_and_edge] + counts[Kind::two_patches], 0u);
}

TEST(TwoBends, NoKindHasMorePathsThanItsHalfOfTheBudget) {
  const scene::Scene scene = yard().build();
  for (const uint32_t budget : {1u, 2u, 17u, 60u, 1000u}) {
    std::map<Kind, size_t> counts;
    for (const GeometricPath& path :
         Links(scene, {1, -9, 3}, both_kinds(3, budget), edges_and_patches()).geometry({7, 14, 2}))
      ++counts[kind_of(path.interactions)];
    const size_t most = std::max(1u, budget / 2);
    EXPECT_LE(counts[Kind::two_patches] + counts[Kind::edge_and_patch], most) << budget;
    EXPECT_LE(counts[Kind::patch_and_edge], most) << budget;
    EXPECT_GE(counts[Kind::patch_and_edge], most / 8) << budget;
  }
}

TEST(TwoBends, NothingIsDrawnWhereNothingScattersOrDiffracts) {
  TinyScene smooth = rough_materials(ScatteringPattern::lambertian), flat = smooth;
  smooth.object("house", 0, 2).box({-4, 0, 0}, {5, 6, 7});
  flat.object("ground", 0, 1).quad({-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0});
  for (const scene::Scene& scene : {smooth.build(), flat.build()})
    for (const GeometricPath& path :
         Links(scene, {1, -9, 3}, both_kinds(3, 100), edges_and_patches()).geometry({7, 14, 2}))
      EXPECT_EQ(kind_of(path.interactions), Kind::other);
}

TEST(TwoBends, DrawsDependOnTheLinkAloneAndStayWhenTheTargetMovesALittle) {
  const scene::Scene scene = yard().build();
  const dvec3 source(1, -9, 3), target(7, 14, 2);
  const Links links(scene, source, both_kinds(3, 800, 2.0), edges_and_patches());
  const auto chains = [](const std::vector<GeometricPath>& paths, Kind kind) {
    std::vector<std::vector<Interaction>> all;
    for (const GeometricPath& path : paths)
      if (kind_of(path.interactions) == kind) all.push_back(path.interactions);
    return all;
  };
  const auto first = links.geometry(target);
  (void)links.geometry({-9, 3, 1});
  const auto again = links.geometry(target, 4);
  const auto moved = links.geometry(target + dvec3(0.02, 0.01, 0));
  const auto other = Links(scene, source, both_kinds(3, 800, 2.0), edges_and_patches(2)).geometry(target);
  for (const Kind kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind));
    const auto chain = chains(first, kind), after = chains(moved, kind);
    EXPECT_GT(chain.size(), 50u);
    EXPECT_EQ(chain, chains(again, kind));
    EXPECT_TRUE(std::ranges::adjacent_find(chain) == chain.end()) << "a path twice";
    std::vector<std::vector<Interaction>> same;
    std::ranges::set_intersection(chain, after, std::back_inserter(same),
                                  [](const auto& a, const auto& b) { return interactions_less(a, b); });
    EXPECT_GT(static_cast<double>(same.size()), 0.6 * static_cast<double>(chain.size()));
    EXPECT_NE(chain, chains(other, kind)) << "another seed";
  }
}

TEST(TwoBends, BothDirectionsOfALinkDrawTheSame) {
  const scene::Scene scene = yard().build();
  Obstacles obstacles(scene);
  const dvec3 source(1, -9, 3), target(7, 14, 2);
  const PathLimits limits = both_kinds(3, 400);
  std::vector<Path> down = Links(scene, source, limits, edges_and_patches()).lit(target, obstacles);
  std::vector<Path> up =
      Links(scene, source, limits, edges_and_patches(), Source::receiver).lit(target, obstacles);
  ASSERT_EQ(down.size(), up.size());
  for (Path& path : up) std::ranges::reverse(path.interactions);
  std::ranges::sort(
      up, [](const Path& a, const Path& b) { return interactions_less(a.interactions, b.interactions); });
  size_t two_bends = 0;
  for (size_t i = 0; i < up.size(); ++i) {
    EXPECT_EQ(down[i].interactions, up[i].interactions);
    EXPECT_EQ(down[i].second_patch_area_m2, up[i].second_patch_area_m2);
    if (kind_of(down[i].interactions) == Kind::other) continue;
    ++two_bends;
    EXPECT_NEAR(power_of(down[i]), power_of(up[i]), 1e-12 * power_of(up[i]));
    EXPECT_NEAR(glm::distance(down[i].departure, up[i].arrival), 0.0, 1e-12);
  }
  EXPECT_GT(two_bends, 50u);
}

TEST(TwoBends, APatchThatMovesShiftsTheFrequency) {
  // A van that drives away from both ends: the shift is the rate of the path's length over the wavelength.
  TinyScene tiny = rough_materials(ScatteringPattern::lambertian);
  const uint32_t van = tiny.body("van");
  tiny.object("wall", 0, 1).quad({-20, 25, 0}, {20, 25, 0}, {20, 25, 12}, {-20, 25, 12});
  tiny.object("van", van, 1).box({2, 10, 0}, {4, 15, 3});
  const scene::Scene scene = tiny.build();
  Links links(scene, {1, -9, 3}, both_kinds(2, 200, 3.0), edges_and_patches(), Source::transmitter, true);
  const dvec3 velocity(0, 7, 0), target(-6, 12, 2);
  constexpr double step_s = 1e-5;
  links.move_body(van, {.pose = {}, .velocity = velocity});
  const auto length_after = [&](const Path& path, double time_s) {
    std::vector<dvec3> vertices = path.vertices;
    for (size_t i = 0; i < path.interactions.size(); ++i) {
      const Interaction& one = path.interactions[i];
      const uint32_t body = one.type == InteractionType::diffraction
                                ? links.model().wedges[one.element].body
                                : links.model().facets.facet(one.element).body;
      if (body == van) vertices[i + 1] += time_s * velocity;
    }
    double length_m = 0.0;
    for (size_t i = 0; i + 1 < vertices.size(); ++i) length_m += glm::distance(vertices[i], vertices[i + 1]);
    return length_m;
  };
  std::map<Kind, size_t> counts;
  for (const Path& path : links.unhidden(target)) {
    const double rate = (length_after(path, -step_s) - length_after(path, step_s)) / (2.0 * step_s);
    if (kind_of(path.interactions) == Kind::other || rate == 0.0) continue;
    ++counts[kind_of(path.interactions)];
    EXPECT_NEAR(path.doppler_hz, rate * budget_hz / speed_of_light, 1e-3);
  }
  for (const Kind kind : kinds) EXPECT_GT(counts[kind], 5u) << static_cast<int>(kind);
}

}  // namespace
}  // namespace greatx::rf
