// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/activity.h"

#include <atomic>
#include <new>

namespace greatx {
namespace {

thread_local const char* current = nullptr;
/// A thread that parallel_for() starts has no activity of its own, so the outermost thread's activity stands
/// for it.
std::atomic<const char*> latest{nullptr}, failed{nullptr};
thread_local ActivityListener* listening = nullptr;

void change(const char* what) {
  latest = current = what;
  if (listening != nullptr) listening->activity_changed(what);
}

void on_failure() {
  failed = current != nullptr ? current : latest.load();
  throw std::bad_alloc();
}

}  // namespace

Activity::Activity(const char* what) : before_(current) { change(what); }
Activity::~Activity() { change(before_); }

ActivityScope::ActivityScope(ActivityListener& listener) : before_(listening) { listening = &listener; }
ActivityScope::~ActivityScope() { listening = before_; }

void watch_memory() { std::set_new_handler(on_failure); }

std::string out_of_memory() {
  const char* what = failed;
  return what == nullptr ? "out of memory" : std::string("out of memory while ") + what;
}

}  // namespace greatx
