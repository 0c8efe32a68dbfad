// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes Vulkan instances: for the devices that compute, and for those that show a window.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/vulkan.h"

namespace greatx::gpu {

/// Says what to install where there is no driver.
extern const char* const no_vulkan_help;

bool has_instance_extension(const char* name);
/// Makes an instance with debug names where the loader has them, and with `extra` extensions. Messages of the
/// validation layer go to `log`, which outlives the instance. Throws UserError if there is no driver, or if
/// the layer is wanted and not installed.
VkInstance make_instance(bool validation, std::span<const std::string> extra, ValidationLog* log);
/// Sends the messages of the validation layer to `log`; null if the loader cannot.
VkDebugUtilsMessengerEXT make_messenger(VkInstance instance, ValidationLog* log);
/// Destroys the instance and, before it, the messenger, which may be null.
void destroy_instance(VkInstance instance, VkDebugUtilsMessengerEXT messenger);
/// Returns the devices of the instance; none if there is no driver.
std::vector<VkPhysicalDevice> physical_devices(VkInstance instance);
/// Whether the variable is set, and to something else than 0.
bool environment_flag(const char* name);

}  // namespace greatx::gpu
