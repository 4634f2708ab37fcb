#!/bin/sh
# Installs Khronos' validator of SPIR-V, which a test hands all kernels to, where that needs no question: on Debian and Ubuntu,
# as root. Elsewhere, and where it cannot be installed, that test says that it was skipped.
command -v spirv-val >/dev/null 2>&1 && exit 0
[ "$(id -u)" -eq 0 ] && command -v apt-get >/dev/null 2>&1 || exit 0
{
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends spirv-tools
} >/dev/null 2>&1
exit 0
