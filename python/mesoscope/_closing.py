"""Devices close before the interpreter does: drivers do not survive the other order."""

from __future__ import annotations

import atexit
import weakref
from typing import Any

_open: "weakref.WeakSet[Any]" = weakref.WeakSet()


def register(simulation: Any) -> None:
    """Closes a simulation when the interpreter exits, if nobody has before."""
    _open.add(simulation)


@atexit.register
def _close() -> None:
    for simulation in list(_open):
        simulation.close()
