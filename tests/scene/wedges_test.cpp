// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/wedges.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "scene/build/build.h"
#include "tests/scene/gltf_writer.h"

namespace greatx::scene {
namespace {

/// Makes facets by hand, from arbitrary triangles.
struct Hand {
  Hand() { scene.bodies.resize(1); }

  uint32_t facet(const std::vector<FacetTriangle>& triangles, uint32_t body = 0) {
    const dvec3* corner = triangles[0].corners;
    Facet made;
    made.normal = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
    made.offset = glm::dot(made.normal, corner[0]);
    made.body = body;
    made.first_triangle = static_cast<uint32_t>(scene.facet_triangles.size());
    made.triangle_count = static_cast<uint32_t>(triangles.size());
    scene.facet_triangles.insert(scene.facet_triangles.end(), triangles.begin(), triangles.end());
    scene.facets.push_back(made);
    return static_cast<uint32_t>(scene.facets.size() - 1);
  }
  /// Adds the parallelogram at `o` with sides u and v, in cells_u x cells_v quads of two triangles each. It
  /// faces u x v.
  uint32_t plate(const dvec3& o, const dvec3& u, const dvec3& v, int cells_u = 1, int cells_v = 1,
                 uint32_t body = 0) {
    std::vector<FacetTriangle> triangles;
    for (int i = 0; i < cells_u; ++i) {
      for (int k = 0; k < cells_v; ++k) {
        const auto at = [&](int du, int dv) {
          return o + u * (static_cast<double>(i + du) / cells_u) +
                 v * (static_cast<double>(k + dv) / cells_v);
        };
        triangles.push_back({{at(0, 0), at(1, 0), at(1, 1)}});
        triangles.push_back({{at(0, 0), at(1, 1), at(0, 1)}});
      }
    }
    return facet(triangles, body);
  }
  /// Adds six facets that face outwards: bottom (unless left out), top, y low, y high, x low, x high.
  void box(const dvec3& o, const dvec3& size, bool bottom = true, uint32_t body = 0) {
    const dvec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    if (bottom) plate(o, y, x, 1, 1, body);
    plate(o + z, x, y, 1, 1, body);
    plate(o, x, z, 1, 1, body);
    plate(o + y, z, x, 1, 1, body);
    plate(o, z, y, 1, 1, body);
    plate(o + x, y, z, 1, 1, body);
  }

