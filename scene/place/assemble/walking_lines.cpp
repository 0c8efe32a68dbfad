// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/assemble/walking_lines.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "scene/place/assemble/polyline.h"

namespace greatx::scene::place {
namespace {

constexpr double band_m = 1.3;  // half the width of the band that a walking line surrounds
constexpr double walks_apart_m = 4.0, off_road_m = 2.0, least_walk_m = 12.0;
constexpr double spot_step_m = 1.0, spot_cell_m = 8.0;

/// Leads from the right of a line's end round to its left. Those who walk inside and outside of the band
/// then stay apart by the same distance: with a step of 0.9 m and a width of 0.55 m they have 3 cm.
void add_half_circle(std::vector<dvec2>& band, const dvec2& middle, const dvec2& ahead) {
  constexpr int parts = 8;
  const dvec2 right(ahead.y, -ahead.x);
  for (int i = 1; i < parts; ++i) {
    const double angle = pi * i / parts;
    band.push_back(middle + band_m * (std::cos(angle) * right + std::sin(angle) * ahead));
  }
}

}  // namespace

std::pair<int64_t, int64_t> WalkingLines::cell_of(const dvec2& p) {
  return {std::llround(std::floor(p.x / spot_cell_m)), std::llround(std::floor(p.y / spot_cell_m))};
}

bool WalkingLines::near(const Spots& spots, const dvec2& p) {
  const auto [x, y] = cell_of(p);
  for (int64_t i = x - 2; i <= x + 2; ++i)
    for (int64_t j = y - 2; j <= y + 2; ++j)
      if (const auto found = spots.find({i, j}); found != spots.end())
        for (const Spot& spot : found->second)
          if (glm::distance(spot.place, p) < spot.radius_m) return true;
  return false;
}

void WalkingLines::mark(Spots& spots, const std::vector<dvec2>& line, double radius_m) {
  for (const dvec2& p : points_along(line, spot_step_m))
    spots[cell_of(p)].push_back({p, std::min(radius_m, 15.0)});
}

void WalkingLines::keep_off(const std::vector<dvec2>& road, double half_width_m) {
  mark(carriageways_, road, half_width_m + off_road_m);
}

void WalkingLines::add(const std::vector<dvec2>& line) {
  std::vector<dvec2> run;
  std::vector<std::vector<dvec2>> runs;
  const auto finish = [&] {
    if (run.size() > 1 && line_length(run) >= least_walk_m) runs.push_back(run);
    run.clear();
  };
  for (const dvec2& p : points_along(line, spot_step_m)) {
    const bool free = rectangle_.holds(p) && !near(carriageways_, p) && !near(walked_, p) && !built_(p);
    free ? run.push_back(p) : finish();
  }
  finish();
  for (const std::vector<dvec2>& free : runs) add_band(free);
}

void WalkingLines::add_band(const std::vector<dvec2>& free) {
  mark(walked_, free, walks_apart_m);
  // Every few metres are enough for the line; its ends are round.
  std::vector<dvec2> middle;
  for (size_t i = 0; i + 1 < free.size(); i += 4) middle.push_back(free[i]);
  middle.push_back(free.back());
  std::vector<dvec2> band = moved_right(middle, band_m), back = moved_right(middle, -band_m);
  std::ranges::reverse(back);
  const size_t n = middle.size();
  add_half_circle(band, middle[n - 1], glm::normalize(middle[n - 1] - middle[n - 2]));
  band.insert(band.end(), back.begin(), back.end());
  add_half_circle(band, middle[0], glm::normalize(middle[0] - middle[1]));
  StreetWalk walk;
  for (const dvec2& p : band) walk.line.emplace_back(p, height_(p));
  walks_.push_back(std::move(walk));
}

}  // namespace greatx::scene::place
