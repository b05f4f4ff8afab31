/* SPDX-License-Identifier: MIT
 * Small pictures, drawn as large ones are. */
#include "check/inside.h"
#include "render/render.h"

#include <string.h>

static size_t pixel_count(const GiSurvey *survey) {
    return (size_t)survey->width * (size_t)survey->height;
}

/* Of the monitor only the question whether to stop: several pictures are no progress. */
static bool draw(GiCheck *check, int light, GiSurvey *survey) {
    GiRenderArea area = {.width = survey->width, .height = survey->height};
    area.crop_width = area.width;
    area.crop_height = area.height;
    GiRenderTarget target = {
        .samples = 1, .color = survey->color, .surface = survey->surface, .light = light};
    const GlintMonitor *outer = check->input->monitor;
    GlintMonitor monitor = {0};
    if (outer != NULL) monitor = (GlintMonitor){NULL, outer->cancelled, outer->user};
    GiRenderCounts counts;
    check->status = gi_render(check->world, check->input->pool, &area, &monitor, &target, &counts);
    return check->status == GLINT_OK;
}

bool gi_survey_draw(GiCheck *check, int side, int light, GiSurvey *survey) {
    const GiScene *scene = check->scene;
    *survey = (GiSurvey){.width = scene->width < side ? scene->width : side,
        .height = scene->height < side ? scene->height : side};
    size_t count = pixel_count(survey);
    survey->color = gi_memory_allocate(check->memory, count * 3 * sizeof *survey->color);
    survey->surface = gi_memory_allocate(check->memory, count * sizeof *survey->surface);
    if (survey->color == NULL || survey->surface == NULL) {
        check->status = GLINT_ERROR_MEMORY;
        return false;
    }
    if (!draw(check, light, survey)) return false;
    for (size_t i = 0; i < count; i++) survey->seen += survey->surface[i] != 0;
    return true;
}

void gi_survey_free(const GiCheck *check, GiSurvey *survey) {
    size_t count = pixel_count(survey);
    gi_memory_free(check->memory, survey->color, count * 3 * sizeof *survey->color);
    gi_memory_free(check->memory, survey->surface, count * sizeof *survey->surface);
}

bool gi_survey_look(const GiCheck *check, double a, double b, GiSight *sight) {
    const GiWorld *world = check->world;
    gi_view_ray(&world->view, a, b, &sight->origin, &sight->direction);
    GiTraceRay ray = {sight->origin, sight->direction, gi_world_eye_error(world, world->view.eye),
        INFINITY, GI_SHAPE_NONE, GI_SHAPE_NONE};
    return world->kernel->closest(&world->trace, &ray, &sight->hit);
}
