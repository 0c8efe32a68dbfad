// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of cameras: colour as WebP; depth, ids, flow, normals and luminance as packed numbers; boxes.
#include <algorithm>
#include <cmath>

#include "draw/report/parts.h"
#include "io/formats/webp.h"

namespace greatx::io::report {

namespace {

constexpr double depth_ratio = 1.002, luminance_ratio = 1.01, flow_step_px = 1.0 / 16.0;

/// Returns the factor by which a picture is thinned so that it is at most `most` wide.
int64_t thinning(int64_t width, int64_t most) { return (width + most - 1) / most; }

void note_thinning(const Context& context, const char* what, const SensorSpec& sensor, int64_t factor) {
  if (factor > 1)
    context.collected.notes.insert(fmt::format("{} of {} are shown at 1/{} of their width and height.", what,
                                               printable(sensor.name), factor));
}

/// Averages blocks of factor x factor pixels, as their codes are (sRGB).
Array smaller_picture(const Array& rgb, int64_t factor) {
  const int64_t h = rgb.shape[0], w = rgb.shape[1];
  const int64_t rows = (h + factor - 1) / factor, columns = (w + factor - 1) / factor;
  if (factor == 1) return rgb;
  Array small(DType::u8, {rows, columns, 3});
  const std::span<const uint8_t> from = rgb.as<uint8_t>();
  for (int64_t y = 0; y < rows; ++y)
    for (int64_t x = 0; x < columns; ++x) {
      const int64_t bottom = std::min(h, (y + 1) * factor), right = std::min(w, (x + 1) * factor);
      const int64_t count = (bottom - y * factor) * (right - x * factor);
      for (int64_t c = 0; c < 3; ++c) {
        int64_t sum = count / 2;
        for (int64_t j = y * factor; j < bottom; ++j)
          for (int64_t i = x * factor; i < right; ++i) sum += from[static_cast<size_t>((j * w + i) * 3 + c)];
        small.as<uint8_t>()[static_cast<size_t>((y * columns + x) * 3 + c)] =
            static_cast<uint8_t>(sum / count);
      }
    }
  return small;
}

/// Calls take(pixel) for the pixel in the middle of each block, row by row, where `pixel` is an index into
/// [h, w]. Returns the size of the thinned raster.
template <typename Take>
std::pair<int64_t, int64_t> thin(const Array& raster, int64_t factor, const Take& take) {
  const int64_t h = raster.shape[0], w = raster.shape[1];
  const int64_t rows = (h + factor - 1) / factor, columns = (w + factor - 1) / factor;
  for (int64_t y = 0; y < rows; ++y)
    for (int64_t x = 0; x < columns; ++x)
      take(static_cast<size_t>(std::min(h - 1, y * factor + factor / 2) * w +
                               std::min(w - 1, x * factor + factor / 2)));
  return {rows, columns};
}

/// A raster's JSON: blob, rows, columns, and the pixels of the sensor that one of the page stands for.
Json raster_json(size_t blob, std::pair<int64_t, int64_t> size, int64_t factor) {
  return {{"blob", blob}, {"h", size.first}, {"w", size.second}, {"by", factor}};
}

/// Adds the values below and above which a two-hundredth of them lies, for the page's scale.
void add_span(Json& json, std::vector<float> values) {
  std::erase_if(values, [](float value) { return !std::isfinite(value) || !(value > 0.0f); });
  if (values.empty()) return;
  const auto quantile = [&](double q) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return static_cast<double>(*at);
  };
  const double low = quantile(0.005), high = quantile(0.995);
  json["span"] = {low, high};
}

/// Packs positive numbers by their logarithm.
Json encode_scalar(const Context& context, const PanelSource& source, const Array& raster,
                   std::span<const float> values, double ratio) {
  const int64_t factor = thinning(raster.shape[1], context.detail.value_width);
  note_thinning(context, "Depth, ids and other values", source.spec(), factor);
  std::vector<float> kept;
  const auto size = thin(raster, factor, [&](size_t pixel) { kept.push_back(values[pixel]); });
  const LogCode code = LogCode::of(kept, ratio);
  std::vector<uint32_t> codes;
  codes.reserve(kept.size());
  for (const float value : kept) codes.push_back(code.code(value));
  Json json =
      raster_json(context.blobs.add(packed(codes, 2, static_cast<size_t>(size.second))), size, factor);
  json["low"] = code.low;
  json["ratio"] = code.ratio;
  add_span(json, std::move(kept));
  return json;
}

Json encode_flow(const Context& context, const PanelSource& source, const Array& flow) {
  const int64_t factor = thinning(flow.shape[1], context.detail.value_width);
  const std::span<const float> values = flow.as<float>();
  std::vector<uint32_t> codes;
  std::vector<float> lengths;
  std::pair<int64_t, int64_t> size;
  for (const size_t part : {0, 1})
    size = thin(flow, factor, [&](size_t pixel) {
      const double value = values[2 * pixel + part];
      // 0 stands for "out of sight"; 32768 is no motion.
      codes.push_back(std::isfinite(value) ? static_cast<uint32_t>(std::clamp(
                                                 32768.0 + std::round(value / flow_step_px), 1.0, 65535.0))
                                           : 0u);
      if (part == 0) lengths.push_back(std::hypot(values[2 * pixel], values[2 * pixel + 1]));
    });
  note_thinning(context, "Depth, ids and other values", source.spec(), factor);
  Json json =
      raster_json(context.blobs.add(packed(codes, 2, static_cast<size_t>(size.second))), size, factor);
  json["step"] = flow_step_px;
  add_span(json, std::move(lengths));
  return json;
}

Json encode_normals(const Context& context, const Array& normals) {
  const int64_t factor = thinning(normals.shape[1], context.detail.value_width);
  const std::span<const float> values = normals.as<float>();
  std::vector<uint32_t> codes;
  std::pair<int64_t, int64_t> size;
  for (const size_t part : {0, 1, 2})
    size = thin(normals, factor, [&](size_t pixel) {
      codes.push_back(
          static_cast<uint32_t>(nearest(128.0 + 127.0 * std::clamp(values[3 * pixel + part], -1.0f, 1.0f))));
    });
  return raster_json(context.blobs.add(packed(codes, 1, static_cast<size_t>(size.second))), size, factor);
}

/// Packs the boxes of a record as text: [instance, u0, v0, u1, v1, visibility, x, y, z, size, wxyz].
Json encode_boxes(const Context& context, const PanelSource& source, const IndexRow& row) {
  const Array ids = source.load(row, "box_instance", {DType::u32}, {-1}),
              rectangles = source.load(row, "box_amodal", {DType::f32}, {-1, 4}),
              visible = source.load(row, "box_visibility", {DType::f32}, {-1}),
              center = source.load(row, "box_center", {DType::f64}, {-1, 3}),
              size = source.load(row, "box_size", {DType::f32}, {-1, 3}),
              turn = source.load(row, "box_orientation", {DType::f64}, {-1, 4});
  expect_same_rows(source, {&ids, &rectangles, &visible, &center, &size, &turn});
  Json list = Json::array();
  const size_t count = ids.as<uint32_t>().size();
  for (size_t i = 0; i < count && list.size() < most_boxes; ++i) {
    const float* const r = rectangles.as<float>().data() + 4 * i;
    const double* const c = center.as<double>().data() + 3 * i;
    const float* const s = size.as<float>().data() + 3 * i;
    const double* const q = turn.as<double>().data() + 4 * i;
    Json box = {ids.as<uint32_t>()[i], rounded(r[0], 1), rounded(r[1], 1),
                rounded(r[2], 1),      rounded(r[3], 1), rounded(visible.as<float>()[i], 3)};
    for (const Json& value : place_json(context, {c[0], c[1], c[2]})) box.push_back(value);
    for (int k = 0; k < 3; ++k) box.push_back(rounded(s[k], 3));
    for (int k = 0; k < 4; ++k) box.push_back(rounded(q[k], 6));
    list.push_back(std::move(box));
    context.collected.instances.insert(ids.as<uint32_t>()[i]);
  }
  if (count > most_boxes)
    context.collected.notes.insert(
        fmt::format("{}: the first {} boxes of each record.", printable(source.spec().name), most_boxes));
  return {{"blob", context.blobs.add(packed_text(list.dump()))}, {"all", count}};
}

}  // namespace

