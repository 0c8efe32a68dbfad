// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the panels of cameras: RGB, depth and ids.
#include <algorithm>
#include <cmath>
#include <set>

#include "draw/sheet/picture_panel.h"

namespace greatx::io {

namespace {

/// Shows the picture as it is.
class RgbPanel : public PicturePanel {
 public:
  explicit RgbPanel(const PanelSource& source) : PicturePanel(source, "rgb", "rgb", {DType::u8}, 3) {}
  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const Array image = load(row);
    canvas.picture(picture, image);
    caption(canvas, legend, fmt::format("{} x {}", image.shape[1], image.shape[0]));
  }
};

/// Shows planar depth. All rows have the same scale, so that they can be compared.
class DepthPanel : public PicturePanel {
 public:
  explicit DepthPanel(const PanelSource& source) : PicturePanel(source, "depth", "depth", {DType::f32}) {
    std::vector<float> values;
    for (size_t row = 0; row < source_.chosen.size(); ++row) {
      const Array depth = load(row);
      const std::span<const float> metres = depth.as<float>();
      for (size_t i = 0; i < metres.size(); i += 7)
        if (std::isfinite(metres[i]) && metres[i] > 0.0f) values.push_back(metres[i]);
    }
    if (values.empty()) return;
    std::sort(values.begin(), values.end());
    const auto quantile = [&](double q) {
      return values[static_cast<size_t>(q * static_cast<double>(values.size() - 1))];
    };
    scale_ = scale_for(quantile(0.005), quantile(0.995), 10.0);
  }
  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const Array depth = load(row);
    const std::span<const float> metres = depth.as<float>();
    const int64_t width = depth.shape[1];
    canvas.raster(picture, static_cast<int>(width), static_cast<int>(depth.shape[0]), [&](int x, int y) {
      const float value = metres[static_cast<size_t>(y * width + x)];
      return std::isfinite(value) ? turbo(1.0 - scale_.at(std::max<double>(value, 1e-6))) : color_of_sky;
    });
    draw_color_bar(
        canvas, legend, scale_, [](double t) { return turbo(1.0 - t); },
        scale_.logarithmic ? "m (log)" : "m");
  }

 private:
  Scale scale_{0.0, 100.0, false};
};

/// Shows ids, each in its colour (color_of_id()).
class IdPanel : public PicturePanel {
 public:
  IdPanel(const PanelSource& source, const std::string& array)
      : PicturePanel(source, array, array == "instance" ? "instances" : array.c_str(),
                     {DType::u8, DType::u16, DType::u32}) {}
  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const Array image = load(row);
    std::vector<uint32_t> ids;
    if (image.dtype == DType::u8)
      ids.assign(image.as<uint8_t>().begin(), image.as<uint8_t>().end());
    else if (image.dtype == DType::u16)
      ids.assign(image.as<uint16_t>().begin(), image.as<uint16_t>().end());
    else
      ids.assign(image.as<uint32_t>().begin(), image.as<uint32_t>().end());
    const int64_t width = image.shape[1];
    canvas.raster(picture, static_cast<int>(width), static_cast<int>(image.shape[0]),
                  [&](int x, int y) { return color_of_id(ids[static_cast<size_t>(y * width + x)]); });
    std::set<uint32_t> distinct(ids.begin(), ids.end());
    distinct.erase(0);
    caption(canvas, legend, fmt::format("{} visible", distinct.size()));
  }
};

}  // namespace

void add_camera_panels(const PanelSource& source, Panels& panels) {
  if (source.has("rgb")) panels.frames.push_back(std::make_unique<RgbPanel>(source));
  if (source.has("depth")) panels.frames.push_back(std::make_unique<DepthPanel>(source));
  for (const char* ids : {"instance", "semantic", "material"}) {
    if (!source.has(ids)) continue;
    panels.frames.push_back(std::make_unique<IdPanel>(source, ids));
    break;  // one of them is enough to show that the sensor has ids
  }
  add_truth_panels(source, panels);
}

}  // namespace greatx::io
