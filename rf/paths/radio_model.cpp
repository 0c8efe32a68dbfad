// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/radio_model.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <spdlog/spdlog.h>

#include "core/built_effects.h"
#include "core/error.h"
#include "core/units.h"
#include "rf/atmosphere/fog.h"
#include "rf/atmosphere/foliage.h"
#include "rf/atmosphere/gas.h"
#include "rf/atmosphere/rain.h"
#include "rf/surface/fresnel.h"
#include "scene/material/lossless.h"
#include "shaders/shared/rf.h"

namespace greatx::rf {

namespace {

FacetKind kind_of(const scene::Material& material, const RadioEffects& effects) {
  if (!material.radio) return FacetKind::opaque;
  if (scene::is_lossless(material)) return FacetKind::absent;
  if (material.radio->foliage) return effects.field.foliage ? FacetKind::foliage : FacetKind::absent;
  if (!effects.transmission || !penetrable(*material.radio)) return FacetKind::opaque;
  const bool dark =
      effects.lowest_carrier_hz > 0.0 && wall_loss_db(material, effects.lowest_carrier_hz) >= dark_wall_db;
  return dark ? FacetKind::opaque : FacetKind::wall;
}

std::vector<scene::Wedge> wedges_of(const scene::Scene& scene, const FacetKinds& kinds,
                                    const scene::WedgeOptions& options, const scene::EdgeSurvey* survey,
                                    uint64_t& too_short) {
  std::vector<scene::Wedge> wedges = scene::find_wedges(scene, options, &too_short, survey);
  const auto hard = [&](uint32_t facet) {
    return facet == scene::no_facet || kinds[facet] == FacetKind::opaque || kinds[facet] == FacetKind::wall;
  };
  std::erase_if(wedges, [&](const scene::Wedge& w) { return !hard(w.facet_0) || !hard(w.facet_n); });
  return wedges;
}

/// Returns the one kind of foliage of the scene, since the depth inside is summed over all crowns. Throws
/// UserError if there are two kinds.
std::optional<scene::Foliage> foliage_of(const scene::Scene& scene, const FacetKinds& kinds) {
  const scene::Material* known = nullptr;
  for (size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i] != FacetKind::foliage) continue;
    const scene::Material& material = scene.materials[scene.facets[i].material];
    if (known != nullptr && !(*known->radio->foliage == *material.radio->foliage))
      throw_user_error("scene '{}': expected one kind of foliage, found two: materials '{}' and '{}'",
                       scene.name, known->name, material.name);
    known = &material;
  }
  return known == nullptr ? std::nullopt : known->radio->foliage;
}

}  // namespace

bool penetrable(const scene::RadioMaterial& material) {
  if (material.windows && material.windows->share > 0.0) return true;
  return std::ranges::all_of(material.layers,
                             [](const scene::RadioLayer& layer) { return layer.thickness_m > 0.0; });
}

double wall_loss_db(const scene::Material& material, double frequency_hz) {
  const RadioSurface surface = radio_surface(*material.radio, frequency_hz, material.name);
  const auto amplitude = [&](const std::vector<DielectricLayer>& layers) {
    return std::abs(multilayer(layers, speed_of_light / frequency_hz, 1.0).t_te);
  };
  const double share = surface.windows.share;
  if (share == 0.0) return -20.0 * std::log10(amplitude(surface.front));
  const double wall = surface.wall_ends() ? amplitude(surface.front) : 0.0;
  return -20.0 * std::log10((1.0 - share) * wall + share * amplitude(surface.windows.front));
}

FacetKinds facet_kinds(const scene::Scene& scene, const RadioEffects& effects) {
  std::vector<std::optional<FacetKind>> known(scene.materials.size());
  FacetKinds kinds;
  kinds.reserve(scene.facets.size());
  for (const scene::Facet& facet : scene.facets) {
    std::optional<FacetKind>& kind = known[facet.material];
    if (!kind) kind = kind_of(scene.materials[facet.material], effects);
    kinds.push_back(*kind);
  }
  return kinds;
}

RadioModel::RadioModel(const scene::Scene& radio_scene, double carrier_hz, const RadioEffects& which,
                       const scene::EdgeSurvey* survey)
    : scene(&radio_scene),
      effects(which),
      facets(radio_scene),
      surfaces(radio_scene, carrier_hz),
      kinds(facet_kinds(radio_scene, which)),
      edge_gaps(radio_scene, kinds) {
  if (effects.field.foliage) check_foliage(radio_scene, carrier_hz);
  if (effects.field.finite_reflectors)
    reflectors.emplace(radio_scene, kinds,
                       DiffractingEdges{.free = effects.free_edges,
                                        .corners = effects.diffraction && effects.corner_diffraction},
                       survey);
  if (!effects.diffraction) return;
  const scene::WedgeOptions options{.free_edges = effects.free_edges};
  wedges = wedges_of(radio_scene, kinds, options, survey, short_wedges);
  if (effects.corner_diffraction) corners = OpenCorners(radio_scene, kinds, wedges);
  if (short_wedges > 0)
    spdlog::info("scene '{}': {} edges shorter than {} m do not diffract", radio_scene.name, short_wedges,
                 options.min_length_m);
}

FieldModel RadioModel::field_model() const {
  FieldModel model;
  model.world = &facets;
  model.surfaces = &surfaces;
  model.effects = effects.field;
  model.wedges = wedges;
  const FieldEffects& field = effects.field;
  // An effect is on if any channel needs it. Channels outside the range of its model go without it, and the
  // plan reports that.
  const double hz = surfaces.carrier_hz();
  const WeatherEffects weather{field.gas && gas_model_covers(hz), field.rain && rain_model_covers(hz),
                               field.fog && fog_model_covers(hz)};
  if (weather.gas || weather.rain || weather.fog)
    model.attenuation = path_attenuation(effects.weather, hz, weather);
  if (field.foliage) model.foliage = foliage_of(*scene, kinds);
  if (reflectors) model.reflectors = &*reflectors;
  return model;
}

uint32_t walls_allowed(const RadioModel& model, const PathLimits& limits, size_t interactions) {
  if (!all_effects_built || !model.effects.transmission || interactions >= limits.max_depth) return 0;
  const uint32_t left = limits.max_depth - static_cast<uint32_t>(interactions);
  return std::min({left, limits.max_transmissions, shared::crossings_max});
}

}  // namespace greatx::rf
