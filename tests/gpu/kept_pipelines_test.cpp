// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/kept_pipelines.h"

#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gpu/device.h"
#include "gpu/pipeline.h"

namespace greatx::gpu {
namespace {

ComputeDesc add_desc(uint32_t addend) {
  ComputeDesc desc;
  desc.shader = "tests/add.comp";
  desc.bindings = {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  desc.push_constant_bytes = 8;
  desc.specialization = {addend};
  return desc;
}

/// Makes a pipeline, waits for it and gives it up again. Returns what it was.
VkPipeline make_and_drop(Device& device, const ComputeDesc& desc) {
  const ComputePipeline pipeline(device, desc, "add");
  return pipeline.handle();
}

/// The validation layer reports pipelines that outlive the device.
class KeptPipelinesTest : public testing::Test {
 protected:
  void TearDown() override {
    const std::shared_ptr<ValidationLog> log = device_->validation_log();
    device_.reset();
    EXPECT_THAT(log->take(), testing::IsEmpty());
  }
  std::optional<Device> device_{std::in_place, DeviceOptions{{}, true}};
};

TEST_F(KeptPipelinesTest, OneOfTheSameDescriptionIsTheNextOnes) {
  const KeptPipelines kept(*device_);
  const VkPipeline first = make_and_drop(*device_, add_desc(1));
  EXPECT_EQ(kept.count(), 1u);
  const ComputePipeline again(*device_, add_desc(1), "again");
  EXPECT_EQ(kept.count(), 0u) << "it has one owner";
  EXPECT_EQ(again.handle(), first);
  EXPECT_EQ(device_->counters().pipelines_built, 2u) << "each owner has asked for one";
  EXPECT_THAT(device_->counters().pipelines, testing::ElementsAre("add", "again"));
}

TEST_F(KeptPipelinesTest, EveryPartOfTheDescriptionCounts) {
  const KeptPipelines kept(*device_);
  make_and_drop(*device_, add_desc(1));
  ComputeDesc bytes = add_desc(1), order = add_desc(1), third = add_desc(1);
  bytes.push_constant_bytes = 16;
  std::swap(order.bindings[0], order.bindings[1]);
  third.bindings.push_back({2, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER});
  for (const ComputeDesc& other : {add_desc(2), bytes, order, third}) {
    const size_t before = kept.count();
    make_and_drop(*device_, other);
    EXPECT_EQ(kept.count(), before + 1) << "another one was taken for it";
  }
}

TEST_F(KeptPipelinesTest, TwoOwnersAtATimeHaveTwo) {
  const KeptPipelines kept(*device_);
  {
    const ComputePipeline one(*device_, add_desc(1), "one"), other(*device_, add_desc(1), "other");
    EXPECT_NE(one.handle(), other.handle());
  }
  EXPECT_EQ(kept.count(), 2u);
}

TEST_F(KeptPipelinesTest, NoMoreThanAskedForAreKept) {
  const KeptPipelines kept(*device_, 2);
  for (const uint32_t addend : {1u, 2u, 3u}) make_and_drop(*device_, add_desc(addend));
  EXPECT_EQ(kept.count(), 2u);
  const ComputePipeline first(*device_, add_desc(1), "first");
  EXPECT_EQ(kept.count(), 2u) << "the first one is gone";
  const ComputePipeline last(*device_, add_desc(3), "last");
  EXPECT_EQ(kept.count(), 1u);
}

TEST_F(KeptPipelinesTest, OwnersMayOutliveTheKeeper) {
  std::optional<KeptPipelines> kept(std::in_place, *device_);
  const ComputePipeline pipeline(*device_, add_desc(1), "add");
  pipeline.handle();
  kept.reset();
}

TEST_F(KeptPipelinesTest, WithoutAKeeperNothingIsKept) {
  make_and_drop(*device_, add_desc(1));
  EXPECT_EQ(KeptPipelines::of(*device_), nullptr);
  const KeptPipelines kept(*device_);
  EXPECT_EQ(KeptPipelines::of(*device_), &kept);
  EXPECT_EQ(kept.count(), 0u);
}

}  // namespace
}  // namespace greatx::gpu
