// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the sources of light by night: photometry of lamps, luminance and fraction of lit windows, lamps of
// vehicles.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/paint/textures.h"
#include "tests/scene/generator/soup.h"

namespace greatx::scene {
namespace {

constexpr double full_candelas = 1000.0;  // emission of an emissive factor of 1.0, cd/m^2

double luminance(const vec3& color) { return 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b; }

/// Returns the luminous intensity at an angle from the axis, cd (KHR_lights_punctual, "Inner and Outer Cone
/// Angles").
double candelas(const PunctualLight& light, double angle) {
  const double peak = static_cast<double>(light.intensity) * luminance(light.color);
  if (light.type == PunctualLight::Type::point) return peak;
  const double inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
  const double ramp = std::clamp((std::cos(angle) - outer) / (inner - outer), 0.0, 1.0);
  return peak * ramp * ramp;
}

/// Returns the flux, lm, by the midpoint rule over the sphere. The generator uses a closed form instead.
double lumens(const PunctualLight& light) {
  constexpr int steps = 20000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double angle = pi * (i + 0.5) / steps;
    sum += candelas(light, angle) * 2.0 * pi * std::sin(angle) * pi / steps;
  }
  return sum;
}

/// Returns the illuminance of level ground by one lamp, lux, without the cut-off at its range.
double lux_at(const PunctualLight& light, const dvec3& point) {
  const dvec3 from = point - light.position;
  const double d2 = glm::dot(from, from), cosine = -from.z / std::sqrt(d2);
  return candelas(light, std::acos(glm::dot(from, light.direction) / std::sqrt(d2))) * cosine / d2;
}

double emitted(const Material& material) { return full_candelas * luminance(material.pbr.emissive); }

TEST(Night, StreetLampsGiveTheirFluxDownwards) {
  for (const char* kind : {"city", "country"}) {
    const Soup soup = load_soup({.kind = kind, .seed = 1, .size_m = 300});
    ASSERT_GE(soup.model.lights.size(), 6u);
    std::set<std::string> names;
    std::map<int, int> of_flux;
    for (const PunctualLight& light : soup.model.lights) {
      EXPECT_TRUE(names.insert(light.name).second) << light.name << " twice";
      EXPECT_EQ(light.type, PunctualLight::Type::spot) << light.name;
      EXPECT_LT(light.direction.z, -0.9999) << light.name;
      const double flux = lumens(light);
      ++of_flux[static_cast<int>(std::lround(flux / 100.0)) * 100];
      EXPECT_GE(flux, 2450.0) << light.name;
      EXPECT_LE(flux, 9100.0) << light.name;
      // The light is warm: its ratio of red to blue is that of 2700 to 4500 K.
      EXPECT_GT(light.color.r / light.color.b, 2.0f) << light.name;
      EXPECT_LT(light.color.r / light.color.b, 9.0f) << light.name;
      // The cut-off at the range removes less than 0.3 lux even on a surface that faces the lamp.
      ASSERT_GT(light.range_m, 0.0f);
      const dvec3 foot(light.position.x, light.position.y, 0.0);
      const double height = kind == std::string("city") ? light.position.z : 5.0;
      const double angle = std::acos(height / static_cast<double>(light.range_m));
      EXPECT_LT(candelas(light, angle) / (static_cast<double>(light.range_m) * light.range_m), 0.3)
          << light.name;
      if (kind == std::string("country")) continue;
      const double below = lux_at(light, foot);
      EXPECT_GT(below, 10.0) << light.name;
      EXPECT_LT(below, 60.0) << light.name;
      // The ground is dark between lamps: half-way to the next lamp, at 15 m, both lamps together give less
      // than a fifth.
      EXPECT_LT(2.0 * lux_at(light, foot + dvec3(15.0, 0.0, 0.0)), 0.2 * below) << light.name;
    }
    if (kind == std::string("city")) {
      EXPECT_GE(of_flux[9000], 10);
      EXPECT_GE(of_flux[6000], 10);
      EXPECT_GE(of_flux[2500], 4);
    }
  }
}

TEST(Night, StreetLampsStand25To35MetresApart) {
  const Soup soup = load_soup({.kind = "city", .seed = 4, .size_m = 300});
  std::vector<double> gaps;
  for (const PunctualLight& a : soup.model.lights) {
    if (lumens(a) < 5000.0) continue;
    double nearest = 1e9;
    for (const PunctualLight& b : soup.model.lights)
      if (&a != &b && lumens(b) > 5000.0) nearest = std::min(nearest, glm::length(a.position - b.position));
    gaps.push_back(nearest);
  }
  ASSERT_GE(gaps.size(), 30u);
  std::sort(gaps.begin(), gaps.end());
  EXPECT_GT(gaps.front(), 7.0);
  EXPECT_GT(gaps[gaps.size() / 2], 14.0);  // the lamps of an avenue are staggered across it
  EXPECT_LT(gaps.back(), 36.0);
}

TEST(Night, LampsAndSignalsGlow) {
  const Soup soup = load_soup({.kind = "city", .seed = 1, .size_m = 300});
  std::map<std::string, double> glow;
  for (const Material& m : soup.model.materials)
    if (m.pbr.emissive != vec3(0.0f) && m.pbr.emissive_texture < 0) glow[m.name] = emitted(m);
  for (const char* glass : {"lamp_glass", "lamp_glass_warm"}) {
    ASSERT_TRUE(glow.contains(glass));
    EXPECT_GE(glow[glass], 5000.0);
    EXPECT_LE(glow[glass], 20000.0);
  }
  // EN 12368: a lens of 200 mm gives 200 to 800 cd.
  for (const char* lens : {"switched_red", "switched_amber", "switched_green"}) {
    ASSERT_TRUE(glow.contains(lens)) << lens;
    EXPECT_GE(glow[lens] * 0.01 * pi, 200.0) << lens;
    EXPECT_LE(glow[lens] * 0.01 * pi, 800.0) << lens;
  }
  EXPECT_FALSE(glow.contains("headlight")) << "nothing drives in the scene itself";
}

double linear(uint8_t value) {
  const double s = value / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

TEST(Night, AShareOfTheWindowsIsLitAsWindowsAre) {
  size_t seen = 0;
  for (const generator::MaterialSpec& spec : generator::material_library()) {
    if (spec.lit < 0 || spec.texture == "poster") continue;
    const generator::TextureMaps maps = generator::make_texture(spec.texture);
    const generator::Raster &lit = maps.lit[static_cast<size_t>(spec.lit)],
                            &surface = maps.metallic_roughness;
    ASSERT_EQ(4 * lit.rgb.size(), surface.rgb.size()) << spec.name;
    ASSERT_EQ(2 * lit.width, maps.color.width) << spec.name;
    size_t panes = 0, lit_panes = 0, glowing_wall = 0;
    double sum = 0.0, peak = 0.0;
    for (size_t i = 0; i < lit.rgb.size(); i += 3) {
      const double nits =
          full_candelas *
          luminance(spec.emissive * vec3(linear(lit.rgb[i]), linear(lit.rgb[i + 1]), linear(lit.rgb[i + 2])));
      const size_t x = i / 3 % lit.width, y = i / 3 / lit.width;
      int roughness = 0;  // sum over the four pixels that the lit pixel covers
      for (const size_t at : {2 * y * surface.width + 2 * x, (2 * y + 1) * surface.width + 2 * x})
        roughness += surface.rgb[3 * at + 1] + surface.rgb[3 * at + 4];
      roughness /= 4;
      const bool bright = nits > 1.5;
      panes += roughness < 64;
      lit_panes += roughness < 64 && bright;
      glowing_wall += roughness >= 235 && bright;
      if (bright) sum += nits;
      peak = std::max(peak, nits);
    }
    EXPECT_EQ(glowing_wall, 0u) << spec.name;
    const double share = static_cast<double>(lit_panes) / static_cast<double>(panes);
    const double mean = sum / static_cast<double>(std::max<size_t>(1, lit_panes));
    if (spec.texture == "shopfront") {
      EXPECT_GT(share, 0.5) << spec.name;
      // 500 to 750 lx on pale goods: rho E / pi.
      EXPECT_GT(peak, 80.0) << spec.name;
      EXPECT_LE(peak, 150.0) << spec.name;
    } else if (spec.texture != "dormer") {
      EXPECT_GT(share, 0.08) << spec.name;
      EXPECT_LT(share, 0.6) << spec.name;
      // walls of a room at 50 to 300 lx
      EXPECT_GT(mean, 8.0) << spec.name;
      EXPECT_GT(peak, 25.0) << spec.name;
      EXPECT_LE(peak, 60.0) << spec.name;
    }
    ++seen;
  }
  EXPECT_GE(seen, 15u);
}

TEST(Night, EveningsAndWallsDiffer) {
  for (const char* name : {"facade_brick", "facade_glass", "facade_balcony", "shopfront"}) {
    const generator::TextureMaps maps = generator::make_texture(name);
    EXPECT_NE(maps.lit[0].rgb, maps.lit[1].rgb) << name;
  }
  // Walls start with different bays: more than a few of the eight occur, and no bay occurs on most walls.
  const Soup soup = load_soup({.kind = "city", .seed = 2, .size_m = 300});
  std::map<long, size_t> starts;
  size_t walls = 0;
  for (const ModelMesh& mesh : soup.model.meshes)
    for (const ModelPrimitive& primitive : mesh.primitives) {
      if (!soup.model.materials[primitive.material].name.starts_with("facade_")) continue;
      for (size_t i = 0; i + 3 < primitive.uvs.size(); i += 4) {
        const float u = std::min({primitive.uvs[i].x, primitive.uvs[i + 1].x, primitive.uvs[i + 2].x});
        ++starts[std::lround(8.0 * static_cast<double>(u))];
        ++walls;
      }
    }
  ASSERT_GT(walls, 300u);
  EXPECT_GE(starts.size(), 4u);
  for (const auto& [start, count] : starts) EXPECT_LT(count, walls / 2) << "bay " << start;
}

TEST(Night, ParkedCarsAreDark) {
  for (const char* kind : {"city", "country"}) {
    const Soup soup = load_soup({.kind = kind, .seed = 3, .size_m = 300});
    size_t cars = 0;
    for (const ModelInstance& instance : soup.model.instances) {
      if (instance.semantic_class != SemanticClass::vehicle) continue;
      ++cars;
      for (const ModelPrimitive& primitive : soup.model.meshes[instance.mesh].primitives)
        EXPECT_EQ(soup.model.materials[primitive.material].pbr.emissive, vec3(0.0f)) << instance.name;
    }
    EXPECT_GE(cars, 2u) << kind;
    for (const PunctualLight& light : soup.model.lights)
      EXPECT_TRUE(light.name.starts_with("lamp_")) << light.name;
  }
}

TEST(Night, ADrivingCarHasLowBeamsAndTailLights) {
  for (const char* variant : {"hatchback", "van"}) {
    const Soup soup = load_soup({.kind = "car", .variant = variant});
    std::map<std::string, const PunctualLight*> lights;
    for (const PunctualLight& light : soup.model.lights) lights[light.name] = &light;
    ASSERT_EQ(lights.size(), 4u);
    for (const char* side : {"left", "right"}) {
      const PunctualLight& head = *lights.at(std::string("head_lamp_") + side);
      const PunctualLight& tail = *lights.at(std::string("tail_lamp_") + side);
      const double sign = side == std::string("left") ? 1.0 : -1.0;
      EXPECT_GT(sign * head.position.y, 0.4) << variant;
      EXPECT_GT(sign * tail.position.y, 0.4) << variant;
      EXPECT_GT(head.position.x, 1.9) << variant;
      EXPECT_LT(tail.position.x, -1.9) << variant;
      EXPECT_EQ(head.type, PunctualLight::Type::spot);
      EXPECT_NEAR(candelas(head, 0.0), 12000.0, 30.0);
      const double tilt = -std::asin(head.direction.z) * 180.0 / pi;
      EXPECT_NEAR(tilt, 0.573, 1e-3) << "the elbow of the cut-off lies 1 % below the horizon";
      EXPECT_EQ(head.beam, PunctualLight::Beam::passing);
      EXPECT_GT(head.direction.x, 0.99);
      EXPECT_LE(head.outer_cone, 0.62f);
      EXPECT_EQ(head.range_m, 60.0f);
      EXPECT_LT(candelas(tail, 0.0), 10.0);
      EXPECT_GT(tail.color.r, 20.0f * tail.color.g);
    }
    for (const Material& m : soup.model.materials) {
      if (m.name == "headlight") {
        EXPECT_GT(emitted(m), 5000.0);
      } else if (m.name == "switched_stop") {  // tail lamps shine with a ninth of it
        EXPECT_GT(emitted(m), 9.0 * 200.0);
        EXPECT_LT(emitted(m), 9.0 * 1000.0);
      } else if (m.name == "switched_left" || m.name == "switched_right") {
        EXPECT_GT(emitted(m), 2000.0);
        EXPECT_LT(emitted(m), 20000.0);
      } else {
        EXPECT_EQ(emitted(m), 0.0) << m.name;
      }
    }
  }
}

TEST(Night, NavigationLightsAreRedToTheLeftAndGreenToTheRight) {
  const Soup soup = load_soup({.kind = "quadrotor", .variant = "large"});
  size_t red = 0, green = 0;
  for (const SoupTriangle& t : soup.triangles) {
    const Material& material = soup.model.materials[t.material];
    if (material.name == "navigation_red") {
      EXPECT_GT(t.corners[0].y, 0.0);
      ++red;
    }
    if (material.name == "navigation_green") {
      EXPECT_LT(t.corners[0].y, 0.0);
      ++green;
    }
  }
  EXPECT_GT(red, 0u);
  EXPECT_EQ(red, green);
}

}  // namespace
}  // namespace greatx::scene
