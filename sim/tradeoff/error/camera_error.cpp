// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "sim/tradeoff/error/flip.h"
#include "sim/tradeoff/error/samples.h"
#include "sim/tradeoff/error/ssim.h"

namespace greatx::sim {

namespace {

bool is_picture(const Array* array, DType dtype, int64_t channels) {
  if (array == nullptr || array->dtype != dtype) return false;
  if (channels == 0) return array->shape.size() == 2;
  return array->shape.size() == 3 && array->shape[2] == channels;
}

/// The row or column of a picture of `from` pixels under the middle of place i of `to`.
int64_t nearest(int64_t i, int64_t to, int64_t from) {
  return std::min(from - 1, static_cast<int64_t>((static_cast<double>(i) + 0.5) * double(from) / double(to)));
}

/// Returns the picture, u8 [h, w, 3], with another size, bilinearly.
Array resized(const Array& picture, int64_t height, int64_t width) {
  if (picture.shape[0] == height && picture.shape[1] == width) return picture;
  Array result(DType::u8, {height, width, 3});
  const std::span<const uint8_t> in = picture.as<uint8_t>();
  const std::span<uint8_t> out = result.as<uint8_t>();
  const int64_t h = picture.shape[0], w = picture.shape[1];
  struct Place {
    int64_t low, high;
    double share;
  };
  const auto place = [](int64_t i, int64_t to, int64_t from) {
    const double at = std::clamp((static_cast<double>(i) + 0.5) * double(from) / double(to) - 0.5, 0.0,
                                 static_cast<double>(from - 1));
    const auto low = static_cast<int64_t>(at);
    return Place{low, std::min(low + 1, from - 1), at - static_cast<double>(low)};
  };
  for (int64_t y = 0; y < height; ++y) {
    const Place v = place(y, height, h);
    for (int64_t x = 0; x < width; ++x) {
      const Place u = place(x, width, w);
      for (int64_t c = 0; c < 3; ++c) {
        const auto at = [&](int64_t row, int64_t column) {
          return static_cast<double>(in[static_cast<size_t>((row * w + column) * 3 + c)]);
        };
        const double above = (1.0 - u.share) * at(v.low, u.low) + u.share * at(v.low, u.high);
        const double below = (1.0 - u.share) * at(v.high, u.low) + u.share * at(v.high, u.high);
        out[static_cast<size_t>((y * width + x) * 3 + c)] =
            static_cast<uint8_t>(std::lround((1.0 - v.share) * above + v.share * below));
      }
    }
  }
  return result;
}

class CameraError : public ErrorSum {
 public:
  void add(const SensorSpec& reference_spec, const Record& reference, const SensorSpec& spec,
           const Record& record) override {
    const auto pair = [&](const char* name) {
      return ArrayPair{array_of(reference_spec, reference, name), array_of(spec, record, name)};
    };
    add_rgb(pair("rgb"));
    add_depth(pair("depth"));
    add_ids(pair("instance"));
    add_flow(pair("flow"));
  }

  std::vector<ErrorFigure> figures() const override {
    std::vector<ErrorFigure> figures;
    if (pictures_ > 0) {
      figures.push_back({"flip", "1", flip_ / double(pictures_), "mean of FLIP: 0 equal, 1 black and white"});
      figures.push_back({"ssim", "1", ssim_ / double(pictures_), "1 less the structural similarity"});
    }
    if (!depth_m_.empty()) {
      figures.push_back({"depth", "m", depth_sum_m_ / double(depths_), "mean error of depth"});
      figures.push_back({"depth_p95", "m", depth_m_.quantile(0.95), "95th percentile of the error of depth"});
    }
    const auto share = [](uint64_t part, uint64_t whole) { return 100.0 * double(part) / double(whole); };
    if (depth_pixels_ > 0)
      figures.push_back({"depth_other", "%", share(one_sided_, depth_pixels_),
                         "pixels with a depth in one of the two only"});
    if (ids_ > 0)
      figures.push_back({"ids", "%", share(other_ids_, ids_), "pixels that see another instance"});
    if (flows_ > 0)
      figures.push_back({"flow", "px", flow_sum_px_ / double(flows_), "mean end-point error of the flow"});
    return figures;
  }

