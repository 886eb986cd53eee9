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
targets="lampyr lampyr_image_module"
if [ "${1:-}" = compare ] && [ ! -f "$build/lampyr_report_page.html" ]; then
  # Only the report of compare needs npm.
  install_npm
  (cd "$root" && quietly cmake --preset release)
  targets="$targets lampyr_report_page"
fi
quietly cmake --build "$build" --target $targets
exec "$build/lampyr" "$@"
