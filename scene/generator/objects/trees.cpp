// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/trees.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/paint/texture_painter.h"

namespace greatx::scene::generator {

namespace {

/// Adds a pyramid from its foot, a polygon of three or more sides, to a tip. Its sides are triangles, so that
/// each is one plane.
void add_spike(MeshBuilder& mesh, int bark, std::vector<dvec3> foot, const dvec3& tip, double tall) {
  if (glm::dot(glm::cross(foot[1] - foot[0], foot[2] - foot[0]), tip - foot[0]) < 0.0)
    std::reverse(foot.begin(), foot.end());
  for (size_t i = 0; i < foot.size(); ++i)
    mesh.triangle(bark, {foot[i], foot[(i + 1) % foot.size()], tip},
                  {dvec2(0.0, tall), dvec2(0.4, tall), dvec2(0.2, 0.0)});
  const std::vector<dvec3> end(foot.rbegin(), foot.rend());
  mesh.polygon(bark, end);
}

/// Adds a trunk of five sides that narrows to a point inside the crown, and boughs that leave it below the
/// crown.
void add_trunk(MeshBuilder& mesh, const char* bark_name, double radius, double top, double low, int boughs,
               uint32_t seed) {
  const int bark = material(bark_name);
  std::vector<dvec3> foot;
  for (const dvec2& p : regular_polygon(5, radius, dvec2(0.0), 0.4)) foot.emplace_back(p, -0.2);
  add_spike(mesh, bark, foot, {0, 0, top}, top);
  for (int i = 0; i < boughs; ++i) {
    const double angle = 2.0 * pi * (i + 0.25 * uneven(i, 5, seed)) / boughs + 0.7;
    const dvec2 out(std::cos(angle), std::sin(angle)), side(-out.y, out.x);
    const double z = low - 0.35 + 0.3 * uneven(i, 6, seed), thick = 0.42 * radius;
    const std::vector<dvec3> base{dvec3(thick * side, z), dvec3(-thick * side, z),
                                  dvec3(-0.3 * thick * out, z + 1.7 * thick)};
    const dvec2 end = (1.15 + 0.25 * uneven(i, 7, seed)) * out;
    std::vector<dvec3> snapped;
    for (const dvec3& p : base) snapped.push_back(snap(p));
    add_spike(mesh, bark, snapped, snap(dvec3(end, z + 1.5)), 2.0);
  }
}

/// Describes the shape of a species' crown.
struct Crown {
  const char *leaves, *sprays;
  double low, high, radius;
  double widest;  ///< height of the greatest width, as a fraction of the crown's height
  double taper;   ///< shape of the top: 0 round, 1 a cone
  double lumps;   ///< relative depth of the gaps between boughs
  Sprays around;
};

/// Returns a crown with boughs and gaps.
LeafBody crown_body(const Crown& crown, uint32_t seed) {
  constexpr int sides = 8;
  const std::array<double, 4> heights{-0.74, -0.22, 0.32, 0.78};
  const double height = crown.high - crown.low, widest = crown.low + crown.widest * height;
  const auto place = [&](double around, double z, int i) {
    // Boughs are two waves around the trunk with their own phase. Each corner also moves a little in or out.
    const double bough = 0.6 * std::sin(3.0 * around + 5.0 * z + uneven(-1, 0, seed + 3) * pi) +
                         0.5 * std::sin(5.0 * around - 4.0 * z + uneven(-2, 0, seed + 3) * pi);
    const double out = 0.9 + crown.lumps * (0.45 * bough + 0.4 * uneven(i, 1, seed));
    const double up = z > 0.0 ? crown.high - widest : widest - crown.low;
    const double slim = (z > 0.0 ? 1.0 - crown.taper * z : 1.0 + 0.12 * z) * std::sqrt(1.0 - z * z);
    const double r = crown.radius * out * slim;
    return snap(dvec3(r * std::cos(around), r * std::sin(around),
                      widest + up * z * (1.0 + 0.25 * crown.lumps * uneven(i, 2, seed))));
  };
  LeafBody body;
  for (size_t ring = 0; ring < heights.size(); ++ring) {
    std::vector<dvec3> points;
    for (int i = 0; i < sides; ++i) {
      const int key = static_cast<int>(ring) * sides + i;
      const double turn = ring % 2 == 0 ? 0.0 : 0.4;
      const double around = 2.0 * pi * (i + turn + 0.18 * uneven(key, 3, seed)) / sides;
      points.push_back(place(around, heights[ring], key));
    }
    body.rings.push_back(std::move(points));
  }
  body.bottom = snap(dvec3(0.0, 0.0, crown.low));
  body.top = snap(dvec3(0.1 * uneven(7, 7, seed), 0.1 * uneven(7, 8, seed), crown.high - 0.1));
  return body;
}

struct Species {
  Crown crown;
  const char* bark;
  double trunk_m;
  const char* fallen;  ///< material of its leaves on the ground
};

const std::array<Species, tree_species>& species() {
  static const std::array<Species, tree_species> list{{
      // linden, maple, oak, plane, Lombardy poplar, copper beech, birch
      {{"leaves_green", "sprays_green", 2.2, 7.4, 2.1, 0.42, 0.18, 0.3, {1, 1.7, 0.2}},
       "bark",
       0.22,
       "fallen_yellow"},
      {{"leaves_light", "sprays_light", 2.3, 6.9, 2.4, 0.45, 0.0, 0.34, {1, 1.8, 0.0}},
       "bark",
       0.21,
       "fallen_red"},
      {{"leaves_olive", "sprays_olive", 2.1, 6.4, 2.75, 0.4, 0.0, 0.4, {1, 2.0, 0.0}},
       "bark",
       0.28,
       "fallen_brown"},
      {{"leaves_dark", "sprays_dark", 2.4, 7.8, 2.2, 0.5, 0.05, 0.34, {1, 1.8, 0.1}},
       "bark_plane",
       0.24,
       "fallen_brown"},
      {{"leaves_green", "sprays_green", 1.2, 10.6, 1.1, 0.35, 0.5, 0.24, {2, 1.4, 0.8}},
       "bark",
       0.18,
       "fallen_yellow"},
      {{"leaves_copper", "sprays_copper", 2.0, 6.0, 2.2, 0.45, 0.0, 0.28, {1, 1.7, 0.1}},
       "bark",
       0.19,
       "fallen_red"},
      {{"leaves_birch", "sprays_birch", 1.9, 8.2, 1.5, 0.38, 0.3, 0.36, {2, 1.3, 0.7}},
       "bark_birch",
       0.14,
       "fallen_yellow"},
  }};
  return list;
}

/// The ellipsoid that is nearest to a body of leaves, for the normals.
class RoundBody {
 public:
  explicit RoundBody(const LeafBody& body) : middle_(0.5 * (body.bottom + body.top)) {
    for (const auto& ring : body.rings)
      for (const dvec3& p : ring) wide_ = std::max(wide_, glm::length(dvec2(p - middle_)));
    tall_ = 0.5 * (body.top.z - body.bottom.z);
  }
  dvec3 normal(const dvec3& p) const {
    const dvec3 d = p - middle_;
    // Leaves face the sky a little.
    return glm::normalize(dvec3(d.x / wide_, d.y / wide_, d.z * wide_ / (tall_ * tall_)) + dvec3(0, 0, 0.25));
  }
  /// Adds a triangle with normals between those of the ellipsoid and its own.
  void face(MeshBuilder& mesh, int material, const std::array<dvec3, 3>& p, const std::array<dvec2, 3>& uv,
            double flatness) const {
    const dvec3 flat = glm::normalize(glm::cross(snap(p[1]) - snap(p[0]), snap(p[2]) - snap(p[0])));
    std::array<dvec3, 3> normals;
    for (size_t k = 0; k < 3; ++k) {
      normals[k] = glm::normalize(normal(p[k]) + flatness * flat);
      // A normal must be on the outside of its face.
      while (glm::dot(normals[k], flat) < 0.08) normals[k] = glm::normalize(normals[k] + 0.2 * flat);
    }
    mesh.triangle(material, p, normals, uv);
  }

