"""Builds the wheel with maturin, and the program of the same profile into it: one installation gives both.

`MESOSCOPE_PROFILE` is the profile of cargo, `release` where nothing is said.
"""

import json
import os
import shutil
import subprocess
from pathlib import Path

import maturin

HERE = Path(__file__).resolve().parent
PROFILE = os.environ.get("MESOSCOPE_PROFILE", "release")

get_requires_for_build_wheel = maturin.get_requires_for_build_wheel
prepare_metadata_for_build_wheel = maturin.prepare_metadata_for_build_wheel


def _program() -> None:
    root = HERE.parent
    # With the package of the extension dependencies have the features that they have in it: they are compiled once for both.
    packages = ["--package", "mesoscope", "--package", "mesoscope-python"]
    build = ["cargo", "build", "--locked", "--profile", PROFILE, *packages, "--bin", "mesoscope"]
    subprocess.run(build, cwd=root, check=True)
    found = subprocess.run(
        ["cargo", "metadata", "--locked", "--no-deps", "--format-version", "1"],
        cwd=root, check=True, capture_output=True, text=True,
    )  # fmt: skip
    name = "mesoscope.exe" if os.name == "nt" else "mesoscope"
    folder = "debug" if PROFILE == "dev" else PROFILE
    built = Path(json.loads(found.stdout)["target_directory"]) / folder / name
    place = HERE / "mesoscope" / "bin"
    place.mkdir(exist_ok=True)
    shutil.copy2(built, place / name)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    _program()
    os.environ["MATURIN_PEP517_ARGS"] = f"--profile {PROFILE} --generate-stubs"
    return maturin.build_wheel(wheel_directory, config_settings, metadata_directory)
