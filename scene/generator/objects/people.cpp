// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/people.h"

#include <array>
#include <cmath>

#include "core/random.h"
#include "core/units.h"
#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

namespace {

constexpr uint32_t clothes_stream = 81;
constexpr double figure_crease = 75.0 * pi / 180.0;

/// One contour of trunk and head as shares of the stature: height over the ground, half depth, half width,
/// and how far its middle is ahead of the hip joints.
struct Contour {
  double z, depth, width, ahead;
};

// Breadths follow Drillis and Contini: shoulders 0.259, hips 0.191 of the stature over all; the head is 0.130
// high.
constexpr std::array<Contour, 6> trunk_contours{{{0.468, 0.040, 0.070, 0.0},
                                                 {0.525, 0.066, 0.091, -0.006},
                                                 {0.610, 0.057, 0.077, 0.0},
                                                 {0.730, 0.068, 0.098, 0.006},
                                                 {0.796, 0.050, 0.115, 0.0},
                                                 {0.833, 0.040, 0.086, -0.004}}};
constexpr std::array<Contour, 5> head_contours{{{0.855, 0.033, 0.033, 0.0},
                                                {0.882, 0.046, 0.036, 0.014},
                                                {0.925, 0.056, 0.045, 0.012},
                                                {0.962, 0.056, 0.046, 0.009},
                                                {1.000, 0.022, 0.020, 0.004}}};

/// Puts points of an upright figure where the trunk leans about the hip joints.
dvec3 leaning(const dvec3& point, const dvec3& hip, double upright_hip_z, double lean) {
  const double x = point.x, z = point.z - upright_hip_z;
  return hip +
         dvec3(x * std::cos(lean) + z * std::sin(lean), point.y, z * std::cos(lean) - x * std::sin(lean));
}

int sides(const PersonLook& look) { return look.coarse ? 6 : 8; }

}  // namespace

double hip_y(const PersonShape& shape) { return snap(0.047 * shape.height_m); }

double shoulder_y(const PersonShape& shape, const PersonLook& look) {
  return snap((0.082 + 0.027 * look.girth) * shape.height_m);
}

void add_limb(SmoothMesh& mesh, int material, const dvec3& from, const dvec3& to,
              const std::vector<dvec2>& radii, int count) {
  const dvec3 course = glm::normalize(to - from);
  const dvec3 aside = std::abs(course.x) < 0.8 ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 0.0, 1.0);
  const dvec3 u = glm::normalize(aside - glm::dot(aside, course) * course), v = glm::cross(course, u);
  std::vector<std::vector<dvec3>> rings;
  for (const dvec2& r : radii) rings.push_back(ring(glm::mix(from, to, r.x), r.y * u, r.y * v, count));
  add_rings(mesh, rings, [&](size_t, size_t) { return material; });
}

void add_trunk(SmoothMesh& mesh, const PersonShape& shape, const PersonLook& look, const dvec3& hip,
               double lean) {
  const double h = shape.height_m;
  const int count = sides(look);
  // The trunk ends at the shoulders, and the head at the stature, whatever their shares are.
  const double rise = (shape.shoulder_m - shape.hip_m) / (0.818 - 0.530);
  std::vector<std::vector<dvec3>> rings;
  const auto add = [&](const Contour& c, double z, double girth) {
    rings.push_back(ring(dvec3(c.ahead * h, 0.0, z), dvec3(c.depth * h * girth, 0.0, 0.0),
                         dvec3(0.0, c.width * h * girth, 0.0), count));
  };
  if (look.dress) add({0.0, 0.105, 0.112, 0.0}, 0.30 * h, 1.0);
  for (size_t i = look.dress ? 1 : 0; i < trunk_contours.size(); ++i)
    if (!look.coarse || i != 2)
      add(trunk_contours[i], shape.hip_m + (trunk_contours[i].z - 0.530) * rise, look.girth);
  const double neck = shape.hip_m + (0.838 - 0.530) * rise, scale = (h - neck) / (1.0 - 0.838);
  const size_t first_head = rings.size();
  for (const Contour& c : head_contours) add(c, neck + (c.z - 0.838) * scale, scale / h);
  const size_t nose = first_head + 2;
  rings[nose][0].x += 0.011 * scale;
  for (std::vector<dvec3>& points : rings)
    for (dvec3& p : points) p = leaning(p, hip, shape.hip_m, lean);
  const auto n = static_cast<size_t>(count);
  add_rings(mesh, rings, [&](size_t k, size_t i) {
    if (k + 1 < first_head) return k == 0 && !look.dress ? look.trousers : look.jacket;
    if (k < first_head) return look.jacket;
    const bool front = i == 0 || i == n - 1, beside = !front && (i == 1 || i == n - 2);
    const size_t level = k - first_head;  // 0 neck, 1 jaw, 2 cheeks, 3 crown
    if (level == 3) return look.hair;
    if (level == 0) return look.long_hair && !front && !beside ? look.hair : look.skin;
    if (front) return look.face;
    if (beside) return level == 2 || look.long_hair ? look.hair : look.skin;
    return look.hair;
  });
}

