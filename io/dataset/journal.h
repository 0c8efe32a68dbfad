// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Formats and parses the journal of an unfinished data set. The journal gets one line per packet as soon as
// all files of the packet are in place, and one line per sequence when the sequence is closed. Each line ends
// in a CRC-32, so that an incomplete last line is detected and dropped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "io/files/file.h"

namespace greatx::io {

class JsonValue;

/// Describes a file of the data set, as in the manifest.
struct FileEntry {
  std::string path;  ///< relative to the data set's folder
  uint64_t size = 0;
  std::string sha256;
};

/// Describes a committed packet.
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
  std::vector<FrameFile> frames;  ///< per record and per output of one file per frame, in this order
};

/// Describes the end of a sequence.
struct JournalEnd {
  uint32_t sequence = 0;
  std::vector<FileEntry> files;  ///< stacks, exports and index
};

struct JournalEntry {
  std::variant<JournalPacket, JournalEnd> entry;
  uint64_t end = 0;  ///< size of the journal up to the end of this line, bytes
  int line = 0;      ///< line number, from 1 on
};

std::string journal_line(const JournalPacket& packet);
std::string journal_line(const JournalEnd& end);
/// Returns the entries of all complete lines. Reading stops at the first line that is incomplete or has a
/// wrong checksum. `name` is the file's name in messages. Throws UserError if a line has the right checksum,
/// but is not a valid entry.
std::vector<JournalEntry> parse_journal(const std::string& text, const std::string& name = "journal.txt");

/// Returns a path below the data set's folder. Throws UserError if the value is not such a path.
std::string path_from(const JsonValue& json);
/// Returns a SHA-256 of 64 lower-case hexadecimal digits. Throws UserError if the value is not such a hash.
std::string sha256_from(const JsonValue& json);

}  // namespace greatx::io
