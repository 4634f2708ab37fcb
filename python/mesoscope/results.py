"""What runs leave in their directories."""

from __future__ import annotations

import csv
import html
import json
import os
import struct
import zlib
from base64 import b64encode
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .errors import ArrayError, FileError


class Mean(NamedTuple):
    """A measured number with its standard error, of 68 %."""

    value: float
    #: None where the samples are too few.
    error: float | None
    samples: int = 0
    #: True if the error is not known to a quarter of itself, and may be larger.
    few: bool = False
    unit: str = ""

    def __str__(self) -> str:
        value, unit = self.value, f" {self.unit}" if self.unit not in ("", "number") else ""
        if self.error is None or not np.isfinite(self.error):
            return f"{value:.6g}{unit}"
        if self.error == 0:
            return f"{value:.10g}{unit}"
        digits = max(0, 1 - int(np.floor(np.log10(self.error))))
        return f"{value:.{digits}f} ± {self.error:.{digits}f}{'*' if self.few else ''}{unit}"

    def __float__(self) -> float:
        return float(self.value)


class _Shown:
    """A file that notebooks show."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __repr__(self) -> str:
        return f"<mesoscope.{type(self).__name__} {str(self.path)!r}>"

    def __fspath__(self) -> str:
        return str(self.path)


class Picture(_Shown):
    """A picture that was drawn."""

    def _repr_png_(self) -> bytes:
        return self.path.read_bytes()


class Page(_Shown):
    """A page of HTML."""

    def _repr_html_(self) -> str:
        page = html.escape(self.path.read_text(encoding="utf-8"))
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 60em; border: 0"></iframe>'


def _picture(directory: Path, name: str) -> Picture:
    path = directory / (name if name.endswith(".png") else f"{name}.png")
    if not path.exists():
        drawn = ", ".join(sorted(file.stem for file in directory.glob("*.png")))
        raise ArrayError(f"no picture {name!r} was drawn; accepted: {drawn or 'nothing'}")
    return Picture(path)


def _numbers(cells: list[str]) -> np.ndarray:
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return np.array(cells, dtype=object)


def read_table(path: Path) -> dict[str, np.ndarray]:
    """A table as arrays by the names of its columns; empty cells are NaN."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    except OSError as error:
        raise FileError(f"cannot read the table `{path}`: {error.strerror}") from None
    if not rows:
        raise FileError(f"`{path}` is empty: the run has not written it, or it was cut off")
    names, rows = rows[0], rows[1:]
    for number, row in enumerate(rows, start=2):
        if len(row) != len(names):
            raise FileError(f"`{path}`, line {number}: found {len(row)} cells; accepted: {len(names)}, as in its first line")
    return {name: _numbers([row[place] for row in rows]) for place, name in enumerate(names)}


def _mean(found: Any) -> Mean:
    if found is None:
        return Mean(float("nan"), None)
    if not isinstance(found, dict):
        return Mean(found, 0.0)
    value = found.get("value")
    return Mean(
        float("nan") if value is None else value,
        found.get("error"),
        int(found.get("samples", 0)),
        bool(found.get("few", False)),
        found.get("unit", ""),
    )


