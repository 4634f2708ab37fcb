"""Where a mixture of two fluids demixes: the repulsion of unlike beads is varied, and the order is the share of neighbours of the same kind.

`python phase_diagram.py [steps]`
"""

import sys

import mesoscope as ms
import numpy as np

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 4000
scene = ms.scene("binary-mixture")
scene["space"]["box"] = [24, 24]
scene["time"]["equilibration"] = 0
scene["output"] = {"trajectory": {"every": steps}}
unlike = [25, 30, 35, 45, 60]
sweep = ms.sweep(scene, {"interactions.0.pairs.0.repulsion": unlike}, out="phase-diagram", steps=steps, force=True)
for repulsion, run in zip(unlike, sweep.runs()):
    with ms.Simulation.resume(run.directory / "checkpoint.bin") as sim:
        frame = sim.frame()
    box, kinds = frame.box, frame.species
    same, all_pairs = 0, 0
    for particle in range(0, len(kinds), 10):
        way = frame.positions - frame.positions[particle]
        way[:, : len(box)] -= box * np.round(way[:, : len(box)] / box)
        near = np.einsum("ij,ij->i", way, way) < 1
        near[particle] = False
        same += (kinds[near] == kinds[particle]).sum()
        all_pairs += near.sum()
    print(f"a = {repulsion}: {same / all_pairs:.3f} of the neighbours are of the same kind")
