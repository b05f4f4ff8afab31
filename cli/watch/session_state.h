/* SPDX-License-Identifier: MIT
 * What a session is, for its own files: session.c has its threads, session_ask.c what others ask.
 *
 * Who holds what: `lock` guards requests and results; `scene_lock` the good scene and its text
 * against being replaced while another thread asks them. The drawer alone replaces them, so it
 * reads them without. Where both are held, scene_lock comes first. */
#pragma once

#include "watch/files.h"
#include "watch/schedule.h"
#include "watch/session.h"

#include <pthread.h>
#include <stdatomic.h>

typedef struct CliPixels {
    float *data;
    size_t capacity; /* floats */
} CliPixels;

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
    CliPixels pixels;
};

/* The desc of a scene that is loaded as the session's are; what is found wrong goes to findings,
 * which may be null. */
GlintSceneDesc cli_session_scene_desc(const CliSession *session, CliBytes *findings);
