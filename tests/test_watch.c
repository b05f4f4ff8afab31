/* SPDX-License-Identifier: MIT
 * Watching a scene without showing it: which saves are noticed and how soon, what is drawn after
 * them, what stays when a scene has errors. */
#define _POSIX_C_SOURCE 200809L
#include "scenes.h"
#include "test.h"

#include "progress.h"
#include "watch/camera.h"
#include "watch/files.h"
#include "watch/save.h"
#include "watch/schedule.h"
#include "watch/session.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A path in a folder of its own. */
static const char *in_folder(const char *name) {
    static char paths[4][600], folder[500];
    static int next;
    snprintf(folder, sizeof folder, "%s/watch", test_scratch_dir());
    mkdir(folder, 0777);
    char *path = paths[next++ % 4];
    snprintf(path, 600, "%s/%s", folder, name);
    return path;
}

static void write_text(const char *name, const char *text) {
    FILE *file = fopen(in_folder(name), "wb");
    CHECK(file != NULL && fputs(text, file) >= 0 && fclose(file) == 0);
}

/* As most editors save: under another name, then renamed. */
static void write_and_rename(const char *name, const char *text) {
    char other[600];
    write_text("new", text);
    snprintf(other, sizeof other, "%s", in_folder("new"));
    CHECK_INT(rename(other, in_folder(name)), 0);
}

static void rest(double seconds) {
    struct timespec pause = {(time_t)seconds, (long)(1e9 * (seconds - floor(seconds)))};
    nanosleep(&pause, NULL);
}

/* ---------------------------------------------------------------- files */

/* A thread that counts what cli_file_watch_wait tells. */
typedef struct Waiter {
    CliFileWatch *watch;
    pthread_t thread;
    pthread_mutex_t lock;
    int count;
    double last;
} Waiter;

static void *wait_on(void *user) {
    Waiter *waiter = user;
    while (cli_file_watch_wait(waiter->watch)) {
        pthread_mutex_lock(&waiter->lock);
        waiter->count++;
        waiter->last = cli_clock();
        pthread_mutex_unlock(&waiter->lock);
    }
    return NULL;
}

static int count_of(Waiter *waiter) {
    pthread_mutex_lock(&waiter->lock);
    int count = waiter->count;
    pthread_mutex_unlock(&waiter->lock);
    return count;
}

static void begin_waiter(Waiter *waiter, bool poll_only) {
    *waiter = (Waiter){.watch = cli_file_watch_create(poll_only)};
    pthread_mutex_init(&waiter->lock, NULL);
    const char *paths[] = {in_folder("a"), in_folder("missing")};
    CHECK(cli_file_watch_set(waiter->watch, paths, 2, cli_file_watch_now()));
    CHECK_INT(pthread_create(&waiter->thread, NULL, wait_on, waiter), 0);
}

static void end_waiter(Waiter *waiter) {
    cli_file_watch_wake(waiter->watch);
    pthread_join(waiter->thread, NULL);
    cli_file_watch_destroy(waiter->watch);
    pthread_mutex_destroy(&waiter->lock);
}

/* Whether one more save is noticed, and no second one after it. */
static void expect_one(Waiter *waiter, int before, const char *what) {
    for (int i = 0; i < 500 && count_of(waiter) == before; i++) rest(0.01);
    rest(0.15);
    if (count_of(waiter) != before + 1) {
        test_fail(__FILE__, __LINE__, "%s: noticed %d times", what, count_of(waiter) - before);
    }
}

static void notice_saves(bool poll_only) {
    Waiter waiter;
    write_text("a", "1");
    unlink(in_folder("missing"));
    rest(0.05); /* no file has just been written */
    begin_waiter(&waiter, poll_only);
    int before = count_of(&waiter);
    write_text("a", "22");
    expect_one(&waiter, before, "written in place");
    before = count_of(&waiter);
    write_and_rename("a", "333");
    expect_one(&waiter, before, "renamed over");
    before = count_of(&waiter);
    unlink(in_folder("a"));
    rest(0.03);
    write_text("a", "4444");
    expect_one(&waiter, before, "removed and written");
    before = count_of(&waiter);
    write_text("missing", "here");
    expect_one(&waiter, before, "a file that was not there");
    before = count_of(&waiter);
    write_text("other", "of no interest");
    rest(0.3);
    CHECK_INT(count_of(&waiter), before);
    end_waiter(&waiter);
}

static void saves(void) { notice_saves(false); }
static void saves_by_looking(void) { notice_saves(true); }

