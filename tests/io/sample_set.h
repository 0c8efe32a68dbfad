// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A test that has the sample run (sample_run.h) on disk.
#pragma once

#include <filesystem>

#include <gtest/gtest.h>

#include "tests/io/sample_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {

class SampleSet : public testing::Test {
 protected:
  void SetUp() override {
    DatasetWriter writer(set_, sample_info());
    ASSERT_TRUE(write_sample_run(writer, sample_info()));
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path set_ = folder_.path() / "set";
};

}  // namespace greatx::io
