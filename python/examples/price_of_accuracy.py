"""The cheapest time step and integrator whose temperature is within a target, for a scene of one's own.

`python price_of_accuracy.py [steps]`
"""

import sys

import mesoscope as ms

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
scene = {
    "title": "A dense fluid", "space": {"box": [6, 6, 6]}, "time": {"step": 0.04, "steps": steps, "equilibration": steps // 5},
    "temperature": 1, "particles": [{"species": "A", "number_density": 4}],
    "interactions": [{"type": "dpd", "repulsion": 20, "friction": 6}], "output": {"energies": {"every": 5}},
}  # fmt: skip
found = ms.tradeoff(
    scene, {"time.step": [0.02, 0.04, 0.06], "integrator.type": ["splitting", "groot-warren"]}, {"temperature": "2%"},
    measures=["temperature"], out="price-of-accuracy", force=True,
)  # fmt: skip
print(found.advice)
if found.scene:
    print("step", found.scene["time"]["step"], "with", found.scene["integrator"]["type"])
