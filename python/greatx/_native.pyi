# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# Declares the compiled module, python/src/module.cpp. Text arguments are scenarios (YAML or JSON); returned
# texts are JSON.
from typing import Callable, Dict, List, Optional, Tuple

import numpy as np

version: str
Named = List[Tuple[str, str, str, np.ndarray]]  # name, unit, description, array

def take_log() -> List[Tuple[int, str]]: ...
def embedded_scenarios() -> Dict[str, str]: ...

class PathSet:
    def facts(self) -> str: ...
    def take_arrays(self) -> Named: ...
    def cfr(
        self,
        spacing_hz: Optional[float],
        subcarriers: Optional[int],
        time_samples: Optional[int],
        time_spacing_s: Optional[float],
        select: str,
    ) -> np.ndarray: ...
    def taps(
        self, bandwidth_hz: float, first: int, taps: int, time_samples: int, time_spacing_s: float
    ) -> Named: ...
    def statistics(self) -> Named: ...
    def received(
        self, power_w: float, resistance_ohm: float, transmit_port: int, receive_port: int
    ) -> Named: ...
    def coherence(self, level: float) -> Named: ...

class Stream:
    def sensors(self) -> str: ...
    def next(self) -> Optional[Tuple[int, int, List[Tuple[int, int, List[np.ndarray]]]]]: ...
    def summary(self) -> str: ...

class Session:
    @staticmethod
    def load(file: str, assets: str, device: str, validation: bool) -> "Session": ...
    @staticmethod
    def parse(text: str, name: str, assets: str, device: str, validation: bool) -> "Session": ...
    def add_nodes(self, text: str, where: str) -> None: ...
    def add_channels(self, text: str, where: str, no_receivers: bool) -> None: ...
    def change(self, text: str, where: str, keys: List[str]) -> None: ...
    def facts(self) -> str: ...
    def scene_facts(self) -> str: ...
    def explain(self) -> str: ...
    def device_facts(self) -> str: ...
    def solve(
        self,
        channel: str,
        sequence: int,
        tick: int,
        points: Optional[np.ndarray],
        antenna: str,
        progress: Optional[Callable[[int], None]],
    ) -> PathSet: ...
    def radio_map(
        self,
        channel: str,
        sequence: int,
        tick: int,
        min_m: Optional[List[float]],
        max_m: Optional[List[float]],
        cell_m: float,
        z_m: Optional[float],
        height_m: float,
        over_roofs: bool,
        power_dbm: List[float],
        bandwidth_hz: Optional[float],
        noise_figure_db: float,
        precoder: str,
        beam: Optional[int],
        oversampling: Optional[List[int]],
        inside_solids: bool,
        beyond_scene: bool,
        antenna: str,
        progress: Optional[Callable[[int], None]],
    ) -> Tuple[str, Named]: ...
    def stream(self, sequence: int, first_tick: int) -> Stream: ...
