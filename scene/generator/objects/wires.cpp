// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/wires.h"

#include <cmath>

#include "core/error.h"

namespace greatx::scene::generator {

double Catenary::height(double x) const { return bottom + scale * (std::cosh((x - lowest) / scale) - 1.0); }

double Catenary::length(double from, double to) const {
  return scale * (std::sinh((to - lowest) / scale) - std::sinh((from - lowest) / scale));
}

Catenary catenary(double span, double rise, double sag) {
  GREATX_CHECK(span > 0.0 && sag > 0.0 && sag <= span, "a span of {} m that sags by {} m", span, sag);
  // The sag scale (cosh(u) - 1), with u = span / (2 scale), is span / 2 times (cosh(u) - 1) / u, which grows
  // with u. Newton's method begins at the parabola, above the root.
  const double wanted = 2.0 * sag / span;
  double u = 2.0 * wanted;
  for (int i = 0; i < 60; ++i) {
    const double value = (std::cosh(u) - 1.0) / u, slope = std::sinh(u) / u - value / u;
    const double step = (value - wanted) / slope;
    u -= step;
    if (std::abs(step) < 1e-15 * u) break;
  }
  Catenary wire;
  wire.scale = 0.5 * span / u;
  // rise = 2 scale sinh(u) sinh((span / 2 - lowest) / scale)
  wire.lowest = 0.5 * span - wire.scale * std::asinh(rise / (2.0 * wire.scale * std::sinh(u)));
  wire.bottom = -wire.scale * (std::cosh(wire.lowest / wire.scale) - 1.0);
  return wire;
}

std::vector<dvec3> hanging_wire(const dvec3& from, const dvec3& to, double sag, int pieces) {
  const double span = glm::length(dvec2(to - from));
  const Catenary wire = catenary(span, to.z - from.z, sag);
  std::vector<dvec3> points;
  for (int i = 0; i <= pieces; ++i) {
    const double t = double(i) / pieces;
    points.emplace_back(glm::mix(dvec2(from), dvec2(to), t), from.z + wire.height(t * span));
  }
  return points;
}

void add_wire(MeshBuilder& mesh, int material, std::span<const dvec3> line, double radius) {
  const dvec2 along = glm::normalize(dvec2(line.back() - line.front())), left(-along.y, along.x);
  const double side = std::sqrt(0.75) * radius;
  const auto section = [&](const dvec3& middle) {
    return std::array<dvec3, 3>{snap(middle - dvec3(side * left, 0.5 * radius)),
                                snap(middle + dvec3(0.0, 0.0, radius)),
                                snap(middle + dvec3(side * left, -0.5 * radius))};
  };
  const auto first = section(line.front()), last = section(line.back());
  mesh.polygon(material, first);
  mesh.polygon(material, std::array{last[2], last[1], last[0]});
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    const auto a = section(line[i]), b = section(line[i + 1]);
    for (size_t k = 0; k < 3; ++k) {
      // The sides are triangles, since rounding to millimetres would bend a quadrilateral.
      const size_t j = (k + 1) % 3;
      mesh.polygon(material, std::array{a[k], b[k], b[j]});
      mesh.polygon(material, std::array{a[k], b[j], a[j]});
    }
  }
}

}  // namespace greatx::scene::generator