 private:
  void add_rgb(const ArrayPair& rgb) {
    if (!is_picture(rgb.reference, DType::u8, 3) || !is_picture(rgb.got, DType::u8, 3)) return;
    const int64_t height = rgb.reference->shape[0], width = rgb.reference->shape[1];
    const Array got = resized(*rgb.got, height, width);
    ++pictures_;
    if (got.bytes == rgb.reference->bytes) return;
    flip_ += flip(*rgb.reference, got).mean;
    ssim_ += 1.0 - ssim(*rgb.reference, got);
  }
  /// Calls take(i, j) for each pixel i of the reference, with pixel j of the other picture under it.
  template <typename Take>
  static void for_pixels(const ArrayPair& pair, const Take& take) {
    const int64_t height = pair.reference->shape[0], width = pair.reference->shape[1];
    const int64_t h = pair.got->shape[0], w = pair.got->shape[1];
    for (int64_t y = 0; y < height; ++y) {
      const int64_t row = nearest(y, height, h) * w;
      for (int64_t x = 0; x < width; ++x)
        take(static_cast<size_t>(y * width + x), static_cast<size_t>(row + nearest(x, width, w)));
    }
  }
  void add_depth(const ArrayPair& depth) {
    if (!is_picture(depth.reference, DType::f32, 0) || !is_picture(depth.got, DType::f32, 0)) return;
    const auto a = depth.reference->as<float>(), b = depth.got->as<float>();
    for_pixels(depth, [&](size_t i, size_t j) {
      ++depth_pixels_;
      const bool in_a = std::isfinite(a[i]), in_b = std::isfinite(b[j]);
      one_sided_ += in_a != in_b;
      if (!in_a || !in_b) return;
      const double error = std::abs(static_cast<double>(a[i]) - static_cast<double>(b[j]));
      depth_m_.add(error);
      depth_sum_m_ += error;
      ++depths_;
    });
  }
  void add_ids(const ArrayPair& ids) {
    if (!is_picture(ids.reference, DType::u16, 0) || !is_picture(ids.got, DType::u16, 0)) return;
    const auto a = ids.reference->as<uint16_t>(), b = ids.got->as<uint16_t>();
    for_pixels(ids, [&](size_t i, size_t j) {
      ++ids_;
      other_ids_ += a[i] != b[j];
    });
  }
  /// Flow of pictures of other sizes is scaled to the reference's pixels.
  void add_flow(const ArrayPair& flow) {
    if (!is_picture(flow.reference, DType::f32, 2) || !is_picture(flow.got, DType::f32, 2)) return;
    const auto a = flow.reference->as<float>(), b = flow.got->as<float>();
    const double scale = double(flow.reference->shape[1]) / double(flow.got->shape[1]);
    for_pixels(flow, [&](size_t i, size_t j) {
      const double u = scale * double(b[2 * j]) - double(a[2 * i]),
                   v = scale * double(b[2 * j + 1]) - double(a[2 * i + 1]);
      if (!std::isfinite(u) || !std::isfinite(v)) return;
      flow_sum_px_ += std::sqrt(u * u + v * v);
      ++flows_;
    });
  }

  uint64_t pictures_ = 0, depth_pixels_ = 0, depths_ = 0, one_sided_ = 0, ids_ = 0, other_ids_ = 0,
           flows_ = 0;
  double flip_ = 0.0, ssim_ = 0.0, depth_sum_m_ = 0.0, flow_sum_px_ = 0.0;
  Samples depth_m_;
};

}  // namespace

std::unique_ptr<ErrorSum> make_camera_error() { return std::make_unique<CameraError>(); }

}  // namespace greatx::sim
