"""Stochastic mesoscale particle simulations on any GPU.

>>> import mesoscope as ms
>>> with ms.Simulation("dpd-fluid", settings={"space.box": [4, 4, 4], "output": {}}) as sim:
...     sim.advance(50)
...     frame = sim.frame()
>>> frame.positions.shape, frame.step
((192, 3), 50)
"""

import os as _os

from . import _mesoscope as _mesoscope

# Drivers read these when they load, which is with the first device.
_os.environ.update(_mesoscope.driver_environment())

from .errors import (  # noqa: E402
    AdapterError,
    ArrayError,
    FileError,
    MesoscopeError,
    RunError,
    SceneError,
    UnstableError,
)
from .results import Mean, Page, Run, Stability, Sweep, Tradeoff, open  # noqa: E402
from .scenes import adapters, check, scene, scenes, schema  # noqa: E402
from .simulation import Frame, Simulation  # noqa: E402
from .work import report, resume, run, stability, sweep, tradeoff  # noqa: E402

__all__ = [
    "AdapterError",
    "ArrayError",
    "FileError",
    "Frame",
    "Mean",
    "MesoscopeError",
    "Page",
    "Run",
    "RunError",
    "SceneError",
    "Simulation",
    "Stability",
    "Sweep",
    "Tradeoff",
    "UnstableError",
    "adapters",
    "check",
    "open",
    "report",
    "resume",
    "run",
    "scene",
    "scenes",
    "schema",
    "stability",
    "sweep",
    "tradeoff",
]

__version__ = "0.2.0"
