// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks diffraction at the ends of edges against Kirchhoff's integral over plates of any outline, and which
// ends of edges are open.
#include "rf/edges/corners.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/phase.h"
#include "rf/field/finite_reflectors.h"
#include "tests/rf/edge_contributions.h"

namespace greatx::rf {
namespace {

using namespace testing;

/// A plate in the plane z = 0 whose outline is convex, in wavelengths.
HandScene plate(const std::vector<dvec2>& outline) {
  HandScene hand;
  hand.material("metal", 1.0, 1e9);
  std::vector<scene::FacetTriangle> triangles;
  const auto at = [&](size_t i) { return dvec3(outline[i] * wavelength, 0.0); };
  for (size_t i = 2; i < outline.size(); ++i) triangles.push_back({{at(0), at(i - 1), at(i)}});
  hand.facet(triangles, 0, 0);
  return hand;
}

struct Parts {
  Complex edges{0.0}, corners{0.0};
};

/// Returns the mean over both polarizations of what the edges of a conducting plate and their ends diffract,
/// in units of the direct wave: the reflections of the faces cancel.
Parts diffracted(const Setting& setting, const dvec3& tx, const dvec3& rx) {
  Parts parts;
  const double direct = glm::distance(tx, rx);
  const auto mean = [&](const EdgeDyadic& edge, double length) {
    return -0.5 * (edge.matrix[0] + edge.matrix[3]) * (direct / length) *
           unit_phasor(-(length - direct) / wavelength);
  };
  for (const scene::Wedge& wedge : setting.wedges) {
    std::vector<Contribution> one;
    add_single(setting, wedge, tx, rx, one);
    for (const Contribution& path : one) {
      EdgeDyadic edge;
      std::copy_n(path.map.matrix, 4, edge.matrix);
      parts.edges += mean(edge, path.length_m);
    }
    for (const Corner corner : both_corners) {
      const dvec3& at = corner_point(wedge, corner);
      const double before = glm::distance(tx, at), after = glm::distance(at, rx);
      parts.corners += mean(corner_dyadic(wedge, corner, (at - tx) / before, (rx - at) / after, before, after,
                                          setting.world, setting.surfaces),
                            before + after);
    }
  }
  return parts;
}

/// The wave of a corner is Kirchhoff's to the first order of its integral. Where three directions meet
/// closely, the ray and both edges of an oblique corner, it is off by up to 5 % of the direct wave.
TEST(Corners, PlatesOfAnyOutlineHaveKirchhoffsField) {
  const std::vector<std::vector<dvec2>> outlines = {
      {{-6, -9}, {6, -9}, {6, 9}, {-6, 9}},               // rectangle
      {{-8, -6}, {9, -5}, {-2, 10}},                      // triangle
      {{-9, -2}, {-3, -8}, {7, -7}, {8, 3}, {0, 9}},      // pentagon
      {{-20, -1.2}, {20, -1.2}, {20, 1.2}, {-20, 1.2}}};  // strip of two zones
  for (const auto& outline : outlines) {
    const HandScene hand = plate(outline);
    const Setting setting(hand, true);
    const FiniteReflectors reflectors(hand.scene, FacetKinds(1, FacetKind::opaque), {});
    const dvec3 tx(3.0 * wavelength, -2.0 * wavelength, -120.0 * wavelength);
    double worst = 0.0, without = 0.0, mean = 0.0;
    int count = 0;
    for (double x = -30.0; x <= 30.0; x += 1.37)
      for (double y = -30.0; y <= 30.0; y += 1.93) {
        const dvec3 rx = wavelength * dvec3(x, y, 80.0);
        const double t = tx.z / (tx.z - rx.z);
        const dvec3 through = tx + t * (rx - tx);
        const bool hidden = setting.world.contains(0, setting.world.facet(0).plane_coordinates(through));
        // The wave that the plate takes away is the one that it would reflect to the image of the receiver.
        const dvec3 out = glm::normalize(dvec3(rx.x - tx.x, rx.y - tx.y, -(rx.z - tx.z)));
        const dvec3 in(out.x, out.y, -out.z);
        const double before = glm::distance(tx, through), after = glm::distance(through, rx);
        const Complex weight =
            reflectors.weight(setting.world, 0, {through, in, out, before, after}, wave_number, false);
        const Complex taken = hidden ? weight : weight - 1.0;
        const Parts parts = diffracted(setting, tx, rx);
        const Complex direct = hidden ? 0.0 : 1.0;
        const double error = std::abs(direct + parts.edges + parts.corners - (1.0 - taken));
        worst = std::max(worst, error);
        without = std::max(without, std::abs(direct + parts.edges - (1.0 - taken)));
        mean += error, ++count;
      }
    const bool right_angles = outline.size() == 4;
    EXPECT_LT(worst, right_angles ? 0.004 : 0.05) << outline.size() << " corners";
    EXPECT_LT(mean / count, right_angles ? 0.0015 : 0.004) << outline.size() << " corners";
    EXPECT_GT(without, 0.2);
  }
}

/// Returns the open ends of all edges, sorted by height and place.
std::vector<dvec3> open_ends(const HandScene& hand) {
  const std::vector<scene::Wedge> wedges = scene::find_wedges(hand.scene);
  const OpenCorners corners(hand.scene, FacetKinds(hand.scene.facets.size(), FacetKind::opaque), wedges);
  std::vector<dvec3> ends;
  for (uint32_t i = 0; i < wedges.size(); ++i)
    for (const Corner corner : both_corners)
      if (corners.open(i, corner)) ends.push_back(corner_point(wedges[i], corner));
  return ends;
}

/// Adds a box without its lower side.
void add_house(HandScene& hand, const dvec3& low, const dvec3& high) {
  const auto at = [&](int x, int y, int z) {
    return dvec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
  };
  hand.quad(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
  hand.quad(at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0));
  hand.quad(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));
  hand.quad(at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
  hand.quad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
}

TEST(Corners, EdgesOfAHouseEndAtItsRoofAndNotAtItsFoot) {
  HandScene hand;
  hand.material("wall", 5.0);
  hand.ground(50.0);
  add_house(hand, {0, 0, 0}, {8, 6, 5});
  const std::vector<dvec3> ends = open_ends(hand);
  EXPECT_EQ(ends.size(), 12u);  // three edges at each corner of the roof
  for (const dvec3& end : ends) EXPECT_EQ(end.z, 5.0);
}

TEST(Corners, AnEdgeThatGoesOnOrMeetsAWallHasNoEnd) {
  HandScene hand;
  hand.material("wall", 5.0);
  hand.ground(50.0);
  add_house(hand, {0, 0, 0}, {8, 6, 5});  // a row of two houses of one height: the eaves go on
  add_house(hand, {8, 0, 0}, {14, 6, 5});
  add_house(hand, {14, -3, 0}, {20, 9, 9});  // its wall stands across the ends of both eaves
  for (const dvec3& end : open_ends(hand)) {
    EXPECT_FALSE(end.z == 5.0 && end.x > 0.0) << end.x << ", " << end.y;
    EXPECT_GT(end.z, 0.0);
  }
  EXPECT_EQ(open_ends(hand).size(), 2u * 3u + 4u * 3u);
}

TEST(Corners, HardCasePlacesNearAndFarOfTheEdge) {
  // The excess without cancellation: against 80-bit arithmetic, from a millimetre beside the edge to 100 km.
  for (const double scale : {1e-3, 1.0, 1e5})
    for (const double away : {1e-6, 1.0, 1e3})
      for (const double shift : {-3.0, -1e-9, 0.0, 1e-6, 2.0}) {
        const double u = 2.0 * scale, d_u = away * scale, v = (-2.0 + shift) * scale, d_v = away * scale;
        const CornerPlace place = corner_place(u, d_u, v, d_v);
        using Wide = long double;
        const Wide r = std::hypot(Wide{u}, Wide{d_u}), s = std::hypot(Wide{v}, Wide{d_v});
        const Wide whole = std::hypot(Wide{u} - Wide{v}, Wide{d_u} + Wide{d_v});
        EXPECT_NEAR(place.excess_m, static_cast<double>(r + s - whole),
                    2e-18 * static_cast<double>(whole) + 1e-12 * place.excess_m);
        EXPECT_GE(place.excess_m, 0.0);
        EXPECT_EQ(place.inwards_m > 0.0, shift > 0.0);
      }
}

TEST(Corners, LargestExcessLeavesTheStatedStep) {
  for (const double step_db : {0.1, 0.3, 1.0}) {
    const double excess = largest_excess_m(step_db, wave_number);
    const double wave = 0.5 * std::abs(erfcx_on_diagonal(std::sqrt(wave_number * excess)));
    EXPECT_LE(-20.0 * std::log10(1.0 - wave), 1.001 * step_db);
    EXPECT_GE(-20.0 * std::log10(1.0 - wave), 0.9 * step_db);
  }
}

}  // namespace
}  // namespace greatx::rf
