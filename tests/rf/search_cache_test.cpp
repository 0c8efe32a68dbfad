// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/search_cache.h"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "rf/search/search_key.h"
#include "scene/description/wedges.h"
#include "tests/rf/search_scenes.h"
#include "tests/support/temporary_folder.h"

namespace greatx::rf {
namespace {

namespace fs = std::filesystem;
using rf::testing::SearchScene;

/// Provides a temporary folder and a search result with windows, wedges and beams.
class SearchCacheTest : public ::testing::Test {
 protected:
  void SetUp() override {
    scene_.hand.ground(30.0);
    scene_.box({0, 0, 0}, {6, 5, 4});
    scene_.source = {-4.1, -3.3, 2.2};
    wedges_ = scene::find_wedges(scene_.scene());
    const FacetWorld world(scene_.scene());
    extent_ = {world.facet_count(), static_cast<uint32_t>(wedges_.size())};
    const FacetKinds kinds = scene_.facet_kinds();
    result_ = BeamSearch(world, kinds, wedges_, scene_.options()).search(scene_.source);
    ASSERT_FALSE(result_.list.windows.empty());
    ASSERT_FALSE(result_.list.wedges.empty());
  }

  std::string key() const { return key(scene_.options()); }
  std::string key(const BeamSearchOptions& options) const {
    return search_key(FacetWorld(scene_.scene()), scene_.facet_kinds(), wedges_, scene_.source, options);
  }
  fs::path file() const { return folder_ / "deeper" / (key() + ".beams"); }
  /// Returns a key that consists of 64 times the same letter.
  std::string other_key(char letter) const { return std::string(64, letter); }
  fs::path file(const std::string& key) const { return folder_ / "deeper" / (key + ".beams"); }
  SearchCache cache() const { return SearchCache(folder_ / "deeper"); }

  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
  SearchScene scene_;
  std::vector<scene::Wedge> wedges_;
  BeamSearchResult result_;
  SearchExtent extent_;
};

TEST_F(SearchCacheTest, WhatIsStoredIsReadBackTheSame) {
  EXPECT_FALSE(cache().load(key(), extent_).has_value()) << "nothing there yet";
  cache().store(key(), result_);
  const auto back = cache().load(key(), extent_);
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
  // No draft remains; storing again replaces the file.
  cache().store(key(), result_);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "deeper"), fs::directory_iterator()), 1);
}

TEST_F(SearchCacheTest, AnOverflowIsRemembered) {
  result_.found += 5;
  cache().store(key(), result_);
  EXPECT_EQ(cache().load(key(), extent_)->overflow(), 5u);
}

TEST_F(SearchCacheTest, DamagedAndTruncatedFilesAreAsGoodAsNone) {
  cache().store(key(), result_);
  std::ifstream in(file(), std::ios::binary);
  const std::string good((std::istreambuf_iterator<char>(in)), {});
  const auto with = [&](const std::string& bytes) {
    std::ofstream(file(), std::ios::binary | std::ios::trunc) << bytes;
    return cache().load(key(), extent_).has_value();
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
  // The next search replaces the file.
  cache().store(key(), result_);
  EXPECT_TRUE(cache().load(key(), extent_).has_value());
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
  const FacetWorld world(scene_.scene());
  const auto add = [&](const FacetWorld& of, std::span<const scene::Wedge> wedges, const dvec3& source) {
    keys.push_back(search_key(of, kinds, wedges, source, plain));
  };
  scene::Scene moved = scene_.scene();  // moves a corner of a wall by a millimetre
  moved.facet_triangles.back().corners[1].x += 1e-3;
  add(FacetWorld(moved), wedges_, scene_.source);
  add(world, {}, scene_.source);
  add(world, wedges_, scene_.source + dvec3(0, 0, 1e-15));
  const std::vector<scene::Wedge> free_edges = scene::find_wedges(scene_.scene(), {.free_edges = true});
  ASSERT_GT(free_edges.size(), wedges_.size());
  add(world, free_edges, scene_.source);
  std::vector<scene::Wedge> shorter = wedges_;
  shorter[0].b = 0.5 * (shorter[0].a + shorter[0].b);
  add(world, shorter, scene_.source);
  for (const FacetKind kind : {FacetKind::wall, FacetKind::foliage}) {
    kinds[3] = kind;
    add(world, wedges_, scene_.source);
  }
  EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), keys.size());
  cache().store(key(), result_);
  for (size_t i = 1; i < keys.size(); ++i) EXPECT_FALSE(cache().load(keys[i], extent_).has_value()) << i;
}

