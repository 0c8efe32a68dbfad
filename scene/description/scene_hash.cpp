// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/scene_hash.h"

#include <span>

#include "core/hash.h"

namespace greatx::scene {
namespace {

/// Feeds values without the padding that structs may have. Lists and texts are preceded by their length.
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

void feed(Feeder& feeder, const RadioMaterial& radio) {
  if (radio.foliage) {
    feeder.values(static_cast<uint32_t>(radio.foliage->attenuation_db_per_m.has_value()),
                  radio.foliage->attenuation_db_per_m.value_or(0.0));
  }
  feeder.count(radio.layers.size());
  for (const RadioLayer& layer : radio.layers) {
    feeder.values(layer.thickness_m, static_cast<uint32_t>(layer.medium.extrapolate))
        .count(layer.medium.rows.size());
    for (const RadioRow& row : layer.medium.rows)
      feeder.values(row.a, row.b, row.c, row.d, row.min_hz, row.max_hz);
  }
  feeder.values(radio.scattering_coefficient, static_cast<uint32_t>(radio.pattern), radio.pattern_exponent,
                radio.backscatter_exponent, radio.backscatter_share, radio.cross_polarization,
                radio.roughness_m);
}

void feed(Feeder& feeder, const Material& material) {
  const PbrMaterial& pbr = material.pbr;
  feeder.values(pbr.base_color, pbr.metallic, pbr.roughness, pbr.emissive, pbr.normal_scale, pbr.alpha_cutoff,
                static_cast<uint32_t>(pbr.alpha_mode), static_cast<uint32_t>(pbr.double_sided),
                pbr.base_color_texture, pbr.metallic_roughness_texture, pbr.normal_texture,
                pbr.emissive_texture);
  if (pbr.transmission > 0.0f) feeder.values(pbr.transmission);
  feeder.values(material.reflectance_905nm.value_or(-1.0f), material.reflectance_1550nm.value_or(-1.0f));
  feeder.values(!material.radio ? 0u : material.radio->foliage ? 2u : 1u);
  if (material.radio) feed(feeder, *material.radio);
}

void feed(Feeder& feeder, const Texture& texture) {
  feeder.values(texture.width, texture.height, static_cast<uint32_t>(texture.srgb),
                static_cast<uint32_t>(texture.repeat_u), static_cast<uint32_t>(texture.repeat_v));
  feeder.list(texture.rgba);
}

void feed(Feeder& feeder, const PunctualLight& light) {
  feeder.values(static_cast<uint32_t>(light.type), light.position, light.direction, light.color,
                light.intensity, light.range_m, light.inner_cone, light.outer_cone, light.body);
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
  }
  feed_facets(feeder, scene);
  feeder.count(scene.materials.size());
  for (const Material& material : scene.materials) feed(feeder, material);
  feeder.count(scene.textures.size());
  for (const Texture& texture : scene.textures) feed(feeder, texture);
  feeder.count(scene.lights.size());
  for (const PunctualLight& light : scene.lights) feed(feeder, light);
  return feeder.hex();
}

}  // namespace greatx::scene
