// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/scene_hash.h"

#include <span>

#include "core/hash.h"

namespace greatx::scene {
namespace {

/// Feeds values into the hash without the padding that structs may have. The length precedes lists and texts.
class Feeder {
 public:
  template <typename... Values>
  Feeder& values(const Values&... numbers) {
    (hash_.update_value(numbers), ...);
    return *this;
  }
  Feeder& text(const std::string& string) {
    hash_.update_value(static_cast<uint64_t>(string.size()));
    hash_.update(std::string_view(string));
    return *this;
  }
  /// The elements must have no padding.
  template <typename T>
  Feeder& list(const std::vector<T>& elements) {
    hash_.update_value(static_cast<uint64_t>(elements.size()));
    hash_.update(std::as_bytes(std::span(elements)));
    return *this;
  }
  Feeder& count(size_t size) { return values(static_cast<uint64_t>(size)); }
  std::string hex() const { return hash_.hex(); }

 private:
  Sha256 hash_;
};

void feed(Feeder& feeder, const Bounds& bounds) { feeder.values(bounds.min, bounds.max); }

// A material's members are bound by position, so that the struct is their only list. A new member enters `==`
// by itself and is a compile error here until code decides how the member enters the hash.

void feed(Feeder& feeder, const RadioMedium& medium) {
  const auto& [source, rows, extrapolate] = medium;
  static_cast<void>(source);  // only names the source of the rows
  feeder.values(static_cast<uint32_t>(extrapolate)).count(rows.size());
  for (const RadioRow& row : rows) {
    const auto& [a, b, c, d, min_hz, max_hz] = row;
    feeder.values(a, b, c, d, min_hz, max_hz);
  }
}

void feed(Feeder& feeder, const std::vector<RadioLayer>& layers) {
  feeder.count(layers.size());
  for (const RadioLayer& layer : layers) {
    const auto& [medium, thickness_m] = layer;
    feeder.values(thickness_m);
    feed(feeder, medium);
  }
}

void feed(Feeder& feeder, const SurfaceClutter& clutter) {
  const auto& [form, level_db, angle_db, frequency_db, sea_state, cross_db] = clutter;
  feeder.text("clutter").values(static_cast<uint32_t>(form), level_db, angle_db, frequency_db, sea_state,
                                cross_db);
}

void feed(Feeder& feeder, const RadioMaterial& radio) {
  const auto& [layers, foliage, scattering_coefficient, pattern, pattern_exponent, backscatter_exponent,
               backscatter_share, cross_polarization, roughness_m, deviation_m, clutter, windows] = radio;
  if (foliage) {
    const auto& [attenuation_db_per_m] = *foliage;
    feeder.values(static_cast<uint32_t>(attenuation_db_per_m.has_value()),
                  attenuation_db_per_m.value_or(0.0));
  }
  feed(feeder, layers);
  feeder.values(scattering_coefficient, static_cast<uint32_t>(pattern), pattern_exponent,
                backscatter_exponent, backscatter_share, cross_polarization, roughness_m);
  if (deviation_m > 0.0) feeder.values(deviation_m);
  if (clutter) feed(feeder, *clutter);
  if (!windows) return;
  const auto& [share, panes] = *windows;
  feeder.text("windows").values(share);
  feed(feeder, panes);
}

void feed(Feeder& feeder, const PbrMaterial& pbr) {
  const auto& [base_color, metallic, roughness, emissive, normal_scale, alpha_cutoff, alpha_mode,
               double_sided, transmission, base_color_texture, metallic_roughness_texture, normal_texture,
               emissive_texture] = pbr;
  feeder.values(base_color, metallic, roughness, emissive, normal_scale, alpha_cutoff,
                static_cast<uint32_t>(alpha_mode), static_cast<uint32_t>(double_sided), base_color_texture,
                metallic_roughness_texture, normal_texture, emissive_texture);
  if (transmission > 0.0f) feeder.values(transmission);
}

void feed(Feeder& feeder, const Material& material) {
  const auto& [name, pbr, radio, reflectance_905nm, reflectance_1550nm] = material;
  static_cast<void>(name);  // no computation depends on the name
  feed(feeder, pbr);
  feeder.values(reflectance_905nm.value_or(-1.0f), reflectance_1550nm.value_or(-1.0f));
  feeder.values(!radio ? 0u : radio->foliage ? 2u : 1u);
  if (radio) feed(feeder, *radio);
}

void feed(Feeder& feeder, const Texture& texture) {
  feeder.values(texture.width, texture.height, static_cast<uint32_t>(texture.srgb),
                static_cast<uint32_t>(texture.repeat_u), static_cast<uint32_t>(texture.repeat_v));
  feeder.list(texture.rgba);
}

void feed(Feeder& feeder, const PunctualLight& light) {
  feeder.values(static_cast<uint32_t>(light.type) | static_cast<uint32_t>(light.beam) << 8, light.position,
                light.direction, light.color, light.intensity, light.range_m, light.inner_cone,
                light.outer_cone, light.body);
}

void feed_facets(Feeder& feeder, const Scene& scene) {
  feeder.count(scene.facets.size());
  for (const Facet& facet : scene.facets) {
    feeder.values(facet.normal, facet.offset, facet.body, facet.material, facet.instance,
                  facet.first_triangle, facet.triangle_count);
  }
  feeder.list(scene.facet_triangles).list(scene.facet_of_triangle);
}

}  // namespace

std::string hash_of(const Scene& scene) {
  Feeder feeder;
  feeder.text("greatx scene 1").values(scene.origin);
  feeder.list(scene.positions).list(scene.normals).list(scene.tangents).list(scene.uvs).list(scene.indices);
  feeder.list(scene.primitives).count(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    feeder.text(instance.name).values(static_cast<uint32_t>(instance.semantic_class), instance.body);
    feed(feeder, instance.bounds);
  }
  feeder.count(scene.bodies.size());
  for (const Body& body : scene.bodies) {
    feeder.text(body.name).values(body.first_primitive, body.primitive_count);
    feed(feeder, body.bounds);
    if (body.joint) feeder.text("part").values(body.joint->owner, body.joint->position, body.joint->axis);
    if (body.joint && body.joint->limited())
      feeder.text("limits").values(body.joint->least_angle, body.joint->most_angle);
  }
  feed_facets(feeder, scene);
  feeder.count(scene.materials.size());
  for (const Material& material : scene.materials) feed(feeder, material);
  feeder.count(scene.textures.size());
  for (const Texture& texture : scene.textures) feed(feeder, texture);
  feeder.count(scene.lights.size());
  for (const PunctualLight& light : scene.lights) feed(feeder, light);
  if (const auto& place = scene.georeference)  // the poses say where on the Earth they are
    feeder.text("georeference")
        .values(place->origin.latitude_deg, place->origin.longitude_deg, place->origin.height_m,
                place->undulation_m)
        .text(place->vertical_datum);
  return feeder.hex();
}

}  // namespace greatx::scene