class Run:
    """A run that has ended, by its directory."""

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.directory = Path(directory)
        path = self.directory / "run.json"
        try:
            self.summary: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            raise FileError(f"there is no finished run in `{self.directory}`: it has no run.json; `resume` finishes one") from None
        except ValueError as error:
            raise FileError(f"`{path}` is no summary of a run: {error}") from None

    def __repr__(self) -> str:
        return f"<mesoscope.Run of {self.title!r} in {str(self.directory)!r}, {self.steps} steps>"

    def _repr_html_(self) -> str:
        def row(name: str, mean: Mean) -> str:
            return f"<tr><td>{html.escape(name)}</td><td>{html.escape(str(mean))}</td></tr>"

        means = "".join(row(name, mean) for name, mean in self.means.items() if np.isfinite(mean.value))
        warnings = "".join(f"<li>{html.escape(warning)}</li>" for warning in self.warnings)
        picture = self.directory / "energies.png"
        drawn = f'<img width="720" src="data:image/png;base64,{b64encode(picture.read_bytes()).decode()}"/>' if picture.exists() else ""
        adapter = self.summary.get("adapter", {}).get("name", "")
        return (
            f"<h3>{html.escape(self.title)}</h3><p>{self.steps} steps of {self.summary.get('particles')} particles "
            f"on {html.escape(adapter)}</p>{drawn}<table>{means}</table>" + (f"<ul>{warnings}</ul>" if warnings else "")
        )

    @property
    def title(self) -> str:
        """The title of its scene."""
        return self.summary["scene"]["title"]

    @property
    def scene(self) -> dict[str, Any]:
        """The scene with every default."""
        return self.summary["scene"]

    @property
    def steps(self) -> int:
        """The step of its end."""
        return self.summary["steps"]

    @property
    def warnings(self) -> list[str]:
        """What to know before trusting the numbers."""
        return list(self.summary.get("warnings", []))

    @property
    def means(self) -> dict[str, Mean]:
        """The means of the table of energies after equilibration."""
        return {name: _mean(found) for name, found in self.summary["means"].items()}

    def mean(self, name: str) -> Mean:
        """The mean of a column of the table of energies after equilibration, or a number that an analysis found:
        ``diffusion.diffusion_einstein``."""
        if name in self.summary["means"]:
            return _mean(self.summary["means"][name])
        found: Any = self.summary.get("results", {})
        for part in name.split("."):
            found = found.get(part) if isinstance(found, dict) else None
        if found is None:
            known = list(self.summary["means"])
            known += [f"{key}.{inner}" for key, held in self.results.items() if isinstance(held, dict) for inner in held]
            raise ArrayError(f"this run has no number {name!r}; accepted: {', '.join(known)}")
        return _mean(found)

    @property
    def results(self) -> dict[str, Any]:
        """What analyses found, as ``run.json`` has it."""
        return self.summary.get("results", {})

    def stage(self, number: int) -> "Run":
        """What analyses of an earlier stage have left, counted from 1: ``run.stage(2).rdf()``. Those of the last stage are the run's."""
        stages = self.summary.get("stages", [])
        kept = {place: stage["directory"] for place, stage in enumerate(stages, 1) if "directory" in stage}
        if number not in kept:
            held = ", ".join(map(str, kept)) or "none, for `output` of no earlier stage asks for analyses"
            raise ArrayError(f"stage {number} of this run has no analyses of its own; accepted: {held}")
        return Run(self.directory / kept[number])

    @property
    def energies(self) -> dict[str, np.ndarray]:
        """The table of energies: an array for every column."""
        return self.table("energies")

    def table(self, name: str) -> dict[str, np.ndarray]:
        """A table of the run: an array for every column."""
        file = name if name.endswith(".csv") else f"{name}.csv"
        if file not in self.summary.get("columns", {}) and not (self.directory / file).exists():
            known = [table.removesuffix(".csv") for table in self.summary.get("columns", {}) if table.endswith(".csv")]
            raise ArrayError(f"this run has no table {name!r}; accepted: {', '.join(known)}")
        return read_table(self.directory / file)

    def columns(self, name: str) -> list[dict[str, Any]]:
        """The columns of a table, each with its symbol, unit and meaning."""
        return self.summary["columns"][name if name.endswith(".csv") else f"{name}.csv"]

    def plot(self, name: str = "energies") -> Picture:
        """A picture that the run has drawn: ``energies``, ``snapshot``, or the name of a table."""
        return _picture(self.directory, name)

    def rdf(self, one: str | None = None, other: str | None = None) -> dict[str, np.ndarray]:
        """The radial distribution function: ``distance``, ``g`` and its ``error``; of two species where the run has counted them."""
        table = self.table("radial_distribution")
        found = {column["name"]: _species(column) for column in self.columns("radial_distribution")}
        # A curve has its errors in a column beside it.
        curves = {name: species for name, species in found.items() if f"{name}_error" in table}
        if one is not None:
            wanted = {one, other or one}
            curves = {name: species for name, species in curves.items() if set(species) == wanted}
        if len(curves) != 1:
            pairs = sorted({"–".join(species) or "all" for name, species in found.items() if f"{name}_error" in table})
            raise ArrayError(f"this run has g(r) of {', '.join(pairs)}; name one of these pairs")
        (name,) = curves
        return {"distance": table["distance"], "g": table[name], "error": table[f"{name}_error"]}

    def diffusion(self, species: str | None = None) -> Mean:
        """The diffusion coefficient from mean squared displacements."""
        stages = self.scene.get("stages", [])
        measured = ((stages[-1] if stages else {}).get("output", {}).get("diffusion") or self.scene["output"].get("diffusion", {})).get("species")
        if species is not None and species != measured:
            raise ArrayError(f"this run measured the diffusion of {measured or 'all particles'}, not of {species!r}: set output.diffusion.species")
        return self.mean("diffusion.diffusion_einstein")

    def trajectory(self, unwrap: bool = False) -> np.ndarray:
        """Positions of all frames: (frames, N, 3), in the box or, unwrapped, along the ways. Reads GSD with the package ``gsd``."""
        path = self.directory / "trajectory.gsd"
        if not path.exists():
            raise ArrayError("this run has no trajectory.gsd: set output.trajectory to {\"every\": …}")
        try:
            import gsd.hoomd
        except ImportError:
            raise FileError("reading trajectories takes the package gsd: pip install gsd") from None
        edges = np.zeros(3)
        lengths = self.scene["space"]["box"]
        edges[: len(lengths)] = lengths
        with gsd.hoomd.open(path, "r") as file:
            frames = []
            for frame in file:
                if np.any(frame.configuration.box[3:]):
                    raise ArrayError(
                        "boundaries shear, and cells of this trajectory lean: read it with the package gsd, which has the box of every frame"
                    )
                # Files have the origin in the middle of the box.
                positions = frame.particles.position.astype(np.float64) + edges / 2
                frames.append(positions + frame.particles.image * edges if unwrap else positions)
        return np.array(frames)

    @property
    def field_times(self) -> np.ndarray:
        """The times of the frames of :attr:`fields`."""
        step = self.scene["time"]["step"]
        return np.array([frame["step"] * step for frame in self._field_frames()])

    def _field_frames(self) -> list[dict[str, Any]]:
        # The end has arrays without a number, which are those of the last number if that is of its step.
        numbered = [frame for frame in self.summary.get("numbered", []) if frame["step"] < self.steps]
        return [*numbered, {"number": None, "step": self.steps}]

    @property
    def fields(self) -> dict[str, np.ndarray]:
        """Fields of shallow water: each of shape (frames, nodes along x, nodes along y), of which the last is the end."""
        ends = sorted(path for path in self.directory.glob("*.npy") if not path.stem.rpartition("-")[2].isdigit())
        if not ends:
            raise ArrayError("this run has no arrays of fields; runs of shallow water have, with output.fields.format npy")
        frames = self._field_frames()

        def array(name: str, number: int | None) -> np.ndarray:
            path = self.directory / (f"{name}.npy" if number is None else f"{name}-{number:06}.npy")
            if not path.exists():
                raise FileError(f"`{path}` is not there, which the run has written")
            return np.load(path)

        return {path.stem: np.array([array(path.stem, frame["number"]) for frame in frames]) for path in ends}

    def to_xarray(self) -> Any:
        """The fields of the end with their coordinates, as an ``xarray.Dataset``."""
        import xarray

        mesh = self.summary["mesh"]
        coordinates = {axis: np.arange(count) * step for axis, count, step in zip("xy", mesh["nodes"], mesh["spacing"])}
        return xarray.Dataset({name: (("x", "y"), frames[-1]) for name, frames in self.fields.items()}, coords=coordinates)


