"""Scenes: a dictionary, a path, or the name of a built-in one."""

from __future__ import annotations

import json
import os
from typing import Any, Mapping

import numpy as np

from . import _mesoscope
from .errors import SceneError

#: What stands for a scene: a dictionary as in JSON, a path, or the name of a built-in scene.
SceneLike = "Mapping[str, Any] | str | os.PathLike[str]"


def plain(value: Any) -> Any:
    """The value as JSON knows it: arrays become lists and scalars of NumPy numbers."""
    if isinstance(value, Mapping):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, (list, tuple, range)):
        return [plain(inner) for inner in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value


def text(value: Any) -> str:
    """The value as JSON text; numbers that are none are a mistake of its scene."""
    try:
        return json.dumps(plain(value), allow_nan=False)
    except (TypeError, ValueError) as error:
        places = list(_strange(plain(value), ""))
        lines = [f"{place}: found {found}; accepted: JSON, with finite numbers" for place, found in places]
        raise SceneError("\n".join(lines) or str(error), [(place, f"found {found}") for place, found in places]) from None


def _strange(value: Any, place: str):
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _strange(inner, f"{place}.{key}" if place else key)
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from _strange(inner, f"{place}[{index}]")
    elif isinstance(value, float) and not np.isfinite(value):
        yield place, value
    elif not isinstance(value, (str, int, float, bool, type(None))):
        yield place, type(value).__name__


def overrides(settings: Mapping[str, Any] | None) -> list[str]:
    """Settings as the command writes them."""
    return [f"{key}={text(value)}" for key, value in (settings or {}).items()]


def source(value: Any) -> tuple[str, str | None]:
    """The name of a scene, and its text where it is a dictionary."""
    if isinstance(value, Mapping):
        return str(value.get("title", "scene")), text(value)
    return os.fspath(value), None


def scene(value: Any) -> dict[str, Any]:
    """The scene of a name or in a file as a dictionary, as it is written there.

    >>> import mesoscope as ms
    >>> fluid = ms.scene("dpd-fluid")
    >>> fluid["particles"][0]["mass"] = 2
    >>> ms.check(fluid)["particles"]
    24000
    """
    if isinstance(value, Mapping):
        return json.loads(text(value))
    path = os.fspath(value)
    if os.path.isfile(path):
        with open(path, encoding="utf-8-sig") as file:
            return json.load(file)
    known = dict(_mesoscope.scenes())
    if path not in known:
        # The library knows which name is the nearest.
        _mesoscope.check(path, None, [])
    return json.loads(known[path])


def scenes() -> list[str]:
    """The names of the built-in scenes.

    >>> import mesoscope as ms
    >>> "surfactants" in ms.scenes()
    True
    """
    return [name for name, _ in _mesoscope.scenes()]


def schema() -> dict[str, Any]:
    """The JSON schema of scenes."""
    return json.loads(_mesoscope.schema())


def adapters() -> list[dict[str, str]]:
    """The adapters of this machine, the best first."""
    return [dict(zip(("name", "driver", "kind"), found)) for found in _mesoscope.adapters()]


def check(
    scene: Any,
    settings: Mapping[str, Any] | None = None,
    *,
    steps: int | None = None,
    adapter: str | None = None,
    time: bool = False,
) -> dict[str, Any]:
    """The requirements of a scene: its particles, the memory of the device, warnings, the scene with every default, and with ``time`` the
    seconds that a run is expected to take on the adapter.

    Raises :class:`SceneError` with all mistakes at once.

    >>> import mesoscope as ms
    >>> try:
    ...     ms.check("dpd-fluid", {"temprature": 2, "time.step": -1})
    ... except ms.SceneError as error:
    ...     sorted(place for place, _ in error.mistakes)
    ['temprature', 'time.step']
    """
    name, written = source(scene)
    return json.loads(
        _mesoscope.check(name, written, overrides(settings), steps=steps, adapter=adapter, time=time)
    )
