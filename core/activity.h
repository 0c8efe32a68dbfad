// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Names the activity of the program: for one error that cannot name it itself, a failed allocation, and for
// those who show what a thread does.
#pragma once

#include <string>

namespace greatx {

/// While an Activity lives, its thread does `what` ("building the scene"). The text outlives the Activity.
/// Activities nest.
class Activity {
 public:
  explicit Activity(const char* what);
  ~Activity();
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

 private:
  const char* before_;
};

/// Hears of the activities of a thread.
class ActivityListener {
 public:
  virtual ~ActivityListener() = default;
  /// Called on the thread whenever its activity changes. Null: it has none now.
  virtual void activity_changed(const char* what) noexcept = 0;
};

/// As long as this lives, `listener` hears of the activities of this thread. `listener` outlives it.
class ActivityScope {
 public:
  explicit ActivityScope(ActivityListener& listener);
  ~ActivityScope();
  ActivityScope(const ActivityScope&) = delete;
  ActivityScope& operator=(const ActivityScope&) = delete;

 private:
  ActivityListener* before_;
};

/// Installs a handler (std::set_new_handler) that stores the activity during which memory last ran out.
void watch_memory();
/// Returns "out of memory while building the scene", or "out of memory" if there is no activity.
std::string out_of_memory();

}  // namespace greatx
