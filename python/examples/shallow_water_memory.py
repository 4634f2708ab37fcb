"""The energy that a bath of unresolved waves takes from a shear flow, for several memories: figure 1 of Cotter and Reich,
doi:10.1209/epl/i2003-00621-8.

`python shallow_water_memory.py [steps]`
"""

import sys

import mesoscope as ms

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
found = ms.sweep(
    "shallow-water-memory", {"interactions.0.bath.epsilon": [0.1, 1, 10]}, {"output.fields": {"quantities": ["depth"]}},
    out="shallow-water-memory", steps=steps, force=True,
)  # fmt: skip
for variant, run in zip(found.summary["variants"], found.runs()):
    energy = run.energies["total_energy"]
    print(f"{variant['label']}: {energy[-1] / energy[0]:.6f} of the energy is left; depth {run.fields['depth'][-1].min():.4f} and more")
