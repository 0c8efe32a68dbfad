// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes one device per test program, with validation on. Any message of the validation layer fails the test
// during which it came. Link greatx_gpu_test_support, whose main() installs the listener.
#pragma once

#include "gpu/device.h"

namespace greatx::test {

/// Returns the program's device, which is made at the first call.
gpu::Device& device();

}  // namespace greatx::test
