// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the blobs of the page: base64, zlib, planes of bytes (draw/report/blobs.h). A blob is decoded when it
// is first shown; the last ones are kept.

/// The bytes of a blob as they are in the page.
function rawBlob(number) {
  const node = document.getElementById('b' + number);
  if (!node) throw new Error('blob ' + number + ' is missing: the file is damaged');
  return node.textContent;
}
function bytesOfBase64(text) {
  const binary = atob(text), bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/// A table of a canonical Huffman code (RFC 1951, section 3.2.2): the next `bits` bits of the stream lead to
/// symbol * 16 + length.
function huffmanTable(lengths) {
  let bits = 1;
  for (const length of lengths) bits = Math.max(bits, length);
  const counts = new Array(16).fill(0), next = new Array(17).fill(0);
  for (const length of lengths)
    if (length) ++counts[length];
  for (let length = 1; length <= 15; ++length) next[length + 1] = (next[length] + counts[length]) << 1;
  const entries = new Uint16Array(1 << bits);
  lengths.forEach((length, symbol) => {
    if (!length) return;
    let code = next[length]++, reversed = 0;
    for (let i = 0; i < length; ++i, code >>= 1) reversed = reversed << 1 | (code & 1);
    for (let i = reversed; i < 1 << bits; i += 1 << length) entries[i] = symbol << 4 | length;
  });
  return {entries, bits};
}
const lengthBase = [
  3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
  31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258
];
const lengthExtra = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0];
const distanceBase = [
  1,   2,   3,   4,   5,   7,    9,    13,   17,   25,   33,   49,   65,    97,    129,
  193, 257, 385, 513, 769, 1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577
];
const distanceExtra =
    [0, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13];
const orderOfLengths = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];

/// Unpacks zlib's format (RFC 1950, RFC 1951).
function inflate(from) {
  let at = 2, hold = 0, held = 0;  // behind the header
  let out = new Uint8Array(Math.max(1024, 4 * from.length)), size = 0;
  const need = count => {
    while (held < count) {
      if (at > from.length + 4) throw new Error('packed bytes end too early');
      hold |= (from[at++] || 0) << held;
      held += 8;
    }
  };
  const take = count => {
    need(count);
    const value = hold & ((1 << count) - 1);
    hold >>>= count;
    held -= count;
    return value;
  };
  const symbolOf = code => {
    need(code.bits);
    const entry = code.entries[hold & ((1 << code.bits) - 1)], length = entry & 15;
    if (!length) throw new Error('packed bytes are damaged');
    hold >>>= length;
    held -= length;
    return entry >> 4;
  };
  const room = count => {
    if (size + count <= out.length) return;
    const larger = new Uint8Array(Math.max(2 * out.length, size + count));
    larger.set(out.subarray(0, size));
    out = larger;
  };
  const codesOfBlock = kind => {
    if (kind === 1) {
      const lengths = [];
      for (let i = 0; i < 288; ++i) lengths.push(i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8);
      return [huffmanTable(lengths), huffmanTable(new Array(30).fill(5))];
    }
    const literals = take(5) + 257, distances = take(5) + 1, count = take(4) + 4;
    const first = new Array(19).fill(0);
    for (let i = 0; i < count; ++i) first[orderOfLengths[i]] = take(3);
    const code = huffmanTable(first), lengths = [];
    while (lengths.length < literals + distances) {
      const symbol = symbolOf(code);
      if (symbol < 16)
        lengths.push(symbol);
      else {
        const value = symbol === 16 ? lengths[lengths.length - 1] : 0;
        let times = symbol === 16 ? 3 + take(2) : symbol === 17 ? 3 + take(3) : 11 + take(7);
        while (times-- > 0) lengths.push(value);
      }
    }
    return [huffmanTable(lengths.slice(0, literals)), huffmanTable(lengths.slice(literals))];
  };
  for (let last = false; !last;) {
    last = take(1) === 1;
    const kind = take(2);
    if (kind === 3) throw new Error('packed bytes are damaged');
    if (kind === 0) {
      take(held & 7);
      const count = take(8) | take(8) << 8;
      take(16);
      room(count);
      for (let i = 0; i < count; ++i) out[size++] = take(8);
      continue;
    }
    const [literals, distances] = codesOfBlock(kind);
    for (;;) {
      const symbol = symbolOf(literals);
      if (symbol === 256) break;
      if (symbol < 256) {
        if (size === out.length) room(1);
        out[size++] = symbol;
        continue;
      }
      const count = lengthBase[symbol - 257] + take(lengthExtra[symbol - 257]);
      const far = symbolOf(distances), distance = distanceBase[far] + take(distanceExtra[far]);
      room(count);
      for (let i = 0; i < count; ++i, ++size) out[size] = out[size - distance];
    }
  }
  return out.subarray(0, size);
}

/// Undoes report::packed(): integers of `bytes` each, with rows of differences of length `row` (0: none).
function unpack(planes, bytes, row) {
  const count = planes.length / bytes;
  const values = bytes === 1 ? new Uint8Array(count) :
      bytes === 2            ? new Uint16Array(count) :
                               new Uint32Array(count);
  for (let b = 0; b < bytes; ++b)
    for (let i = 0; i < count; ++i) values[i] |= planes[b * count + i] << (8 * b);
  if (row > 0)
    for (let i = 0; i < count; ++i)
      if (i % row !== 0) values[i] += values[i - 1];
  return values;
}

/// Keeps what was made last.
class Kept {
  constructor(most) {
    this.most = most;
    this.map = new Map();
  }
  get(key, make) {
    let value = this.map.get(key);
    if (value === undefined) {
      value = make();
      if (this.map.size >= this.most) this.map.delete(this.map.keys().next().value);
    } else
      this.map.delete(key);
    this.map.set(key, value);
    return value;
  }
}
const keptArrays = new Kept(300), keptImages = new Kept(60);

const numbersOf = (blob, bytes, row) =>
    keptArrays.get(blob, () => unpack(inflate(bytesOfBase64(rawBlob(blob))), bytes, row));
const textOf = blob => keptArrays.get(blob, () => {
  const bytes = inflate(bytesOfBase64(rawBlob(blob)));
  let text = '';
  for (let i = 0; i < bytes.length; i += 8192)
    text += String.fromCharCode.apply(null, bytes.subarray(i, i + 8192));
  return JSON.parse(text);  // the text of lists is ASCII
});
/// A WebP picture; `ready` is called when it is decoded.
function imageOf(blob, ready) {
  const image = keptImages.get(blob, () => {
    const made = new Image();
    made.src = 'data:image/webp;base64,' + rawBlob(blob);
    return made;
  });
  if (image.complete && image.naturalWidth > 0)
    ready(image);
  else
    image.addEventListener('load', () => ready(image), {once: true});
  return image;
}
/// The value of a code of report::LogCode; 0 stands for none.
const logValue = (raster, code) => code === 0 ? Infinity : raster.low * Math.pow(raster.ratio, code - 1);
/// A raster of the page, its values by pixel: depth and luminance as logarithmic codes, ids as they are.
const rasterOf = (raster, bytes, differences) => numbersOf(raster.blob, bytes, differences ? raster.w : 0);
