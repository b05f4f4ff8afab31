/* SPDX-License-Identifier: MIT
 * A scene that is being watched, without any way to show it. One thread of its own waits for the
 * files, another loads and draws; what has been drawn waits here until somebody takes it.
 *
 * At any moment there is at most one good scene, the last one that could be loaded. When a newer
 * one has errors, these are told and the good one stays, picture and camera and all. */
#pragma once

#include "watch/bytes.h"

typedef struct CliSession CliSession;

/* Appends lines about a pixel of a picture as it was drawn with desc. */
typedef void (*CliExplainFn)(
    GlintScene *scene, const GlintRenderDesc *desc, const char *name, int x, int y, CliBytes *text);

typedef struct CliSessionDesc {
    const char *path;
    GlintDialect dialect;
    int thread_count;           /* 0: one per core */
    const char *isa;            /* null: the fastest */
    int width, height, samples; /* 0: the scene's */
    CliExplainFn explain;       /* what cli_session_pick adds; null: nothing */
    bool poll_only;             /* files are looked at, see cli_file_watch_create */
    /* Called on a thread of the session's when there is something new to take. */
    void (*wake)(void *user);
    void *user;
} CliSessionDesc;

/* What there is to show. */
typedef struct CliFrame {
    uint64_t number;   /* another for whatever is new here; 0: nothing yet */
    float *pixels;     /* width * height * 3, linear; null: nothing has been drawn yet */
    int width, height; /* of what is drawn: smaller than the picture while it is coarse */
    int full_width, full_height, samples; /* of the picture; samples: so far */
    bool finished; /* the picture that `glint render` would make of the scene and camera */
    int view;      /* cli_view_name */
    GlintCameraDesc camera;
    CliBytes findings;     /* of the last load, as a compiler prints them; empty: none */
    bool broken;           /* the last load failed: the picture is of an earlier one */
    uint64_t loads;        /* how often the file has been read */
    double saved;          /* when the save was noticed that the last load is due to, in seconds of
                              cli_clock; 0: the first load */
    double drawn;          /* when the picture was ready */
    double seconds;        /* from the change (of file, camera or view) to this picture */
    size_t pixel_capacity; /* private */
} CliFrame;

/* Begins to watch. Null, with a sentence in message, when threads or memory are short. */
CliSession *cli_session_create(const CliSessionDesc *desc, char *message, size_t size);
/* Ends both threads, within a few tens of milliseconds. Null is allowed. */
void cli_session_destroy(CliSession *session);

/* Copies what is there into *frame (all zero at first) if its number is another. Whether it was. */
bool cli_session_take(CliSession *session, CliFrame *frame);
void cli_frame_reset(CliFrame *frame);

/* ---- from any thread but one at a time */

/* The camera in use, and how far away is what it shows in the middle (1 when that is nothing and
 * never was anything). False before there is a scene. */
bool cli_session_camera(CliSession *session, GlintCameraDesc *camera, double *distance);

/* Draws with this camera; a render that is under way is interrupted. */
void cli_session_set_camera(CliSession *session, const GlintCameraDesc *camera);

/* Back to the camera of the file. */
void cli_session_reset_camera(CliSession *session);

void cli_session_set_view(CliSession *session, int view);

/* Appends what there is to say about a place of the shown picture, from 0 to 1, from the top left.
 * A render that is under way waits meanwhile. */
void cli_session_pick(
    CliSession *session, const CliFrame *frame, double x, double y, CliBytes *text);

/* Writes the camera in use into the scene file (watch/save.h says how); message tells. */
bool cli_session_save_camera(CliSession *session, char *message, size_t size);