Json encode_ids(const Context& context, const Array& ids, std::set<uint32_t>& seen) {
  const int64_t factor = thinning(ids.shape[1], context.detail.value_width);
  const auto value = [&](size_t i) -> uint32_t {
    return ids.dtype == DType::u8    ? ids.as<uint8_t>()[i]
           : ids.dtype == DType::u16 ? ids.as<uint16_t>()[i]
                                     : ids.as<uint32_t>()[i];
  };
  std::vector<uint32_t> kept;
  const auto size = thin(ids, factor, [&](size_t pixel) { kept.push_back(value(pixel)); });
  uint32_t largest = 0, last = 0;
  for (const uint32_t id : kept) {
    if (id != last) seen.insert(id), last = id;
    largest = std::max(largest, id);
  }
  const int bytes = largest < 256 ? 1 : largest < 65536 ? 2 : 4;
  Json json = raster_json(context.blobs.add(packed(kept, bytes, 0)), size, factor);
  json["bytes"] = bytes;
  return json;
}

Json describe_camera(const PanelSource& source) {
  const JsonDocument metadata = metadata_of(source);
  Json json = Json::object();
  // Without intrinsics the page draws nothing over the picture: it knows pinhole cameras alone.
  if (metadata.root().has("lens")) return json;
  for (const char* const key : {"fx", "fy", "cx", "cy", "width", "height"})
    if (metadata.root().has(key)) json[key] = metadata.root().at(key).number(-1e9, 1e9);
  if (metadata.root().has("distortion")) {
    const JsonValue lens = metadata.root().at("distortion");
    for (const char* const key : {"k1", "k2", "p1", "p2", "k3"})
      json["distortion"].push_back(lens.has(key) ? lens.at(key).number(-1e9, 1e9) : 0.0);
  }
  return json;
}

