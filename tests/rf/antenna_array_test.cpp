// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the positions of elements and the response of an array to a plane wave.
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/rf/antenna_support.h"

namespace greatx::rf {
namespace {

/// Returns the sum of e^{j 2 pi r.d / lambda} over the elements for lambda = 1 m.
Complex array_factor(const AntennaArray& array, const dvec3& direction) {
  Complex sum = 0.0;
  for (uint32_t port = 0; port < array.port_count(); port += array.polarization_count())
    sum += std::polar(1.0, 2.0 * pi * glm::dot(direction, array.element_position(port)));
  return sum;
}

/// Returns |sin(N psi/2) / sin(psi/2)|.
double line_factor(uint32_t n, double psi) {
  const double denominator = std::sin(0.5 * psi);
  return std::abs(denominator) < 1e-12 ? n : std::abs(std::sin(0.5 * n * psi) / denominator);
}

TEST(AntennaArrayFactor, LinesAndRectanglesInEveryPlane) {
  RandomStream random(8, 1);
  for (const ArrayPlane plane : {ArrayPlane::yz, ArrayPlane::xz, ArrayPlane::xy})
    for (const auto& [rows, columns] : {std::pair(1u, 8u), std::pair(5u, 1u), std::pair(4u, 8u)}) {
      AntennaArray array;
      array.plane = plane;
      array.rows = rows;
      array.columns = columns;
      array.row_spacing_m = 2.0;
      array.column_spacing_m = 0.5;
      for (int i = 0; i < 50; ++i) {
        const dvec3 r = random_direction(random);
        const double up = plane == ArrayPlane::xy ? r.y : r.z, across = plane == ArrayPlane::yz ? r.y : r.x;
        const Complex factor = array_factor(array, r);
        EXPECT_NEAR(std::abs(factor),
                    line_factor(rows, 2.0 * pi * 2.0 * up) * line_factor(columns, 2.0 * pi * 0.5 * across),
                    1e-10);
        EXPECT_NEAR(factor.imag(), 0.0, 1e-10);  // the array is centred
      }
    }
}

TEST(AntennaArrayFactor, HalfWaveLineHasItsNulls) {
  AntennaArray line;
  line.columns = 8;
  line.column_spacing_m = 0.5;
  EXPECT_NEAR(std::abs(array_factor(line, {1, 0, 0})), 8.0, 1e-14);
  EXPECT_NEAR(std::abs(array_factor(line, {std::sqrt(1.0 - 1.0 / 16), 0.25, 0})), 0.0, 1e-14);  // sin = 2/N
}

TEST(AntennaArray, GreatMcdPanel) {
  // The panel has 4 x 8 elements of TR 38.901 with slants of +-45 degrees in the y-z plane, 2 wavelengths
  // apart vertically and half a wavelength horizontally: 64 ports.
  const double wavelength = speed_of_light / 28e9;
  AntennaArray panel;
  panel.pattern = Pattern::tr38901;
  panel.polarization = Polarization::slant;
  panel.rows = 4;
  panel.columns = 8;
  panel.row_spacing_m = 2.0 * wavelength;
  panel.column_spacing_m = 0.5 * wavelength;
  ASSERT_EQ(panel.port_count(), 64u);
  EXPECT_NEAR(panel.aperture(), wavelength * std::hypot(6.0, 3.5), 1e-15);
  // The order of ports is: lowest row first, rightmost column (-y) first, +45 degrees first.
  EXPECT_NEAR(glm::distance(panel.element_position(0), dvec3(0, -1.75, -3.0) * wavelength), 0.0, 1e-15);
  EXPECT_NEAR(glm::distance(panel.element_position(2), dvec3(0, -1.25, -3.0) * wavelength), 0.0, 1e-15);
  EXPECT_NEAR(glm::distance(panel.element_position(16), dvec3(0, -1.75, -1.0) * wavelength), 0.0, 1e-15);
  EXPECT_NEAR(glm::distance(panel.element_position(63), dvec3(0, 1.75, 3.0) * wavelength), 0.0, 1e-15);
  EXPECT_EQ(panel.slant(0), pi / 4);
  EXPECT_EQ(panel.slant(63), -pi / 4);
  // At boresight both polarizations have a gain of 8 dBi and are orthogonal.
  Jones fields[2];
  panel.turned_element({1, 0, 0, 0}).respond({1, 0, 0}, fields);
  for (const Jones& field : fields) EXPECT_NEAR(10.0 * std::log10(power(field)), 8.0, 1e-12);
  EXPECT_NEAR(std::abs(fields[0].theta * fields[1].theta + fields[0].phi * fields[1].phi), 0.0, 1e-14);
  EXPECT_NEAR(fields[0].theta.real(), fields[0].phi.real(), 1e-14);
}

TEST(AntennaArray, OneSlantOfItsOwn) {
  AntennaArray array;
  array.polarization = Polarization::single;
  array.single_slant = radians(30.0);
  array.columns = 3;
  EXPECT_EQ(array.port_count(), 3u);
  EXPECT_EQ(array.slant(2), radians(30.0));
}

TEST(AntennaArray, FreeElements) {
  AntennaArray array;
  array.polarization = Polarization::vh;
  array.positions_m = {{0, 0, 0}, {1, 2, 3}, {0, -4, 0}};
  ASSERT_EQ(array.port_count(), 6u);
  EXPECT_EQ(array.element_position(0), dvec3(0, 0, 0));  // as given, not centred
  EXPECT_EQ(array.element_position(2), dvec3(1, 2, 3));
  EXPECT_EQ(array.element_position(3), dvec3(1, 2, 3));
  EXPECT_EQ(array.element_position(5), dvec3(0, -4, 0));
  EXPECT_EQ(array.slant(4), 0.0);
  EXPECT_EQ(array.slant(5), pi / 2);
  EXPECT_NEAR(array.aperture(), std::sqrt(1.0 + 36.0 + 9.0), 1e-15);
  EXPECT_THROW(array.element_position(6), ContractError);
}

TEST(AntennaArray, FreeElementsOnAGridAreTheGrid) {
  AntennaArray grid;
  grid.rows = 3;
  grid.columns = 2;
  grid.row_spacing_m = 0.7;
  grid.column_spacing_m = 0.4;
  AntennaArray free = grid;
  for (uint32_t port = 0; port < grid.port_count(); ++port)
    free.positions_m.push_back(grid.element_position(port));
  for (uint32_t port = 0; port < grid.port_count(); ++port)
    EXPECT_EQ(free.element_position(port), grid.element_position(port));
  EXPECT_NEAR(free.aperture(), grid.aperture(), 1e-15);
}

TEST(AntennaArray, FarFieldCountsFromTheOriginThatPathsEndAt) {
  const double wavelength = 0.1, carrier_hz = speed_of_light / wavelength;
  AntennaArray panel;
  panel.rows = 4, panel.columns = 8, panel.row_spacing_m = 0.2, panel.column_spacing_m = 0.05;
  const double d = panel.aperture();
  EXPECT_NEAR(far_field_distance_m(panel, {}, carrier_hz), 2.0 * d * d / wavelength, 1e-12);
  EXPECT_NEAR(far_field_distance_m(panel, panel, carrier_hz), 8.0 * d * d / wavelength, 1e-12);
  EXPECT_EQ(far_field_distance_m({}, {}, carrier_hz), 0.0);
  AntennaArray off;
  off.positions_m = {{2.0, 0.0, 0.0}};  // one element, 2 m from the origin of the paths
  EXPECT_EQ(off.aperture(), 0.0);
  EXPECT_NEAR(far_field_distance_m(off, {}, carrier_hz), 2.0 * 16.0 / wavelength, 1e-9);
}

TEST(AntennaArray, ApertureOfOneElementIsZero) { EXPECT_EQ(AntennaArray{}.aperture(), 0.0); }

}  // namespace
}  // namespace greatx::rf
