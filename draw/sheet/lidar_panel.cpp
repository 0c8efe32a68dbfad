// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the panel of LiDARs.
#include <algorithm>
#include <cmath>

#include "draw/sheet/panels.h"

namespace greatx::io {

namespace {

/// Shows a point cloud from above, coloured by height. North is up if the data set has the pose of the node;
/// otherwise forward is up.
class LidarPanel : public FramePanel {
 public:
  explicit LidarPanel(const PanelSource& source) : source_(source) {
    std::vector<float> ranges, heights;
    for (const IndexRow& row : source_.chosen) {
      clouds_.push_back(turned(row));
      for (const dvec3& point : clouds_.back()) {
        ranges.push_back(static_cast<float>(std::hypot(point.x, point.y)));
        heights.push_back(static_cast<float>(point.z));
      }
    }
    if (ranges.empty()) return;
    std::sort(ranges.begin(), ranges.end());
    std::sort(heights.begin(), heights.end());
    const auto at = [](const std::vector<float>& values, double q) {
      return static_cast<double>(values[static_cast<size_t>(q * static_cast<double>(values.size() - 1))]);
    };
    radius_ = std::max(1.0, 1.05 * at(ranges, 0.97));
    height_ = scale_for(at(heights, 0.02), at(heights, 0.98));
  }
  std::string title() const override { return source_.spec().name + " from above"; }

  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    canvas.clip(picture);
    canvas.fill(picture, theme::panel);
    const double cx = picture.x + 0.5 * picture.width, cy = picture.y + 0.5 * picture.height;
    const double pixels = 0.5 * std::min(picture.width, picture.height) / radius_;
    const double ring = round_down(radius_ / 1.9);
    for (int i = 1; i * ring < 2.0 * radius_; ++i) canvas.circle(cx, cy, i * ring * pixels, 1.0, theme::grid);
    for (const dvec3& point : clouds_[row]) {
      const Color color = turbo(0.08 + 0.84 * std::clamp(height_.at(point.z), 0.0, 1.0));
      const int x = static_cast<int>(std::floor(cx + point.x * pixels)),
                y = static_cast<int>(std::floor(cy - point.y * pixels));
      canvas.blend(x, y, color);
      canvas.blend(x + 1, y, color, 0.35);
      canvas.blend(x, y + 1, color, 0.35);
    }
    canvas.disc(cx, cy, 4.0, theme::text);
    draw_north(canvas, picture);
    draw_length(canvas, picture, ring, ring * pixels);
    canvas.unclip();
    draw_color_bar(
        canvas, legend, height_, [](double t) { return turbo(0.08 + 0.84 * t); },
        north_up_ ? "m height" : "m above");
  }

 private:
  /// Returns the points of a record in the orientation of the picture: x to the right and y up, relative to
  /// the sensor, and the height.
  std::vector<dvec3> turned(const IndexRow& row) {
    const Array array = source_.load(row, "points", {DType::f32}, {-1, 4});
    const std::span<const float> values = array.as<float>();
    const std::optional<Pose> pose = world_from_sensor(source_, row);
    north_up_ = north_up_ && pose.has_value();
    // Without a pose, forward (x) is up and left (y) is left, and heights are relative to the sensor. With a
    // pose, heights are those of the world.
    const dquat rotation = pose ? pose->orientation : glm::angleAxis(glm::radians(90.0), dvec3(0, 0, 1));
    const dvec3 up(0.0, 0.0, pose ? pose->position.z : 0.0);
    std::vector<dvec3> points;
    for (size_t i = 0; i + 3 < values.size(); i += 4)
      points.push_back(rotation * dvec3(values[i], values[i + 1], values[i + 2]) + up);
    return points;
  }
  void draw_north(Canvas& canvas, const Rect& picture) const {
    const int x = picture.right() - 22, y = picture.y + 32;
    canvas.line(x, y + 24, x, y, 2.0, theme::text);
    canvas.line(x, y, x - 6, y + 9, 2.0, theme::text);
    canvas.line(x, y, x + 6, y + 9, 2.0, theme::text);
    canvas.text(x + 1, y - 20, north_up_ ? "N" : "x", theme::text_scale, theme::text, Align::center);
  }
  static void draw_length(Canvas& canvas, const Rect& picture, double metres, double length) {
    const int x = picture.x + 14, y = picture.bottom() - 14, end = x + static_cast<int>(std::lround(length));
    canvas.fill({x, y, end - x, 2}, theme::text);
    canvas.fill({x, y - 4, 2, 10}, theme::text);
    canvas.fill({end - 2, y - 4, 2, 10}, theme::text);
    canvas.text((x + end) / 2, y - 22, tick_text(metres) + " m", theme::text_scale, theme::text,
                Align::center);
  }

  PanelSource source_;
  std::vector<std::vector<dvec3>> clouds_;  ///< one for each row, from turned()
  bool north_up_ = true;
  double radius_ = 10.0;
  Scale height_{0.0, 1.0, false};
};

}  // namespace

void add_lidar_panels(const PanelSource& source, Panels& panels) {
  if (source.has("points")) panels.frames.push_back(std::make_unique<LidarPanel>(source));
}

}  // namespace greatx::io
