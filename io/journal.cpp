// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/journal.h"

#include <zlib.h>

#include <nlohmann/json.hpp>

namespace greatx::io {

using Json = nlohmann::ordered_json;

namespace {

constexpr size_t checksum_size = 9;  // a tab and eight digits

uint32_t crc(std::string_view text) {
  return static_cast<uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(text.data()), text.size()));
}
std::string sealed(const std::string& text) { return fmt::format("{}\t{:08x}\n", text, crc(text)); }

JournalEnd end_from(const Json& json) {
  JournalEnd end{json.at("end"), {}};
  for (const Json& file : json.at("files")) end.files.push_back({file.at(0), file.at(1), file.at(2)});
  return end;
}

JournalPacket packet_from(const Json& json) {
  const Json& head = json.at("packet");
  JournalPacket packet{head.at(0), head.at(1), head.at(2), {}, {}};
  for (const Json& record : json.at("records")) packet.records.push_back({record.at(0), record.at(1)});
  for (const Json& file : json.at("files")) packet.frames.push_back({file.at(0), file.at(1)});
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

std::vector<JournalEntry> parse_journal(const std::string& text) {
  std::vector<JournalEntry> entries;
  for (size_t start = 0; start < text.size();) {
    const size_t end = text.find('\n', start);
    if (end == text.npos || end - start <= checksum_size) break;
    const std::string_view line(text.data() + start, end - start - checksum_size);
    const std::string_view checksum(text.data() + end - checksum_size, checksum_size);
    if (fmt::format("\t{:08x}", crc(line)) != checksum) break;
    const Json json = Json::parse(line);
    JournalEntry& entry = entries.emplace_back();
    entry.end = end + 1;
    if (json.contains("end")) {
      entry.entry = end_from(json);
    } else {
      entry.entry = packet_from(json);
    }
    start = end + 1;
  }
  return entries;
}

}  // namespace greatx::io
