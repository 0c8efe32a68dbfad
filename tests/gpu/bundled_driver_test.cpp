// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/bundled_driver.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace greatx::gpu {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << "{}";
}

TEST(BundledDriver, LiesBesideTheFolderOfTheProgramOrOfTheModule) {
  const test::TemporaryFolder folder;
  const fs::path engine = folder.path() / "greatx_engine";
  EXPECT_TRUE(bundled_driver_of(engine / "bin/greatx").empty());
  write(engine / "vulkan/lavapipe.json");
  EXPECT_EQ(bundled_driver_of(engine / "bin/greatx"), engine / "vulkan/lavapipe.json");
  EXPECT_EQ(bundled_driver_of(folder.path() / "greatx/_native.so"), engine / "vulkan/lavapipe.json");
  EXPECT_TRUE(bundled_driver_of(folder.path() / "bin/deeper/greatx").empty());
}

TEST(BundledDriver, IsNotNeededWhereTheMachineHasALavapipe) {
  const test::TemporaryFolder folder;
  write(folder.path() / "gpu/vulkan/icd.d/radeon_icd.x86_64.json");
  EXPECT_FALSE(has_lavapipe({folder.path() / "gpu/vulkan/icd.d", folder.path() / "missing"}));
  write(folder.path() / "cpu/vulkan/icd.d/lvp_icd.x86_64.json");
  EXPECT_TRUE(has_lavapipe({folder.path() / "gpu/vulkan/icd.d", folder.path() / "cpu/vulkan/icd.d"}));
}

TEST(BundledDriver, FoldersAreThoseOfTheLoader) {
  const char* before = std::getenv("XDG_DATA_DIRS");
  const std::string kept = before == nullptr ? "" : before;
  setenv("XDG_DATA_DIRS", "/one::/two", 1);
  const std::vector<fs::path> folders = driver_folders();
  if (before == nullptr)
    unsetenv("XDG_DATA_DIRS");
  else
    setenv("XDG_DATA_DIRS", kept.c_str(), 1);
  const auto has = [&](const char* name) {
    return std::find(folders.begin(), folders.end(), fs::path(name)) != folders.end();
  };
  EXPECT_TRUE(has("/etc/vulkan/icd.d"));
  EXPECT_TRUE(has("/one/vulkan/icd.d"));
  EXPECT_TRUE(has("/two/vulkan/icd.d"));
  EXPECT_FALSE(has("/usr/share/vulkan/icd.d"));
}

}  // namespace
}  // namespace greatx::gpu
