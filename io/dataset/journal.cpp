// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/journal.h"

#include <algorithm>
#include <zlib.h>

#include <nlohmann/json.hpp>

#include "io/dataset/dataset_format.h"
#include "io/files/inside.h"
#include "io/files/untrusted_json.h"

namespace greatx::io {

using Json = nlohmann::ordered_json;

namespace {

constexpr size_t checksum_size = 9;  // a tab and eight hexadecimal digits

uint32_t crc(std::string_view text) {
  return static_cast<uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(text.data()), text.size()));
}
std::string sealed(const std::string& text) { return fmt::format("{}\t{:08x}\n", text, crc(text)); }

/// Bounds the lists of a line. No packet and no sequence has so many entries.
constexpr size_t most_files = 1 << 20;
constexpr int64_t largest_file = int64_t{1} << 60;

uint64_t size_from(const JsonValue& json) { return static_cast<uint64_t>(json.integer(0, largest_file)); }

JournalEnd end_from(const JsonValue& json) {
  JournalEnd end{static_cast<uint32_t>(json.at("end").integer(0, most_sequences - 1)), {}};
  for (const JsonValue& file : json.at("files").list(most_files)) {
    const std::vector<JsonValue> entry = file.tuple(3);
    end.files.push_back({path_from(entry[0]), size_from(entry[1]), sha256_from(entry[2])});
  }
  return end;
}

JournalPacket packet_from(const JsonValue& json) {
  const std::vector<JsonValue> head = json.at("packet").tuple(3);
  JournalPacket packet{static_cast<uint32_t>(head[0].integer(0, most_sequences - 1)),
                       head[1].integer(0, most_ticks),
                       head[2].integer(0, INT64_MAX),
                       {},
                       {}};
  for (const JsonValue& record : json.at("records").list(most_files)) {
    const std::vector<JsonValue> entry = record.tuple(2);
    packet.records.push_back(
        {static_cast<uint32_t>(entry[0].integer(0, INT32_MAX)), entry[1].integer(0, most_ticks)});
  }
  for (const JsonValue& file : json.at("files").list(most_files)) {
    const std::vector<JsonValue> entry = file.tuple(2);
    packet.frames.push_back({size_from(entry[0]), sha256_from(entry[1])});
  }
  return packet;
}

}  // namespace

std::string journal_line(const JournalPacket& packet) {
  std::string text =
      fmt::format(R"({{"packet":[{},{},{}],"records":[)", packet.sequence, packet.tick, packet.time_ns);
  for (size_t i = 0; i < packet.records.size(); ++i)
    text += fmt::format("{}[{},{}]", i == 0 ? "" : ",", packet.records[i].sensor, packet.records[i].sample);
  text += R"(],"files":[)";
  for (size_t i = 0; i < packet.frames.size(); ++i)
    text += fmt::format(R"({}[{},"{}"])", i == 0 ? "" : ",", packet.frames[i].size, packet.frames[i].sha256);
  return sealed(text + "]}");
}

std::string journal_line(const JournalEnd& end) {
  Json files = Json::array();
  for (const FileEntry& file : end.files) files.push_back({file.path, file.size, file.sha256});
  return sealed(Json({{"end", end.sequence}, {"files", std::move(files)}}).dump());
}

std::string path_from(const JsonValue& json) {
  std::string path = json.text();
  if (const std::string fault = fault_of_path(path); !fault.empty()) json.fail(fault);
  return path;
}

std::string sha256_from(const JsonValue& json) {
  std::string digest = json.text();
  const bool hex = std::all_of(digest.begin(), digest.end(),
                               [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
  if (digest.size() != 64 || !hex) json.fail("a SHA-256 of 64 hexadecimal digits");
  return digest;
}

std::vector<JournalEntry> parse_journal(const std::string& text, const std::string& name) {
  std::vector<JournalEntry> entries;
  int number = 0;
  for (size_t start = 0; start < text.size();) {
    const size_t end = text.find('\n', start);
    if (end == text.npos || end - start <= checksum_size) break;
    const std::string_view line(text.data() + start, end - start - checksum_size);
    const std::string_view checksum(text.data() + end - checksum_size, checksum_size);
    if (fmt::format("\t{:08x}", crc(line)) != checksum) break;
    const JsonDocument json(std::string(line), {name, ++number});
    JournalEntry& entry = entries.emplace_back();
    entry.end = end + 1;
    entry.line = number;
    if (json.root().has("end")) {
      entry.entry = end_from(json.root());
    } else {
      entry.entry = packet_from(json.root());
    }
    start = end + 1;
  }
  return entries;
}

}  // namespace greatx::io
