# Sourced by demos/run.sh and tests/run.sh: the one list of what Stillframe needs from Debian or
# Ubuntu, and the way it gets there.

still_packages=(
    g++ cmake ninja-build
    libglm-dev libhwy-dev libtinyobjloader-dev libstb-dev libcli11-dev nlohmann-json3-dev
    libexpected-dev libxxhash-dev libpng-dev zlib1g-dev libcairo2-dev fonts-dejavu-core catch2
    libsdl2-dev libimgui-dev
    ffmpeg
)
# What tests/bench/peer needs besides; it is left out, or its tests are skipped, without them.
still_peer_packages=(libegl-dev libgles-dev libegl-mesa0 libgl1-mesa-dri)

# install_packages [MORE…]: quiet, and nothing at all when everything is there.
install_packages() {
    local package missing=() as_root=()
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        echo "No apt-get here: please install what demos/setup.sh lists by yourself." >&2
        return
    fi
    for package in "${still_packages[@]}" "$@"; do
        dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
            missing+=("$package")
    done
    if [ ${#missing[@]} -eq 0 ]; then
        return
    fi
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "Please install as root: apt-get install ${missing[*]}" >&2
            return 1
        fi
        as_root=(sudo)
    fi
    echo "Installing ${missing[*]}"
    "${as_root[@]}" apt-get -qq update
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get -qq -y --no-install-recommends install "${missing[@]}" >/dev/null
}
