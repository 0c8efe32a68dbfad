// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A package of greatx may bring Mesa's lavapipe along, which computes on the CPU, for machines on which
// nobody can install a driver (packaging/wheel.sh). The Vulkan loader finds the machine's own drivers by
// itself; this adds ours to them:
//
//   folder of the program or library ─► …/vulkan/lavapipe.json ─► VK_ADD_DRIVER_FILES ─► Vulkan loader
#pragma once

#include <filesystem>
#include <vector>

namespace greatx::gpu {

/// Returns the folders in which the Vulkan loader looks for the descriptions of drivers, from the environment
/// (LoaderDriverInterface.md of the Vulkan loader, "Linux Driver Discovery").
std::vector<std::filesystem::path> driver_folders();

/// Adds the bundled driver to those that the loader finds, by the variable VK_ADD_DRIVER_FILES of this
/// process. Does so once, before the first call of the loader. Adds nothing if the package has no driver, if
/// the machine has a lavapipe of its own, or if VK_DRIVER_FILES or VK_ICD_FILENAMES name the drivers.
void offer_bundled_driver();

/// Whether a lavapipe is described in one of the folders.
bool has_lavapipe(const std::vector<std::filesystem::path>& folders);

/// Returns where the driver that belongs to a program or library is described, or an empty path: vulkan/ and
/// greatx_engine/vulkan/ beside the folder of the file.
std::filesystem::path bundled_driver_of(const std::filesystem::path& file);

}  // namespace greatx::gpu