/* The same size at the same time is a save as well, where the system says so. */
static void saves_in_a_row(void) {
    Waiter waiter;
    write_text("a", "1");
    rest(0.05);
    begin_waiter(&waiter, false);
    struct stat info;
    CHECK_INT(stat(in_folder("a"), &info), 0);
    int before = count_of(&waiter);
    FILE *file = fopen(in_folder("a"), "r+b");
    struct timespec times[2] = {info.st_atim, info.st_mtim};
    CHECK(file != NULL && fputs("2", file) >= 0 && fflush(file) == 0);
    if (file != NULL) {
        CHECK_INT(futimens(fileno(file), times), 0);
        fclose(file);
    }
    expect_one(&waiter, before, "same size, same time");
    end_waiter(&waiter);
}

/* A file that is written slowly is noticed when it is whole. */
static void slow_save(void) {
    Waiter waiter;
    write_text("a", "1");
    rest(0.05);
    begin_waiter(&waiter, false);
    int before = count_of(&waiter);
    FILE *file = fopen(in_folder("a"), "wb");
    CHECK(file != NULL);
    for (int i = 0; file != NULL && i < 20; i++) {
        fputs("some text\n", file);
        fflush(file);
        rest(0.005);
    }
    if (file != NULL) fclose(file);
    double closed = cli_clock();
    expect_one(&waiter, before, "written slowly");
    CHECK(waiter.last >= closed);
    end_waiter(&waiter);
}

/* ---------------------------------------------------------------- the schedule */

static void coarse_to_fine(void) {
    CliSchedule schedule = {.ended = true};
    CliStep step;
    /* Nothing is known: something small, and then, as it was quick, all. */
    cli_schedule_begin(&schedule, 800, 450, 9);
    CHECK(cli_schedule_next(&schedule, &step) && step.first && !step.last);
    CHECK(step.width < 300 && step.height < 200 && step.samples == 1);
    cli_schedule_measure(&schedule, &step, 1e-8 * step.width * step.height, 1);
    CHECK(cli_schedule_next(&schedule, &step) && !step.first && step.last);
    CHECK(step.width == 800 && step.height == 450 && step.samples == 9);
    CHECK(!cli_schedule_next(&schedule, &step));
    /* Known to be quick: all at once. */
    cli_schedule_begin(&schedule, 800, 450, 9);
    CHECK(cli_schedule_next(&schedule, &step) && step.first && step.last);
    /* Slow: each step costs more than the one before, and they lead to the end. */
    schedule.cost = 1e-5;
    cli_schedule_begin(&schedule, 801, 451, 400);
    double before = 0, total = 0, work = 0;
    int count = 0;
    while (cli_schedule_next(&schedule, &step)) {
        work = (double)step.width * step.height * step.samples;
        CHECK(work > 1.9 * before && work < 20 * (before + 1e4));
        total += work;
        before = work;
        CHECK_INT(step.first, count++ == 0);
    }
    CHECK(step.last && step.width == 801 && step.height == 451 && step.samples == 400);
    CHECK(count > 4 && total < 1.5 * work);
    /* A number of samples that is no square stays what it is. */
    schedule.cost = 1e-12;
    cli_schedule_begin(&schedule, 1, 1, 8);
    CHECK(cli_schedule_next(&schedule, &step) && step.last && step.samples == 8);
}

/* ---------------------------------------------------------------- sessions */

static const char good_scene[] =
    "<scene dialect='glint'><image>120 80</image>\n"
    "  <camera type='PerspectiveCamera'>\n    <viewPoint>0 0 4</viewPoint>\n  </camera>\n"
    "  <light><position>4 5 6</position></light>\n"
    "  <surface name='ball' type='Sphere'>%s</surface></scene>\n";

static void write_scene(const char *name, const char *inside) {
    char text[2000];
    snprintf(text, sizeof text, good_scene, inside);
    write_text(name, text);
}

/* A session, and a frame that is taken whenever there is a new one. */
typedef struct Show {
    CliSession *session;
    CliFrame frame;
    char path[600];
} Show;

/* Draws itself, which is allowed while nothing else is drawn. */
static void explain(GlintScene *scene, const GlintRenderDesc *desc, const char *name, int x, int y,
    CliBytes *text) {
    (void)name;
    GlintRenderDesc pixel = *desc;
    float color[3];
    pixel.crop_x = x;
    pixel.crop_y = y;
    pixel.crop_width = pixel.crop_height = 1;
    pixel.samples = 1;
    CHECK_INT(glint_render(scene, &pixel, color, NULL), GLINT_OK);
    cli_bytes_add_text(text, "asked");
}

