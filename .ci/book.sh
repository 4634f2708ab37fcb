#!/bin/sh
# Builds the documentation as a book in target/book with mdBook: README, docs and the files next to them in the folders that they have here,
# so that every link leads to the same place in the files and in the book.
set -eu
cd "$(dirname "$0")/.."

source=target/book-source
rm -rf "$source" target/book
mkdir -p "$source/assets"
cp README.md ARCHITECTURE.md CONTRIBUTING.md CHANGELOG.md "$source"
cp -R docs shaders "$source"
cp -R assets/gallery "$source/assets"
# The table of contents of docs, seen from one folder above.
sed -e 's|](|](docs/|' -e 's|](docs/\.\./|](|' docs/SUMMARY.md >"$source/SUMMARY.md"
mdbook build
