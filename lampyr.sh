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
if [ "${1:-}" = compare ]; then
  # Only the report of compare needs npm, and compare has tables without it.
  if ! { install_npm && (cd "$root" && quietly cmake --preset release) &&
         quietly cmake --build "$build" --target lampyr_report_page; }; then
    echo "warning: the report page could not be made: compare will write its tables only" >&2
  fi
fi
exec "$build/lampyr" "$@"
