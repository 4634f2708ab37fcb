"""Runs and sweeps."""

from __future__ import annotations

import json
import os
import re
import sys
from pathlib import Path
from typing import Any, Callable, Iterable, Mapping

from . import _mesoscope
from .errors import SceneError
from .results import Run, Sweep
from .scenes import overrides, source, text


class _Progress:
    """Progress on standard error, on a line that is written again."""

    def __init__(self) -> None:
        self.stream = sys.stderr
        self.is_terminal = self.stream.isatty() or "ipykernel" in sys.modules
        self.length = 0

    def __call__(self, line: str) -> None:
        event = json.loads(line)
        if event["event"] in ("warning", "repeating"):
            self._end()
            print(f"{event['event']}: {event['text']}", file=self.stream)
        elif event["event"] == "ended":
            self._end()
            print(f"{event['run']}: {event['text']}", file=self.stream)
        elif event["event"] == "progress" and self.is_terminal:
            left = event.get("remaining_seconds")
            rest = f", {left:.0f} s left" if left is not None else ""
            self._again(f"step {event['step']} of {event['last_step']}{rest}")

    def _again(self, shown: str) -> None:
        self.stream.write("\r" + shown.ljust(self.length))
        self.stream.flush()
        self.length = len(shown)

    def _end(self) -> None:
        if self.length:
            self._again("")
            self.stream.write("\r")
            self.length = 0

    def close(self) -> None:
        self._end()


#: Calls with a dictionary for every event, no progress at all, or that on standard error.
Progress = "bool | Callable[[dict[str, Any]], None]"


def _reporter(progress: Any) -> tuple[Callable[[str], None] | None, Callable[[], None]]:
    if progress is False:
        return None, lambda: None
    if callable(progress):
        return lambda line: progress(json.loads(line)), lambda: None
    shown = _Progress()
    return shown, shown.close


def _directory(name: str, out: str | os.PathLike[str] | None) -> Path:
    if out is not None:
        return Path(out)
    stem = Path(name).stem if not re.search(r"\s", name) else name
    return Path(re.sub(r"[^\w.+-]+", "-", stem).strip("-").lower() or "run")


def run(
    scene: Any,
    settings: Mapping[str, Any] | None = None,
    out: str | os.PathLike[str] | None = None,
    *,
    steps: int | None = None,
    force: bool = False,
    pictures: bool = True,
    adapter: str | None = None,
    progress: Any = True,
) -> Run:
    """Runs a scene and writes what it asks for into the directory ``out``, as ``mesoscope run`` does, with the same bytes.

    A ``KeyboardInterrupt`` saves a checkpoint, from which :func:`resume` goes on. ``progress`` is shown on standard error, passed to a
    function as dictionaries, or left out if it is False.

    >>> import mesoscope as ms
    >>> small = {"space.box": [4, 4, 4], "time.equilibration": 20, "output": {}}
    >>> run = ms.run("dpd-fluid", small, out="fluid", steps=200, progress=False)
    >>> run.mean("temperature").samples, run.energies["temperature"].shape
    (10, (11,))
    """
    name, written = source(scene)
    directory = _directory(name, out)
    report, close = _reporter(progress)
    try:
        _mesoscope.run_scene(
            name, written, overrides(settings), directory,
            steps=steps, force=force, pictures=pictures, adapter=adapter, report=report,
        )  # fmt: skip
    finally:
        close()
    return Run(directory)


def resume(
    directory: str | os.PathLike[str], *, steps: int | None = None, adapter: str | None = None, progress: Any = True
) -> Run:
    """Goes on with the run in a directory from its last checkpoint, up to ``steps`` where that is given."""
    report, close = _reporter(progress)
    try:
        _mesoscope.resume(Path(directory), steps=steps, adapter=adapter, report=report)
    finally:
        close()
    return Run(directory)


def sweep(
    scene: Any,
    vary: Mapping[str, Iterable[Any]],
    settings: Mapping[str, Any] | None = None,
    out: str | os.PathLike[str] | None = None,
    *,
    also: Iterable[Mapping[str, Any]] = (),
    seeds: int | Iterable[int] | None = None,
    steps: int | None = None,
    jobs: int | None = None,
    force: bool = False,
    adapter: str | None = None,
    progress: Any = True,
) -> Sweep:
    """Runs all combinations of the values in ``vary``, and the settings in ``also`` besides; with ``seeds`` each so many times.

    Variants that fail do not stop the others: ``failures`` of the result says why.

    >>> import mesoscope as ms
    >>> small = {"space.box": [4, 4, 4], "time.equilibration": 20, "output": {}}
    >>> found = ms.sweep("dpd-fluid", {"temperature": [1, 2]}, small, out="two", steps=100, progress=False)
    >>> found.table()["temperature"].tolist()
    [1.0, 2.0]
    """
    name, written = source(scene)
    varied = {key: list(values) for key, values in vary.items()}
    if seeds is not None:
        varied["seed"] = list(range(1, seeds + 1)) if isinstance(seeds, int) else list(seeds)
    if not varied and not also:
        raise SceneError("nothing is varied; accepted: keys with their values, or seeds")
    arguments = [f"{key}={','.join(text(value) for value in values)}" for key, values in varied.items()]
    further = [",".join(f"{key}={text(value)}" for key, value in settings.items()) for settings in also]
    directory = _directory(f"{_directory(name, None)}-sweep", out)
    report, close = _reporter(progress)
    try:
        failures = _mesoscope.sweep(
            _directory(name, None).name if written else name, written, overrides(settings), directory, arguments, further,
            steps=steps, force=force, jobs=jobs, adapter=adapter, report=report,
        )  # fmt: skip
    finally:
        close()
    return Sweep(directory, dict(failures))
