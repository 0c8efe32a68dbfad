// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/run_deflate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <libdeflate.h>

namespace greatx::io {

namespace {

static_assert(std::endian::native == std::endian::little, "words are written as they lie in memory");

// Section 3.2.5 of RFC 1951: literals 0 to 255, the end of a block, then the codes of lengths.
constexpr size_t end_of_block = 256, first_length_code = 257, literal_codes = 286, length_order = 19;
constexpr size_t longest_match = 258, shortest_run = 4;
/// Two codes of one bit are a complete code, which every decoder takes. The one of the period is used.
constexpr size_t distance_codes = 2;
/// The codes of a block fit the statistics of its own lines. A block's header takes about 80 bytes.
constexpr size_t block_bytes = 1 << 16;
/// Four literals of this length fit into the bit buffer beside the bits that remain from before.
constexpr unsigned longest_code = 12, longest_length_code = 7;

uint64_t word_at(const uint8_t* at) {
  uint64_t word = 0;
  std::memcpy(&word, at, sizeof word);
  return word;
}

struct LengthCode {
  uint16_t symbol;
  uint8_t extra_bits, extra;
};

constexpr std::array<LengthCode, longest_match + 1> make_length_codes() {
  std::array<LengthCode, longest_match + 1> codes{};
  constexpr unsigned extra_bits[29] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                       2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
  unsigned length = 3;
  for (unsigned code = 0; code < 28; ++code)
    for (unsigned extra = 0; extra < 1u << extra_bits[code]; ++extra, ++length)
      codes[length] = {static_cast<uint16_t>(first_length_code + code),
                       static_cast<uint8_t>(extra_bits[code]), static_cast<uint8_t>(extra)};
  codes[longest_match] = {static_cast<uint16_t>(first_length_code + 28), 0, 0};
  return codes;
}
constexpr std::array<LengthCode, longest_match + 1> length_codes = make_length_codes();

/// Calls literals(at, count) and match(length) for the tokens of a block, in order. It depends on the bytes
/// alone, so two calls give the same tokens.
template <typename Literals, typename Match>
void tokens_of(const uint8_t* begin, const uint8_t* first, const uint8_t* end, size_t period,
               const Literals& literals, const Match& match) {
  const uint8_t* at = first;
  if (at == begin) {
    const size_t head = std::min(period, static_cast<size_t>(end - at));
    literals(at, head);
    at += head;
  }
  while (end - at >= 8) {
    const uint64_t differs = word_at(at) ^ word_at(at - period);
    // A byte of the mask is 0x80 where the byte and the next three repeat, as far as the word shows.
    constexpr uint64_t low = 0x7f7f7f7f7f7f7f7fu;
    const uint64_t equal = ~(((differs & low) + low) | differs | low);
    const uint64_t begins = equal & equal >> 8 & equal >> 16 & equal >> 24;
    if (begins == 0) {
      literals(at, std::integral_constant<size_t, 8>());
      at += 8;
      continue;
    }
    if (const auto before = static_cast<size_t>(std::countr_zero(begins)) / 8; before > 0) {
      literals(at, before);
      at += before;
      continue;
    }
    const auto same = static_cast<size_t>(std::countr_zero(differs)) / 8;
    const uint8_t* run = at + same;
    if (same == 8) {
      while (end - run >= 8) {
        const uint64_t further = word_at(run) ^ word_at(run - period);
        const auto more = static_cast<size_t>(std::countr_zero(further)) / 8;
        run += more;
        if (more < 8) break;
      }
    }
    size_t length = static_cast<size_t>(run - at);
    for (; length >= shortest_run; length -= std::min(length, longest_match))
      match(std::min(length, longest_match));
    at = run - length;
    if (length > 0) literals(at, length);
    at = run;
  }
  if (at != end) literals(at, static_cast<size_t>(end - at));
}

/// Returns the lengths of a Huffman code of at most `most` bits; symbols that do not occur have none. Two
/// symbols occur at least.
void code_lengths(std::span<const uint32_t> counts, unsigned most, uint8_t* lengths) {
  std::array<uint32_t, literal_codes> order;  // count << 9 | symbol, by count ascending
  size_t used = 0;
  for (size_t symbol = 0; symbol < counts.size(); ++symbol) {
    lengths[symbol] = 0;
    if (counts[symbol] > 0) order[used++] = counts[symbol] << 9 | static_cast<uint32_t>(symbol);
  }
  std::sort(order.begin(), order.begin() + static_cast<ptrdiff_t>(used));
  // A. Moffat, J. Katajainen, "In-place calculation of minimum-redundancy codes" (WADS 1995): weights become
  // parents, then depths.
  std::array<uint32_t, literal_codes> work;
  for (size_t i = 0; i < used; ++i) work[i] = order[i] >> 9;
  size_t leaf = 0, root = 0;
  for (size_t next = 0; next + 1 < used; ++next) {
    const auto lightest = [&](uint32_t& to) {
      const bool inner = root < next && (leaf >= used || work[root] < work[leaf]);
      const uint32_t weight = inner ? work[root] : work[leaf];
      if (inner)
        work[root++] = static_cast<uint32_t>(next);
      else
        ++leaf;
      to = weight;
    };
    uint32_t a = 0, b = 0;
    lightest(a);
    lightest(b);
    work[next] = a + b;
  }
  std::array<uint32_t, 64> of_depth{};  // symbols by length
  work[used - 2] = 0;
  for (size_t next = used - 2; next-- > 0;) work[next] = work[work[next]] + 1;
  size_t open = 1, inner = used - 1;
  for (uint32_t depth = 0; open > 0; ++depth) {
    size_t nodes = 0;
    while (inner > 0 && work[inner - 1] == depth) {
      ++nodes;
      --inner;
    }
    of_depth[std::min<uint32_t>(depth, most)] += static_cast<uint32_t>(open - nodes);
    open = 2 * nodes;
  }
  // Codes that were too long overfill the code space: a shorter code gives way to two longer ones.
  uint32_t total = 0;
  for (unsigned length = 1; length <= most; ++length) total += of_depth[length] << (most - length);
  for (; total > 1u << most; --total) {
    --of_depth[most];
    unsigned length = most - 1;
    while (of_depth[length] == 0) --length;
    --of_depth[length];
    of_depth[length + 1] += 2;
  }
  size_t next = used;
  for (unsigned length = 1; length <= most; ++length)
    for (uint32_t i = 0; i < of_depth[length]; ++i)
      lengths[order[--next] & 511u] = static_cast<uint8_t>(length);
}

struct Code {
  uint16_t bits = 0;  ///< first bit lowest
  uint8_t length = 0;
};

/// Returns the canonical codes of the lengths (section 3.2.2), which are sent with their first bit lowest.
void assign_codes(std::span<const uint8_t> lengths, Code* codes) {
  std::array<uint32_t, 16> of_length{}, next{};
  for (const uint8_t length : lengths) ++of_length[length];
  of_length[0] = 0;
  for (size_t bits = 1; bits < 16; ++bits) next[bits] = (next[bits - 1] + of_length[bits - 1]) << 1;
  for (size_t symbol = 0; symbol < lengths.size(); ++symbol) {
    const unsigned length = lengths[symbol];
    uint32_t code = length == 0 ? 0 : next[length]++, turned = 0;
    for (unsigned bit = 0; bit < length; ++bit, code >>= 1) turned = turned << 1 | (code & 1u);
    codes[symbol] = {static_cast<uint16_t>(turned), static_cast<uint8_t>(length)};
  }
}

/// Writes bits, the first one lowest. The room must last for all of them and for seven further bytes.
class BitWriter {
 public:
  explicit BitWriter(uint8_t* to) : to_(to) {}
  void put(uint64_t bits, unsigned count) {
    held_ |= bits << count_;
    count_ += count;
  }
  /// Leaves less than 8 bits held, so that 56 may follow.
  void flush() {
    std::memcpy(to_, &held_, sizeof held_);
    const unsigned bytes = count_ / 8;
    to_ += bytes;
    held_ >>= 8 * bytes;
    count_ %= 8;
  }
  /// Ends at a whole byte and returns the place behind it.
  uint8_t* finish() {
    flush();
    if (count_ > 0) ++to_;
    return to_;
  }

