// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the watch of long work: it can stop the work from a loop of any thread, and it receives the
// progress.
#include "core/watch.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/parallel.h"

namespace greatx {
namespace {

/// Interrupts the work at the `stop_at`th check.
class CountingWatch : public Watch {
 public:
  explicit CountingWatch(int stop_at) : stop_at_(stop_at) {}
  bool look(const WorkState& state) noexcept override {
    threads.push_back(std::this_thread::get_id());
    if (state.what != nullptr) what = state.what, shares.push_back(state.share);
    return ++looks < stop_at_;
  }
  void stage_ended() noexcept override { ++ended; }

  int looks = 0, ended = 0;
  std::string what;
  std::vector<double> shares;
  std::vector<std::thread::id> threads;

 private:
  int stop_at_;
};

[[noreturn]] void never_ends() {
  for (;;) checkpoint();
}

TEST(Watch, NothingHappensWhereNobodyWatches) {
  EXPECT_NO_THROW(checkpoint());
  WorkStage stage("work");
  stage.add(1);
  stage.expect(2.0);
  size_t sum = 0;
  parallel_for(10, 1, [&](size_t i) { sum += i; });
  EXPECT_EQ(sum, 45u);
}

TEST(Watch, StopsWorkOfTheThreadItself) {
  CountingWatch watch(3);
  const WatchScope scope(watch);
  EXPECT_THROW(never_ends(), Interrupted);
  EXPECT_EQ(watch.looks, 3);
  EXPECT_THROW(checkpoint(), Interrupted) << "and all that follows, until the scope ends";
}

TEST(Watch, StopsWorkersWhileTheThreadOnlyWaitsForThem) {
  CountingWatch watch(3);
  const WatchScope scope(watch);
  const std::thread::id mine = std::this_thread::get_id();
  const auto work = [&](size_t) {
    if (std::this_thread::get_id() != mine) never_ends();
  };
  EXPECT_THROW(parallel_for(3, 3, [&](size_t i) { i == 0 ? never_ends() : work(i); }), Interrupted);
  for (const std::thread::id& thread : watch.threads) EXPECT_EQ(thread, mine);
}

TEST(Watch, StopsWorkersOfWorkers) {
  CountingWatch watch(2);
  const WatchScope scope(watch);
  EXPECT_THROW(parallel_for(2, 2, [&](size_t) { parallel_for(2, 2, [](size_t) { never_ends(); }); }),
               Interrupted);
}

TEST(Watch, HearsWhatIsDoneAndHowFarItIs) {
  CountingWatch watch(4);
  const WatchScope scope(watch);
  EXPECT_THROW(
      {
        WorkStage stage("search");
        stage.add(3);
        WorkStage inner("part of it");  // the watch receives nothing of this stage
        inner.add(100);
        stage.expect(12.0);
        never_ends();
      },
      Interrupted);
  EXPECT_EQ(watch.what, "search");
  EXPECT_EQ(watch.shares, std::vector<double>(4, 0.25));
  EXPECT_EQ(watch.ended, 1);
}

TEST(Watch, AnInnerScopeTakesThePlaceOfTheOuterOne) {
  CountingWatch outer(1), inner(1);
  const WatchScope scope(outer);
  {
    const WatchScope inside(inner);
    EXPECT_THROW(never_ends(), Interrupted);
  }
  EXPECT_EQ(outer.looks, 0);
  EXPECT_THROW(never_ends(), Interrupted);
  EXPECT_EQ(outer.looks, 1);
}

}  // namespace
}  // namespace greatx
