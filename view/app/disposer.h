// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <vector>

namespace greatx::view {

/// Destroys things that take long to stop, such as runs, on threads of their own, so that the window goes on.
/// The destructor waits for all of them.
class Disposer {
 public:
  template <typename T>
  void drop(std::unique_ptr<T> thing) {
    std::erase_if(ending_, [](const std::future<void>& end) {
      return end.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    if (thing == nullptr) return;
    std::shared_ptr<T> last = std::move(thing);
    ending_.push_back(std::async(std::launch::async, [last = std::move(last)]() mutable { last.reset(); }));
  }

 private:
  std::vector<std::future<void>> ending_;
};

}  // namespace greatx::view
