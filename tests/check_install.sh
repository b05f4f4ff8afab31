#!/bin/sh
# SPDX-License-Identifier: MIT
# What a user of the library gets: installs a build into an empty folder, compiles a small program
# against it through pkg-config, with the shared and with the static library, and runs it.
#   check_install.sh BUILD
# Ends with "N passed, N failed".
set -u
build=$(cd "${1:-build}" && pwd) || exit 3
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
passed=0
failed=0
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

cat >"$dir/ball.c" <<'C'
/* A program of somebody else: one sphere, one light, one ray. */
#include <glint/glint.h>

#include <stdio.h>

int main(void) {
    GlintError error;
    GlintSceneDesc desc = glint_scene_desc_default();
    GlintImageDesc image = glint_image_desc_default();
    GlintCameraDesc camera = glint_camera_desc_default();
    GlintLightDesc light = glint_light_desc_default();
    GlintSurfaceDesc ball = glint_surface_desc_default(GLINT_SURFACE_SPHERE);
    GlintRenderDesc render = glint_render_desc_default();
    GlintScene *scene = NULL;
    GlintHit hit;
    GlintRay ray = {{0, 0, 5}, {0, 0, -1}, 0, 100};
    static float pixels[16 * 16 * 3];
    GlintImage picture = {16, 16, pixels};
    GlintSaveDesc save = glint_save_desc_default();
    image.width = image.height = 16;
    camera.view_point[2] = 5;
    light.position[2] = 5;
    if (glint_scene_create(&desc, &scene, &error) != GLINT_OK ||
        glint_scene_set_image(scene, &image, &error) != GLINT_OK ||
        glint_scene_set_camera(scene, &camera, &error) != GLINT_OK ||
        glint_scene_add_light(scene, &light, &error) != GLINT_OK ||
        glint_scene_add_surface(scene, &ball, NULL, &error) != GLINT_OK ||
        glint_scene_commit(scene, NULL, &error) != GLINT_OK ||
        glint_render(scene, &render, pixels, &error) != GLINT_OK ||
        glint_image_save(&picture, "ball.png", &save, &error) != GLINT_OK) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    if (!glint_trace(scene, &ray, &hit) || hit.t < 3.999999 || hit.t > 4.000001) return 2;
    glint_scene_destroy(scene);
    return 0;
}
C

check "meson install" env DESTDIR="$dir/root" meson install -C "$build" --no-rebuild --quiet
pc=$(find "$dir/root" -name glint.pc | head -n 1)
[ -n "$pc" ] || pc=$dir/none/glint.pc
export PKG_CONFIG_PATH="${pc%/*}"
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
cd "$dir" || exit 3
flags() { pkg-config --define-variable=prefix="$prefix" --cflags --libs "$@" glint; }
# shellcheck disable=SC2046 # flags are several words
{
    check "a program with the shared library" \
        "${CC:-gcc}" -std=c11 -Wall -Werror ball.c -o ball $(flags)
    check "it runs" env LD_LIBRARY_PATH="$libdir" ./ball
    check "it has drawn" test -s ball.png
    check "a program with the static library" \
        "${CC:-gcc}" -std=c11 ball.c -o ball-static \
        $(flags --static | sed 's/-lglint/-l:libglint.a/')
    check "it runs" ./ball-static
}
# Nothing but the public names may be seen from outside.
check "exported names" test -z "$(nm -D --defined-only "$libdir/libglint.so.0" |
    awk '$2 ~ /[A-Z]/ && $3 !~ /^glint_/ { print $3 }')"

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
