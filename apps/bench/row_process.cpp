// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/row_process.h"

#include <cerrno>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include "apps/bench/said_once.h"
#include "core/error.h"
#include "core/text.h"

namespace greatx::apps {

namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Returns the answer of the child process as JSON text: {"row": ...} or the error, and the messages that it
/// has printed.
std::string answer_of(const std::function<nlohmann::json()>& row) {
  nlohmann::json answer;
  try {
    answer["row"] = row();
  } catch (const UserError& error) {
    answer["user_error"] = error.what();
  } catch (const std::exception& error) {
    answer["error"] = error.what();
  }
  answer["said"] = SaidOnce::said();
  return answer.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void write_all(int file, const std::string& text) {
  for (size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(file, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;
    done += static_cast<size_t>(count);
  }
}

std::string read_all(int file) {
  std::string text;
  char buffer[4096];
  for (;;) {
    const ssize_t count = ::read(file, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer, static_cast<size_t>(count));
  }
}

}  // namespace

nlohmann::json in_own_process(const std::function<nlohmann::json()>& row) {
  int pipe_ends[2];
  if (::pipe(pipe_ends) != 0) throw std::runtime_error("bench: no pipe to a row's process");
  std::cout.flush();
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("bench: cannot start a row's process");
  if (child == 0) {
    ::close(pipe_ends[0]);
    write_all(pipe_ends[1], answer_of(row));
    ::close(pipe_ends[1]);
    ::_exit(0);
  }
  ::close(pipe_ends[1]);
  const std::string text = read_all(pipe_ends[0]);
  ::close(pipe_ends[0]);
  int status = 0;
  rusage usage{};
  while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR) continue;
  if (!WIFEXITED(status) || text.empty())
    throw std::runtime_error(fmt::format("bench: a row's process ended with status {}", status));
  nlohmann::json answer = nlohmann::json::parse(text);
  SaidOnce::add(answer["said"].get<std::vector<std::string>>());
  if (answer.contains("user_error")) throw UserError(answer["user_error"].get<std::string>());
  if (answer.contains("error")) throw std::runtime_error(answer["error"].get<std::string>());
  nlohmann::json result = std::move(answer["row"]);
  result["cpu_s"] = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  result["peak_rss_bytes"] = static_cast<uint64_t>(usage.ru_maxrss) * 1024;
  return result;
}

std::string output_of(const std::vector<std::string>& command) {
  int pipe_ends[2];
  if (::pipe(pipe_ends) != 0) throw std::runtime_error("bench: no pipe to another program");
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  std::cout.flush();
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("bench: cannot start another program");
  if (child == 0) {
    ::dup2(pipe_ends[1], STDOUT_FILENO);
    ::close(pipe_ends[0]);
    ::close(pipe_ends[1]);
    ::execvp(arguments[0], arguments.data());
    ::_exit(127);
  }
  ::close(pipe_ends[1]);
  std::string text = read_all(pipe_ends[0]);
  ::close(pipe_ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw_user_error("bench: expected '{}' to run and to end with exit code 0, found {}", command[0],
                     WIFEXITED(status) ? fmt::format("exit code {}", WEXITSTATUS(status))
                                       : fmt::format("status {}", status));
  return text;
}

double process_age_s() {
  std::ifstream file("/proc/self/stat");
  std::string stat((std::istreambuf_iterator<char>(file)), {});
  // The start time is field 22 (proc(5)). Fields are counted from the name in brackets, field 2, because the
  // name may contain blanks.
  const size_t bracket = stat.rfind(')');
  if (bracket == std::string::npos) throw std::runtime_error("bench: /proc/self/stat cannot be read");
  std::istringstream fields(stat.substr(bracket + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i) fields >> field;
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) -
         parse_number(field).value_or(0.0) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace greatx::apps
