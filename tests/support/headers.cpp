// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Source file of the program that compiles the precompiled headers of the test programs (CMakeLists.txt).
