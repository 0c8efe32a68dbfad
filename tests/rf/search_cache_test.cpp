// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/search_cache.h"

#include <cstdlib>
#include <fstream>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/wedges.h"
#include "tests/rf/search_scenes.h"
#include "tests/support/temporary_folder.h"

namespace greatx::rf {
namespace {

namespace fs = std::filesystem;
using rf::testing::SearchScene;

/// A folder of its own, and a result with windows, wedges and beams.
class SearchCacheTest : public ::testing::Test {
 protected:
  void SetUp() override {
    scene_.hand.ground(30.0);
    scene_.box({0, 0, 0}, {6, 5, 4});
    scene_.source = {-4.1, -3.3, 2.2};
    wedges_ = scene::find_wedges(scene_.scene());
    const FacetWorld world(scene_.scene());
    const FacetKinds kinds = scene_.facet_kinds();
    result_ = BeamSearch(world, kinds, wedges_, scene_.options()).search(scene_.source);
    ASSERT_FALSE(result_.list.windows.empty());
    ASSERT_FALSE(result_.list.wedges.empty());
  }

  std::string key() const { return key(scene_.options()); }
  std::string key(const BeamSearchOptions& options) const {
    return search_key("scene", scene_.facet_kinds(), wedges_, scene_.source, options);
  }
  fs::path file() const { return folder_ / "deeper" / (key() + ".beams"); }
  SearchCache cache() const { return SearchCache(folder_ / "deeper"); }

  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
  SearchScene scene_;
  std::vector<scene::Wedge> wedges_;
  BeamSearchResult result_;
};

TEST_F(SearchCacheTest, WhatIsStoredIsReadBackTheSame) {
  EXPECT_FALSE(cache().load(key()).has_value()) << "nothing there yet";
  cache().store(key(), result_);
  const auto back = cache().load(key());
  ASSERT_TRUE(back.has_value());
  EXPECT_TRUE(back->list == result_.list);
  EXPECT_EQ(back->found, result_.found);
  ASSERT_EQ(back->beams.size(), result_.beams.size());
  for (size_t i = 0; i < result_.beams.size(); ++i) {
    const SequenceBeam &a = result_.beams[i], &b = back->beams[i];
    EXPECT_TRUE(a.image == b.image && a.center == b.center && a.half_a == b.half_a && a.half_b == b.half_b &&
                a.walls == b.walls)
        << i;
  }
  // No draft is left behind; storing again replaces.
  cache().store(key(), result_);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "deeper"), fs::directory_iterator()), 1);
}

TEST_F(SearchCacheTest, AnOverflowIsRemembered) {
  result_.found += 5;
  cache().store(key(), result_);
  EXPECT_EQ(cache().load(key())->overflow(), 5u);
}

TEST_F(SearchCacheTest, DamagedAndTruncatedFilesAreAsGoodAsNone) {
  cache().store(key(), result_);
  std::ifstream in(file(), std::ios::binary);
  const std::string good((std::istreambuf_iterator<char>(in)), {});
  const auto with = [&](const std::string& bytes) {
    std::ofstream(file(), std::ios::binary | std::ios::trunc) << bytes;
    return cache().load(key()).has_value();
  };
  ASSERT_TRUE(with(good));
  for (size_t at : {size_t{0}, size_t{9}, good.size() / 2, good.size() - 65, good.size() - 1}) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 4);
    EXPECT_FALSE(with(bad)) << "byte " << at;
  }
  for (size_t length :
       {size_t{0}, size_t{1}, size_t{63}, size_t{64}, size_t{65}, good.size() / 2, good.size() - 1})
    EXPECT_FALSE(with(good.substr(0, length))) << length << " bytes";
  EXPECT_FALSE(with(good + "more"));
  EXPECT_FALSE(with(std::string(1000, 'x')));
  // And it is replaced by the next search.
  cache().store(key(), result_);
  EXPECT_TRUE(cache().load(key()).has_value());
}

