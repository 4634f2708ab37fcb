#!/bin/sh
# Builds the wheel of a profile (`dev` or `release`), installs it into a virtual environment, and tests what is installed: `sh .ci/python.sh dev`.
# Without Python 3.11 or later it says so; where PYTHON_REQUIRED is set that is a failure.
set -eu
cd "$(dirname "$0")/.."
profile=${1:-dev}
root=$PWD
python=${PYTHON:-python3}
if ! "$python" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
    echo "the tests of the Python package are left out: $python is not Python 3.11 or later with venv" >&2
    [ -z "${PYTHON_REQUIRED:-}" ]
    exit
fi
environment=$root/target/python
[ -x "$environment/bin/python" ] || "$python" -m venv "$environment"
pip="$environment/bin/python -m pip --quiet --disable-pip-version-check"
$pip install 'maturin>=1.9,<2' 'numpy>=1.26' pytest gsd pandas xarray freud-analysis MDAnalysis mypy
PATH="$environment/bin:$PATH" MESOSCOPE_PROFILE=$profile CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$root/target}" \
    $pip install --no-build-isolation --no-deps --force-reinstall ./python
# From a folder without the sources: what is tested is what is installed.
place=$root/target/python-tests
rm -rf "$place"
mkdir -p "$place"
cd "$place"
installed=$("$environment/bin/python" -c 'import mesoscope, os; print(os.path.dirname(mesoscope.__file__))')
"$environment/bin/python" -m mypy --ignore-missing-imports -p mesoscope
"$environment/bin/python" -m pytest -q -p no:cacheprovider "$root/python/tests"
"$environment/bin/python" -m pytest -q -p no:cacheprovider --doctest-modules -c "$root/python/pyproject.toml" --rootdir "$place" \
    --confcutdir "$place" "$installed"
