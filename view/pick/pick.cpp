// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/pick/pick.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geodesy.h"
#include "core/text.h"
#include "core/units.h"
#include "renderer/lens/lens.h"

namespace greatx::view {

namespace {

/// Returns the normalised coordinates of the direction that a point of the picture shows.
dvec2 undistorted(const apps::PictureView& view, const dvec2& pixel) {
  if (!view.distortion.any()) return {(pixel.x - view.cx) / view.fx, (pixel.y - view.cy) / view.fy};
  const render::Lens lens(
      {"view", view.width, view.height, view.fx, view.fy, view.cx, view.cy, view.distortion});
  return lens.undistorted(pixel);
}

std::string vector_text(const dvec3& v, const char* unit) {
  return fmt::format("{:.2f}, {:.2f}, {:.2f} {}", v.x, v.y, v.z, unit);
}

uint64_t triangles_of(const scene::Scene& scene, uint32_t instance) {
  uint64_t indices = 0;
  for (const scene::Primitive& primitive : scene.primitives)
    if (primitive.instance == instance) indices += primitive.index_count;
  return indices / 3;
}

std::string optical_text(const scene::PbrMaterial& pbr) {
  std::string text =
      fmt::format("colour {:.2f} {:.2f} {:.2f}, metallic {:.2f}, roughness {:.2f}", pbr.base_color.x,
                  pbr.base_color.y, pbr.base_color.z, pbr.metallic, pbr.roughness);
  if (pbr.base_color_texture >= 0) text += ", textured";
  if (pbr.emissive != vec3(0.0f)) text += ", glows";
  if (pbr.transmission > 0.0f) text += fmt::format(", transmits {:.0f} %", 100.0 * pbr.transmission);
  return text;
}

std::string layer_text(const scene::RadioLayer& layer, double carrier_hz, const std::string& material) {
  const std::string thickness =
      layer.thickness_m > 0.0 ? fmt::format("{:.4g} m thick", layer.thickness_m) : "half-space";
  try {
    const std::complex<double> eta = scene::relative_permittivity(layer.medium, carrier_hz, material);
    const double conductivity = -eta.imag() * 2.0 * pi * carrier_hz * vacuum_permittivity;
    return fmt::format("er {:.4g}, sigma {:.4g} S/m, {}", eta.real(), conductivity, thickness);
  } catch (const UserError&) {
    return fmt::format("no value at {:.4g} GHz, {}", 1e-9 * carrier_hz, thickness);
  }
}

void add_layers(const char* what, const std::vector<scene::RadioLayer>& layers, double carrier_hz,
                const std::string& material, Facts& facts) {
  for (size_t i = 0; i < layers.size(); ++i) {
    facts.emplace_back(layers.size() == 1 ? what : fmt::format("{} layer {}", what, i + 1),
                       printable(layers[i].medium.source));
    facts.emplace_back(fmt::format("at {:.4g} GHz", 1e-9 * carrier_hz),
                       layer_text(layers[i], carrier_hz, material));
  }
}

void add_radio(const scene::Material& material, double carrier_hz, Facts& facts) {
  if (!material.radio) {
    facts.emplace_back("radio", "none: the scene is loaded for light only");
    return;
  }
  const scene::RadioMaterial& radio = *material.radio;
  if (radio.foliage) {
    facts.emplace_back("radio",
                       radio.foliage->attenuation_db_per_m
                           ? fmt::format("foliage, {:.3g} dB/m", *radio.foliage->attenuation_db_per_m)
                           : "foliage, Weissberger's model");
    return;
  }
  add_layers("radio", radio.layers, carrier_hz, material.name, facts);
  if (radio.windows) {
    facts.emplace_back("windows", fmt::format("{:.3g} % of the area", 100.0 * radio.windows->share));
    add_layers("window", radio.windows->layers, carrier_hz, material.name, facts);
  }
  if (radio.scattering_coefficient > 0.0)
    facts.emplace_back("scattering", fmt::format("S {:.3g}", radio.scattering_coefficient));
  if (radio.roughness_m > 0.0)
    facts.emplace_back("roughness", fmt::format("{:.3g} mm rms", 1e3 * radio.roughness_m));
}

}  // namespace

std::optional<Picked> pick(const ScenePicture& picture, int x, int y, const dvec3& origin) {
  const apps::PictureView& view = picture.request.view;
  if (x < 0 || y < 0 || x >= static_cast<int>(view.width) || y >= static_cast<int>(view.height)) return {};
  const size_t pixel = static_cast<size_t>(y) * view.width + static_cast<size_t>(x);
  const uint32_t instance = picture.instance[pixel];
  const double depth = picture.depth[pixel];
  if (instance == 0 || !std::isfinite(depth)) return {};
  const dvec2 straight = undistorted(view, {x + 0.5, y + 0.5});
  const dvec3 in_camera = depth * dvec3(1.0, -straight.x, -straight.y);
  Picked picked;
  picked.instance = instance - 1;
  picked.material = picture.material[pixel] > 0 ? picture.material[pixel] - 1u : 0u;
  picked.point = view.local_from_sensor.apply(in_camera) + origin;
  picked.distance_m = glm::length(in_camera);
  return picked;
}

Facts facts_of(const Picked& picked, const sim::Experiment& experiment, const ScenePicture& picture,
               double carrier_hz) {
  const scene::Scene& scene = experiment.scene();
  const scene::Instance& instance = scene.instances.at(picked.instance);
  const scene::Material& material = scene.materials.at(picked.material);
  Facts facts;
  facts.emplace_back("object", printable(instance.name));
  facts.emplace_back("class", scene::name_of(instance.semantic_class));
  facts.emplace_back("instance id", fmt::format("{}", picked.instance + 1));
  facts.emplace_back("triangles", fmt::format("{}", triangles_of(scene, picked.instance)));
  facts.emplace_back("point", vector_text(picked.point, "m"));
  if (scene.georeference) {
    const Geodetic place = LocalFrame(*scene.georeference).datum_place(picked.point);
    facts.emplace_back("place", fmt::format("{:.7f}, {:.7f} deg, {:.2f} m above the datum",
                                            place.latitude_deg, place.longitude_deg, place.height_m));
  }
  facts.emplace_back("distance", fmt::format("{:.2f} m", picked.distance_m));
  facts.emplace_back("material", printable(material.name));
  facts.emplace_back("light", optical_text(material.pbr));
  add_radio(material, carrier_hz, facts);
  if (instance.body == 0) {
    facts.emplace_back("motion", "none");
    return facts;
  }
  const uint32_t node = experiment.world->node_of_body.at(instance.body);
  const Motion& motion = picture.nodes.at(node);
  facts.emplace_back("node", printable(experiment.scenario.nodes[node].name));
  facts.emplace_back("position", vector_text(motion.pose.position, "m"));
  facts.emplace_back("velocity", fmt::format("{} = {:.2f} m/s", vector_text(motion.velocity, "m/s"),
                                             glm::length(motion.velocity)));
  return facts;
}

}  // namespace greatx::view
