// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/view_start.h"

#include <cerrno>
#include <fcntl.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace greatx::apps {

namespace {

constexpr const char* own_program = "/proc/self/exe";

/// Starts the program with its output in the pipe's end `out`.
pid_t start(const std::vector<std::string>& arguments, int out) {
  std::vector<std::string> words{own_program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  pid_t child = 0;
  const int failed = posix_spawn(&child, own_program, &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error("bench: the program cannot be started anew");
  return child;
}

}  // namespace

std::vector<double> times_of_lines(const std::vector<std::string>& arguments) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("bench: no pipe to the program");
  const Clock::time_point begin = Clock::now();
  pid_t child = 0;
  try {
    child = start(arguments, ends[1]);
  } catch (...) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw;
  }
  ::close(ends[1]);
  std::vector<double> times;
  char byte = 0;
  for (ssize_t count = 0; (count = ::read(ends[0], &byte, 1)) > 0 || (count < 0 && errno == EINTR);)
    if (count > 0 && byte == '\n') times.push_back(seconds_since(begin));
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error(fmt::format("bench: the viewer's process ended with status {}", status));
  return times;
}

}  // namespace greatx::apps
