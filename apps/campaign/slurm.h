// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the script of a campaign for Slurm: a job array whose tasks run a shard each, and a job that merges
// and verifies once all of them are done. docs/campaigns.md says what the script does when it is stopped.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "apps/campaign/plan.h"
#include "apps/campaign/store.h"
#include "apps/console/session.h"

namespace greatx::apps {

/// What the user says of the jobs.
struct SlurmOptions {
  std::string script;               ///< empty: job.sh in the campaign's folder
  uint32_t tasks = 0, at_once = 0;  ///< 0: as many as cells; 0: no limit
  uint32_t cpus = 2, jobs = 1;      ///< of each task
  uint32_t restarts = 20;           ///< of a task
  std::string time, merge_time;     ///< as Slurm writes times; empty: from what the plan measures
  std::string partition, account, memory, gpus, logs, program;
  std::vector<std::string> setup, sbatch;
  void add_to(CLI::App& command);
};

/// What a job takes, in s; it is part of the script.
struct SlurmTimes {
  int64_t task_s = 0, merge_s = 0;
};
/// Returns a Slurm time in s: M, M:S, H:M:S, D-H, D-H:M or D-H:M:S. Throws UserError, also below 2 minutes,
/// since Slurm looks at limits every half a minute. `option` is for its message.
int64_t parse_slurm_time(const std::string& text, const char* option);
/// Returns D-HH:MM:SS.
std::string slurm_time(int64_t seconds);

/// Returns the measured time of the shard that takes longest, in s on the device that measured it. All units
/// count, complete or not, so that the script does not depend on when it is written. `costs`: [cells].
double longest_shard_s(const OpenCampaign& open, const std::vector<CellCost>& costs, uint32_t tasks);
/// Returns what to ask Slurm for: twice the longest shard and 5 minutes; twice what `verify` takes to read
/// all data at 100 MB/s and 10 minutes. Both are rounded up to minutes. `slower` is the ratio of the time of
/// a tick in a task to that of the measure.
SlurmTimes measured_times(const OpenCampaign& open, const std::vector<CellCost>& costs, uint32_t tasks,
                          double slower);

/// Returns the number of tasks. Throws UserError if there are more than units, or more jobs than processors.
uint32_t task_count(const OpenCampaign& open, const SlurmOptions& options);

/// Returns a word that bash reads as `text`.
std::string shell_word(const std::string& text);

/// Returns the script. It depends on its arguments, the working folder and the path of this program alone.
/// Throws UserError if Slurm cannot hold a path.
std::string slurm_script(const OpenCampaign& open, const CampaignOptions& campaign, const RunOptions& run,
                         const SlurmOptions& options, const SlurmTimes& times);

}  // namespace greatx::apps
