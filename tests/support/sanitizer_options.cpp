// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// In a build with AddressSanitizer: leaks of the Vulkan loader, its layers and drivers are not ours; all others are faults.
// The names are the sanitizers' own (sanitizer/lsan_interface.h).
#include <dlfcn.h>

// The loader and the sanitizers' library look for these in the program, where all else is hidden.
#pragma GCC visibility push(default)
extern "C" {

/// Drivers stay loaded: a leak can be laid at the door of its library only while that is in memory.
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
