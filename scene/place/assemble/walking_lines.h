// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the lines on which people walk in a place: where nothing is within their reach.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "core/vec.h"
#include "scene/network/network.h"
#include "scene/place/input/box.h"

namespace greatx::scene::place {

class WalkingLines {
 public:
  /// The lines lie within `rectangle` and off what is `built`. The functions outlive this.
  WalkingLines(const Box& rectangle, const std::function<double(const dvec2&)>& height,
               const std::function<bool(const dvec2&)>& built)
      : rectangle_(rectangle), height_(height), built_(built) {}

  /// Keeps later lines off a carriageway of this half width.
  void keep_off(const std::vector<dvec2>& road, double half_width_m);
  /// Makes walking lines of those parts of a line that are off carriageways, houses and other walking lines.
  void add(const std::vector<dvec2>& line);
  std::vector<StreetWalk> take() { return std::move(walks_); }

 private:
  struct Spot {
    dvec2 place;
    double radius_m = 0.0;
  };
  /// Spots by cells of the plane.
  using Spots = std::map<std::pair<int64_t, int64_t>, std::vector<Spot>>;
  static std::pair<int64_t, int64_t> cell_of(const dvec2& p);
  static bool near(const Spots& spots, const dvec2& p);
  static void mark(Spots& spots, const std::vector<dvec2>& line, double radius_m);
  void add_band(const std::vector<dvec2>& free);

  Box rectangle_;
  const std::function<double(const dvec2&)>& height_;
  const std::function<bool(const dvec2&)>& built_;
  Spots carriageways_, walked_;
  std::vector<StreetWalk> walks_;
};

}  // namespace greatx::scene::place
