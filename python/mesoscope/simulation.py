"""Simulations that are advanced step by step."""

from __future__ import annotations

import json
import os
import warnings
from dataclasses import dataclass, field
from typing import Any, Iterator, Mapping

import numpy as np

from . import _closing, _mesoscope
from .errors import ArrayError
from .results import Mean, png_of
from .scenes import overrides, source, text


@dataclass
class Frame:
    """Particles at a step in units of the scene, in the order of their numbers."""

    #: The step and its time.
    step: int
    time: float
    #: Edges of the box, one for each dimension.
    box: np.ndarray
    #: True for axes without walls across them.
    periodic: list[bool]
    #: Axis and length by which the copies of the box above are displaced along x, where boundaries shear.
    displacement: tuple[int, float] | None
    #: Positions, velocities at the full step, and turns round the box: (N, 3); components beyond the dimensions are zero.
    positions: np.ndarray
    velocities: np.ndarray
    images: np.ndarray
    #: Species as places in ``species_names``, and masses: (N,).
    species: np.ndarray
    masses: np.ndarray
    species_names: list[str] = field(default_factory=list)
    bonds: np.ndarray = field(default_factory=lambda: np.zeros((0, 2), np.uint32))
    _simulation: Any = field(default=None, repr=False)

    @property
    def unwrapped(self) -> np.ndarray:
        """Positions without turns at the boundaries: ways are differences of these."""
        self._check_upright("ways across boundaries that shear are no whole numbers of boxes")
        return self.positions + self.images * self._edges(0.0)

    def _edges(self, rest: float) -> np.ndarray:
        edges = np.full(3, rest)
        edges[: len(self.box)] = self.box
        return edges

    def _check_upright(self, why: str) -> None:
        if self.displacement is not None:
            raise ArrayError(f"{why}; Simulation.write makes a trajectory whose cell leans")

    @property
    def fields(self) -> dict[str, np.ndarray]:
        """Fields of shallow water on the nodes along x and y, as long as the simulation has not gone on."""
        if self._simulation is None or self._simulation.step != self.step:
            raise ArrayError("the simulation has gone on: read `fields` of a frame before the next step")
        return self._simulation.fields

    def of(self, species: str) -> np.ndarray:
        """True for the particles of a species."""
        if species not in self.species_names:
            raise ArrayError(f"there is no species {species!r}; accepted: {', '.join(self.species_names)}")
        return self.species == self.species_names.index(species)

    def to_gsd(self):
        """A ``gsd.hoomd.Frame``, whose box is centred at the origin."""
        import gsd.hoomd

        self._check_upright("a frame in memory has an upright box, and boundaries shear")
        edges = self._edges(1.0)
        frame = gsd.hoomd.Frame()
        frame.configuration.step = self.step
        frame.configuration.dimensions = max(len(self.box), 2)
        frame.configuration.box = [*edges, 0, 0, 0]
        frame.particles.N = len(self.positions)
        frame.particles.position = (self.positions - self._edges(0.0) / 2).astype(np.float32)
        frame.particles.velocity = self.velocities.astype(np.float32)
        frame.particles.image = self.images.astype(np.int32)
        frame.particles.types = self.species_names
        frame.particles.typeid = self.species.astype(np.uint32)
        frame.particles.mass = self.masses.astype(np.float32)
        if len(self.bonds):
            frame.bonds.N = len(self.bonds)
            frame.bonds.types = ["bond"]
            frame.bonds.typeid = np.zeros(len(self.bonds), np.uint32)
            frame.bonds.group = self.bonds
        return frame

    def to_freud(self):
        """A pair of ``freud.box.Box`` and positions about its centre, as freud's analyses take them."""
        import freud

        self._check_upright("a box of freud has its own conventions for cells that lean, and boundaries shear")
        edges = self._edges(1.0)
        box = freud.box.Box(*edges[:2], is2D=True) if len(self.box) == 2 else freud.box.Box(*edges)
        box.periodic = [*self.periodic, True, True][:3]
        return box, (self.positions - self._edges(0.0) / 2).astype(np.float32)

    def to_mdanalysis(self):
        """An ``MDAnalysis.Universe`` of this frame in memory."""
        import MDAnalysis
        from MDAnalysis.coordinates.memory import MemoryReader

        self._check_upright("a universe in memory has an upright box, and boundaries shear")
        universe = MDAnalysis.Universe.empty(len(self.positions), trajectory=True, velocities=True)
        universe.add_TopologyAttr("types", [self.species_names[number] for number in self.species])
        universe.add_TopologyAttr("masses", self.masses)
        if len(self.bonds):
            universe.add_TopologyAttr("bonds", [tuple(pair) for pair in self.bonds.tolist()])
        universe.load_new(
            self.positions[None].astype(np.float32),
            format=MemoryReader,
            dimensions=[*self._edges(1.0), 90, 90, 90],
            velocities=self.velocities[None].astype(np.float32),
        )
        return universe


