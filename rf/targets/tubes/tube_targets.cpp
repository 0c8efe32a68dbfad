// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/targets/tubes/tube_targets.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "rf/radar/signal/delay.h"

namespace greatx::rf {
namespace {

/// The view is wider than the box by this share, so that no silhouette lies on its border.
constexpr double margin = 0.05;
/// Tubes beside the box. A surface in a tube is found by the tube's ray or by those of its neighbours.
constexpr double tubes_beside = 3.0;
constexpr double widest_tube = 0.25;  ///< rad
constexpr uint32_t least_tubes = 100;
constexpr uint32_t most_squares = 32'768;  ///< of a box; EchoOptions::max_echoes leaves room for all of them

EchoEnd end_of(const std::string& name, uint32_t polarization, uint32_t body) {
  EchoEnd end;
  end.slant = polarization == 0 ? 0.0 : 0.5 * pi;
  end.own_body = body;
  end.name = name;
  return end;
}

/// `scattering`: the instances that scatter, one scatterer in each square of `square_m`.
EchoOptions options_of(const TubeOptions& tubes, std::vector<uint32_t> scattering, double square_m) {
  EchoOptions options;
  options.max_bounces = tubes.max_bounces;
  options.moving_targets = false;  // the view is that of a target, with all its tubes
  options.antenna_radius_m = 0.0;
  options.border_floor_m2 = 0.0;
  options.air_db_per_km = tubes.air_db_per_km;
  options.roughness = tubes.roughness;
  options.bandwidth_hz = tubes.bandwidth_hz;
  options.diffuse = !scattering.empty();
  options.diffuse_instances = std::move(scattering);
  options.diffuse_patch_m = square_m;
  options.scatterer_echoes = true;
  options.seed = tubes.seed;
  return options;
}

/// Returns the orientation of a frame whose x axis points along `direction`.
dquat towards(const dvec3& direction) {
  return orientation_from_yaw_pitch_roll(std::atan2(direction.y, direction.x),
                                         -std::atan2(direction.z, std::hypot(direction.x, direction.y)), 0.0);
}

/// Returns the azimuths and elevations of a box in a frame at `from` that `turn` turns towards the box, with
/// a margin; the whole sphere from near by.
FieldOfView view_of_box(const scene::Bounds& box, const Pose& pose, const dvec3& from, const dquat& turn,
                        double tube_rad) {
  constexpr FieldOfView everything{-pi, pi, -0.5 * pi, 0.5 * pi};
  const double radius = 0.5 * glm::length(box.size());
  if (glm::length(pose.apply(box.center()) - from) < 1.5 * radius) return everything;
  double wide = 0.0, high = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
    const dvec3 p = glm::conjugate(turn) * (pose.apply(box.center() + sign * box.size()) - from);
    wide = std::max(wide, std::abs(std::atan2(p.y, p.x)));
    high = std::max(high, std::abs(std::atan2(p.z, std::hypot(p.x, p.y))));
  }
  // The edges of a box bulge beyond its corners by less than the sagitta of their span.
  const double span = 2.0 * std::max(wide, high);
  const double room = std::max(margin * span, tubes_beside * tube_rad) + 0.125 * span * span * std::tan(high);
  if (wide + room >= pi || high + room >= 0.5 * pi) return everything;
  return {-wide - room, wide + room, -high - room, high + room};
}

}  // namespace

TubeTargets::TubeTargets(scene::GpuScene& scene, const RadioSurfaces& surfaces, const std::string& name,
                         uint32_t transmitter_body, uint32_t receiver_body, const TubeOptions& options)
    : scene_(scene.scene()), wavelength_m_(surfaces.wavelength_m()), options_(options) {
  // Both ends are always given, so that ends at one place with other polarizations are treated alike.
  const EchoOptions echoes = options_of(options, scattering(surfaces), square_m());
  for (uint32_t received = 0; received < 2; ++received)
    for (uint32_t sent = 0; sent < 2; ++sent)
      finders_[2 * received + sent] =
          std::make_unique<EchoFinder>(scene, surfaces, end_of(name, sent, transmitter_body),
                                       end_of(name, received, receiver_body), echoes);
}

std::vector<uint32_t> TubeTargets::scattering(const RadioSurfaces& surfaces) const {
  std::vector<uint32_t> instances;
  for (uint32_t i = 0; i < scene_.instances.size(); ++i)
    if (std::ranges::any_of(options_.instances, [&](uint32_t target) { return belongs(i, target); }))
      instances.push_back(i);
  const bool any = std::ranges::any_of(scene_.facets, [&](const scene::Facet& facet) {
    const RadioSurface& surface = surfaces.surface(facet.material);
    return !surface.foliage && surface.scattering.coefficient > 0.0 &&
           std::ranges::binary_search(instances, facet.instance);
  });
  if (!any) instances.clear();
  return instances;
}

