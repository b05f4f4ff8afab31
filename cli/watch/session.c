/* SPDX-License-Identifier: MIT
 * Who holds what: `lock` guards requests and results; `scene_lock` the good scene and its text
 * against being replaced while another thread asks them. The drawer alone replaces them, so it
 * reads them without. Where both are held, scene_lock comes first. */
#define _POSIX_C_SOURCE 200809L
#include "watch/session.h"

#include "progress.h"
#include "watch/camera.h"
#include "watch/camera_text.h"
#include "watch/files.h"
#include "watch/pick.h"
#include "watch/save.h"
#include "watch/schedule.h"
#include "watch/views.h"

#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A first look that takes longer is interrupted as well. */
static const double patience = 0.1;

enum { FINDINGS_LIMIT = 16384 };

typedef struct Pixels {
    float *data;
    size_t capacity; /* floats */
} Pixels;

struct CliSession {
    CliSessionDesc desc;
    char *path;
    CliFileWatch *files;
    pthread_t watcher, drawer;
    bool has_watcher, has_drawer;
    pthread_mutex_t lock, scene_lock;
    pthread_cond_t requested, answered;

    /* Requests: set under lock, and read without by a call that may have to be given up. */
    atomic_bool quit, reload, redraw;
    atomic_int askers; /* threads that want the scene, which is then not drawn */
    double noticed;    /* the save, for the next load */
    double changed;    /* what is to be drawn */
    GlintCameraDesc camera;
    int view;

    /* The good scene. */
    GlintScene *scene;
    CliBytes text;               /* of its file */
    GlintCameraDesc file_camera; /* under lock */
    bool moved;                  /* camera is not that of the file; under lock */
    double distance;             /* the last that was found; under scene_lock; 0: none */

    bool drawing; /* the drawer uses the scene; under lock */

    CliFrame frame; /* its pixels go to whoever takes them */
    bool fresh;     /* they are there */

    /* The drawer's own. */
    CliSchedule schedule;
    CliStep step;
    bool again; /* the step was not finished */
    GlintCameraDesc drawn_camera;
    int drawn_view;
    double drawn_change, step_began, share;
    Pixels pixels;
};

static void tell(CliSession *session) {
    if (session->desc.wake != NULL) session->desc.wake(session->desc.user);
}

/* ---------------------------------------------------------------- loading */

static bool load_is_old(void *user) {
    const CliSession *session = user;
    return atomic_load(&session->quit) || atomic_load(&session->reload);
}

static void on_diagnostic(void *user, const GlintDiagnostic *diagnostic) {
    CliBytes *findings = user;
    if (findings->size > FINDINGS_LIMIT) return;
    size_t size = glint_diagnostic_format(diagnostic, NULL, 0) + 1;
    char *text = malloc(size);
    if (text == NULL) return;
    glint_diagnostic_format(diagnostic, text, size);
    cli_bytes_add_text(findings, text);
    free(text);
}

static GlintSceneDesc scene_desc(const CliSession *session, CliBytes *findings) {
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.dialect = session->desc.dialect;
    desc.thread_count = session->desc.thread_count;
    desc.isa = session->desc.isa;
    desc.keep_sources = true;
    desc.diagnostic = findings != NULL ? on_diagnostic : NULL;
    desc.diagnostic_user = findings;
    return desc;
}

/* Reads the file and what it names, and builds the tree. *scene may be one that failed. */
static GlintStatus read_scene(
    CliSession *session, GlintScene **scene, CliBytes *text, CliBytes *findings) {
    GlintMonitor monitor = {NULL, load_is_old, session};
    GlintError error = {0};
    *scene = NULL;
    if (!cli_file_read(session->path, text)) {
        cli_bytes_format(findings, "%s: error: %s\n", session->path, strerror(errno));
        return GLINT_ERROR_FILE;
    }
    GlintSceneDesc desc = scene_desc(session, findings);
    GlintStatus status = glint_scene_create(&desc, scene, &error);
    if (status == GLINT_OK) {
        status = glint_scene_load_memory(
            *scene, cli_bytes_text(text), text->size, session->path, &monitor, &error);
    }
    if (status == GLINT_OK) status = glint_scene_commit(*scene, &monitor, &error);
    if (status != GLINT_OK && findings->size == 0) {
        const char *message = error.message[0] != '\0' ? error.message : glint_status_text(status);
        cli_bytes_format(findings, "%s: error: %s\n", session->path, message);
    }
    return status;
}

