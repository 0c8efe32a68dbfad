// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/paths/output.h"

#include <cerrno>

#include <fmt/format.h>

#include "apps/paths/text.h"
#include "io/files/file.h"

namespace greatx::apps {

namespace {

using Json = nlohmann::ordered_json;

class JsonOutput : public PathsOutput {
 public:
  JsonOutput(std::ostream& out, const PathScene& scene) : out_(out), scene_(scene) {}

  void begin(const Json& head) override {
    out_ << "{\n";
    members(head);
    out_ << "\"receivers\": [";
  }
  void add(const PathLink& link) override {
    out_ << (first_ ? "\n" : ",\n") << json_of(link, scene_).dump();
    first_ = false;
  }
  void end(const Json& tail) override {
    out_ << "\n],\n";
    for (auto member = tail.begin(); member != tail.end(); ++member)
      out_ << Json(member.key()).dump() << ": " << member.value().dump()
           << (std::next(member) == tail.end() ? "\n" : ",\n");
    out_ << "}\n";
  }

 private:
  void members(const Json& json) {
    for (const auto& [key, value] : json.items())
      out_ << Json(key).dump() << ": " << value.dump(-1, ' ', false, Json::error_handler_t::replace) << ",\n";
  }
  std::ostream& out_;
  PathScene scene_;
  bool first_ = true;
};

class JsonLinesOutput : public PathsOutput {
 public:
  JsonLinesOutput(std::ostream& out, const PathScene& scene) : out_(out), scene_(scene) {}
  void begin(const Json& head) override { line("head", head); }
  void add(const PathLink& link) override { line("receiver", json_of(link, scene_)); }
  void end(const Json& tail) override { line("totals", tail); }

 private:
  void line(const char* kind, const Json& json) {
    Json object{{"kind", kind}};
    object.update(json);
    out_ << object.dump() << '\n';
  }
  std::ostream& out_;
  PathScene scene_;
};

class TableOutput : public PathsOutput {
 public:
  TableOutput(std::ostream& out, const PathScene& scene, bool brief)
      : out_(out), scene_(scene), brief_(brief) {}
  void begin(const Json&) override {
    if (brief_) out_ << brief_head();
  }
  void add(const PathLink& link) override {
    if (brief_)
      out_ << brief_row(link, scene_.carrier_hz);
    else
      out_ << table_of(link, scene_) << '\n';
  }

 private:
  std::ostream& out_;
  PathScene scene_;
  bool brief_;
};

class CsvOutput : public PathsOutput {
 public:
  CsvOutput(std::filesystem::path file, const PathScene& scene) : file_(std::move(file)), scene_(scene) {
    io::create_folder_of(file_);
    out_.open(io::part_name(file_), std::ios::binary | std::ios::trunc);
    out_ << csv_head(scene_);
    check();
  }
  ~CsvOutput() override {
    if (finished_) return;
    std::error_code ignored;
    std::filesystem::remove(io::part_name(file_), ignored);
  }
  void add(const PathLink& link) override {
    out_ << csv_row(link, scene_);
    check();
  }
  void end(const Json&) override {
    out_.close();
    check();
    io::rename_file(io::part_name(file_), file_);
    finished_ = true;
  }

 private:
  void check() const {
    if (!out_) throw io::WriteError(file_, errno);
  }
  std::filesystem::path file_;
  std::ofstream out_;
  PathScene scene_;
  bool finished_ = false;
};

}  // namespace

void PathTotals::add(const LinkFigures& figures) {
  ++receivers;
  paths += figures.paths;
  with_line_of_sight += figures.line_of_sight ? 1 : 0;
  without_path += figures.paths == 0 ? 1 : 0;
  for (size_t i = 0; i < kinds.size(); ++i) kinds[i] += figures.kinds[i];
}

Json PathTotals::json() const {
  Json json{{"receivers", receivers},
            {"paths", paths},
            {"with_line_of_sight", with_line_of_sight},
            {"without_path", without_path},
            {"paths_by_kind", Json::object()}};
  for (size_t i = 0; i < kinds.size(); ++i) json["paths_by_kind"][kind_name(path_kinds[i])] = kinds[i];
  return json;
}

std::string PathTotals::text() const {
  const auto count = [](size_t number, const char* what) {
    return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
  };
  std::string text = count(receivers, "receiver") + ", " + count(paths, "path");
  const char* before = " (";
  for (size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i] == 0) continue;
    text += fmt::format("{}{} {}", before, kind_name(path_kinds[i]), kinds[i]);
    before = ", ";
  }
  if (paths > 0) text += ")";
  if (without_path > 0) text += fmt::format(", {} without any", count(without_path, "receiver"));
  return text;
}

std::unique_ptr<PathsOutput> json_output(std::ostream& out, const PathScene& scene) {
  return std::make_unique<JsonOutput>(out, scene);
}

std::unique_ptr<PathsOutput> json_lines_output(std::ostream& out, const PathScene& scene) {
  return std::make_unique<JsonLinesOutput>(out, scene);
}

std::unique_ptr<PathsOutput> table_output(std::ostream& out, const PathScene& scene, bool brief) {
  return std::make_unique<TableOutput>(out, scene, brief);
}

std::unique_ptr<PathsOutput> csv_output(const std::filesystem::path& file, const PathScene& scene) {
  return std::make_unique<CsvOutput>(file, scene);
}

}  // namespace greatx::apps
