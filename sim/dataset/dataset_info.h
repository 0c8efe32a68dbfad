// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes a run as a data set states it. A room of its own, because sim/run knows nothing of files.
#pragma once

#include <vector>

#include "core/record.h"
#include "gpu/device.h"
#include "io/dataset/dataset_format.h"
#include "sim/experiment/experiment.h"

namespace greatx::sim {

/// Returns what a data set says of its run: everything that decides its bytes, and the tables that ids refer
/// to. `sensors` are those of the Simulator.
io::DatasetInfo dataset_info(const Experiment& experiment, const gpu::Device& device,
                             const std::vector<SensorSpec>& sensors);

/// Returns what the data set says of the same run with another number of sequences, as `scenario` has it.
io::DatasetInfo with_sequences(io::DatasetInfo info, const Scenario& scenario);

}  // namespace greatx::sim
