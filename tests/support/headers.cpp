// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Stands for the test programs when their common headers are compiled (CMakeLists.txt).
