// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/atmosphere/foliage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/error.h"
#include "scene/material/lossless.h"

namespace greatx::rf {
namespace {

void check_frequency(const scene::Foliage& foliage, double frequency_hz, const std::string& what) {
  if (foliage_model_covers(foliage, frequency_hz)) return;
  throw_user_error(
      "{}: expected a frequency from 0.23 to 95 GHz for Weissberger's model, found {:g} GHz; choose another "
      "frequency, "
      "or give the material 'foliage: {{attenuation_db_per_m: ...}}'",
      what, frequency_hz / 1e9);
}

using Place = std::array<double, 3>;

/// Holds one side of a triangle, with the smaller end first.
struct Side {
  Place low, high;
  int direction = 0;  ///< 1: the triangle runs from low to high; -1: from high to low
};

Side side_of(const dvec3& from, const dvec3& to) {
  const Place a{from.x, from.y, from.z}, b{to.x, to.y, to.z};
  return a < b ? Side{a, b, 1} : Side{b, a, -1};
}

/// Returns the number of edges along which the directions of the sides do not cancel.
size_t open_edges(std::vector<Side> sides) {
  const auto edge = [](const Side& side) { return std::tie(side.low, side.high); };
  std::sort(sides.begin(), sides.end(), [&](const Side& a, const Side& b) { return edge(a) < edge(b); });
  size_t open = 0;
  for (size_t first = 0; first < sides.size();) {
    int balance = 0;
    size_t next = first;
    for (; next < sides.size() && edge(sides[next]) == edge(sides[first]); ++next)
      balance += sides[next].direction;
    open += balance != 0;
    first = next;
  }
  return open;
}

}  // namespace

bool foliage_model_covers(const scene::Foliage& foliage, double frequency_hz) {
  return foliage.attenuation_db_per_m ||
         (frequency_hz >= weissberger_min_hz && frequency_hz <= weissberger_max_hz);
}

template <typename R>
R foliage_db(const scene::Foliage& foliage, const Given<R>& frequency_hz, double depth_m) {
  using std::pow;
  GREATX_CHECK(depth_m >= 0.0 && std::isfinite(depth_m), "{} m of foliage", depth_m);
  if (foliage.attenuation_db_per_m) return *foliage.attenuation_db_per_m * depth_m;
  check_frequency(foliage, value_of(frequency_hz), "foliage");
  const R f = pow(frequency_hz / 1e9, 0.284);
  return depth_m <= weissberger_branch_m ? 0.45 * f * depth_m : 1.33 * f * std::pow(depth_m, 0.588);
}
template double foliage_db<double>(const scene::Foliage&, const double&, double);
template Dual foliage_db<Dual>(const scene::Foliage&, const Dual&, double);

void check_foliage(const scene::Scene& scene, double frequency_hz) {
  std::map<std::pair<uint32_t, uint32_t>, std::vector<Side>> volumes;  // by instance and material
  for (const scene::Facet& facet : scene.facets) {
    const scene::Material& material = scene.materials[facet.material];
    if (!material.radio || !material.radio->foliage || scene::is_lossless(material)) continue;
    check_frequency(*material.radio->foliage, frequency_hz, fmt::format("material '{}'", material.name));
    std::vector<Side>& sides = volumes[{facet.instance, facet.material}];
    for (uint32_t i = 0; i < facet.triangle_count; ++i) {
      const dvec3* corners = scene.facet_triangles[facet.first_triangle + i].corners;
      for (int k = 0; k < 3; ++k) sides.push_back(side_of(corners[k], corners[(k + 1) % 3]));
    }
  }
  for (auto& [volume, sides] : volumes) {
    const size_t open = open_edges(std::move(sides));
    if (open == 0) continue;
    const auto& [instance, material] = volume;
    throw_user_error(
        "scene '{}', object '{}': expected a closed mesh of foliage '{}' (its depth needs an inside), found "
        "{} open "
        "edges",
        scene.name, instance < scene.instances.size() ? scene.instances[instance].name : "?",
        scene.materials[material].name, open);
  }
}

}  // namespace greatx::rf