/* The scene file and what it names are watched from now on, what is missing too. */
static void watch_files(CliSession *session, const GlintScene *scene, int64_t since) {
    int count = 1, found = 0;
    size_t missing = 0;
    GlintSceneFile file;
    while (scene != NULL && glint_scene_file(scene, found, &file)) found++;
    while (scene != NULL && glint_scene_missing_file(scene, missing) != NULL) missing++;
    const char **paths = malloc(((size_t)found + missing + 1) * sizeof *paths);
    if (paths == NULL) return; /* those of before still are */
    paths[0] = session->path;
    for (int i = 0; i < found && glint_scene_file(scene, i, &file); i++) {
        if (file.kind != GLINT_FILE_SCENE) paths[count++] = file.path;
    }
    for (size_t i = 0; i < missing; i++) paths[count++] = glint_scene_missing_file(scene, i);
    cli_file_watch_set(session->files, paths, count, since);
    free(paths);
}

/* The scene takes the place of the one before. A camera that was moved by hand stays, unless the
 * file has another one now. */
static void adopt(CliSession *session, GlintScene *scene, CliBytes *text) {
    GlintCameraDesc camera = glint_camera_desc_default();
    glint_scene_camera(scene, &camera);
    pthread_mutex_lock(&session->scene_lock);
    pthread_mutex_lock(&session->lock);
    GlintScene *old = session->scene;
    CliBytes old_text = session->text;
    bool first = old == NULL;
    session->scene = scene;
    session->text = *text;
    if (first || !session->moved || !cli_camera_equal(&camera, &session->file_camera)) {
        session->camera = camera;
        session->moved = false;
    }
    session->file_camera = camera;
    session->changed = session->frame.saved;
    atomic_store(&session->redraw, true);
    pthread_mutex_unlock(&session->lock);
    pthread_mutex_unlock(&session->scene_lock);
    glint_scene_destroy(old);
    cli_bytes_reset(&old_text);
}

static void load(CliSession *session) {
    int64_t since = cli_file_watch_now();
    CliBytes text = {0}, findings = {0};
    GlintScene *scene;
    GlintStatus status = read_scene(session, &scene, &text, &findings);
    bool given_up = status == GLINT_CANCELLED;
    if (!given_up) {
        watch_files(session, scene, since);
        pthread_mutex_lock(&session->lock);
        CliFrame *frame = &session->frame;
        CliBytes old = frame->findings;
        frame->findings = findings;
        findings = old;
        frame->broken = status != GLINT_OK;
        frame->saved = session->noticed;
        frame->loads++;
        /* What is well shows with its first picture, so that nothing flickers. */
        if (status != GLINT_OK) frame->number++;
        pthread_mutex_unlock(&session->lock);
    }
    if (status == GLINT_OK) {
        adopt(session, scene, &text);
    } else {
        glint_scene_destroy(scene);
        cli_bytes_reset(&text);
    }
    cli_bytes_reset(&findings);
    if (!given_up && status != GLINT_OK) tell(session);
}

/* ---------------------------------------------------------------- drawing */

static bool step_is_old(void *user) {
    const CliSession *session = user;
    if (load_is_old(user) || atomic_load(&session->askers) > 0) return true;
    if (!atomic_load(&session->redraw)) return false;
    return !session->step.first || cli_clock() - session->step_began > patience;
}

static void on_progress(void *user, GlintPhase phase, double fraction) {
    CliSession *session = user;
    (void)phase;
    session->share = fraction;
}

/* Begins with what has been asked for meanwhile. */
static void begin_picture(CliSession *session) {
    GlintSceneInfo info;
    glint_scene_info(session->scene, &info);
    pthread_mutex_lock(&session->lock);
    if (atomic_exchange(&session->redraw, false)) {
        const CliSessionDesc *desc = &session->desc;
        session->drawn_camera = session->camera;
        session->drawn_view = session->view;
        session->drawn_change = session->changed;
        cli_schedule_begin(&session->schedule, desc->width > 0 ? desc->width : info.width,
            desc->height > 0 ? desc->height : info.height,
            desc->samples > 0 ? desc->samples : info.samples);
    }
    pthread_mutex_unlock(&session->lock);
}