TEST_F(SearchCacheTest, WhatMovesIsNotInTheKey) {
  const auto with_drone = [&](const dvec3& size, FacetKind kind, const dvec3& at) {
    SearchScene scene;
    scene.hand.ground(30.0);
    scene.box({0, 0, 0}, {6, 5, 4});
    const size_t still = scene.scene().facets.size();
    if (size != dvec3(0.0)) {
      const uint32_t drone = scene.hand.body();
      scene.hand.quad({0, 0, 0}, {size.x, 0, 0}, {size.x, size.y, 0}, {0, size.y, 0}, 0, drone);
      scene.hand.quad({0, 0, 0}, {size.x, 0, 0}, {size.x, 0, size.z}, {0, 0, size.z}, 0, drone);
    }
    FacetWorld world(scene.scene());
    if (size != dvec3(0.0)) world.move(1, {Pose{at, dquat(1, 0, 0, 0)}, {}, {}});
    FacetKinds kinds = scene.facet_kinds();
    for (size_t i = still; i < kinds.size(); ++i) kinds[i] = kind;
    return search_key(world, kinds, scene::find_wedges(scene.scene()), {-4.1, -3.3, 2.2}, scene_.options());
  };
  const std::string none = with_drone(dvec3(0.0), FacetKind::opaque, {});
  EXPECT_EQ(none, key());
  EXPECT_EQ(with_drone({1, 1, 0.3}, FacetKind::opaque, {}), none);
  EXPECT_EQ(with_drone({2, 1, 0.5}, FacetKind::opaque, {}), none) << "another drone";
  EXPECT_EQ(with_drone({1, 1, 0.3}, FacetKind::wall, {}), none) << "of another material";
  EXPECT_EQ(with_drone({1, 1, 0.3}, FacetKind::opaque, {3, 4, 5}), none) << "elsewhere";
}

TEST_F(SearchCacheTest, WhatIsNoFileOfItsKeyIsReplaced) {
  const auto good = [&] {
    cache().store(key(), result_);
    return cache().load(key(), extent_).has_value();
  };
  ASSERT_TRUE(good());
  // The file belongs to another key, although it is complete.
  fs::rename(file(), file(other_key('a')));
  EXPECT_FALSE(cache().load(other_key('a'), extent_).has_value());
  // The file is complete, but belongs to a scene with more facets or wedges.
  ASSERT_TRUE(good());
  EXPECT_FALSE(cache().load(key(), {extent_.facets - 1, extent_.wedges}).has_value());
  EXPECT_FALSE(cache().load(key(), {extent_.facets, extent_.wedges - 1}).has_value());
  // A pipe without a writer, and a link to itself.
  fs::remove(file());
  ASSERT_EQ(mkfifo(file().c_str(), 0600), 0);
  EXPECT_FALSE(cache().load(key(), extent_).has_value());
  EXPECT_TRUE(good());
  fs::remove(file());
  fs::create_symlink(file().filename(), file());
  EXPECT_FALSE(cache().load(key(), extent_).has_value());
  EXPECT_TRUE(good());
  // A folder is not a file of the cache and remains, empty or not. The run continues without the cache.
  fs::remove(file());
  fs::create_directories(file() / "inner");
  EXPECT_FALSE(cache().load(key(), extent_).has_value());
  EXPECT_NO_THROW(cache().store(key(), result_));
  EXPECT_TRUE(fs::exists(file() / "inner"));
  EXPECT_FALSE(cache().load(key(), extent_).has_value());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "deeper"), fs::directory_iterator()), 2)
      << "the folder and the file of another key: no draft is left";
}

