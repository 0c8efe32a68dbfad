// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "sim/tradeoff/error/samples.h"

namespace greatx::sim {

namespace {

/// A map of path gains with the place of its cells.
struct GainMap {
  const Array* gain = nullptr;  ///< f64 [tx, rows, columns]; 0: no path, NaN: the cell has no value
  double west_m = 0.0, south_m = 0.0, cell_m = 0.0;

  int64_t transmitters() const { return gain->shape[0]; }
  int64_t rows() const { return gain->shape[1]; }
  int64_t columns() const { return gain->shape[2]; }
  double at(int64_t transmitter, int64_t row, int64_t column) const {
    const size_t cell = static_cast<size_t>((transmitter * rows() + row) * columns() + column);
    return gain->as<double>()[cell];
  }
  /// Returns the gain of the cell that contains a place; 0 outside of the map.
  double at_place(int64_t transmitter, double x_m, double y_m) const {
    const auto column = static_cast<int64_t>(std::floor((x_m - west_m) / cell_m)),
               row = static_cast<int64_t>(std::floor((y_m - south_m) / cell_m));
    if (row < 0 || row >= rows() || column < 0 || column >= columns()) return 0.0;
    return at(transmitter, row, column);
  }
};

/// Returns false if the record is no map.
bool gain_map_of(const SensorSpec& spec, const Record& record, GainMap& map) {
  map.gain = array_of(spec, record, "path_gain");
  const nlohmann::json metadata = nlohmann::json::parse(spec.metadata_json, nullptr, false);
  if (map.gain == nullptr || map.gain->dtype != DType::f64 || map.gain->shape.size() != 3) return false;
  if (!metadata.is_object() || !metadata.contains("min_m")) return false;
  map.west_m = metadata["min_m"][0];
  map.south_m = metadata["min_m"][1];
  map.cell_m = metadata.value("cell_m", 0.0);
  return map.cell_m > 0.0;
}

class MapError : public ErrorSum {
 public:
  void add(const SensorSpec& reference_spec, const Record& reference, const SensorSpec& spec,
           const Record& record) override {
    GainMap fine, coarse;
    if (!gain_map_of(reference_spec, reference, fine) || !gain_map_of(spec, record, coarse)) return;
    if (fine.transmitters() != coarse.transmitters()) return;
    for (int64_t t = 0; t < fine.transmitters(); ++t)
      for (int64_t row = 0; row < fine.rows(); ++row)
        for (int64_t column = 0; column < fine.columns(); ++column) {
          const double x = fine.west_m + (static_cast<double>(column) + 0.5) * fine.cell_m,
                       y = fine.south_m + (static_cast<double>(row) + 0.5) * fine.cell_m;
          add_place(fine.at(t, row, column), coarse.at_place(t, x, y));
        }
  }

  std::vector<ErrorFigure> figures() const override {
    std::vector<ErrorFigure> figures;
    if (!gain_db_.empty()) {
      figures.push_back({"path_gain", "dB", gain_db_.quantile(0.5),
                         "median error of path gain at the centres of the reference's cells"});
      figures.push_back({"path_gain_p95", "dB", gain_db_.quantile(0.95),
                         "95th percentile of the error of path gain at these centres"});
    }
    if (places_ > 0)
      figures.push_back({"coverage", "%", 100.0 * static_cast<double>(differ_) / static_cast<double>(places_),
                         "share of the area with a path in one of the two maps only"});
    return figures;
  }

 private:
  void add_place(double fine, double coarse) {
    const bool in_fine = fine > 0.0, in_coarse = coarse > 0.0;  // NaN is not
    ++places_;
    differ_ += in_fine != in_coarse;
    if (in_fine && in_coarse) gain_db_.add(std::abs(10.0 * std::log10(coarse / fine)));
  }

  Samples gain_db_;
  uint64_t places_ = 0, differ_ = 0;
};

}  // namespace

std::unique_ptr<ErrorSum> make_map_error() { return std::make_unique<MapError>(); }

}  // namespace greatx::sim
