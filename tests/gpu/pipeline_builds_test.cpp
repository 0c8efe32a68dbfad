// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/pipeline_builds.h"

#include <array>
#include <atomic>
#include <latch>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace greatx::gpu {
namespace {

VkPipeline numbered(uintptr_t number) { return reinterpret_cast<VkPipeline>(number); }

TEST(PipelineBuild, IsMadeOnceByWhoeverComesFirst) {
  std::atomic<int> made{0};
  PipelineBuild build([&] { return numbered(static_cast<uintptr_t>(++made)); });
  std::vector<std::thread> threads;
  std::latch together(4);
  std::array<VkPipeline, 4> got{};
  for (size_t i = 0; i < got.size(); ++i)
    threads.emplace_back([&, i] {
      together.arrive_and_wait();
      got[i] = build.get();
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(got, testing::Each(numbered(1)));
  EXPECT_EQ(made, 1);
}

TEST(PipelineBuild, TellsOfItsErrorToEveryoneWhoAsks) {
  PipelineBuild build([]() -> VkPipeline { throw std::runtime_error("no memory"); });
  build.run();
  for (int i = 0; i < 2; ++i) {
    try {
      build.get();
      FAIL() << "no error";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "no memory");
    }
  }
}

TEST(PipelineBuild, IsLeftOutIfNobodyBeganIt) {
  bool made = false;
  PipelineBuild build([&] {
    made = true;
    return numbered(1);
  });
  EXPECT_EQ(build.give_up(), VkPipeline{VK_NULL_HANDLE});
  build.run();
  EXPECT_FALSE(made);
}

TEST(PipelineBuild, IsWaitedForIfAThreadIsAtIt) {
  std::latch begun(1), go_on(1);
  PipelineBuild build([&] {
    begun.count_down();
    go_on.wait();
    return numbered(7);
  });
  std::thread thread([&] { build.run(); });
  begun.wait();
  std::thread later([&] { go_on.count_down(); });
  EXPECT_EQ(build.give_up(), numbered(7)) << "it would leak";
  thread.join();
  later.join();
}

TEST(PipelineBuilds, MakeAllThatAreAskedFor) {
  constexpr uintptr_t count = 200;
  std::vector<std::shared_ptr<PipelineBuild>> builds;
  std::atomic<uintptr_t> made{0};
  PipelineBuilds threads;
  for (uintptr_t i = 1; i <= count; ++i) {
    builds.push_back(std::make_shared<PipelineBuild>([&made, i] {
      ++made;
      return numbered(i);
    }));
    threads.add(builds.back());
  }
  for (uintptr_t i = 1; i <= count; ++i) EXPECT_EQ(builds[i - 1]->get(), numbered(i));
  EXPECT_EQ(made, count);
}

TEST(PipelineBuilds, EndWithBuildsThatNobodyBegan) {
  std::vector<std::shared_ptr<PipelineBuild>> builds;
  std::atomic<int> made{0};
  {
    PipelineBuilds threads;
    for (int i = 0; i < 50; ++i) {
      builds.push_back(std::make_shared<PipelineBuild>([&made] {
        ++made;
        return numbered(1);
      }));
      threads.add(builds.back());
    }
  }
  const int before = made;
  int given = 0;
  for (const auto& build : builds) given += build->give_up() != VkPipeline{VK_NULL_HANDLE} ? 1 : 0;
  EXPECT_EQ(made, before) << "a thread outlived its owner";
  EXPECT_EQ(given, before);
}

}  // namespace
}  // namespace greatx::gpu
