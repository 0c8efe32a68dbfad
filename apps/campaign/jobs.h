// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

namespace greatx::apps {

/// Runs job(0) to job(count - 1), each in a process of its own, and calls `meanwhile` twice a second until
/// all have ended. No device may exist yet. A job that throws prints its message. If this process is
/// interrupted or killed, its jobs are interrupted. Throws Interrupted if one was interrupted, and Failed
/// with the exit code of one that has failed.
void in_processes(uint32_t count, const std::function<void(uint32_t)>& job,
                  const std::function<void()>& meanwhile);

}  // namespace greatx::apps
