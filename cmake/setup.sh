#!/bin/sh
# Set-up shared by ./run and ./test: installs missing packages, configures and builds. Sourced from the project's root.
# Says what it does; when nothing is to be done it says nothing and takes well under a second.
set -eu

calot_install_packages() {
    missing=""
    for package in $(sed 's/#.*//' cmake/packages.txt); do
        status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
        [ "$status" = "install ok installed" ] || missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    sudo=""
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || { echo "calot: these packages are missing:$missing. Install them as root, then try again." >&2; exit 1; }
        sudo=sudo
    fi
    echo "calot: installing$missing"
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get update -qq
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >build-packages.log 2>&1 ||
        { tail -20 build-packages.log >&2; echo "calot: apt-get failed; the whole log is in build-packages.log" >&2; exit 1; }
    rm -f build-packages.log
}

# calot_build PRESET TARGET...
calot_build() {
    preset=$1
    shift
    mkdir -p "build/$preset"
    if [ ! -f "build/$preset/build.ninja" ]; then
        echo "calot: configuring (build/$preset)"
        cmake --preset "$preset" >"build/$preset/configure.log" 2>&1 || { cat "build/$preset/configure.log" >&2; exit 1; }
    fi
    if ! cmake --build --preset "$preset" --target "$@" -- -n | grep -q 'no work to do'; then
        echo "calot: building (build/$preset)"
        cmake --build --preset "$preset" --target "$@"
    fi
}
