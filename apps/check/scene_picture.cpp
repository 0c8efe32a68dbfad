// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "apps/check/scene_report.h"
#include "draw/canvas/canvas.h"

namespace greatx::apps {
namespace {

constexpr int margin = 24, legend = 14;

/// The highest surface at each pixel, seen from straight above.
class ViewFromAbove {
 public:
  ViewFromAbove(const scene::Bounds& bounds, int pixels) : bounds_(bounds) {
    const dvec3 size = bounds.size();
    scale_ = (pixels - 2 * margin) / std::max({size.x, size.y, 1e-6});
    width_ = std::max(1, static_cast<int>(std::ceil(size.x * scale_)));
    height_ = std::max(1, static_cast<int>(std::ceil(size.y * scale_)));
    heights_.assign(static_cast<size_t>(width_) * static_cast<size_t>(height_), -1e300);
    shades_.assign(heights_.size(), 0.0f);
  }
  int width() const { return width_; }
  int height() const { return height_; }
  dvec2 pixel(const dvec3& p) const {
    return {(p.x - bounds_.min.x) * scale_, (bounds_.max.y - p.y) * scale_};
  }
  /// Returns 0 where there is nothing, else the brightness, 0 to 1.
  double brightness(int x, int y) const {
    const size_t at = index(x, y);
    if (heights_[at] == -1e300) return 0.0;
    const double range = std::max(bounds_.max.z - bounds_.min.z, 1e-6);
    return shades_[at] * (0.55 + 0.45 * (heights_[at] - bounds_.min.z) / range);
  }

  void draw(const dvec3& a, const dvec3& b, const dvec3& c) {
    const dvec2 p = pixel(a), q = pixel(b), r = pixel(c);
    const double twice = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    if (!(std::abs(twice) > 0.0)) return;
    const dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const auto shade = static_cast<float>(0.35 + 0.5 * std::abs(normal.z) + 0.15 * normal.x);
    const int x0 = std::max(0, static_cast<int>(std::min({p.x, q.x, r.x}))),
              x1 = std::min(width_ - 1, static_cast<int>(std::max({p.x, q.x, r.x})));
    const int y0 = std::max(0, static_cast<int>(std::min({p.y, q.y, r.y}))),
              y1 = std::min(height_ - 1, static_cast<int>(std::max({p.y, q.y, r.y})));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const dvec2 at(x + 0.5, y + 0.5);
        const double v = ((at.x - p.x) * (r.y - p.y) - (at.y - p.y) * (r.x - p.x)) / twice;
        const double w = ((q.x - p.x) * (at.y - p.y) - (q.y - p.y) * (at.x - p.x)) / twice;
        if (v < 0.0 || w < 0.0 || v + w > 1.0) continue;
        const double z = a.z + v * (b.z - a.z) + w * (c.z - a.z);
        if (z > heights_[index(x, y)]) heights_[index(x, y)] = z, shades_[index(x, y)] = shade;
      }
  }

 private:
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }
  scene::Bounds bounds_;
  double scale_ = 1.0;
  int width_ = 1, height_ = 1;
  std::vector<double> heights_;
  std::vector<float> shades_;
};

void draw_model(const scene::Model& model, ViewFromAbove& view) {
  for (const scene::ModelInstance& instance : model.instances)
    for (const scene::ModelPrimitive& primitive : model.meshes[instance.mesh].primitives)
      for (size_t first = 0; first + 2 < primitive.indices.size(); first += 3) {
        dvec3 c[3];
        bool finite = true;
        for (size_t i = 0; i < 3; ++i) {
          c[i] = dvec3(instance.model_from_mesh *
                       dvec4(dvec3(primitive.positions[primitive.indices[first + i]]), 1.0));
          finite &= std::isfinite(c[i].x) && std::isfinite(c[i].y) && std::isfinite(c[i].z);
        }
        if (finite) view.draw(c[0], c[1], c[2]);
      }
}

}  // namespace

Array draw_faults(const scene::Model& model, const scene::SceneFaults& faults, int pixels) {
  ViewFromAbove view(faults.figures.bounds, pixels);
  draw_model(model, view);
  const int lines = static_cast<int>(faults.faults.size()) + 1;
  const int width = std::max(view.width() + 2 * margin, 520);
  io::Canvas canvas(width, view.height() + 2 * margin + legend * lines, {24, 26, 30});
  canvas.raster({margin, margin, view.width(), view.height()}, view.width(), view.height(),
                [&](int x, int y) -> io::Color {
                  const double b = view.brightness(x, y);
                  if (b == 0.0) return {24, 26, 30};
                  const auto value = [&](double of) {
                    return static_cast<uint8_t>(std::clamp(of * (40.0 + 190.0 * b), 0.0, 255.0));
                  };
                  return {value(0.93), value(0.97), value(1.0)};
                });
  constexpr io::Color red{235, 60, 50}, orange{245, 170, 50};
  // Doubts first, so that faults are drawn over them.
  for (auto fault = faults.faults.rbegin(); fault != faults.faults.rend(); ++fault)
    for (const scene::FaultPlace& place : fault->places) {
      if (place.object.empty()) continue;
      const dvec2 at = view.pixel(place.at) + dvec2(margin);
      // A place of a corner that is not finite may lie anywhere.
      if (!(at.x >= 0.0 && at.y >= 0.0 && at.x <= canvas.width() && at.y <= canvas.height())) continue;
      const bool is_fault = fault->severity == scene::FaultSeverity::fault;
      canvas.circle(at.x, at.y, is_fault ? 6.0 : 4.0, is_fault ? 2.0 : 1.2, is_fault ? red : orange);
    }
  int y = view.height() + 2 * margin;
  if (faults.faults.empty()) canvas.text(margin, y, "no faults", 1, {220, 220, 220});
  for (const scene::SceneFault& fault : faults.faults) {
    canvas.text(margin, y, fmt::format("{} {} ({})", fault.count, fault.text, fault.kind), 1,
                fault.severity == scene::FaultSeverity::fault ? red : orange);
    y += legend;
  }
  return canvas.image();
}

}  // namespace greatx::apps
