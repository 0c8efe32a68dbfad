// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/rf/gradient_links.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "rf/edges/corners.h"
#include "rf/edges/keller_points.h"
#include "rf/geometry/geometry.h"
#include "rf/gradient/dual_vertices.h"

namespace greatx::rf::testing {
namespace {

using Kind = ChannelParameter::Kind;

std::vector<DielectricLayer> from_behind(const std::vector<DielectricLayer>& front) {
  if (front.empty() || front.back().thickness_m == 0.0)
    return {front.end() - (front.empty() ? 0 : 1), front.end()};
  return {front.rbegin(), front.rend()};
}

void change(RadioSurface& surface, const ChannelParameter& p, double step, double carrier_hz) {
  std::vector<DielectricLayer>& layers = p.windows ? surface.windows.front : surface.front;
  if (p.kind == Kind::permittivity) layers[p.layer].eta += step;
  if (p.kind == Kind::conductivity)
    layers[p.layer].eta -= Complex(0.0, step / (2.0 * pi * carrier_hz * vacuum_permittivity));
  if (p.kind == Kind::thickness) layers[p.layer].thickness_m += step;
  if (p.kind == Kind::roughness) surface.roughness_m += step;
  if (p.kind == Kind::scattering) surface.scattering.coefficient += step;
  if (p.kind == Kind::cross_polarization) surface.scattering.cross_polarization += step;
  if (p.kind == Kind::backscatter_share) surface.scattering.backscatter_share += step;
  surface.back = from_behind(surface.front);
  if (surface.windows.share > 0.0) surface.windows.back = from_behind(surface.windows.front);
}

/// Holds a link after a change, and the model of its field.
struct Made {
  Made(const Link& link, const ChannelParameter& p, double step)
      : world(link.hand.scene),
        wedges(scene::find_wedges(link.hand.scene, {.free_edges = link.free_edges})),
        kinds(link.hand.scene.facets.size(), FacetKind::wall),
        reflectors(link.hand.scene, kinds, link.diffracting),
        carrier_hz(link.carrier_hz + (p.kind == Kind::carrier ? step : 0.0)),
        surfaces(link.hand.scene, carrier_hz),
        ends{link.transmitter, link.receiver},
        velocities{link.transmitter_velocity, link.receiver_velocity} {
    for (uint32_t body = 0; body < link.motions.size(); ++body) world.move(body + 1, link.motions[body]);
    if (p.kind <= Kind::backscatter_share) {
      std::vector<RadioSurface> all;
      for (uint32_t i = 0; i < link.hand.scene.materials.size(); ++i) all.push_back(surfaces.surface(i));
      change(all[p.index], p, step, carrier_hz);
      surfaces = RadioSurfaces(std::move(all), carrier_hz);
    }
    const auto axis = static_cast<int>(p.axis);
    if (p.kind == Kind::transmitter_position) ends[0][axis] += step;
    if (p.kind == Kind::receiver_position) ends[1][axis] += step;
    if (p.kind == Kind::transmitter_velocity) velocities[0][axis] += step;
    if (p.kind == Kind::receiver_velocity) velocities[1][axis] += step;
    const FieldEffects& effects = link.effects;
    weather_effects = {effects.gas, effects.rain, effects.fog};
    model = {&world,
             &surfaces,
             effects,
             wedges,
             path_attenuation(link.weather, carrier_hz, weather_effects),
             link.foliage,
             effects.finite_reflectors ? &reflectors : nullptr};
    geometry = link.solve(world, wedges, ends[0], ends[1]);
  }
  Made(const Made&) = delete;

