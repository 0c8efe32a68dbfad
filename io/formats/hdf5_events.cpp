// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <hdf5.h>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/files/file.h"
#include "io/formats/event_files.h"

namespace greatx::io {

namespace {

/// Owns an object of the HDF5 library and closes it in the destructor.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t opened, Close closes, const std::filesystem::path& file) : id_(opened), close_(closes) {
    if (opened < 0) throw WriteError(file, errno != 0 ? errno : EIO);
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  hid_t id() const { return id_; }
  /// Closes the object now, and throws WriteError if this fails.
  void close(const std::filesystem::path& file) {
    if (close_(std::exchange(id_, -1)) < 0) throw WriteError(file, errno != 0 ? errno : EIO);
  }

 private:
  hid_t id_;
  Close close_;
};

/// Writes an HDF5 dataset of one axis and known length from front to back.
class Column {
 public:
  Column(const Handle& file, const std::filesystem::path& path, const char* name, hid_t stored, hid_t given,
         uint64_t rows)
      : path_(path), given_(given), properties_(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path) {
    H5Pset_obj_track_times(properties_.id(), 0);  // the bytes must not depend on the time of day
    const hsize_t extent = rows;
    const Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose, path);
    dataset_.emplace(
        H5Dcreate2(file.id(), name, stored, space.id(), H5P_DEFAULT, properties_.id(), H5P_DEFAULT), H5Dclose,
        path);
  }
  template <typename T>
  void append(std::span<const T> values) {
    if (values.empty()) return;
    const hsize_t start = written_, count = values.size();
    const Handle file_space(H5Dget_space(dataset_->id()), H5Sclose, path_);
    H5Sselect_hyperslab(file_space.id(), H5S_SELECT_SET, &start, nullptr, &count, nullptr);
    const Handle memory_space(H5Screate_simple(1, &count, nullptr), H5Sclose, path_);
    errno = 0;
    if (H5Dwrite(dataset_->id(), given_, memory_space.id(), file_space.id(), H5P_DEFAULT, values.data()) < 0)
      throw WriteError(path_, errno != 0 ? errno : EIO);
    written_ += count;
  }

 private:
  std::filesystem::path path_;
  hid_t given_;
  Handle properties_;
  std::optional<Handle> dataset_;
  hsize_t written_ = 0;
};

}  // namespace

void write_hdf5_events(const std::filesystem::path& path, const EventArrays& events) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // this code throws on failures, so HDF5 need not print them
  errno = 0;
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path);
  std::vector<uint64_t> ms_to_idx;
  {
    const Handle group(H5Gcreate2(file.id(), "/events", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
                       path);
    const auto rows = static_cast<uint64_t>(events.size());
    Column t(file, path, "/events/t", H5T_STD_U32LE, H5T_NATIVE_UINT32, rows),
        x(file, path, "/events/x", H5T_STD_U16LE, H5T_NATIVE_UINT16, rows),
        y(file, path, "/events/y", H5T_STD_U16LE, H5T_NATIVE_UINT16, rows),
        p(file, path, "/events/p", H5T_STD_U8LE, H5T_NATIVE_UINT8, rows);
    events.for_each_piece([&](const EventArrays::Piece& piece) {
      std::vector<uint32_t> microseconds;
      microseconds.reserve(static_cast<size_t>(piece.size()));
      for (const int64_t t_ns : piece.t.as<int64_t>()) {
        const int64_t us = t_ns / 1000;
        if (t_ns < 0 || us > std::numeric_limits<uint32_t>::max())
          throw_user_error("{}: expected times of at most 4294.967295 s for DSEC's format, found {} ns",
                           events.file().string(), t_ns);
        const uint64_t index = static_cast<uint64_t>(piece.first) + microseconds.size();
        while (ms_to_idx.size() <= static_cast<uint64_t>(us / 1000)) ms_to_idx.push_back(index);
        microseconds.push_back(static_cast<uint32_t>(us));
      }
      t.append(std::span<const uint32_t>(microseconds));
      x.append(piece.x.as<uint16_t>());
      y.append(piece.y.as<uint16_t>());
      p.append(piece.p.as<uint8_t>());
    });
    ms_to_idx.push_back(rows);
    Column(file, path, "/ms_to_idx", H5T_STD_U64LE, H5T_NATIVE_UINT64, ms_to_idx.size())
        .append(std::span<const uint64_t>(ms_to_idx));
    const Handle scalar(H5Screate(H5S_SCALAR), H5Sclose, path),
        properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path);
    H5Pset_obj_track_times(properties.id(), 0);
    const Handle offset(H5Dcreate2(file.id(), "/t_offset", H5T_STD_I64LE, scalar.id(), H5P_DEFAULT,
                                   properties.id(), H5P_DEFAULT),
                        H5Dclose, path);
    constexpr int64_t zero = 0;
    if (H5Dwrite(offset.id(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &zero) < 0)
      throw WriteError(path, EIO);
  }
  file.close(path);
}

}  // namespace greatx::io
