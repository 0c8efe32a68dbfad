// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/budget.h"

#include <fstream>
#include <sys/stat.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/input_file.h"
#include "tests/support/temporary_folder.h"

namespace greatx {
namespace {

using testing::HasSubstr;

std::string budget_message(const auto& call) {
  try {
    call();
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Budget, ProductsAndSumsStayAtTheTop) {
  EXPECT_EQ(saturating_product({3, 5, 7}), 105u);
  EXPECT_EQ(saturating_product({uint64_t{1} << 40, uint64_t{1} << 40}), UINT64_MAX);
  EXPECT_EQ(saturating_product({uint64_t{1} << 40, uint64_t{1} << 40, 0}), 0u);
  EXPECT_EQ(saturating_sum(UINT64_MAX - 1, 1), UINT64_MAX);
  EXPECT_EQ(saturating_sum(UINT64_MAX - 1, 2), UINT64_MAX);
}

TEST(Budget, TheMessageSaysWhereWhatAndHowMuch) {
  const Budget budget{"a thing", 2 * budget::gib};
  EXPECT_NO_THROW(require_within("x.glb: mesh 'm'", 2 * budget::gib, budget));
  EXPECT_EQ(budget_message([&] { require_within("x.glb: mesh 'm'", 3 * budget::gib, budget); }),
            "x.glb: mesh 'm': expected at most 2 GiB for a thing (docs/limits.md), found 3 GiB");
  const Budget values{"a list", 10, "values"};
  EXPECT_EQ(budget_message([&] { require_within("x.yaml:3", UINT64_MAX, values); }),
            "x.yaml:3: expected at most 10 values for a list (docs/limits.md), found more than "
            "18446744073709551615 values");
}

TEST(Budget, SharesAreSummed) {
  Spending spending({"things", 10, "values"});
  spending.plan("a", 6);
  EXPECT_THAT(budget_message([&] { spending.plan("b", 5); }), HasSubstr("b: expected at most 10 values"));
  EXPECT_THAT(budget_message([&] { spending.plan("c", UINT64_MAX); }), HasSubstr("c: expected"));
}

TEST(InputFile, ReadsWhatIsRegularAndWithinItsBudget) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "a.txt";
  std::ofstream(path) << "hello";
  const Budget budget{"a file", 5};
  EXPECT_EQ(InputFile(path, "text", budget).text(), "hello");
  std::ofstream(path) << "hello!";
  EXPECT_THAT(
      budget_message([&] { InputFile(path, "text", budget); }),
      testing::AllOf(HasSubstr("text: file '" + path.string()), HasSubstr("5 bytes"), HasSubstr("found 6")));
  EXPECT_THAT(budget_message([&] { InputFile(folder.path(), "text", budget); }),
              HasSubstr("not a regular file"));
  EXPECT_THAT(budget_message([&] { InputFile(folder.path() / "b", "text", budget); }),
              HasSubstr("does not exist"));
}

TEST(InputFile, APipeIsRefusedAndNotWaitedFor) {
  const test::TemporaryFolder folder;
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(budget_message([&] { InputFile(pipe, "text", budget::csv_file); }),
              HasSubstr("not a regular file"));
}

TEST(InputFile, ASparseFileOfAHundredGibibytesIsRefusedBeforeItIsRead) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "sparse.csv";
  std::ofstream(path) << "x";
  std::error_code error;
  std::filesystem::resize_file(path, 100 * budget::gib, error);
  if (error) GTEST_SKIP() << "this file system has no sparse files: " << error.message();
  EXPECT_THAT(budget_message([&] { InputFile(path, "positions", budget::csv_file); }),
              testing::AllOf(HasSubstr("sparse.csv"), HasSubstr("256 MiB"), HasSubstr("100 GiB")));
}

/// docs/limits.md must state each of the limits.
TEST(Budget, TheDocumentSaysTheSame) {
  std::ifstream file(GREATX_LIMITS);
  const std::string document((std::istreambuf_iterator<char>(file)), {});
  ASSERT_FALSE(document.empty());
  for (const Budget& budget :
       {budget::yaml_file, budget::yaml_values, budget::csv_file, budget::model_file, budget::model_json,
        budget::model_externals, budget::import_xml, budget::model_geometry, budget::model_zeros,
        budget::model_textures, budget::scene_textures, budget::scene_triangles, budget::scene_vertices,
        budget::import_geometry, budget::element_pairs, budget::channel_record})
    EXPECT_THAT(document, HasSubstr(fmt::format("| {} | {} |", budget.what, amount(budget.most, budget))));
}

}  // namespace
}  // namespace greatx
