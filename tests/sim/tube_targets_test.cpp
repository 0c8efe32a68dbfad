// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reflectors of known radar cross-sections as targets of a channel that are computed from their surfaces.
// Their size follows the wavelength, so that one closed form holds at every carrier: a = 0.1 m at 77 GHz.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "scene/description/scene_hash.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/kept_run.h"
#include "tests/support/tiny_scene.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;
using Complex = std::complex<double>;

/// Describes the sizes at a carrier.
struct Sizes {
  double carrier_hz;
  double a() const { return 0.1 * 77e9 / carrier_hz; }
  double wavelength() const { return speed_of_light / carrier_hz; }
  double k() const { return 2.0 * pi / wavelength(); }
  double range_m() const { return 4000.0 * a(); }
};

scene::Material perfect_metal() {
  scene::Material material;
  material.name = "metal";
  scene::RadioMaterial radio;
  radio.layers.push_back({*scene::itu_medium("metal"), 0.0});
  material.radio = radio;
  return material;
}

struct Reflector {
  test::TinyScene tiny;
  uint32_t body;
  explicit Reflector() : body(0) {
    const uint32_t metal = tiny.material_as(perfect_metal());
    body = tiny.body("thing");
    tiny.object("thing", body, metal);
  }
  scene::Scene build() const {
    scene::Scene scene = tiny.build();
    scene.hash = scene::hash_of(scene);
    return scene;
  }
};

scene::Scene plate(double a) {
  Reflector r;
  const double h = 0.5 * a;
  r.tiny.quad({0, -h, -h}, {0, h, -h}, {0, h, h}, {0, -h, h});
  return r.build();
}

scene::Scene lying_plate(double a) {
  Reflector r;
  const double h = 0.5 * a;
  r.tiny.quad({-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0});
  return r.build();
}

scene::Scene dihedral(double a) {
  Reflector r;
  r.tiny.quad({0, 0, 0}, {a, 0, 0}, {a, 0, a}, {0, 0, a}).quad({0, 0, 0}, {0, 0, a}, {0, a, a}, {0, a, 0});
  return r.build();
}

scene::Scene trihedral(double a) {
  Reflector r;
  const dvec3 o(0.0), x(a, 0, 0), y(0, a, 0), z(0, 0, a);
  r.tiny.triangle(o, x, y).triangle(o, z, x).triangle(o, y, z);
  return r.build();
}

/// Returns a sphere of 12 n^2 triangles, a cube's grid projected outwards, with vertices that are moved at
/// random along it: a regular mesh has Bragg reflections.
scene::Scene ball(double radius, int n) {
  Reflector r;
  const dquat turn = orientation_from_yaw_pitch_roll(0.4, 0.7, 1.1);
  for (int face = 0; face < 6; ++face) {
    const auto at = [&](int i, int j) {
      const double u = std::tan(0.25 * pi * (2.0 * i / n - 1.0)),
                   v = std::tan(0.25 * pi * (2.0 * j / n - 1.0));
      const double sign = face < 3 ? 1.0 : -1.0;
      dvec3 p(sign, sign * u, v);
      p = glm::normalize(face % 3 == 0 ? p : face % 3 == 1 ? dvec3(p.z, p.x, p.y) : dvec3(p.y, p.z, p.x));
      const dvec3 place = glm::floor(p * 1e6 + 0.5);  // shared vertices move alike
      RandomStream random(1, static_cast<uint32_t>(int64_t(place.x) * 7919 + int64_t(place.y)),
                          static_cast<uint32_t>(int64_t(place.z)));
      const double step = 0.25 * 0.5 * pi / n;
      p += step * dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      return radius * (turn * glm::normalize(p));
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        r.tiny.triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1))
            .triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
  }
  return r.build();
}

