// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The readers of untrusted input, each as a function of bytes. libFuzzer calls one of them millions of times
// (clang, option GREATX_FUZZERS); test_fuzz_targets calls all of them with the corpus (any compiler).
//
// A reader may take its input or throw UserError. Anything else is a fault: another exception, a signal, a
// report of a sanitizer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace greatx::fuzz {

struct Target {
  const char* name;  ///< folder of its corpus
  void (*read)(const uint8_t* data, size_t size);
};

/// Returns every target.
std::span<const Target> targets();

/// Calls the target; UserError is an answer.
void run(const Target& target, const uint8_t* data, size_t size);

}  // namespace greatx::fuzz
