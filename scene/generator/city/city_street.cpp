// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/city/city_street.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "scene/generator/city/city_ground.h"
#include "scene/generator/objects/objects.h"
#include "scene/generator/objects/street_furniture.h"
#include "scene/generator/objects/street_pieces.h"

namespace greatx::scene::generator {

namespace {

/// A piece that may stand at a kerb.
struct Piece {
  const char* name;
  double half_m;   ///< of its length along the kerb
  double depth_m;  ///< of its middle from the kerb
  double turn;     ///< yaw against the direction into the block, rad
  bool wide;       ///< needs the pavement of an avenue
  double weight;
};

constexpr std::array<Piece, 10> pieces{{{"bench", 0.9, 1.0, 0.5 * pi, true, 1.6},
                                        {"bin", 0.3, 0.6, 0.0, false, 1.2},
                                        {"bollards", 2.4, 0.4, 0.0, false, 0.8},
                                        {"bicycle_rack", 1.5, 1.35, -0.5 * pi, true, 1.5},
                                        {"post_box", 0.4, 0.6, pi, false, 0.4},
                                        {"hydrant", 0.3, 0.5, 0.0, false, 0.4},
                                        {"planter", 0.9, 0.66, -0.5 * pi, false, 0.9},
                                        {"advertising_column", 0.8, 1.5, 0.0, true, 0.5},
                                        {"cabinet", 0.8, 0.6, -0.5 * pi, false, 0.6},
                                        {"sign", 0.3, 0.45, 0.0, false, 1.1}}};

const Piece& choose(bool avenue, double draw) {
  double total = 0.0;
  for (const Piece& p : pieces)
    if (avenue || !p.wide) total += p.weight;
  double left = draw * total;
  for (const Piece& p : pieces) {
    if (!avenue && p.wide) continue;
    left -= p.weight;
    if (left < 0.0) return p;
  }
  return pieces[1];
}

}  // namespace

Kerb::Kerb(const Block& block, int edge)
    : start(block.edge_start(edge)),
      along(block.edge_end(edge) - start),
      length(glm::length(along)),
      avenue(block.pavement_m[static_cast<size_t>(edge)] >= 4.0) {
  along /= length;
  inwards = dvec2(-along.y, along.x);
}

void CityStreet::place(const std::string& name, const std::string& mesh, const Make& make, const dvec2& where,
                       double yaw, SemanticClass semantic_class) {
  const auto found = meshes_.find(mesh);
  const int index = found != meshes_.end() ? found->second : meshes_[mesh] = writer_.add_mesh(mesh, make());
  writer_.add_node({.name = fmt::format("{}_{:03}", name, counts_[name]++),
                    .mesh = index,
                    .position = dvec3(where, pavement_height_m),
                    .yaw = yaw,
                    .semantic_class = semantic_class});
}

void CityStreet::furnish(const Block& block, const TakenPlaces& taken) {
  RandomStream random(seed_, 6, static_cast<uint32_t>(64 * block.row + block.column));
  for (int edge = 0; edge < 4; ++edge) {
    if (!block.street[static_cast<size_t>(edge)]) continue;
    const Kerb kerb(block, edge);
    const double length = kerb.length;
    const bool avenue = kerb.avenue;
    std::vector<double> full = taken[static_cast<size_t>(edge)];
    for (double at = 6.5; at < length - 6.5; at += random.uniform(3.0, avenue ? 8.0 : 12.0)) {
      const Piece& piece = choose(avenue, random.uniform());
      const uint32_t draw = random.below(1000);
      const auto clear = [&](double t) { return std::abs(t - at) > piece.half_m + 0.9; };
      if (at + piece.half_m > length - 6.0 || at - piece.half_m < 6.0 || !std::ranges::all_of(full, clear))
        continue;
      full.push_back(at - 0.6 * piece.half_m);
      full.push_back(at + 0.6 * piece.half_m);
      const dvec2 spot = snap(kerb.spot(at, piece.depth_m));
      const double yaw = std::atan2(kerb.inwards.y, kerb.inwards.x) + piece.turn;
      const std::string name = piece.name;
      if (name == "bench") {
        place("seat", "seat", make_bench, spot, yaw);
      } else if (name == "bin") {
        place("litter_bin", "litter_bin", make_bin, spot, yaw);
      } else if (name == "bollards") {
        for (const double shift : {-1.6, 0.0, 1.6})
          place("bollard", "bollard", make_bollard, snap(spot + shift * kerb.along), yaw);
      } else if (name == "bicycle_rack") {
        place(
            name, fmt::format("bicycle_rack_{}", draw % 4), [&] { return make_bicycle_rack(draw % 4); }, spot,
            yaw);
      } else if (name == "post_box") {
        place(name, name, make_post_box, spot, yaw);
      } else if (name == "hydrant") {
        place(name, name, make_hydrant, spot, yaw);
      } else if (name == "planter") {
        place(
            name, fmt::format("planter_{}", draw % 2), [&] { return make_planter(draw % 2 * 16); }, spot,
            yaw);
      } else if (name == "advertising_column") {
        place(name, name, make_advertising_column, spot, yaw);
      } else if (name == "cabinet") {
        place(name, name, make_cabinet, spot, yaw);
      } else {
        // Drivers beside this pavement come from b, so that signs face along the edge.
        static constexpr std::array<SignKind, 5> kinds{SignKind::no_parking, SignKind::parking,
                                                       SignKind::priority, SignKind::speed_30,
                                                       SignKind::one_way};
        const SignKind kind = kinds[draw % kinds.size()];
        place(
            "traffic_sign", fmt::format("traffic_sign_{}", static_cast<int>(kind)),
            [&] { return make_traffic_sign(kind); }, spot, std::atan2(kerb.along.y, kerb.along.x),
            SemanticClass::pole);
      }
    }
  }
}

void CityStreet::grate(const dvec2& where, double yaw) {
  place("tree_grate", "tree_grate", make_tree_grate, where, yaw, SemanticClass::pavement);
}

void CityStreet::cafe(const dvec2& where, const dvec2& out) {
  place("cafe", "cafe", make_cafe, where, std::atan2(out.y, out.x) - 0.5 * pi);
}

}  // namespace greatx::scene::generator
