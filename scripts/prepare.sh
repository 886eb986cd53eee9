# Sourced by lampyr.sh and tests/run: installs the Debian packages that are missing.

# Packages to build the renderer.
LAMPYR_BUILD_PACKAGES="g++ cmake ninja-build ccache libembree-dev libopenimageio-dev libopenexr-dev libflann-dev
  liblz4-dev libnanovdb-dev libglm-dev libtbb-dev libcli11-dev libfmt-dev nlohmann-json3-dev libeigen3-dev libpng-dev zlib1g-dev
  libcpp-httplib-dev"
# Further packages for its tests and benchmarks.
LAMPYR_TEST_PACKAGES="libgtest-dev libgmock-dev libbenchmark-dev patch"

# Further packages for its fuzzers.
LAMPYR_FUZZ_PACKAGES="clang"

# install_missing PACKAGE…: quiet when there is nothing to do.
install_missing() {
  local missing="" package as_root=""
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing="$missing $package"
  done
  [ -z "$missing" ] && return 0
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { echo "error: these packages are missing and there is no sudo:$missing" >&2; return 1; }
    as_root=sudo
  fi
  echo "Installing:$missing" >&2
  local log
  log=$(mktemp)
  if ! { $as_root apt-get update -q && $as_root env DEBIAN_FRONTEND=noninteractive \
         apt-get install -q -y --no-install-recommends $missing; } >"$log" 2>&1; then
    cat "$log" >&2
    echo "error: could not install:$missing" >&2
    return 1
  fi
  rm -f "$log"
}

# npm and node may be installed from elsewhere than Debian.
install_npm() {
  command -v npm >/dev/null && { command -v node || command -v nodejs; } >/dev/null || install_missing nodejs npm
}

# quietly COMMAND…: prints its output only when it fails.
quietly() {
  local log status=0
  log=$(mktemp)
  "$@" >"$log" 2>&1 || status=$?
  [ $status = 0 ] || cat "$log" >&2
  rm -f "$log"
  return $status
}
