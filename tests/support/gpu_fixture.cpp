// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gpu_fixture.h"

#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>

#include <gtest/gtest.h>

namespace greatx::test {

namespace {

std::map<gpu::Tracer, std::unique_ptr<gpu::Device>> shared_devices;

class ValidationListener : public testing::EmptyTestEventListener {
  void OnTestEnd(const testing::TestInfo&) override {
    for (const auto& [tracer, device] : shared_devices)
      for (const std::string& message : device->validation_log()->take())
        ADD_FAILURE() << "validation: " << message;
  }
};

}  // namespace

gpu::Device& device(gpu::Tracer tracer) {
  std::unique_ptr<gpu::Device>& device = shared_devices[tracer];
  if (device == nullptr) device = std::make_unique<gpu::Device>(gpu::DeviceOptions{{}, true, tracer});
  return *device;
}

int run(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  setenv("GREATX_CACHE", "off", 0);  // tests do not use the results of earlier runs
  testing::UnitTest::GetInstance()->listeners().Append(new ValidationListener);
  int result = RUN_ALL_TESTS();
  // The validation layer reports leaks, and objects that outlive the device, while the device is destroyed.
  for (auto& [tracer, device] : shared_devices) {
    const std::shared_ptr<gpu::ValidationLog> log = device->validation_log();
    device.reset();
    for (const std::string& message : log->take()) {
      std::fprintf(stderr, "validation at the end: %s\n", message.c_str());
      result = 1;
    }
  }
  return result;
}

}  // namespace greatx::test

int main(int argc, char** argv) { return greatx::test::run(argc, argv); }
