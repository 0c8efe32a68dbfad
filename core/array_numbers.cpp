// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/array_numbers.h"

namespace greatx {

double number_at(const Array& array, size_t i) {
  switch (array.dtype) {
    case DType::u8:
      return array.as<uint8_t>()[i];
    case DType::u16:
      return array.as<uint16_t>()[i];
    case DType::u32:
      return array.as<uint32_t>()[i];
    case DType::u64:
      return static_cast<double>(array.as<uint64_t>()[i]);
    case DType::i8:
      return array.as<int8_t>()[i];
    case DType::i32:
      return array.as<int32_t>()[i];
    case DType::i64:
      return static_cast<double>(array.as<int64_t>()[i]);
    case DType::f32:
      return static_cast<double>(array.as<float>()[i]);
    case DType::f64:
      return array.as<double>()[i];
    case DType::complex64:
      break;
  }
  GREATX_CHECK(false, "a number in an array of {}", numpy_name(array.dtype));
  return 0.0;
}

}  // namespace greatx
