"""The programs of the guide run, and its reference is that of the docstrings."""

import re
from pathlib import Path

import pytest
from reference import reference

ROOT = Path(__file__).resolve().parents[2]
GUIDE = ROOT / "docs" / "guide" / "python.md"


def programs():
    """Headings with the programs under them, by chapters, of which a first program without a heading of its own belongs to all."""
    for chapter in re.split(r"^## ", GUIDE.read_text(encoding="utf-8"), flags=re.M):
        first, *parts = re.split(r"^### ", chapter, flags=re.M)
        shared = re.findall(r"^```python\n(.*?)^```", first, flags=re.M | re.S)
        if not parts:
            yield from ((first.splitlines()[0], program) for program in shared)
        for part in parts:
            for program in re.findall(r"^```python\n(.*?)^```", part, flags=re.M | re.S):
                yield part.splitlines()[0], "\n".join([*shared, program])


PROGRAMS = list(programs())


def test_there_are_ten_recipes_and_more():
    assert len(PROGRAMS) >= 12


@pytest.mark.parametrize("program", [program for _, program in PROGRAMS], ids=[heading for heading, _ in PROGRAMS])
def test_program_of_the_guide(program, capsys):
    exec(compile(program, "docs/guide/python.md", "exec"), {"__name__": "__main__"})
    assert capsys.readouterr().out.strip()


def test_the_reference_is_that_of_the_docstrings():
    written = (ROOT / "docs" / "guide" / "python-reference.md").read_text(encoding="utf-8")
    assert reference() == written, "make it again: python python/tests/reference.py > docs/guide/python-reference.md"
