// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace greatx {

/// Holds a value of a document as somebody wrote it, in YAML or in JSON. Nothing is interpreted: a number is
/// the text of a plain scalar. Immutable once made.
struct FieldValue {
  enum class Kind : uint8_t { nothing, scalar, list, map };
  struct Member {
    std::string key;
    int line = 0;  ///< of the key, from 1; 0 if it is unknown
    std::shared_ptr<const FieldValue> value;
  };
  Kind kind = Kind::nothing;
  bool quoted = false;  ///< of a scalar: it is a text, never a number or a boolean
  int line = 0;         ///< on which it begins, from 1; 0 if it is unknown
  std::string text;     ///< of a scalar
  std::vector<std::shared_ptr<const FieldValue>> items;  ///< of a list
  std::vector<Member> members;                           ///< of a map, in the document's order
};

}  // namespace greatx