 private:
  dvec3 middle_;
  double wide_ = 0.1, tall_ = 1.0;
};

/// Adds a spray with its middle at `at`, in the plane of `across` and `up`, with the normals of a round body.
void add_spray(MeshBuilder& mesh, int material, const RoundBody& round, const dvec3& at, const dvec3& across,
               const dvec3& up, uint32_t draw) {
  const auto [p, uv] = spray_corners(at, across, up, draw);
  round.face(mesh, material, {p[0], p[1], p[2]}, {uv[0], uv[1], uv[2]}, 0.2);
  round.face(mesh, material, {p[0], p[2], p[3]}, {uv[0], uv[2], uv[3]}, 0.2);
}

}  // namespace

double uneven(int i, int k, uint32_t seed) { return (hash(i, k, seed) % 1001) / 500.0 - 1.0; }

SprayCorners spray_corners(const dvec3& at, const dvec3& across, const dvec3& up, uint32_t draw) {
  const double u = 0.5 * (draw % 2) + 0.004, v = 0.5 * (draw / 2 % 2) + 0.004, s = 0.492;
  return {{snap(at - across - up), snap(at + across - up), snap(at + across + up), snap(at - across + up)},
          {dvec2(u, v + s), dvec2(u + s, v + s), dvec2(u + s, v), dvec2(u, v)}};
}

void add_leaf_body(MeshBuilder& mesh, int material, const LeafBody& body) {
  const RoundBody round(body);
  const size_t sides = body.rings.front().size(), last = body.rings.size() - 1;
  const dvec2 tile = material_library()[static_cast<size_t>(material)].tile_m;
  const auto at = [&](size_t ring, size_t i) { return body.rings[ring][i % sides]; };
  const auto face = [&](const dvec3& a, const dvec3& b, const dvec3& c) {
    // The side that a face looks to decides how it is mapped.
    const dvec3 flat = glm::normalize(glm::cross(b - a, c - a));
    std::array<dvec2, 3> uv;
    const std::array<dvec3, 3> p{a, b, c};
    for (size_t k = 0; k < 3; ++k)
      uv[k] = (std::abs(flat.z) > 0.75               ? dvec2(p[k].x, p[k].y)
               : std::abs(flat.x) > std::abs(flat.y) ? dvec2(p[k].y, -p[k].z)
                                                     : dvec2(p[k].x, -p[k].z)) /
              tile;
    round.face(mesh, material, p, uv, 0.25);
  };
  for (size_t i = 0; i < sides; ++i) {
    face(at(0, i + 1), at(0, i), body.bottom);
    for (size_t r = 0; r < last; ++r) {
      face(at(r, i), at(r, i + 1), at(r + 1, i + 1));
      face(at(r, i), at(r + 1, i + 1), at(r + 1, i));
    }
    face(at(last, i), at(last, i + 1), body.top);
  }
}

void add_sprays(MeshBuilder& mesh, int material, const LeafBody& body, const Sprays& sprays, uint32_t seed) {
  const RoundBody round(body);
  const size_t sides = body.rings.front().size(), last = body.rings.size() - 1;
  int count = 0;
  // Sets a spray near a point of the body, turned out of its face at random.
  const auto spray = [&](const dvec3& on, const dvec3& normal) {
    const int key = count++;
    const double half = 0.5 * sprays.size_m * (1.0 + 0.25 * uneven(key, 1, seed));
    const dvec3 random(uneven(key, 2, seed), uneven(key, 3, seed), uneven(key, 4, seed));
    dvec3 out = glm::normalize(normal + 0.46 * random);
    out = glm::normalize(glm::mix(out, dvec3(out.x, out.y, 0.25 * out.z), sprays.hang));
    dvec3 up = glm::normalize(glm::mix(random, dvec3(0.3 * random.x, 0.3 * random.y, 1.0), sprays.hang) +
                              0.01 * dvec3(1.0, 2.0, 3.0));
    const dvec3 across = glm::normalize(glm::cross(up, out));
    up = glm::cross(out, across);
    const dvec3 at = on + (0.12 + 0.2 * uneven(key, 5, seed)) * half * normal;
    add_spray(mesh, material, round, at, half * across, half * up, hash(key, 6, seed));
  };
  const auto on_face = [&](const std::array<dvec3, 4>& c) {
    const dvec3 normal = glm::normalize(glm::cross(c[2] - c[0], c[3] - c[1]));
    const double u = 0.5 + 0.3 * uneven(count, 7, seed), v = 0.5 + 0.3 * uneven(count, 8, seed);
    spray(glm::mix(glm::mix(c[0], c[1], u), glm::mix(c[3], c[2], u), v), normal);
  };
  const auto at = [&](size_t ring, size_t i) { return body.rings[ring][i % sides]; };
  for (size_t i = 0; i < sides; ++i) {
    // The lowest faces look down. They have half as many sprays, since sprays cost a picture more than faces.
    for (size_t r = i % 2; r < last; ++r)
      for (int k = 0; k < sprays.per_face; ++k)
        on_face({at(r, i), at(r, i + 1), at(r + 1, i + 1), at(r + 1, i)});
    if (i % 2 == 0) continue;
    on_face({at(last, i), at(last, i + 1), glm::mix(at(last, i + 1), body.top, 0.9),
             glm::mix(at(last, i), body.top, 0.9)});
  }
}

namespace {

/// Returns the body that stands for the twigs of a bare crown: smaller about the middle of the leaves.
LeafBody bare_body(const LeafBody& leaves) {
  const dvec3 middle = 0.5 * (leaves.bottom + leaves.top);
  const auto nearer = [&](const dvec3& p) { return snap(middle + leafless_scale * (p - middle)); };
  LeafBody body{leaves.rings, nearer(leaves.bottom), nearer(leaves.top)};
  for (auto& ring : body.rings)
    for (dvec3& p : ring) p = nearer(p);
  return body;
}

/// Adds the boughs of a bare crown, which rise from the trunk, and its leader.
void add_boughs(MeshBuilder& mesh, const Crown& crown, double trunk_radius, uint32_t seed) {
  const int bark = material("boughs");
  const double height = crown.high - crown.low;
  const auto bough = [&](const dvec3& from, const dvec3& to, double thick) {
    const dvec3 along = glm::normalize(to - from);
    const dvec3 side = glm::normalize(glm::cross(along, dvec3(0.36, -0.48, 0.8))),
                over = glm::cross(along, side);
    std::vector<dvec3> foot;
    for (const dvec2& p : regular_polygon(3, thick)) foot.push_back(snap(from + p.x * side + p.y * over));
    add_spike(mesh, bark, foot, snap(to), glm::length(to - from));
  };
  bough({0.0, 0.0, crown.low + 0.1 * height}, {0.0, 0.0, crown.high - 0.12 * height}, 0.55 * trunk_radius);
  constexpr int count = 9;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.4 * i + 0.3 * uneven(i, 11, seed);  // the golden angle, as buds stand
    const double at = crown.low + (0.02 + 0.5 * i / count) * height;
    const double top = std::min(at + (0.34 + 0.1 * uneven(i, 12, seed)) * height, crown.high - 0.1 * height);
    const double far = crown.radius * (0.86 - 0.34 * i / count) * (1.0 + 0.12 * uneven(i, 13, seed));
    bough({0.0, 0.0, at}, {far * std::cos(angle), far * std::sin(angle), top},
          trunk_radius * (0.4 - 0.2 * i / count));
  }
}

}  // namespace

