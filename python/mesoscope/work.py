"""Runs and sweeps."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any, Callable, Iterable, Mapping

from . import _mesoscope
from ._command import program
from .errors import FileError, SceneError
from .results import Page, Run, Stability, Sweep, Tradeoff
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
        elif event["event"] == "phase":
            self._end()
            print(event["text"], file=self.stream)
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
    directory: str | os.PathLike[str],
    settings: Mapping[str, Any] | None = None,
    *,
    steps: int | None = None,
    adapter: str | None = None,
    progress: Any = True,
) -> Run:
    """Goes on with the run in a directory from its last checkpoint, up to ``steps`` where that is given; with ``settings`` in a new stage of the
    run, in which these numbers of its scene are others.
    """
    report, close = _reporter(progress)
    try:
        _mesoscope.resume(Path(directory), overrides(settings), steps=steps, adapter=adapter, report=report)
    finally:
        close()
    return Run(directory)


class _Study:
    """What studies are started with, as the extension reads it."""

    def __init__(
        self, kind: str, scene: Any, settings: Mapping[str, Any] | None, out: Any, vary: Mapping[str, Any], also: Iterable[Mapping[str, Any]],
        *, seeds: int | None, steps: int | None, jobs: int | None, replicas: int | None, force: bool, adapter: str | None, progress: Any,
    ) -> None:  # fmt: skip
        name, self.text = source(scene)
        stem = _directory(name, None).name
        self.name = stem if self.text else name
        self.settings = overrides(settings)
        self.vary = [f"{key}={_values(values)}" for key, values in vary.items()]
        self.also = [",".join(f"{key}={text(value)}" for key, value in one.items()) for one in also]
        if jobs is not None and jobs < 1:
            raise SceneError(f"jobs is {jobs}; accepted: at least 1")
        if replicas is not None and not 1 <= replicas <= 64:
            raise SceneError(f"replicas is {replicas}; accepted: 1 to 64")
        self.seeds, self.steps, self.jobs, self.replicas, self.force, self.adapter = seeds, steps, jobs, replicas, force, adapter
        self.out = _directory(f"{stem}-{kind}", out)
        self.report, self.close = _reporter(progress)


def _values(values: Any) -> str:
    # A range of a map of stability is written as the command has it: "0.01..0.2/9".
    if isinstance(values, str):
        return values
    return ",".join(text(value) for value in values)


def _named(pairs: Mapping[str, Any] | None) -> list[str]:
    """``{"pressure": "1%"}`` as ``pressure=1%``, and ``(value, error)`` as ``value+-error``."""
    found = []
    for name, value in (pairs or {}).items():
        shown = value if isinstance(value, str) else "+-".join(str(part) for part in (value if isinstance(value, tuple) else (value,)))
        found.append(f"{name}={shown}")
    return found


def sweep(
    scene: Any,
    vary: Mapping[str, Iterable[Any]] | None = None,
    settings: Mapping[str, Any] | None = None,
    out: str | os.PathLike[str] | None = None,
    *,
    also: Iterable[Mapping[str, Any]] = (),
    seeds: int | Iterable[int] | None = None,
    steps: int | None = None,
    jobs: int | None = None,
    replicas: int | None = None,
    force: bool = False,
    adapter: str | None = None,
    progress: Any = True,
) -> Sweep:
    """Runs all combinations of the values in ``vary``, and the settings in ``also`` besides. ``seeds`` makes independent runs of each: a number of
    them, with the seed of the scene and those that follow, or the seeds themselves; ``averages`` of the result are means over them.

    ``jobs`` are runs at once, and ``replicas`` runs that a device advances together in the dispatches of one, as with ``--replicas``.
    Variants that fail do not stop the others: ``failures`` of the result says why.

    >>> import mesoscope as ms
    >>> small = {"space.box": [4, 4, 4], "time.equilibration": 20, "output": {}}
    >>> found = ms.sweep("dpd-fluid", {"temperature": [1, 2]}, small, out="two", steps=100, progress=False)
    >>> found.table()["temperature"].tolist()
    [1.0, 2.0]
    """
    varied = {key: list(values) for key, values in (vary or {}).items()}
    count = None
    if isinstance(seeds, int):
        count = seeds
    elif seeds is not None:
        varied["seed"] = list(seeds)
    study = _Study(
        "sweep", scene, settings, out, varied, also,
        seeds=count, steps=steps, jobs=jobs, replicas=replicas, force=force, adapter=adapter, progress=progress,
    )  # fmt: skip
    if not varied and not study.also and count is None:
        raise SceneError("nothing is varied; accepted: keys with their values, or seeds")
    try:
        failures = _mesoscope.sweep(study)
    finally:
        study.close()
    return Sweep(study.out, dict(failures))


def tradeoff(
    scene: Any,
    vary: Mapping[str, Iterable[Any]],
    targets: Mapping[str, Any] | None = None,
    settings: Mapping[str, Any] | None = None,
    out: str | os.PathLike[str] | None = None,
    *,
    also: Iterable[Mapping[str, Any]] = (),
    error: float | None = None,
    budget: float | None = None,
    measures: Iterable[str] = (),
    references: Mapping[str, Any] | None = None,
    finer: Mapping[str, Any] | None = None,
    seeds: int | None = None,
    steps: int | None = None,
    jobs: int | None = None,
    replicas: int | None = None,
    force: bool = False,
    adapter: str | None = None,
    progress: Any = True,
) -> Tradeoff:
    """Measures what choices cost and how far each is off, and says which is the cheapest that meets the ``targets``: ``{"pressure": "1%"}``
    in parts of a reference, or numbers in units of the scene.

    With ``seeds`` every choice runs with the seed of the scene and those that follow: means are over them, with errors from their scatter.
    ``error`` is the relative standard error that means are to have, ``budget`` the seconds that all steps may take, and ``references`` are
    values that are known, alone or with their errors: ``{"pressure": (23.65, 0.01)}``.
    """
    study = _Study(
        "tradeoff", scene, settings, out, vary, also,
        seeds=seeds, steps=steps, jobs=jobs, replicas=replicas, force=force, adapter=adapter, progress=progress,
    )  # fmt: skip
    more = ",".join(f"{key}={text(value)}" for key, value in (finer or {}).items()) or None
    try:
        advice, chosen = _mesoscope.tradeoff(
            study, error=error, budget=budget, measures=list(measures), references=_named(references), targets=_named(targets), finer=more,
        )  # fmt: skip
    finally:
        study.close()
    return Tradeoff(study.out, advice.strip(), json.loads(chosen) if chosen else None)


def stability(
    scene: Any,
    vary: Mapping[str, Any] | None = None,
    settings: Mapping[str, Any] | None = None,
    out: str | os.PathLike[str] | None = None,
    *,
    tolerance: float = 0.05,
    bisections: int = 3,
    measures: Iterable[str] = (),
    references: Mapping[str, Any] | None = None,
    seeds: int | None = None,
    steps: int | None = None,
    jobs: int | None = None,
    replicas: int | None = None,
    force: bool = False,
    adapter: str | None = None,
    progress: Any = True,
) -> Stability:
    """Measures how far a scene may go: along one key, or two, of which each has values or a range such as ``"0.01..0.2/9"``. With ``seeds``
    every scene runs with the seed of the scene and those that follow, and means are over them.
    """
    study = _Study(
        "stability", scene, settings, out, vary or {}, (),
        seeds=seeds, steps=steps, jobs=jobs, replicas=replicas, force=force, adapter=adapter, progress=progress,
    )  # fmt: skip
    try:
        rows, findings = _mesoscope.stability(
            study, tolerance=tolerance, bisections=bisections, measures=list(measures), references=_named(references)
        )
    finally:
        study.close()
    return Stability(study.out, [dict(zip(("row", "right_up_to", "unstable_from", "laws"), row)) for row in rows], findings)


def report(*results: Any, out: str | os.PathLike[str] = "report.html", force: bool = False) -> Page:
    """Makes one page of runs and studies, given as results or as directories, with pictures inside: to send around.

    >>> import mesoscope as ms
    >>> small = {"space.box": [4, 4, 4], "time.equilibration": 20, "output": {}}
    >>> run = ms.run("dpd-fluid", small, out="reported", steps=100, progress=False)
    >>> ms.report(run, out="page.html").path.name
    'page.html'
    """
    directories = [os.fspath(getattr(result, "directory", result)) for result in results]
    more = ["--force"] if force else []
    done = subprocess.run(
        [program(), "report", "--out", os.fspath(out), *more, "--", *directories], check=False, capture_output=True, text=True
    )
    if done.returncode != 0:
        raise FileError(done.stderr.strip().removeprefix("error: "))
    return Page(Path(out))
