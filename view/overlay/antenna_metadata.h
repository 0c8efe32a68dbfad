// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Antennas as a channel's metadata describe them (sim/plan/antennas.cpp writes them).
#pragma once

#include <map>
#include <memory>
#include <string>

#include "io/files/untrusted_json.h"
#include "view/overlay/record_tables.h"

namespace greatx::view {

/// The imported patterns of a channel, each parsed at its first use.
class PatternTables {
 public:
  /// `channel`, its metadata, must outlive this.
  explicit PatternTables(const io::JsonValue& channel) : channel_(channel) {}
  /// Throws UserError if there is no such table or it is damaged. `place` names it in the message.
  std::shared_ptr<const rf::PatternTable> table(const io::JsonValue& sha256);

 private:
  io::JsonValue channel_;
  std::map<std::string, std::shared_ptr<const rf::PatternTable>> parsed_;
};

/// One entry of "transmitters" or "receivers", without its place.
AntennaFacts antenna_of(const io::JsonValue& json, PatternTables& tables);

}  // namespace greatx::view
