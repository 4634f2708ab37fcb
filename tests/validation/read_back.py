"""Reads trajectories with other programs' packages, and compares them with what was written.

Arguments: a directory of cases, each with `expected.json`, `trajectory.gsd` and `trajectory.xyz`.
"""

import json
import sys
import warnings
from importlib.metadata import version
from pathlib import Path

import numpy as np

warnings.simplefilter("ignore", DeprecationWarning)


def close(found, expected, scale, what):
    """Single precision of numbers up to a scale."""
    difference = np.abs(np.asarray(found, float) - np.asarray(expected, float)).max(initial=0.0)
    assert difference <= 4e-7 * scale, f"{what}: off by {difference}, scale {scale}"


def unwrapped(case):
    return np.array([frame["unwrapped"] for frame in case["frames"]])


def mean_squared_displacement(way):
    """Averaged over particles and origins, lag by lag."""
    return np.array([((way[lag:] - way[: len(way) - lag]) ** 2).sum(-1).mean() for lag in range(len(way))])


def gsd_frames(case, path):
    import gsd.hoomd

    lengths, gaps, dimension = np.array(case["lengths"]), np.array(case["gaps"]), case["dimension"]
    reach = np.abs(unwrapped(case)).max(initial=0.0) + lengths.max()
    with gsd.hoomd.open(path, "r") as trajectory:
        assert len(trajectory) == len(case["frames"])
        for found, expected in zip(trajectory, case["frames"]):
            found.validate()
            particles = found.particles
            assert found.configuration.step == expected["step"]
            assert found.configuration.dimensions == max(dimension, 2)
            assert found.log["time"] == expected["time"]
            assert (found.bonds.N, found.angles.N) == (case["bonds"], case["angles"])
            assert bytes(found.log["run_id"]).decode() == case["run_id"]
            assert [particles.types[kind] for kind in particles.typeid] == expected["names"]
            size = found.configuration.box[:3].astype(float)
            close(size[:dimension], lengths[:dimension], lengths.max(), "box")
            assert (np.abs(particles.position) <= size / 2 * (1 + 1e-6)).all()
            # The centre of the box, or of what is between walls, is the origin.
            middle = np.where(np.arange(3) < dimension, (lengths - gaps) / 2, 0.0)
            close(particles.position + particles.image * size + middle, expected["unwrapped"], reach, "unwrapped")
            close(particles.velocity, expected["velocities"], np.abs(expected["velocities"]).max(), "velocities")
            close(particles.mass, expected["masses"], max(expected["masses"]), "masses")
    return len(case["frames"])


def mdanalysis_universe(case, path):
    import gsd.hoomd
    import MDAnalysis
    from MDAnalysis.analysis.msd import EinsteinMSD
    from MDAnalysis.coordinates.memory import MemoryReader

    frames = case["frames"]
    universe = MDAnalysis.Universe(str(path))
    assert universe.atoms.n_atoms == len(frames[0]["names"])
    assert list(universe.atoms.types) == frames[0]["names"]
    close(universe.atoms.masses, frames[0]["masses"], max(frames[0]["masses"]), "masses")
    assert len(getattr(universe, "bonds", [])) == case["bonds"]
    assert len(getattr(universe, "angles", [])) == case["angles"]
    for step, frame in zip(universe.trajectory, frames):
        assert step.data["step"] == frame["step"]
    # Its reader of GSD takes positions only; velocities, times and images come from the file by the package `gsd`.
    with gsd.hoomd.open(path, "r") as trajectory:
        size = trajectory[0].configuration.box[:3]
        way = np.array([frame.particles.position + frame.particles.image * size for frame in trajectory])
        velocities = np.array([frame.particles.velocity for frame in trajectory])
        times = [frame.log["time"][0] for frame in trajectory]
    universe.load_new(way, format=MemoryReader, velocities=velocities, dt=times[1] - times[0])
    for step, frame in zip(universe.trajectory, frames):
        assert abs(step.time - frame["time"]) <= 1e-9 * (1 + frame["time"])
        close(step.velocities, frame["velocities"], np.abs(frame["velocities"]).max(), "velocities")
    found = EinsteinMSD(universe, msd_type="xyz", fft=False).run().results.timeseries
    expected = mean_squared_displacement(unwrapped(case))
    reach = np.abs(unwrapped(case)).max() + max(case["lengths"])
    # A difference of two numbers of single precision, squared.
    slack = 4e-7 * reach * (np.sqrt(expected.max()) + 4e-7 * reach) * 8
    assert np.abs(found - expected).max() <= slack, f"mean squared displacement: {found} from {expected}"
    assert expected.max() > 0
    return len(frames)


def ase_frames(case, path):
    import ase.io

    lengths, dimension = np.array(case["lengths"]), case["dimension"]
    reach = np.abs(unwrapped(case)).max(initial=0.0) + lengths.max()
    found = ase.io.read(path, ":", format="extxyz")
    assert len(found) == len(case["frames"])
    for atoms, expected in zip(found, case["frames"]):
        assert atoms.info["Step"] == expected["step"] and atoms.info["Time"] == expected["time"]
        assert atoms.info["run_id"] == case["run_id"]
        close(atoms.cell.lengths(), lengths - np.array(case["gaps"]), lengths.max(), "cell")
        assert list(atoms.pbc) == [axis < dimension and case["gaps"][axis] == 0 for axis in range(3)]
        if "species_name" in atoms.arrays:
            assert list(atoms.arrays["species_name"]) == expected["words"]
            symbols = {}
            for symbol, name in zip(atoms.get_chemical_symbols(), expected["words"]):
                assert symbols.setdefault(symbol, name) == name, f"{symbol} stands for two species"
        else:
            assert atoms.get_chemical_symbols() == expected["names"]
        close(atoms.get_masses(), expected["masses"], max(expected["masses"]), "masses")
        heavy = atoms.get_masses() > 0
        speed = np.abs(expected["velocities"]).max()
        momenta = np.array(expected["masses"])[:, None] * np.array(expected["velocities"])
        close(atoms.get_momenta(), momenta, np.abs(momenta).max(), "momenta")
        close(atoms.get_velocities()[heavy], np.array(expected["velocities"])[heavy], speed, "velocities")
        close(atoms.arrays["velo"], expected["velocities"], speed, "velo")
        shift = atoms.arrays["map_shift"] * np.where(np.arange(3) < dimension, lengths, 0.0)
        close(atoms.positions + shift, expected["unwrapped"], reach, "unwrapped")
    return len(found)


READERS = {
    "gsd": ("trajectory.gsd", gsd_frames),
    "MDAnalysis": ("trajectory.gsd", mdanalysis_universe),
    "ase": ("trajectory.xyz", ase_frames),
}


def main():
    np.seterr(invalid="ignore")
    missing = []
    for package in READERS:
        try:
            __import__(package)
        except ImportError as error:
            missing.append(f"{package} ({error})")
            print(f"NOT TESTED with {package}: {error}")
    for place in sorted(Path(sys.argv[1]).iterdir()):
        case = json.loads((place / "expected.json").read_text())
        for package, (name, check) in READERS.items():
            if any(entry.startswith(package) for entry in missing):
                continue
            print(f"{place.name}: {package} {version(package)} read {check(case, place / name)} frames")


main()
