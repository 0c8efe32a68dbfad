# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Predicts which beam of a panel is the best one for a car, from a camera and a LiDAR beside the panel.

Data flow: drives -> labels (the power of every beam, from the CSI of the tick) and inputs (pictures, range
images) -> networks and baselines, which rank the beams -> measures -> tables and pictures.

The task is that of A. Alkhateeb et al., "DeepSense 6G: A Large-Scale Real-World Multi-Modal Sensing and
Communication Dataset", IEEE Commun. Mag. 61(9), 2023.
"""
