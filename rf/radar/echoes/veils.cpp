// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/veils.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/units.h"
#include "rf/atmosphere/foliage.h"
#include "rf/radar/echoes/echo_tracks.h"
#include "scene/material/lossless.h"

namespace greatx::rf {
namespace {

constexpr uint32_t most_veils = 64;  ///< on one leg of a way
constexpr double at_the_end = 1e-6;  ///< relative; veils this close to the end of a leg are not passed

double power(const SheetTransmission& t) { return 0.5 * (std::norm(t.te) + std::norm(t.tm)); }

}  // namespace

Veils::Veils(const scene::Scene& scene, const FacetTrees& trees, const FacetWorld& world,
             const RadioSurfaces& surfaces)
    : scene_(scene), trees_(trees), world_(world), surfaces_(surfaces) {
  std::vector<uint8_t> veil(scene.materials.size(), 0), unseen(scene.materials.size(), 0);
  for (uint32_t facet = 0; facet < world.facet_count(); ++facet) {
    const uint32_t material = world.facet(facet).material;
    const auto& radio = scene.materials[material].radio;
    unseen[material] = scene::is_lossless(scene.materials[material]) ? 1 : 0;
    if (unseen[material] != 0) continue;
    veil[material] =
        surfaces.surface(material).foliage
            ? radio && radio->foliage && foliage_model_covers(*radio->foliage, surfaces.carrier_hz())
            : surfaces.penetrable(material) && power(surfaces.transmit(material, true, 1.0)) >= least_share;
  }
  if (std::find(veil.begin(), veil.end(), 1) == veil.end()) return;
  veils_.emplace(scene, trees, [&](uint32_t facet) { return veil[world.facet(facet).material] != 0; });
  sight_.emplace(scene, trees, [&](uint32_t facet) {
    const uint32_t material = world.facet(facet).material;
    return veil[material] == 0 && unseen[material] == 0;
  });
}

std::vector<uint32_t> Veils::behind(std::span<const uint32_t> facets, const Ends& ends,
                                    uint32_t threads) const {
  constexpr size_t chunk = 256;
  const EchoTracer::View view = veils_->view(world_, ends.own_body);
  std::vector<uint8_t> hidden(facets.size(), 0);
  const auto veiled = [&](uint32_t facet) {
    const auto covered = [&](const dvec3& point) {
      const dvec3 arm = point - ends.source;
      const double length = glm::length(arm);
      return veils_->first(view, ends.source, arm / length, facet).distance < length * (1.0 - at_the_end);
    };
    if (covered(world_.facet(facet).centroid)) return true;
    std::array<dvec3, FacetTrees::most_corners> room;
    for (const uint32_t piece : trees_.pieces(facet)) {
      const std::span<const dvec3> corners = trees_.corners(world_, facet, piece, room);
      if (std::any_of(corners.begin(), corners.end(), covered)) return true;
    }
    return false;
  };
  parallel_for((facets.size() + chunk - 1) / chunk, threads, [&](size_t part) {
    for (size_t i = part * chunk; i < std::min(facets.size(), (part + 1) * chunk); ++i)
      hidden[i] = veiled(facets[i]) ? 1 : 0;
  });
  std::vector<uint32_t> found;
  for (size_t i = 0; i < facets.size(); ++i)
    if (hidden[i] != 0) found.push_back(facets[i]);
  return found;
}

void Veils::pass(const EchoTracer::View& view, const dvec3& from, const dvec3& to, Passed& passed) const {
  const dvec3 arm = to - from;
  const double length = glm::length(arm);
  if (!(length > 0.0)) return;
  const dvec3 direction = arm / length;
  double entered = 0.0;  // place on the leg from which the present crowns count
  uint32_t leaving = ~0u;
  dvec3 origin = from;
  double at = 0.0;
  for (uint32_t i = 0; i < most_veils; ++i) {
    const EchoTracer::Met met = veils_->first(view, origin, direction, leaving);
    at += met.distance;
    if (met.facet == ~0u || at >= length * (1.0 - at_the_end)) break;
    const PosedFacet& facet = world_.facet(met.facet);
    const double towards = glm::dot(direction, facet.normal);
    if (surfaces_.surface(facet.material).foliage) {
      passed.depth_m += passed.inside * (at - entered);
      entered = at;
      passed.inside = std::max(0, passed.inside + (towards < 0.0 ? 1 : -1));
      passed.crown = facet.material;
    } else {
      const SheetTransmission through =
          surfaces_.transmit(facet.material, towards < 0.0, std::clamp(std::abs(towards), 1e-6, 1.0));
      passed.panes *= 0.5 * (through.te + through.tm);
    }
    leaving = met.facet;
    origin = from + at * direction;
  }
  passed.depth_m += passed.inside * (length - entered);
}

Complex Veils::factor(const Passed& passed) const {
  if (passed.depth_m == 0.0) return passed.panes;
  const scene::Foliage& foliage = *scene_.materials[passed.crown].radio->foliage;
  const double loss_db = foliage_db(foliage, surfaces_.carrier_hz(), passed.depth_m);
  return passed.panes * std::pow(10.0, -loss_db / 20.0);
}

Veils::Views Veils::views(const Ends& ends) const {
  return {veils_->view(world_, ends.own_body), veils_->view(world_, ends.own_body, ends.receiver_body)};
}

Veils::Passed Veils::leg(const EchoTracer::View& view, const dvec3& from, const dvec3& to) const {
  Passed passed;
  pass(view, from, to, passed);
  return passed;
}

void Veils::weaken(RawEchoes& raw, size_t first, const Passed& out, const Views& views, const Ends& ends,
                   bool monostatic) const {
  const Complex share = factor(out), both_ways = share * share;
  for (size_t i = first; i < raw.echoes.size(); ++i) {
    RawEcho& echo = raw.echoes[i];
    if (echo.bounces == 1 && monostatic) {
      echo.amplitude *= both_ways;
      continue;
    }
    Passed there = out;
    const CarriedPath path =
        carried_vertices(world_, ends.source, echo.departure, raw.chain(echo), echo.point);
    dvec3 from = ends.source;
    for (uint32_t vertex = 0; vertex < path.count; ++vertex) {
      const CarriedPoint& point = path.points[vertex];
      const dvec3 to = point.body == 0 ? point.at : world_.motion(point.body).pose.apply(point.at);
      if (vertex > 0) pass(views.out, from, to, there);
      from = to;
    }
    // The way home is counted from the receiver, which is outside of all crowns.
    echo.amplitude *= factor(there) * factor(leg(views.home, ends.receiver, from));
  }
}

}  // namespace greatx::rf
