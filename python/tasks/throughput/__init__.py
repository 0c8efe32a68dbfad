# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Measures how fast items reach a network: from a data set, and from the engine itself.

The task makes its own data set (scenario.yaml) in each kind of storage. A batch has pictures of 224 x 224,
channels of 64 ports and 256 subcarriers by angle and delay, a radar's maps and voxel grids of events.
"""
