// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the panels of a camera's normals, optical flow and boxes.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "draw/sheet/picture_panel.h"

namespace greatx::io {

namespace {

/// Shows normals. Each component from -1..1 becomes 0..255 of a colour channel.
class NormalsPanel : public PicturePanel {
 public:
  explicit NormalsPanel(const PanelSource& source)
      : PicturePanel(source, "normals", "normals", {DType::f32}, 3) {}
  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const Array array = load(row);
    const std::span<const float> normals = array.as<float>();
    const int64_t width = array.shape[1];
    canvas.raster(picture, static_cast<int>(width), static_cast<int>(array.shape[0]), [&](int x, int y) {
      const float* const n = normals.data() + 3 * static_cast<size_t>(y * width + x);
      if (n[0] == 0.0f && n[1] == 0.0f && n[2] == 0.0f) return color_of_sky;
      const auto byte = [](float c) {
        return static_cast<uint8_t>(std::lround(127.5f * (1.0f + std::clamp(c, -1.0f, 1.0f))));
      };
      return Color{byte(n[0]), byte(n[1]), byte(n[2])};
    });
    caption(canvas, legend, "east north up: red green blue");
  }
};

/// Shows optical flow with flow_color(). The hue is the direction, the saturation is the length, and white is
/// no motion. The idea is that of the Middlebury colour coding (S. Baker et al., "A Database and Evaluation
/// Methodology for Optical Flow", IJCV 92, 2011). The scale is the same for all rows.
class FlowPanel : public PicturePanel {
 public:
  explicit FlowPanel(const PanelSource& source) : PicturePanel(source, "flow", "flow", {DType::f32}, 2) {
    std::vector<float> lengths;
    for (size_t row = 0; row < source_.chosen.size(); ++row) {
      const Array flow = load(row);
      const std::span<const float> values = flow.as<float>();
      for (size_t i = 0; i + 1 < values.size(); i += 14)
        if (const float length = std::hypot(values[i], values[i + 1]); std::isfinite(length))
          lengths.push_back(length);
    }
    if (lengths.empty()) return;
    std::sort(lengths.begin(), lengths.end());
    const float longest = lengths[static_cast<size_t>(0.95 * static_cast<double>(lengths.size() - 1))];
    if (longest > 0.0f) full_px_ = longest;
  }
  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const Array array = load(row);
    const std::span<const float> flow = array.as<float>();
    const int64_t width = array.shape[1];
    canvas.raster(picture, static_cast<int>(width), static_cast<int>(array.shape[0]), [&](int x, int y) {
      const size_t i = 2 * static_cast<size_t>(y * width + x);
      return flow_color(flow[i] / full_px_, flow[i + 1] / full_px_);
    });
    draw_wheel(canvas, picture);
    caption(canvas, legend, fmt::format("wheel's rim: {:.3g} px a picture", full_px_));
  }

 private:
  void draw_wheel(Canvas& canvas, const Rect& picture) const {
    const int radius = std::min(picture.width, picture.height) / 10;
    const int cx = picture.right() - radius - 8, cy = picture.bottom() - radius - 8;
    canvas.disc(cx, cy, radius + 2.0, theme::page);
    for (int y = -radius; y <= radius; ++y)
      for (int x = -radius; x <= radius; ++x)
        if (x * x + y * y <= radius * radius)
          canvas.blend(cx + x, cy + y, flow_color(double(x) / radius, double(y) / radius));
  }
  double full_px_ = 1.0;
};

/// Shows the amodal boxes of the objects over the darkened picture. Visible objects have boxes in their
/// colours, hidden ones have thin grey boxes.
class BoxesPanel : public PicturePanel {
 public:
  explicit BoxesPanel(const PanelSource& source) : PicturePanel(source, "rgb", "boxes", {DType::u8}, 3) {}
  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const IndexRow& record = source_.chosen[row];
    const Array rgb = load(row), rectangles = source_.load(record, "box_amodal", {DType::f32}, {-1, 4}),
                ids = source_.load(record, "box_instance", {DType::u32}, {-1}),
                visibility = source_.load(record, "box_visibility", {DType::f32}, {-1});
    expect_same_rows(source_, {&rectangles, &ids, &visibility});
    canvas.clip(picture);
    canvas.picture(picture, rgb);
    canvas.fill(picture, theme::page, 0.35);
    const double sx = picture.width / static_cast<double>(rgb.shape[1]),
                 sy = picture.height / static_cast<double>(rgb.shape[0]);
    size_t seen = 0;
    for (size_t i = 0; i < ids.as<uint32_t>().size(); ++i) {
      const float* const r = rectangles.as<float>().data() + 4 * i;
      const double x0 = picture.x + r[0] * sx, y0 = picture.y + r[1] * sy, x1 = picture.x + r[2] * sx,
                   y1 = picture.y + r[3] * sy;
      const bool visible = visibility.as<float>()[i] > 0.0f;
      seen += visible;
      const Color color = visible ? color_of_id(ids.as<uint32_t>()[i]) : theme::dim;
      const double thickness = visible ? 1.6 : 0.6;
      canvas.line(x0, y0, x1, y0, thickness, color);
      canvas.line(x1, y0, x1, y1, thickness, color);
      canvas.line(x1, y1, x0, y1, thickness, color);
      canvas.line(x0, y1, x0, y0, thickness, color);
    }
    canvas.unclip();
    caption(
        canvas, legend,
        fmt::format("{} objects, {} hidden", ids.as<uint32_t>().size(), ids.as<uint32_t>().size() - seen));
  }
};

}  // namespace

Color flow_color(double u, double v) {
  const double length = std::hypot(u, v);
  if (!std::isfinite(length)) return {0, 0, 0};
  // Hue 0 (red) is to the right, and 90 degrees more is down the picture. The channels are piecewise linear
  // in the hue, as in HSV.
  const double sixth = 3.0 * (std::atan2(v, u) / std::numbers::pi + (v < 0.0 ? 2.0 : 0.0));
  const double saturation = std::min(length, 1.0), value = length <= 1.0 ? 1.0 : 0.8;
  const auto channel = [&](double at) {
    double distance = std::abs(sixth - at);
    distance = std::min(distance, 6.0 - distance);
    const double pure = std::clamp(2.0 - distance, 0.0, 1.0);
    return static_cast<uint8_t>(std::lround(255.0 * value * (1.0 - saturation * (1.0 - pure))));
  };
  return {channel(0.0), channel(2.0), channel(4.0)};
}

void add_truth_panels(const PanelSource& source, Panels& panels) {
  if (source.has("normals")) panels.frames.push_back(std::make_unique<NormalsPanel>(source));
  if (source.has("flow")) panels.frames.push_back(std::make_unique<FlowPanel>(source));
  if (source.has("rgb") && source.has("box_amodal") && source.has("box_visibility"))
    panels.frames.push_back(std::make_unique<BoxesPanel>(source));
}

}  // namespace greatx::io
