// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Suppresses leaks of the Vulkan loader, its layers and drivers in a build with AddressSanitizer, because
// they are not faults of greatx. All other leaks count. The sanitizers prescribe the names of these functions
// (sanitizer/lsan_interface.h).
#include <dlfcn.h>

// The loader and the library of the sanitizers look these functions up in the program, which hides all its
// other symbols.
#pragma GCC visibility push(default)
extern "C" {

/// Keeps drivers loaded, because a leak can only be attributed to a library that is still in memory.
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
