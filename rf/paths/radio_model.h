// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes the scene as radio waves of one carrier see it, with the effects that are on.
#pragma once

#include <optional>
#include <vector>

#include "rf/atmosphere/weather.h"
#include "rf/config/path_limits.h"
#include "rf/edges/corners.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/field/field.h"
#include "rf/paths/edge_gaps.h"
#include "rf/surface/surfaces.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

/// Selects the effects. The effect plan decides; an effect has the same name in the plan
/// (sim/plan/effect_list.h).
struct RadioEffects {
  bool line_of_sight = true, reflection = true, transmission = false, diffraction = false, scattering = false;
  bool diffraction_lit_region = true;  ///< diffraction also where the wedge does not shade
  bool free_edges = false;             ///< borders of thin plates diffract
  bool corner_diffraction = false;     ///< ends of edges diffract, too (rf/edges/corners.h)
  /// Lowest carrier of all channels that share the facet kinds, Hz. A wall that takes dark_wall_db at this
  /// carrier is opaque. 0: no wall is.
  double lowest_carrier_hz = 0.0;
  Weather weather;     ///< weather for gas, rain and fog, if they are on
  FieldEffects field;  ///< effects on the field of each path: roughness, scattering loss, weather
};

/// Tells whether a wave can come out on the other side: no layer of the material is a half-space, or it has
/// windows.
bool penetrable(const scene::RadioMaterial& material);

/// Loss of a wall at normal incidence from which on the transmitted wave is negligible for any receiver (2 mm
/// of metal takes thousands of dB). At other angles the way through is longer.
inline constexpr double dark_wall_db = 100.0;

/// Returns the loss of a wall at normal incidence, -20 lg |T|, dB; inf if nothing is left. With windows the
/// fields add in phase, so that no chance cancellation makes a wall opaque. The material must be penetrable.
/// Throws UserError if the frequency is outside the material's range.
double wall_loss_db(const scene::Material& material, double frequency_hz);

/// Returns the kind of each facet. It depends on the materials and the effects, and is the same for every
/// carrier.
FacetKinds facet_kinds(const scene::Scene& scene, const RadioEffects& effects);

struct RadioModel {
  /// `survey`: null, or one of the scene's edges, which spares work.
  RadioModel(const scene::Scene& scene, double carrier_hz, const RadioEffects& effects,
             const scene::EdgeSurvey* survey = nullptr);

  const scene::Scene* scene = nullptr;
  RadioEffects effects;
  FacetWorld facets;
  RadioSurfaces surfaces;
  FacetKinds kinds;
  EdgeGaps edge_gaps;
  std::vector<scene::Wedge> wedges;            ///< empty if diffraction is off
  OpenCorners corners;                         ///< none are open if corner diffraction is off
  std::optional<FiniteReflectors> reflectors;  ///< set if that effect is on
  uint64_t short_wedges = 0;  ///< diffracting edges that are left out as too short (WedgeOptions)

  FieldModel field_model() const;
};

/// Returns the number of walls that a path may pass beside this many other interactions.
uint32_t walls_allowed(const RadioModel& model, const PathLimits& limits, size_t interactions);

}  // namespace greatx::rf
