#!/usr/bin/env bash
# The page "TAA, one step at a time": installs what it needs, builds the engine for browsers twice,
# with threads and without, and the folder build/web/site that any file host can serve.
#   run.sh          … and serves it here
#   run.sh --build  … and nothing more
#   run.sh --test   … and tests it in a headless Chromium
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source demos/setup.sh

case "${1:-}" in
    "" | --build | --test) task="${1:-}" ;;
    *)
        echo "usage: demos/web/run.sh [--build | --test]" >&2
        exit 2
        ;;
esac

command -v node >/dev/null || node_packages=(nodejs)
command -v npm >/dev/null || npm_packages=(npm)
install_packages emscripten ${node_packages[@]+"${node_packages[@]}"}
if [ "$task" = --test ]; then
    install_packages chromium ${npm_packages[@]+"${npm_packages[@]}"}
fi

# The native program, whose hashes the page shows beside its own.
[ -f build/release/build.ninja ] || cmake --preset release -DSTILL_TESTS=OFF >/dev/null
cmake --build --preset release --target stillframe

# Emscripten's own scripts need the acorn that Debian installs beside its own node.
export NODE_PATH=/usr/share/nodejs
launcher=()
if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
for build in threads single; do
    threads=OFF
    if [ "$build" = threads ]; then
        threads=ON
    fi
    emcmake cmake -S demos/web -B "build/web/$build" -G Ninja ${launcher[@]+"${launcher[@]}"} \
        -DSTILL_WEB_THREADS="$threads" >/dev/null
    cmake --build "build/web/$build" --target stillframe_web
done

site=build/web/site
rm -rf "$site.part"
mkdir -p "$site.part"/{threads,single}
cp demos/web/page/* "$site.part"
for build in threads single; do
    cp "build/web/$build"/stillframe_web.{js,wasm} "$site.part/$build"
done
cp build/web/threads/stillframe_web.worker.js "$site.part/threads"
node demos/web/make_expected.mjs build/release/demos/stillframe demos/web/page/steps.json \
    "$site.part/expected.json"
rm -rf "$site"
mv "$site.part" "$site"

case "$task" in
    --build) ;;
    --test)
        # The same table of hashes as natively, by node; then the page in a browser.
        cmake --build build/web/threads --target determinism
        node --no-experimental-fetch build/web/threads/determinism.js
        mkdir -p build/web/test
        cp demos/web/package.json demos/web/serve.mjs demos/web/test/*.mjs build/web/test
        (cd build/web/test && npm install --silent --no-audit --no-fund)
        node build/web/test/page_test.mjs "$site" tests/data out/web
        ;;
    *) node demos/web/serve.mjs "$site" 8000 ;;
esac
