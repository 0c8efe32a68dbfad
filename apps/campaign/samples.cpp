// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Looks at some records of a merged campaign: which classes its cameras and LiDARs see, and how much of the
// objects with boxes is hidden.
#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/campaign/stats.h"
#include "apps/console/progress.h"
#include "io/dataset/dataset_reader.h"
#include "sim/campaign/campaign.h"

namespace greatx::apps {
namespace {

/// Counts of classes, by split.
using ClassCounts = std::vector<std::map<std::string, double>>;

bool has_array(const SensorSpec& spec, const std::string& name) {
  return std::ranges::find(spec.arrays, name, &ArraySpec::name) != spec.arrays.end();
}

/// Calls visit(value) for each element of an array of whole numbers.
template <typename Visit>
void each_number(const Array& array, const Visit& visit) {
  switch (array.dtype) {
    case DType::u8:
      for (const uint8_t value : array.as<uint8_t>()) visit(value);
      break;
    case DType::u16:
      for (const uint16_t value : array.as<uint16_t>()) visit(value);
      break;
    case DType::u32:
      for (const uint32_t value : array.as<uint32_t>()) visit(value);
      break;
    default:
      GREATX_CHECK(false, "classes of type {}", numpy_name(array.dtype));
  }
}

/// Looks at the records of one data set.
class SampledSet {
 public:
  SampledSet(const std::filesystem::path& folder, std::map<std::string, ClassCounts>& counts,
             std::vector<std::vector<double>>& visibility)
      : reader_(folder), counts_(counts), visibility_(visibility) {
    const nlohmann::json run = nlohmann::json::parse(reader_.info().run_json);
    classes_ = run.at("semantic_classes").get<std::vector<std::string>>();
    for (const nlohmann::json& instance : run.at("instances"))
      class_of_instance_.push_back(instance.at("class").get<std::string>());
  }
  const io::DatasetReader& reader() const { return reader_; }

  void look(uint32_t sequence, const io::IndexRow& row, size_t split) {
    const SensorSpec& spec = reader_.sensors()[static_cast<size_t>(row.sensor)];
    if (spec.kind == "camera" && has_array(spec, "semantic"))
      count(reader_.load(sequence, row, "semantic"), classes_, 0, "camera", split);
    if (spec.kind == "camera" && has_array(spec, "box_visibility")) {
      const Array shares = reader_.load(sequence, row, "box_visibility");
      const auto values = shares.as<float>();
      visibility_[split].insert(visibility_[split].end(), values.begin(), values.end());
    }
    if (spec.kind == "lidar" && has_array(spec, "instance"))
      count(reader_.load(sequence, row, "instance"), class_of_instance_, 1, "lidar", split);
  }

 private:
  /// Counts the names of values; the first name has the value `first`, and values below it are none.
  void count(const Array& array, const std::vector<std::string>& names, size_t first, const std::string& kind,
             size_t split) {
    std::vector<uint64_t> by_value(first + names.size());
    each_number(array, [&](size_t value) {
      if (value < by_value.size()) ++by_value[value];
    });
    ClassCounts& counts = counts_.try_emplace(kind, ClassCounts(split_count)).first->second;
    for (size_t value = first; value < by_value.size(); ++value)
      if (by_value[value] > 0) counts[split][names[value - first]] += static_cast<double>(by_value[value]);
  }

  io::DatasetReader reader_;
  std::map<std::string, ClassCounts>& counts_;
  std::vector<std::vector<double>>& visibility_;
  std::vector<std::string> classes_, class_of_instance_;
};

ClassBalance balance_of(const std::string& kind, const ClassCounts& counts) {
  std::map<std::string, double> all;
  ClassBalance balance{kind, {}, std::vector<std::vector<double>>(split_count)};
  for (const auto& of_split : counts)
    for (const auto& [name, count] : of_split) all[name] += count;
  for (const auto& [name, count] : all) balance.classes.push_back(name);
  std::ranges::stable_sort(balance.classes, [&](const auto& a, const auto& b) { return all[a] > all[b]; });
  for (size_t s = 0; s < split_count; ++s) {
    double sum = 0.0;
    for (const auto& [name, count] : counts[s]) sum += count;
    if (sum == 0.0) continue;
    for (const std::string& name : balance.classes) {
      const auto found = counts[s].find(name);
      balance.shares[s].push_back(found == counts[s].end() ? 0.0 : found->second / sum);
    }
  }
  return balance;
}

}  // namespace

void add_samples(const OpenCampaign& open, uint64_t most_sampled, bool quiet, CampaignStats& stats) {
  std::map<std::string, uint64_t> records;
  for (const auto& [split, kinds] : stats.json["records"].items())
    for (const auto& [kind, count] : kinds.items())
      records[kind] += static_cast<uint64_t>(count.get<double>());
  std::map<std::string, ClassCounts> counts;
  std::vector<std::vector<double>> visibility(split_count);
  std::map<std::string, uint64_t> seen, sampled;
  Progress progress("classes", static_cast<int64_t>(open.cells.size()), quiet, "cells");
  for (size_t cell = 0; cell < open.cells.size() && most_sampled > 0; ++cell) {
    if (!open.merged(cell)) continue;
    SampledSet set(open.data(cell), counts, visibility);
    for (uint32_t s = 0; s < set.reader().sequences(); ++s) {
      const auto split = static_cast<size_t>(sim::split_of(open.campaign, open.cells[cell].values, s));
      for (const io::IndexRow& row : set.reader().records(s)) {
        const std::string& kind = set.reader().sensors()[static_cast<size_t>(row.sensor)].kind;
        if (kind != "camera" && kind != "lidar") continue;
        // Record i of n is one of m evenly spread ones if i m / n passes a whole number.
        const uint64_t i = seen[kind]++, n = std::max<uint64_t>(1, records[kind]),
                       m = std::min(n, most_sampled);
        if (i * m / n == (i + 1) * m / n) continue;
        set.look(s, row, split);
        ++sampled[kind];
      }
    }
    progress.update(static_cast<int64_t>(cell) + 1);
  }
  for (const auto& [kind, count] : sampled) stats.json["sampled"][kind] = count;
  for (const auto& [kind, count] : counts) {
    stats.balances.push_back(balance_of(kind, count));
    const ClassBalance& balance = stats.balances.back();
    for (size_t s = 0; s < split_count; ++s)
      for (size_t c = 0; c < balance.shares[s].size(); ++c)
        stats.json["classes"][kind][sim::split_names[s]][balance.classes[c]] = balance.shares[s][c];
  }
  Quantity visible{"visibility", "visible share of an object with a box", std::move(visibility)};
  bool any = false;
  for (size_t s = 0; s < split_count; ++s) {
    std::ranges::sort(visible.values[s]);
    if (visible.values[s].empty()) continue;
    stats.json["quantities"]["visibility"][sim::split_names[s]] = figures_of(visible.values[s]);
    any = true;
  }
  if (any) stats.quantities.push_back(std::move(visible));
}

}  // namespace greatx::apps
