// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/manifest.h"

#include <charconv>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "io/files/inside.h"
#include "io/files/untrusted_json.h"

namespace greatx::io {

using Json = nlohmann::ordered_json;

namespace {

/// Buffers text and writes it in large pieces.
class TextFile {
 public:
  explicit TextFile(const std::filesystem::path& path) : file_(File::open_for_writing(path)) {
    file_.truncate(0);
  }
  void add(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() > (1 << 20)) flush();
  }
  void close() {
    flush();
    file_.close();
  }

 private:
  void flush() {
    file_.write_at(written_, bytes_of(buffer_));
    written_ += buffer_.size();
    buffer_.clear();
  }
  File file_;
  uint64_t written_ = 0;
  std::string buffer_;
};

std::string hex(const std::array<uint8_t, 32>& digest) {
  std::string text;
  for (const uint8_t byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

std::string totals(const DatasetInfo& info, const Manifest& manifest, int64_t files, uint64_t bytes) {
  Json per_sensor = Json::object();
  int64_t records = 0;
  for (size_t i = 0; i < info.sensors.size(); ++i) {
    per_sensor[info.sensors[i].name] = manifest.records_per_sensor[i];
    records += manifest.records_per_sensor[i];
  }
  return Json({{"files", files},
               {"bytes", bytes},
               {"sequences", info.sequences},
               {"packets", manifest.packets},
               {"records", records},
               {"records_per_sensor", std::move(per_sensor)}})
      .dump();
}

}  // namespace

void Manifest::add_frame(Frame frame, const std::string& sha256) {
  GREATX_CHECK(sha256.size() == 64, "digest \"{}\"", sha256);
  for (size_t i = 0; i < 32; ++i)
    std::from_chars(sha256.data() + 2 * i, sha256.data() + 2 * i + 2, frame.digest[i], 16);
  frames.push_back(frame);
}

std::pair<int64_t, uint64_t> write_manifest(const std::filesystem::path& folder, const DatasetInfo& info,
                                            const Manifest& manifest) {
  const auto files = static_cast<int64_t>(manifest.files.size() + manifest.frames.size());
  uint64_t bytes = 0;
  for (const FileEntry& file : manifest.files) bytes += file.size;
  for (const Manifest::Frame& frame : manifest.frames) bytes += frame.size;

  const std::filesystem::path path = inside(folder, manifest_file), part = part_name(path);
  try {
    TextFile out(part);
    out.add(fmt::format(
        "{{\n\"format\": \"greatx-manifest\",\n\"format_version\": {},\n\"totals\": {},\n\"files\": [",
        format_version, totals(info, manifest, files, bytes)));
    const char* separator = "\n";
    const auto add = [&](const std::string& name, uint64_t size, const std::string& sha256) {
      out.add(fmt::format("{}{{\"path\": {}, \"size\": {}, \"sha256\": \"{}\"}}", separator,
                          Json(name).dump(), size, sha256));
      separator = ",\n";
    };
    for (const FileEntry& file : manifest.files) add(file.path, file.size, file.sha256);
    for (const Manifest::Frame& frame : manifest.frames) {
      const SensorSpec& sensor = info.sensors[frame.sensor];
      add(frame_path(frame.sequence, sensor, sensor.outputs[frame.output], frame.sample), frame.size,
          hex(frame.digest));
    }
    out.add("\n]\n}\n");
    out.close();
    rename_file(part, path);
  } catch (...) {
    ::unlink(part.c_str());
    throw;
  }
  return {files, bytes};
}

std::vector<FileEntry> read_manifest(const std::filesystem::path& folder) {
  constexpr JsonLimits limits{uint64_t{2} << 30, uint64_t{1} << 26, 8};  // about 16 million files
  const std::filesystem::path path = inside(folder, manifest_file);
  const JsonDocument document(read_text_file(path, limits.bytes), {path.string(), 1}, limits);
  const JsonValue json = document.root();
  if (json.at("format").text() != "greatx-manifest") json.at("format").fail("\"greatx-manifest\"");
  if (json.at("format_version").integer(INT64_MIN, INT64_MAX) != format_version)
    json.at("format_version").fail(fmt::format("version {}", format_version));
  std::vector<FileEntry> files;
  for (const JsonValue& file : json.at("files").list(limits.values))
    files.push_back({path_from(file.at("path")), static_cast<uint64_t>(file.at("size").integer(0, INT64_MAX)),
                     sha256_from(file.at("sha256"))});
  return files;
}

}  // namespace greatx::io
