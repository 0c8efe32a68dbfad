// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes one device per test program, with validation. Any message of the validation layer fails the test
// during which it arrives. Link greatx_gpu_test_support: its main() installs the listener.
#pragma once

#include "gpu/device.h"

namespace greatx::test {

/// Returns the program's device. The first call makes it.
gpu::Device& device();

}  // namespace greatx::test
