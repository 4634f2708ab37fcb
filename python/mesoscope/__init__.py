"""Stochastic mesoscale particle simulations on any GPU.

>>> import mesoscope as ms
>>> with ms.Simulation("dpd-fluid", settings={"space.box": [4, 4, 4], "output": {}}) as sim:
...     sim.advance(50)
...     frame = sim.frame()
>>> frame.positions.shape, sim.step
((192, 3), 50)
"""

import os as _os
import sys as _sys


def _prepare_environment() -> None:
    """Sets what Mesa's drivers read when they load: two threads a core, and a directory where there is none."""
    if _sys.platform != "linux":
        return
    own = len(_os.sched_getaffinity(0))
    _os.environ.setdefault("LP_NUM_THREADS", str(2 * own))
    if not _os.path.isabs(_os.environ.get("XDG_RUNTIME_DIR", "")):
        _os.environ["XDG_RUNTIME_DIR"] = "/nonexistent"


_prepare_environment()

from .errors import (  # noqa: E402
    AdapterError,
    ArrayError,
    FileError,
    MesoscopeError,
    RunError,
    SceneError,
    UnstableError,
)
from .results import Mean, Run, Sweep, open  # noqa: E402
from .scenes import adapters, check, scene, scenes, schema  # noqa: E402
from .simulation import Frame, Simulation  # noqa: E402
from .work import resume, run, sweep  # noqa: E402

__all__ = [
    "AdapterError",
    "ArrayError",
    "FileError",
    "Frame",
    "Mean",
    "MesoscopeError",
    "Run",
    "RunError",
    "SceneError",
    "Simulation",
    "Sweep",
    "UnstableError",
    "adapters",
    "check",
    "open",
    "resume",
    "run",
    "scene",
    "scenes",
    "schema",
    "sweep",
]

__version__ = "0.1.0"
