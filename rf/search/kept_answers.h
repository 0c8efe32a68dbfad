// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps the last answers to questions that many threads ask, for searches that several transmitters share.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace greatx::rf {

template <typename Question, typename Answer>
class KeptAnswers {
 public:
  explicit KeptAnswers(size_t most) : most_(most) {}

  /// Returns the answer that is kept, or that of `find()`, which is kept from now on if `keep`.
  template <typename Find>
  std::shared_ptr<const Answer> get(const Question& question, bool keep, const Find& find) {
    {
      const std::lock_guard lock(mutex_);
      if (auto answer = known(question)) return answer;
    }
    auto answer = std::make_shared<const Answer>(find());
    const std::lock_guard lock(mutex_);
    if (!keep || known(question)) return answer;
    if (kept_.size() < most_)
      kept_.emplace_back(question, answer);
    else
      kept_[std::exchange(next_, (next_ + 1) % most_)] = {question, answer};
    return answer;
  }
  /// Must not be called while others ask.
  void clear() {
    kept_.clear();
    next_ = 0;
  }

 private:
  std::shared_ptr<const Answer> known(const Question& question) const {
    for (const auto& [asked, answer] : kept_)
      if (asked == question) return answer;
    return nullptr;
  }

  size_t most_, next_ = 0;
  std::mutex mutex_;
  std::vector<std::pair<Question, std::shared_ptr<const Answer>>> kept_;  ///< a ring
};

}  // namespace greatx::rf
