#!/bin/sh
# SPDX-License-Identifier: MIT
# What a user of the library gets. A build is installed into an empty folder; small programs are
# compiled against it through pkg-config and CMake, with the shared and with the static library, and
# run. Then the same with the build folder itself, where nothing is installed.
#   check_install.sh BUILD
# Ends with "N passed, N failed[, N skipped]".
set -u
build=$(cd "${1:-build}" && pwd) || exit 3
source=$(cd "$(dirname "$0")/.." && pwd) || exit 3
stranger=$source/tests/stranger
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
trap 'exit 130' INT TERM
passed=0
failed=0
skipped=0
check() { # check WHAT COMMAND...
    what=$1
    shift
    if "$@" >"$dir/log" 2>&1; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAIL install: $what"
        head -n 10 "$dir/log"
    fi
}
cc=${CC:-gcc}

# draws PROGRAM: whether it works, and finds those modules that were built. These lie beside the
# shared library; a static one looks where it was to be installed, which is not here.
draws() {
    rm -f ball.png globe.exr
    check "$1 runs" "./$1"
    check "$1 has drawn" test -s ball.png
    [ "$1" != ball-static ] || return 0
    [ -e "$build/modules/glint-png.so" ] && [ -e "$build/modules/glint-exr.so" ] || return 0
    check "$1 finds the modules" "./$1" "$source/scenes/globe.xml" globe.exr
    check "$1 has written EXR" test -s globe.exr
}

# programs PKG_CONFIG_OPTION...: all that a .pc file is asked for.
programs() {
    flags=$(pkg-config "$@" --cflags --libs glint)
    # That of the static library, where the linker would take the shared one.
    static=$(pkg-config "$@" --static --cflags --libs glint | sed 's/-lglint/-l:libglint.a/')
    # shellcheck disable=SC2086 # flags are several words
    {
        check "a program with the shared library" \
            "$cc" -std=c11 -Wall -Werror "$stranger/ball.c" -o ball $flags
        check "a program with the static library" \
            "$cc" -std=c11 "$stranger/ball.c" -o ball-static $static
        for name in example embed; do
            check "docs/$name.c" "$cc" -std=c11 "$source/docs/$name.c" -o $name $flags
        done
    }
    draws ball
    (unset LD_LIBRARY_PATH && ldd ./ball-static) >"$dir/needs"
    check "the static program needs no libglint" sh -c "! grep libglint '$dir/needs'"
    draws ball-static
    check "docs/example.c runs" ./example
    check "docs/embed.c runs" sh -c './embed 60 >embed.png && test -s embed.png'
    check "docs/embed.c stops in time" sh -c '! ./embed 0 >embed.png 2>/dev/null'
}

# ---------------------------------------------------------------- installed

check "meson install" env DESTDIR="$dir/root" meson install -C "$build" --no-rebuild --quiet
pc=$(find "$dir/root" -name glint.pc | head -n 1)
[ -n "$pc" ] || pc=$dir/none/pkgconfig/glint.pc
libdir=${pc%/pkgconfig/*}
prefix=$(dirname "$(find "$dir/root" -type d -name include | head -n 1)")
check "the header" test -f "$prefix/include/glint/glint.h"
check "the program" "$prefix/bin/glint" --version
check "the manual" test -s "$prefix/share/man/man1/glint.1"
for verb in $("$prefix/bin/glint" --help | sed -n 's/^  \([a-z]*\) .*/\1/p' | grep -v '^glint$'); do
    check "the manual of $verb" test -s "$prefix/share/man/man1/glint-$verb.1"
done
for script in bash-completion/completions/glint zsh/site-functions/_glint \
    fish/vendor_completions.d/glint.fish; do
    check "completion: $script" test -s "$prefix/share/$script"
done
check "the shared library's name" test -e "$libdir/libglint.so.0"
# What the build made of modules must be where the library will look for it.
for module in "$build"/modules/*.so; do
    [ -e "$module" ] || continue
    check "the module ${module##*/}" test -f "$libdir/glint/${module##*/}"
done
# Nothing but the public names may be seen from outside.
check "exported names" test -z "$(nm -D --defined-only "$libdir/libglint.so.0" |
    awk '$2 ~ /[A-Z]/ && $3 !~ /^glint_/ { print $3 }')"

mkdir "$dir/installed" && cd "$dir/installed" || exit 3
export LD_LIBRARY_PATH="$libdir"
PKG_CONFIG_PATH=${pc%/*} programs --define-variable=prefix="$prefix"

# CMake writes where the library is into the programs.
unset LD_LIBRARY_PATH
if command -v cmake >/dev/null 2>&1; then
    check "CMake: configure" env CC="$cc" cmake -S "$stranger" -B "$dir/cmake" \
        -Dglint_DIR="$libdir/cmake/glint"
    check "CMake: build" cmake --build "$dir/cmake"
    if cd "$dir/cmake"; then
        for name in ball ball-static ball-cxx; do draws $name; done
    fi
else
    skipped=1
    echo "skip install: there is no CMake"
fi

# ---------------------------------------------------------------- not installed

mkdir "$dir/uninstalled" && cd "$dir/uninstalled" || exit 3
export LD_LIBRARY_PATH="$build"
PKG_CONFIG_PATH=$build/meson-uninstalled programs

echo "$passed passed, $failed failed, $skipped skipped"
[ $failed -eq 0 ]
