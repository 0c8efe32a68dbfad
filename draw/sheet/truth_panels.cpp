// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the panels of a camera's normals, optical flow and boxes.
#include <algorithm>
#include <cmath>
#include <limits>
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
    const Array& array = load(row);
    const std::span<const float> normals = array.as<float>();
    const int64_t width = array.shape[1];
    canvas.raster(picture, static_cast<int>(width), static_cast<int>(array.shape[0]), [&](int x, int y) {
      const float* const n = normals.data() + 3 * static_cast<size_t>(y * width + x);
      if (n[0] == 0.0f && n[1] == 0.0f && n[2] == 0.0f) return canvas.theme().sky;
      const auto byte = [](float c) {
        return static_cast<uint8_t>(std::lround(127.5f * (1.0f + std::clamp(c, -1.0f, 1.0f))));
      };
      return Color{byte(n[0]), byte(n[1]), byte(n[2])};
    });
    caption(canvas, legend, "red east, green north, blue up");
  }

 protected:
  std::string text_of(size_t, const Array& array, size_t i, const SceneNames&) override {
    const float* const n = array.as<float>().data() + 3 * i;
    if (n[0] == 0.0f && n[1] == 0.0f && n[2] == 0.0f) return "sky";
    return fmt::format("east {:.3f} north {:.3f} up {:.3f}", n[0], n[1], n[2]);
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
      const Array& flow = load(row);
      const std::span<const float> values = flow.as<float>();
      for (size_t i = 0; i + 1 < values.size(); i += 14)
        if (const float length = std::hypot(values[i], values[i + 1]); std::isfinite(length))
          lengths.push_back(length);
    }
    if (lengths.empty()) return;
    const auto longest =
        lengths.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(lengths.size() - 1));
    std::nth_element(lengths.begin(), longest, lengths.end());
    if (*longest > 0.0f) full_px_ = *longest;
  }
  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const Array& array = load(row);
    const std::span<const float> flow = array.as<float>();
    const int64_t width = array.shape[1];
    canvas.raster(picture, static_cast<int>(width), static_cast<int>(array.shape[0]), [&](int x, int y) {
      const size_t i = 2 * static_cast<size_t>(y * width + x);
      return flow_color(flow[i] / full_px_, flow[i + 1] / full_px_);
    });
    draw_wheel(canvas, picture);
    caption(canvas, legend, fmt::format("wheel's rim: {:.3g} px a picture", full_px_));
  }

 protected:
  std::string text_of(size_t, const Array& array, size_t i, const SceneNames&) override {
    const float u = array.as<float>()[2 * i], v = array.as<float>()[2 * i + 1];
    if (!std::isfinite(u) || !std::isfinite(v)) return "out of sight in the next picture";
    return fmt::format("right {:.2f} down {:.2f} px a picture", u, v);
  }

 private:
  void draw_wheel(Canvas& canvas, const Rect& picture) const {
    const int radius = std::min(picture.width, picture.height) / 10;
    const int cx = picture.right() - radius - 8, cy = picture.bottom() - radius - 8;
    canvas.disc(cx, cy, radius + 2.0, canvas.theme().page);
    canvas.paint({cx - radius, cy - radius, 2 * radius + 1, 2 * radius + 1},
                 [&](double px, double py, Color& color) {
                   const double x = px - cx, y = py - cy;
                   color = flow_color(x / radius, y / radius);
                   return x * x + y * y <= double(radius) * radius;
                 });
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
    const Array& rgb = load(row);
    const Array rectangles = source_.load(record, "box_amodal", {DType::f32}, {-1, 4}),
                ids = source_.load(record, "box_instance", {DType::u32}, {-1}),
                visibility = source_.load(record, "box_visibility", {DType::f32}, {-1});
    expect_same_rows(source_, {&rectangles, &ids, &visibility});
    canvas.clip(picture);
    canvas.picture(picture, rgb);
    canvas.fill(picture, canvas.theme().halo, 0.35);
    const double sx = picture.width / static_cast<double>(rgb.shape[1]),
                 sy = picture.height / static_cast<double>(rgb.shape[0]);
    size_t seen = 0;
    for (size_t i = 0; i < ids.as<uint32_t>().size(); ++i) {
      const float* const r = rectangles.as<float>().data() + 4 * i;
      const double x0 = picture.x + r[0] * sx, y0 = picture.y + r[1] * sy, x1 = picture.x + r[2] * sx,
                   y1 = picture.y + r[3] * sy;
      const bool visible = visibility.as<float>()[i] > 0.0f;
      seen += visible;
      const Color color =
          visible ? color_of_id(canvas.theme(), ids.as<uint32_t>()[i]) : canvas.theme().false_alarm;
      const double thickness = visible ? 1.6 : 0.6;
      canvas.line(x0, y0, x1, y0, thickness, color);
      canvas.line(x1, y0, x1, y1, thickness, color);
      canvas.line(x1, y1, x0, y1, thickness, color);
      canvas.line(x0, y1, x0, y0, thickness, color);
    }
    canvas.unclip();
    caption(canvas, legend,
            fmt::format("{} objects, {} hidden (grey)", ids.as<uint32_t>().size(),
                        ids.as<uint32_t>().size() - seen));
  }
  std::string nothing_of(size_t row) override {
    const Array ids = source_.load(source_.chosen[row], "box_instance", {DType::u32}, {-1});
    return ids.shape[0] == 0 ? "no boxes" : "";
  }

 protected:
  /// The smallest box around the pixel, with its size and how much of the object is seen.
  std::string text_of(size_t row, const Array& rgb, size_t i, const SceneNames& names) override {
    const IndexRow& record = source_.chosen[row];
    const Array rectangles = source_.load(record, "box_amodal", {DType::f32}, {-1, 4}),
                ids = source_.load(record, "box_instance", {DType::u32}, {-1}),
                visibility = source_.load(record, "box_visibility", {DType::f32}, {-1});
    expect_same_rows(source_, {&rectangles, &ids, &visibility});
    const auto width = static_cast<size_t>(rgb.shape[1]);
    const double u = static_cast<double>(i % width) + 0.5, v = static_cast<double>(i / width) + 0.5;
    double smallest = std::numeric_limits<double>::infinity();
    std::string text = "no box";
    for (size_t b = 0; b < ids.as<uint32_t>().size(); ++b) {
      const float* const r = rectangles.as<float>().data() + 4 * b;
      const double area = (double(r[2]) - r[0]) * (double(r[3]) - r[1]);
      if (u < r[0] || u > r[2] || v < r[1] || v > r[3] || area >= smallest) continue;
      smallest = area;
      text = fmt::format("{}\n{:.4g} x {:.4g} px, {:.0f} % seen", names.instance(ids.as<uint32_t>()[b]),
                         r[2] - r[0], r[3] - r[1], 100.0f * visibility.as<float>()[b]);
    }
    return text;
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
    return static_cast<uint8_t>(255.0 * value * (1.0 - saturation * (1.0 - pure)) + 0.5);
  };
  return {channel(0.0), channel(2.0), channel(4.0)};
}

std::vector<FrameKind> truth_frames() {
  return {{"normals", {"normals"}, make_frame<NormalsPanel>, "normals"},
          {"flow", {"flow"}, make_frame<FlowPanel>, "flow"},
          {"boxes", {"rgb", "box_amodal", "box_visibility"}, make_frame<BoxesPanel>, "boxes"}};
}

}  // namespace greatx::io
