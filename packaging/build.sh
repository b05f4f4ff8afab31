#!/bin/sh
# SPDX-License-Identifier: MIT
# Makes the Debian packages, the source package and the Python wheel of the sources as they stand in
# this clone. The same sources make the same bytes, wherever and by whomever they are built.
#   build.sh FOLDER    empties FOLDER, and leaves there what is made
# DEB_BUILD_OPTIONS=nocheck leaves out the tests; SOURCE_DATE_EPOCH is the time in the packages, by
# default that of the last entry in packaging/debian/changelog.
set -u
source=$(cd "$(dirname "$0")/.." && pwd) || exit 3
die() {
    echo "package: $*" >&2
    exit 1
}
[ $# -eq 1 ] || die "usage: $0 FOLDER"
mkdir -p "$1" && folder=$(cd "$1" && pwd) || exit 3
changelog=$source/packaging/debian/changelog
version=$(dpkg-parsechangelog -l "$changelog" -S Version) || exit 1
grep -q "^  version: '$version'," "$source/meson.build" ||
    die "packaging/debian/changelog has version $version, meson.build another"
time=$(dpkg-parsechangelog -l "$changelog" -S Timestamp) || exit 1
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$time}
# What differs between people must not reach the packages.
export SOURCE_DATE_EPOCH LC_ALL=C.UTF-8 TZ=UTC
unset CC CFLAGS CPPFLAGS LDFLAGS
umask 022

# Only our own leavings, in case the folder was named by mistake.
tree=$folder/glint-$version
rm -rf "$tree" "$folder"/*glint*.deb "$folder"/glint_* "$folder"/glint-*.whl "$folder/log"
mkdir "$tree" || exit 3
cd "$source" || exit 3
git ls-files -z --cached --others --exclude-standard | sort -zu >"$folder/files" || exit 1
git ls-files -z --deleted | sort -zu >"$folder/deleted" || exit 1
comm -z -23 "$folder/files" "$folder/deleted" | tar -c --null -T - | tar -x -C "$tree" || exit 1
rm "$folder/files" "$folder/deleted"
cp -r packaging/debian "$tree/debian" || exit 1
chmod -R u=rwX,go=rX "$tree"
find "$tree" -exec touch -h -d "@$time" {} +

cd "$tree" || exit 3
dpkg-buildpackage --no-sign >"$folder/log" 2>&1 || {
    tail -n 40 "$folder/log" >&2
    die "dpkg-buildpackage failed; all it said is in $folder/log"
}
/usr/bin/python3 -m pip wheel --quiet --no-index --no-deps --no-build-isolation \
    --disable-pip-version-check --wheel-dir "$folder" "$tree/python" >>"$folder/log" 2>&1 || {
    tail -n 40 "$folder/log" >&2
    die "the wheel failed"
}
cd "$folder" && rm -rf "$tree" && ls -d "$folder"/*.deb "$folder"/*.dsc "$folder"/*.whl
