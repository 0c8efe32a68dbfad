// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/world/radio_facts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/text.h"
#include "core/units.h"
#include "sim/channel/channel_paths.h"

namespace greatx::view {

namespace {

double carrier_of(const sim::Experiment& experiment, uint32_t channel) {
  return experiment.scenario.channels.at(channel).carrier_hz;
}

/// The mean loss of both polarizations.
double loss_db_of(const rf::Complex& te, const rf::Complex& tm, double share) {
  return -decibels(0.5 * (std::norm(te) + std::norm(tm)) * share * share);
}

/// The power that a surface returns or lets pass at a stop.
std::optional<double> loss_of(const PathStop& stop, const rf::RadioModel& model, uint32_t material,
                              bool from_front, double cosine) {
  const rf::RadioSurface& surface = model.surfaces.surface(material);
  if (surface.front.empty()) return {};
  const rf::FieldEffects& effects = model.effects.field;
  if (stop.type == rf::InteractionType::reflection) {
    const rf::ReflectionCoefficients r = model.surfaces.reflect(material, from_front, cosine);
    return loss_db_of(
        r.r_te, r.r_tm,
        rf::specular_share(surface, cosine, model.surfaces.wavelength_m(),
                           effects.roughness ? std::optional(effects.roughness_model) : std::nullopt,
                           effects.scattering));
  }
  if (stop.type == rf::InteractionType::transmission && surface.penetrable()) {
    const rf::SheetTransmission t = model.surfaces.transmit(material, from_front, cosine);
    return loss_db_of(t.te, t.tm, 1.0);
  }
  return {};
}

/// Tells whether paths of their own may hold the diffraction at the facet of a reflection (as PathSolver).
/// Empty if that depends on the side from which the channel was searched.
std::optional<bool> edges_diffract(const PathStory& story, const rf::RadioModel& model) {
  if (!model.effects.diffraction || !model.effects.diffraction_lit_region) return false;
  const auto is = [](rf::InteractionType type) {
    return [type](const PathStop& s) { return s.type == type; };
  };
  if (!std::ranges::all_of(story.stops, [&](const PathStop& stop) {
        return stop.type == rf::InteractionType::reflection || stop.type == rf::InteractionType::transmission;
      }))
    return false;
  if (std::ranges::count_if(story.stops, is(rf::InteractionType::reflection)) == 1) return true;
  return {};
}

/// The loss because the facet of a reflection covers a part of the Fresnel zones alone, dB; may be negative.
std::optional<double> size_loss_db(const PathStory& story, size_t at, const RadioFacts& facts,
                                   const rf::FacetWorld& world) {
  const rf::RadioModel& model = facts.model();
  if (!model.reflectors) return 0.0;
  const std::optional<bool> diffract = edges_diffract(story, model);
  if (!diffract) return {};
  const auto bends = [&](size_t stop) {
    return story.stops[stop].type == rf::InteractionType::diffraction ||
           story.stops[stop].type == rf::InteractionType::scattering;
  };
  const auto point = [&](size_t i) {  // 0: start, i: stop i - 1
    return i == 0 ? story.start : i <= story.stops.size() ? story.stops[i - 1].at : story.end;
  };
  rf::ReflectionSight sight;
  for (size_t i = at + 1; i > 0; --i) {
    sight.before_m += glm::distance(point(i - 1), point(i));
    if (i > 1 && bends(i - 2)) break;
  }
  for (size_t i = at + 1; i <= story.stops.size(); ++i) {
    sight.after_m += glm::distance(point(i), point(i + 1));
    if (i < story.stops.size() && bends(i)) break;
  }
  const dvec3 normal = world.facet(*story.stops[at].facet).normal;
  sight.point = facts.scene().to_local(point(at + 1));
  sight.out = glm::normalize(point(at + 2) - point(at + 1));
  sight.in = sight.out - 2.0 * glm::dot(sight.out, normal) * normal;
  return -decibels(std::norm(model.reflectors->weight(world, *story.stops[at].facet, sight,
                                                      2.0 * pi / model.surfaces.wavelength_m(), *diffract)));
}

void explain_surface(PathStop& stop, const dvec3& direction, const RadioFacts& facts,
                     std::span<const Pose> bodies) {
  const scene::Facet& facet = facts.scene().facets[*stop.facet];
  const dvec3 normal = bodies[facet.body].orientation * facet.normal;
  const double along = glm::dot(direction, normal);
  const double cosine = std::clamp(std::abs(along), 0.0, 1.0);
  stop.angle = std::acos(cosine);
  stop.loss_db = loss_of(stop, facts.model(), facet.material, along < 0.0, cosine);
  stop.more = fmt::format("facet {}", *stop.facet);
}

void explain_edge(PathStop& stop, const dvec3& direction, const RadioFacts& facts,
                  std::span<const Pose> bodies) {
  const scene::Wedge& wedge = facts.model().wedges[*stop.element];
  const dvec3 edge = glm::normalize(bodies[wedge.body].orientation * (wedge.b - wedge.a));
  stop.angle = std::acos(std::clamp(std::abs(glm::dot(direction, edge)), 0.0, 1.0));
  stop.more = fmt::format("wedge {}, {}, exterior {:.0f} deg", *stop.element,
                          wedge.facet_n == scene::no_facet ? "free edge" : "edge of two faces",
                          degrees(wedge.n * pi));
}

}  // namespace

RadioFacts::RadioFacts(std::shared_ptr<const sim::Experiment> experiment, uint32_t channel)
    : experiment_(std::move(experiment)),
      channel_(channel),
      model_(experiment_->scene(), carrier_of(*experiment_, channel), sim::radio_effects(*experiment_)) {
  if (diffracts()) return;
  scene::WedgeOptions options;
  options.free_edges = model_.effects.free_edges;
  wedges_ = scene::find_wedges(scene(), options);
}

std::string RadioFacts::material_text(uint32_t material) const {
  const scene::Material& named = scene().materials.at(material);
  std::string text = printable(named.name);
  const rf::RadioSurface& surface = model_.surfaces.surface(material);
  if (surface.foliage) return text + ": foliage";
  const auto add = [&](const std::vector<rf::DielectricLayer>& layers) {
    for (const rf::DielectricLayer& layer : layers) {
      const double sigma = -layer.eta.imag() * 2.0 * pi * carrier_hz() * vacuum_permittivity;
      text += fmt::format("\n  er {:.4g}, sigma {:.4g} S/m, {}", layer.eta.real(), sigma,
                          layer.thickness_m > 0.0 ? fmt::format("{:.4g} m thick", layer.thickness_m)
                                                  : std::string("half-space"));
    }
  };
  add(surface.front);
  if (surface.windows.share > 0.0) {
    text += fmt::format("\n  windows on {:.3g} % of its area:", 100.0 * surface.windows.share);
    add(surface.windows.front);
  }
  return text;
}

const char* name_of(rf::FacetKind kind) {
  switch (kind) {
    case rf::FacetKind::opaque:
      return "opaque";
    case rf::FacetKind::wall:
      return "wall that lets waves pass";
    case rf::FacetKind::foliage:
      return "foliage";
    case rf::FacetKind::absent:
      return "without effect";
  }
  return "opaque";
}

void explain(PathStory& story, const RadioFacts& facts, std::span<const Pose> bodies) {
  const scene::Scene& scene = facts.scene();
  const std::vector<scene::Wedge>& wedges = facts.model().wedges;
  rf::FacetWorld world = facts.model().facets;
  for (uint32_t body = 1; body < std::min(bodies.size(), scene.bodies.size()); ++body)
    world.move(body, {.pose = bodies[body]});
  dvec3 before = story.start;
  for (size_t at = 0; at < story.stops.size(); ++at) {
    PathStop& stop = story.stops[at];
    const dvec3 way = stop.at - before;
    const double length = glm::length(way);
    before = stop.at;
    if (!(length > 0.0)) continue;
    if (stop.type == rf::InteractionType::diffraction) {
      if (stop.element && *stop.element < wedges.size() && wedges[*stop.element].body < bodies.size())
        explain_edge(stop, way / length, facts, bodies);
    } else if (stop.facet && *stop.facet < scene.facets.size() &&
               scene.facets[*stop.facet].body < bodies.size()) {
      explain_surface(stop, way / length, facts, bodies);
      if (stop.type != rf::InteractionType::reflection || !stop.loss_db) continue;
      const std::optional<double> by_size = size_loss_db(story, at, facts, world);
      if (by_size && facts.model().reflectors)
        stop.more += fmt::format(", {:.1f} dB of its loss by its size", *by_size);
      stop.loss_db = by_size ? std::optional(*stop.loss_db + *by_size) : std::nullopt;
    }
  }
}

}  // namespace greatx::view
