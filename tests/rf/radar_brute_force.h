// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the echo of a monostatic radar by brute force, with no beams, clipping or closed forms: the
// currents of physical optics at the centre of each small rectangle of each facet, lit and seen if single
// rays say so.
#pragma once

#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "core/units.h"
#include "rf/radar/echoes/echo_field.h"
#include "rf/radar/echoes/echo_tracer.h"
#include "rf/radar/echoes/mirrors.h"
#include "rf/radar/echoes/tube_beam.h"

namespace greatx::rf::testing {

class BruteForce {
 public:
  struct Scene {
    const FacetWorld& world;
    const FacetTrees& trees;
    const EchoTracer& tracer;
  };
  /// `step_m` is the side of the rectangles.
  BruteForce(const Scene& scene, const EchoField& field, const dvec3& radar, double step_m)
      : scene_(scene),
        field_(field),
        radar_(radar),
        step_(step_m),
        view_(scene.tracer.view(scene.world, 0)) {}

  /// Returns the field of all paths with one bounce and of all paths with two, as EchoField has it.
  struct Fields {
    Complex once{0.0}, twice{0.0};
  };
  Fields find() const {
    std::vector<Fields> parts(scene_.world.facet_count());
    parallel_for(parts.size(), 0, [&](size_t facet) { parts[facet] = find(static_cast<uint32_t>(facet)); });
    Fields all;
    for (const Fields& part : parts) all.once += part.once, all.twice += part.twice;
    return all;
  }

 private:
  struct Sample {
    dvec3 at, above;
    double width, height;
  };

  Fields find(uint32_t facet) const {
    Fields sum;
    const FacetWorld& world = scene_.world;
    const PosedFacet& posed = world.facet(facet);
    const double side = posed.distance(radar_);
    if (std::abs(side) < 1e-9) return sum;
    const dvec3 normal = side > 0.0 ? posed.normal : -posed.normal;
    const double columns = std::ceil((posed.max_u - posed.min_u) / step_),
                 rows = std::ceil((posed.max_v - posed.min_v) / step_);
    const double du = (posed.max_u - posed.min_u) / columns, dv = (posed.max_v - posed.min_v) / rows;
    for (double i = 0.5; i < columns; ++i)
      for (double k = 0.5; k < rows; ++k) {
        const dvec2 place(posed.min_u + i * du, posed.min_v + k * dv);
        if (!world.contains(facet, place)) continue;
        const dvec3 at = point_of(posed, place);
        const Sample sample{at, EchoTracer::lifted(at, normal), du, dv};
        if (!scene_.tracer.clear(view_, sample.above, radar_, facet)) continue;
        const uint32_t chain[1] = {facet};
        sum.once += contribution(sample, posed, radar_, radar_,
                                 {.departure = glm::normalize(at - radar_),
                                  .length_m = glm::distance(at, radar_),
                                  .point = at,
                                  .chain = chain});
        for (uint32_t other = 0; other < world.facet_count(); ++other)
          if (other != facet) sum.twice += over(sample, facet, other);
      }
    return sum;
  }

  /// Returns the field of a rectangle of `facet` on the ways that meet `other` once, before it or after it.
  Complex over(const Sample& sample, uint32_t facet, uint32_t other) const {
    const FacetWorld& world = scene_.world;
    const PosedFacet &posed = world.facet(facet), &wall = world.facet(other);
    if (mirrors(world, facet, other)) return 0.0;  // the currents on the smaller facet count
    const double side = wall.distance(radar_);
    if (std::abs(side) < 1e-9 || side * wall.distance(sample.at) <= 0.0) return 0.0;
    const dvec3 image = radar_ - 2.0 * side * wall.normal;
    const double share = -wall.distance(sample.at) / glm::dot(wall.normal, image - sample.at);
    const dvec3 turn = sample.at + share * (image - sample.at);
    if (!world.contains(other, wall.plane_coordinates(turn))) return 0.0;
    const dvec3 above = EchoTracer::lifted(turn, side > 0.0 ? wall.normal : -wall.normal);
    if (posed.distance(radar_) * posed.distance(image) <= 0.0 ||
        !scene_.tracer.clear(view_, above, radar_, other) ||
        !scene_.tracer.clear(view_, sample.above, above, facet))
      return 0.0;
    // Out over the other facet, and back directly.
    const uint32_t chain[2] = {other, facet};
    const Complex there = contribution(sample, posed, image, radar_,
                                       {.departure = glm::normalize(turn - radar_),
                                        .length_m = glm::distance(sample.at, image),
                                        .point = sample.at,
                                        .chain = chain});
    if (!mirrors(world, other, facet)) return there;
    // A mirror counts on the way back, and the opposite path with it.
    const Complex back = contribution(sample, posed, radar_, image,
                                      {.departure = glm::normalize(sample.at - radar_),
                                       .length_m = glm::distance(sample.at, radar_),
                                       .point = sample.at,
                                       .chain = std::span(chain).last(1),
                                       .mirror = other});
    return 2.0 * back;
  }

  /// Returns the density at the centre times the integral of the phase, whose gradient is constant.
  Complex contribution(const Sample& sample, const PosedFacet& posed, const dvec3& source,
                       const dvec3& receiver, const EchoPoint& point) const {
    const dvec3 gradient =
        field_.wavenumber() * (glm::normalize(source - sample.at) + glm::normalize(receiver - sample.at));
    const auto sinc = [](double x) { return std::abs(x) < 1e-6 ? 1.0 : std::sin(x) / x; };
    const double area = sample.width * sample.height *
                        sinc(0.5 * sample.width * glm::dot(gradient, posed.axis_u)) *
                        sinc(0.5 * sample.height * glm::dot(gradient, posed.axis_v));
    const double length = glm::distance(sample.at, source) + glm::distance(sample.at, receiver);
    const double wavelength = 2.0 * pi / field_.wavenumber();
    return area * field_.density(point) *
           std::polar(1.0, -field_.wavenumber() * std::remainder(length, wavelength));
  }

  Scene scene_;
  const EchoField& field_;
  dvec3 radar_;
  double step_;
  EchoTracer::View view_;
};

}  // namespace greatx::rf::testing
