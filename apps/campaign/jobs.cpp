// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/campaign/jobs.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
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

/// The signal by which this process interrupts its jobs. Theirs is not SIGTERM or SIGINT, which may have
/// reached them already (Ctrl-C, scancel): a second one would end them at once.
constexpr int stop_signal = SIGUSR1;

/// As long as this lives, the signal interrupts this process and the jobs that it starts.
class StopSignal {
 public:
  StopSignal() {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupt(); };
    sigaction(stop_signal, &action, &before_);
  }
  ~StopSignal() { sigaction(stop_signal, &before_, nullptr); }
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

 private:
  struct sigaction before_ {};
};

/// Returns the exit code for the status of a job that has ended.
int code_of_status(int status) {
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  const int signal = WTERMSIG(status);
  return signal == SIGINT || signal == SIGTERM ? exit_interrupted : exit_internal;
}

pid_t start(const std::function<void(uint32_t)>& job, uint32_t index) {
  std::cout.flush();
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot start a process for a job");
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, stop_signal);  // if this process is killed
    const int code = code_of(job, index);
    std::fflush(nullptr);
    ::_exit(code);
  }
  return child;
}

}  // namespace

void in_processes(uint32_t count, const std::function<void(uint32_t)>& job,
                  const std::function<void()>& meanwhile) {
  const StopSignal signal;
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
      worst = std::max(worst, code_of_status(status));
      children.erase(children.begin() + static_cast<ptrdiff_t>(i));
    }
    if (interrupted() && !told) {
      for (const pid_t child : children) ::kill(child, stop_signal);
      told = true;
    }
    meanwhile();
    const timespec half_a_second{0, 500'000'000};
    if (!children.empty()) ::nanosleep(&half_a_second, nullptr);
  }
  if (worst == exit_interrupted) throw Interrupted("the jobs were interrupted; the same command goes on");
  if (worst != 0) throw Failed{worst};
}

}  // namespace greatx::apps
