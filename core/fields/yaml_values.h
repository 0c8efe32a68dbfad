// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Changes and writes values of a document, without regard to the text that they come from. Inside of
// core/fields.
#pragma once

#include <memory>
#include <string>

#include "core/fields/edit_yaml.h"

namespace greatx {

/// Returns the document with the change. Throws UserError if the path leads nowhere or the value is not
/// well-formed.
std::shared_ptr<const FieldValue> changed_value(const std::shared_ptr<const FieldValue>& root,
                                                const YamlChange& change);
/// Returns a document in block style, with its inner values on one line each.
std::string yaml_block(const FieldValue& root);

}  // namespace greatx