  FacetWorld world;
  std::vector<scene::Wedge> wedges;
  FacetKinds kinds;
  FiniteReflectors reflectors;
  double carrier_hz;
  RadioSurfaces surfaces;
  WeatherEffects weather_effects;
  FieldModel model;
  dvec3 ends[2], velocities[2];
  GeometricPath geometry;
};

/// What of a path is compared: transfer, length, Doppler shift, and both directions.
constexpr size_t part_begins[] = {0, 8, 9, 10, 13, 16};
constexpr const char* part_names[] = {"transfer", "length", "Doppler shift", "departure", "arrival"};
constexpr size_t parts = std::size(part_names);
using Numbers = std::array<double, 16>;

template <typename Of>
Numbers numbers_of(const Of& path) {
  Numbers all{};
  for (size_t i = 0; i < 4; ++i)
    all[2 * i] = path.transfer[i].real(), all[2 * i + 1] = path.transfer[i].imag();
  all[8] = path.length_m, all[9] = path.doppler_hz;
  for (int i = 0; i < 3; ++i) {
    all[static_cast<size_t>(10 + i)] = path.departure[i];
    all[static_cast<size_t>(13 + i)] = path.arrival[i];
  }
  return all;
}

double norm_of(const Numbers& all, size_t part) {
  double sum = 0.0;
  for (size_t i = part_begins[part]; i < part_begins[part + 1]; ++i) sum += all[i] * all[i];
  return std::sqrt(sum);
}
Numbers combined(double a, const Numbers& x, double b, const Numbers& y) {
  Numbers sum{};
  for (size_t i = 0; i < sum.size(); ++i) sum[i] = a * x[i] + b * y[i];
  return sum;
}

struct Difference {
  Numbers slope{};
  std::array<double, parts> error{};
};

/// Ridders' extrapolation of central differences, for each part by itself.
Difference difference(const std::function<Numbers(double)>& f, double first_step) {
  constexpr int levels = 12;
  constexpr double shrink = 1.5;
  std::array<std::array<Numbers, levels>, levels> table{};
  Difference best;
  best.error.fill(1e300);
  double step = first_step;
  for (int row = 0; row < levels; ++row, step /= shrink) {
    table[0][row] = combined(0.5 / step, f(step), -0.5 / step, f(-step));
    double factor = shrink * shrink;
    for (int level = 1; level <= row; ++level, factor *= shrink * shrink) {
      table[level][row] = combined(factor / (factor - 1.0), table[level - 1][row], -1.0 / (factor - 1.0),
                                   table[level - 1][row - 1]);
      const Numbers from_left = combined(1.0, table[level][row], -1.0, table[level - 1][row]),
                    from_above = combined(1.0, table[level][row], -1.0, table[level - 1][row - 1]);
      for (size_t part = 0; part < parts; ++part) {
        const double error = std::max(norm_of(from_left, part), norm_of(from_above, part));
        if (error > best.error[part]) continue;
        best.error[part] = error;
        std::copy(table[level][row].begin() + static_cast<ptrdiff_t>(part_begins[part]),
                  table[level][row].begin() + static_cast<ptrdiff_t>(part_begins[part + 1]),
                  best.slope.begin() + static_cast<ptrdiff_t>(part_begins[part]));
      }
    }
  }
  return best;
}

RadioSurfaceOf<Dual> as_dual(const RadioSurface& surface) {
  const auto stack = [](const std::vector<DielectricLayer>& layers) {
    std::vector<DielectricLayerOf<Dual>> all;
    for (const DielectricLayer& layer : layers) all.push_back({layer.eta, layer.thickness_m});
    return all;
  };
  const DiffuseScattering& s = surface.scattering;
  return {stack(surface.front),
          stack(surface.back),
          surface.foliage,
          surface.roughness_m,
          {s.coefficient, s.pattern, s.exponent, s.backscatter_exponent, s.backscatter_share,
           s.cross_polarization},
          {surface.windows.share, stack(surface.windows.front), stack(surface.windows.back)}};
}

/// Returns the values of path_values() in dual numbers.
Numbers dual_values(const Link& link, const Made& made) {
  std::vector<RadioSurfaceOf<Dual>> all;
  for (uint32_t i = 0; i < made.surfaces.size(); ++i) all.push_back(as_dual(made.surfaces.surface(i)));
  const RadioSurfacesOf<Dual> surfaces(std::move(all), made.carrier_hz);
  const FieldModelOf<Dual> model{made.model.world,
                                 &surfaces,
                                 made.model.effects,
                                 made.model.wedges,
                                 path_attenuation<Dual>(link.weather, made.carrier_hz, made.weather_effects),
                                 made.model.foliage,
                                 made.model.reflectors};
  const std::vector<Vec3Of<Dual>> vertices(made.geometry.vertices.begin(), made.geometry.vertices.end());
  const PathValuesOf<Dual> values = path_values<Dual>(
      made.geometry, {vertices, made.geometry.length_m, made.velocities[0], made.velocities[1]}, model);
  Path path;
  for (int i = 0; i < 4; ++i) path.transfer[i] = values.transfer[i].value();
  path.length_m = made.geometry.length_m;
  path.doppler_hz = values.doppler_hz.value;
  path.departure = value_of(values.departure), path.arrival = value_of(values.arrival);
  return numbers_of(path);
}

/// Returns the scale on which the field may change with a parameter.
double scale_of(const Link& link, const Made& made, const ChannelParameter& p, double position_m) {
  const double wavelength_m = speed_of_light / link.carrier_hz;
  if (p.kind == Kind::transmitter_position || p.kind == Kind::receiver_position) return position_m;
  if (p.kind == Kind::transmitter_velocity || p.kind == Kind::receiver_velocity) return 1.0;
  if (p.kind == Kind::carrier) return 2e-4 * link.carrier_hz;
  if (p.kind >= Kind::roughness) {
    if (p.kind == Kind::roughness)
      return 0.2 * made.surfaces.surface(p.index).roughness_m + 1e-3 * wavelength_m;
    return 0.1;
  }
  const RadioSurface& surface = made.surfaces.surface(p.index);
  const DielectricLayer& layer = (p.windows ? surface.windows.front : surface.front)[p.layer];
  const double size = std::abs(layer.eta), turns = layer.thickness_m * std::sqrt(size) / wavelength_m;
  if (p.kind == Kind::thickness) return 0.1 * std::min(layer.thickness_m, wavelength_m / std::sqrt(size));
  const double eta = 0.2 * std::min(size, 1.0 + size / (1.0 + turns)) / (1.0 + turns);
  if (p.kind == Kind::permittivity) return std::min(eta, size);
  const double by = 2.0 * pi * link.carrier_hz * vacuum_permittivity;
  return layer.eta.imag() == 0.0 ? 0.0 : std::min(eta * by, -layer.eta.imag() * by);
}

}  // namespace

Path path_of(const Link& link, const ChannelParameter& parameter, double step) {
  const Made made(link, parameter, step);
  return path_field(made.geometry, made.model, made.velocities[0], made.velocities[1]);
}

std::vector<PathSlope> slopes_of(const Link& link, const std::vector<ChannelParameter>& parameters) {
  const Made made(link, {Kind::carrier}, 0.0);
  const CarrierSlopes carrier =
      carrier_slopes(link.hand.scene, link.weather, made.weather_effects, link.carrier_hz);
  return path_slopes(made.geometry, made.model, made.velocities[0], made.velocities[1], parameters, &carrier);
}

std::vector<ChannelParameter> every_parameter(const Link& link) {
  std::vector<ChannelParameter> all;
  const auto layers = [&](uint32_t material, const std::vector<scene::RadioLayer>& of, bool windows) {
    for (uint32_t layer = 0; layer < of.size(); ++layer) {
      all.push_back({Kind::permittivity, material, layer, 0, windows});
      all.push_back({Kind::conductivity, material, layer, 0, windows});
      if (of[layer].thickness_m > 0.0) all.push_back({Kind::thickness, material, layer, 0, windows});
    }
  };
  for (uint32_t i = 0; i < link.hand.scene.materials.size(); ++i) {
    if (std::ranges::find(link.hand.scene.facets, i, &scene::Facet::material) == link.hand.scene.facets.end())
      continue;
    const scene::RadioMaterial& radio = *link.hand.scene.materials[i].radio;
    layers(i, radio.layers, false);
    if (radio.windows) layers(i, radio.windows->layers, true);
    if (radio.roughness_m > 0.0) all.push_back({Kind::roughness, i});
    if (radio.scattering_coefficient == 0.0) continue;
    for (const Kind kind : {Kind::scattering, Kind::cross_polarization, Kind::backscatter_share})
      all.push_back({kind, i});
  }
  for (uint32_t kind = static_cast<uint32_t>(Kind::transmitter_position);
       kind <= static_cast<uint32_t>(Kind::receiver_velocity); ++kind)
    for (uint32_t axis = 0; axis < 3; ++axis) all.push_back({static_cast<Kind>(kind), 0, 0, axis});
  all.push_back({Kind::carrier});
  return all;
}

std::string text_of(const ChannelParameter& p) {
  return fmt::format("kind {}, index {}, layer {}{}, axis {}", static_cast<int>(p.kind), p.index, p.layer,
                     p.windows ? " of windows" : "", p.axis);
}

void expect_true_slopes(const Link& link, double position_m) {
  const std::vector<ChannelParameter> parameters = every_parameter(link);
  const std::vector<PathSlope> slopes = slopes_of(link, parameters);
  const Made made(link, {Kind::carrier}, 0.0);
  EXPECT_EQ(dual_values(link, made), numbers_of(path_of(link, {Kind::carrier}, 0.0)));
  for (size_t i = 0; i < parameters.size(); ++i) {
    const ChannelParameter& p = parameters[i];
    const double scale = scale_of(link, made, p, position_m);
    if (scale == 0.0) continue;  // a conductivity of 0 has values on one side only
    const auto at = [&](double step) { return numbers_of(path_of(link, p, step)); };
    const Numbers value = at(0.0), found = numbers_of(slopes[i]);
    const Difference expected = difference(at, 0.5 * scale);
    const Numbers off = combined(1.0, found, -1.0, expected.slope);
    for (size_t part = 0; part < parts; ++part) {
      const double allowed = 1e-7 * norm_of(expected.slope, part) + 1e-11 * norm_of(value, part) / scale;
      EXPECT_LE(norm_of(off, part), allowed)
          << part_names[part] << " by " << text_of(p) << ": slope " << norm_of(expected.slope, part)
          << ", error of the difference " << expected.error[part] << ", value " << norm_of(value, part);
    }
  }
}

Cost cost_of(const Link& link, const std::vector<ChannelParameter>& parameters) {
  const Made made(link, {Kind::carrier}, 0.0);
  const CarrierSlopes carrier =
      carrier_slopes(link.hand.scene, link.weather, made.weather_effects, link.carrier_hz);
  double sum = 0.0;
  const auto seconds = [&](const auto& call, int calls) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) sum += call();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / calls;
  };
  // The least of short batches: few of them are interrupted.
  const auto time = [&](const auto& call) {
    const int calls = std::max(1, static_cast<int>(2e-4 / seconds(call, 3)));
    double least = 1e300;
    for (int batch = 0; batch < 100; ++batch) least = std::min(least, seconds(call, calls));
    return least;
  };
  Cost cost;
  cost.field_s = time([&] {
    return path_field(made.geometry, made.model, made.velocities[0], made.velocities[1]).transfer[0].real();
  });
  cost.slopes_s = time([&] {
    return path_slopes(made.geometry, made.model, made.velocities[0], made.velocities[1], parameters,
                       &carrier)
        .back()
        .length_m;
  });
  if (std::isnan(sum)) throw std::logic_error("a field is no number");
  return cost;
}

