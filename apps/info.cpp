// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "apps/console/json_text.h"
#include "gpu/device.h"

namespace greatx::apps {

namespace {

nlohmann::json json_of(const gpu::DeviceInfo& info) {
  nlohmann::json json{{"index", info.index},        {"name", info.name},
                      {"type", info.type},          {"driver", info.driver},
                      {"vulkan", info.api_version}, {"memory_bytes", info.memory_bytes},
                      {"usable", info.usable()},    {"missing", info.missing()}};
  for (const gpu::Capability& capability : info.capabilities)
    json["capabilities"].push_back({{"name", capability.name},
                                    {"used_for", capability.used_for},
                                    {"required", capability.required},
                                    {"available", capability.available}});
  return json;
}

void print(const gpu::DeviceInfo& info) {
  std::cout << fmt::format("{}: {} ({})\n   {}, Vulkan {}, {:.1f} GiB: {}\n", info.index, info.name,
                           info.type, info.driver, info.api_version,
                           static_cast<double>(info.memory_bytes) / (1u << 30),
                           info.usable() ? "greatx runs here" : "greatx cannot run here");
  for (const gpu::Capability& capability : info.capabilities)
    std::cout << fmt::format("     {:<4} {:<45} {}\n", capability.available ? "yes" : "NO", capability.name,
                             capability.used_for);
}

}  // namespace

void add_info(CLI::App& app) {
  CLI::App* command = app.add_subcommand("info", "list the Vulkan devices and what each can and cannot do");
  auto as_json = std::make_shared<bool>(false);
  command->add_flag("--json", *as_json, "print one JSON object");
  command->callback([as_json] {
    const std::vector<gpu::DeviceInfo> devices = gpu::list_devices();
    if (*as_json) {
      nlohmann::json json{{"greatx", GREATX_VERSION}, {"devices", nlohmann::json::array()}};
      for (const gpu::DeviceInfo& info : devices) json["devices"].push_back(json_of(info));
      std::cout << json_text(json) << '\n';
      return;
    }
    for (const gpu::DeviceInfo& info : devices) print(info);
  });
}

}  // namespace greatx::apps
