#!/bin/sh
# Builds the library for C, C++ and Fortran, and lays it out below a folder. usage: install.sh PREFIX
#
# Cargo gives crates the features that all packages ask for which it builds. With CAROM_C_BUILT_WITH=--workspace the
# library is built of the crates that the tests have: not one is compiled again.
# What is laid out may be moved: carom.pc and the CMake files know each other's places relative to their own.
set -eu
root=$(cd "$(dirname "$0")/../../.." && pwd)
here=$root/crates/carom-c
mkdir -p "$1"
prefix=$(cd "$1" && pwd)
cd "$root"

version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
# Before 1.0 a new minor version may be another interface.
case $version in
0.*) interface=$(echo "$version" | cut -d. -f1,2) ;;
*) interface=$(echo "$version" | cut -d. -f1) ;;
esac
case $(uname -s) in
Darwin)
    built=libcarom_c.dylib real=libcarom.$version.dylib named=libcarom.$interface.dylib plain=libcarom.dylib
    ;;
*)
    built=libcarom_c.so real=libcarom.so.$version named=libcarom.so.$interface plain=libcarom.so
    ;;
esac

# shellcheck disable=SC2086
cargo build --release --locked --lib ${CAROM_C_BUILT_WITH:---package carom-c}
target=${CARGO_TARGET_DIR:-target}/release

mkdir -p "$prefix/include" "$prefix/lib/pkgconfig" "$prefix/lib/cmake/carom" "$prefix/share/doc/carom"
install -m 644 "$here/include/carom.h" "$here/include/carom.f90" "$prefix/include"
install -m 644 "$target/libcarom_c.a" "$prefix/lib/libcarom.a"
install -m 755 "$target/$built" "$prefix/lib/$real"
ln -sf "$real" "$prefix/lib/$named"
ln -sf "$named" "$prefix/lib/$plain"
fill() {
    sed -e "s/@VERSION@/$version/g" -e "s/@INTERFACE@/$interface/g" -e "s/@SHARED@/$plain/g" "$here/install/$1.in" >"$2/$1"
}
fill carom.pc "$prefix/lib/pkgconfig"
fill carom-config.cmake "$prefix/lib/cmake/carom"
fill carom-config-version.cmake "$prefix/lib/cmake/carom"
install -m 644 LICENSE-MIT LICENSE-APACHE THIRD-PARTY-NOTICES.txt "$prefix/share/doc/carom"