TEST_F(SearchCacheTest, WhateverChangesTheResultChangesTheKey) {
  std::vector<std::string> keys{key()};
  const BeamSearchOptions plain = scene_.options();
  BeamSearchOptions o = plain;
  o.max_depth = 4, keys.push_back(key(o)), o = plain;
  o.max_transmissions = 1, keys.push_back(key(o)), o = plain;
  o.capacity = 10, keys.push_back(key(o)), o = plain;
  o.source_body = 2, keys.push_back(key(o)), o = plain;
  o.clearance_m = 0.0, keys.push_back(key(o)), o = plain;
  o.stop_depth = 2, keys.push_back(key(o)), o = plain;
  FacetKinds kinds = scene_.facet_kinds();
  const auto add = [&](const std::string& scene, std::span<const scene::Wedge> wedges, const dvec3& source) {
    keys.push_back(search_key(scene, kinds, wedges, source, plain));
  };
  add("another", wedges_, scene_.source);
  add("scene", {}, scene_.source);
  add("scene", wedges_, scene_.source + dvec3(0, 0, 1e-15));
  const std::vector<scene::Wedge> free_edges = scene::find_wedges(scene_.scene(), {.free_edges = true});
  ASSERT_GT(free_edges.size(), wedges_.size());
  add("scene", free_edges, scene_.source);
  std::vector<scene::Wedge> shorter = wedges_;
  shorter[0].b = 0.5 * (shorter[0].a + shorter[0].b);
  add("scene", shorter, scene_.source);
  kinds[3] = FacetKind::wall;
  add("scene", wedges_, scene_.source);
  EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), keys.size());
  cache().store(key(), result_);
  for (size_t i = 1; i < keys.size(); ++i) EXPECT_FALSE(cache().load(keys[i]).has_value()) << i;
}

TEST_F(SearchCacheTest, ThreadsDoNotChangeTheKeyAndMovingBodiesHaveNone) {
  BeamSearchOptions options = scene_.options();
  options.threads = 2;
  EXPECT_EQ(key(options), key());
  options.moving_bodies = true;
  EXPECT_THROW(key(options), ContractError);
}

TEST_F(SearchCacheTest, AFolderThatCannotBeWrittenIsNoError) {
  std::ofstream(folder_ / "file") << "not a folder";
  const SearchCache blocked(folder_ / "file" / "cache");
  EXPECT_NO_THROW(blocked.store(key(), result_));
  EXPECT_FALSE(blocked.load(key()).has_value());
  // Where permissions hold (not for root): a folder that is there but read-only.
  fs::create_directory(folder_ / "locked");
  fs::permissions(folder_ / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_NO_THROW(SearchCache(folder_ / "locked").store(key(), result_));
  fs::permissions(folder_ / "locked", fs::perms::owner_all);
}

TEST_F(SearchCacheTest, TheEnvironmentChoosesTheFolder) {
  const auto with = [](const char* own, const char* shared, const char* home) {
    const auto set = [](const char* name, const char* value) {
      value == nullptr ? unsetenv(name) : setenv(name, value, 1);
    };
    set("GREATX_CACHE", own), set("XDG_CACHE_HOME", shared), set("HOME", home);
    return SearchCache::standard().folder().string();
  };
  std::optional<std::string> before[3];
  const char* names[] = {"GREATX_CACHE", "XDG_CACHE_HOME", "HOME"};
  for (int i = 0; i < 3; ++i)
    if (const char* value = std::getenv(names[i])) before[i] = value;
  EXPECT_EQ(with("off", "/x", "/h"), "");
  EXPECT_EQ(with("/own", "/x", "/h"), "/own");
  EXPECT_EQ(with(nullptr, "/x", "/h"), "/x/greatx");
  EXPECT_EQ(with("", "", "/h"), "/h/.cache/greatx");
  EXPECT_EQ(with(nullptr, nullptr, nullptr), "");
  for (int i = 0; i < 3; ++i) before[i] ? setenv(names[i], before[i]->c_str(), 1) : unsetenv(names[i]);
  SearchCache({}).store("key", result_);
  EXPECT_FALSE(SearchCache({}).load("key").has_value());
}

}  // namespace
}  // namespace greatx::rf
