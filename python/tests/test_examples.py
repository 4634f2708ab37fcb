"""The examples run, short."""

import runpy
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"
SAYS = {
    "diffusion_with_freud": ("400", "freud: D = "),
    "equation_of_state": ("200", "ρ = 6: p = "),
    "own_observable": ("60", "S(2π/L) = "),
    "phase_diagram": ("200", "a = 60: "),
    "price_of_accuracy": ("200", "target"),
    "shallow_water_memory": ("4", "of the energy is left"),
}


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.py")), ids=lambda path: path.stem)
def test_example(path, monkeypatch, capsys):
    steps, says = SAYS[path.stem]
    monkeypatch.setattr(sys, "argv", [str(path), steps])
    runpy.run_path(str(path), run_name="__main__")
    assert says in capsys.readouterr().out