static bool reserve(Pixels *pixels, size_t count) {
    if (count <= pixels->capacity) return true;
    float *data = realloc(pixels->data, count * sizeof *data);
    if (data == NULL) return false;
    *pixels = (Pixels){data, count};
    return true;
}

static void publish(CliSession *session) {
    const CliStep *step = &session->step;
    pthread_mutex_lock(&session->lock);
    CliFrame *frame = &session->frame;
    Pixels old = {frame->pixels, frame->pixel_capacity};
    frame->pixels = session->pixels.data;
    frame->pixel_capacity = session->pixels.capacity;
    session->pixels = old;
    session->fresh = true;
    frame->width = step->width;
    frame->height = step->height;
    frame->full_width = session->schedule.width;
    frame->full_height = session->schedule.height;
    frame->samples = step->samples;
    frame->finished = step->last;
    frame->view = session->drawn_view;
    frame->camera = session->drawn_camera;
    frame->drawn = cli_clock();
    frame->seconds = frame->drawn - session->drawn_change;
    frame->number++;
    pthread_mutex_unlock(&session->lock);
    tell(session);
}

static void publish_failure(CliSession *session, const GlintError *error) {
    pthread_mutex_lock(&session->lock);
    CliFrame *frame = &session->frame;
    cli_bytes_clear(&frame->findings);
    cli_bytes_format(&frame->findings, "%s: error: %s\n", session->path, error->message);
    frame->broken = true;
    frame->number++;
    pthread_mutex_unlock(&session->lock);
    session->schedule.ended = true;
    tell(session);
}

/* A step that was given up for somebody who asked is drawn once more. */
static bool next_step(CliSession *session) {
    bool again = session->again && !atomic_load(&session->redraw);
    session->again = false;
    begin_picture(session);
    return again || cli_schedule_next(&session->schedule, &session->step);
}

static void draw(CliSession *session) {
    CliStep *step = &session->step;
    if (!next_step(session)) return;
    GlintMonitor monitor = {on_progress, step_is_old, session};
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = step->width;
    desc.height = step->height;
    desc.samples = step->samples;
    desc.camera = &session->drawn_camera;
    desc.monitor = &monitor;
    GlintError error = {0};
    GlintStatus status = GLINT_ERROR_MEMORY;
    snprintf(error.message, sizeof error.message, "%s", glint_status_text(status));
    session->step_began = cli_clock();
    session->share = 0;
    if (reserve(&session->pixels, 3 * (size_t)step->width * (size_t)step->height)) {
        status = cli_view_render(
            session->scene, &desc, session->drawn_view, session->pixels.data, &error);
    }
    double taken = cli_clock() - session->step_began;
    if (status == GLINT_OK) {
        cli_schedule_measure(&session->schedule, step, taken, 1);
        publish(session);
    } else if (status == GLINT_CANCELLED) {
        /* If it was for a scene that turns out to be wrong, or for a question, this one goes on. */
        cli_schedule_measure(&session->schedule, step, taken, session->share);
        session->again = true;
    } else {
        publish_failure(session, &error);
    }
}

/* ---------------------------------------------------------------- the threads */

static bool has_work(const CliSession *session) {
    if (session->scene == NULL || atomic_load(&session->askers) > 0) return false;
    return session->again || !session->schedule.ended || atomic_load(&session->redraw);
}

static void *draw_on(void *user) {
    CliSession *session = user;
    for (;;) {
        pthread_mutex_lock(&session->lock);
        while (
            !atomic_load(&session->quit) && !atomic_load(&session->reload) && !has_work(session)) {
            pthread_cond_wait(&session->requested, &session->lock);
        }
        bool quits = atomic_load(&session->quit), loads = atomic_exchange(&session->reload, false);
        session->drawing = !quits;
        pthread_mutex_unlock(&session->lock);
        if (quits) return NULL;
        if (loads) load(session);
        if (session->scene != NULL && !load_is_old(session)) draw(session);
        pthread_mutex_lock(&session->lock);
        session->drawing = false;
        pthread_cond_broadcast(&session->answered);
        pthread_mutex_unlock(&session->lock);
    }
}

