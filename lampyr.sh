#!/usr/bin/env bash
# Installs and builds what is missing, then runs lampyr with the arguments given.
set -eu
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build="$root/build/release"
. "$root/scripts/prepare.sh"

install_missing $LAMPYR_BUILD_PACKAGES
if [ ! -f "$build/build.ninja" ]; then
  echo "Configuring lampyr" >&2
  (cd "$root" && quietly cmake --preset release -DLAMPYR_TESTS=OFF)
fi
[ -x "$build/lampyr" ] || echo "Building lampyr (a minute or two, once)" >&2
quietly cmake --build "$build" --target lampyr lampyr_image_module
exec "$build/lampyr" "$@"
