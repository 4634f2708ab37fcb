#!/usr/bin/env bash
# The tests of devices on other drivers than the usual one: with the plans that every GPU gets, on SwiftShader, a second Vulkan driver
# in software, and under the Vulkan validation layer with its checks of synchronization. Unit tests, those of linked shaders and examples
# of the documentation do not depend on the driver and are left out; those of the command are run on SwiftShader. What is missing here is
# said at the end.
# Fails if a test does, or if the layer complains of anything.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools=$PWD/target/validation
mkdir -p "$tools"
failed=()
missing=()

# suite NAME VARIABLE=VALUE...; the tests in `programs` are run.
suite() {
    local name=$1
    shift
    printf '\n== %s\n' "$name"
    env "$@" cargo test --release --locked --no-fail-fast "${programs[@]}" || failed+=("$name")
}
programs=(--test library --test errors)

# SwiftShader as Chrome ships it. No package of Debian has it; this one of npm holds it compressed.
swiftshader() {
    [ -e "$tools/swiftshader/vk_swiftshader_icd.json" ] && return
    command -v node >/dev/null && command -v npm >/dev/null || return 1
    local package
    package=$(cd "$tools" && npm pack --silent @sparticuz/chromium@147.0.0 2>/dev/null) || return 1
    mkdir -p "$tools/swiftshader"
    tar -xzOf "$tools/$package" package/bin/swiftshader.tar.br >"$tools/swiftshader.tar.br" || return 1
    node -e 'const [from, to] = process.argv.slice(1), { readFileSync, writeFileSync } = require("fs");
        writeFileSync(to, require("zlib").brotliDecompressSync(readFileSync(from)));' \
        "$tools/swiftshader.tar.br" "$tools/swiftshader.tar" || return 1
    tar -xf "$tools/swiftshader.tar" -C "$tools/swiftshader" || return 1
    rm -f "$tools/$package" "$tools/swiftshader.tar.br" "$tools/swiftshader.tar"
}

# The layer's manifest, in a folder of the system or of the user.
layer() {
    local name=VkLayer_khronos_validation.json folder
    for folder in ${VK_LAYER_PATH:-} /usr/share/vulkan/explicit_layer.d /etc/vulkan/explicit_layer.d \
        /usr/local/share/vulkan/explicit_layer.d "${XDG_DATA_HOME:-$HOME/.local/share}/vulkan/explicit_layer.d"; do
        [ -e "$folder/$name" ] && return
    done
    return 1
}

# under_the_layer NAME VARIABLE=VALUE...
under_the_layer() {
    local log=$tools/layer.log pipe=$tools/layer.pipe settings=$tools/vk_layer_settings.txt reader
    # Every process begins its log anew; what goes through a pipe is kept.
    rm -f "$pipe"
    mkfifo "$pipe"
    cat "$pipe" >"$log" &
    reader=$!
    exec 3>"$pipe"
    cat >"$settings" <<END
khronos_validation.debug_action = VK_DBG_LAYER_ACTION_LOG_MSG
khronos_validation.log_filename = $pipe
khronos_validation.report_flags = error
khronos_validation.enables = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
END
    suite "$1" VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation VK_LAYER_SETTINGS_PATH="$settings" "${@:2}"
    exec 3>&-
    wait "$reader"
    if [ -s "$log" ]; then
        printf 'The validation layer complains %d times:\n' "$(grep -c 'Validation Error' "$log")"
        grep -o 'Validation Error: \[ [^]]* \]' "$log" | sort | uniq -c
        failed+=("$1: the layer complains")
    fi
}

suite 'the plan of every GPU' MESOSCOPE_PLAN=gpu
if swiftshader; then
    programs+=(--test command_line)
    suite 'SwiftShader' VK_DRIVER_FILES="$tools/swiftshader/vk_swiftshader_icd.json"
    programs=(--test library --test errors)
    printf '\n== SwiftShader: adapters --check\n'
    VK_DRIVER_FILES="$tools/swiftshader/vk_swiftshader_icd.json" cargo run --release --locked -- adapters --check ||
        failed+=('SwiftShader: adapters --check')
else
    missing+=('SwiftShader (needs node and npm, and their registry)')
fi
if ! layer && [ "$(id -u)" -eq 0 ] && command -v apt-get >/dev/null; then
    { apt-get update -qq; apt-get install -y -qq --no-install-recommends vulkan-validationlayers; } >/dev/null 2>&1
fi
if layer; then
    under_the_layer 'the validation layer'
    under_the_layer 'the validation layer, the plan of every GPU' MESOSCOPE_PLAN=gpu
else
    missing+=('the validation layer (Debian, Ubuntu: apt-get install vulkan-validationlayers)')
fi

printf '\n'
for what in ${missing[@]+"${missing[@]}"}; do printf 'NOT RUN: %s\n' "$what"; done
for what in ${failed[@]+"${failed[@]}"}; do printf 'FAILED: %s\n' "$what"; done
[ ${#failed[@]} -eq 0 ]
