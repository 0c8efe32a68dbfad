// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/deflate.h"

#include <array>
#include <memory>

#include <libdeflate.h>

namespace greatx::io {

namespace {

constexpr size_t most_level = 12;

struct FreeCompressor {
  void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
};
using Compressor = std::unique_ptr<libdeflate_compressor, FreeCompressor>;

/// Returns the thread's own compressor of a level.
libdeflate_compressor* compressor_of(int level) {
  thread_local std::array<Compressor, most_level + 1> compressors;
  Compressor& compressor = compressors.at(static_cast<size_t>(level));
  if (!compressor) compressor.reset(libdeflate_alloc_compressor(level));
  GREATX_CHECK(compressor != nullptr, "libdeflate: no memory for level {}", level);
  return compressor.get();
}

}  // namespace

void append_deflated(std::span<const std::byte> bytes, int level, Bytes& out) {
  libdeflate_compressor* const compressor = compressor_of(level);
  const size_t begin = out.size(), most = libdeflate_zlib_compress_bound(compressor, bytes.size());
  out.resize(begin + most);
  const size_t size =
      libdeflate_zlib_compress(compressor, bytes.data(), bytes.size(), out.data() + begin, most);
  GREATX_CHECK(size > 0, "libdeflate: {} bytes", bytes.size());
  out.resize(begin + size);
}

bool inflate_exactly(std::span<const std::byte> packed, std::span<std::byte> to) {
  thread_local const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> state(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  GREATX_CHECK(state != nullptr, "libdeflate: no memory");
  size_t size = 0;
  return libdeflate_zlib_decompress(state.get(), packed.data(), packed.size(), to.data(), to.size(), &size) ==
             LIBDEFLATE_SUCCESS &&
         size == to.size();
}

}  // namespace greatx::io
