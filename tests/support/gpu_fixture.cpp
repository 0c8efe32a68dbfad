// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gpu_fixture.h"

#include <cstdio>
#include <cstdlib>
#include <memory>

#include <gtest/gtest.h>

namespace greatx::test {

namespace {

std::unique_ptr<gpu::Device> shared_device;

class ValidationListener : public testing::EmptyTestEventListener {
  void OnTestEnd(const testing::TestInfo&) override {
    if (shared_device == nullptr) return;
    for (const std::string& message : shared_device->validation_log()->take())
      ADD_FAILURE() << "validation: " << message;
  }
};

}  // namespace

gpu::Device& device() {
  if (shared_device == nullptr) shared_device = std::make_unique<gpu::Device>(gpu::DeviceOptions{{}, true});
  return *shared_device;
}

int run(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  setenv("GREATX_CACHE", "off", 0);  // tests do not use the results of earlier runs
  testing::UnitTest::GetInstance()->listeners().Append(new ValidationListener);
  int result = RUN_ALL_TESTS();
  if (shared_device == nullptr) return result;
  // The validation layer reports leaks, and objects that outlive the device, while the device is destroyed.
  const std::shared_ptr<gpu::ValidationLog> log = shared_device->validation_log();
  shared_device.reset();
  for (const std::string& message : log->take()) {
    std::fprintf(stderr, "validation at the end: %s\n", message.c_str());
    result = 1;
  }
  return result;
}

}  // namespace greatx::test

int main(int argc, char** argv) { return greatx::test::run(argc, argv); }
