// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the shape that a picture's header states, before memory is allocated for the pixels.
#pragma once

#include <string>
#include <vector>

#include <fmt/ranges.h>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

/// Throws UserError unless the picture has the expected shape and takes at most largest_read bytes. A
/// negative extent in `expected` accepts any value, and an empty `expected` accepts any shape.
inline void check_picture_shape(const std::string& name, DType dtype, const std::vector<int64_t>& found,
                                const std::vector<int64_t>& expected) {
  bool fits = expected.empty() || expected.size() == found.size();
  uint64_t bytes = size_of(dtype);
  for (size_t axis = 0; axis < found.size(); ++axis) {
    if (fits && !expected.empty()) fits = expected[axis] < 0 || expected[axis] == found[axis];
    if (found[axis] < 1 ||
        __builtin_mul_overflow(bytes, static_cast<uint64_t>(std::max<int64_t>(1, found[axis])), &bytes))
      bytes = UINT64_MAX;
  }
  if (fits && bytes <= largest_read) return;
  if (expected.empty())
    throw_user_error("{}: expected a picture of at most {} bytes, found [{}]", name, largest_read,
                     fmt::join(found, ", "));
  throw_user_error("{}: expected {} [{}], found {} [{}]", name, numpy_name(dtype), fmt::join(expected, ", "),
                   numpy_name(dtype), fmt::join(found, ", "));
}

}  // namespace greatx::io
