// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/campaign/plan.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "io/dataset/dataset_writer.h"
#include "io/files/file.h"
#include "sim/dataset/dataset_info.h"
#include "sim/run/simulator.h"

namespace greatx::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point begin, Clock::time_point end) {
  return std::chrono::duration<double>(end - begin).count();
}

/// A folder that goes away with this object.
class MeasuredFolder {
 public:
  MeasuredFolder() {
    std::string name = (fs::temp_directory_path() / "greatx_plan_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw_user_error("{}: cannot make a folder there", name);
    path_ = name;
  }
  ~MeasuredFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  MeasuredFolder(const MeasuredFolder&) = delete;
  MeasuredFolder& operator=(const MeasuredFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

constexpr double hour_s = 3600.0, gigabyte = 1e9;

struct Sum {
  uint64_t units = 0, done = 0;
  int64_t ticks = 0, left = 0;
  double seconds = 0.0, bytes = 0.0;
};

}  // namespace

CellCost measure_cell(const sim::Scenario& scenario, gpu::Device& device, int64_t ticks) {
  const Clock::time_point begin = Clock::now();
  const sim::Experiment experiment = sim::make_experiment(scenario);
  sim::Simulator simulator(device, experiment);
  const MeasuredFolder folder;
  CellCost cost;
  std::vector<double> times;
  {
    io::DatasetWriter writer(folder.path() / "data",
                             sim::dataset_info(experiment, device, simulator.sensors()), {});
    writer.begin_sequence(0);
    simulator.start(0);
    // The first step submits a tick; the packet of a tick comes with the next one.
    simulator.step(writer);
    cost.start_s = seconds_between(begin, Clock::now());
    Clock::time_point last = Clock::now();
    bool more = true;
    for (int64_t i = 0; i < ticks && more; ++i) {
      more = simulator.step(writer);
      writer.flush();
      const Clock::time_point now = Clock::now();
      times.push_back(seconds_between(last, now));
      last = now;
    }
    simulator.drain(writer);
    writer.flush();
    if (writer.stats().packets > 0)
      cost.tick_bytes = static_cast<double>(io::folder_size(folder.path()).bytes) /
                        static_cast<double>(writer.stats().packets);
  }
  device.wait_idle();
  std::ranges::sort(times);
  if (!times.empty()) cost.tick_s = times[times.size() / 2];
  return cost;
}

CampaignPlan plan_of(const OpenCampaign& open, const std::vector<CellCost>& costs, uint32_t cores,
                     const std::vector<uint32_t>& other_cores) {
  CampaignPlan plan;
  const bool measured = !costs.empty();
  plan.json = {{"campaign", open.campaign.name}, {"cells", nlohmann::json::array()}, {"measured", measured}};
  size_t widest = 4;
  for (const sim::CampaignCell& cell : open.cells) widest = std::max(widest, cell.name.size());
  plan.text = fmt::format("{:<{}}  sequences   done   ticks each{}\n", "cell", widest,
                          measured ? "   start s   s a tick   MB a tick    hours       GB" : "");
  Sum all;
  for (size_t c = 0; c < open.cells.size(); ++c) {
    const sim::CampaignCell& cell = open.cells[c];
    const int64_t ticks = cell.scenario.ticks;
    uint64_t done = 0;
    for (uint32_t s = 0; s < open.sequences(c); ++s) done += open.state({c, s}).complete;
    const auto left = static_cast<int64_t>(open.sequences(c) - done) * ticks;
    nlohmann::json row{
        {"cell", cell.name}, {"sequences", open.sequences(c)}, {"done", done}, {"ticks", ticks}};
    plan.text +=
        fmt::format("{:<{}}  {:>9}  {:>5}   {:>10}", cell.name, widest, open.sequences(c), done, ticks);
    all.units += open.sequences(c), all.done += done;
    all.ticks += open.sequences(c) * ticks, all.left += left;
    if (measured) {
      const CellCost& cost = costs[c];
      const double seconds = static_cast<double>(left) * cost.tick_s + (left > 0 ? cost.start_s : 0.0);
      const double bytes = static_cast<double>(open.sequences(c) * ticks) * cost.tick_bytes;
      all.seconds += seconds, all.bytes += bytes;
      row["start_s"] = cost.start_s, row["tick_s"] = cost.tick_s, row["tick_bytes"] = cost.tick_bytes;
      row["hours"] = seconds / hour_s, row["gigabytes"] = bytes / gigabyte;
      plan.text += fmt::format("  {:>8.2f}  {:>9.4f}  {:>10.3f}  {:>7.3f}  {:>7.3f}", cost.start_s,
                               cost.tick_s, 1e-6 * cost.tick_bytes, seconds / hour_s, bytes / gigabyte);
    }
    plan.text += '\n';
    plan.json["cells"].push_back(std::move(row));
  }
  plan.json["sequences"] = all.units, plan.json["done"] = all.done;
  plan.json["ticks"] = all.ticks, plan.json["ticks_left"] = all.left;
  plan.text += fmt::format("{} cells, {} sequences, {} ticks; {} sequences and {} ticks are left\n",
                           open.cells.size(), all.units, all.ticks, all.units - all.done, all.left);
  if (!measured) return plan;
  plan.json["hours"] = all.seconds / hour_s, plan.json["gigabytes"] = all.bytes / gigabyte;
  plan.json["cores"] = cores;
  plan.text += fmt::format("{:.3g} GB; {:.3g} hours on the {} cores of this machine", all.bytes / gigabyte,
                           all.seconds / hour_s, cores);
  for (const uint32_t other : other_cores) {
    const double hours = all.seconds / hour_s * cores / other;
    plan.json["hours_on"][std::to_string(other)] = hours;
    plan.text += fmt::format(", {:.3g} on {}", hours, other);
  }
  plan.text += " in shards\n";
  return plan;
}

}  // namespace greatx::apps
