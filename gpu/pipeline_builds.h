// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Builds pipelines beside the thread that asks for them. A driver compiles the shaders of a pipeline on the
// thread that calls it, and a run asks for dozens of pipelines before its first tick. Vulkan allows several
// threads to create pipelines of one device with one pipeline cache (Vulkan 1.3 specification, section 3.6,
// "Threading Behavior").
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "gpu/vulkan.h"

namespace greatx::gpu {

/// Represents a pipeline that is built once, by whichever thread comes to it first.
class PipelineBuild {
 public:
  explicit PipelineBuild(std::function<VkPipeline()> make) : make_(std::move(make)) {}
  /// Returns the pipeline. Builds it here if no thread has begun it, and waits for a thread that is at it.
  /// Throws what building has thrown.
  VkPipeline get();
  /// Builds the pipeline and keeps what building throws for get().
  void run() noexcept;
  /// Leaves the pipeline out if no thread has begun it, else waits for it. Returns what has been built, or
  /// VK_NULL_HANDLE.
  VkPipeline give_up() noexcept;

 private:
  std::once_flag once_;
  std::function<VkPipeline()> make_;
  VkPipeline made_ = VK_NULL_HANDLE;
  std::exception_ptr failure_;
};

/// Holds the threads that build pipelines. The calling thread has a core of its own, so that there are no
/// threads on one core.
class PipelineBuilds {
 public:
  PipelineBuilds();
  /// Ends the threads after the builds at which they are.
  ~PipelineBuilds();
  PipelineBuilds(const PipelineBuilds&) = delete;
  PipelineBuilds& operator=(const PipelineBuilds&) = delete;
  /// Queues a build. Without threads, builds it at once and throws what building throws.
  void add(std::shared_ptr<PipelineBuild> build);

 private:
  void work();

  size_t most_threads_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::shared_ptr<PipelineBuild>> waiting_;
  size_t idle_ = 0;  ///< threads that wait for a build
  bool ends_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace greatx::gpu
