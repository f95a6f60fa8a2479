#!/usr/bin/env bash
# Fetches the engine from its registry, opens its mesh passes with the patch beside this file, and builds and runs this program.
set -euo pipefail
cd "$(dirname "$0")"
engine=../../../target/guests/graphics-0.6.7
if [ ! -d "$engine" ]; then
  # A package that depends on the engine alone makes cargo unpack its sources.
  fetch=$(mktemp -d)
  cargo init --quiet --lib --name fetch "$fetch"
  cargo add --quiet --manifest-path "$fetch/Cargo.toml" graphics@=0.6.7
  manifest=$(cargo metadata --quiet --format-version 1 --manifest-path "$fetch/Cargo.toml" |
    grep -o '[^"]*/graphics-0\.6\.7/Cargo\.toml' | head -1)
  mkdir -p "$(dirname "$engine")"
  cp -r "$(dirname "$manifest")" "$engine"
  patch --quiet --binary -p1 -d "$engine" < graphics-0.6.7.patch
  rm -rf "$fetch"
fi
CARGO_TARGET_DIR=../../../target/graphics exec cargo run
