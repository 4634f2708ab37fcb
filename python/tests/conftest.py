"""Every test has a directory of its own to work in."""

import pytest

#: Small changes that make the built-in fluid quick.
SMALL = {"space.box": [4, 4, 4], "time.equilibration": 0, "output": {}}


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def small():
    return dict(SMALL)