static void begin_show(Show *show, const char *name) {
    *show = (Show){0};
    snprintf(show->path, sizeof show->path, "%s", in_folder(name));
    CliSessionDesc desc = {.path = show->path, .thread_count = 2, .explain = explain};
    rest(0.02); /* no file is so new that it may have changed after it was read */
    char message[256];
    show->session = cli_session_create(&desc, message, sizeof message);
    CHECK(show->session != NULL);
}

static void end_show(Show *show) {
    cli_session_destroy(show->session);
    cli_frame_reset(&show->frame);
}

/* Waits for so many loads, and what comes of the last. */
static bool wait_for_load(Show *show, uint64_t loads) {
    for (int i = 0; i < 15000; i++) {
        cli_session_take(show->session, &show->frame);
        const CliFrame *frame = &show->frame;
        bool done = frame->broken || (frame->finished && frame->drawn > frame->saved);
        if (frame->loads >= loads && done) return true;
        rest(0.002);
    }
    test_fail(__FILE__, __LINE__, "no picture after load %d", (int)loads);
    return false;
}

static bool wait_for_camera(Show *show, const GlintCameraDesc *camera) {
    for (int i = 0; i < 15000; i++) {
        cli_session_take(show->session, &show->frame);
        if (show->frame.finished && cli_camera_equal(&show->frame.camera, camera)) return true;
        rest(0.002);
    }
    test_fail(__FILE__, __LINE__, "no picture with the camera");
    return false;
}

/* What is shown at last is what the library draws of the file. */
static void expect_picture(const Show *show) {
    GlintScene *scene = scene_from_file(show->path, NULL, 2);
    Picture picture = picture_of_scene(scene, NULL);
    size_t size = 3 * sizeof(float) * (size_t)picture.width * (size_t)picture.height;
    CHECK(show->frame.finished && show->frame.width == picture.width);
    CHECK(show->frame.pixels != NULL && memcmp(show->frame.pixels, picture.pixels, size) == 0);
    picture_free(&picture);
    glint_scene_destroy(scene);
}

static void draws_what_is_saved(void) {
    Show show;
    write_scene("scene.xml", "");
    begin_show(&show, "scene.xml");
    CHECK(wait_for_load(&show, 1));
    CHECK(!show.frame.broken && show.frame.findings.size == 0);
    expect_picture(&show);
    write_scene("scene.xml", "<radius>0.5</radius>");
    CHECK(wait_for_load(&show, 2));
    expect_picture(&show);
    end_show(&show);
}