def _array(name: str, value: Any) -> np.ndarray:
    array = np.asarray(value)
    if array.dtype.kind not in "fiu":
        raise ArrayError(f"{name}: found an array of {array.dtype}; accepted: real numbers")
    if array.ndim != 2 or array.shape[1] not in (1, 2, 3):
        raise ArrayError(f"{name}: found the shape {array.shape}; accepted: (N, 3), or (N, 2) in two dimensions")
    return np.ascontiguousarray(array, dtype=np.float64)


class Simulation:
    """A scene on a device, advanced by a given number of steps at a time; its state can be read and changed between steps.

    The device closes at the end of a ``with``, or with :meth:`close`. There is no callback for forces: they are computed on
    the device, inside of a step; a new force is a term of the scene.

    >>> import mesoscope as ms
    >>> with ms.Simulation("dpd-fluid", settings={"space.box": [4, 4, 4], "output": {}}) as sim:
    ...     speeds = [abs(frame.velocities).max() for frame in sim.steps(40, every=20)]
    ...     rounding = sim.set("temperature", 2.0)
    ...     sim.advance(10)
    >>> len(speeds)
    2
    """

    def __init__(
        self,
        scene: Any,
        settings: Mapping[str, Any] | None = None,
        *,
        positions: Any = None,
        velocities: Any = None,
        seed: int | None = None,
        announced: Mapping[str, float] | None = None,
        adapter: str | None = None,
        ranks: int = 1,
    ) -> None:
        ranks = _whole("ranks", ranks)
        name, written = source(scene)
        settings = dict(settings or {}) | ({} if seed is None else {"seed": seed})
        if announced is not None:
            settings["announced"] = [{"key": key, "largest": largest} for key, largest in announced.items()]
        self._inner = _mesoscope.Simulation.start(name, written, overrides(settings), adapter, ranks)
        self._begin()
        try:
            if positions is not None:
                self.set_positions(positions)
            if velocities is not None:
                self.set_velocities(velocities)
        except Exception:
            self.close()
            raise

    def _begin(self) -> None:
        for shared in self._inner.ranks()[1]:
            warnings.warn(shared, RuntimeWarning, stacklevel=3)
        self._bonds: np.ndarray | None = None
        self.species_names: list[str] = self._inner.species_names()
        _closing.register(self)

    @classmethod
    def resume(cls, path: str | os.PathLike[str], *, adapter: str | None = None, ranks: int = 1) -> "Simulation":
        """The simulation that goes on from a checkpoint: of :meth:`checkpoint`, or of a run."""
        made = cls.__new__(cls)
        made._inner = _mesoscope.Simulation.resume(os.fspath(path), adapter, _whole("ranks", ranks))
        made._begin()
        return made

    def __enter__(self) -> "Simulation":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Closes the device. The simulation cannot be used after that."""
        self._inner.close()

    def __repr__(self) -> str:
        if self._inner.is_closed():
            return "<mesoscope.Simulation, closed>"
        return f"<mesoscope.Simulation of {self.scene['title']!r} at step {self.step} on {self.adapter}>"

    def _repr_png_(self) -> bytes | None:
        return None if self._inner.is_closed() else self.png()

    @property
    def step(self) -> int:
        """The current step."""
        return self._inner.step()

    @property
    def time(self) -> float:
        """Its time, in units of the scene."""
        return self._inner.time()

    @property
    def adapter(self) -> str:
        """The name of the adapter."""
        return self._inner.adapter()

    @property
    def ranks(self) -> int:
        """The number of ranks that share the simulation: threads of this process, each with an adapter and a part of the box."""
        return self._inner.ranks()[0]

    @property
    def scene(self) -> dict[str, Any]:
        """The scene with every default, as changes have left it."""
        return json.loads(self._inner.scene())

    @property
    def changes(self) -> list[dict[str, Any]]:
        """The changes so far, with their steps."""
        return json.loads(self._inner.changes())

    def advance(self, steps: int) -> None:
        """Takes steps, and returns when the device has done them."""
        self._inner.advance(_whole("steps", steps))

    def steps(self, steps: int, every: int = 1) -> Iterator[Frame]:
        """Frames of the next steps, every so many of them; the last step has one."""
        left, every = _whole("steps", steps), _whole("every", every)
        if every == 0:
            raise ArrayError("every: found 0; accepted: a number of steps")
        while left > 0:
            now = min(left, every)
            self._inner.advance(now)
            left -= now
            yield self.frame()

    def frame(self) -> Frame:
        """The particles at the current step."""
        if self._bonds is None:
            self._bonds = self._inner.bonds()
        found = self._inner.frame()
        return Frame(**found, species_names=self.species_names, bonds=self._bonds, _simulation=self)

    @property
    def observables(self) -> dict[str, float]:
        """The numbers of a row of the table of energies at the current step."""
        return dict(self._inner.observables())

    def __getattr__(self, name: str) -> Any:
        # Numbers of the table: `sim.pressure`, `sim.temperature`.
        if name.startswith("_"):
            raise AttributeError(name)
        found = dict(self._inner.observables())
        if name in found:
            return found[name]
        raise AttributeError(f"a simulation has no {name!r}; observables of this scene: {', '.join(found)}")

    @property
    def stress(self) -> np.ndarray:
        """The pressure tensor at the current step: (3, 6), from motion, conservative forces, and friction with noise, as xx, yy, zz, xy, xz,
        yz. The scene needs ``output.stress``."""
        found = self._inner.stress()
        if found is None:
            raise ArrayError('this scene does not measure the stress; make it with settings={"output.stress": {"every": 1}}')
        return np.asarray(found)

    @property
    def energies(self) -> dict[str, np.ndarray]:
        """The table of energies since the simulation began, every ``output.energies.every`` steps."""
        names, rows = self._inner.energies()
        return {name: rows[:, column] for column, name in enumerate(names)}

    def mean(self, name: str) -> Mean:
        """The mean of a column of this table, with its standard error, after equilibration and after the last change."""
        found = dict(self._inner.means())
        if name not in found:
            raise ArrayError(f"there is no column {name!r}; accepted: {', '.join(found)}")
        mean = found[name]
        return Mean(*mean) if mean else Mean(float("nan"), None, 0, True)

    @property
    def fields(self) -> dict[str, np.ndarray]:
        """Fields of shallow water at the current step, each of shape (nodes along x, nodes along y)."""
        return {name: values for name, _, values in self._inner.fields()}

    @property
    def cells(self) -> tuple[np.ndarray, list[list[int]]] | None:
        """Areas of Voronoi cells and the numbers of their neighbours; none of other scenes."""
        return self._inner.cells()

    def set(self, key: str, value: Any) -> tuple[float, list[float]]:
        """Changes a number of the scene: the temperature, a number of an interaction, of a wall, the rate of shear.

        Returns the largest rounding of momenta, and the change of their sum, which are zero unless the change needs a larger unit than
        the scene, and the largest values that ``announced`` has, asked for. The first change of a simulation without ``announced``
        compiles the kernels once more.
        """
        return self._inner.set(key, text(value))

    def set_positions(self, positions: Any) -> float:
        """Moves all particles; returns the largest rounding."""
        return self._inner.set_positions(_array("positions", positions))

    def set_velocities(self, velocities: Any) -> float:
        """Gives all particles other velocities; returns the largest rounding."""
        return self._inner.set_velocities(_array("velocities", velocities))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Adds the current step to a trajectory, ``.gsd`` or ``.xyz``; the first frame of a simulation begins the file anew."""
        self._inner.write(os.fspath(path))

    def checkpoint(self, path: str | os.PathLike[str]) -> None:
        """Saves the current step, from which :meth:`resume` continues to the bit."""
        self._inner.checkpoint(os.fspath(path))

    def summary(self, path: str | os.PathLike[str]) -> None:
        """Writes what ``run.json`` says of a run: scene, adapter, changes, speed, and means with errors since the last change."""
        self._inner.summary(os.fspath(path))

    def draw(self) -> np.ndarray | None:
        """A picture of the current step: (height, width, 4) bytes; none of particles on a line."""
        return self._inner.draw()

    def png(self) -> bytes | None:
        """The same as the bytes of a PNG file."""
        pixels = self.draw()
        return None if pixels is None else png_of(pixels)


def _whole(name: str, value: Any) -> int:
    if isinstance(value, bool) or int(value) != value or value < 0:
        raise ArrayError(f"{name}: found {value!r}; accepted: a whole number, zero or more")
    return int(value)
