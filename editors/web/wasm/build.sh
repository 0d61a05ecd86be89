#!/usr/bin/env bash
# Makes okoshi as a module for browsers: okoshi_web.js, okoshi_web_bg.wasm and their types.
#
#     bash editors/web/wasm/build.sh FOLDER
#
# rustup's toolchain is used if it has the target (`rustup target add wasm32-unknown-unknown`), otherwise Debian's (packages rustc-web,
# cargo-web, rust-web-src and lld-22), whose standard library is compiled first. WASM_PROFILE names another profile than `release`: `quick` is built
# in less time; WASM_FEATURES=editor adds the language server, for the extension of VS Code for the Web. wasm-opt is not used: what it makes is smaller as it is, and larger with Brotli.
set -euo pipefail
out=$(realpath -m "${1:?usage: build.sh FOLDER}")
target=$(realpath -m "${CARGO_TARGET_DIR:-$(dirname "$0")/target}")
cd "$(dirname "$0")"
triple=wasm32-unknown-unknown
profile=${WASM_PROFILE:-release}

# Less is inlined than by default: that is smaller (docs/speed.md).
flags="-C target-feature=+simd128 -C llvm-args=-inline-threshold=100"

build=(build --locked --profile "$profile" --features "${WASM_FEATURES:-}" --target "$triple" --target-dir "$target/wasm")
if rustup target list --installed 2> /dev/null | grep -qx "$triple"; then
  RUSTFLAGS=$flags cargo "${build[@]}"
elif [ -d /usr/lib/rustlib/src/rust/library ] && command -v wasm-ld-22 > /dev/null; then
  # Sources of the standard library are built by the compiler that they came with. A panic's message is shown to nobody, so it is left out.
  RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 RUSTFLAGS="$flags -Z unstable-options -C panic=immediate-abort" \
    CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=wasm-ld-22 /usr/bin/cargo "${build[@]}" -Z build-std=std,panic_abort
else
  echo "There is no compiler for WebAssembly: run \`rustup target add $triple\`, or, on Debian, \`apt-get install rustc-web cargo-web rust-web-src lld-22\`." >&2
  exit 1
fi
folder=$profile
[ "$profile" != dev ] || folder=debug

# The program that writes the JavaScript side runs here, on any toolchain.
cargo build --locked --quiet --manifest-path bindgen/Cargo.toml --target-dir "$target/bindgen"
mkdir -p "$out"
"$target/bindgen/debug/bindgen" "$target/wasm/$triple/$folder/okoshi_web.wasm" "$out"
# What the environment makes of the profile is built for tests, too.
