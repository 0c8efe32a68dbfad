// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws a radar's detections over the picture of a camera of the same node: where the camera sees them, in
// the colours of their velocities.
#include <algorithm>
#include <cmath>
#include <memory>

#include "draw/sheet/companion.h"
#include "draw/sheet/panels.h"

namespace greatx::io {

namespace {

/// Holds a pinhole camera: pixels, and the picture's size.
struct Pinhole {
  double fx = 1.0, fy = 1.0, cx = 0.0, cy = 0.0, width = 1.0, height = 1.0;
};

Pinhole pinhole_of(const PanelSource& camera) {
  const JsonDocument metadata = metadata_of(camera);
  const auto positive = [&](const char* key) { return metadata.root().at(key).number(1e-6, 1e9); };
  Pinhole lens{positive("fx"), positive("fy"), 0.0, 0.0, positive("width"), positive("height")};
  lens.cx = metadata.root().at("cx").number(-1e9, 1e9), lens.cy = metadata.root().at("cy").number(-1e9, 1e9);
  return lens;
}

class RadarOverlayPanel : public FramePanel {
 public:
  RadarOverlayPanel(const PanelSource& source, Companion camera)
      : source_(source), camera_(std::move(camera)), lens_(pinhole_of(camera_.source)) {
    for (const IndexRow& row : source_.chosen) load_detections(row);
    double fastest = 0.0;
    for (const auto& row : detections_)
      for (const Detection& d : row) fastest = std::max(fastest, std::abs(d.velocity));
    scale_ = {-std::max(1.0, fastest), std::max(1.0, fastest), false};
  }
  std::string title() const override { return source_.spec().name + " over the picture"; }
  double aspect() const override { return lens_.height / lens_.width; }

  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    canvas.fill(picture, canvas.theme().panel);
    if (camera_.rows[row])
      canvas.picture(picture, camera_.source.load(*camera_.rows[row], "rgb", {DType::u8}, {0, 0, 3}));
    canvas.clip(picture);
    for (const Detection& d : detections_[row])
      if (const std::optional<dvec2> at = place(picture, d)) {
        canvas.disc(at->x, at->y, 6.0, canvas.theme().halo);
        canvas.disc(at->x, at->y, 4.5, color(canvas.theme(), d));
      }
    canvas.unclip();
    draw_color_bar(canvas, legend, scale_, canvas.theme().velocities, "m/s");
  }
  std::vector<KeyEntry> key(const Theme&) override {
    return {{KeyEntry::Mark::none, {}, "dots: detections by range rate"}};
  }
  std::string nothing_of(size_t row) override { return detections_[row].empty() ? "no detections" : ""; }

  std::string value_at(const Rect& picture, size_t row, int x, int y, const SceneNames& names) override {
    if (!cell_at(picture, 1, 1, x, y)) return {};
    std::string text;
    double nearest = 8.0;
    for (const Detection& d : detections_[row]) {
      const std::optional<dvec2> at = place(picture, d);
      const double distance = at ? std::hypot(x + 0.5 - at->x, y + 0.5 - at->y) : nearest;
      if (distance >= nearest) continue;
      nearest = distance;
      text = fmt::format("detection: {:.2f} m, {:.2f} m/s\n{}", glm::length(d.at), d.velocity,
                         d.instance != 0 ? names.instance(d.instance) : "false alarm");
    }
    return text;
  }

 private:
  struct Detection {
    dvec3 at{0.0};  ///< in the radar's frame
    double velocity = 0.0;
    uint32_t instance = 0;
  };
  void load_detections(const IndexRow& row) {
    std::vector<Detection>& list = detections_.emplace_back();
    const Array places = source_.load(row, "detections", {DType::f32}, {-1, 4}),
                velocities = source_.load(row, "velocity", {DType::f32}, {-1}),
                instances = source_.load(row, "instance", {DType::u32}, {-1});
    expect_same_rows(source_, {&places, &velocities, &instances});
    const float* const p = places.as<float>().data();
    for (size_t i = 0; i < velocities.as<float>().size(); ++i)
      list.push_back({dvec3(p[4 * i], p[4 * i + 1], p[4 * i + 2]), velocities.as<float>()[i],
                      instances.as<uint32_t>()[i]});
  }
  Color color(const Theme& theme, const Detection& d) const {
    return theme.velocities(scale_.at(d.velocity));
  }
  /// Returns where the camera sees a detection, or nothing if it is behind the camera or beside the picture.
  std::optional<dvec2> place(const Rect& picture, const Detection& d) const {
    const dvec3 at = camera_.from_first.apply(d.at);  // x forward, y left, z up
    if (!(at.x > 0.1)) return std::nullopt;
    const double u = lens_.cx - lens_.fx * at.y / at.x, v = lens_.cy - lens_.fy * at.z / at.x;
    if (!(u >= 0.0 && u < lens_.width && v >= 0.0 && v < lens_.height)) return std::nullopt;
    return dvec2(picture.x + u / lens_.width * picture.width, picture.y + v / lens_.height * picture.height);
  }

  PanelSource source_;
  Companion camera_;
  Pinhole lens_;
  std::vector<std::vector<Detection>> detections_;  ///< one list for each row
  Scale scale_{-1.0, 1.0, false};
};

/// Returns nothing if no camera of the node has pictures at these ticks, or if its lens distorts them.
std::unique_ptr<FramePanel> make_overlay(const PanelSource& source) {
  std::optional<Companion> camera = companion(source, "camera", {"rgb"});
  if (!camera) return nullptr;
  const JsonDocument metadata = metadata_of(camera->source);
  const auto& root = metadata.root();
  if (!root.has("fx") || root.has("distortion") || root.has("lens")) return nullptr;
  return std::make_unique<RadarOverlayPanel>(source, std::move(*camera));
}

}  // namespace

std::vector<FrameKind> radar_overlay_frames() {
  return {{"over the picture", {"detections", "velocity", "instance"}, make_overlay, "overlay"}};
}

}  // namespace greatx::io