 private:
  uint8_t* to_;
  uint64_t held_ = 0;
  unsigned count_ = 0;
};

/// Packs one block after the other.
class RunDeflate {
 public:
  RunDeflate(std::span<const uint8_t> bytes, size_t period, uint8_t* to)
      : begin_(bytes.data()), end_(bytes.data() + bytes.size()), period_(period), out_(to) {}

  uint8_t* pack() {
    for (const uint8_t* first = begin_;;) {
      const uint8_t* last = first + std::min<size_t>(block_bytes, static_cast<size_t>(end_ - first));
      add_block(first, last, last == end_);
      if (last == end_) return out_.finish();
      first = last;
    }
  }

 private:
  void add_block(const uint8_t* first, const uint8_t* last, bool final) {
    count(first, last);
    code_lengths(counts_, longest_code, lengths_.data());
    for (size_t code = 0; code < distance_codes; ++code)
      lengths_[literal_codes + first_distance() + code] = 1;
    out_.put(final ? 1 : 0, 1);
    out_.put(2, 2);  // codes of its own
    write_lengths();
    assign_codes(std::span(lengths_).first(literal_codes), codes_.data());
    write_tokens(first, last);
  }

  size_t first_distance() const { return period_ < 2 ? 0 : period_ - 2; }

  void count(const uint8_t* first, const uint8_t* last) {
    // Four tables, since counts of equal bytes would wait for each other.
    std::array<std::array<uint32_t, 256>, 4> of_bytes{};
    counts_.fill(0);
    tokens_of(
        begin_, first, last, period_,
        [&](const uint8_t* at, auto number) {
          for (size_t i = 0; i < number; ++i) ++of_bytes[i & 3u][at[i]];
        },
        [&](size_t length) { ++counts_[length_codes[length].symbol]; });
    for (size_t byte = 0; byte < 256; ++byte)
      counts_[byte] = of_bytes[0][byte] + of_bytes[1][byte] + of_bytes[2][byte] + of_bytes[3][byte];
    counts_[end_of_block] = 1;
    if (first == last) counts_[0] = 1;  // a code has two symbols at least
  }

