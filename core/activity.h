// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the program is doing, for the one error that cannot say it itself: memory that is not there.
#pragma once

#include <string>

namespace greatx {

/// Until its end this thread is doing `what`, a text that outlives it ("building the scene"). Activities nest.
class Activity {
 public:
  explicit Activity(const char* what);
  ~Activity();
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

 private:
  const char* before_;
};

/// Keeps, from now on, the activity in which memory last ran out (std::set_new_handler).
void watch_memory();
/// "out of memory while building the scene"; without an activity "out of memory".
std::string out_of_memory();

}  // namespace greatx
