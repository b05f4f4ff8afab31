/* SPDX-License-Identifier: MIT
 * What is asked of a session from outside: other cameras and views, what a pixel shows, and the
 * camera written down. */
#define _POSIX_C_SOURCE 200809L
#include "watch/session_state.h"

#include "progress.h"
#include "watch/camera.h"
#include "watch/camera_text.h"
#include "watch/pick.h"
#include "watch/save.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void request_picture(CliSession *session) {
    session->changed = cli_clock();
    atomic_store(&session->redraw, true);
    pthread_cond_signal(&session->requested);
}

void cli_session_set_camera(CliSession *session, const GlintCameraDesc *camera) {
    pthread_mutex_lock(&session->lock);
    session->camera = *camera;
    session->moved = !cli_camera_equal(camera, &session->file_camera);
    request_picture(session);
    pthread_mutex_unlock(&session->lock);
}

void cli_session_reset_camera(CliSession *session) {
    pthread_mutex_lock(&session->lock);
    if (session->moved) {
        session->camera = session->file_camera;
        session->moved = false;
        request_picture(session);
    }
    pthread_mutex_unlock(&session->lock);
}

void cli_session_set_view(CliSession *session, int view) {
    pthread_mutex_lock(&session->lock);
    if (session->view != view) {
        session->view = view;
        request_picture(session);
    }
    pthread_mutex_unlock(&session->lock);
}

/* How far away is what the middle of the picture shows. */
static double find_distance(CliSession *session, const GlintCameraDesc *camera) {
    GlintRay ray = {.t_min = 0};
    GlintHit hit;
    if (glint_camera_ray(camera, 0.5, 0.5, &ray, NULL) == GLINT_OK &&
        glint_trace(session->scene, &ray, &hit) && hit.t > 0) {
        return session->distance = hit.t;
    }
    if (session->distance > 0) return session->distance;
    /* Most scenes are about the origin. */
    double along = 0;
    for (int i = 0; i < 3; i++) along -= camera->view_point[i] * ray.direction[i];
    return along > 0 && isfinite(along) ? along : 1;
}

bool cli_session_camera(CliSession *session, GlintCameraDesc *camera, double *distance) {
    pthread_mutex_lock(&session->scene_lock);
    bool there = session->scene != NULL;
    if (there) {
        pthread_mutex_lock(&session->lock);
        *camera = session->camera;
        pthread_mutex_unlock(&session->lock);
        *distance = find_distance(session, camera);
    }
    pthread_mutex_unlock(&session->scene_lock);
    return there;
}

static int clamp(int value, int limit) { return value < 0 ? 0 : value < limit ? value : limit - 1; }

/* Takes the scene from the drawer, who stops within a few tens of milliseconds; and back. */
static void begin_question(CliSession *session) {
    pthread_mutex_lock(&session->lock);
    atomic_fetch_add(&session->askers, 1);
    while (session->drawing) pthread_cond_wait(&session->answered, &session->lock);
    pthread_mutex_unlock(&session->lock);
    pthread_mutex_lock(&session->scene_lock);
}

static void end_question(CliSession *session) {
    pthread_mutex_unlock(&session->scene_lock);
    pthread_mutex_lock(&session->lock);
    atomic_fetch_sub(&session->askers, 1);
    pthread_cond_signal(&session->requested);
    pthread_mutex_unlock(&session->lock);
}

void cli_session_pick(
    CliSession *session, const CliFrame *frame, double x, double y, CliBytes *text) {
    if (frame->pixels == NULL) return;
    size_t column = (size_t)clamp((int)(x * frame->width), frame->width);
    size_t row = (size_t)clamp((int)(y * frame->height), frame->height);
    CliPicked picked = {.width = frame->full_width,
        .height = frame->full_height,
        .x = clamp((int)(x * frame->full_width), frame->full_width),
        .y = clamp((int)(y * frame->full_height), frame->full_height),
        .color = frame->pixels + 3 * (row * (size_t)frame->width + column),
        .camera = &frame->camera};
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = frame->full_width;
    desc.height = frame->full_height;
    desc.samples = session->desc.samples;
    desc.camera = &frame->camera;
    begin_question(session);
    if (session->scene != NULL) {
        cli_pick_describe(session->scene, &picked, text);
        if (session->desc.explain != NULL) {
            session->desc.explain(session->scene, &desc, session->path, picked.x, picked.y, text);
        }
    }
    end_question(session);
}

/* ---------------------------------------------------------------- writing the camera down */

/* The camera that counts: the last one, or the one that this refers to by name. */
static bool find_camera(const CliSession *session, CliCameraText *place) {
    GlintSource source;
    uint32_t index1 = 0;
    while (glint_scene_source(session->scene, GLINT_OBJECT_CAMERA, index1 + 1, &source)) index1++;
    char name[256];
    while (index1 > 0) {
        glint_scene_source(session->scene, GLINT_OBJECT_CAMERA, index1, &source);
        place->line = source.line;
        place->column = source.column;
        if (!cli_camera_text_ref(place, name, sizeof name)) return true;
        do {
            index1--;
        } while (index1 > 0 &&
                 (!glint_scene_source(session->scene, GLINT_OBJECT_CAMERA, index1, &source) ||
                     strcmp(source.name, name) != 0));
    }
    return false;
}

/* Whether the text is a scene with this camera: the proof that it says what it should. */
static bool is_scene_with(
    const CliSession *session, const CliBytes *text, const GlintCameraDesc *camera) {
    GlintSceneDesc desc = cli_session_scene_desc(session, NULL);
    GlintScene *scene = NULL;
    GlintCameraDesc own;
    bool good = glint_scene_create(&desc, &scene, NULL) == GLINT_OK &&
                glint_scene_load_memory(scene, cli_bytes_text(text), text->size, session->path,
                    NULL, NULL) == GLINT_OK &&
                glint_scene_camera(scene, &own) && cli_camera_equal(&own, camera);
    glint_scene_destroy(scene);
    return good;
}

static bool save(CliSession *session, const GlintCameraDesc *before, const GlintCameraDesc *after,
    char *message, size_t size) {
    CliBytes changed = {0};
    CliCameraText place = {.text = cli_bytes_text(&session->text), .size = session->text.size};
    char reason[160] = "the camera is not found in the text of the scene";
    bool good = find_camera(session, &place) &&
                cli_camera_text_replace(&place, before, after, &changed, reason, sizeof reason);
    if (good && !is_scene_with(session, &changed, after)) {
        snprintf(reason, sizeof reason, "the scene would not say this camera afterwards");
        good = false;
    }
    if (good) {
        good = cli_scene_text_save(session->path, &session->text, &changed, message, size);
    } else {
        snprintf(message, size, "camera not written: %s", reason);
    }
    cli_bytes_reset(&changed);
    return good;
}

bool cli_session_save_camera(CliSession *session, char *message, size_t size) {
    pthread_mutex_lock(&session->scene_lock);
    pthread_mutex_lock(&session->lock);
    GlintCameraDesc before = session->file_camera, after = session->camera;
    bool there = session->scene != NULL, moved = session->moved;
    pthread_mutex_unlock(&session->lock);
    bool good = false;
    if (!there || !moved) {
        snprintf(message, size, "the camera is the one of the file");
    } else {
        good = save(session, &before, &after, message, size);
    }
    pthread_mutex_unlock(&session->scene_lock);
    return good;
}
