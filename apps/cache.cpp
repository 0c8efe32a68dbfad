// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "apps/commands.h"
#include "apps/console/json_text.h"
#include "core/cache_folder.h"
#include "rf/search/search_cache.h"

namespace greatx::apps {
namespace {

struct CacheOptions {
  bool clear = false, json = false;
};

void run_cache(const CacheOptions& options) {
  const rf::SearchCache cache = rf::SearchCache::standard();
  if (cache.folder().empty()) {
    if (options.json)
      std::cout << json_text(nlohmann::json{{"folder", nullptr}}) << '\n';
    else
      std::cout << "there is no cache: GREATX_CACHE is off, or there is no home folder\n";
    return;
  }
  const rf::SearchCache::Size removed = options.clear ? cache.clear() : rf::SearchCache::Size{};
  const rf::SearchCache::Size size = cache.size();
  if (options.json) {
    nlohmann::json json{{"folder", cache.folder().string()},
                        {"results", size.results},
                        {"bytes", size.bytes},
                        {"most_bytes", cache.most_bytes()}};
    if (options.clear) json["removed"] = {{"results", removed.results}, {"bytes", removed.bytes}};
    std::cout << json_text(json) << '\n';
    return;
  }
  const auto mib = [](uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); };
  if (options.clear)
    std::cout << fmt::format("{}: {} searches removed, {:.1f} MiB\n", cache.folder().string(),
                             removed.results, mib(removed.bytes));
  else
    std::cout << fmt::format("{}: {} searches, {:.1f} MiB of at most {:.0f} (GREATX_CACHE_MIB)\n",
                             cache.folder().string(), size.results, mib(size.bytes), mib(cache.most_bytes()));
}

}  // namespace

void add_cache(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("cache", "say how large the cache of searches for paths is, or empty it");
  auto options = std::make_shared<CacheOptions>();
  command->add_flag("--clear", options->clear, "remove every search");
  command->add_flag("--json", options->json, "print one JSON object");
  command->callback([options] { run_cache(*options); });
}

}  // namespace greatx::apps
