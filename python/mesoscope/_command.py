"""The command, whose program lies in the package."""

import os
import sys
from pathlib import Path


def main() -> None:
    name = "mesoscope.exe" if os.name == "nt" else "mesoscope"
    program = str(Path(__file__).with_name("bin") / name)
    if os.name == "nt":
        import subprocess

        sys.exit(subprocess.run([program, *sys.argv[1:]], check=False).returncode)
    os.execv(program, [program, *sys.argv[1:]])
