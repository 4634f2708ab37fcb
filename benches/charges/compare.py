"""Salt water of .6 mol/l beside LAMMPS, in turns: seconds of a step, and the true error of forces between charges.

python3 benches/charges/compare.py MESOSCOPE [EDGE [ROUNDS]]

MESOSCOPE is the program. LAMMPS is that of `sh benches/dpd/lammps.sh`, on two processes of MPICH's `mpiexec`; its charges are those of Slater, 1/lamda = .929,
which have the contact energy of a Gaussian .6076 wide. The true error of its settings is the root mean square difference of forces on ions from those
with a cutoff of 9.5, over their root mean square, in a box of 10: what it reports itself knows nothing of the cut tail. Needs NumPy.
"""

import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
LAMMPS = ROOT / "target/lammps"
ENVIRONMENT = {**os.environ, "LD_LIBRARY_PATH": str(LAMMPS / "lib"), "OMP_NUM_THREADS": "1"}
COMMAND = LAMMPS / "environment/bin/lmp"
# The wheel is built for MPICH.
MPIEXEC = shutil.which("mpiexec.mpich") or "mpiexec"
BJERRUM = 1.1039
# Cutoff of charges and accuracy asked of PPPM: as in its examples, and for a true error below a thousandth.
SETTINGS = [(3.0, 1e-3), (5.0, 3e-4)]


def lammps(directory, text, processes=1):
    (directory / "in").write_text(text)
    command = [COMMAND, "-in", "in", "-log", "log"]
    command = [MPIEXEC, "-n", str(processes), *command] if processes > 1 else command
    subprocess.run(command, cwd=directory, env=ENVIRONMENT, check=True, stdout=subprocess.DEVNULL)
    return (directory / "log").read_text()


def beads(edge):
    ions = round(0.098 * edge**3)
    return [round(3 * edge**3) - 2 * ions, ions, ions]


def start(edge):
    charge = BJERRUM**0.5
    water, cations, anions = beads(edge)
    return f"""units lj
atom_style charge
comm_modify vel yes
newton on
region box block 0 {edge} 0 {edge} 0 {edge}
create_box 3 box
create_atoms 1 random {water} 87287 NULL
create_atoms 2 random {cations} 4928 NULL
create_atoms 3 random {anions} 5928 NULL
mass * 1.0
set type 2 charge {charge}
set type 3 charge {-charge}
velocity all create 1.0 9999
"""


def fluid(cutoff, accuracy):
    return f"""pair_style dpd/coul/slater/long 1.0 1.0 34387 {1 / 0.929} {cutoff}
pair_coeff 1 1 25 4.5 no
pair_coeff 1 2*3 25 4.5 no
pair_coeff 2 2*3 25 4.5 yes
pair_coeff 3 3 25 4.5 yes
kspace_style pppm {accuracy}
neigh_modify one 20000 page 2000000
"""


def forces(directory, cutoff, accuracy):
    text = f"""units lj
atom_style charge
comm_modify vel yes
read_data salt.data
pair_style coul/slater/long {1 / 0.929} {cutoff}
pair_coeff * *
kspace_style pppm {accuracy}
neigh_modify one 20000 page 2000000
group ions type 2 3
dump 1 ions custom 1 forces id fx fy fz
dump_modify 1 sort id format float %.12g
run 0
"""
    lammps(directory, text)
    return np.loadtxt(directory / "forces", skiprows=9)[:, 1:]


def true_errors(directory):
    lammps(directory, start(10) + fluid(3.0, 1e-3) + "timestep 0.02\nfix 1 all nve\nrun 1000\nwrite_data salt.data nocoeff\n")
    exact = forces(directory, 9.5, 1e-5)
    mean_square = lambda rows: (rows**2).sum(1).mean()
    return [(mean_square(forces(directory, *one) - exact) / mean_square(exact)) ** 0.5 for one in SETTINGS]


def seconds_of_lammps(directory, edge, setting, charged=True):
    settings = fluid(*setting) if charged else "pair_style dpd 1.0 1.0 34387\npair_coeff * * 25 4.5\n"
    text = start(edge) + settings + "timestep 0.02\nfix 1 all nve\nrun 200\ntimestep 0.04\nrun 300\n"
    log = lammps(directory, text, processes=2)
    times = [line.split() for line in log.splitlines() if line.startswith("Loop time")]
    return float(times[-1][3]) / 300


def seconds_of_mesoscope(directory, program, edge, charged=True):
    names, steps = ["water", "cation", "anion"], 3_000_000 // edge**3
    charges = [0, 1, -1] if charged else [0, 0, 0]
    scene = {
        "title": "salt", "space": {"box": [edge] * 3}, "time": {"step": 0.04, "steps": steps}, "temperature": 1,
        "particles": [{"species": name, "count": count, "charge": charge} for name, count, charge in zip(names, beads(edge), charges)],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {"energies": {"every": 100}, "snapshot": None},
    }
    if charged:
        scene["interactions"].append({"type": "electrostatics", "bjerrum_length": BJERRUM})
    (directory / "scene.json").write_text(json.dumps(scene))
    command = [program, "run", "scene.json", "--out", "out", "--force", "--quiet", "--no-pictures"]
    subprocess.run(command, cwd=directory, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return json.loads((directory / "out/run.json").read_text())["wall_seconds"] / steps


def main():
    program = str(Path(sys.argv[1]).resolve())
    edge = int(sys.argv[2]) if len(sys.argv) > 2 else 10
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    with tempfile.TemporaryDirectory() as name:
        directory = Path(name)
        errors = true_errors(directory)
        ways = {
            "mesoscope": lambda: seconds_of_mesoscope(directory, program, edge),
            "mesoscope without charges": lambda: seconds_of_mesoscope(directory, program, edge, charged=False),
            "LAMMPS without charges": lambda: seconds_of_lammps(directory, edge, SETTINGS[0], charged=False),
        }
        for setting, error in zip(SETTINGS, errors):
            label = f"LAMMPS, cutoff {setting[0]}, accuracy {setting[1]:g}, true error {100 * error:.2f} %"
            ways[label] = lambda setting=setting: seconds_of_lammps(directory, edge, setting)
        found = {label: [] for label in ways}
        for _ in range(rounds):
            for label, way in ways.items():
                found[label].append(1e3 * way())
    print(f"{sum(beads(edge))} beads, {2 * beads(edge)[1]} ions, {rounds} rounds in turns; milliseconds of a step, median (least to most)")
    for label, times in found.items():
        print(f"{label}: {statistics.median(times):.2f} ({min(times):.2f} to {max(times):.2f})")


if __name__ == "__main__":
    main()
