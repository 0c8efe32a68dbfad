// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The entry of libFuzzer for the target GREATX_TARGET.
#include <cstdlib>
#include <cstring>

#include "tests/fuzz/targets/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  for (const greatx::fuzz::Target& target : greatx::fuzz::targets())
    if (std::strcmp(target.name, GREATX_TARGET) == 0) {
      greatx::fuzz::run(target, data, size);
      return 0;
    }
  std::abort();
}