TEST_F(SearchCacheTest, WhatWasNotUsedForLongestGoes) {
  cache().store(key(), result_);
  const uint64_t one = fs::file_size(file());
  const SearchCache small(folder_ / "deeper", 3 * one);
  const auto used = [&](char letter, int minutes_ago) {
    fs::last_write_time(file(other_key(letter)),
                        fs::file_time_type::clock::now() - std::chrono::minutes(minutes_ago));
  };
  fs::remove(file());
  for (const char letter : {'a', 'b', 'c'}) small.store(other_key(letter), result_);
  used('a', 30), used('b', 20), used('c', 10);
  // Other files do not count and are not touched, nor is a draft that a process may be writing.
  std::ofstream(folder_ / "deeper" / "notes.beams") << std::string(4 * one, 'x');
  std::ofstream(folder_ / "deeper" / "thesis.tmp") << "mine";
  fs::last_write_time(folder_ / "deeper" / "thesis.tmp", fs::file_time_type{});
  std::ofstream(folder_ / "deeper" / (other_key('d') + ".7.tmp")) << "being written";
  std::ofstream(folder_ / "deeper" / (other_key('e') + ".7.tmp")) << "left by one that was killed";
  fs::last_write_time(folder_ / "deeper" / (other_key('e') + ".7.tmp"),
                      fs::file_time_type::clock::now() - std::chrono::hours(2));
  EXPECT_TRUE(small.load(other_key('a'), extent_).has_value()) << "now b is the oldest";
  small.store(other_key('f'), result_);
  EXPECT_TRUE(fs::exists(file(other_key('a'))));
  EXPECT_FALSE(fs::exists(file(other_key('b'))));
  EXPECT_TRUE(fs::exists(file(other_key('c'))));
  EXPECT_TRUE(fs::exists(file(other_key('f'))));
  EXPECT_TRUE(fs::exists(folder_ / "deeper" / "notes.beams"));
  EXPECT_TRUE(fs::exists(folder_ / "deeper" / "thesis.tmp"));
  EXPECT_TRUE(fs::exists(folder_ / "deeper" / (other_key('d') + ".7.tmp")));
  EXPECT_FALSE(fs::exists(folder_ / "deeper" / (other_key('e') + ".7.tmp")));
  // A result that alone exceeds the limit does not displace others.
  const SearchCache tiny(folder_ / "deeper", one - 1);
  tiny.store(other_key('0'), result_);
  EXPECT_FALSE(fs::exists(file(other_key('0'))));
  EXPECT_TRUE(fs::exists(file(other_key('f'))));
}

TEST_F(SearchCacheTest, SeveralProcessesShareAFolder) {
  cache().store(other_key('0'), result_);
  const uint64_t one = fs::file_size(file(other_key('0')));
  const SearchCache small(folder_ / "deeper", 4 * one + one / 2);
  std::vector<pid_t> children;
  for (int child = 0; child < 3; ++child) {
    children.push_back(fork());
    if (children.back() != 0) continue;
    bool whole = true;
    for (int i = 0; i < 60; ++i) {
      const std::string shared = other_key("0123456789"[(i + child) % 10]);
      small.store(shared, result_);
      if (const auto back = small.load(shared, extent_)) whole = whole && back->list == result_.list;
    }
    _exit(whole ? 0 : 1);
  }
  for (const pid_t child : children) {
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  small.store(other_key('a'), result_);
  uint64_t total = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "deeper")) {
    total += entry.file_size();
    EXPECT_EQ(entry.path().extension(), ".beams");
    EXPECT_TRUE(small.load(entry.path().stem().string(), extent_).has_value());
  }
  EXPECT_LE(total, small.most_bytes());
  EXPECT_GE(total, one);
}

TEST_F(SearchCacheTest, TheLimitIsTheEnvironments) {
  const char* value = std::getenv("GREATX_CACHE_MIB");
  const std::optional<std::string> before =
      value == nullptr ? std::nullopt : std::optional<std::string>(value);
  unsetenv("GREATX_CACHE_MIB");
  EXPECT_EQ(SearchCache::standard().most_bytes(), 512u << 20);
  setenv("GREATX_CACHE_MIB", "7", 1);
  EXPECT_EQ(SearchCache::standard().most_bytes(), 7u << 20);
  for (const char* bad : {"0", "-1", "1.5", "lots", "1 ", "99999999999999999999"}) {
    setenv("GREATX_CACHE_MIB", bad, 1);
    EXPECT_THROW(SearchCache::standard(), UserError) << bad;
  }
  before ? setenv("GREATX_CACHE_MIB", before->c_str(), 1) : unsetenv("GREATX_CACHE_MIB");
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
  EXPECT_FALSE(blocked.load(key(), extent_).has_value());
  // A folder that exists but is read-only, where permissions apply (not for root).
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
  EXPECT_FALSE(SearchCache({}).load("key", extent_).has_value());
}

}  // namespace
}  // namespace greatx::rf
