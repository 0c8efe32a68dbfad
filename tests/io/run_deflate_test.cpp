// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/run_deflate.h"

#include <zlib.h>

#include <gtest/gtest.h>
#include <libdeflate.h>

#include "core/error.h"
#include "core/random.h"

namespace greatx::io {
namespace {

Bytes packed(const Bytes& bytes, size_t period) {
  Bytes out(3);  // the packed bytes are appended
  append_run_deflated(bytes, period, out);
  out.erase(out.begin(), out.begin() + 3);
  return out;
}

/// Requires that zlib and libdeflate give the bytes back.
void expect_back(const Bytes& bytes, const std::string& what) {
  for (size_t period = 1; period <= 4; ++period) {
    const Bytes file = packed(bytes, period);
    Bytes back(bytes.size() + 1);
    uLongf size = back.size();
    ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(back.data()), &size,
                         reinterpret_cast<const Bytef*>(file.data()), file.size()),
              Z_OK)
        << what << ", period " << period;
    back.resize(size);
    ASSERT_EQ(back, bytes) << what << ", period " << period;
    libdeflate_decompressor* const other = libdeflate_alloc_decompressor();
    Bytes again(bytes.size());
    const libdeflate_result result =
        libdeflate_zlib_decompress(other, file.data(), file.size(), again.data(), again.size(), nullptr);
    libdeflate_free_decompressor(other);
    ASSERT_EQ(result, LIBDEFLATE_SUCCESS) << what << ", period " << period;
    ASSERT_EQ(again, bytes) << what << ", period " << period;
  }
}

template <typename Value>
Bytes bytes_where(size_t size, Value&& value) {
  Bytes bytes(size);
  for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(value(i));
  return bytes;
}

TEST(RunDeflate, DecodersGiveEverySmallSizeBack) {
  RandomStream random(3, 1);
  for (size_t size = 0; size < 70; ++size) {
    expect_back(Bytes(size), fmt::format("{} zeros", size));
    expect_back(bytes_where(size, [&](size_t) { return random.below(256); }), fmt::format("{} random", size));
    expect_back(bytes_where(size, [&](size_t i) { return i / 11; }), fmt::format("{} of runs", size));
  }
}

TEST(RunDeflate, DecodersGiveRunsOfEveryLengthBack) {
  // Runs of each length with a mark between them, at every offset from the words that are compared at once.
  for (size_t length = 1; length < 600; length = length * 9 / 8 + 1)
    for (size_t period = 1; period <= 4; ++period)
      expect_back(bytes_where(8 * (length + 3),
                              [&](size_t i) {
                                const size_t at = i % (length + 3);
                                return at < 3 ? 200 + i % 50 : i % period;
                              }),
                  fmt::format("runs of {} and of {}", length, period));
}

TEST(RunDeflate, DecodersGiveManyBlocksBack) {
  RandomStream random(5, 1);
  for (const size_t size : {65535u, 65536u, 65537u, 65540u, 131072u, 200001u}) {
    expect_back(bytes_where(size, [&](size_t) { return random.below(256); }), "random");
    expect_back(bytes_where(size, [&](size_t i) { return i % 97 < 60 ? 0u : random.below(8); }), "skewed");
    expect_back(Bytes(size), "zeros");
  }
}

TEST(RunDeflate, CodesStayShortWhereCountsGrowLikeFibonacci) {
  // Without a limit, the codes of these counts would have up to 21 bits.
  Bytes bytes;
  size_t count = 1, before = 1;
  for (unsigned symbol = 0; symbol < 22; ++symbol) {
    for (size_t i = 0; i < count; ++i) bytes.push_back(static_cast<std::byte>(7 * symbol));
    before = std::exchange(count, count + before);
  }
  RandomStream random(9, 1);
  for (size_t i = bytes.size(); i > 1; --i)
    std::swap(bytes[i - 1], bytes[random.below(static_cast<uint32_t>(i))]);
  expect_back(bytes, "Fibonacci");
}

TEST(RunDeflate, RunsAndSkewedValuesShrink) {
  EXPECT_LT(packed(Bytes(300'000), 1).size(), 1000u);
  const Bytes pixels = bytes_where(300'000, [](size_t i) { return 50 * (i % 3); });
  EXPECT_LT(packed(pixels, 3).size(), 1000u);
  RandomStream random(7, 1);
  const Bytes of_16 = bytes_where(300'000, [&](size_t) { return random.below(16); });
  EXPECT_LT(packed(of_16, 1).size(), 155'000u);  // 4 bits each
  const Bytes noise = bytes_where(300'000, [&](size_t) { return random.below(256); });
  EXPECT_LT(packed(noise, 1).size(), 303'000u);
}

TEST(RunDeflate, PeriodIsThatOfAPixel) {
  EXPECT_THROW(packed(Bytes(8), 0), ContractError);
  EXPECT_THROW(packed(Bytes(8), 5), ContractError);
}

}  // namespace
}  // namespace greatx::io
