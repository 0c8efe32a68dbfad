// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <span>
#include <unordered_map>

#include "sim/tradeoff/error/samples.h"

namespace greatx::sim {

namespace {

/// Shots are the same if their directions differ by less than this, rad: far below any LiDAR's step, and far
/// above the rounding of points in fp32.
constexpr double same_direction = 1e-4;

/// The returns of one record.
struct Returns {
  std::span<const float> points, range;
  std::span<const uint16_t> ring, number;
};

bool returns_of(const SensorSpec& spec, const Record& record, Returns& returns) {
  const Array *const points = array_of(spec, record, "points"),
                     *const range = array_of(spec, record, "range"),
                     *const ring = array_of(spec, record, "ring"),
                     *const number = array_of(spec, record, "return_number");
  if (points == nullptr || range == nullptr || ring == nullptr || number == nullptr) return false;
  if (points->dtype != DType::f32 || range->dtype != DType::f32 || ring->dtype != DType::u16 ||
      number->dtype != DType::u16)
    return false;
  returns = {points->as<float>(), range->as<float>(), ring->as<uint16_t>(), number->as<uint16_t>()};
  return returns.points.size() == 4 * returns.range.size() && returns.ring.size() == returns.range.size() &&
         returns.number.size() == returns.range.size();
}

/// The direction of a return's shot, as cells of a grid of `same_direction`.
struct Cell {
  int64_t azimuth = 0, elevation = 0;
};
Cell cell_of(const Returns& returns, size_t i) {
  const double x = static_cast<double>(returns.points[4 * i]),
               y = static_cast<double>(returns.points[4 * i + 1]),
               z = static_cast<double>(returns.points[4 * i + 2]);
  return {std::llround(std::atan2(y, x) / same_direction),
          std::llround(std::atan2(z, std::sqrt(x * x + y * y)) / same_direction)};
}
uint64_t key_of(const Returns& returns, size_t i, const Cell& cell) {
  // 17 bits for each angle, 15 for the ring and 15 for the return.
  const auto bits = [](int64_t value) { return static_cast<uint64_t>(value + 65536) & 0x1ffff; };
  return bits(cell.azimuth) << 47 | bits(cell.elevation) << 30 | (uint64_t{returns.ring[i]} & 0x7fff) << 15 |
         (uint64_t{returns.number[i]} & 0x7fff);
}

class LidarError : public ErrorSum {
 public:
  void add(const SensorSpec& reference_spec, const Record& reference, const SensorSpec& spec,
           const Record& record) override {
    Returns a, b;
    if (!returns_of(reference_spec, reference, a) || !returns_of(spec, record, b)) return;
    ++records_;
    std::unordered_map<uint64_t, size_t> found;
    found.reserve(2 * a.range.size());
    for (size_t i = 0; i < a.range.size(); ++i) found.emplace(key_of(a, i, cell_of(a, i)), i);
    size_t both = 0;
    for (size_t j = 0; j < b.range.size(); ++j) {
      const auto partner = partner_of(b, j, found);
      if (!partner) continue;
      ++both;
      const double error = std::abs(static_cast<double>(b.range[j]) - static_cast<double>(a.range[*partner]));
      range_m_.add(error);
      range_sum_m_ += error;
      intensity_sum_ += std::abs(static_cast<double>(b.points[4 * j + 3]) -
                                 static_cast<double>(a.points[4 * *partner + 3]));
    }
    ranges_ += both;
    reference_returns_ += a.range.size();
    one_sided_ += a.range.size() + b.range.size() - 2 * both;
  }

  std::vector<ErrorFigure> figures() const override {
    std::vector<ErrorFigure> figures;
    if (ranges_ > 0) {
      figures.push_back({"range", "m", range_sum_m_ / static_cast<double>(ranges_), "mean error of ranges"});
      figures.push_back(
          {"range_p95", "m", range_m_.quantile(0.95), "95th percentile of the error of ranges"});
    }
    if (ranges_ > 0)
      figures.push_back(
          {"intensity", "1", intensity_sum_ / static_cast<double>(ranges_), "mean error of intensities"});
    if (reference_returns_ > 0)
      figures.push_back({"missed", "%", 100.0 * double(one_sided_) / double(reference_returns_),
                         "returns that only one of the two has, of the reference's"});
    return figures;
  }

 private:
  /// Looks in the cells around, since the directions of equal shots may be rounded into neighbours.
  static std::optional<size_t> partner_of(const Returns& returns, size_t i,
                                          const std::unordered_map<uint64_t, size_t>& found) {
    const Cell cell = cell_of(returns, i);
    for (const int64_t du : {0, -1, 1})
      for (const int64_t dv : {0, -1, 1})
        if (const auto at = found.find(key_of(returns, i, {cell.azimuth + du, cell.elevation + dv}));
            at != found.end())
          return at->second;
    return {};
  }

  uint64_t records_ = 0, ranges_ = 0, one_sided_ = 0, reference_returns_ = 0;
  double range_sum_m_ = 0.0, intensity_sum_ = 0.0;
  Samples range_m_;
};

}  // namespace

std::unique_ptr<ErrorSum> make_lidar_error() { return std::make_unique<LidarError>(); }

}  // namespace greatx::sim
