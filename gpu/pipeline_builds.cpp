// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/pipeline_builds.h"

#include <algorithm>
#include <utility>

#include "core/parallel.h"

namespace greatx::gpu {

namespace {

/// A run has few large pipelines. More threads would only hold memory.
constexpr size_t most_build_threads = 8;

}  // namespace

void PipelineBuild::run() noexcept {
  std::call_once(once_, [this] {
    try {
      made_ = make_();
    } catch (...) {
      failure_ = std::current_exception();
    }
    make_ = nullptr;
  });
}

VkPipeline PipelineBuild::get() {
  run();
  if (failure_) std::rethrow_exception(failure_);
  return made_;
}

VkPipeline PipelineBuild::give_up() noexcept {
  std::call_once(once_, [this] { make_ = nullptr; });
  return made_;
}

PipelineBuilds::PipelineBuilds() : most_threads_(std::min(usable_cores() - 1, most_build_threads)) {}

PipelineBuilds::~PipelineBuilds() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void PipelineBuilds::add(std::shared_ptr<PipelineBuild> build) {
  if (most_threads_ == 0) {
    build->get();
    return;
  }
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(build));
  if (idle_ < waiting_.size() && threads_.size() < most_threads_) threads_.emplace_back([this] { work(); });
  changed_.notify_one();
}

void PipelineBuilds::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    ++idle_;
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    --idle_;
    if (ends_) return;
    const std::shared_ptr<PipelineBuild> build = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    build->run();
    lock.lock();
  }
}

}  // namespace greatx::gpu