/// Returns the cross-section of a convex mesh of conductors in physical optics by brute force, dBsm:
/// quadrature over m^2 points of every lit triangle.
double brute_force_db(const scene::Scene& scene, const dvec3& from, double wavelength, int m) {
  Complex sum(0.0);
  const double distance = glm::length(from), k = 2.0 * pi / wavelength;
  for (const scene::FacetTriangle& t : scene.facet_triangles) {
    const dvec3 u = t.corners[1] - t.corners[0], v = t.corners[2] - t.corners[0], cross = glm::cross(u, v);
    const double area = 0.5 * glm::length(cross);
    const dvec3 normal = cross / (2.0 * area);
    if (glm::dot(normal, from - t.corners[0]) <= 0.0) continue;
    for (int i = 0; i < m; ++i)
      for (int h = 0; h < 2 * (m - i) - 1; ++h) {
        const double third = (h % 2 + 1) / 3.0, b = (i + third) / m, c = (h / 2 + third) / m;
        const dvec3 arm = from - (t.corners[0] + b * u + c * v);
        const double r = glm::length(arm);
        sum += std::polar(area / (m * m) * glm::dot(normal, arm) / r * std::pow(distance / r, 2),
                          -2.0 * k * (r - distance));
      }
  }
  return decibels(4.0 * pi / (wavelength * wavelength) * std::norm(sum));
}

dvec3 direction(double azimuth_deg, double elevation_deg) {
  const double az = radians(azimuth_deg), el = radians(elevation_deg);
  return {std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el)};
}

/// Runs a channel from an antenna that sees the reflector from a direction, to itself or to another one.
KeptRun run_of(const scene::Scene& scene, const Sizes& sizes, const dvec3& from, const dvec3& to,
               const std::string& tubes) {
  const auto place = [&](const dvec3& d) {
    const dvec3 p = sizes.range_m() * d;
    return fmt::format("{{type: static, position_m: [{:.17g}, {:.17g}, {:.17g}]}}", p.x, p.y, p.z);
  };
  const std::string yaml = fmt::format(
      "greatx: 1\nname: test\nticks: 1\ntick_rate_hz: 10\nnodes:\n"
      "  - {{name: a, trajectory: {}, sensors: [{{name: v, type: antenna, polarization: vh}}]}}\n"
      "  - {{name: b, trajectory: {}, sensors: [{{name: v, type: antenna, polarization: vh}}]}}\n"
      "  - {{name: thing, trajectory: {{type: waypoints, points: [{{t_s: 0, position_m: [0, 0, 0], "
      "rotation_deg: "
      "[0, 0, 0]}}]}}, model: {{generate: {{kind: car}}}}}}\n"
      "channels:\n  - {{name: csi, tx: a/v, rx: {}/v, rate_hz: 10, carrier_hz: {:.17g}, subcarriers: 1, "
      "bandwidth_hz: 1e6, max_depth: 0, targets: [{{nodes: thing, tubes: {}}}]}}\n"
      "effects: {{gas: off, line_of_sight: off}}\n",
      place(from), place(to), from == to ? "a" : "b", sizes.carrier_hz, tubes);
  auto world = std::make_shared<const World>(World{scene, {0, 0, 1}, {0, 2}, {}, {}});
  return keep_run(make_experiment(parse_scenario(yaml, "test.yaml", "."), std::move(world)));
}

/// Returns the cross-section that H of the port pair (rx, tx) means, dBsm.
double section_db(const KeptRun& run, const Sizes& sizes, size_t rx = 0, size_t tx = 0) {
  const double h = std::abs(Complex(run.array<std::complex<float>>(0, "csi", "cfr")[2 * rx + tx]));
  const double lambda = sizes.wavelength(), r = sizes.range_m();
  return decibels(h * h * std::pow(4.0 * pi, 3) * std::pow(r, 4) / (lambda * lambda));
}

double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(x) / x; }

class TubeReflectors : public ::testing::TestWithParam<double> {
 protected:
  const Sizes sizes_{GetParam()};
  std::string tubes(double share_of_a, uint32_t budget, uint32_t bounces) const {
    return fmt::format("{{width_m: {:.6g}, budget: {}, max_bounces: {}}}", share_of_a * sizes_.a(), budget,
                       bounces);
  }
  /// Returns 4 pi A^2/lambda^2 of an effective aperture of share * a^2, dBsm.
  double aperture_db(double share) const {
    return decibels(4.0 * pi * std::pow(sizes_.a(), 4) * share * share / std::pow(sizes_.wavelength(), 2));
  }
};

/// The tubes have no pole where the target is.
TEST_P(TubeReflectors, APlateFromStraightAboveAndBelow) {
  const scene::Scene scene = lying_plate(sizes_.a());
  for (const double elevation : {90.0, 88.0, 78.0, 60.0, -90.0}) {
    const dvec3 from = direction(0.0, elevation);
    const KeptRun run = run_of(scene, sizes_, from, from, tubes(0.1, 2000, 1));
    const double off = radians(90.0 - std::abs(elevation));
    const double share = std::cos(off) * sinc(sizes_.k() * sizes_.a() * std::sin(off));
    EXPECT_NEAR(section_db(run, sizes_), aperture_db(share), 0.02) << elevation;
    EXPECT_NEAR(section_db(run, sizes_, 1, 1), aperture_db(share), 0.02) << elevation;
  }
}