static void *watch_on(void *user) {
    CliSession *session = user;
    while (cli_file_watch_wait(session->files)) {
        pthread_mutex_lock(&session->lock);
        session->noticed = cli_clock();
        atomic_store(&session->reload, true);
        pthread_cond_signal(&session->requested);
        pthread_mutex_unlock(&session->lock);
    }
    return NULL;
}

/* Signals are the business of the thread that shows the picture. */
static bool start_threads(CliSession *session) {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    session->has_drawer = pthread_create(&session->drawer, NULL, draw_on, session) == 0;
    session->has_watcher =
        session->has_drawer && pthread_create(&session->watcher, NULL, watch_on, session) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return session->has_watcher;
}

CliSession *cli_session_create(const CliSessionDesc *desc, char *message, size_t size) {
    CliSession *session = calloc(1, sizeof *session);
    snprintf(message, size, "%s", glint_status_text(GLINT_ERROR_MEMORY));
    if (session == NULL) return NULL;
    session->desc = *desc;
    pthread_mutex_init(&session->lock, NULL);
    pthread_mutex_init(&session->scene_lock, NULL);
    pthread_cond_init(&session->requested, NULL);
    pthread_cond_init(&session->answered, NULL);
    session->schedule.ended = true;
    session->changed = session->noticed = cli_clock();
    atomic_init(&session->reload, true);
    session->path = strdup(desc->path);
    session->files = cli_file_watch_create(desc->poll_only);
    bool good = session->path != NULL && session->files != NULL;
    if (good && !cli_file_watch_set(session->files, &desc->path, 1, cli_file_watch_now())) {
        good = false;
    }
    if (good && !start_threads(session)) {
        snprintf(message, size, "%s", glint_status_text(GLINT_ERROR_THREAD));
        good = false;
    }
    if (good) return session;
    cli_session_destroy(session);
    return NULL;
}

void cli_session_destroy(CliSession *session) {
    if (session == NULL) return;
    pthread_mutex_lock(&session->lock);
    atomic_store(&session->quit, true);
    pthread_cond_signal(&session->requested);
    pthread_mutex_unlock(&session->lock);
    if (session->has_watcher) {
        cli_file_watch_wake(session->files);
        pthread_join(session->watcher, NULL);
    }
    if (session->has_drawer) pthread_join(session->drawer, NULL);
    glint_scene_destroy(session->scene);
    cli_file_watch_destroy(session->files);
    cli_bytes_reset(&session->text);
    cli_frame_reset(&session->frame);
    free(session->pixels.data);
    free(session->path);
    pthread_cond_destroy(&session->requested);
    pthread_cond_destroy(&session->answered);
    pthread_mutex_destroy(&session->scene_lock);
    pthread_mutex_destroy(&session->lock);
    free(session);
}

/* ---------------------------------------------------------------- results */

bool cli_session_take(CliSession *session, CliFrame *frame) {
    pthread_mutex_lock(&session->lock);
    bool taken = session->frame.number != frame->number;
    if (taken) {
        CliBytes findings = frame->findings;
        Pixels own = {frame->pixels, frame->pixel_capacity};
        Pixels offered = {session->frame.pixels, session->frame.pixel_capacity};
        cli_bytes_clear(&findings);
        cli_bytes_add(
            &findings, cli_bytes_text(&session->frame.findings), session->frame.findings.size);
        *frame = session->frame;
        frame->findings = findings;
        Pixels kept = session->fresh ? offered : own, given = session->fresh ? own : offered;
        frame->pixels = kept.data;
        frame->pixel_capacity = kept.capacity;
        session->frame.pixels = given.data;
        session->frame.pixel_capacity = given.capacity;
        session->fresh = false;
    }
    pthread_mutex_unlock(&session->lock);
    return taken;
}

void cli_frame_reset(CliFrame *frame) {
    free(frame->pixels);
    cli_bytes_reset(&frame->findings);
    *frame = (CliFrame){0};
}

/* ---------------------------------------------------------------- requests */

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
    GlintSceneDesc desc = scene_desc(session, NULL);
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
