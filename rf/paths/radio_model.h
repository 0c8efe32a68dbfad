// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a channel's paths meet: the scene as radio waves of one carrier see it, with the effects that are on.
#pragma once

#include <vector>

#include "rf/atmosphere/weather.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/field/field.h"
#include "rf/surface/surfaces.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

/// Which effects act. The effect plan decides; an effect of it has the same name there
/// (sim/plan/effect_list.h).
struct RadioEffects {
  bool line_of_sight = true, reflection = true, transmission = false, diffraction = false, scattering = false;
  bool diffraction_lit_region = true;  ///< diffraction where the wedge does not shade, too
  bool free_edges = false;             ///< borders of thin plates diffract
  /// Of all channels that share the kinds of facets: a wall that takes dark_wall_db there is opaque. 0: none
  /// is.
  double lowest_carrier_hz = 0.0;
  Weather weather;     ///< of gas, rain and fog, if they are on
  FieldEffects field;  ///< roughness, scattering loss, weather: what acts on the field of each path
};

/// Can a wave come out on the other side: no half-space among its layers?
bool penetrable(const scene::RadioMaterial& material);

/// A wave that a wall takes this much from is nothing that a receiver could tell from nothing (2 mm of metal
/// takes thousands). At normal incidence; at others the way through is longer.
inline constexpr double dark_wall_db = 100.0;

/// What a wall takes at normal incidence: -20 lg |T|, inf if nothing is left. The material must be
/// penetrable. Throws UserError if the frequency is outside of the material's range.
double wall_loss_db(const scene::Material& material, double frequency_hz);

/// The kind of each facet: a function of the materials and the effects, the same for every carrier.
FacetKinds facet_kinds(const scene::Scene& scene, const RadioEffects& effects);

struct RadioModel {
  RadioModel(const scene::Scene& scene, double carrier_hz, const RadioEffects& effects);

  const scene::Scene* scene = nullptr;
  RadioEffects effects;
  FacetWorld facets;
  RadioSurfaces surfaces;
  FacetKinds kinds;
  std::vector<scene::Wedge> wedges;  ///< empty if diffraction is off
  uint64_t short_wedges = 0;         ///< edges that diffract but are left out as too short (WedgeOptions)

  FieldModel field_model() const;
};

}  // namespace greatx::rf
