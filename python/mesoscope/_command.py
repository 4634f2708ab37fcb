"""The command, whose program lies in the package."""

import os
import subprocess
import sys
from pathlib import Path


def program() -> str:
    """The path of the program."""
    return str(Path(__file__).with_name("bin") / ("mesoscope.exe" if os.name == "nt" else "mesoscope"))


def main() -> None:
    """The entry point of the command."""
    arguments = [program(), *sys.argv[1:]]
    if os.name == "nt":
        sys.exit(subprocess.run(arguments, check=False).returncode)
    os.execv(arguments[0], arguments)
