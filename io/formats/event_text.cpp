// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>

#include "core/error.h"
#include "io/files/file.h"
#include "io/formats/event_files.h"

namespace greatx::io {

NpyEvents::NpyEvents(const std::filesystem::path& t, const std::filesystem::path& x,
                     const std::filesystem::path& y, const std::filesystem::path& p)
    : file_(t), t_(t), x_(x), y_(y), p_(p) {
  const auto check = [&](const NpyFile& file, const std::filesystem::path& path, DType dtype) {
    if (file.dtype() != dtype || file.shape().size() != 1 || file.rows() != t_.rows())
      throw_user_error("{}: expected {} [{}], found {} [{}]", path.string(), numpy_name(dtype), t_.rows(),
                       numpy_name(file.dtype()), fmt::join(file.shape(), ", "));
  };
  check(t_, t, DType::i64);
  check(x_, x, DType::u16);
  check(y_, y, DType::u16);
  check(p_, p, DType::u8);
}

void NpyEvents::for_each_piece(const std::function<void(const Piece&)>& visit) const {
  constexpr int64_t piece = 1 << 20;
  for (int64_t first = 0; first < size(); first += piece) {
    const int64_t last = std::min(first + piece, size());
    visit(Piece{first, t_.read_rows(first, last), x_.read_rows(first, last), y_.read_rows(first, last),
                p_.read_rows(first, last)});
  }
}

void write_text_events(const std::filesystem::path& path, const EventArrays& events) {
  File file = File::open_for_writing(path);
  uint64_t offset = 0;
  const auto write = [&](std::string_view text) {
    file.write_at(offset, bytes_of(text));
    offset += text.size();
  };
  write("# t [s] x y p (1: brighter, 0: darker)\n");
  events.for_each_piece([&](const EventArrays::Piece& piece) {
    fmt::memory_buffer text;
    for (size_t i = 0; i < static_cast<size_t>(piece.size()); ++i) {
      const int64_t t = piece.t.as<int64_t>()[i];
      fmt::format_to(std::back_inserter(text), "{}.{:09} {} {} {}\n", t / 1'000'000'000, t % 1'000'000'000,
                     piece.x.as<uint16_t>()[i], piece.y.as<uint16_t>()[i], piece.p.as<uint8_t>()[i]);
    }
    write({text.data(), text.size()});
  });
  file.close();
}

}  // namespace greatx::io
