// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Gives each file of the corpus to its target, whole, and cut and changed in a fixed way. What libFuzzer has
// found is in the corpus under the name of its fault.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/fuzz/targets/targets.h"

namespace greatx::fuzz {
namespace {

namespace fs = std::filesystem;

class FuzzTargets : public testing::TestWithParam<size_t> {};

TEST_P(FuzzTargets, TakeOrRefuseTheCorpus) {
  const Target& target = targets()[GetParam()];
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(GREATX_FUZZ_CORPUS) / target.name))
    files.push_back(entry.path());
  ASSERT_FALSE(files.empty()) << target.name << " has no corpus";
  std::sort(files.begin(), files.end());
  run(target, nullptr, 0);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.string());
    std::ifstream in(file, std::ios::binary);
    const std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NO_THROW(run(target, bytes.data(), bytes.size()));
    RandomStream random(1, static_cast<uint32_t>(bytes.size()));
    for (int i = 0; i < 40 && !bytes.empty(); ++i) {
      std::vector<uint8_t> damaged = bytes;
      for (uint32_t change = 0; change <= random.below(3); ++change)
        damaged[random.below(static_cast<uint32_t>(damaged.size()))] = static_cast<uint8_t>(random.bits());
      if (i % 4 == 0) damaged.resize(random.below(static_cast<uint32_t>(damaged.size())));
      EXPECT_NO_THROW(run(target, damaged.data(), damaged.size())) << "damage " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, FuzzTargets, testing::Range<size_t>(0, targets().size()),
                         [](const auto& test) { return std::string(targets()[test.param].name); });

}  // namespace
}  // namespace greatx::fuzz