void add_fallen_leaves(MeshBuilder& mesh, int kind, const std::array<dvec3, 4>& corners, uint32_t draw) {
  const double u = 0.5 * static_cast<double>(draw % 2), v = 0.5 * static_cast<double>(draw / 2 % 2);
  const std::array<dvec2, 4> uv{dvec2(u, v + 0.5), dvec2(u + 0.5, v + 0.5), dvec2(u + 0.5, v), dvec2(u, v)};
  const int leaves = material(species()[static_cast<size_t>(kind)].fallen);
  for (const auto& [a, b, c] : {std::array<size_t, 3>{0, 1, 2}, std::array<size_t, 3>{0, 2, 3}})
    mesh.triangle(leaves, {snap(corners[a]), snap(corners[b]), snap(corners[c])}, {uv[a], uv[b], uv[c]});
}

MeshBuilder make_tree(int kind, int shape, double clear_m, Season season) {
  const Species& s = species()[static_cast<size_t>(kind)];
  Crown crown = s.crown;
  const double lift = std::max(0.0, clear_m - crown.low);
  crown.low += lift;
  crown.high += lift;
  const uint32_t seed = 900u + 16u * static_cast<uint32_t>(kind) + static_cast<uint32_t>(shape);
  MeshBuilder mesh;
  add_trunk(mesh, s.bark, s.trunk_m * (1.0 + 0.08 * lift), crown.low + 0.45 * (crown.high - crown.low),
            crown.low, 3, seed);
  const LeafBody body = crown_body(crown, seed);
  if (season == Season::winter) {
    add_leaf_body(mesh, material(crown.leaves), bare_body(body));
    add_boughs(mesh, crown, s.trunk_m, seed);
    crown.around.hang = 0.8;  // twigs rise
  } else {
    add_leaf_body(mesh, material(crown.leaves), body);
  }
  add_sprays(mesh, material(crown.sprays), body, crown.around, seed);
  return mesh;
}

