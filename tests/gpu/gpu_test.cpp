// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <future>
#include <numeric>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gpu/tick_ring.h"
#include "tests/support/gpu_fixture.h"

namespace greatx::gpu {
namespace {

struct AddConstants {
  uint32_t count, more;
};

ComputePipeline add_pipeline(uint32_t addend) {
  ComputeDesc desc;
  desc.shader = "tests/add.comp";
  desc.bindings = {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  desc.push_constant_bytes = sizeof(AddConstants);
  desc.specialization = {addend};
  return ComputePipeline(test::device(), desc, "add");
}

TEST(Devices, AreListedWithWhatTheyLack) {
  const std::vector<DeviceInfo> devices = list_devices();
  ASSERT_FALSE(devices.empty());
  for (const DeviceInfo& info : devices) {
    EXPECT_FALSE(info.name.empty());
    EXPECT_EQ(info.usable(), info.missing().empty());
  }
}

TEST(Devices, MissingFeatureIsNamed) {
  DeviceInfo info;
  info.capabilities = {{"rayQuery", "tracing rays", true, false}, {"nicety", "speed", false, false}};
  EXPECT_THAT(info.missing(), testing::ElementsAre("rayQuery"));
  EXPECT_FALSE(info.usable());
}

TEST(Devices, UnknownSelectionListsWhatThereIs) {
  try {
    const Device device({"no such device", false});
    FAIL() << "a device was found";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no Vulkan device matches 'no such device'"));
    EXPECT_THAT(error.what(), testing::HasSubstr(list_devices()[0].name));
  }
}

DeviceInfo made_up(uint32_t index, const std::string& name, const std::string& type, bool ray_query) {
  DeviceInfo info;
  info.index = index;
  info.name = name;
  info.type = type;
  info.capabilities = {{"rayQuery", "tracing rays", true, ray_query}};
  return info;
}

TEST(Devices, TheBestUsableTypeIsChosen) {
  const std::vector<DeviceInfo> devices{made_up(0, "Soft", "cpu", true),
                                        made_up(1, "Blind", "discrete", false),
                                        made_up(2, "Small", "integrated", true)};
  EXPECT_EQ(choose_device(devices, "").name, "Small");
  EXPECT_EQ(choose_device(devices, "soft").name, "Soft");
  EXPECT_EQ(choose_device(devices, "2").name, "Small");
}

TEST(Devices, AnIndexGoesBeforeAPartOfAName) {
  const std::vector<DeviceInfo> devices{made_up(0, "llvmpipe (LLVM 15.0.6, 256 bits)", "cpu", true),
                                        made_up(1, "Real", "discrete", true)};
  EXPECT_EQ(choose_device(devices, "1").name, "Real");
  EXPECT_EQ(choose_device(devices, "0").name, devices[0].name);
  EXPECT_EQ(choose_device(devices, "256").name, devices[0].name);
}

TEST(Devices, WithoutRayQueryIsRefusedByName) {
  const std::vector<DeviceInfo> devices{made_up(0, "Blind", "discrete", false)};
  for (const char* select : {"", "blind"}) {
    try {
      choose_device(devices, select);
      FAIL() << "a device without ray query was chosen";
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("lacks rayQuery"));
      EXPECT_THAT(error.what(), testing::HasSubstr("Blind"));
    }
  }
}

TEST(Devices, NoneAtAllSaysWhatToInstall) {
  try {
    choose_device({}, "");
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no Vulkan driver found: install"));
  }
}

TEST(Validation, AMessageIsCaught) {
  Device& device = test::device();
  const Buffer from(device, 64, Memory::device, "from"), to(device, 64, Memory::device, "to");
  submit_setup(device, [&](Cmd& cmd) {
    // A size of 0 is not allowed, and harmless. A CPU's driver would execute a copy beyond the end.
    const VkBufferCopy nothing{0, 0, 0};
    vkCmdCopyBuffer(cmd.handle(), from.handle(), to.handle(), 1, &nothing);
  });
  EXPECT_FALSE(device.validation_log()->take().empty()) << "validation is not on";
}

/// An error between a submission and its wait destroys everything that the submission uses, in the order in
/// which scopes end. The validation layer reports objects that are destroyed too early.
TEST(Ticks, NothingDiesBeforeTheSubmissionThatUsesIt) {
  Device& device = test::device();
  const auto run = [&](bool next_begun) {
    TickRing ring(device, 2, 1 << 16, 1 << 16);
    const Buffer in(device, 4u << 20, Memory::device, "in"), out(device, 4u << 20, Memory::device, "out");
    const ComputePipeline pipeline = add_pipeline(1);
    const auto record = [&](TickSlot& slot) {
      const auto scope = slot.cmd->scope("add");
      slot.cmd->bind(pipeline);
      slot.cmd->push({Descriptor::buffer(0, in.slice()), Descriptor::buffer(1, out.slice())});
      slot.cmd->constants(AddConstants{1u << 20, 1});
      slot.cmd->dispatch((1u << 20) / 64);
    };
    TickSlot& slot = ring.begin();
    record(slot);
    ring.submit(slot);
    if (next_begun) record(ring.begin());
    throw_user_error("of a sensor");
  };
  EXPECT_THROW(run(false), UserError);
  EXPECT_THROW(run(true), UserError);
}

TEST(Compute, AddsWithSpecializationAndPushConstants) {
  Device& device = test::device();
  const ComputePipeline pipeline = add_pipeline(100);
  TickRing ring(device, 2, 1 << 16, 1 << 16);
  const uint64_t submits = device.counters().submits;
  for (uint32_t tick = 0; tick < 5; ++tick) {
    std::vector<uint32_t> values(1000);
    std::iota(values.begin(), values.end(), tick);
    TickSlot& slot = ring.begin();
    const Slice in = slot.upload.put(std::span<const uint32_t>(values));
    const Slice out = slot.readback.allocate_for<uint32_t>(values.size());
    {
      const auto scope = slot.cmd->scope("add");
      slot.cmd->bind(pipeline);
      slot.cmd->push({Descriptor::buffer(0, in), Descriptor::buffer(1, out)});
      slot.cmd->constants(AddConstants{1000, tick});
      slot.cmd->dispatch(16);
    }
    ring.submit(slot);
    ring.wait(slot);
    const auto result = out.as<uint32_t>();
    for (uint32_t i = 0; i < values.size(); ++i) ASSERT_EQ(result[i], i + 2 * tick + 100);
    const std::vector<PassTime> times = slot.timestamps.read();
    ASSERT_EQ(times.size(), 1u);
    EXPECT_EQ(times[0].name, "add");
    EXPECT_GE(times[0].milliseconds, 0.0);
  }
  EXPECT_EQ(device.counters().submits - submits, 5u);
}

/// A packet is handed over while the next tick is at work, so nothing that it needs may wait for that tick.
TEST(Ticks, TimesAreReadWhileALaterSubmissionWaits) {
  Device& device = test::device();
  const ComputePipeline pipeline = add_pipeline(1);
  TickRing ring(device, 2, 1 << 16, 1 << 16);
  TickSlot& slot = ring.begin();
  {
    const auto scope = slot.cmd->scope("add");
    slot.cmd->bind(pipeline);
    slot.cmd->push(
        {Descriptor::buffer(0, slot.upload.allocate(64)), Descriptor::buffer(1, slot.readback.allocate(64))});
    slot.cmd->constants(AddConstants{16, 1});
    slot.cmd->dispatch(1);
  }
  ring.submit(slot);
  ring.wait(slot);
  VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
  VkSemaphore host = VK_NULL_HANDLE;
  GREATX_VK(vkCreateSemaphore(device.handle(), &info, nullptr, &host));
  VkSemaphoreSubmitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
  wait.semaphore = host;
  wait.value = 1;
  wait.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  VkSubmitInfo2 later{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  later.waitSemaphoreInfoCount = 1;
  later.pWaitSemaphoreInfos = &wait;
  GREATX_VK(vkQueueSubmit2(device.queue(), 1, &later, VK_NULL_HANDLE));

  std::future<std::vector<PassTime>> times =
      std::async(std::launch::async, [&] { return slot.timestamps.read(); });
  const bool read = times.wait_for(std::chrono::seconds(20)) == std::future_status::ready;
  VkSemaphoreSignalInfo signal{VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO};
  signal.semaphore = host;
  signal.value = 1;
  GREATX_VK(vkSignalSemaphore(device.handle(), &signal));
  EXPECT_TRUE(read) << "the times wait for the later submission";
  EXPECT_EQ(times.get().size(), 1u);
  device.wait_idle();
  vkDestroySemaphore(device.handle(), host, nullptr);
}

TEST(Compute, AnUnknownShaderIsAnErrorAtOnce) {
  ComputeDesc desc;
  desc.shader = "tests/none.comp";
  EXPECT_THROW(ComputePipeline(test::device(), desc, "none"), ContractError);
}

TEST(Compute, PipelinesAreCountedInTheOrderAskedFor) {
  Device& device = test::device();
  const size_t before = device.counters().pipelines.size();
  const uint64_t built = device.counters().pipelines_built;
  for (const uint32_t addend : {1u, 2u, 3u}) {
    ComputeDesc desc;
    desc.shader = "tests/add.comp";
    desc.bindings = {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
    desc.push_constant_bytes = sizeof(AddConstants);
    desc.specialization = {addend};
    const ComputePipeline unused(device, desc, fmt::format("add {}", addend));
    EXPECT_TRUE(static_cast<bool>(unused));
  }
  const std::vector<std::string>& all = device.counters().pipelines;
  EXPECT_THAT(std::vector(all.begin() + static_cast<std::ptrdiff_t>(before), all.end()),
              testing::ElementsAre("add 1", "add 2", "add 3"));
  EXPECT_EQ(device.counters().pipelines_built, built + 3);
}

TEST(Compute, GroupsAreLaidOutInRows) {
  EXPECT_EQ(group_grid(0), (GroupGrid{0, 0}));
  EXPECT_EQ(group_grid(1), (GroupGrid{1, 1}));
  EXPECT_EQ(group_grid(65535), (GroupGrid{65535, 1}));
  EXPECT_EQ(group_grid(65536), (GroupGrid{32768, 2}));
  for (const uint64_t groups : {88586ull, 131071ull, 1ull << 26, 65535ull * 65535ull}) {
    const GroupGrid grid = group_grid(groups);
    EXPECT_LE(grid.x, 65535u);
    EXPECT_LE(grid.y, 65535u);
    EXPECT_GE(uint64_t{grid.x} * grid.y, groups);
    EXPECT_LT(uint64_t{grid.x} * grid.y, groups + grid.y);
  }
  EXPECT_THROW(group_grid(65535ull * 65535ull + 1), ContractError);
}

TEST(Compute, MoreGroupsThanAnAxisTakes) {
  Device& device = test::device();
  const ComputePipeline pipeline = add_pipeline(3);
  const uint32_t count = 64 * 70001 + 5;
  TickRing ring(device, 1, 4 * count + 16, 4 * count + 16);
  TickSlot& slot = ring.begin();
  std::vector<uint32_t> values(count);
  std::iota(values.begin(), values.end(), 0u);
  const Slice in = slot.upload.put(std::span<const uint32_t>(values));
  const Slice out = slot.readback.allocate_for<uint32_t>(count);
  const uint64_t before = device.counters().dispatches;
  slot.cmd->bind(pipeline);
  slot.cmd->push({Descriptor::buffer(0, in), Descriptor::buffer(1, out)});
  slot.cmd->constants(AddConstants{count, 4});
  slot.cmd->dispatch_linear(count, 64);
  EXPECT_EQ(device.counters().dispatches - before, 1u);
  slot.cmd->dispatch_linear(0, 64);
  EXPECT_EQ(device.counters().dispatches - before, 1u) << "nothing";
  ring.submit(slot);
  ring.wait(slot);
  const auto result = out.as<uint32_t>();
  size_t wrong = 0;
  for (uint32_t i = 0; i < count; ++i) wrong += result[i] != i + 7;
  EXPECT_EQ(wrong, 0u);
}

TEST(Compute, ABufferLargerThanShadersMaySeeIsRefusedByName) {
  Device& device = test::device();
  const VkDeviceSize most = device.limits().maxStorageBufferRange;
  if (most > 1u << 28) GTEST_SKIP() << "this device takes " << most << " bytes";
  const ComputePipeline pipeline = add_pipeline(0);
  const Buffer large(device, most + 16, Memory::device, "a large table"),
      small(device, 64, Memory::device, "");
  TickRing ring(device, 1, 1 << 16, 1 << 16);
  TickSlot& slot = ring.begin();
  slot.cmd->bind(pipeline);
  slot.cmd->push({Descriptor::buffer(0, large.slice().part(16, most)), Descriptor::buffer(1, small)});
  EXPECT_THAT(
      [&] {
        slot.cmd->push({Descriptor::buffer(0, large), Descriptor::buffer(1, small)});
      },
      testing::ThrowsMessage<UserError>(
          testing::HasSubstr(fmt::format("'a large table' needs {} bytes", most + 16))));
  ring.submit(slot);
  ring.wait(slot);
}

TEST(Arena, GrowsOnceThenReuses) {
  Arena arena(test::device(), Memory::upload, 1024, "test");
  for (int round = 0; round < 3; ++round) {
    arena.reset();
    const Slice a = arena.allocate(1000);
    const Slice b = arena.allocate(5000);
    EXPECT_NE(a.buffer, b.buffer);
    EXPECT_EQ(b.size, 5000u);
  }
  EXPECT_EQ(arena.growths(), 1u);
}

TEST(Upload, ArrivesWhole) {
  std::vector<uint32_t> words(100000);
  std::iota(words.begin(), words.end(), 7u);
  const Buffer buffer = upload_buffer(test::device(), std::as_bytes(std::span(words)), "words");
  const Buffer back(test::device(), buffer.size(), Memory::readback, "back");
  submit_setup(test::device(), [&](Cmd& cmd) { cmd.copy(buffer.slice(), back.slice()); });
  EXPECT_TRUE(std::equal(words.begin(), words.end(), back.slice().as<uint32_t>().begin()));
}

TEST(Spirv, UnknownNameIsABrokenContract) { EXPECT_THROW(spirv("no/such.comp"), ContractError); }

}  // namespace
}  // namespace greatx::gpu