def _species(column: dict[str, Any]) -> list[str]:
    found = column.get("species", [])
    return [found] if isinstance(found, str) else list(found)


class _Study:
    """A study by its directory: a table and pictures."""

    _kind = ""

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.directory = Path(directory)
        path = self.directory / f"{self._kind}.json"
        try:
            self.summary: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            raise FileError(f"there is no {self._kind} in `{self.directory}`: it has no {path.name}") from None

    def __repr__(self) -> str:
        return f"<mesoscope.{type(self).__name__} in {str(self.directory)!r}>"

    def table(self) -> dict[str, np.ndarray]:
        """The table: an array for every column."""
        return read_table(self.directory / f"{self._kind}.csv")

    def to_pandas(self) -> Any:
        """The table as a ``pandas.DataFrame``."""
        import pandas

        return pandas.DataFrame(self.table())

    def plots(self) -> list[Picture]:
        """The pictures."""
        return [Picture(path) for path in sorted(self.directory.glob(f"{self._kind}*.png"))]


class Sweep(_Study):
    """Runs of a scene that differ in a few values."""

    _kind = "sweep"

    def __init__(self, directory: str | os.PathLike[str], failures: dict[str, str] | None = None) -> None:
        super().__init__(directory)
        #: Why variants failed, by their names.
        self.failures = dict(failures or {})

    def averages(self) -> dict[str, np.ndarray]:
        """The table of averages over seeds."""
        return read_table(self.directory / "sweep-averages.csv")

    def runs(self) -> list[Run]:
        """The runs that have finished."""
        names = [variant["name"] for variant in self.summary["variants"] if variant["state"] == "finished"]
        return [Run(self.directory / name) for name in names]

    def plot(self, name: str = "sweep-means") -> Picture:
        """A picture of the sweep."""
        return _picture(self.directory, name)


class _Told(_Study):
    """A study that leaves a page in words."""

    @property
    def page(self) -> str:
        """All that was found, as Markdown."""
        return (self.directory / f"{self._kind}.md").read_text(encoding="utf-8")

    def _repr_markdown_(self) -> str:
        return self.page


class Tradeoff(_Told):
    """What choices cost, and how far each is off."""

    _kind = "tradeoff"

    def __init__(self, directory: str | os.PathLike[str], advice: str = "", scene: dict[str, Any] | None = None) -> None:
        super().__init__(directory)
        #: What to choose, in words; empty without targets.
        self.advice = advice
        #: The scene of the choice, if there is one.
        self.scene = scene


class Stability(_Told):
    """How far a scene may go."""

    _kind = "stability"

    def __init__(
        self, directory: str | os.PathLike[str], rows: list[dict[str, str]] | None = None, findings: list[str] | None = None
    ) -> None:
        super().__init__(directory)
        #: The result of each row in words.
        self.rows = rows or []
        #: What else was found.
        self.findings = findings or []


def open(directory: str | os.PathLike[str]) -> Run | Sweep | Tradeoff | Stability:
    """The run or study in a directory."""
    path = Path(directory)
    for kind, name in ((Sweep, "sweep.json"), (Tradeoff, "tradeoff.json"), (Stability, "stability.json")):
        if (path / name).exists():
            return kind(path)
    return Run(path)


def png_of(pixels: np.ndarray) -> bytes:
    """Pixels of shape (height, width, 4) as the bytes of a PNG file."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width, _ = pixels.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], axis=1)
    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b"")
