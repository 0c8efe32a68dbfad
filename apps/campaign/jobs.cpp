// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/campaign/jobs.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "apps/console/exit_code.h"
#include "apps/console/progress.h"
#include "core/error.h"

namespace greatx::apps {
namespace {

/// Returns the exit code of a job.
int code_of(const std::function<void(uint32_t)>& job, uint32_t index) {
  try {
    job(index);
    return 0;
  } catch (const Interrupted&) {
    return exit_interrupted;  // the parent says so
  } catch (const UserError& error) {
    spdlog::error("{}", error.what());
    return exit_user;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return exit_internal;
  }
}

pid_t start(const std::function<void(uint32_t)>& job, uint32_t index) {
  std::cout.flush();
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot start a process for a job");
  if (child == 0) {
    const int code = code_of(job, index);
    std::fflush(nullptr);
    ::_exit(code);
  }
  return child;
}

}  // namespace

void in_processes(uint32_t count, const std::function<void(uint32_t)>& job,
                  const std::function<void()>& meanwhile) {
  std::vector<pid_t> children;
  for (uint32_t i = 0; i < count; ++i) children.push_back(start(job, i));
  int worst = 0;
  bool told = false;
  while (!children.empty()) {
    for (size_t i = 0; i < children.size();) {
      int status = 0;
      if (::waitpid(children[i], &status, WNOHANG) == 0) {
        ++i;
        continue;
      }
      worst = std::max(worst, WIFEXITED(status) ? WEXITSTATUS(status) : int{exit_internal});
      children.erase(children.begin() + static_cast<ptrdiff_t>(i));
    }
    // The signal may have been sent to this process alone. A second one would end a job at once.
    if (interrupted() && !std::exchange(told, true))
      for (const pid_t child : children) ::kill(child, SIGTERM);
    meanwhile();
    const timespec half_a_second{0, 500'000'000};
    if (!children.empty()) ::nanosleep(&half_a_second, nullptr);
  }
  if (worst == exit_interrupted) throw Interrupted("the jobs were interrupted; the same command goes on");
  if (worst != 0) throw Failed{worst};
}

}  // namespace greatx::apps
