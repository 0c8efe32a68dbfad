// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the writers of HDF5 files share.
#pragma once

#include <cerrno>
#include <filesystem>
#include <hdf5.h>
#include <mutex>
#include <utility>

#include "io/files/file.h"

namespace greatx::io {

/// Lets one thread at a time use the HDF5 library, which is not made for several, and keeps it from printing
/// the failures that the callers throw.
class Hdf5Lock {
 public:
  Hdf5Lock() : lock_(mutex()) { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
};

/// Owns an object of the HDF5 library and closes it in the destructor.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Handle(hid_t opened, Close closes, const std::filesystem::path& file) : id_(opened), close_(closes) {
    if (opened < 0) throw WriteError(file, errno != 0 ? errno : EIO);
  }
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  hid_t id() const { return id_; }
  /// Closes the object now, and throws WriteError if this fails.
  void close(const std::filesystem::path& file) {
    if (close_(std::exchange(id_, -1)) < 0) throw WriteError(file, errno != 0 ? errno : EIO);
  }

 private:
  hid_t id_;
  Close close_;
};

}  // namespace greatx::io
