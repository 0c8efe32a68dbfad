// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Guesses the medium of a material from its name. People name materials by what they are ("red_brick",
// "GlassFront.001", "Rasenfläche"), in many languages and styles. One table maps words to radio fields; a
// person confirms each guess, because a name says nothing about thickness or coating.
//
//   name ─► words, without case, digits, marks and accents ─► first row of the table that fits ─► radio
//   fields
#pragma once

#include <string>

namespace greatx::scene {

/// Returns the radio fields that a word of a material's name suggests, such as "itu: glass, thickness_m:
/// 0.006" for "Window.001"; an empty text if no word is known. Where several words are known, a material
/// ("glass") goes before a place ("front", "wall").
std::string suggested_radio(const std::string& material_name);

}  // namespace greatx::scene
