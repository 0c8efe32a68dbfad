// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The dimensions of generated vehicles and people, for those who let them move: vehicle_shapes(),
// person_shapes(). The tables lie beside the code that builds the bodies from them.
#pragma once

#include "scene/generator/objects/shapes.h"
