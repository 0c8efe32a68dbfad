// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// In a build with AddressSanitizer, leaks of the Vulkan loader, its layers and drivers are not faults of
// greatx; all others are. The sanitizers choose the names of these functions (sanitizer/lsan_interface.h).
#include <dlfcn.h>

// The loader and the sanitizers' library look for these functions in the program, where all others are
// hidden.
#pragma GCC visibility push(default)
extern "C" {

/// Keeps drivers loaded: a leak can be attributed to its library only while the library is in memory.
int dlclose(void* /*handle*/) noexcept { return 0; }

const char* __lsan_default_suppressions();
const char* __lsan_default_suppressions() {
  return "leak:libvulkan\n"
         "leak:libVkLayer\n"
         "leak:libLLVM\n";
}

const char* __lsan_default_options();
const char* __lsan_default_options() { return "print_suppressions=0"; }

}  // extern "C"
#pragma GCC visibility pop
