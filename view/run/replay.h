// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Shows a recorded data set in the viewer.
#pragma once

#include <filesystem>
#include <memory>

#include "view/run/run.h"

namespace greatx::view {

/// Opens the data set on a thread of its own, shows its first tick and waits. Of an unfinished data set it
/// shows the packets that are complete when it is opened. A record that cannot be read is left out of its
/// tick: status().error names the file, the sensor and the tick. The first one of a sensor also pauses. Each
/// replay has a thread, so several run side by side.
std::unique_ptr<Run> replay_run(std::filesystem::path folder);

}  // namespace greatx::view
