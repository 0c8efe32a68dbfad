// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Points with properties, one behind the other, as PLY and PCD have them after their headers.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

struct VertexProperty {
  std::string name;
  DType dtype;
};

/// arrays[0] f32 [n, 4] gives the properties x, y, z, intensity, every other array [n] that of its name.
/// ContractError for other shapes.
std::vector<VertexProperty> vertex_properties(const std::vector<std::string>& names,
                                              const std::vector<const Array*>& arrays);
/// `header` and the rows of those arrays behind it.
Bytes with_vertex_rows(const std::string& header, const std::vector<const Array*>& arrays);
/// The columns of `count` rows; `data` holds exactly these.
std::map<std::string, Array> vertex_columns(const std::vector<VertexProperty>& properties, size_t count,
                                            std::span<const std::byte> data);
size_t row_bytes(const std::vector<VertexProperty>& properties);

/// The text of a file before `end_mark`, which stands within the first 64 KiB; empty if it does not.
std::optional<std::string_view> text_header(std::span<const std::byte> file, std::string_view end_mark);

}  // namespace greatx::io
