// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks hanging wires against what defines a catenary.
#include "scene/generator/objects/wires.h"

#include <cmath>

#include <gtest/gtest.h>

#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {
namespace {

TEST(Wires, EndsSagAndTensionAreThoseOfTheCatenary) {
  for (const double rise : {0.0, 1.3, -6.0})
    for (const double sag : {0.05, 0.7, 9.0}) {
      const double span = 38.0;
      const Catenary wire = catenary(span, rise, sag);
      EXPECT_NEAR(wire.height(0.0), 0.0, 1e-9);
      EXPECT_NEAR(wire.height(span), rise, 1e-9);
      if (rise == 0.0) {
        EXPECT_NEAR(wire.height(0.5 * span), -sag, 1e-9);
        EXPECT_NEAR(wire.lowest, 0.5 * span, 1e-9);
      }
      // Equilibrium: what the tension turns by along a metre is the weight of that metre.
      const double h = 0.05;
      for (double x = 1.0; x < span; x += 5.0) {
        const double slope = (wire.height(x + h) - wire.height(x - h)) / (2.0 * h);
        const double bend = (wire.height(x + h) - 2.0 * wire.height(x) + wire.height(x - h)) / (h * h);
        EXPECT_NEAR(bend * wire.scale / std::sqrt(1.0 + slope * slope), 1.0, 1e-4) << rise << ' ' << sag;
      }
    }
}

TEST(Wires, LengthIsThatOfManyChords) {
  const Catenary wire = catenary(38.0, 2.0, 4.0);
  double sum = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double a = 38.0 * i / 4000, b = 38.0 * (i + 1) / 4000;
    sum += std::hypot(b - a, wire.height(b) - wire.height(a));
  }
  EXPECT_NEAR(wire.length(0.0, 38.0), sum, 1e-5);
}

TEST(Wires, ChordsStayNearTheWire) {
  const dvec3 from(3.0, -2.0, 7.0), to(30.0, 20.0, 8.5);
  constexpr double sag = 0.7;
  constexpr int pieces = 8;
  const std::vector<dvec3> line = hanging_wire(from, to, sag, pieces);
  ASSERT_EQ(line.size(), size_t{pieces} + 1);
  EXPECT_LT(glm::distance(line.front(), from) + glm::distance(line.back(), to), 1e-9);
  const double span = glm::length(dvec2(to - from));
  const Catenary wire = catenary(span, 1.5, sag);
  double most = 0.0;
  for (int i = 0; i < pieces; ++i)
    for (const double t : {0.25, 0.5, 0.75}) {
      const double x = span * (i + t) / pieces;
      const double chord = glm::mix(line[size_t(i)].z, line[size_t(i) + 1].z, t);
      EXPECT_GE(chord, from.z + wire.height(x) - 1e-9);
      most = std::max(most, chord - from.z - wire.height(x));
    }
  EXPECT_LT(most, 1.02 * sag / (pieces * pieces));
  EXPECT_GT(most, 0.9 * sag / (pieces * pieces));
}

TEST(Wires, AWireIsAClosedPrismOfItsRadius) {
  MeshBuilder mesh;
  const std::vector<dvec3> line = hanging_wire({0, 0, 6}, {38, 4, 6.5}, 0.7, 8);
  add_wire(mesh, material("wire"), line, 0.009);
  ASSERT_EQ(mesh.primitives().size(), 1u);
  const PrimitiveData& wire = mesh.primitives().front();
  EXPECT_EQ(wire.indices.size(), 3u * (8 * 6 + 2));
  // A closed surface: its volume by the divergence theorem is that of a triangular prism.
  double volume = 0.0;
  for (size_t i = 0; i < wire.indices.size(); i += 3) {
    const dvec3 a(wire.positions[wire.indices[i]]), b(wire.positions[wire.indices[i + 1]]),
        c(wire.positions[wire.indices[i + 2]]);
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  const double area = 0.75 * std::sqrt(3.0) * 0.009 * 0.009;
  // Corners are whole millimetres.
  EXPECT_NEAR(volume / (area * glm::length(dvec2(38.0, 4.0))), 1.0, 0.1);
}

}  // namespace
}  // namespace greatx::scene::generator
