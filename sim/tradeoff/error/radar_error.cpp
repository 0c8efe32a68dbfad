// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <span>

#include <nlohmann/json.hpp>

#include "sim/tradeoff/error/samples.h"

namespace greatx::sim {

namespace {

/// Detections are partners if their ranges and velocities differ by at most so many bins.
constexpr double partner_bins = 1.5;

struct Detections {
  std::span<const float> range, velocity, power;
};

bool detections_of(const SensorSpec& spec, const Record& record, Detections& detections) {
  const Array *const range = array_of(spec, record, "range"),
                     *const velocity = array_of(spec, record, "velocity"),
                     *const power = array_of(spec, record, "power");
  for (const Array* const array : {range, velocity, power})
    if (array == nullptr || array->dtype != DType::f32) return false;
  detections = {range->as<float>(), velocity->as<float>(), power->as<float>()};
  return detections.range.size() == detections.velocity.size() &&
         detections.range.size() == detections.power.size();
}

struct Bins {
  double range_m = 0.0, velocity_m_s = 0.0;
};
Bins bins_of(const SensorSpec& spec) {
  const nlohmann::json metadata = nlohmann::json::parse(spec.metadata_json, nullptr, false);
  if (!metadata.is_object()) return {};
  return {metadata.value("range_bin_m", 0.0), metadata.value("velocity_bin_m_s", 0.0)};
}

class RadarError : public ErrorSum {
 public:
  void add(const SensorSpec& reference_spec, const Record& reference, const SensorSpec& spec,
           const Record& record) override {
    add_map({array_of(reference_spec, reference, "range_doppler"), array_of(spec, record, "range_doppler")});
    Detections a, b;
    if (detections_of(reference_spec, reference, a) && detections_of(spec, record, b))
      add_detections(a, b, bins_of(reference_spec));
  }

  std::vector<ErrorFigure> figures() const override {
    std::vector<ErrorFigure> figures;
    if (map_power_ > 0.0)
      figures.push_back({"map", "dB", 10.0 * std::log10(map_error_ / map_power_),
                         "error of the range-Doppler map's powers relative to their sum"});
    if (reference_detections_ > 0) {
      const auto all = static_cast<double>(reference_detections_);
      figures.push_back({"missed", "%", 100.0 * static_cast<double>(missed_) / all,
                         "detections of the reference without a partner"});
      figures.push_back({"false", "%", 100.0 * static_cast<double>(false_) / all,
                         "detections without a partner, of the reference's number"});
    }
    if (!power_db_.empty())
      figures.push_back({"power", "dB", power_db_.quantile(0.5), "median error of a detection's power"});
    return figures;
  }

 private:
  void add_map(const ArrayPair& map) {
    if (!map || map.reference->dtype != DType::f32) return;
    const auto a = map.reference->as<float>(), b = map.got->as<float>();
    for (size_t i = 0; i < a.size(); ++i) {
      map_error_ += std::abs(static_cast<double>(b[i]) - static_cast<double>(a[i]));
      map_power_ += static_cast<double>(a[i]);
    }
  }
  /// Each detection of the reference takes the nearest one that is free, the strongest ones first.
  void add_detections(const Detections& a, const Detections& b, const Bins& bins) {
    std::vector<size_t> order(a.range.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, [&](size_t i, size_t j) { return a.power[i] > a.power[j]; });
    std::vector<bool> taken(b.range.size(), false);
    size_t partners = 0;
    for (const size_t i : order) {
      size_t best = b.range.size();
      double least = std::numeric_limits<double>::infinity();
      for (size_t j = 0; j < b.range.size(); ++j) {
        if (taken[j]) continue;
        const double dr = std::abs(double(b.range[j]) - double(a.range[i])) / std::max(bins.range_m, 1e-9),
                     dv = std::abs(double(b.velocity[j]) - double(a.velocity[i])) /
                          std::max(bins.velocity_m_s, 1e-9);
        if (dr > partner_bins || dv > partner_bins || dr + dv >= least) continue;
        least = dr + dv;
        best = j;
      }
      if (best == b.range.size()) continue;
      taken[best] = true;
      ++partners;
      power_db_.add(std::abs(double(b.power[best]) - double(a.power[i])));
    }
    reference_detections_ += a.range.size();
    missed_ += a.range.size() - partners;
    false_ += b.range.size() - partners;
  }

  double map_error_ = 0.0, map_power_ = 0.0;
  uint64_t reference_detections_ = 0, missed_ = 0, false_ = 0;
  Samples power_db_;
};

}  // namespace

std::unique_ptr<ErrorSum> make_radar_error() { return std::make_unique<RadarError>(); }

}  // namespace greatx::sim
