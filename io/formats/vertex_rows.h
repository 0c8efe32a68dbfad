// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Packs and unpacks points with properties as consecutive rows, which PLY and PCD hold after their headers.
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

/// Returns the properties of the arrays: x, y, z, intensity for arrays[0], f32 [n, 4], and one property for
/// every other array [n]. Throws ContractError for other shapes.
std::vector<VertexProperty> vertex_properties(const std::vector<std::string>& names,
                                              const std::vector<const Array*>& arrays);
/// Returns `header`, followed by the rows of the arrays.
Bytes with_vertex_rows(const std::string& header, const std::vector<const Array*>& arrays);
/// Returns the columns of `count` rows by name. `data` must hold exactly these rows.
std::map<std::string, Array> vertex_columns(const std::vector<VertexProperty>& properties, size_t count,
                                            std::span<const std::byte> data);
size_t row_bytes(const std::vector<VertexProperty>& properties);

/// Returns the text of a file before `end_mark`, or nullopt if the mark is not within the first 64 KiB.
std::optional<std::string_view> text_header(std::span<const std::byte> file, std::string_view end_mark);

}  // namespace greatx::io
