// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/error/ssim.h"

#include <cmath>
#include <vector>

namespace greatx::sim {

namespace {

constexpr int64_t window = 11;
constexpr double sd_px = 1.5;

std::vector<double> luma(const Array& picture) {
  const std::span<const uint8_t> rgb = picture.as<uint8_t>();
  std::vector<double> values(rgb.size() / 3);
  for (size_t i = 0; i < values.size(); ++i)
    values[i] = 0.299 * rgb[3 * i] + 0.587 * rgb[3 * i + 1] + 0.114 * rgb[3 * i + 2];
  return values;
}

/// Means over the windows: [height - n + 1, width - m + 1].
std::vector<double> means(const std::vector<double>& in, int64_t height, int64_t width,
                          const std::vector<double>& along_y, const std::vector<double>& along_x) {
  const auto n = static_cast<int64_t>(along_y.size()), m = static_cast<int64_t>(along_x.size());
  const int64_t rows = height - n + 1, columns = width - m + 1;
  std::vector<double> narrow(static_cast<size_t>(height * columns), 0.0);
  for (int64_t y = 0; y < height; ++y)
    for (int64_t t = 0; t < m; ++t) {
      const double weight = along_x[static_cast<size_t>(t)];
      const double* const from = in.data() + y * width + t;
      double* const to = narrow.data() + y * columns;
      for (int64_t x = 0; x < columns; ++x) to[x] += weight * from[x];
    }
  std::vector<double> out(static_cast<size_t>(rows * columns), 0.0);
  for (int64_t y = 0; y < rows; ++y)
    for (int64_t t = 0; t < n; ++t) {
      const double weight = along_y[static_cast<size_t>(t)];
      const double* const from = narrow.data() + (y + t) * columns;
      double* const to = out.data() + y * columns;
      for (int64_t x = 0; x < columns; ++x) to[x] += weight * from[x];
    }
  return out;
}

std::vector<double> weights(int64_t extent) {
  std::vector<double> values;
  double sum = 0.0;
  for (int64_t i = 0; i < std::min(extent, window); ++i) {
    const double x = static_cast<double>(i) - 0.5 * double(window - 1);
    values.push_back(extent < window ? 1.0 : std::exp(-x * x / (2.0 * sd_px * sd_px)));
    sum += values.back();
  }
  for (double& value : values) value /= sum;
  return values;
}

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> values(a.size());
  for (size_t i = 0; i < a.size(); ++i) values[i] = a[i] * b[i];
  return values;
}

}  // namespace

double ssim(const Array& a, const Array& b) {
  GREATX_CHECK(a.dtype == DType::u8 && a.shape == b.shape && a.shape.size() == 3 && a.shape[2] == 3 &&
                   a.shape[0] > 0 && a.shape[1] > 0,
               "pictures of different shapes, or not u8 [h, w, 3]");
  const int64_t height = a.shape[0], width = a.shape[1];
  const std::vector<double> x = luma(a), y = luma(b), along_y = weights(height), along_x = weights(width);
  const auto mean = [&](const std::vector<double>& values) {
    return means(values, height, width, along_y, along_x);
  };
  const std::vector<double> mx = mean(x), my = mean(y), xx = mean(product(x, x)), yy = mean(product(y, y)),
                            xy = mean(product(x, y));
  constexpr double c1 = 0.01 * 255.0 * 0.01 * 255.0, c2 = 0.03 * 255.0 * 0.03 * 255.0;
  double sum = 0.0;
  for (size_t i = 0; i < mx.size(); ++i) {
    const double vx = xx[i] - mx[i] * mx[i], vy = yy[i] - my[i] * my[i], cov = xy[i] - mx[i] * my[i];
    sum += (2.0 * mx[i] * my[i] + c1) * (2.0 * cov + c2) /
           ((mx[i] * mx[i] + my[i] * my[i] + c1) * (vx + vy + c2));
  }
  return sum / static_cast<double>(mx.size());
}

}  // namespace greatx::sim
