// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes a data set as one file of HTML that needs nothing else: no network, no library, no font.
//
// Data flow, in one direction:
//
//   DatasetReader ─► moments (ticks of a sequence, thinned evenly until they fit)
//     ─► parts: one function for each kind of sensor makes a record's JSON and its blobs (parts.h)
//     ─► Blobs: numbered bytes, WebP pictures or packed arrays (blobs.h)
//     ─► page: template, styles and scripts of page/, the JSON, and the blobs that the JSON names (page.cpp)
//
// The file has one <script type="application/json" id="data"> with everything but the arrays, and a
// <script type="text/plain" id="b12"> in base64 for each blob. The scripts of page/ decode a blob when it is
// first shown. docs/report.md describes the page, the arrays and their bounds for users.
//
// All lengths are metres from `origin`, a point near the first pose, so that UTM coordinates keep their
// precision in the page's fp32 and in short numbers. The page never holds the place of a file or a time of
// day, so the same data set always gives the same bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/dataset/dataset_reader.h"

namespace greatx::io {

struct ReportOptions {
  double megabytes = 25.0;           ///< the file is at most this long, 10^6 bytes
  size_t moments = 240;              ///< of a sequence, at most
  std::optional<uint32_t> sequence;  ///< only this one; none: all, up to most_report_sequences
};
inline constexpr uint32_t most_report_sequences = 8;

struct ReportFile {
  uint64_t bytes = 0;
  size_t sequences = 0, moments = 0;
  /// Says in sentences what the page leaves out or holds at less than the data set's resolution.
  std::vector<std::string> notes;
};

/// Is called after each moment that is packed, with the number so far and the number in all.
using ReportProgress = std::function<void(int64_t done, int64_t total)>;

/// Returns the page. Throws UserError if there are no records, if a record is not as declared, or if not even
/// one moment fits.
std::string html_report(const DatasetReader& reader, const ReportOptions& options, ReportFile& file,
                        const ReportProgress& progress = {});
/// Writes the page. An existing file is replaced only if it is a report, too. Throws UserError otherwise.
ReportFile write_html_report(const DatasetReader& reader, const std::filesystem::path& path,
                             const ReportOptions& options, const ReportProgress& progress = {});

}  // namespace greatx::io
