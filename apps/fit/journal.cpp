// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/fit/journal.h"

#include "core/error.h"
#include "io/files/file.h"
#include "io/files/same_request.h"
#include "io/files/untrusted_json.h"

namespace greatx::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* journal_file = "fit.part";
constexpr double any_number = 1e300;
constexpr int64_t most_count = 1'000'000'000;

std::vector<double> numbers(const io::JsonValue& value) {
  std::vector<double> all;
  for (const io::JsonValue& one : value.list(1u << 16)) all.push_back(one.number(-any_number, any_number));
  return all;
}

}  // namespace

FitJournal::FitJournal(const fs::path& folder, const Json& request, bool resume)
    : folder_(folder), request_(request) {
  io::create_folders(folder);
  const fs::path part = folder / journal_file, whole = folder / fit_description;
  const bool unfinished = fs::exists(part), complete = !unfinished && fs::exists(whole);
  if (!unfinished && !complete && !fs::is_empty(folder))
    throw_user_error("{}: expected a new or empty folder, or that of a fit, found '{}' in it",
                     folder.string(), fs::directory_iterator(folder)->path().filename().string());
  if (!unfinished && !complete) return;
  if (!resume)
    throw_user_error("{}: holds {} fit: choose another folder, or add --resume{}", folder.string(),
                     complete ? "a finished" : "an unfinished", complete ? "" : " to go on");
  const fs::path file = complete ? whole : part;
  const io::JsonDocument document(io::read_text_file(file, io::JsonLimits{}.bytes), {file.string(), 0});
  const io::JsonValue found = document.root().at("request");
  io::check_same_request(folder, "a fit", request, found.json());
  finished_ = complete;
  if (complete) return;
  const io::JsonValue state = document.root().at("state");
  sim::FitState read;
  const auto count = [&](const char* key) {
    return static_cast<uint32_t>(state.at(key).integer(0, most_count));
  };
  read.stage = static_cast<sim::FitStage>(state.at("stage").integer(0, 2));
  read.run = count("run"), read.round = count("round"), read.iteration = count("iteration");
  read.lambda = state.at("lambda").number(0.0, any_number);
  read.cost = state.at("cost").number(-any_number, any_number);
  read.converged = state.at("converged").boolean();
  read.done = state.at("done").boolean();
  read.coordinates = numbers(state.at("coordinates"));
  read.sigmas = numbers(state.at("sigmas"));
  read.before = numbers(state.at("before"));
  read.best_cost = state.at("best_cost").number(-any_number, any_number);
  read.best = numbers(state.at("best"));
  state_ = std::move(read);
}

void FitJournal::write(const sim::FitState& state) {
  const Json json{{"request", request_},
                  {"state",
                   {{"stage", static_cast<int>(state.stage)},
                    {"run", state.run},
                    {"round", state.round},
                    {"iteration", state.iteration},
                    {"lambda", state.lambda},
                    {"cost", state.cost},
                    {"converged", state.converged},
                    {"done", state.done},
                    {"coordinates", state.coordinates},
                    {"sigmas", state.sigmas},
                    {"before", state.before},
                    {"best_cost", state.best_cost},
                    {"best", state.best}}}};
  io::write_file_atomically(folder_ / journal_file, json.dump(1) + "\n");
}

void FitJournal::finish() { fs::remove(folder_ / journal_file); }

}  // namespace greatx::apps