  Scene scene;
};

dvec3 direction(const Wedge& wedge) { return glm::normalize(wedge.b - wedge.a); }
/// Returns the direction at `angle` from face 0 into the exterior.
dvec3 around(const Wedge& wedge, double angle) {
  return std::cos(angle) * wedge.tangent_0 + std::sin(angle) * wedge.normal_0;
}

void expect_sound(const Scene& scene, const std::vector<Wedge>& wedges) {
  for (const Wedge& wedge : wedges) {
    EXPECT_LT(glm::distance(glm::cross(wedge.tangent_0, wedge.normal_0), direction(wedge)), 1e-12);
    EXPECT_NEAR(glm::length(wedge.tangent_0), 1.0, 1e-12);
    EXPECT_GT(wedge.n, 1.0);
    EXPECT_LE(wedge.n, 2.0);
    EXPECT_LT(std::abs(glm::dot(scene.facets[wedge.facet_0].normal, wedge.tangent_0)), 1e-9);
    if (wedge.facet_n == no_facet) {
      EXPECT_EQ(wedge.n, 2.0);
      EXPECT_GT(glm::dot(scene.facets[wedge.facet_0].normal, wedge.normal_0), 0.99);
    } else {
      EXPECT_LT(wedge.facet_0, wedge.facet_n);
      EXPECT_LT(std::abs(glm::dot(scene.facets[wedge.facet_n].normal, around(wedge, wedge.n * pi))), 1e-4);
    }
    EXPECT_EQ(wedge.body, scene.facets[wedge.facet_0].body);
  }
}

std::vector<Wedge> wedges_of(const Hand& hand, bool free_edges = false) {
  std::vector<Wedge> wedges = find_wedges(hand.scene, {.free_edges = free_edges});
  expect_sound(hand.scene, wedges);
  return wedges;
}

/// Returns the number of wedges with both ends in the plane z = height.
size_t at_height(const std::vector<Wedge>& wedges, double height) {
  return static_cast<size_t>(std::count_if(wedges.begin(), wedges.end(), [&](const Wedge& wedge) {
    return std::abs(wedge.a.z - height) < 1e-6 && std::abs(wedge.b.z - height) < 1e-6;
  }));
}

double total_length(const std::vector<Wedge>& wedges) {
  double sum = 0.0;
  for (const Wedge& wedge : wedges) sum += glm::distance(wedge.a, wedge.b);
  return sum;
}

TEST(FindWedges, BoxHasTwelve) {
  Hand hand;
  const dvec3 corner(3, -2, 1), size(4, 5, 6);
  hand.box(corner, size);
  const std::vector<Wedge> wedges = wedges_of(hand);
  ASSERT_EQ(wedges.size(), 12u);
  EXPECT_NEAR(total_length(wedges), 4.0 * (4 + 5 + 6), 1e-12);
  const dvec3 middle = corner + 0.5 * size;
  for (const Wedge& wedge : wedges) {
    EXPECT_NEAR(wedge.n, 1.5, 1e-15);
    // The middle of the exterior points away from the box.
    EXPECT_GT(glm::dot(around(wedge, 0.75 * pi), 0.5 * (wedge.a + wedge.b) - middle), 0.0);
    EXPECT_LT(glm::distance(wedge.normal_0, hand.scene.facets[wedge.facet_0].normal), 1e-15);
  }
  EXPECT_TRUE(std::is_sorted(wedges.begin(), wedges.end(), [](const Wedge& x, const Wedge& y) {
    return std::pair(x.facet_0, x.facet_n) < std::pair(y.facet_0, y.facet_n);
  }));
}

TEST(FindWedges, WindingDoesNotMatter) {
  // A room has the same walls, wound inwards.
  Hand out, in;
  out.box({0, 0, 0}, {4, 5, 6});
  in.box({0, 0, 0}, {4, 5, 6});
  for (FacetTriangle& triangle : in.scene.facet_triangles)
    std::swap(triangle.corners[1], triangle.corners[2]);
  for (Facet& facet : in.scene.facets) facet.normal = -facet.normal, facet.offset = -facet.offset;
  const std::vector<Wedge> wedges = wedges_of(out), inwards = wedges_of(in);
  ASSERT_EQ(inwards.size(), 12u);
  for (size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(inwards[i].a, wedges[i].a);
    EXPECT_EQ(inwards[i].b, wedges[i].b);
    EXPECT_LT(glm::distance(inwards[i].normal_0, wedges[i].normal_0), 1e-15);
    EXPECT_EQ(inwards[i].n, wedges[i].n);
  }
}

TEST(FindWedges, FromAFile) {
  test::GltfWriter writer;
  writer.add_triangles("box",
                       {vec3(0, 0, 0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0), vec3(0, 0, 1),
                        vec3(1, 0, 1), vec3(1, 1, 1), vec3(0, 1, 1)},
                       {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                        3, 7, 6, 3, 6, 2, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5},
                       writer.itu_material());
  const Model model = writer.load();
  ModelPlacement still, turned;
  still.model = turned.model = &model;
  still.name = "still", turned.name = "turned";
  turned.moving = true;
  const Scene scene = build_scene({still, turned}, {});
  const std::vector<Wedge> wedges = find_wedges(scene);
  expect_sound(scene, wedges);
  ASSERT_EQ(wedges.size(), 24u);
  EXPECT_EQ(wedges[11].body, 0u);
  EXPECT_EQ(wedges[12].body, 1u);
}

TEST(FindWedges, BoxOnAGroundHasNoneAlongItsFoot) {
  Hand shared;  // eight plates around the foot, which use its vertices
  for (int i = -1; i <= 1; ++i)
    for (int k = -1; k <= 1; ++k)
      if (i != 0 || k != 0) shared.plate(dvec3(10 * i, 10 * k, 0), {10, 0, 0}, {0, 10, 0});
  Hand apart, open;  // one plate underneath, of one cell or of 49
  apart.plate({-50, -50, 0}, {100, 0, 0}, {0, 100, 0});
  open.plate({-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, 7, 7);
  shared.box({0, 0, 0}, {10, 10, 5});
  apart.box({0, 0, 0}, {10, 10, 5});
  open.box({0, 0, 0}, {10, 10, 5}, false);
  for (const Hand* hand : {&shared, &apart, &open}) {
    const std::vector<Wedge> wedges = wedges_of(*hand);
    EXPECT_EQ(wedges.size(), 8u);
    EXPECT_EQ(at_height(wedges, 0.0), 0u);
    // The border of the ground has free edges, the foot of the box has none.
    EXPECT_EQ(at_height(wedges_of(*hand, true), 0.0), hand == &shared ? 12u : 4u);
  }
}

TEST(FindWedges, WallOnAGroundMeetsNothing) {
  Hand hand;
  hand.plate({-50, -50, 0}, {100, 0, 0}, {0, 100, 0});
  hand.plate({0, -3, 0}, {0, 6, 0}, {0, 0, 4});
  EXPECT_TRUE(wedges_of(hand).empty());
  // the border of the ground, and the edges of the wall without its foot
  EXPECT_EQ(wedges_of(hand, true).size(), 4u + 3u);
}

TEST(FindWedges, FootBeyondTheGround) {
  // Half of the box extends over the border of the ground (x = 5). There its foot diffracts.
  Hand hand;
  hand.plate({-50, -50, 0}, {55, 0, 0}, {0, 100, 0});
  hand.box({0, 0, 0}, {10, 10, 5});
  const std::vector<Wedge> wedges = wedges_of(hand);
  EXPECT_EQ(at_height(wedges, 0.0), 3u);
  EXPECT_EQ(wedges.size(), 11u);
  EXPECT_NEAR(total_length(wedges), 4 * 10 + 4 * 5 + 5 + 10 + 5, 1e-9);
}

TEST(FindWedges, LShapedHouse) {
  // There are 6 uprights, 6 edges of the roof and 6 of the floor. One upright is the corner of a yard, and
  // its wide side lies inside.
  Hand hand;
  const std::vector<dvec3> plan{{0, 0, 0}, {8, 0, 0}, {8, 3, 0}, {3, 3, 0}, {3, 8, 0}, {0, 8, 0}};
  const dvec3 up(0, 0, 4);
  for (size_t i = 0; i < plan.size(); ++i) hand.plate(plan[i], plan[(i + 1) % plan.size()] - plan[i], up);
  for (const dvec3& level : {dvec3(0.0), up}) {
    std::vector<FacetTriangle> triangles;
    for (const auto& [a, b, c] :
         {std::tuple(0, 1, 2), std::tuple(0, 2, 3), std::tuple(0, 3, 4), std::tuple(0, 4, 5)})
      triangles.push_back({{plan[static_cast<size_t>(a)] + level, plan[static_cast<size_t>(b)] + level,
                            plan[static_cast<size_t>(c)] + level}});
    hand.facet(triangles);
  }
  const std::vector<Wedge> wedges = wedges_of(hand);
  ASSERT_EQ(wedges.size(), 18u);
  size_t inside = 0;
  for (const Wedge& wedge : wedges) {
    EXPECT_NEAR(wedge.n, 1.5, 1e-12);
    const dvec3 point = 0.5 * (wedge.a + wedge.b) + 0.1 * around(wedge, 0.75 * pi);
    const bool in_plan =
        point.x > 0 && point.y > 0 && ((point.x < 8 && point.y < 3) || (point.x < 3 && point.y < 8));
    inside += in_plan && point.z > 0 && point.z < 4;
  }
  EXPECT_EQ(inside, 1u);
}

TEST(FindWedges, FreeEdgesOnRequest) {
  Hand hand;
  const uint32_t plate = hand.plate({0, 0, 0}, {0, 3, 0}, {0, 0, 2}, 3, 2);
  EXPECT_TRUE(wedges_of(hand).empty());
  const std::vector<Wedge> wedges = wedges_of(hand, true);
  ASSERT_EQ(wedges.size(), 4u);
  for (const Wedge& wedge : wedges) {
    EXPECT_EQ(wedge.facet_0, plate);
    EXPECT_EQ(wedge.facet_n, no_facet);
    EXPECT_LT(glm::dot(wedge.tangent_0, 0.5 * (wedge.a + wedge.b) - dvec3(0, 1.5, 1)),
              0.0);  // into the plate
  }
  // A sheet of two sides in one place is the same plate.
  hand.plate({0, 0, 0}, {0, 0, 2}, {0, 3, 0});
  EXPECT_TRUE(wedges_of(hand).empty());
  EXPECT_EQ(wedges_of(hand, true).size(), 4u);
  // A round plate has one free edge per straight run.
  Hand disk;
  std::vector<FacetTriangle> slices;
  for (int i = 0; i < 24; ++i) {
    const auto rim = [](int at) {
      return dvec3(std::cos(at % 24 * pi / 12), std::sin(at % 24 * pi / 12), 0.0);
    };
    slices.push_back({{dvec3(0.0), rim(i), rim(i + 1)}});
  }
  disk.facet(slices);
  EXPECT_EQ(wedges_of(disk, true).size(), 24u);
}

TEST(FindWedges, MoreThanTwoFacetsOnAnEdge) {
  // Fins stand around the z axis at these degrees. The widest gap decides, and only if it is wider than pi.
  const auto fins = [](std::initializer_list<double> degrees) {
    Hand hand;
    for (const double at : degrees)
      hand.plate(dvec3(0.0), {std::cos(radians(at)), std::sin(radians(at)), 0}, {0, 0, 2});
    return hand;
  };
  const std::vector<Wedge> three = wedges_of(fins({0, 90, 40}));
  ASSERT_EQ(three.size(), 1u);
  EXPECT_NEAR(three[0].n, 1.5, 1e-12);
  EXPECT_EQ(three[0].facet_0, 0u);
  EXPECT_EQ(three[0].facet_n, 1u);
  EXPECT_LT(glm::distance(direction(three[0]), dvec3(0, 0, -1)), 1e-12);  // from 0 backwards to 90 degrees
  EXPECT_TRUE(wedges_of(fins({0, 120, 240})).empty());
  EXPECT_TRUE(wedges_of(fins({0, 90, 180, 270})).empty());
  EXPECT_TRUE(wedges_of(fins({0, 90, 179})).empty());  // 181 degrees: flat
  EXPECT_NEAR(wedges_of(fins({0, 90, 170}))[0].n, 190.0 / 180.0, 1e-12);
  EXPECT_NEAR(wedges_of(fins({10, 11}))[0].n, 359.0 / 180.0, 1e-12);
  // Of facets in one place the lowest index counts.
  const std::vector<Wedge> twice = wedges_of(fins({90, 0, 90, 0}));
  ASSERT_EQ(twice.size(), 1u);
  EXPECT_EQ(twice[0].facet_0, 0u);
  EXPECT_EQ(twice[0].facet_n, 1u);
}

TEST(FindWedges, TouchingHouses) {
  Hand flush;  // side by side and equally high: no wedge on the common roof line
  flush.box({0, 0, 0}, {4, 4, 4});
  flush.box({4, 0, 0}, {4, 4, 4});
  // Of the 24 edges, the 4 of each box around the common wall make flat seams. The long edges stay separate
  // for each pair of facets.
  EXPECT_EQ(wedges_of(flush).size(), 16u);
  Hand steps;
  steps.box({0, 0, 0}, {4, 4, 4});
  steps.box({4, 0, 0}, {4, 4, 7});
  // The lower house loses its four edges at the common wall. Of the taller house's edges at this wall, the
  // top remains, and its uprights from 4 to 7.
  const std::vector<Wedge> wedges = wedges_of(steps);
  EXPECT_EQ(wedges.size(), 8u + 11u);
  Hand diagonal;
  diagonal.box({0, 0, 0}, {4, 4, 4});
  diagonal.box({4, 4, 0}, {4, 4, 4});
  EXPECT_EQ(wedges_of(diagonal).size(), 22u);
}

TEST(FindWedges, TooShort) {
  Hand hand;
  hand.box({0, 0, 0}, {4, 5, 5e-4});
  uint64_t too_short = 0;
  EXPECT_EQ(find_wedges(hand.scene, {}, &too_short).size(), 8u);
  EXPECT_EQ(too_short, 4u);
}

TEST(FindWedges, AnyWedgeLooksAtSmallBodiesFirst) {
  Hand hand;
  hand.box({0, 0, 0}, {4, 5, 6});
  hand.box({0, 0, 10}, {4, 5, 6});  // one static body with 24 wedges, and a plate on a body of its own
  const uint32_t first = static_cast<uint32_t>(hand.scene.facets.size());
  hand.plate({20, 0, 0}, {3, 0, 0}, {0, 3, 0});
  hand.scene.bodies.resize(2);
  for (uint32_t facet = first; facet < hand.scene.facets.size(); ++facet) hand.scene.facets[facet].body = 1;
  const WedgeOptions options{.free_edges = true};
  const std::vector<Wedge> all = find_wedges(hand.scene, options);
  ASSERT_EQ(all.size(), 28u);
  size_t asked = 0;
  EXPECT_TRUE(any_wedge(hand.scene, options, [&](const Wedge&) { return ++asked > 0; }));
  EXPECT_EQ(asked, 1u);
  std::vector<uint32_t> bodies;
  EXPECT_FALSE(any_wedge(hand.scene, options, [&](const Wedge& wedge) {
    bodies.push_back(wedge.body);
    return false;
  }));
  ASSERT_EQ(bodies.size(), all.size());
  EXPECT_TRUE(std::ranges::is_sorted(bodies, std::greater<>()));
  for (const Wedge& wanted : all)
    EXPECT_TRUE(any_wedge(hand.scene, options,
                          [&](const Wedge& wedge) { return wedge.a == wanted.a && wedge.b == wanted.b; }));
}

TEST(FindWedges, ASurveyGivesTheSameWedgesByEveryOption) {
  // A prism of 40 sides has bends of 9 degrees; the plates have free edges, and one of them is cut short.
  Hand hand;
  hand.box({0, 0, 0}, {4, 5, 6});
  hand.box({4, 5, 0}, {3, 3, 3});
  hand.plate({-50, -50, 0}, {100, 0, 0}, {0, 100, 0});
  for (int side = 0; side < 40; ++side) {
    const auto rim = [](int k) {
      return dvec3(20 + 3 * std::cos(k * pi / 20), 3 * std::sin(k * pi / 20), 0);
    };
    hand.plate(rim(side), rim(side + 1) - rim(side), {0, 0, side == 7 ? 3.0 : 4.0});
  }
  hand.box({30, 0, 0}, {4, 5, 5e-4});
  const EdgeSurvey survey(hand.scene, {.free_edges = true, .flat_angle_rad = 0.0035});
  EXPECT_FALSE(survey.covers({.flat_angle_rad = 0.001}));
  EXPECT_FALSE(survey.covers({.weld_distance_m = 1e-3}));
  EXPECT_FALSE(EdgeSurvey(hand.scene, {}).covers({.free_edges = true}));
  EXPECT_THROW(survey.wedges({.flat_angle_rad = 0.001}), ContractError);
  const auto bytes = [](const std::vector<Wedge>& wedges) {
    std::vector<double> numbers;
    for (const Wedge& w : wedges)
      for (const dvec3& v : {w.a, w.b, w.tangent_0, w.normal_0, dvec3(w.n, w.facet_0, w.facet_n)})
        numbers.insert(numbers.end(), {v.x, v.y, v.z});
    return numbers;
  };
  std::set<size_t> counts;
  for (const bool free_edges : {false, true})
    for (const double flat : {0.0035, 0.035, 0.1, 0.5}) {
      const WedgeOptions options{.free_edges = free_edges, .flat_angle_rad = flat};
      uint64_t too_short = 0, expected_too_short = 0;
      const std::vector<Wedge> expected = find_wedges(hand.scene, options, &expected_too_short);
      EXPECT_EQ(bytes(survey.wedges(options, &too_short)), bytes(expected)) << flat;
      EXPECT_EQ(too_short, expected_too_short);
      EXPECT_EQ(bytes(find_wedges(hand.scene, options, nullptr, &survey)), bytes(expected));
      counts.insert(expected.size());
    }
  EXPECT_GE(counts.size(), 4u) << "the options make a difference";
}

TEST(FindWedges, RoundingOfAFileMovesNothing) {
  Hand hand;
  hand.box({0, 0, 0}, {4, 5, 6});
  hand.plate({-50, -50, 0}, {100, 0, 0}, {0, 100, 0});
  RandomStream random(3, 0);
  for (FacetTriangle& triangle : hand.scene.facet_triangles)
    for (dvec3& corner : triangle.corners)
      for (int axis = 0; axis < 3; ++axis) corner[axis] += random.uniform(-2e-5, 2e-5);
  const std::vector<Wedge> wedges = find_wedges(hand.scene);
  ASSERT_EQ(wedges.size(), 8u);
  for (const Wedge& wedge : wedges) EXPECT_NEAR(wedge.n, 1.5, 1e-4);
}

TEST(FindWedges, OrderOfTrianglesDoesNotMatter) {
  Hand hand;
  hand.box({0, 0, 0}, {4, 5, 6});
  hand.plate({0, 0, 6}, {4, 0, 0}, {0, 2, 3}, 3, 2);
  hand.plate({0, 2, 9}, {4, 0, 0}, {0, 3, -3}, 2, 3);
  const std::vector<Wedge> wedges = wedges_of(hand);
  for (const Facet& facet : hand.scene.facets) {
    const auto first = hand.scene.facet_triangles.begin() + facet.first_triangle;
    std::reverse(first, first + facet.triangle_count);
    for (auto triangle = first; triangle < first + facet.triangle_count; ++triangle)
      std::rotate(triangle->corners, triangle->corners + 1, triangle->corners + 3);
  }
  const std::vector<Wedge> again = wedges_of(hand);
  ASSERT_EQ(again.size(), wedges.size());
  for (size_t i = 0; i < wedges.size(); ++i) {
    EXPECT_EQ(again[i].a, wedges[i].a);
    EXPECT_EQ(again[i].b, wedges[i].b);
    EXPECT_EQ(again[i].facet_n, wedges[i].facet_n);
    EXPECT_EQ(again[i].n, wedges[i].n);
  }
}

TEST(FindWedgesHardCase, N46_FlatSeamsAreIgnored) {
  const auto folded = [](double degrees) {
    Hand hand;
    hand.plate({0, 0, 0}, {-5, 0, 0}, {0, 5, 0});
    hand.plate({0, 0, 0}, {5 * std::cos(radians(degrees)), 0, 5 * std::sin(radians(degrees))}, {0, 5, 0}, 4,
               1);
    return wedges_of(hand).size();
  };
  EXPECT_EQ(folded(0.0), 0u);
  EXPECT_EQ(folded(1e-9), 0u);
  EXPECT_EQ(folded(1.9), 0u);
  EXPECT_EQ(folded(2.1), 1u);
  EXPECT_EQ(folded(-2.1), 1u);
}

TEST(FindWedges, PagesOfABookHaveOneSpine) {
  // The spine must not be processed once for each page, which would take quadratic time.
  const int pages = 2000;
  Hand book;
  for (int page = 0; page < pages; ++page) {
    const double angle = 0.5 * pi * page / (pages - 1);
    book.plate(dvec3(0), {std::cos(angle), std::sin(angle), 0}, {0, 0, 2});
  }
  const std::vector<Wedge> wedges = find_wedges(book.scene, {});
  ASSERT_EQ(wedges.size(), 1u);
  EXPECT_NEAR(total_length(wedges), 2.0, 1e-12);
  EXPECT_NEAR(wedges[0].n, 1.5, 1e-9);
  EXPECT_EQ(std::minmax(wedges[0].facet_0, wedges[0].facet_n), std::minmax(0u, uint32_t(pages - 1)));
}

TEST(FindWedgesHardCase, N47_SplitEdgesAndDiagonalsMakeNoMore) {
  // Each wall and the roof has another grid, and they have no common vertices but the corners. There are
  // still 12 edges of full length.
  Hand hand;
  const dvec3 x(4, 0, 0), y(0, 5, 0), z(0, 0, 6), o(7, 8, 9);
  hand.plate(o, y, x, 3, 2);
  hand.plate(o + z, x, y, 5, 7);
  hand.plate(o, x, z, 1, 1);
  hand.plate(o + y, z, x, 4, 3);
  hand.plate(o, z, y, 2, 6);
  hand.plate(o + x, y, z, 2, 1);
  const std::vector<Wedge> wedges = wedges_of(hand);
  ASSERT_EQ(wedges.size(), 12u);
  EXPECT_NEAR(total_length(wedges), 4.0 * (4 + 5 + 6), 1e-12);
  for (const Wedge& wedge : wedges) {
    const dvec3 size = glm::abs(wedge.b - wedge.a);
    EXPECT_NEAR(size.x + size.y + size.z, std::max({size.x, size.y, size.z}), 1e-12);  // corner to corner
    EXPECT_NEAR(wedge.n, 1.5, 1e-12);
  }
  EXPECT_EQ(wedges_of(hand, true).size(), 12u);
  // An opening in a wall interrupts an edge. The result is two wedges between the same facets.
  Hand gap;
  gap.plate({0, 0, 3}, {10, 0, 0}, {0, 5, 0});
  gap.facet({{{dvec3(0, 0, 0), dvec3(4, 0, 0), dvec3(4, 0, 3)}},
             {{dvec3(0, 0, 0), dvec3(4, 0, 3), dvec3(0, 0, 3)}},
             {{dvec3(4, 0, 0), dvec3(6, 0, 0), dvec3(6, 0, 1)}},
             {{dvec3(4, 0, 0), dvec3(6, 0, 1), dvec3(4, 0, 1)}},
             {{dvec3(6, 0, 0), dvec3(10, 0, 0), dvec3(10, 0, 3)}},
             {{dvec3(6, 0, 0), dvec3(10, 0, 3), dvec3(6, 0, 3)}}});
  const std::vector<Wedge> lintel = wedges_of(gap);
  ASSERT_EQ(lintel.size(), 2u);
  EXPECT_NEAR(total_length(lintel), 8.0, 1e-12);
}

}  // namespace
}  // namespace greatx::scene
