// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The image method, through the whole search: beams, images, visibility on the device.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "apps/selftest/catalogue.h"
#include "core/units.h"
#include "scene/build/build.h"

namespace greatx::apps::selftest {

namespace {

using rf::Path;

double count_of(const std::vector<Path>& paths, size_t interactions) {
  return static_cast<double>(std::ranges::count_if(
      paths, [&](const Path& path) { return path.interactions.size() == interactions; }));
}

/// Adds a square wall across the x axis, facing the origin.
void add_wall(Stage& stage, double x, double half = 20.0) {
  stage.quad({x, half, -half}, {x, -half, -half}, {x, -half, half}, {x, half, half});
}

void n12_beside_a_wall(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  add_wall(stage, 10.0);
  const scene::Scene scene = stage.build();
  Links links(lab, scene, {});
  const dvec3 transmitter(9.995, 1.0, 2.0);
  const std::vector<dvec3> receivers{{0.0, -3.0, -1.0}, {lab.given(1.0) == 1.0 ? 10.5 : 9.5, 0.0, 0.0}};
  const auto paths = links.solve(transmitter, receivers);
  rows.add("reflections 5 mm in front of a wall", lab.host_and_tracer(), 1.0, count_of(paths[0], 1), 0.0);
  rows.add("paths through the wall 5 mm away", lab.host_and_tracer(), 0.0,
           static_cast<double>(paths[1].size()), 0.0);
}

void n13_refused(const Lab& lab, Rows& rows) {
  double refused = 0.0;
  for (const dvec3& corner : {dvec3(2, 0, 0), dvec3(1, 0, 0), dvec3(std::nan(""), 0, 0)}) {
    Stage stage = lab.stage();
    stage.triangle({0, 0, 0}, {1, 0, 0}, corner).triangle({0, 0, 1}, {1, 0, 1}, {0, 1, 1});
    try {
      (void)stage.build();
    } catch (const UserError&) {
      ++refused;
    }
  }
  rows.add("triangles of no area, with equal corners, of NaN: refused", host, 3.0, refused, 0.0);
}

void n15_end_in_the_plane(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  stage.quad({-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0});
  const scene::Scene scene = stage.build();
  Links links(lab, scene, {});
  const double lift = lab.given(1.0) - 1.0;  // 0
  const dvec3 in_plane(3, 4, lift), above(-5, 2, 3);
  for (const bool receiver : {false, true}) {
    const std::vector<Path> paths = receiver ? links.solve(above, in_plane) : links.solve(in_plane, above);
    double finite = 0.0;
    for (const Path& path : paths)
      finite +=
          std::isfinite(path.delay_s) && path.delay_s > 0.0 && std::isfinite(std::abs(path.transfer[0]));
    rows.add(receiver ? "paths to a receiver in the plane" : "paths from a transmitter in the plane",
             lab.host_and_tracer(), 1.0, finite, 0.0);
  }
}

void n17_same_place(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  stage.box({-6, -5, -4}, {6, 5, 4});
  const scene::Scene scene = stage.build();
  Links links(lab, scene, {});
  const dvec3 at(1, 2, 0.5);
  const std::vector<Path> paths = links.solve(at, at + dvec3(0, 0, lab.given(1.0) - 1.0));
  rows.add("lines of sight to itself", lab.host_and_tracer(), 0.0, count_of(paths, 0), 0.0);
  rows.add("echoes off six walls", lab.host_and_tracer(), 6.0, count_of(paths, 1), 0.0);
}

void n18_diagonal(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  stage.quad({-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0});
  const scene::Scene scene = stage.build();
  Links links(lab, scene, {});
  const std::vector<Path> paths = links.solve({1, -2, 3}, {5, 4, 3});
  double on_diagonal = 0.0;
  for (const Path& path : links.solve({-2, -3, 3}, lab.given({4, 5, 3})))  // by way of (1, 1, 0)
    on_diagonal += path.interactions.size() == 1 && path.vertices[1].x == path.vertices[1].y;
  rows.add("reflections on the diagonal of a quad", lab.host_and_tracer(), 1.0, on_diagonal, 0.0);
  rows.add("reflections beside it", lab.host_and_tracer(), 1.0, count_of(paths, 1), 0.0);
}

void n19_duplicates(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  for (const char* name : {"one", "two", "three"}) {
    stage.object(name);
    add_wall(stage, 10.0);
  }
  const scene::Scene scene = stage.build();
  Links links(lab, scene, {.max_depth = 2});
  const std::vector<Path> paths = links.solve({0, 3, -3}, {1, -4, -5});
  rows.add("paths off a wall that exists three times", lab.host_and_tracer(), 2.0,
           static_cast<double>(paths.size()), 0.0);
}

void n20_corner(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  stage.object("x").quad({0, 0, -20}, {0, 20, -20}, {0, 20, 20}, {0, 0, 20});
  stage.object("y").quad({0, 0, -20}, {0, 0, 20}, {20, 0, 20}, {20, 0, -20});
  const scene::Scene scene = stage.build();
  Links links(lab, scene, {.max_depth = 2});
  // The double reflection passes through the edge itself: xy and yx are one polyline.
  const std::vector<Path> paths = links.solve({3, 4, 1}, {6, 8, 2});
  rows.add("double reflections in the edge of a corner", lab.host_and_tracer(), 1.0, count_of(paths, 2), 0.0);
}

/// Returns the squared distances of the images of order 0 to `most` of a shoe box [0, size].
std::vector<double> lattice(const dvec3& size, const dvec3& from, const dvec3& to, int most) {
  std::vector<double> lengths;
  const auto image = [](double s, double at, int n) { return n % 2 == 0 ? n * s + at : (n + 1) * s - at; };
  for (int x = -most; x <= most; ++x)
    for (int y = -most; y <= most; ++y)
      for (int z = -most; z <= most; ++z)
        if (std::abs(x) + std::abs(y) + std::abs(z) <= most)
          lengths.push_back(glm::length(
              dvec3(image(size.x, from.x, x), image(size.y, from.y, y), image(size.z, from.z, z)) - to));
  std::ranges::sort(lengths);
  return lengths;
}

void n21_shoe_box(const Lab& lab, Rows& rows) {
  const dvec3 size(5.25, 4.125, 2.75), from(1.375, 0.8125, 1.25), to(4.0625, 3.1875, 0.9375);
  Stage stage = lab.stage();
  stage.box(dvec3(0.0), size);
  const scene::Scene scene = stage.build();
  Links links(lab, scene, {.max_depth = 4});
  const std::vector<Path> paths = links.solve(from, lab.given(to));
  const double counts[] = {1, 6, 18, 38, 66};
  for (size_t order = 0; order < 5; ++order)
    rows.add("paths of order " + std::to_string(order), lab.host_and_tracer(), counts[order],
             count_of(paths, order), 0.0);
  std::vector<double> found;
  for (const Path& path : paths) found.push_back(path.delay_s * speed_of_light);
  std::ranges::sort(found);
  const std::vector<double> exact = lattice(size, from, to, 4);
  double worst = found.size() == exact.size() ? 0.0 : std::nan("");
  for (size_t i = 0; i < std::min(found.size(), exact.size()); ++i)
    worst = std::max(worst, std::abs(found[i] / exact[i] - 1.0));
  rows.add("largest relative error of delay", host, 0.0, worst, 1e-12);
}

void n23_four_millimetres(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  const uint32_t pane = stage.material(6.3, 0.01, 0.002);
  for (const double x : {10.0, 10.00390625}) {
    stage.object("pane", pane);
    add_wall(stage, x);
  }
  const scene::Scene scene = stage.build();
  Links links(lab, scene, {.max_depth = 3, .walls = true});
  const std::vector<Path> paths = links.solve({0, 3, -3}, {1, -4, -5});
  double off_first = 0.0, off_second = 0.0;
  for (const Path& path : paths) {
    off_first += path.interactions.size() == 1;
    off_second += path.interactions.size() == 3;  // in through the first pane, off the second, out again
  }
  rows.add("reflections off the first of two panes 4 mm apart", lab.host_and_tracer(), 1.0, off_first, 0.0);
  rows.add("reflections off the second, through the first", lab.host_and_tracer(), 1.0, off_second, 0.0);
}

void n24_grazing(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  stage.quad({-1000, -1000, 0}, {1000, -1000, 0}, {1000, 1000, 0}, {-1000, 1000, 0});
  const scene::Scene scene = stage.build();
  Links links(lab, scene, {});
  const double height = 900.0 * std::tan(radians(0.01));  // 89.99 degrees of incidence
  const std::vector<Path> paths = links.solve({-900, 0, height}, {900, 0, lab.given(height)});
  double error = std::nan("");
  for (const Path& path : paths)
    if (path.interactions.size() == 1)
      error = std::abs(path.delay_s * speed_of_light / std::hypot(1800.0, 2.0 * height) - 1.0);
  rows.add("reflections at 89.99 degrees", lab.host_and_tracer(), 1.0, count_of(paths, 1), 0.0);
  rows.add("relative error of delay", host, 0.0, error, 1e-12);
}

bool same_bits(const std::vector<Path>& a, const std::vector<Path>& b) {
  return std::ranges::equal(a, b, [](const Path& p, const Path& q) {
    return p.interactions == q.interactions && p.vertices == q.vertices && p.delay_s == q.delay_s &&
           std::equal(p.transfer, p.transfer + 4, q.transfer);
  });
}

/// A room with two pillars, whose paths the cases below compare.
scene::Scene pillars(const Lab& lab, const dvec3& shift = dvec3(0.0), const dvec3& origin = dvec3(0.0)) {
  Stage stage = lab.stage();
  stage.object("room").box({-10, -8, 0}, {10, 8, 5});
  stage.object("pillar").box({-3, -2, 0}, {-2, -1, 5});
  stage.object("pillar").box({2, 1, 0}, {3, 2.5, 5});
  return stage.build(shift, origin);
}

std::vector<dvec3> spread_receivers(uint32_t count) {
  RandomStream random(25, 1);
  std::vector<dvec3> receivers;
  while (receivers.size() < count)
    receivers.push_back({random.uniform(-9, 9), random.uniform(-7, 7), random.uniform(0.5, 4.5)});
  return receivers;
}

void n07_paths_at_utm(const Lab& lab, Rows& rows) {
  const dvec3 utm(500000.0, 5411000.0, 0.0), off(-37.0, 54.0, 8.0);
  const scene::Scene here = pillars(lab), there = pillars(lab, utm, utm + off);
  Links near(lab, here, {.max_depth = 2}), far(lab, there, {.max_depth = 2});
  std::vector<dvec3> receivers = spread_receivers(8), moved;
  for (const dvec3& receiver : receivers) moved.push_back(lab.given(receiver) - off);
  const dvec3 transmitter(-7.5, 6.25, 3.0);
  const auto a = near.solve(transmitter, receivers), b = far.solve(transmitter - off, moved);
  double worst = 0.0;
  for (size_t r = 0; r < a.size(); ++r) {
    if (a[r].size() != b[r].size()) worst = std::nan("");
    for (size_t i = 0; i < std::min(a[r].size(), b[r].size()); ++i)
      worst = std::max(worst, std::abs(a[r][i].length_m - b[r][i].length_m));
  }
  rows.add("largest change of length at UTM coordinates, m", lab.host_and_tracer(), 0.0, worst, 1e-9);
}

void n25_alone(const Lab& lab, Rows& rows) {
  const scene::Scene scene = pillars(lab);
  Links links(lab, scene, {.max_depth = 2});
  const std::vector<dvec3> receivers = spread_receivers(100);
  const dvec3 transmitter(-7.5, 6.25, 3.0);
  const auto all = links.solve(transmitter, receivers);
  double differ = 0.0;
  for (const size_t r : {0u, 13u, 57u, 99u})
    differ += !same_bits(all[r], links.solve(transmitter, lab.given(receivers[r])));
  rows.add("receivers alone that differ from those among 100", lab.host_and_tracer(), 0.0, differ, 0.0);
}

void n63_threads_of_the_search(const Lab& lab, Rows& rows) {
  const scene::Scene scene = pillars(lab);
  const std::vector<dvec3> receivers = spread_receivers(6);
  std::vector<std::vector<std::vector<Path>>> found;
  for (const uint32_t threads : {1u, 2u, 16u}) {
    Links links(lab, scene, {.max_depth = 3, .threads = threads});
    const dvec3 transmitter(-7.5, 6.25, 3.0);
    found.push_back(links.solve(threads == 1 ? transmitter : lab.given(transmitter), receivers));
  }
  double differ = 0.0;
  for (size_t i = 1; i < found.size(); ++i)
    for (size_t r = 0; r < receivers.size(); ++r) differ += !same_bits(found[0][r], found[i][r]);
  rows.add("links that differ with 2 or 16 threads", lab.host_and_tracer(), 0.0, differ, 0.0);
}

void n52_both_directions(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  const uint32_t metal = stage.material(1.0, 1e14, 0.0);
  stage.object("floor", metal).quad({-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0});
  stage.object("block", metal).box({3, -2, 0}, {5, 2, 6});
  const scene::Scene scene = stage.build();
  Links links(lab, scene, {.max_depth = 2});
  const dvec3 a(-6, 3, 2), b(-4, -7, 3);
  const rf::ChannelGrid grid{3.5e9, 30e3, 16, 1, 1e-3};
  const rf::ArrayPose dipole = antenna(rf::Pattern::half_wave_dipole, rf::Polarization::vh);
  const auto there = rf::frequency_response_fp64(links.solve(a, b), dipole, dipole, grid);
  const auto back = rf::frequency_response_fp64(links.solve(lab.given(b), a), dipole, dipole, grid);
  double worst = there.size() == back.size() ? 0.0 : std::nan(""), largest = 0.0;
  for (const auto& value : there) largest = std::max(largest, std::abs(value));
  for (size_t rx = 0; rx < 2; ++rx)  // [rx][tx][subcarrier]
    for (size_t tx = 0; tx < 2; ++tx)
      for (size_t k = 0; k < 16; ++k)
        worst = std::max(worst, std::abs(there[(rx * 2 + tx) * 16 + k] - back[(tx * 2 + rx) * 16 + k]));
  rows.add("change of H in the other direction, of its largest value", lab.host_and_tracer(), 0.0,
           worst / largest, 1e-6);
}

void n64_no_paths(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  stage.box({-1, -1, -1}, {1, 1, 1});
  const scene::Scene scene = stage.build();
  Links links(lab, scene, {.max_depth = 2});
  // The receiver is outside of the closed box.
  const auto paths = links.solve({0.25, 0.125, 0.5}, {lab.given(1.0) == 1.0 ? 5.0 : 0.5, 0.75, 0.25});
  rows.add("paths out of a closed box", lab.host_and_tracer(), 0.0, static_cast<double>(paths.size()), 0.0);
  double sum = 0.0;
  for (const auto& value : rf::frequency_response(paths, antenna(), antenna(), {3.5e9, 30e3, 64, 1, 1e-3}))
    sum += std::abs(value);
  rows.add("sum of |H| without a path", "host, complex64", 0.0, sum, 0.0);
}

constexpr Case list_of_path_cases[] = {
    {7, "paths at UTM coordinates", n07_paths_at_utm},
    {12, "transmitter 5 mm from a wall", n12_beside_a_wall},
    {13, "triangles without area or with NaN", n13_refused},
    {15, "end in the reflecting plane (15, 16)", n15_end_in_the_plane},
    {17, "transmitter = receiver", n17_same_place},
    {18, "diagonal of a quad", n18_diagonal},
    {19, "coplanar duplicates", n19_duplicates},
    {20, "tie in a corner", n20_corner},
    {21, "shoe box, orders 0 to 4", n21_shoe_box},
    {23, "two walls 4 mm apart", n23_four_millimetres},
    {24, "grazing incidence", n24_grazing},
    {25, "receiver alone and among 100", n25_alone},
    {52, "both directions of a link", n52_both_directions},
    {63, "threads of the search", n63_threads_of_the_search},
    {64, "no path", n64_no_paths},
};

}  // namespace

std::span<const Case> path_cases() { return list_of_path_cases; }

}  // namespace greatx::apps::selftest
