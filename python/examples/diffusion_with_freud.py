"""Mean squared displacements by freud from a trajectory, beside the coefficient that the run measures itself.

`python diffusion_with_freud.py [steps]`
"""

import sys

import freud
import mesoscope as ms
import numpy as np

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 6000
output = {"energies": {"every": 100}, "trajectory": {"every": 10}, "diffusion": {"every": 10, "window": steps // 60}}
settings = {"space.box": [8, 8, 8], "time.equilibration": steps // 6, "output": output}
run = ms.run("dpd-fluid", settings, out="diffusion", steps=steps, force=True)

ways = run.trajectory(unwrap=True)[run.scene["time"]["equilibration"] // 10 :]
msd = freud.msd.MSD(mode="window").compute(ways).msd
time = np.arange(len(msd)) * 10 * run.scene["time"]["step"]
half = slice(len(msd) // 8, len(msd) // 4)
slope = np.polyfit(time[half], msd[half], 1)[0]
print(f"freud: D = {slope / 6:.4f}; the run: D = {run.diffusion()}")
