// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <span>

#include "sim/tradeoff/error/samples.h"

namespace greatx::sim {

namespace {

constexpr int64_t grid_bins = 15;

/// The events of one record.
struct Events {
  std::span<const int64_t> t;
  std::span<const uint16_t> x, y;
  std::span<const uint8_t> p;
  size_t count() const { return t.size(); }
};

bool events_of(const SensorSpec& spec, const Record& record, Events& events) {
  const Array *const t = array_of(spec, record, "t"), *const x = array_of(spec, record, "x"),
                     *const y = array_of(spec, record, "y"), *const p = array_of(spec, record, "p");
  if (t == nullptr || x == nullptr || y == nullptr || p == nullptr) return false;
  if (t->dtype != DType::i64 || x->dtype != DType::u16 || y->dtype != DType::u16 || p->dtype != DType::u8)
    return false;
  events = {t->as<int64_t>(), x->as<uint16_t>(), y->as<uint16_t>(), p->as<uint8_t>()};
  return true;
}

/// The part of the sensor that has events, and the time between the first one and the last one.
struct Extent {
  size_t width = 0, height = 0;
  int64_t first = std::numeric_limits<int64_t>::max(), last = std::numeric_limits<int64_t>::min();
  void add(const Events& events) {
    for (size_t i = 0; i < events.count(); ++i) {
      width = std::max<size_t>(width, events.x[i] + size_t{1});
      height = std::max<size_t>(height, events.y[i] + size_t{1});
      first = std::min(first, events.t[i]);
      last = std::max(last, events.t[i]);
    }
  }
  size_t pixels() const { return width * height; }
};

/// Adds events to a voxel grid [grid_bins, pixels]: each one to the two bins beside its time, with its sign.
void add_to_grid(const Events& events, const Extent& extent, std::vector<float>& grid) {
  const double scale = extent.last > extent.first ? static_cast<double>(grid_bins - 1) /
                                                        static_cast<double>(extent.last - extent.first)
                                                  : 0.0;
  for (size_t i = 0; i < events.count(); ++i) {
    // Rounding may carry the last event beyond the last bin.
    const double at =
        std::min(static_cast<double>(events.t[i] - extent.first) * scale, double(grid_bins - 1));
    const auto low = static_cast<size_t>(at);
    const auto share = static_cast<float>(at - static_cast<double>(low));
    const float sign = events.p[i] != 0 ? 1.0f : -1.0f;
    const size_t pixel = events.y[i] * extent.width + events.x[i];
    grid[low * extent.pixels() + pixel] += (1.0f - share) * sign;
    if (share > 0.0f) grid[(low + 1) * extent.pixels() + pixel] += share * sign;
  }
}

/// The times of the events of each pixel and polarity, in the order of the record.
struct Sorted {
  std::vector<uint32_t> begins;  ///< [2 pixels + 1]
  std::vector<int64_t> times;
  Sorted(const Events& events, const Extent& extent)
      : begins(2 * extent.pixels() + 1, 0), times(events.count()) {
    const auto key = [&](size_t i) {
      return 2 * (events.y[i] * extent.width + events.x[i]) + (events.p[i] != 0 ? 1 : 0);
    };
    for (size_t i = 0; i < events.count(); ++i) ++begins[key(i) + 1];
    for (size_t k = 1; k < begins.size(); ++k) begins[k] += begins[k - 1];
    std::vector<uint32_t> next(begins.begin(), begins.end() - 1);
    for (size_t i = 0; i < events.count(); ++i) times[next[key(i)]++] = events.t[i];
  }
};

class EventError : public ErrorSum {
 public:
  void add(const SensorSpec& reference_spec, const Record& reference, const SensorSpec& spec,
           const Record& record) override {
    Events a, b;
    if (!events_of(reference_spec, reference, a) || !events_of(spec, record, b)) return;
    ++records_;
    reference_count_ += a.count();
    count_ += b.count();
    Extent extent;
    extent.add(a);
    extent.add(b);
    if (extent.pixels() == 0) return;
    compare_grids(a, b, extent);
    compare_times(a, b, extent);
  }

  std::vector<ErrorFigure> figures() const override {
    std::vector<ErrorFigure> figures;
    if (records_ == 0) return figures;
    const auto share = [](double part, double whole) {
      return whole > 0.0 ? part / whole : part > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
    };
    figures.push_back({"voxels", "1", share(grid_error_, grid_power_),
                       "relative L1 error of a voxel grid of 15 bins; 1 is that of an empty grid"});
    figures.push_back(
        {"count", "%",
         100.0 * share(std::abs(double(count_) - double(reference_count_)), double(reference_count_)),
         "error of the number of events"});
    if (!time_us_.empty())
      figures.push_back({"time", "us", time_us_.quantile(0.5), "median error of an event's time"});
    figures.push_back({"unmatched", "%", 100.0 * share(double(unmatched_), double(count_ + reference_count_)),
                       "events without a partner in the other record, of all"});
    return figures;
  }

 private:
  void compare_grids(const Events& a, const Events& b, const Extent& extent) {
    const size_t voxels = static_cast<size_t>(grid_bins) * extent.pixels();
    reference_grid_.assign(voxels, 0.0f);
    grid_.assign(voxels, 0.0f);
    add_to_grid(a, extent, reference_grid_);
    add_to_grid(b, extent, grid_);
    for (size_t i = 0; i < voxels; ++i) {
      grid_error_ += static_cast<double>(std::abs(grid_[i] - reference_grid_[i]));
      grid_power_ += static_cast<double>(std::abs(reference_grid_[i]));
    }
  }
  /// The k-th event of a pixel and polarity is the partner of the k-th one of the reference.
  void compare_times(const Events& a, const Events& b, const Extent& extent) {
    const Sorted of_a(a, extent), of_b(b, extent);
    for (size_t k = 0; k + 1 < of_a.begins.size(); ++k) {
      const uint32_t in_a = of_a.begins[k + 1] - of_a.begins[k], in_b = of_b.begins[k + 1] - of_b.begins[k];
      const uint32_t both = std::min(in_a, in_b);
      unmatched_ += std::max(in_a, in_b) - both;
      for (uint32_t i = 0; i < both; ++i)
        time_us_.add(1e-3 * static_cast<double>(
                                std::abs(of_b.times[of_b.begins[k] + i] - of_a.times[of_a.begins[k] + i])));
    }
  }

  uint64_t records_ = 0, reference_count_ = 0, count_ = 0, unmatched_ = 0;
  double grid_error_ = 0.0, grid_power_ = 0.0;
  Samples time_us_;
  std::vector<float> reference_grid_, grid_;
};

}  // namespace

std::unique_ptr<ErrorSum> make_event_error() { return std::make_unique<EventError>(); }

}  // namespace greatx::sim
