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
    const auto at = [](std::vector<float>& values, double q) {
      const auto found =
          values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), found, values.end());
      return static_cast<double>(*found);
    };
    radius_ = std::max(1.0, 1.05 * at(ranges, 0.97));
    const double low = at(heights, 0.02), high = at(heights, 0.98);
    height_ = scale_for(low, high);
  }
  std::string title() const override { return source_.spec().name + " from above"; }

  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    canvas.clip(picture);
    canvas.fill(picture, canvas.theme().panel);
    const auto [cx, cy, pixels] = layout(picture);
    const double ring = round_down(radius_ / 1.9);
    for (int i = 1; i * ring < 2.0 * radius_; ++i)
      canvas.circle(cx, cy, i * ring * pixels, 1.0, canvas.theme().grid);
    for (const dvec3& point : clouds_[row]) {
      const Color color = canvas.theme().heights(height_.at(point.z));
      const int x = static_cast<int>(std::floor(cx + point.x * pixels)),
                y = static_cast<int>(std::floor(cy - point.y * pixels));
      canvas.blend(x, y, color);
      canvas.blend(x + 1, y, color, 0.35);
      canvas.blend(x, y + 1, color, 0.35);
    }
    canvas.disc(cx, cy, 4.0, canvas.theme().text);
    draw_north(canvas, picture);
    draw_length(canvas, picture, ring, ring * pixels);
    canvas.unclip();
    draw_color_bar(canvas, legend, height_, canvas.theme().heights, "m");
  }
  std::vector<KeyEntry> key(const Theme& theme) override {
    using Mark = KeyEntry::Mark;
    return {
        {Mark::none, {}, north_up_ ? "colour: height in the world" : "colour: height above the sensor"},
        {Mark::disc, theme.text, north_up_ ? "the sensor; north is up" : "the sensor; forward (x) is up"}};
  }
  std::string nothing_of(size_t row) override { return clouds_[row].empty() ? "no points" : ""; }

  /// The point next to the pixel, if one is near; else the place on the ground.
  std::string value_at(const Rect& picture, size_t row, int x, int y, const SceneNames& names) override {
    if (!cell_at(picture, 1, 1, x, y)) return {};
    const auto [cx, cy, pixels] = layout(picture);
    const double right = (x + 0.5 - cx) / pixels, up = (cy - y - 0.5) / pixels;
    std::string text = north_up_ ? fmt::format("east {:.1f} north {:.1f} m of the sensor", right, up)
                                 : fmt::format("forward {:.1f} left {:.1f} m", up, -right);
    constexpr double reach_px = 4.0;
    double nearest = reach_px / pixels;
    size_t found = clouds_[row].size();
    for (size_t i = 0; i < clouds_[row].size(); ++i) {
      const dvec3& point = clouds_[row][i];
      const double distance = std::hypot(point.x - right, point.y - up);
      if (distance < nearest) nearest = distance, found = i;
    }
    if (found == clouds_[row].size()) return text;
    const IndexRow& record = source_.chosen[row];
    const Array points = source_.load(record, "points", {DType::f32}, {-1, 4});
    const float* const point = points.as<float>().data() + 4 * found;
    text += fmt::format("\nrange {:.2f} m, height {:.2f} m, intensity {:.3g}",
                        std::hypot(point[0], point[1], point[2]), clouds_[row][found].z, point[3]);
    if (!source_.has("instance")) return text;
    const Array instances = source_.load(record, "instance", {DType::u32}, {-1});
    expect_same_rows(source_, {&points, &instances});
    const uint32_t id = instances.as<uint32_t>()[found];
    return text + "\n" + (id == 0 ? "fog or rain" : names.instance(id));
  }

 private:
  struct Layout {
    double center_x, center_y, pixels;  ///< pixels a metre
  };
  Layout layout(const Rect& picture) const {
    return {picture.x + 0.5 * picture.width, picture.y + 0.5 * picture.height,
            0.5 * std::min(picture.width, picture.height) / radius_};
  }
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
    canvas.line(x, y + 24, x, y, 2.0, canvas.theme().text);
    canvas.line(x, y, x - 6, y + 9, 2.0, canvas.theme().text);
    canvas.line(x, y, x + 6, y + 9, 2.0, canvas.theme().text);
    canvas.text(x + 1, y - 20, north_up_ ? "N" : "x", theme::text_scale, canvas.theme().text, Align::center);
  }
  static void draw_length(Canvas& canvas, const Rect& picture, double metres, double length) {
    const int x = picture.x + 14, y = picture.bottom() - 14, end = x + static_cast<int>(std::lround(length));
    canvas.fill({x, y, end - x, 2}, canvas.theme().text);
    canvas.fill({x, y - 4, 2, 10}, canvas.theme().text);
    canvas.fill({end - 2, y - 4, 2, 10}, canvas.theme().text);
    canvas.text((x + end) / 2, y - 22, tick_text(metres) + " m", theme::text_scale, canvas.theme().text,
                Align::center);
  }

  PanelSource source_;
  std::vector<std::vector<dvec3>> clouds_;  ///< one for each row, from turned()
  bool north_up_ = true;
  double radius_ = 10.0;
  Scale height_{0.0, 1.0, false};
};

}  // namespace

std::vector<FrameKind> lidar_frames() {
  return {{"from above", {"points"}, make_frame<LidarPanel>, "points"}};
}

}  // namespace greatx::io
