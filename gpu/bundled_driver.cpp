// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/bundled_driver.h"

#include <cstdlib>
#include <dlfcn.h>
#include <link.h>
#include <mutex>
#include <string>

#include <spdlog/spdlog.h>

namespace greatx::gpu {

namespace {

namespace fs = std::filesystem;

std::string variable(const char* name, const std::string& otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : otherwise;
}

void add_folders(std::vector<fs::path>& folders, const std::string& list) {
  for (size_t at = 0; at < list.size();) {
    const size_t colon = std::min(list.find(':', at), list.size());
    if (colon > at) folders.push_back(fs::path(list.substr(at, colon - at)) / "vulkan/icd.d");
    at = colon + 1;
  }
}

/// Returns the file of the program or library that holds this code.
fs::path own_file() {
  static const int here = 0;
  Dl_info info{};
  void* map = nullptr;
  std::error_code none;
  if (dladdr1(&here, &info, &map, RTLD_DL_LINKMAP) == 0) return {};
  const char* name = static_cast<const link_map*>(map)->l_name;
  // The loader knows the program itself by an empty name.
  return *name == '\0' ? fs::read_symlink("/proc/self/exe", none) : fs::absolute(name, none);
}

void add_driver() {
  if (std::getenv("VK_DRIVER_FILES") != nullptr || std::getenv("VK_ICD_FILENAMES") != nullptr) return;
  const fs::path driver = bundled_driver_of(own_file());
  if (driver.empty() || has_lavapipe(driver_folders())) return;
  const std::string others = variable("VK_ADD_DRIVER_FILES", "");
  setenv("VK_ADD_DRIVER_FILES", (others.empty() ? "" : others + ":").append(driver.string()).c_str(), 1);
  spdlog::debug("the drivers of this machine, and {}", driver.string());
}

}  // namespace

std::vector<fs::path> driver_folders() {
  std::vector<fs::path> folders;
  const std::string home = variable("HOME", "");
  add_folders(folders, variable("XDG_CONFIG_HOME", home.empty() ? "" : home + "/.config"));
  add_folders(folders, variable("XDG_CONFIG_DIRS", "/etc/xdg"));
  add_folders(folders, "/etc");
  add_folders(folders, variable("XDG_DATA_HOME", home.empty() ? "" : home + "/.local/share"));
  add_folders(folders, variable("XDG_DATA_DIRS", "/usr/local/share:/usr/share"));
  return folders;
}

bool has_lavapipe(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    std::error_code missing;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, missing)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("lvp_icd") && name.ends_with(".json")) return true;
    }
  }
  return false;
}

fs::path bundled_driver_of(const fs::path& file) {
  const fs::path above = file.parent_path().parent_path();
  for (const char* folder : {"vulkan", "greatx_engine/vulkan"}) {
    const fs::path driver = above / folder / "lavapipe.json";
    std::error_code missing;
    if (fs::is_regular_file(driver, missing)) return driver;
  }
  return {};
}

void offer_bundled_driver() {
  static std::once_flag once;
  std::call_once(once, add_driver);
}

}  // namespace greatx::gpu