SolveLink reflecting(FacetSequence facets) {
  return [=](const FacetWorld& world, const std::vector<scene::Wedge>&, const dvec3& tx, const dvec3& rx) {
    CandidateList candidates;
    candidates.add(facets);
    std::vector<GeometricPath> paths = ImageTree(world, tx, candidates).solve(rx);
    if (paths.size() != 1) throw std::logic_error("no path with these reflections");
    return paths[0];
  };
}

SolveLink through(SolveLink path, std::vector<uint32_t> walls) {
  return [=](const FacetWorld& world, const std::vector<scene::Wedge>& wedges, const dvec3& tx,
             const dvec3& rx) {
    const GeometricPath bare = path(world, wedges, tx, rx);
    GeometricPath result = bare;
    result.interactions.clear();
    result.vertices = {tx};
    for (size_t i = 0; i + 1 < bare.vertices.size(); ++i) {
      const dvec3 &from = bare.vertices[i], &to = bare.vertices[i + 1];
      for (const uint32_t wall : walls) {
        const double before = world.facet(wall).distance(from), after = world.facet(wall).distance(to);
        if (before * after >= -1e-12) continue;
        result.interactions.push_back({InteractionType::transmission, wall});
        result.vertices.push_back(from + before / (before - after) * (to - from));
      }
      if (i < bare.interactions.size()) result.interactions.push_back(bare.interactions[i]);
      result.vertices.push_back(to);
    }
    return result;
  };
}

