// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gpu_fixture.h"

#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "gpu/kept_pipelines.h"

namespace greatx::test {

namespace {

/// A program compiles each shader once, however many simulators its tests make. What is declared last is
/// destroyed first.
struct SharedDevice {
  std::unique_ptr<gpu::Device> device;
  std::unique_ptr<gpu::KeptPipelines> pipelines;
};
std::map<gpu::Tracer, SharedDevice> shared_devices;

class ValidationListener : public testing::EmptyTestEventListener {
  void OnTestEnd(const testing::TestInfo&) override {
    for (const auto& [tracer, shared] : shared_devices)
      for (const std::string& message : shared.device->validation_log()->take())
        ADD_FAILURE() << "validation: " << message;
  }
};

}  // namespace

gpu::Device& device(gpu::Tracer tracer) {
  SharedDevice& shared = shared_devices[tracer];
  if (shared.device == nullptr) {
    shared.device = std::make_unique<gpu::Device>(gpu::DeviceOptions{{}, true, tracer});
    shared.pipelines = std::make_unique<gpu::KeptPipelines>(*shared.device);
  }
  return *shared.device;
}

int run(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  setenv("GREATX_CACHE", "off", 0);  // tests do not use the results of earlier runs
  testing::UnitTest::GetInstance()->listeners().Append(new ValidationListener);
  int result = RUN_ALL_TESTS();
  // The validation layer reports leaks, and objects that outlive the device, while the device is destroyed.
  for (auto& [tracer, shared] : shared_devices) {
    const std::shared_ptr<gpu::ValidationLog> log = shared.device->validation_log();
    shared.pipelines.reset();
    shared.device.reset();
    for (const std::string& message : log->take()) {
      std::fprintf(stderr, "validation at the end: %s\n", message.c_str());
      result = 1;
    }
  }
  return result;
}

}  // namespace greatx::test

int main(int argc, char** argv) { return greatx::test::run(argc, argv); }
