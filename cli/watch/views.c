/* SPDX-License-Identifier: MIT
 * A view is a row of the table: its name, and what the library shows for it. */
#include "watch/views.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct View {
    const char *name;
    GlintShow show;
    bool albedo; /* not a thing to show but an output beside the picture */
} View;

static const View views[] = {
    {"picture", GLINT_SHOW_PICTURE, false},
    {"normal", GLINT_SHOW_NORMAL, false},
    {"depth", GLINT_SHOW_DEPTH, false},
    {"uv", GLINT_SHOW_UV, false},
    {"id", GLINT_SHOW_ID, false},
    {"cost", GLINT_SHOW_COST, false},
    {"shadow", GLINT_SHOW_SHADOW, false},
    {"albedo", GLINT_SHOW_PICTURE, true},
};

enum { VIEW_COUNT = sizeof views / sizeof views[0] };

const char *cli_view_name(int view) {
    return view >= 0 && view < VIEW_COUNT ? views[view].name : NULL;
}

static GlintStatus render_albedo(
    GlintScene *scene, GlintRenderDesc *desc, float *pixels, GlintError *error) {
    size_t size = 3 * sizeof *pixels * (size_t)desc->width * (size_t)desc->height;
    desc->albedo = malloc(size);
    if (desc->albedo == NULL) {
        snprintf(
            error->message, sizeof error->message, "%s", glint_status_text(GLINT_ERROR_MEMORY));
        return GLINT_ERROR_MEMORY;
    }
    desc->light = -1; /* the least work: no light is asked for */
    GlintStatus status = glint_render(scene, desc, pixels, error);
    if (status == GLINT_OK) memcpy(pixels, desc->albedo, size);
    free(desc->albedo);
    desc->albedo = NULL;
    return status;
}

GlintStatus cli_view_render(
    GlintScene *scene, GlintRenderDesc *desc, int view, float *pixels, GlintError *error) {
    if (views[view].albedo) return render_albedo(scene, desc, pixels, error);
    desc->show = views[view].show;
    if (desc->show != GLINT_SHOW_PICTURE) desc->samples = 1; /* more would show the same */
    return glint_render(scene, desc, pixels, error);
}
