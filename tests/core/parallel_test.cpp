// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks parallel_for and the pool of threads behind it: every index is done once, whoever asks, within other
// loops, after failures and in a child process.
#include "core/parallel.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace greatx {
namespace {

/// Returns whether a loop does each of its indices once.
bool done_once(size_t count, uint32_t threads) {
  std::vector<std::atomic<int>> done(count);
  parallel_for(count, threads, [&](size_t i) { ++done[i]; });
  return std::ranges::all_of(done, [](const std::atomic<int>& times) { return times == 1; });
}

TEST(Parallel, EveryIndexIsDoneOnce) {
  for (const uint32_t threads : {0u, 1u, 2u, 3u, 8u, 17u})
    for (const size_t count : {0, 1, 2, 7, 1000}) EXPECT_TRUE(done_once(count, threads)) << threads;
}

TEST(Parallel, ThreadsAreKept) {
  std::mutex mutex;
  std::set<std::thread::id> seen;
  for (int round = 0; round < 200; ++round)
    parallel_for(8, 4, [&](size_t) {
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
    });
  // Loops before this one may have asked for more threads; a thread anew for each round would be hundreds.
  EXPECT_LE(seen.size(), 1u + 16u);
}

TEST(Parallel, LoopsWithinLoops) {
  std::atomic<size_t> sum{0};
  parallel_for(9, 4, [&](size_t i) {
    parallel_for(11, 5,
                 [&](size_t k) { parallel_for(3, 0, [&](size_t m) { sum += 100 * i + 10 * k + m; }); });
  });
  EXPECT_EQ(sum, 100u * 36 * 33 + 10u * 55 * 27 + 3u * 99);
}

TEST(Parallel, SeveralCallersAtOnce) {
  std::vector<std::thread> callers;
  std::atomic<int> good{0};
  for (int caller = 0; caller < 6; ++caller)
    callers.emplace_back([&] {
      for (int round = 0; round < 50; ++round) good += done_once(37, 3);
    });
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(good, 300);
}

TEST(Parallel, TheFirstFailureComesBackAndTheNextLoopWorks) {
  for (const uint32_t threads : {1u, 4u}) {
    EXPECT_THROW(parallel_for(100, threads,
                              [](size_t i) {
                                if (i == 50) throw std::runtime_error("50");
                              }),
                 std::runtime_error);
    EXPECT_TRUE(done_once(100, threads));
  }
}

TEST(Parallel, AChildProcessHasThreadsOfItsOwn) {
  ASSERT_TRUE(done_once(100, 4));
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);  // a loop that waits for threads of the parent would never end
    _exit(done_once(100, 4) ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(done_once(100, 4));
}

TEST(Parallel, LoopsBesideEachOther) {
  for (const uint32_t threads : {1u, 4u}) {
    std::vector<std::vector<int>> done{std::vector<int>(5), {}, std::vector<int>(70), std::vector<int>(1)};
    LoopsBeside loops;
    for (std::vector<int>& own : done) loops.add(own.size(), [&own](size_t i) { ++own[i]; });
    loops.run(threads);
    for (const std::vector<int>& own : done)
      EXPECT_TRUE(std::ranges::all_of(own, [](int times) { return times == 1; }));
  }
  LoopsBeside().run(4);
}

}  // namespace
}  // namespace greatx
