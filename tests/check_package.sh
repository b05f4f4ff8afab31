#!/bin/sh
# SPDX-License-Identifier: MIT
# The Debian packages: two builds in different folders are the same to the byte, lintian finds
# nothing, and, as root, what is installed works and goes away again.
#   check_package.sh [BUILD]    BUILD has the program whose pictures theirs must equal
# Ends with "N passed, N failed[, N skipped]".
set -u
build=$(cd "${1:-build}" && pwd) || exit 3
source=$(cd "$(dirname "$0")/.." && pwd) || exit 3
dir=$(mktemp -d)
installed= # whether it is ours to remove
names="glint glint-modules glint-window libglint0 libglint-dev python3-glint"
clean() {
    # shellcheck disable=SC2086 # names are a list
    [ -z "$installed" ] || apt purge -y $names >/dev/null 2>&1
    rm -rf "$dir"
}
trap clean EXIT
trap 'exit 130' INT TERM
passed=0
failed=0
skipped=0
check() { # check WHAT COMMAND...
    what=$1
    shift
    if "$@" >"$dir/said" 2>&1; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAIL package: $what"
        tail -n 20 "$dir/said"
    fi
}
skip() { # skip WHY
    skipped=$((skipped + 1))
    echo "skip package: $1"
}
apt() { # waits for its turn
    DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=600 "$@" </dev/null
}
finish() {
    echo "$passed passed, $failed failed, $skipped skipped"
    [ $failed -eq 0 ]
    exit
}

# ---------------------------------------------------------------- built

export SOURCE_DATE_EPOCH=1600000000
one=$dir/one two=$dir/another/place
check "a build with its tests" env DEB_BUILD_OPTIONS=parallel=2 "$source/packaging/build.sh" "$one"
check "a second build" env DEB_BUILD_OPTIONS='parallel=1 nocheck' TZ=Asia/Tokyo \
    sh -c "umask 077 && '$source/packaging/build.sh' '$two'"
for file in "$one"/*.deb "$one"/*.dsc "$one"/*.tar.* "$one"/*.whl; do
    check "the same bytes: ${file##*/}" cmp "$file" "$two/${file##*/}"
done
check "lintian" lintian --allow-root --fail-on error,warning "$one"/*.changes
[ ! -s "$dir/said" ] || cat "$dir/said"
check "their time" sh -c "dpkg-deb --fsys-tarfile '$one'/glint_*.deb |
    tar -tv --utc --full-time | grep -q '2020-09-13 12:26:40 ./usr/bin/glint'"
[ $failed -eq 0 ] || finish

# ---------------------------------------------------------------- installed

if [ "$(id -u)" -ne 0 ]; then
    skip "only root can install packages"
    finish
fi
for name in $names; do
    if dpkg-query -W -f '${Status}\n' $name 2>/dev/null | grep -q ' installed'; then
        skip "a package $name is installed already"
        finish
    fi
done

traces() { find /etc /opt /usr /var -name '*glint*' 2>/dev/null; }
traces | sort >"$dir/before"
installed=yes
check "apt install" apt install -y --no-install-recommends "$one"/glint_*.deb \
    "$one"/glint-modules_*.deb "$one"/glint-window_*.deb "$one"/libglint0_*.deb \
    "$one"/libglint-dev_*.deb "$one"/python3-glint_*.deb

mkdir "$dir/work" && cd "$dir/work" || exit 3
examples=/usr/share/doc/glint/examples
check "glint --version" /usr/bin/glint --version
check "glint: a picture" /usr/bin/glint --size 60x40 -o solids.png $examples/solids.xml
check "glint: a PNG texture, EXR" /usr/bin/glint --size 60x40 -o globe.exr $examples/globe.xml
for file in solids.png globe.exr; do
    # Of the same path, which stands in the recipe of a PNG.
    "$build/glint" -q --size 60x40 -o "own-$file" "$examples/${file%.*}.xml"
    check "$file is that of the build" cmp "$file" "own-$file"
done
check "the manual page" sh -c 'zcat /usr/share/man/man1/glint.1.gz | grep -q "^.TH GLINT 1"'

cc=${CC:-gcc}
# shellcheck disable=SC2046 # flags are several words
{
    check "pkg-config" "$cc" "$source/tests/stranger/ball.c" -o ball \
        $(pkg-config --cflags --libs glint)
    check "pkg-config --static" "$cc" "$source/tests/stranger/ball.c" -o ball-static \
        $(pkg-config --static --cflags --libs glint | sed 's/-lglint/-l:libglint.a/')
}
check "CMake" sh -c "cmake -S '$source/tests/stranger' -B cmake && cmake --build cmake"
for program in ball ball-static cmake/ball cmake/ball-static cmake/ball-cxx; do
    check "$program runs" "./$program"
    check "$program finds the modules" "./$program" $examples/globe.xml ball.exr
done
for page in library scene-format; do
    check "the page $page" test -e /usr/share/doc/libglint-dev/$page.md -o \
        -e /usr/share/doc/libglint-dev/$page.md.gz
done
check "Python" env -u GLINT_LIBRARY -u PYTHONPATH /usr/bin/python3 "$source/tests/python/run.py" \
    scene building image tracing
check "Python is that of the package" /usr/bin/python3 -c \
    'import glint; assert glint.__file__.startswith("/usr/lib/python3/dist-packages/")'

# ---------------------------------------------------------------- removed

# shellcheck disable=SC2086 # names are a list
check "apt purge" apt purge -y $names
installed=
traces | sort >"$dir/after"
check "nothing is left" diff "$dir/before" "$dir/after"
finish
