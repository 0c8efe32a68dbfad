// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/campaign/run.h"

#include <chrono>
#include <memory>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "apps/console/progress.h"
#include "apps/console/run_record.h"
#include "apps/console/watch.h"
#include "apps/files/consistency_files.h"
#include "core/watch.h"
#include "io/dataset/dataset_writer.h"
#include "io/files/file.h"
#include "sim/dataset/dataset_info.h"
#include "sim/run/simulator.h"

namespace greatx::apps {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Runs units one after another. It keeps the simulator of the last cell.
class UnitRunner {
 public:
  UnitRunner(const OpenCampaign& open, gpu::Device& device, uint32_t threads)
      : open_(open), device_(device), threads_(threads) {}

  /// Returns false if it was interrupted. `tick_done` is called after every tick.
  template <typename TickDone>
  bool run(const CampaignUnit& unit, const TickDone& tick_done) {
    if (!simulator_ || unit.cell != cell_) enter(unit.cell);
    const sim::Scenario scenario = sim::with_sequences(experiment_->scenario, unit.sequence + 1);
    io::DatasetWriter writer(open_.part(unit), sim::with_sequences(*info_, scenario),
                             {.threads = threads_, .resume = true, .first_sequence = unit.sequence});
    const io::DatasetWriter::Position position = writer.resume_position();
    if (position.sequence > unit.sequence) return true;  // another process has finished it meanwhile
    writer.begin_sequence(unit.sequence);
    simulator_->start(unit.sequence, position.next_tick);
    while (simulator_->step(writer)) {
      tick_done();
      if (!interrupted()) continue;
      simulator_->drain(writer);
      writer.flush();
      return false;
    }
    keep_consistency(unit);  // before the end of the sequence, which makes the unit complete
    writer.end_sequence();
    return true;
  }
  /// Prints what was lost. Called once more after the last unit.
  void leave() {
    if (!simulator_) return;
    device_.wait_idle();
    for (const std::string& warning : simulator_->statistics().warnings) {
      warnings_.push_back(fmt::format("{}: {}", open_.cells[cell_].name, warning));
      spdlog::warn("{}", warnings_.back());
    }
    simulator_.reset();
  }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void enter(size_t cell) {
    leave();
    const sim::Scenario& scenario = open_.cells[cell].scenario;
    auto next = std::make_unique<sim::Experiment>(experiment_ ? sim::make_experiment(scenario, *experiment_)
                                                              : sim::make_experiment(scenario));
    experiment_ = std::move(next);
    simulator_.emplace(device_, *experiment_);
    info_ = sim::dataset_info(*experiment_, device_, simulator_->sensors());
    cell_ = cell;
    rows_ = 0;
  }

  /// Keeps the rows that this unit has added beside its part.
  void keep_consistency(const CampaignUnit& unit) {
    const std::vector<sim::ConsistencyRow>& all = simulator_->consistency_rows();
    const std::vector<sim::ConsistencyRow> own(all.begin() + static_cast<ptrdiff_t>(rows_), all.end());
    rows_ = all.size();
    if (own.empty()) return;
    io::create_folders(open_.journals(unit.cell));
    io::write_file_atomically(consistency_of(open_.journals(unit.cell), unit.sequence), consistency_csv(own));
  }

  const OpenCampaign& open_;
  gpu::Device& device_;
  uint32_t threads_;
  std::unique_ptr<sim::Experiment> experiment_;
  std::optional<sim::Simulator> simulator_;
  std::optional<io::DatasetInfo> info_;
  size_t cell_ = 0, rows_ = 0;
  std::vector<std::string> warnings_;
};

/// Runs the units of a queue until nothing is left, or until the user interrupts it.
void run_queue(UnitRunner& runner, const OpenCampaign& open, const WorkQueue& queue, bool quiet,
               CampaignRun& run) {
  int64_t ticks = 0, ticks_done = 0;
  for (const CampaignUnit& unit : queue.units()) ticks += open.cells[unit.cell].scenario.ticks;
  Progress progress(open.campaign.name, ticks, quiet);
  const TerminalWatch watch(quiet);
  try {
    for (auto range = queue.take(); run.complete && !range.empty(); range = queue.take())
      for (const CampaignUnit& unit : range) {
        const io::PartState state = open.state(unit);
        if (state.complete) {
          ++run.skipped;
          ticks_done += open.cells[unit.cell].scenario.ticks;
          continue;
        }
        ticks_done += state.next_tick;
        run.complete = runner.run(unit, [&] { progress.update(++ticks_done); });
        if (!run.complete) break;
        ++run.done;
      }
  } catch (const Interrupted&) {
    run.complete = false;
  }
  runner.leave();
  run.warnings = runner.warnings();
}

}  // namespace

CampaignRun run_units(const OpenCampaign& open, const WorkQueue& queue, gpu::Device& device, uint32_t threads,
                      bool quiet) {
  const Clock::time_point begin = Clock::now();
  CampaignRun run;
  RunRecord record;
  record.set_device(device);
  record.set("sequences", queue.units().size());
  record.write_into(open.folder / "runs");
  const auto end_record = [&] {
    record.set("done", run.done);
    record.end(run.complete, run.warnings);
    record.write_into(open.folder / "runs");
  };
  UnitRunner runner(open, device, threads);
  try {
    run_queue(runner, open, queue, quiet, run);
  } catch (const std::exception& error) {
    run.complete = false;
    record.set("error", error.what());
    try {
      end_record();
    } catch (const std::exception&) {
      // The disk may be full. The first error is the one to tell.
    }
    throw;
  }
  end_record();
  run.seconds = seconds_since(begin);
  return run;
}

}  // namespace greatx::apps
