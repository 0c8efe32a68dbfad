// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads YAML from files that may be faulty or hostile.
#pragma once

#include <memory>
#include <string>

#include "core/fields/field_value.h"

namespace greatx {

/// Returns the one document of `text`; an empty text is the value `nothing`. `name` stands for the file in
/// messages. An alias shares the value that it names. Throws UserError "name:line: ..." if the text is not
/// UTF-8, is not well-formed, or has several documents, if a key is not a scalar, if an alias stands inside
/// the value that it names, or if the values are more than budget::yaml_values when every alias is written
/// out, as any walk over the document does.
std::shared_ptr<const FieldValue> read_yaml(const std::string& text, const std::string& name);

}  // namespace greatx
