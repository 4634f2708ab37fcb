#!/bin/sh
# Makes sure that programs can be built with MPI: an MPI library, its launcher, and libclang, which makes the declarations.
# Installs Open MPI on Debian and Ubuntu; elsewhere says what to install.
set -u

find_libclang() {
    [ -n "${LIBCLANG_PATH:-}" ] && return
    for library in /usr/lib/llvm-*/lib/libclang*.so* /usr/lib64/libclang*.so* /usr/lib/libclang*.so* \
        /usr/lib/*-linux-*/libclang*.so*; do
        [ -e "$library" ] && return
    done
    return 1
}

ready() { command -v mpicc >/dev/null 2>&1 && command -v mpirun >/dev/null 2>&1 && find_libclang; }

refuse() {
    printf 'error: no MPI to build with. %s\n' "$1" >&2
    exit 3
}

elsewhere='Install an MPI library, a C compiler and libclang:
  Debian, Ubuntu   apt-get install libopenmpi-dev openmpi-bin libclang-dev
  Fedora           dnf install openmpi-devel clang-devel, then: module load mpi
  Arch             pacman -S openmpi clang
  macOS            brew install open-mpi llvm
  clusters         load the modules of the MPI library and of LLVM'

ready && exit 0
command -v apt-get >/dev/null 2>&1 || refuse "$elsewhere"
as_root=
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null 2>&1 || refuse "Run as root: apt-get install libopenmpi-dev openmpi-bin libclang-dev"
    as_root=sudo
fi
echo 'No MPI was found: installing Open MPI and libclang (libopenmpi-dev, openmpi-bin, libclang-dev).'
$as_root apt-get update -qq
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
    libopenmpi-dev openmpi-bin libclang-dev || refuse "$elsewhere"
ready || refuse "It was installed but cannot be found. $elsewhere"
