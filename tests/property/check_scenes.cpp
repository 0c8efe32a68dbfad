// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/property/check_scenes.h"

#include <cstdlib>

#include <gtest/gtest.h>

namespace greatx::property {

namespace {

uint64_t number_of(const char* variable, uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

std::filesystem::path failures() {
  const char* folder = std::getenv("GREATX_PROPERTY_FOLDER");
  return folder != nullptr ? std::filesystem::path(folder)
                           : std::filesystem::temp_directory_path() / "greatx_property_failures";
}

}  // namespace

void check_scenes(const std::string& name, const Verdict& verdict, const std::vector<Form>& forms,
                  const std::function<void(DrawnCase&)>& prepare) {
  const uint64_t first = number_of("GREATX_PROPERTY_FIRST", 1),
                 count = number_of("GREATX_PROPERTY_SCENES", 4);
  for (uint64_t seed = first; seed < first + count; ++seed) {
    DrawnCase drawn = draw_case(seed);
    if (prepare) prepare(drawn);
    const std::optional<std::string> message = check_case(drawn, name, verdict, forms, failures());
    EXPECT_FALSE(message) << *message;
  }
}

}  // namespace greatx::property
