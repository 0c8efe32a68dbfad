// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The journal of an unfinished data set: one line a packet, appended when all its files are in place, and one
// line a sequence when that is closed. Each line ends in a CRC-32, so that a torn last line is seen and
// dropped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "io/files/file.h"

namespace greatx::io {

class JsonValue;

/// A file of the data set as the manifest lists it.
struct FileEntry {
  std::string path;  ///< relative to the data set's folder
  uint64_t size = 0;
  std::string sha256;
};

struct JournalPacket {
  struct RecordLine {
    uint32_t sensor = 0;
    int64_t sample = 0;
  };
  struct FrameFile {
    uint64_t size = 0;
    std::string sha256;
  };
  uint32_t sequence = 0;
  int64_t tick = 0;
  int64_t time_ns = 0;
  std::vector<RecordLine> records;
  std::vector<FrameFile> frames;  ///< per record, per output that is one file a frame, in order
};

struct JournalEnd {
  uint32_t sequence = 0;
  std::vector<FileEntry> files;  ///< stacks and index
};

struct JournalEntry {
  std::variant<JournalPacket, JournalEnd> entry;
  uint64_t end = 0;  ///< bytes of the journal up to and with this line
  int line = 0;      ///< its number, from 1 on
};

std::string journal_line(const JournalPacket& packet);
std::string journal_line(const JournalEnd& end);
/// All whole lines; reading stops at the first one that is torn. `name` stands for the file in messages.
/// Throws UserError for a line whose checksum is right and that still is none of a journal.
std::vector<JournalEntry> parse_journal(const std::string& text, const std::string& name = "journal.txt");

/// A path below the data set's folder, and a SHA-256 in hexadecimal digits. Throw UserError.
std::string path_from(const JsonValue& json);
std::string sha256_from(const JsonValue& json);

}  // namespace greatx::io