namespace {

/// Adds a spruce's tiers of boughs: one closed body, wide below and narrow above in each tier, and sprays
/// that hang from its rims.
void add_tiers(MeshBuilder& mesh) {
  constexpr int sides = 7, tiers = 5;
  constexpr uint32_t seed = 1211;
  LeafBody body;
  for (int tier = 0; tier < tiers; ++tier)
    for (const int part : {0, 1}) {
      const double z = 1.0 + 1.72 * tier + (part == 0 ? 0.0 : 1.3);
      const double radius = (part == 0 ? 1.7 : 1.0) * (1.0 - 0.17 * tier) - (part == 0 ? 0.0 : 0.12);
      std::vector<dvec3> ring;
      for (int i = 0; i < sides; ++i) {
        const int key = 16 * tier + 8 * part + i;
        const double around = 2.0 * pi * (i + 0.5 * (tier % 2) + 0.15 * uneven(key, 1, seed)) / sides;
        const double r = radius * (1.0 + 0.2 * uneven(key, 2, seed));
        ring.push_back(snap(dvec3(r * std::cos(around), r * std::sin(around), z)));
      }
      body.rings.push_back(std::move(ring));
    }
  body.bottom = {0, 0, 1.15};
  body.top = {0, 0, 10.2};
  add_leaf_body(mesh, material("needles"), body);
  const RoundBody round(body);
  for (int tier = 0; tier < tiers; ++tier)
    for (int i = 0; i < sides; ++i) {
      const int key = 40 * tier + i;
      const double angle = 2.0 * pi * (i + 0.5 * (tier % 2) + 0.5 + 0.3 * uneven(key, 3, seed)) / sides;
      const dvec3 out(std::cos(angle), std::sin(angle), 0.0), side(-out.y, out.x, 0.0);
      const double radius = 1.7 * (1.0 - 0.17 * tier), half = 0.42 * radius + 0.25;
      const dvec3 up = glm::normalize(out - dvec3(0, 0, 0.45 + 0.2 * uneven(key, 4, seed)));
      const dvec3 across = glm::normalize(side + 0.25 * uneven(key, 5, seed) * dvec3(0, 0, 1));
      const dvec3 at = dvec3(0, 0, 1.55 + 1.72 * tier) + (0.85 * radius) * out;
      add_spray(mesh, material("sprays_needles"), round, at, -half * across, half * up, hash(key, 6, seed));
    }
}

}  // namespace

MeshBuilder make_conifer(Conifer kind) {
  MeshBuilder mesh;
  if (kind == Conifer::spruce) {
    add_trunk(mesh, "bark", 0.2, 4.0, 1.2, 0, 1211);
    add_tiers(mesh);
    return mesh;
  }
  const Crown crown{"needles_pine", "sprays_pine", 4.6, 9.6, 2.1, 0.35, 0.1, 0.45, {1, 1.7, 0.0}};
  add_trunk(mesh, "bark", 0.2, 8.0, 4.7, 3, 1201);
  const LeafBody body = crown_body(crown, 1201);
  add_leaf_body(mesh, material(crown.leaves), body);
  add_sprays(mesh, material(crown.sprays), body, crown.around, 1201);
  return mesh;
}

}  // namespace greatx::scene::generator
