#!/bin/sh
# Makes sure that there is a Vulkan adapter, at least Mesa's software one. Installs it on Debian and Ubuntu; elsewhere
# says what to install. Needs no vulkaninfo: it looks for what the Vulkan loader itself looks for.
set -u

# Where the system keeps its libraries, beside what ldconfig lists (which may be missing from a user's PATH, or whole).
find_library() {
    PATH="$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null | grep -q "[[:space:]]$1[[:space:]]" && return
    for found in $(printf '%s' "${LD_LIBRARY_PATH:-}" | tr ':' ' ') /usr/lib /usr/lib64 /usr/lib/*-linux-* \
        /usr/local/lib /lib /lib64 /run/opengl-driver/lib; do
        [ -e "$found/$1" ] && return
    done
    return 1
}

# A driver counts if its manifest names a library that exists.
usable_driver() {
    [ -r "$1" ] || return 1
    library=$(sed -n 's/.*"library_path"[[:space:]]*:[[:space:]]*"\([^"]*\)".*/\1/p' "$1" | head -n 1)
    case $library in
        "") return 1 ;;
        /*) [ -e "$library" ] ;;
        */*) [ -e "$(dirname "$1")/$library" ] ;;
        *) find_library "$library" ;;
    esac
}

# Manifests named by the user replace those of the system, as they do in the loader.
find_driver() {
    named=${VK_DRIVER_FILES:-${VK_ICD_FILENAMES:-}}
    if [ -n "$named" ]; then
        for entry in $(printf '%s' "$named" | tr ':' ' '); do
            for manifest in "$entry" "$entry"/*.json; do
                [ -f "$manifest" ] && usable_driver "$manifest" && return
            done
        done
        return 1
    fi
    for manifest in "${XDG_CONFIG_HOME:-$HOME/.config}"/vulkan/icd.d/*.json /etc/xdg/vulkan/icd.d/*.json \
        /etc/vulkan/icd.d/*.json "${XDG_DATA_HOME:-$HOME/.local/share}"/vulkan/icd.d/*.json \
        /usr/local/share/vulkan/icd.d/*.json /usr/share/vulkan/icd.d/*.json /run/opengl-driver/share/vulkan/icd.d/*.json; do
        usable_driver "$manifest" && return
    done
    return 1
}

ready() { find_library libvulkan.so.1 && find_driver; }

refuse() {
    printf 'error: no Vulkan adapter was found. %s\n' "$1" >&2
    exit 3
}

elsewhere='Install a Vulkan driver; without a GPU the software driver serves:
  Debian, Ubuntu   apt-get install libvulkan1 mesa-vulkan-drivers
  Fedora           dnf install vulkan-loader mesa-vulkan-drivers
  Arch             pacman -S vulkan-icd-loader vulkan-swrast
  macOS, Windows   nothing: Metal and DirectX 12 are part of the system'

case $(uname -s) in
    Linux) ;;
    # Metal and DirectX 12 are part of the system.
    *) exit 0 ;;
esac
ready && exit 0
if [ -n "${VK_DRIVER_FILES:-${VK_ICD_FILENAMES:-}}" ]; then
    refuse 'VK_DRIVER_FILES (or VK_ICD_FILENAMES) names no driver that exists, and hides all others: unset it or mend it.'
fi
command -v apt-get >/dev/null 2>&1 || refuse "$elsewhere"

as_root=
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null 2>&1 || refuse "Run as root: apt-get install libvulkan1 mesa-vulkan-drivers"
    as_root=sudo
fi
echo 'No Vulkan adapter was found: installing the software driver (libvulkan1, mesa-vulkan-drivers).'
$as_root apt-get update -qq
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends libvulkan1 mesa-vulkan-drivers ||
    refuse "$elsewhere"
ready || refuse "The driver was installed but cannot be found. $elsewhere"
