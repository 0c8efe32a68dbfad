# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Predicts whether a vehicle is about to block the line of sight, from an event camera and a radar.

Data flow: drives -> labels (when the line of sight ends, from the channel's record) and inputs (events, radar
maps) -> networks and baselines, which give the probability of a blockage within each number of ticks ->
measures -> tables and pictures.

The task is that of U. Demirhan and A. Alkhateeb, "Radar Aided Proactive Blockage Prediction in Real-World
Millimeter Wave Systems", IEEE ICC 2022, with an event camera beside the radar.
"""
