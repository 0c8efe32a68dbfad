// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the panels of cameras: RGB, depth and ids.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "draw/sheet/picture_panel.h"

namespace greatx::io {

namespace {

/// Shows the picture as it is.
class RgbPanel : public PicturePanel {
 public:
  explicit RgbPanel(const PanelSource& source) : PicturePanel(source, "rgb", "rgb", {DType::u8}, 3) {}
  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const Array& image = load(row);
    canvas.picture(picture, image);
    caption(canvas, legend, fmt::format("{} x {}", image.shape[1], image.shape[0]));
  }

 protected:
  std::string text_of(size_t, const Array& image, size_t i, const SceneNames&) override {
    const uint8_t* const rgb = image.as<uint8_t>().data() + 3 * i;
    return fmt::format("rgb {} {} {}", rgb[0], rgb[1], rgb[2]);
  }
};

/// Depth, planar or along the ray; one scale for all rows, so that they can be compared.
class DepthPanel : public PicturePanel {
 public:
  DepthPanel(const PanelSource& source, const std::string& array, const char* what)
      : PicturePanel(source, array, what, {DType::f32}) {
    std::vector<float> values;
    for (size_t row = 0; row < source_.chosen.size(); ++row) {
      const Array& depth = load(row);
      const std::span<const float> metres = depth.as<float>();
      for (size_t i = 0; i < metres.size(); i += 7)
        if (std::isfinite(metres[i]) && metres[i] > 0.0f) values.push_back(metres[i]);
    }
    if (values.empty()) return;
    const auto quantile = [&](double q) {
      const auto at =
          values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), at, values.end());
      return *at;
    };
    const float low = quantile(0.005), high = quantile(0.995);
    scale_ = scale_for(low, high, 10.0);
  }
  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const Array& depth = load(row);
    const std::span<const float> metres = depth.as<float>();
    const int64_t width = depth.shape[1];
    canvas.raster(picture, static_cast<int>(width), static_cast<int>(depth.shape[0]), [&](int x, int y) {
      const float value = metres[static_cast<size_t>(y * width + x)];
      return std::isfinite(value) ? canvas.theme().depths(scale_.at(std::max<double>(value, 1e-6)))
                                  : canvas.theme().sky;
    });
    draw_color_bar(canvas, legend, scale_, canvas.theme().depths, scale_.logarithmic ? "m (log)" : "m");
  }

 protected:
  std::string text_of(size_t, const Array& depth, size_t i, const SceneNames&) override {
    const float metres = depth.as<float>()[i];
    return std::isfinite(metres) ? fmt::format("{:.4g} m", metres) : "sky";
  }

 private:
  Scale scale_{0.0, 100.0, false};
};

/// Luminance on a logarithmic scale, from the first to the last hundredth of the pixels.
class LuminancePanel : public PicturePanel {
 public:
  explicit LuminancePanel(const PanelSource& source)
      : PicturePanel(source, "hdr", "luminance", {DType::f32}, 3) {
    std::vector<double> values;
    for (size_t row = 0; row < source_.chosen.size(); ++row) {
      const Array& array = load(row);
      const size_t pixels = array.as<float>().size() / 3;
      for (size_t i = 0; i < pixels; i += 7)
        if (const double value = luminance(array, i); value > 0.0) values.push_back(value);
    }
    if (values.empty()) return;
    const auto quantile = [&](double q) {
      const auto at =
          values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), at, values.end());
      return *at;
    };
    const double low = quantile(0.01), high = quantile(0.99);
    scale_ = scale_for(low, high, 3.0);
  }
  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const Array& array = load(row);
    const int64_t width = array.shape[1];
    canvas.raster(picture, static_cast<int>(width), static_cast<int>(array.shape[0]), [&](int x, int y) {
      const double value = luminance(array, static_cast<size_t>(y * width + x));
      return canvas.theme().power(scale_.at(std::max(value, 1e-30)));
    });
    draw_color_bar(canvas, legend, scale_, canvas.theme().power,
                   scale_.logarithmic ? "cd/m2 (log)" : "cd/m2");
  }

 protected:
  std::string text_of(size_t, const Array& array, size_t i, const SceneNames&) override {
    const float* const rgb = array.as<float>().data() + 3 * i;
    return fmt::format("{:.4g} cd/m2, red {:.4g} green {:.4g} blue {:.4g}", luminance(array, i), rgb[0],
                       rgb[1], rgb[2]);
  }

 private:
  /// Of linear Rec. 709 components.
  static double luminance(const Array& array, size_t i) {
    const float* const rgb = array.as<float>().data() + 3 * i;
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  }
  Scale scale_{0.1, 1000.0, true};
};

/// Calls `use(id, count)` for every run of pixels with the same id, which is most of a picture.
template <typename Id, typename Use>
void for_each_run(std::span<const Id> ids, const Use& use) {
  for (size_t i = 0; i < ids.size();) {
    size_t end = i + 1;
    while (end < ids.size() && ids[end] == ids[i]) ++end;
    use(static_cast<uint32_t>(ids[i]), end - i);
    i = end;
  }
}
template <typename Use>
void for_each_run(const Array& ids, const Use& use) {
  if (ids.dtype == DType::u8) return for_each_run(ids.as<uint8_t>(), use);
  if (ids.dtype == DType::u16) return for_each_run(ids.as<uint16_t>(), use);
  for_each_run(ids.as<uint32_t>(), use);
}

