// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/event/pixel_paths.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace greatx::sim {

namespace {

constexpr double most_error_px = 0.02;

/// Holds a PixelPath in fp64, as twelve numbers: r0, rx, ry, o.
using PathNumbers = std::array<double, 12>;

/// Returns the path for a pose of the camera at the instant in the frame of the camera at the picture.
PathNumbers path_of(const PinholeConfig& camera, const Pose& picture_from_instant) {
  const auto pixels = [&](const dvec3& sensor) {
    const dvec3 p = to_optical(sensor);
    return dvec3(camera.fx * p.x + camera.cx * p.z, camera.fy * p.y + camera.cy * p.z, p.z);
  };
  const auto turned = [&](const dvec3& optical) {
    return pixels(picture_from_instant.rotate(from_optical(optical)));
  };
  const dvec3 rx = turned({1.0 / camera.fx, 0.0, 0.0}), ry = turned({0.0, 1.0 / camera.fy, 0.0});
  const dvec3 r0 = turned({-camera.cx / camera.fx, -camera.cy / camera.fy, 1.0});
  const dvec3 o = pixels(picture_from_instant.position);
  PathNumbers numbers;
  for (int i = 0; i < 3; ++i) {
    numbers[i] = r0[i];
    numbers[3 + i] = rx[i];
    numbers[6 + i] = ry[i];
    numbers[9 + i] = o[i];
  }
  return numbers;
}

shared::PixelPath rounded(const PathNumbers& n) {
  return {vec3(n[0], n[1], n[2]), vec3(n[3], n[4], n[5]), vec3(n[6], n[7], n[8]), vec3(n[9], n[10], n[11])};
}

/// Returns the coefficients of the cubic through the values at 0, 1/3, 2/3 and 1.
std::array<PathNumbers, 4> cubic_through(const std::array<PathNumbers, 4>& at) {
  std::array<PathNumbers, 4> c;
  for (size_t i = 0; i < 12; ++i) {
    const double a = at[0][i], b = at[1][i], d = at[2][i], e = at[3][i];
    c[0][i] = a;
    c[1][i] = 0.5 * (-11.0 * a + 18.0 * b - 9.0 * d + 2.0 * e);
    c[2][i] = 4.5 * (2.0 * a - 5.0 * b + 4.0 * d - e);
    c[3][i] = 4.5 * (-a + 3.0 * b - 3.0 * d + e);
  }
  return c;
}

double value_of(const std::array<PathNumbers, 4>& c, size_t i, double t) {
  return c[0][i] + t * (c[1][i] + t * (c[2][i] + t * c[3][i]));
}

/// Returns how far, in pixels, the cubic takes a point at the nearest distance from its right place, at the
/// corners of the picture.
double error_of(const PinholeConfig& camera, const std::array<PathNumbers, 4>& cubic,
                const PathNumbers& right, double t, double nearest_m) {
  const auto wrong = [&](size_t i) { return value_of(cubic, i, t) - right[i]; };
  double worst = 0.0;
  for (const double x : {0.0, double(camera.width)})
    for (const double y : {0.0, double(camera.height)}) {
      dvec3 error{0.0};
      for (size_t i = 0; i < 3; ++i)
        error[int(i)] = wrong(i) + x * wrong(3 + i) + y * wrong(6 + i) + wrong(9 + i) / nearest_m;
      // A change of the homogeneous z moves the place by at most its distance from the origin.
      worst = std::max(worst, glm::length(dvec2(error)) + std::abs(error.z) * std::hypot(x, y));
    }
  return worst;
}

}  // namespace

void find_pixel_paths(const PinholeConfig& camera, uint32_t grid, double nearest_m,
                      const std::function<EventMoment(double)>& moment_at, render::PixelPaths& paths) {
  const std::array<EventMoment, 2> pictures{moment_at(0.0), moment_at(1.0)};
  paths.bodies = static_cast<uint32_t>(pictures[0].bodies.size());
  paths.exact_world = false;
  const auto path = [&](uint32_t picture, const EventMoment& moment, uint32_t body) {
    const Pose& there = pictures[picture].bodies[body];
    const Pose moved = body == 0 ? moment.camera : there * (moment.bodies[body].inverse() * moment.camera);
    return path_of(camera, pictures[picture].camera.inverse() * moved);
  };
  std::array<EventMoment, 4> nodes{pictures[0], moment_at(1.0 / 3.0), moment_at(2.0 / 3.0), pictures[1]};
  std::array<std::array<PathNumbers, 4>, 2> cubics;
  for (const uint32_t picture : {0u, 1u}) {
    std::array<PathNumbers, 4> at;
    for (size_t i = 0; i < 4; ++i) at[i] = path(picture, nodes[i], 0);
    cubics[picture] = cubic_through(at);
    for (size_t i = 0; i < 4; ++i) paths.world[4 * picture + i] = rounded(cubics[picture][i]);
  }
  const size_t of_picture = size_t{grid + 1} * paths.bodies;
  paths.of_bodies.resize(2 * of_picture);
  for (uint32_t k = 0; k <= grid; ++k) {
    const double t = double(k) / double(grid);
    const EventMoment moment = k == 0 ? pictures[0] : k == grid ? pictures[1] : moment_at(t);
    for (const uint32_t picture : {0u, 1u})
      for (uint32_t body = 0; body < paths.bodies; ++body) {
        const PathNumbers right = path(picture, moment, body);
        paths.of_bodies[picture * of_picture + k * paths.bodies + body] = rounded(right);
        if (body == 0 && !(error_of(camera, cubics[picture], right, t, nearest_m) < most_error_px))
          paths.exact_world = true;
      }
  }
}

}  // namespace greatx::sim