TEST_P(TubeReflectors, APlate) {
  const scene::Scene scene = plate(sizes_.a());
  for (const double angle : {0.0, 2.0, 10.0, 33.0}) {
    const dvec3 from = direction(angle, 0.0);
    const KeptRun run = run_of(scene, sizes_, from, from, tubes(0.1, 2000, 1));
    const double share = std::cos(radians(angle)) * sinc(sizes_.k() * sizes_.a() * std::sin(radians(angle)));
    EXPECT_NEAR(section_db(run, sizes_), aperture_db(share), 0.02) << angle;        // theta to theta
    EXPECT_NEAR(section_db(run, sizes_, 1, 1), aperture_db(share), 0.02) << angle;  // phi to phi
    EXPECT_LT(section_db(run, sizes_, 0, 1), aperture_db(share) - 60.0);
    const auto type = run.array<uint8_t>(0, "csi", "interaction");
    const size_t depth = static_cast<size_t>(run.array(0, "csi", "interaction").shape[1]);
    for (size_t i = 0; i < type.size(); i += depth) EXPECT_EQ(type[i], 5);
  }
}

TEST_P(TubeReflectors, ADihedral) {
  const scene::Scene scene = dihedral(sizes_.a());
  for (const double angle : {20.0, 45.0, 60.0}) {
    const dvec3 from = direction(angle, 0.0);
    // Two bounces see an aperture of 2 a^2 min(sin, cos); single bounces are far from their own normals.
    const double share = 2.0 * std::min(std::sin(radians(angle)), std::cos(radians(angle)));
    const KeptRun run = run_of(scene, sizes_, from, from, tubes(0.05, 8000, 2));
    EXPECT_NEAR(section_db(run, sizes_), aperture_db(share), 0.25) << angle;
  }
}

TEST_P(TubeReflectors, ATrihedral) {
  const scene::Scene scene = trihedral(sizes_.a());
  const dvec3 from = glm::normalize(dvec3(1.0));
  // A = a^2 (l + m + n - 2/(l + m + n)), l = m = n (A. C. Bonkowski et al. 1953).
  const double sum = std::sqrt(3.0);
  const KeptRun run = run_of(scene, sizes_, from, from, tubes(0.02, 20000, 3));
  EXPECT_NEAR(section_db(run, sizes_), aperture_db(sum - 2.0 / sum), 0.25);
}

TEST_P(TubeReflectors, ASphere) {
  const double radius = 0.5 * sizes_.a();
  const scene::Scene scene = ball(radius, 24);
  const dvec3 from = direction(25.0, 10.0);
  const KeptRun run = run_of(scene, sizes_, from, from, tubes(0.008, 60000, 1));
  const double found = section_db(run, sizes_);
  EXPECT_NEAR(found, brute_force_db(scene, sizes_.range_m() * from, sizes_.wavelength(), 8), 0.15);
  EXPECT_NEAR(found, decibels(pi * radius * radius), 1.5);
}

/// A bistatic plate in physical optics, with the field across the plane of incidence.
TEST_P(TubeReflectors, ABistaticPlate) {
  const scene::Scene scene = plate(sizes_.a());
  for (const auto& [out, home] : {std::pair(20.0, -20.0), std::pair(0.0, 40.0)}) {
    const KeptRun run = run_of(scene, sizes_, direction(out, 0.0), direction(home, 0.0), tubes(0.1, 2000, 1));
    const double phase = 0.5 * sizes_.k() * sizes_.a() * (std::sin(radians(out)) + std::sin(radians(home)));
    EXPECT_NEAR(section_db(run, sizes_), aperture_db(std::cos(radians(out)) * sinc(phase)), 0.02) << out;
  }
}

INSTANTIATE_TEST_SUITE_P(Carriers, TubeReflectors, ::testing::Values(3.5e9, 28e9, 77e9),
                         [](const auto& carrier) {
                           return fmt::format("At{}MHz", std::lround(carrier.param / 1e6));
                         });

}  // namespace
}  // namespace greatx::sim