Json encode_camera(const Context& context, const PanelSource& source, const IndexRow& row) {
  Json json = {{"pose", pose_json(context, context.poses.world_from(node_of(source.spec()), mount_of(source),
                                                                    row.tick))}};
  if (source.has("rgb")) {
    const Array rgb = source.load(row, "rgb", {DType::u8}, {0, 0, 3});
    const int64_t factor = thinning(rgb.shape[1], context.detail.picture_width);
    note_thinning(context, "Pictures", source.spec(), factor);
    const Array small = smaller_picture(rgb, factor);
    json["rgb"] = {{"blob", context.blobs.add(encode_webp(small, context.detail.quality))},
                   {"h", small.shape[0]},
                   {"w", small.shape[1]},
                   {"by", factor}};
  }
  for (const char* const name : {"depth", "depth_ray"})
    if (source.has(name)) {
      const Array depth = source.load(row, name, {DType::f32}, {0, 0});
      json[name] = encode_scalar(context, source, depth, depth.as<float>(), depth_ratio);
    }
  const std::vector<DType> integers{DType::u8, DType::u16, DType::u32};
  if (source.has("instance"))
    json["instance"] =
        encode_ids(context, source.load(row, "instance", integers, {0, 0}), context.collected.instances);
  if (source.has("semantic"))
    json["semantic"] =
        encode_ids(context, source.load(row, "semantic", integers, {0, 0}), context.collected.classes);
  if (source.has("material"))
    json["material"] =
        encode_ids(context, source.load(row, "material", integers, {0, 0}), context.collected.materials);
  if (source.has("flow"))
    json["flow"] = encode_flow(context, source, source.load(row, "flow", {DType::f32}, {0, 0, 2}));
  if (source.has("normals"))
    json["normals"] = encode_normals(context, source.load(row, "normals", {DType::f32}, {0, 0, 3}));
  if (source.has("hdr")) {
    const Array hdr = source.load(row, "hdr", {DType::f32}, {0, 0, 3});
    const std::span<const float> rgb = hdr.as<float>();
    std::vector<float> luminance(rgb.size() / 3);  // Rec. 709
    for (size_t i = 0; i < luminance.size(); ++i)
      luminance[i] = 0.2126f * rgb[3 * i] + 0.7152f * rgb[3 * i + 1] + 0.0722f * rgb[3 * i + 2];
    json["luminance"] = encode_scalar(context, source, hdr, luminance, luminance_ratio);
  }
  if (source.has("box_instance") && source.has("box_center") && source.has("box_amodal"))
    json["boxes"] = encode_boxes(context, source, row);
  return json;
}

}  // namespace greatx::io::report
