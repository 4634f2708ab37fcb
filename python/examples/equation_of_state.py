"""The pressure of the standard DPD fluid over its density: Groot and Warren found p = ρkT + αaρ² with α near 0.101 for ρ > 2.

`python equation_of_state.py [steps]`
"""

import sys

import mesoscope as ms
import numpy as np

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 4000
scene = ms.scene("dpd-fluid")
scene["space"]["box"] = [8, 8, 8]
scene["time"]["equilibration"] = steps // 4
scene["output"] = {"energies": {"every": 20}}

densities = [3, 4, 5, 6]
sweep = ms.sweep(scene, {"particles.0.number_density": densities}, out="equation-of-state", steps=steps, force=True)
table = sweep.table()
repulsion = scene["interactions"][0]["repulsion"]
density = np.array(densities, float)
alpha = (table["pressure"] - density) / (repulsion * density**2)
for row in zip(density, table["pressure"], table["pressure_error"], alpha):
    print("ρ = {:.0f}: p = {:.3f} ± {:.3f}, α = {:.4f}".format(*row))
