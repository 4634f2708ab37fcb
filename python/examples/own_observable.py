"""An observable of one's own: the autocorrelation of the longest density wave along x, from frames as they come.

`python own_observable.py [frames]`
"""

import sys

import mesoscope as ms
import numpy as np

frames = int(sys.argv[1]) if len(sys.argv) > 1 else 400
settings = {"space.box": [8, 8, 8], "time.equilibration": 0, "output": {}}
with ms.Simulation("dpd-fluid", settings) as sim:
    sim.advance(500)
    waves = []
    for frame in sim.steps(5 * frames, every=5):
        waves.append(np.exp(2j * np.pi * frame.positions[:, 0] / frame.box[0]).sum())
    interval = 5 * sim.scene["time"]["step"]
    count = len(frame.positions)
waves = np.array(waves)
print(f"S(2π/L) = {np.mean(np.abs(waves) ** 2) / count:.4f}")
for lag in range(0, min(20, frames // 2), 4):
    correlation = np.mean((waves[lag:] * waves[: len(waves) - lag].conj()).real) / np.mean(np.abs(waves) ** 2)
    print(f"t = {lag * interval:.2f}: {correlation:.3f}")