/// Shows ids in colours. The key names those that are seen: first what moves, each by its largest part, then
/// what takes most pixels.
class IdPanel : public PicturePanel {
 public:
  IdPanel(const PanelSource& source, const std::string& array)
      : PicturePanel(source, array, array == "instance" ? "instances" : array.c_str(),
                     {DType::u8, DType::u16, DType::u32}) {}
  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const Array& image = load(row);
    const size_t seen = image.dtype == DType::u8    ? draw_ids<uint8_t>(canvas, picture, image)
                        : image.dtype == DType::u16 ? draw_ids<uint16_t>(canvas, picture, image)
                                                    : draw_ids<uint32_t>(canvas, picture, image);
    caption(canvas, legend, fmt::format("{} visible", seen));
  }

  std::vector<KeyEntry> key(const Theme& theme) override {
    std::map<uint32_t, size_t> pixels;
    for (size_t row = 0; row < source_.chosen.size(); ++row)
      for_each_run(load(row), [&](uint32_t id, size_t count) { pixels[id] += count; });
    pixels.erase(0);
    const SceneNames names = source_.scene ? source_.scene->names : SceneNames();
    std::vector<std::pair<uint32_t, size_t>> order(pixels.begin(), pixels.end());
    std::ranges::sort(order, [](const auto& a, const auto& b) {
      return std::tuple(b.second, a.first) < std::tuple(a.second, b.first);
    });
    // The largest part of each thing that moves comes first; its rotors and wheels follow with the rest.
    if (array_ == instance_name) {
      std::set<std::string> nodes;
      std::vector<std::pair<uint32_t, size_t>> leading, rest;
      for (const auto& entry : order) {
        const bool leads = names.moves(entry.first) && nodes.insert(names.short_instance(entry.first)).second;
        (leads ? leading : rest).push_back(entry);
      }
      order = std::move(leading);
      order.insert(order.end(), rest.begin(), rest.end());
    }
    const size_t shown = order.size() > most_key_entries ? most_key_entries - 1 : order.size();
    std::vector<KeyEntry> entries;
    for (size_t i = 0; i < shown; ++i)
      entries.push_back(
          {KeyEntry::Mark::square, color_of_id(theme, order[i].first), name_of(names, order[i].first)});
    if (shown < order.size())
      entries.push_back({KeyEntry::Mark::none, {}, fmt::format("and {} more", order.size() - shown)});
    return entries;
  }

 protected:
  std::string text_of(size_t, const Array& image, size_t i, const SceneNames& names) override {
    return name_of(names, image.dtype == DType::u8    ? image.as<uint8_t>()[i]
                          : image.dtype == DType::u16 ? image.as<uint16_t>()[i]
                                                      : image.as<uint32_t>()[i]);
  }

 private:
  static constexpr const char* instance_name = "instance";
  std::string name_of(const SceneNames& names, uint32_t id) const {
    if (array_ == instance_name) return names.instance(id);
    return array_ == "semantic" ? names.semantic_class(id) : names.material(id);
  }

  /// Returns the number of different ids, without 0. Neighbours are mostly equal, so the colour of the last
  /// one is kept.
  template <typename Id>
  static size_t draw_ids(Canvas& canvas, const Rect& picture, const Array& image) {
    const std::span<const Id> ids = image.as<Id>();
    const int64_t width = image.shape[1];
    uint32_t last = 0;
    Color color = color_of_id(canvas.theme(), last);
    canvas.raster(picture, static_cast<int>(width), static_cast<int>(image.shape[0]), [&](int x, int y) {
      const uint32_t id = ids[static_cast<size_t>(y * width + x)];
      if (id != last) last = id, color = color_of_id(canvas.theme(), id);
      return color;
    });
    std::set<uint32_t> distinct;
    for_each_run(ids, [&](uint32_t id, size_t) { distinct.insert(id); });
    distinct.erase(0);
    return distinct.size();
  }
};

constexpr char instance_array[] = "instance", semantic_array[] = "semantic", material_array[] = "material";
constexpr char planar_array[] = "depth", ray_array[] = "depth_ray";
template <const char* array>
std::unique_ptr<FramePanel> make_ids(const PanelSource& source) {
  return std::make_unique<IdPanel>(source, array);
}
template <const char* array>
std::unique_ptr<FramePanel> make_depth(const PanelSource& source) {
  return std::make_unique<DepthPanel>(source, array, array == planar_array ? "depth" : "depth along the ray");
}

}  // namespace

std::vector<FrameKind> camera_frames() {
  std::vector<FrameKind> kinds{
      {"rgb", {"rgb"}, make_frame<RgbPanel>, "rgb"},
      {"depth", {planar_array}, make_depth<planar_array>, "depth"},
      // One of them is enough for the sheet to show that they are there.
      {"instance", {instance_array}, make_ids<instance_array>, "ids"},
      {"semantic", {semantic_array}, make_ids<semantic_array>, "ids"},
      {"material", {material_array}, make_ids<material_array>, "ids"},
  };
  for (FrameKind& kind : truth_frames()) kinds.push_back(std::move(kind));
  kinds.push_back({"depth along the ray", {ray_array}, make_depth<ray_array>, nullptr});
  kinds.push_back({"luminance", {"hdr"}, make_frame<LuminancePanel>, nullptr});
  return kinds;
}

}  // namespace greatx::io
