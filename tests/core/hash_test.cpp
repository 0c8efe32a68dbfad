// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/hash.h"

#include <gtest/gtest.h>

namespace greatx {
namespace {

// test vectors of FIPS 180-4 (NIST, "SHA256ShortMsg")
TEST(Sha256, MatchesPublishedVectors) {
  EXPECT_EQ(Sha256().hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256().update("abc").hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, StreamsLikeOneBlock) {
  EXPECT_EQ(Sha256().update("a").update("bc").hex(), Sha256().update("abc").hex());
}

}  // namespace
}  // namespace greatx