bool TubeTargets::belongs(uint32_t instance, uint32_t target) const {
  const uint32_t body = scene_.instances[target].body;
  return instance == target ||
         (body != 0 && scene_.owner_of(scene_.instances[instance].body) == scene_.owner_of(body));
}

scene::Bounds TubeTargets::box_of(uint32_t target) const {
  const scene::Instance& instance = scene_.instances[target];
  const uint32_t body = scene_.owner_of(instance.body);
  scene::Bounds box = instance.body == body ? instance.bounds : scene::Bounds{};
  if (body != 0) box.add(scene_.reach_of(body));
  return box;
}

double TubeTargets::square_m() const {
  double largest_m2 = 0.0;
  for (const uint32_t target : options_.instances) {
    const dvec3 size = box_of(target).size();
    largest_m2 = std::max(largest_m2, 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x));
  }
  const uint32_t most = std::clamp(options_.budget, least_tubes, most_squares);
  return std::max(options_.square_m, std::sqrt(largest_m2 / most));
}

TubeTargets::Search TubeTargets::view_of(uint32_t target, const dvec3& transmitter,
                                         std::span<const Pose> bodies) const {
  const uint32_t body = scene_.owner_of(scene_.instances[target].body);
  const scene::Bounds box = box_of(target);
  const Pose pose = body == 0 ? Pose{} : bodies[body];
  const double distance_m =
      std::max(glm::length(pose.apply(box.center()) - transmitter) - 0.5 * glm::length(box.size()), 1e-3);
  // The tubes widen until the view of the box and what is beside it has no more of them than allowed.
  Search search;
  search.turn = towards(pose.apply(box.center()) - transmitter);
  double tube_rad = std::min(options_.tube_m / distance_m, widest_tube);
  while (true) {
    search.view = view_of_box(box, pose, transmitter, search.turn, tube_rad);
    const double solid_angle = (search.view.azimuth_max - search.view.azimuth_min) *
                               (std::sin(search.view.elevation_max) - std::sin(search.view.elevation_min));
    const double wanted = solid_angle / (tube_rad * tube_rad);
    search.tubes = static_cast<uint32_t>(std::ceil(wanted));
    if (wanted <= std::max(options_.budget, least_tubes) || tube_rad >= widest_tube) break;
    tube_rad = std::min(1.1 * tube_rad, widest_tube);
  }
  return search;
}

TubeTargets::Pending TubeTargets::record(gpu::TickSlot& slot, const dvec3& transmitter, const dvec3& receiver,
                                         std::span<const Pose> bodies) {
  // Elements along the axes of the world have theta and phi of the world.
  const dquat world(1.0, 0.0, 0.0, 0.0);
  Pending pending;
  for (const uint32_t target : options_.instances) {
    Search search = view_of(target, transmitter, bodies);
    for (size_t i = 0; i < finders_.size(); ++i) {
      finders_[i]->set_view(search.view, search.tubes, search.turn);
      search.rays[i] = finders_[i]->record(slot, {transmitter, world}, {receiver, world}, bodies);
    }
    pending.push_back(std::move(search));
  }
  return pending;
}

std::vector<TubeEcho> TubeTargets::collect(const Pending& pending, const EchoMotion& motion,
                                           std::span<const double> times_s) const {
  GREATX_CHECK(!times_s.empty(), "echoes at no time");
  std::vector<TubeEcho> found;
  for (size_t target = 0; target < pending.size(); ++target)
    for (uint32_t i = 0; i < finders_.size(); ++i) {
      finders_[i]->set_view(pending[target].view, pending[target].tubes, pending[target].turn);
      const EchoList list = finders_[i]->collect(pending[target].rays[i], motion);
      for (const Echo& echo : list.echoes) {
        if (echo.instance == 0 || !belongs(echo.instance - 1, options_.instances[target])) continue;
        TubeEcho& one = found.emplace_back();
        one.instance = echo.instance - 1;
        one.sent = i % 2, one.received = i / 2;
        one.transfer = echo.amplitude * (4.0 * pi / wavelength_m_);
        one.departure = echo.departure;
        one.arrival = echo.arrival;
        one.point = echo.point;
        for (const double time_s : times_s)
          one.delay_s.push_back(delay_at(list, echo.delay, motion.slot_s, time_s).delay_s);
        one.rate = delay_at(list, echo.delay, motion.slot_s, times_s.front()).rate;
      }
    }
  return found;
}

}  // namespace greatx::rf
