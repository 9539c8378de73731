# SPDX-License-Identifier: MIT
"""Metropolis light transport steered by derivatives."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

__version__: str

class Error(ValueError): ...

Step = Callable[[Technique, NDArray[np.float64]], tuple[ArrayLike, float] | None]

class Scene:
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def moving(self) -> bool: ...
    @property
    def aperture(self) -> bool: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def notes(self) -> list[str]: ...
    @overload
    def render(
        self,
        integrator: str = "",
        options: Mapping[str, Any] = {},
        *,
        time: float = 0,
        samples_per_pixel: int = 0,
        mutations_per_pixel: int = 0,
        seed: int | None = None,
        threads: int = 0,
        progress: Callable[[float, float, float], Any] | None = None,
        aov: None = None,
        aov_samples: int = 16,
    ) -> tuple[NDArray[np.float32], dict[str, Any]]: ...
    @overload
    def render(
        self,
        integrator: str = "",
        options: Mapping[str, Any] = {},
        *,
        time: float = 0,
        samples_per_pixel: int = 0,
        mutations_per_pixel: int = 0,
        seed: int | None = None,
        threads: int = 0,
        progress: Callable[[float, float, float], Any] | None = None,
        aov: Sequence[str],
        aov_samples: int = 16,
    ) -> tuple[NDArray[np.float32], dict[str, Any], dict[str, NDArray[np.float32]]]: ...
    def technique(self, s: int, t: int) -> Technique: ...
    def chain(
        self,
        mutations: Mapping[str | Step, float],
        *,
        large_step: float = 0.1,
        max_edges: int = 8,
        min_edges: int = 1,
        seed: int = 0,
        bootstrap: int = 20000,
    ) -> Chain: ...

class Technique:
    @property
    def s(self) -> int: ...
    @property
    def t(self) -> int: ...
    @property
    def edges(self) -> int: ...
    @property
    def dimension(self) -> int: ...
    @property
    def names(self) -> list[str]: ...
    def sample(self, count: int, seed: int = 0) -> NDArray[np.float64]: ...
    def evaluate(self, x: ArrayLike, threads: int = 0) -> dict[str, NDArray[np.float32]]: ...
    def differentiate(
        self, x: ArrayLike, dtype: DTypeLike = "float32", threads: int = 0
    ) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]: ...
    def convert(
        self, x: ArrayLike, to: Technique, seed: int = 0, threads: int = 0
    ) -> NDArray[np.float64]: ...
    def trace(self, row: ArrayLike) -> Path | None: ...

class Chain:
    @property
    def path(self) -> Path: ...
    @property
    def statistics(self) -> dict[str, dict[str, float]]: ...
    def step(self, count: int = 1) -> None: ...
    def image(self) -> NDArray[np.float32]: ...
    def propose(self, mutation: int, count: int = 1) -> list[tuple[Path | None, float]]: ...

class Path:
    @property
    def s(self) -> int: ...
    @property
    def t(self) -> int: ...
    @property
    def target(self) -> float: ...
    @property
    def contribution(self) -> tuple[float, float, float]: ...
    @property
    def film(self) -> tuple[float, float]: ...
    @property
    def moving(self) -> bool: ...
    @property
    def x(self) -> NDArray[np.float64]: ...
    @property
    def vertices(self) -> NDArray[np.float64]: ...
    def log_target(self, x: ArrayLike) -> float: ...
    def gradient(self, x: ArrayLike) -> NDArray[np.float64]: ...
    def hessian(self, x: ArrayLike) -> NDArray[np.float64]: ...

def load(
    file: str,
    *,
    width: int = 0,
    height: int = 0,
    scale: float = 0,
    defines: Mapping[str, str] = {},
    permissive: bool = False,
) -> Scene: ...
def load_string(
    text: str,
    folder: str = "",
    *,
    width: int = 0,
    height: int = 0,
    scale: float = 0,
    defines: Mapping[str, str] = {},
    permissive: bool = False,
) -> Scene: ...
def read_image(file: str) -> NDArray[np.float32]: ...
def write_image(file: str, image: ArrayLike) -> None: ...
def metrics(image: ArrayLike, reference: ArrayLike) -> dict[str, float]: ...
