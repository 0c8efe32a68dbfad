# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""How well scores tell the items before a blockage from the others. `truth` is bool [n], `score` float [n].

If all items are of one kind, there is nothing to tell: precision is then the share of positives, and the area
under the curve 0.5.
"""
from __future__ import annotations

from typing import Tuple

import numpy as np


def precision_recall(score: np.ndarray, truth: np.ndarray) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns precision, recall and threshold, for each different score from the highest on as the threshold:
    an item with this score or more is an alarm."""
    order = np.argsort(-score, kind="stable")
    right = np.cumsum(truth[order])
    last = np.flatnonzero(np.diff(score[order], append=np.nan) != 0)  # equal scores are one threshold
    return right[last] / (last + 1), right[last] / max(right[-1], 1), score[order][last]


def average_precision(score: np.ndarray, truth: np.ndarray) -> float:
    """Returns sum_i (R_i - R_{i-1}) P_i over the thresholds: the area below the steps of the curve."""
    if truth.all() or not truth.any():
        return float(truth.mean())
    precision, recall, _ = precision_recall(score, truth)
    return float(np.sum(np.diff(recall, prepend=0) * precision))


def roc_auc(score: np.ndarray, truth: np.ndarray) -> float:
    """Returns the probability that a positive has a higher score than a negative, an equal one counting a
    half (J. A. Hanley, B. J. McNeil, Radiology 143(1), 1982)."""
    if truth.all() or not truth.any():
        return 0.5
    values, place, count = np.unique(score, return_inverse=True, return_counts=True)
    rank = (np.cumsum(count) - (count - 1) / 2)[place]  # 1 for the lowest, the mean for equal ones
    positives = np.count_nonzero(truth)
    area = rank[truth].sum() - positives * (positives + 1) / 2
    return float(area / (positives * (len(truth) - positives)))


def f1(alarm: np.ndarray, truth: np.ndarray) -> float:
    """Returns 2 TP / (2 TP + FP + FN) of alarms, bool [n]; 0 without any."""
    right = np.count_nonzero(alarm & truth)
    wrong = np.count_nonzero(alarm != truth)
    return 2 * right / (2 * right + wrong) if right + wrong else 0.0


def best_threshold(score: np.ndarray, truth: np.ndarray) -> float:
    """Returns the threshold with the highest F1; of equal ones, the highest threshold."""
    precision, recall, threshold = precision_recall(score, truth)
    value = 2 * precision * recall / np.maximum(precision + recall, 1e-12)
    return float(threshold[np.argmax(value)])


def alarm_threshold(score: np.ndarray, truth: np.ndarray, false_alarms: float) -> float:
    """Returns the least threshold at which at most the share `false_alarms` of the negatives is an alarm."""
    negatives = np.sort(score[~truth])[::-1]
    allowed = int(false_alarms * len(negatives))
    if allowed >= len(negatives):
        return -np.inf
    return float(np.nextafter(negatives[allowed], np.inf))


def lead_ticks(alarm: np.ndarray, onset: int) -> int:
    """Returns how many ticks before an onset the alarm was given, and kept up to it: bool [ticks] of a drive
    -> 0 if there was none at the tick before."""
    before = alarm[:onset][::-1]
    silent = np.flatnonzero(~before)
    return int(silent[0]) if len(silent) else len(before)
