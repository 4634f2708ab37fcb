"""The peer: HOOMD-blue simulates the standard fluid on a card.

    version                     the version
    fluid N EDGE DT SECONDS     particle-steps a second of N particles in a cube, measured over about so many seconds
"""

import sys
import time


def fail(error):
    print("error:", " ".join(str(error).split()), flush=True)
    sys.exit(1)


try:
    import hoomd
    import numpy
except ImportError as error:
    fail(error)


def fluid(count, edge, step, seconds):
    sites = int(numpy.ceil(count ** (1 / 3)))
    grid = (numpy.arange(sites) + 0.5) / sites * edge - edge / 2
    places = numpy.stack(numpy.meshgrid(grid, grid, grid), axis=-1).reshape(-1, 3)
    simulation = hoomd.Simulation(device=hoomd.device.GPU(), seed=1)
    frame = hoomd.Snapshot()
    frame.configuration.box = [edge, edge, edge, 0, 0, 0]
    frame.particles.N = count
    frame.particles.types = ["A"]
    frame.particles.position[:] = places[:count]
    frame.particles.velocity[:] = numpy.random.default_rng(1).normal(size=(count, 3))
    simulation.create_state_from_snapshot(frame)
    cells = hoomd.md.nlist.Cell(buffer=0.4)
    force = hoomd.md.pair.DPD(nlist=cells, kT=1.0, default_r_cut=1.0)
    force.params[("A", "A")] = {"A": 25.0, "gamma": 4.5}
    method = hoomd.md.methods.ConstantVolume(filter=hoomd.filter.All())
    simulation.operations.integrator = hoomd.md.Integrator(dt=step, methods=[method], forces=[force])
    simulation.run(300)
    steps = 100
    while True:
        begun = time.perf_counter()
        simulation.run(steps)
        taken = time.perf_counter() - begun
        if taken > seconds:
            return steps * count / taken
        steps *= 2


try:
    if sys.argv[1] == "version":
        print(hoomd.version.version)
    else:
        print(fluid(int(sys.argv[2]), *map(float, sys.argv[3:])))
except Exception as error:
    fail(error)