SolveLink over(std::vector<Interaction> interactions, std::vector<dvec3> points, double area_m2,
               double second_area_m2) {
  return [=](const FacetWorld&, const std::vector<scene::Wedge>&, const dvec3& tx, const dvec3& rx) {
    GeometricPath path;
    path.interactions = interactions;
    path.vertices = {tx};
    path.vertices.insert(path.vertices.end(), points.begin(), points.end());
    path.vertices.push_back(rx);
    for (size_t i = 0; i + 1 < path.vertices.size(); ++i)
      path.length_m += glm::distance(path.vertices[i], path.vertices[i + 1]);
    path.patch_area_m2 = area_m2, path.second_patch_area_m2 = second_area_m2;
    return path;
  };
}

SolveLink over_edge(uint32_t wedge, FacetSequence before, FacetSequence after) {
  return [=](const FacetWorld& world, const std::vector<scene::Wedge>& wedges, const dvec3& tx,
             const dvec3& rx) {
    CandidateList first, last;
    first.add(before);
    last.add(FacetSequence(after.rbegin(), after.rend()));
    const ImageTree from(world, tx, first), to(world, rx, last);
    const auto point = keller_point(posed(wedges[wedge], world), from.image(0), to.image(0));
    if (!point) throw std::logic_error("no point on this edge");
    GeometricPath path;
    path.vertices = {tx};
    if (!from.reach(0, *point, path)) throw std::logic_error("no path to the edge");
    path.interactions.push_back({InteractionType::diffraction, wedge});
    path.vertices.push_back(*point);
    GeometricPath back;
    if (!to.reach(0, *point, back)) throw std::logic_error("no path from the edge");
    path.interactions.insert(path.interactions.end(), back.interactions.rbegin(), back.interactions.rend());
    path.vertices.insert(path.vertices.end(), back.vertices.rbegin(), back.vertices.rend());
    path.vertices.push_back(rx);
    path.length_m = glm::distance(from.image(0), *point) + glm::distance(*point, to.image(0));
    return path;
  };
}

SolveLink over_edges(uint32_t first, uint32_t second) {
  return [=](const FacetWorld& world, const std::vector<scene::Wedge>& wedges, const dvec3& tx,
             const dvec3& rx) {
    const auto points = keller_points(posed(wedges[first], world), posed(wedges[second], world), tx, rx);
    if (!points) throw std::logic_error("no points on these edges");
    return over({{InteractionType::diffraction, first}, {InteractionType::diffraction, second}},
                {points->first, points->second}, 0.0)(world, wedges, tx, rx);
  };
}

SolveLink backwards(SolveLink path) {
  return [=](const FacetWorld& world, const std::vector<scene::Wedge>& wedges, const dvec3& tx,
             const dvec3& rx) {
    GeometricPath turned = path(world, wedges, tx, rx);
    turned.from_receiver = true;
    return turned;
  };
}

}  // namespace greatx::rf::testing