  void write_tokens(const uint8_t* first, const uint8_t* last) {
    // A match is written at once: its code, the extra bits, and the bit of the distance.
    const unsigned distance_bit = period_ == 1 ? 0 : 1;
    tokens_of(
        begin_, first, last, period_,
        [&](const uint8_t* at, auto number) {
          size_t i = 0;
          for (; i + 4 <= number; i += 4) {
            for (size_t k = 0; k < 4; ++k) put(codes_[at[i + k]]);
            out_.flush();
          }
          for (; i < number; ++i) put(codes_[at[i]]);
          out_.flush();
        },
        [&](size_t length) {
          const LengthCode& code = length_codes[length];
          put(codes_[code.symbol]);
          out_.put(code.extra, code.extra_bits);
          out_.put(distance_bit, 1);
          out_.flush();
        });
    put(codes_[end_of_block]);
    out_.flush();
  }

  /// Writes the code lengths of both codes, themselves packed (section 3.2.7).
  void write_lengths() {
    const size_t distances = first_distance() + distance_codes;
    const std::span<const uint8_t> all = std::span(lengths_).first(literal_codes + distances);
    std::array<uint8_t, literal_codes + 4> symbols, extras;
    size_t used = 0;
    std::array<uint32_t, length_order> counts{};
    const auto add = [&](size_t symbol, size_t extra) {
      symbols[used] = static_cast<uint8_t>(symbol);
      extras[used++] = static_cast<uint8_t>(extra);
      ++counts[symbol];
    };
    for (size_t i = 0; i < all.size();) {
      size_t run = 1;
      while (i + run < all.size() && all[i + run] == all[i]) ++run;
      size_t left = run;
      if (all[i] == 0) {
        for (; left >= 11; left -= std::min<size_t>(left, 138)) add(18, std::min<size_t>(left, 138) - 11);
        if (left >= 3) {
          add(17, left - 3);
          left = 0;
        }
      } else {
        add(all[i], 0);
        for (--left; left >= 3; left -= std::min<size_t>(left, 6)) add(16, std::min<size_t>(left, 6) - 3);
      }
      for (; left > 0; --left) add(all[i], 0);
      i += run;
    }
    std::array<uint8_t, length_order> lengths;
    std::array<Code, length_order> codes;
    code_lengths(counts, longest_length_code, lengths.data());
    assign_codes(lengths, codes.data());
    constexpr uint8_t order[length_order] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                             11, 4,  12, 3, 13, 2, 14, 1, 15};
    out_.put(literal_codes - 257, 5);
    out_.put(distances - 1, 5);
    out_.put(length_order - 4, 4);
    out_.flush();
    for (const uint8_t symbol : order) {
      out_.put(lengths[symbol], 3);
      out_.flush();
    }
    for (size_t i = 0; i < used; ++i) {
      put(codes[symbols[i]]);
      out_.put(extras[i], symbols[i] == 16 ? 2 : symbols[i] == 17 ? 3 : symbols[i] == 18 ? 7 : 0);
      out_.flush();
    }
  }

  void put(Code code) { out_.put(code.bits, code.length); }

  const uint8_t *begin_, *end_;
  size_t period_;
  BitWriter out_;
  std::array<uint32_t, literal_codes> counts_;
  std::array<uint8_t, literal_codes + 4> lengths_{};
  std::array<Code, literal_codes> codes_;
};

}  // namespace

void append_run_deflated(std::span<const std::byte> bytes, size_t period, Bytes& out) {
  GREATX_CHECK(period >= 1 && period <= 4, "a period of {} bytes", period);
  // A code of 12 bits at most makes literals longer by half; headers and the checksum come on top.
  const size_t blocks = bytes.size() / block_bytes + 1,
               most = bytes.size() + bytes.size() / 2 + 512 * blocks + 16;
  thread_local Bytes packed;  // kept from call to call
  if (packed.size() < most) packed.resize(most);
  auto* const to = reinterpret_cast<uint8_t*>(packed.data());
  to[0] = 0x78;  // windows of 32 KiB
  to[1] = 0x01;  // fast
  const std::span<const uint8_t> from(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  uint8_t* end = RunDeflate(from, period, to + 2).pack();
  const uint32_t sum = libdeflate_adler32(1, bytes.data(), bytes.size());
  for (const int shift : {24, 16, 8, 0}) *end++ = static_cast<uint8_t>(sum >> shift);
  append(out, std::span(packed).first(static_cast<size_t>(end - to)));
}

}  // namespace greatx::io
