#!/bin/sh
# Fetches Dawn's package for Node.js, by which a test asks Chrome's compiler of WGSL; the test says that it was skipped without it.
# Prints the folder that NODE_PATH is to name.
cd "$(dirname "$0")/.." || exit 1
folder=$PWD/target/validation
mkdir -p "$folder"
[ -d "$folder/node_modules/webgpu" ] || npm install --silent --no-save --prefix "$folder" webgpu@0.6.2 >/dev/null 2>&1
printf '%s\n' "$folder/node_modules"
