// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <fmt/ranges.h>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

/// Before room is made for a decoded picture, whose header may say anything: throws UserError unless its
/// shape is the expected one (negative extents: any; empty: any shape) and takes no more than largest_read
/// bytes.
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
