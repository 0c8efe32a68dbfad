// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/record.h"

#include <functional>
#include <numeric>

namespace greatx {

namespace {
struct DTypeRow {
  DType dtype;
  size_t size;
  std::string_view numpy;
};
constexpr DTypeRow dtype_rows[] = {
    {DType::u8, 1, "|u1"},  {DType::u16, 2, "<u2"},       {DType::u32, 4, "<u4"}, {DType::u64, 8, "<u8"},
    {DType::i8, 1, "|i1"},  {DType::i32, 4, "<i4"},       {DType::i64, 8, "<i8"}, {DType::f32, 4, "<f4"},
    {DType::f64, 8, "<f8"}, {DType::complex64, 8, "<c8"},
};
const DTypeRow& row_of(DType dtype) { return dtype_rows[static_cast<size_t>(dtype)]; }
}  // namespace

size_t size_of(DType dtype) { return row_of(dtype).size; }
std::string_view numpy_name(DType dtype) { return row_of(dtype).numpy; }

Array::Array(DType dtype_, std::vector<int64_t> shape_) : dtype(dtype_), shape(std::move(shape_)) {
  bytes.resize(static_cast<size_t>(element_count()) * size_of(dtype));
}

int64_t Array::element_count() const {
  return std::accumulate(shape.begin(), shape.end(), int64_t{1}, std::multiplies<>());
}

}  // namespace greatx