MeshBuilder make_thigh(const PersonShape& shape, const PersonLook& look) {
  SmoothMesh limb;
  const double h = shape.height_m, g = look.girth;
  add_limb(limb, look.dress ? look.skin : look.trousers, dvec3(0.0), {0.0, 0.0, -shape.thigh_m},
           {{-0.08, 0.038 * h * g}, {0.16, 0.044 * h * g}, {1.02, 0.034 * h * g}}, look.coarse ? 4 : 5);
  MeshBuilder mesh;
  limb.add_to(mesh, figure_crease);
  return mesh;
}

MeshBuilder make_shank(const PersonShape& shape, const PersonLook& look) {
  SmoothMesh limb;
  const double h = shape.height_m, g = look.girth;
  const int cloth = look.dress ? look.skin : look.trousers;
  const double hem = look.dress ? 0.019 : 0.029;
  std::vector<dvec2> radii{
      {-0.06, 0.020 * h}, {0.03, 0.034 * h * g}, {0.3, 0.036 * h * g}, {0.9, hem * h * g}};
  if (look.coarse) radii.erase(radii.begin() + 2);
  add_limb(limb, cloth, dvec3(0.0), {0.0, 0.0, -shape.shank_m}, radii, look.coarse ? 4 : 5);
  // the shoe: rings from the heel to the toes; the sole is level
  std::vector<std::vector<dvec3>> rings;
  const double sole = -shape.shank_m;
  const auto add = [&](double x, double half, double height) {
    rings.push_back({{x * h, -half * h, sole},
                     {x * h, half * h, sole},
                     {x * h, 0.75 * half * h, sole + height * h},
                     {x * h, -0.75 * half * h, sole + height * h}});
  };
  add(-0.040, 0.019, 0.034);
  if (!look.coarse) add(0.012, 0.022, 0.048);
  add(0.070, 0.027, look.coarse ? 0.036 : 0.026);
  add(0.112, 0.017, 0.014);
  add_rings(limb, rings, [&](size_t, size_t) { return look.shoes; });
  MeshBuilder mesh;
  limb.add_to(mesh, 50.0 * pi / 180.0);
  return mesh;
}

namespace {

MeshBuilder make_upper_arm(const PersonShape& shape, const PersonLook& look) {
  SmoothMesh limb;
  const double h = shape.height_m, g = look.girth;
  add_limb(limb, look.jacket, dvec3(0.0), {0.0, 0.0, -shape.upper_arm_m},
           {{0.0, 0.010 * h * g}, {0.07, 0.026 * h * g}, {0.25, 0.031 * h * g}, {1.03, 0.023 * h * g}}, 5);
  MeshBuilder mesh;
  limb.add_to(mesh, figure_crease);
  return mesh;
}

MeshBuilder make_forearm(const PersonShape& shape, const PersonLook& look) {
  SmoothMesh limb;
  const double h = shape.height_m, g = look.girth, wrist = -shape.forearm_m;
  add_limb(limb, look.jacket, dvec3(0.0), {0.0, 0.0, wrist},
           {{-0.08, 0.013 * h}, {0.02, 0.024 * h * g}, {1.0, 0.018 * h * g}}, 5);
  // a hand with bent fingers: wider along x than thick
  std::vector<std::vector<dvec3>> rings;
  const auto add = [&](double x, double below, double width, double thickness) {
    rings.push_back(ring(dvec3(x * h, 0.0, wrist - below * h), dvec3(width * h, 0.0, 0.0),
                         dvec3(0.0, -thickness * h, 0.0), 4));
  };
  add(0.0, -0.005, 0.013, 0.013);
  add(0.004, 0.040, 0.024, 0.013);
  add(0.010, 0.092, 0.012, 0.008);
  add_rings(limb, rings, [&](size_t, size_t) { return look.skin; });
  MeshBuilder mesh;
  limb.add_to(mesh, figure_crease);
  return mesh;
}

}  // namespace

