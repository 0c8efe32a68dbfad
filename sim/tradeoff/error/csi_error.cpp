// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <set>

#include "sim/tradeoff/error/samples.h"

namespace greatx::sim {

namespace {

class CsiError : public ErrorSum {
 public:
  void add(const SensorSpec& reference_spec, const Record& reference, const SensorSpec& spec,
           const Record& record) override {
    const auto pair = [&](const char* name) {
      return ArrayPair{array_of(reference_spec, reference, name), array_of(spec, record, name)};
    };
    add_transfer(pair("cfr"));
    add_links(pair("path_gain"), pair("delay_spread"));
    add_paths({array_of(reference_spec, reference, "id"), array_of(spec, record, "id")});
  }

  std::vector<ErrorFigure> figures() const override {
    std::vector<ErrorFigure> figures;
    if (power_ > 0.0)
      figures.push_back(
          {"nmse", "dB", 10.0 * std::log10(error_ / power_), "error of H(f) relative to its power"});
    if (!gain_db_.empty()) {
      figures.push_back({"path_gain", "dB", gain_db_.quantile(0.5), "median error of the links' path gain"});
      figures.push_back(
          {"path_gain_p95", "dB", gain_db_.quantile(0.95), "95th percentile of the error of path gain"});
      figures.push_back({"path_gain_most", "dB", most_db_, "largest error of a link's path gain"});
    }
    if (!spread_ns_.empty())
      figures.push_back({"delay_spread", "ns", spread_ns_.quantile(0.5), "median error of the delay spread"});
    if (links_ > 0)
      figures.push_back(
          {"changed", "%", 100.0 * static_cast<double>(changed_) / static_cast<double>(links_),
           "links whose path gain is off by more than 0.1 dB, or that only one of the two has"});
    if (links_ > 0)
      figures.push_back({"links", "%", 100.0 * static_cast<double>(lost_) / static_cast<double>(links_),
                         "links that have a path in one of the two only"});
    if (either_ > 0)
      figures.push_back({"paths", "%",
                         100.0 * (1.0 - static_cast<double>(both_) / static_cast<double>(either_)),
                         "paths, by identity, that only one of the two has, of all"});
    return figures;
  }

 private:
  void add_transfer(const ArrayPair& cfr) {
    if (!cfr || cfr.reference->dtype != DType::complex64) return;
    const auto x = cfr.reference->as<std::complex<float>>(), y = cfr.got->as<std::complex<float>>();
    for (size_t i = 0; i < x.size(); ++i) {
      const std::complex<double> a(x[i]), b(y[i]);
      error_ += std::norm(b - a);
      power_ += std::norm(a);
    }
  }
  void add_links(const ArrayPair& gain, const ArrayPair& spread) {
    if (!gain || gain.reference->dtype != DType::f64) return;
    const auto x = gain.reference->as<double>(), y = gain.got->as<double>();
    for (size_t i = 0; i < x.size(); ++i) {
      const bool in_x = x[i] > 0.0, in_y = y[i] > 0.0;
      links_ += in_x || in_y;
      lost_ += in_x != in_y;
      changed_ += in_x != in_y;
      if (!in_x || !in_y) continue;
      const double error_db = std::abs(10.0 * std::log10(y[i] / x[i]));
      gain_db_.add(error_db);
      most_db_ = std::max(most_db_, error_db);
      changed_ += error_db > changed_db;
    }
    if (!spread || spread.reference->dtype != DType::f64) return;
    const auto s = spread.reference->as<double>(), t = spread.got->as<double>();
    for (size_t i = 0; i < s.size(); ++i)
      if (std::isfinite(s[i]) && std::isfinite(t[i])) spread_ns_.add(1e9 * std::abs(t[i] - s[i]));
  }
  void add_paths(const ArrayPair& id) {
    if (id.reference == nullptr || id.got == nullptr) return;
    if (id.reference->dtype != DType::u64 || id.got->dtype != DType::u64) return;
    const auto x = id.reference->as<uint64_t>(), y = id.got->as<uint64_t>();
    const std::set<uint64_t> of_x(x.begin(), x.end()), of_y(y.begin(), y.end());
    size_t both = 0;
    for (const uint64_t path : of_x) both += of_y.contains(path);
    both_ += both;
    either_ += of_x.size() + of_y.size() - both;
  }

  static constexpr double changed_db = 0.1;
  double error_ = 0.0, power_ = 0.0, most_db_ = 0.0;
  Samples gain_db_, spread_ns_;
  uint64_t links_ = 0, lost_ = 0, changed_ = 0, both_ = 0, either_ = 0;
};

}  // namespace

std::unique_ptr<ErrorSum> make_csi_error() { return std::make_unique<CsiError>(); }

}  // namespace greatx::sim
