# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Positioning: where a drone is, from what it sees and hears (docs/learning.md).

Data flow: records (which ticks, which sensors, whose flight) -> cache (inputs of networks, made once) ->
splits -> experiment (for each seed: a teacher with all modalities, a student with CSI alone, the same student
with distillation; floors) -> results.
"""
