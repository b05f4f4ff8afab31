/* SPDX-License-Identifier: MIT
 * The rule of dialects: whether content alone tells the year, where the years differ for what the
 * scene holds. The conflicts are those of docs/scene-format.md, section 2. */
#include "check/inside.h"

#include <stdio.h>

/* What of the years' differences shows in this scene. */
typedef struct Shows {
    bool diffuse, plain, highlight; /* diffuse terms; Lambertian without a colour; Phong */
    bool lights;
} Shows;

static Shows shows_of(const GiCheck *check) {
    const GiScene *scene = check->scene;
    Shows shows = {.lights = scene->lights.count > 0};
    for (size_t i = 0; i < scene->shaders.count; i++) {
        const GiShader *shader = &scene->shaders.data[i];
        if (!check->shader_used[i]) continue;
        bool phong = shader->type == GLINT_SHADER_PHONG;
        bool lambertian = shader->type == GLINT_SHADER_LAMBERTIAN;
        bool textured = shader->texture != GI_NONE;
        shows.diffuse |= (phong || lambertian) && (textured || !gi_vec_is_zero(shader->diffuse));
        shows.plain |= lambertian && !shader->diffuse_given && !textured;
        shows.highlight |= phong && !gi_vec_is_zero(shader->specular);
    }
    return shows;
}

void gi_check_dialect(GiCheck *check) {
    const GiSources *sources = check->input->sources;
    GlintDialect dialect = check->scene->dialect;
    Shows shows = shows_of(check);
    if (!sources->guessed || !shows.lights || (!shows.diffuse && !shows.highlight)) return;
    const char *chosen = glint_dialect_name(dialect), *others, *either = "2019";
    char differ[240];
    if (dialect == GLINT_DIALECT_2017) {
        /* The assignments of 2018 know no Phong. */
        others = shows.highlight ? "2019" : "2018 and 2019";
        if (!shows.highlight) either = "2018";
        snprintf(differ, sizeof differ, "%s%s%s%s",
            shows.diffuse ? "diffuse light is divided by pi" : "",
            shows.diffuse && shows.highlight ? " and " : "",
            shows.highlight ? "highlights fade toward the shadow" : "",
            shows.plain ? "; in 2019 a Lambertian without a colour is 0.2" : "");
    } else if (dialect == GLINT_DIALECT_2013) {
        others = "2017, 2018 and 2019";
        snprintf(differ, sizeof differ, "light falls off with the square of the distance");
    } else {
        return;
    }
    gi_check_add(check, GI_CHECK_DIALECT, check->root,
        "read as %s, but nothing in the file tells it from %s, where %s\n"
        "say which is meant: <scene dialect=\"%s\"> or <scene dialect=\"%s\">",
        chosen, others, differ, chosen, either);
}