/* A file that the scene names counts like the scene, also when it is missing at first. */
static void draws_what_is_named(void) {
    Show show;
    unlink(in_folder("named-by-a-scene.obj"));
    write_text("named.xml",
        "<scene dialect='glint'><image>60 40</image>"
        "<camera><viewPoint>0.3 0.3 2</viewPoint></camera>"
        "<light type='ConstantLight'/>"
        "<surface type='Mesh'><data>named-by-a-scene.obj</data></surface></scene>");
    begin_show(&show, "named.xml");
    CHECK(wait_for_load(&show, 1));
    CHECK(show.frame.broken && show.frame.pixels == NULL);
    CHECK(strstr(cli_bytes_text(&show.frame.findings), "there is no file `named-by-a-scene.obj`") !=
          NULL);
    write_text("named-by-a-scene.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK(wait_for_load(&show, 2));
    CHECK(!show.frame.broken && show.frame.findings.size == 0);
    expect_picture(&show);
    write_and_rename("named-by-a-scene.obj", "v 0 0 0\nv 1 0 0\nv 0 0.5 0\nf 1 2 3\n");
    CHECK(wait_for_load(&show, 3));
    expect_picture(&show);
    end_show(&show);
}

/* Errors are told with place and excerpt, and the picture stays. */
static void errors_stay_beside(void) {
    Show show;
    write_scene("errors.xml", "");
    begin_show(&show, "errors.xml");
    CHECK(wait_for_load(&show, 1));
    size_t size = 3 * sizeof(float) * 120 * 80;
    float *before = malloc(size);
    if (before == NULL) return;
    memcpy(before, show.frame.pixels, size);
    write_scene("errors.xml", "<raduis>2</raduis>");
    CHECK(wait_for_load(&show, 2));
    CHECK(show.frame.broken && show.frame.finished);
    CHECK(memcmp(before, show.frame.pixels, size) == 0);
    const char *text = cli_bytes_text(&show.frame.findings);
    CHECK(strstr(text, "errors.xml:6:38: error: unknown element `raduis`") != NULL);
    CHECK(strstr(text, "\n  <surface name='ball'") != NULL && strstr(text, "^~~~~~~") != NULL);
    /* The good scene can still be looked at from elsewhere. */
    GlintCameraDesc camera;
    double distance;
    CHECK(cli_session_camera(show.session, &camera, &distance));
    CHECK_NEAR(distance, 3, 1e-12);
    cli_camera_orbit(&camera, distance, 30, 10);
    cli_session_set_camera(show.session, &camera);
    CHECK(wait_for_camera(&show, &camera) && show.frame.broken);
    unlink(show.path);
    CHECK(wait_for_load(&show, 3) && show.frame.broken);
    text = cli_bytes_text(&show.frame.findings);
    CHECK(strstr(text, "errors.xml: error: No such file or directory") != NULL);
    write_scene("errors.xml", "");
    CHECK(wait_for_load(&show, 4));
    CHECK(!show.frame.broken && show.frame.findings.size == 0);
    free(before);
    end_show(&show);
}

/* A moved camera survives a save, unless the file has another camera than before. */
static void camera_over_saves(void) {
    Show show;
    write_scene("camera.xml", "");
    begin_show(&show, "camera.xml");
    CHECK(wait_for_load(&show, 1));
    GlintCameraDesc camera, now;
    double distance;
    CHECK(cli_session_camera(show.session, &camera, &distance));
    cli_camera_zoom(&camera, distance, 0.5);
    cli_session_set_camera(show.session, &camera);
    CHECK(wait_for_camera(&show, &camera));
    write_scene("camera.xml", "<radius>0.7</radius>");
    CHECK(wait_for_load(&show, 2));
    CHECK(cli_session_camera(show.session, &now, &distance) && cli_camera_equal(&now, &camera));
    write_text("camera.xml",
        "<scene dialect='glint'><image>120 80</image>"
        "<camera><viewPoint>0 0 5</viewPoint></camera><surface type='Sphere'/></scene>");
    CHECK(wait_for_load(&show, 3));
    CHECK(cli_session_camera(show.session, &now, &distance) && now.view_point[2] == 5);
    cli_session_set_camera(show.session, &camera);
    CHECK(wait_for_camera(&show, &camera));
    cli_session_reset_camera(show.session);
    CHECK(wait_for_camera(&show, &now));
    end_show(&show);
}

/* The camera goes into the file, and the picture of the file is then the one that was shown. */
static void camera_into_file(void) {
    Show show;
    char message[512];
    write_scene("written.xml", "");
    begin_show(&show, "written.xml");
    CHECK(wait_for_load(&show, 1));
    CHECK(!cli_session_save_camera(show.session, message, sizeof message));
    CHECK_TEXT(message, "the camera is the one of the file");
    GlintCameraDesc camera;
    double distance;
    CHECK(cli_session_camera(show.session, &camera, &distance));
    cli_camera_orbit(&camera, distance, 33, 12);
    cli_session_set_camera(show.session, &camera);
    CHECK(wait_for_camera(&show, &camera));
    chmod(show.path, 0640);
    CHECK(cli_session_save_camera(show.session, message, sizeof message));
    CHECK(strncmp(message, "camera written to ", 18) == 0);
    struct stat info;
    CHECK(stat(show.path, &info) == 0 && (info.st_mode & 0777) == 0640);
    CHECK(wait_for_load(&show, 2));
    CHECK(cli_camera_equal(&show.frame.camera, &camera));
    expect_picture(&show);
    /* When another has changed the file it is left alone. */
    cli_camera_zoom(&camera, distance, 0.8);
    cli_session_set_camera(show.session, &camera);
    write_scene("written.xml", "<oh dear");
    unlink(in_folder("written.camera.xml"));
    CHECK(cli_session_save_camera(show.session, message, sizeof message));
    CHECK(strstr(message, "written.camera.xml") != NULL);
    CHECK(cli_session_save_camera(show.session, message, sizeof message));
    CHECK(strstr(message, "written.camera-2.xml") != NULL);
    GlintScene *scene = scene_from_file(in_folder("written.camera.xml"), NULL, 2);
    GlintCameraDesc copied;
    CHECK(
        scene != NULL && glint_scene_camera(scene, &copied) && cli_camera_equal(&copied, &camera));
    glint_scene_destroy(scene);
    CliBytes text = {0};
    CHECK(cli_file_read(show.path, &text) && strstr(cli_bytes_text(&text), "<oh dear") != NULL);
    cli_bytes_reset(&text);
    end_show(&show);
}

static void picked(void) {
    Show show;
    CliBytes text = {0};
    write_scene("picked.xml", "");
    begin_show(&show, "picked.xml");
    CHECK(wait_for_load(&show, 1));
    cli_session_pick(show.session, &show.frame, 60.5 / 120, 40.5 / 80, &text);
    const char *said = cli_bytes_text(&text);
    CHECK(strncmp(said, "pixel 60,40\n", 12) == 0);
    CHECK(
        strstr(said, "surface   1 \"ball\", ") != NULL && strstr(said, "picked.xml:6:3\n") != NULL);
    CHECK(strstr(said, "distance  3.00") != NULL);
    cli_bytes_clear(&text);
    cli_session_pick(show.session, &show.frame, 0, 0.9999, &text);
    CHECK_TEXT(cli_bytes_text(&text),
        "pixel 0,79\n  colour    0 0 0, as bytes 0 0 0\n  surface   none: the background\nasked");
    cli_bytes_reset(&text);
    end_show(&show);
}

/* A camera that is moved while a long picture is under way is drawn at once. */
static void interrupted(void) {
    Show show;
    write_text("long.xml",
        "<scene dialect='glint'><image>640 480</image><samples>10000</samples>"
        "<camera><viewPoint>0 0 4</viewPoint></camera><light><position>4 5 6</position></light>"
        "<surface type='Sphere'/></scene>");
    begin_show(&show, "long.xml");
    for (int i = 0; i < 3000 && show.frame.pixels == NULL; i++) {
        rest(0.002);
        cli_session_take(show.session, &show.frame);
    }
    CHECK(show.frame.pixels != NULL && !show.frame.finished);
    GlintCameraDesc camera;
    double distance, least = INFINITY;
    CHECK(cli_session_camera(show.session, &camera, &distance));
    for (int turn = 0; turn < 5; turn++) {
        cli_camera_orbit(&camera, distance, 5, 0);
        double asked = cli_clock();
        cli_session_set_camera(show.session, &camera);
        for (int i = 0; i < 10000; i++) {
            cli_session_take(show.session, &show.frame);
            if (cli_camera_equal(&show.frame.camera, &camera)) break;
            rest(0.001);
        }
        CHECK(cli_camera_equal(&show.frame.camera, &camera));
        least = fmin(least, cli_clock() - asked);
    }
    CHECK(least < 0.2 * test_slowness());
    /* A question interrupts as well, and what was interrupted goes on. */
    CliBytes text = {0};
    int samples = show.frame.samples;
    cli_session_pick(show.session, &show.frame, 0.5, 0.5, &text);
    CHECK(strstr(cli_bytes_text(&text), "asked") != NULL);
    cli_bytes_reset(&text);
    for (int i = 0; i < 10000 && show.frame.samples <= samples; i++) {
        cli_session_take(show.session, &show.frame);
        rest(0.001);
    }
    CHECK(show.frame.samples > samples);
    double ended = cli_clock();
    end_show(&show);
    CHECK(cli_clock() - ended < 2 * test_slowness());
}

/* From the moment a file is renamed into place to the moment its finished picture can be taken: the
 * least of several, since other programs run as well. */
static void soon_after_a_save(void) {
    Show show;
    write_scene("soon.xml", "");
    begin_show(&show, "soon.xml");
    CHECK(wait_for_load(&show, 1));
    double least = INFINITY;
    for (int i = 0; i < 10; i++) {
        char text[2000], inside[64];
        snprintf(inside, sizeof inside, "<radius>0.%d</radius>", 10 + i);
        snprintf(text, sizeof text, good_scene, inside);
        uint64_t loads = show.frame.loads;
        rest(0.02);
        double saved = cli_clock();
        write_and_rename("soon.xml", text);
        CHECK(wait_for_load(&show, loads + 1));
        least = fmin(least, show.frame.drawn - saved);
    }
    if (!(least < 0.1 * test_slowness())) {
        test_fail(__FILE__, __LINE__, "%.1f ms from a save to its picture", 1e3 * least);
    }
    printf("  %.1f ms from a save to its picture\n", 1e3 * least);
    end_show(&show);
}

const GiTest tests_watch[] = {TEST(saves), TEST(saves_by_looking), TEST(saves_in_a_row),
    TEST(slow_save), TEST(coarse_to_fine), TEST(draws_what_is_saved), TEST(draws_what_is_named),
    TEST(errors_stay_beside), TEST(camera_over_saves), TEST(camera_into_file), TEST(picked),
    TEST(interrupted), TEST(soon_after_a_save), TEST_END};
