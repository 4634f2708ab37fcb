"""Structure of the frames of a run by freud and MDAnalysis, compared with what the run says of it.

Argument: the directory of a run with samples of all analyses at every frame of its trajectory.
"""

import json
import sys
import warnings
from pathlib import Path

import numpy as np

warnings.simplefilter("ignore", DeprecationWarning)

directory = Path(sys.argv[1])
run = json.loads((directory / "run.json").read_text())


def table(name):
    path = directory / name
    columns = path.open().readline().strip().split(",")
    return dict(zip(columns, np.genfromtxt(path, delimiter=",", skip_header=1, ndmin=2).T))


def frames():
    import gsd.hoomd

    with gsd.hoomd.open(directory / "trajectory.gsd") as trajectory:
        for frame in trajectory:
            kinds = np.array(frame.particles.types)[frame.particles.typeid]
            yield frame.configuration.box, frame.particles.position, frame.particles.image, kinds == "A", frame.bonds.group


def close(found, expected, tolerance, what):
    difference = np.abs(np.asarray(found, float) - np.asarray(expected, float)).max()
    assert difference <= tolerance, f"{what}: off by {difference}"
    print(f"{what}: at most {difference:.2g} apart")


def by_freud():
    import freud

    radial, sizes = table("radial_distribution.csv"), table("cluster_sizes.csv")
    asked = run["scene"]["output"]
    pairs = {"0_0": (True, True), "0_1": (True, False), "1_1": (False, False)}
    counts = {pair: 0 for pair in pairs}
    clusters = {}
    number = 0
    for box, position, _, is_a, _ in frames():
        number += 1
        box = freud.box.Box(*box[:3])
        for pair, species in pairs.items():
            first, second = (position[is_a == kind] for kind in species)
            settings = asked["radial_distribution"]
            distribution = freud.density.RDF(settings["bins"], settings["range"])
            distribution.compute((box, first), None if species[0] == species[1] else second)
            counts[pair] = counts[pair] + distribution.bin_counts / (2 if species[0] == species[1] else 1)
        cluster = freud.cluster.Cluster().compute((box, position[is_a]), neighbors={"r_max": asked["clusters"]["distance"]})
        for size in np.bincount(cluster.cluster_idx):
            clusters[size] = clusters.get(size, 0) + 1
    for pair in pairs:
        # Positions of single precision may be rounded across the edge of a bin.
        close(counts[pair], radial[f"pairs_{pair}"], 2, f"pairs by distance, freud {freud.__version__}, {pair}")
    found = sorted((int(size), count / number) for size, count in clusters.items())
    close(found, np.column_stack([sizes["size"], sizes["clusters"]]), 1e-9, "sizes of clusters and their numbers")


def by_numpy():
    """All wave vectors of the box, of which freud's own sample is an octant."""
    factor, asked = table("structure_factor.csv"), run["scene"]["output"]["structure_factor"]
    pairs = {"0_0": (True, True), "0_1": (True, False), "1_1": (False, False)}
    edges = np.linspace(0, asked["range"], asked["bins"] + 1)
    sums = {pair: [] for pair in pairs}
    for box, position, _, is_a, _ in frames():
        waves = np.arange(-8, 9)
        vectors = np.array(np.meshgrid(waves, waves, waves)).reshape(3, -1).T * 2 * np.pi / box[:3]
        lengths = np.linalg.norm(vectors, axis=1)
        kept = (lengths > 0) & (lengths < asked["range"])
        vectors, bins = vectors[kept], np.searchsorted(edges, lengths[kept], side="right") - 1
        density = {kind: np.exp(1j * vectors @ position[is_a == kind].astype(float).T).sum(1) for kind in (True, False)}
        for pair, (first, second) in pairs.items():
            product = (density[first] * density[second].conj()).real / np.sqrt((is_a == first).sum() * (is_a == second).sum())
            sums[pair].append(np.bincount(bins, product, asked["bins"]) / np.maximum(np.bincount(bins, minlength=asked["bins"]), 1))
    counted = np.bincount(bins, minlength=asked["bins"])
    close(counted[counted > 0] / 2, factor["vectors"], 0, "wave vectors, numpy " + np.__version__)
    for pair, found in sums.items():
        # Positions of the trajectory have single precision.
        close(np.mean(found, 0)[counted > 0], factor[f"structure_factor_{pair}"], 1e-4, f"structure factor, {pair}")


def by_mdanalysis():
    import MDAnalysis

    sizes = table("chain_sizes.csv")
    expected = np.column_stack([sizes["end_to_end_squared_0"], sizes["radius_of_gyration_squared_0"]])
    found = []
    for box, position, image, is_a, bonds in frames():
        way = (position + image * box[:3])[~is_a]
        universe = MDAnalysis.Universe.empty(len(way), trajectory=True)
        universe.add_TopologyAttr("mass", np.ones(len(way)))
        universe.atoms.positions = way
        chains = [universe.atoms[first : first + 4] for first in range(0, len(way), 4)]
        ends = [np.sum((chain.positions[0] - chain.positions[-1]) ** 2) for chain in chains]
        found.append([np.mean(ends), np.mean([chain.radius_of_gyration() ** 2 for chain in chains])])
    close(found, expected, 1e-5, f"end-to-end distance and radius of gyration, squared, MDAnalysis {MDAnalysis.__version__}")


for module, compare in [("numpy", by_numpy), ("freud", by_freud), ("MDAnalysis", by_mdanalysis)]:
    try:
        __import__("gsd")
        __import__(module)
    except ImportError:
        print(f"NOT TESTED: {module} cannot be installed")
        continue
    compare()
