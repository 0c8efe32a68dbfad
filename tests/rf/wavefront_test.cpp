// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lengths between the elements of two arrays, against image sources.
#include "rf/channel/wavefront.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/rf/channel_paths.h"

namespace greatx::rf {
namespace {

struct Plane {
  dvec3 normal;
  double offset;
  dvec3 mirrored(const dvec3& p) const { return p - 2.0 * (glm::dot(normal, p) - offset) * normal; }
};

dvec3 random_point(RandomStream& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

ArrayPose array_of(RandomStream& random, size_t elements, double size_m) {
  ArrayPose end = testing::antenna();
  for (size_t i = 0; i < elements; ++i) end.array.positions_m.push_back(random_point(random, size_m));
  end.orientation = glm::angleAxis(random.uniform(0, 3), glm::normalize(random_point(random, 1)));
  end.wavefront = Wavefront::curved;
  return end;
}
ArrayPose with_squint(ArrayPose end) {
  end.beam_squint = true;
  return end;
}
dvec3 place(const ArrayPose& end, size_t element) {
  return end.orientation * end.array.element_position(static_cast<uint32_t>(element));
}

/// Returns the length of the way from `tx` over the planes to `rx`, by the images of `tx`.
double image_length(dvec3 tx, const dvec3& rx, const std::vector<Plane>& planes) {
  for (const Plane& plane : planes) tx = plane.mirrored(tx);
  return glm::distance(tx, rx);
}

/// Returns the path of reflections at the planes, which the ends must have in this order. The points are
/// where the receiver, and then each point, sees the image of the transmitter.
Path reflected_path(const dvec3& tx, const dvec3& rx, const std::vector<Plane>& planes) {
  std::vector<dvec3> images{tx};
  for (const Plane& plane : planes) images.push_back(plane.mirrored(images.back()));
  Path path;
  path.vertices = {rx};
  dvec3 to = rx;
  for (size_t i = planes.size(); i-- > 0;) {
    const dvec3 direction = images[i + 1] - to;
    const double t =
        (planes[i].offset - glm::dot(planes[i].normal, to)) / glm::dot(planes[i].normal, direction);
    EXPECT_GT(t, 0.0);
    EXPECT_LT(t, 1.0);
    to += t * direction;
    path.vertices.insert(path.vertices.begin(), to);
  }
  path.vertices.insert(path.vertices.begin(), tx);
  path.interactions.resize(planes.size());
  path.length_m = glm::distance(images.back(), rx);
  path.delay_s = path.length_m / speed_of_light;
  path.departure = glm::normalize(path.vertices[1] - tx);
  path.arrival = glm::normalize(path.vertices[path.vertices.size() - 2] - rx);
  return path;
}

/// A floor, a wall and a slope, which reflect a path between ends above and beside them in this order.
std::vector<Plane> some_planes(size_t count) {
  const std::vector<Plane> planes{
      {{0, 0, 1}, 0.0}, {{-1, 0, 0}, -40.0}, {glm::normalize(dvec3(0.1, -1, 0.05)), -32.0}};
  return {planes.begin(), planes.begin() + static_cast<std::ptrdiff_t>(count)};
}

TEST(Leads, OfReflectionsAreThoseOfTheImageSources) {
  RandomStream random(61, 0);
  for (size_t reflections = 0; reflections <= 3; ++reflections) {
    const std::vector<Plane> planes = some_planes(reflections);
    for (int trial = 0; trial < 20; ++trial) {
      const dvec3 tx = dvec3(0, 0, 4) + random_point(random, 2),
                  rx = dvec3(20, 26, 20) + random_point(random, 2);
      const Path path = reflected_path(tx, rx, planes);
      const ArrayPose from = array_of(random, 4, 0.5), to = array_of(random, 3, 0.5);
      Leads leads(from, to);
      std::vector<double> found(leads.pairs());
      leads(path, found.data());
      for (size_t u = 0; u < 3; ++u)
        for (size_t s = 0; s < 4; ++s) {
          const double length = image_length(tx + place(from, s), rx + place(to, u), planes);
          EXPECT_NEAR(found[u * 4 + s] * speed_of_light, path.length_m - length, 2e-13) << reflections;
        }
    }
  }
}

TEST(Leads, KeepTheirDigitsFarAwayAndBecomePlane) {
  RandomStream random(62, 0);
  const ArrayPose from = array_of(random, 4, 0.5), to = array_of(random, 3, 0.5);
  ArrayPose flat_from = from, flat_to = to;
  flat_from.wavefront = flat_to.wavefront = Wavefront::plane;
  Leads curved(from, to), plane(flat_from, flat_to);
  for (const double distance_m : {1e2, 1e4, 1e6, 1e8}) {
    const Path path = reflected_path(dvec3(0.0), distance_m * glm::normalize(dvec3(1, 2, 0.5)), {});
    std::vector<double> of_sphere(12), of_plane(12);
    curved(path, of_sphere.data());
    plane(path, of_plane.data());
    for (size_t u = 0; u < 3; ++u)
      for (size_t s = 0; s < 4; ++s) {
        const dvec3 across = place(to, u) - place(from, s);
        const double along = glm::dot(across, path.departure);
        // To the next order the sphere is below the plane by d^2/2L, d being the distance across the wave.
        const double fall_m = (glm::dot(across, across) - along * along) / (2.0 * distance_m);
        const double difference_m = (of_plane[u * 4 + s] - of_sphere[u * 4 + s]) * speed_of_light;
        EXPECT_NEAR(difference_m, fall_m, 3.0 * fall_m / distance_m + 2e-15) << distance_m;
      }
  }
}

TEST(Leads, OfAScatteringAreSpheresAboutThePatch) {
  RandomStream random(63, 0);
  const dvec3 tx(0, 0, 10), patch(15, 3, 4), rx(20, -12, 2);
  Path path;
  path.vertices = {tx, patch, rx};
  path.interactions.resize(1);
  path.interactions[0].type = InteractionType::scattering;
  path.length_m = glm::distance(tx, patch) + glm::distance(patch, rx);
  path.departure = glm::normalize(patch - tx);
  path.arrival = glm::normalize(patch - rx);
  const ArrayPose from = array_of(random, 4, 0.5), to = array_of(random, 3, 0.5);
  Leads leads(from, to);
  std::vector<double> found(leads.pairs());
  leads(path, found.data());
  for (size_t u = 0; u < 3; ++u)
    for (size_t s = 0; s < 4; ++s)
      EXPECT_NEAR(
          found[u * 4 + s] * speed_of_light,
          path.length_m - glm::distance(tx + place(from, s), patch) - glm::distance(patch, rx + place(to, u)),
          1e-13);
}

TEST(Leads, BehindAnEdgeStayPlane) {
  RandomStream random(64, 0);
  const ArrayPose from = array_of(random, 4, 0.5), to = array_of(random, 3, 0.5);
  Path path = reflected_path({0, 0, 10}, {20, 8, 6}, some_planes(1));
  path.interactions[0].type = InteractionType::diffraction;
  Leads leads(from, to);
  std::vector<double> found(leads.pairs());
  leads(path, found.data());
  for (size_t u = 0; u < 3; ++u)
    for (size_t s = 0; s < 4; ++s)
      EXPECT_NEAR(found[u * 4 + s] * speed_of_light,
                  glm::dot(path.arrival, place(to, u)) + glm::dot(path.departure, place(from, s)), 1e-14);
}

TEST(Leads, AWallThatIsPassedTurnsNothing) {
  RandomStream random(65, 0);
  const ArrayPose from = array_of(random, 4, 0.5), to = array_of(random, 3, 0.5);
  const Path line = reflected_path({0, 0, 10}, {20, 8, 6}, {});
  Path path = line;
  path.vertices.insert(path.vertices.begin() + 1, 0.4 * path.vertices[0] + 0.6 * path.vertices[1]);
  path.interactions.resize(1);
  path.interactions[0].type = InteractionType::transmission;
  Leads leads(from, to);
  std::vector<double> through(leads.pairs()), past(leads.pairs());
  leads(path, through.data());
  leads(line, past.data());
  EXPECT_EQ(through, past);
}

TEST(Curvature, AmplitudesAndTheResponseTurnByTheLeads) {
  RandomStream random(66, 0);
  Path path = reflected_path({0, 0, 10}, {20, 8, 6}, some_planes(2));
  path.transfer[0] = {0.02, 0.01};
  path.transfer[3] = {-0.01, 0.03};
  const ArrayPose from = array_of(random, 4, 0.5), to = array_of(random, 3, 0.5);
  ArrayPose flat_from = from, flat_to = to;
  flat_from.wavefront = flat_to.wavefront = Wavefront::plane;
  Leads curved(from, to), plane(flat_from, flat_to);
  std::vector<double> exact_s(12), plane_s(12);
  curved(path, exact_s.data());
  plane(path, plane_s.data());
  const double carrier_hz = 28e9;
  const ChannelGrid grid{carrier_hz, 4e6, 101, 1, 1e-3};
  const ImpulseResponse found = impulse_response({&path, 1}, from, to, carrier_hz),
                        flat = impulse_response({&path, 1}, flat_from, flat_to, carrier_hz);
  const auto response = frequency_response_fp64({&path, 1}, with_squint(from), with_squint(to), grid),
             flat_response =
                 frequency_response_fp64({&path, 1}, with_squint(flat_from), with_squint(flat_to), grid);
  for (size_t i = 0; i < 12; ++i) {
    const Complex turn = unit_phasor(turns_of(carrier_hz, exact_s[i]) - turns_of(carrier_hz, plane_s[i]));
    EXPECT_LT(std::abs(Complex(found.amplitude[i]) - Complex(flat.amplitude[i]) * turn),
              1e-6 * std::abs(turn * Complex(flat.amplitude[i])));
    for (size_t k = 0; k < 101; ++k) {
      const double f = carrier_hz + grid.subcarrier_number(static_cast<uint32_t>(k)) * 4e6;
      const Complex all = unit_phasor(turns_of(f, exact_s[i]) - turns_of(f, plane_s[i]));
      const Complex expected = flat_response[i * 101 + k] * all;
      EXPECT_LT(std::abs(response[i * 101 + k] - expected), 1e-11 * std::abs(expected)) << i << " " << k;
    }
  }
}

}  // namespace
}  // namespace greatx::rf
