// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes one device per test program and tracer, with validation. Any message of the validation layer fails
// the test during which it arrives. Link greatx_gpu_test_support: its main() installs the listener.
#pragma once

#include "gpu/device.h"

namespace greatx::test {

/// Returns the program's device, with a tracer: the one that the device prefers, or the one named. The first
/// call for each makes it.
gpu::Device& device(gpu::Tracer tracer = gpu::Tracer::automatic);

}  // namespace greatx::test