void finish_figure(MeshBuilder& mesh, const SmoothMesh& figure, const PersonShape& shape, const dvec3& hip,
                   double lean) {
  // The picture of a face covers its breadth and the height from the chin to the brow.
  const double h = shape.height_m, low = shape.shoulder_m + 0.062 * h, high = 0.966 * h;
  figure.add_to(mesh, figure_crease, [&](const dvec3& p, const dvec3&, const dvec3&) {
    const dvec3 d = p - hip;
    const double z = d.x * std::sin(lean) + d.z * std::cos(lean) + shape.hip_m;
    return dvec2(0.5 - p.y / (0.088 * h), (high - z) / (high - low));
  });
}

PersonLook person_look(const std::string& variant, uint64_t seed) {
  RandomStream random(seed, clothes_stream, static_cast<uint32_t>(variant.size() * 256u + variant[0]));
  const auto pick = [&](const std::vector<const char*>& names) {
    return std::string(names[random.below(static_cast<uint32_t>(names.size()))]);
  };
  const std::string tone = pick({"light", "light", "tan", "brown", "dark"});
  PersonLook look;
  look.skin = material("skin_" + tone);
  look.face = material("face_" + tone);
  const bool elder = variant == "elder";
  look.hair = material(
      "hair_" + (elder ? pick({"grey", "white"}) : pick({"black", "brown", "brown", "blond", "auburn"})));
  look.jacket = material("cloth_" + pick({"navy", "black", "grey", "red", "green", "beige", "white", "blue",
                                          "brown", "mustard"}));
  look.trousers = material("cloth_" + pick({"denim", "denim", "black", "grey", "beige", "navy"}));
  look.shoes = material("cloth_" + pick({"black", "brown", "white"}));
  const bool woman = variant == "woman" || variant == "dress";
  const bool either = variant == "teenager" || variant == "slim" || variant == "child";
  look.long_hair = woman || (either && random.below(2) == 0);
  look.dress = variant == "dress";
  look.girth = variant == "broad"               ? 1.22
               : variant == "slim"              ? 0.88
               : woman || variant == "teenager" ? 0.92
               : variant == "child"             ? 1.0
                                                : 1.0;
  return look;
}

void write_person(SceneWriter& writer, const std::string& variant, uint64_t seed) {
  const PersonShape& shape = person_shape(variant);
  const PersonLook look = person_look(variant, seed);
  const dvec3 hip(0.0, 0.0, shape.hip_m);
  SmoothMesh figure;
  add_trunk(figure, shape, look, hip, 0.0);
  MeshBuilder body;
  finish_figure(body, figure, shape, hip, 0.0);
  const auto add = [&](const std::string& name, int mesh, const dvec3& joint, int parent) {
    return writer.add_node({.name = name,
                            .mesh = mesh,
                            .position = joint,
                            .semantic_class = SemanticClass::person,
                            .parent = parent});
  };
  const int root = add(variant, writer.add_mesh(variant, body), dvec3(0.0), -1);
  const int thigh = writer.add_mesh("thigh", make_thigh(shape, look)),
            shank = writer.add_mesh("shank", make_shank(shape, look)),
            upper_arm = writer.add_mesh("upper_arm", make_upper_arm(shape, look)),
            forearm = writer.add_mesh("forearm", make_forearm(shape, look));
  for (const double side : {1.0, -1.0}) {
    const std::string suffix = side > 0.0 ? "_left" : "_right";
    const int upper = add("thigh" + suffix, thigh, {0.0, side * hip_y(shape), shape.hip_m}, root);
    add("shank" + suffix, shank, {0.0, 0.0, -shape.thigh_m}, upper);
    const int arm =
        add("upper_arm" + suffix, upper_arm, {0.0, side * shoulder_y(shape, look), shape.shoulder_m}, root);
    add("forearm" + suffix, forearm, {0.0, 0.0, -shape.upper_arm_m}, arm);
  }
}

}  // namespace greatx::scene::generator
