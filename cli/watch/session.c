/* SPDX-License-Identifier: MIT
 * The threads of a session: what they load and draw, and what they leave for others to take. */
#define _POSIX_C_SOURCE 200809L
#include "watch/session_state.h"

#include "progress.h"
#include "watch/camera.h"
#include "watch/save.h"
#include "watch/views.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A first look that takes longer is interrupted as well. */
static const double patience = 0.1;

enum { FINDINGS_LIMIT = 16384 };

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

GlintSceneDesc cli_session_scene_desc(const CliSession *session, CliBytes *findings) {
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
    GlintSceneDesc desc = cli_session_scene_desc(session, findings);
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

static bool reserve(CliPixels *pixels, size_t count) {
    if (count <= pixels->capacity) return true;
    float *data = realloc(pixels->data, count * sizeof *data);
    if (data == NULL) return false;
    *pixels = (CliPixels){data, count};
    return true;
}

static void publish(CliSession *session) {
    const CliStep *step = &session->step;
    pthread_mutex_lock(&session->lock);
    CliFrame *frame = &session->frame;
    CliPixels old = {frame->pixels, frame->pixel_capacity};
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
        bool asked = atomic_load(&session->askers) > 0;
        if (session->scene != NULL && !asked && !load_is_old(session)) draw(session);
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
        CliPixels own = {frame->pixels, frame->pixel_capacity};
        CliPixels offered = {session->frame.pixels, session->frame.pixel_capacity};
        cli_bytes_clear(&findings);
        cli_bytes_add(
            &findings, cli_bytes_text(&session->frame.findings), session->frame.findings.size);
        *frame = session->frame;
        frame->findings = findings;
        CliPixels kept = session->fresh ? offered : own, given = session->fresh ? own : offered;
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
