/* SPDX-License-Identifier: MIT
 * Turning a camera by hand, and writing it into the text of a scene. */
#include "scenes.h"
#include "test.h"

#include "watch/camera.h"
#include "watch/camera_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static GlintCameraDesc some_camera(GlintCameraType type) {
    GlintCameraDesc camera = glint_camera_desc_default();
    camera.type = type;
    for (int i = 0; i < 3; i++) {
        camera.view_point[i] = 5 - i;
        camera.view_direction[i] = i - 5;
    }
    camera.projection_distance = 2;
    return camera;
}

static double distance_between(const double a[3], const double b[3]) {
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

/* What the middle of the picture shows at a distance. */
static void middle(const GlintCameraDesc *camera, double distance, double point[3]) {
    GlintRay ray;
    CHECK_INT(glint_camera_ray(camera, 0.5, 0.5, &ray, NULL), GLINT_OK);
    for (int i = 0; i < 3; i++) point[i] = ray.origin[i] + distance * ray.direction[i];
}

/* ---------------------------------------------------------------- movements */

static void orbits(void) {
    for (int type = 0; type < 2; type++) {
        GlintCameraDesc camera = some_camera((GlintCameraType)type), before = camera;
        double pivot[3], now[3];
        middle(&camera, 6, pivot);
        cli_camera_orbit(&camera, 6, 40, 0);
        middle(&camera, 6, now);
        CHECK_NEAR(distance_between(pivot, now), 0, 1e-4);
        CHECK_NEAR(camera.view_point[1], before.view_point[1], 1e-5); /* as high as before */
        cli_camera_orbit(&camera, 6, 0, 20);
        middle(&camera, 6, now);
        CHECK_NEAR(distance_between(pivot, now), 0, 1e-4);
        CHECK(camera.view_point[1] > before.view_point[1] + 1);
        /* All the way round and back leads to where it was. */
        cli_camera_orbit(&camera, 6, -40, 0);
        cli_camera_orbit(&camera, 6, 0, -20);
        CHECK_NEAR(distance_between(camera.view_point, before.view_point), 0, 1e-4);
        CHECK(camera.view_up[1] == 1);
    }
    /* To the right is where the right of the picture is. */
    GlintCameraDesc camera = glint_camera_desc_default();
    camera.view_point[2] = 4;
    cli_camera_orbit(&camera, 4, 90, 0);
    CHECK_NEAR(camera.view_point[0], 4, 1e-5);
    CHECK_NEAR(camera.view_direction[0], -1, 1e-5);
}

/* It stops short of where what is up is in front, and stays a good camera. */
static void poles(void) {
    GlintCameraDesc camera = some_camera(GLINT_CAMERA_PERSPECTIVE);
    GlintRay ray;
    for (int i = 0; i < 40; i++) {
        cli_camera_orbit(&camera, 7, 3, 10);
        CHECK_INT(glint_camera_ray(&camera, 0, 0, &ray, NULL), GLINT_OK);
    }
    double high =
        camera.view_direction[1] / distance_between(camera.view_direction, (double[3]){0});
    CHECK(high < -0.99 && high > -1);
    for (int i = 0; i < 40; i++) cli_camera_orbit(&camera, 7, 3, -10);
    high = camera.view_direction[1] / distance_between(camera.view_direction, (double[3]){0});
    CHECK(high > 0.99 && high < 1);
}

/* A window that is tilted stays as tilted; one that is given as straight stays straight. */
static void normals(void) {
    GlintCameraDesc camera = some_camera(GLINT_CAMERA_PERSPECTIVE);
    camera.projection_normal[0] = 0.3;
    camera.projection_normal[2] = 1;
    double before = 0, after = 0;
    for (int i = 0; i < 3; i++) before += camera.projection_normal[i] * camera.view_direction[i];
    cli_camera_orbit(&camera, 5, 50, 10);
    for (int i = 0; i < 3; i++) after += camera.projection_normal[i] * camera.view_direction[i];
    CHECK_NEAR(after, before, 1e-5);
    camera = some_camera(GLINT_CAMERA_PERSPECTIVE);
    for (int i = 0; i < 3; i++) camera.projection_normal[i] = -2 * camera.view_direction[i];
    cli_camera_orbit(&camera, 5, 50, 10);
    for (int i = 0; i < 3; i++) {
        CHECK(camera.projection_normal[i] == -camera.view_direction[i]);
    }
}

static void pans_and_zooms(void) {
    GlintCameraDesc camera = glint_camera_desc_default();
    camera.view_point[2] = 4;
    cli_camera_pan(&camera, 4, 0.25, 0.5);
    /* What is in the middle at distance 4 is then a quarter to the right, half a picture down. */
    CHECK_NEAR(camera.view_point[0], -1, 1e-6);
    CHECK_NEAR(camera.view_point[1], 2, 1e-6);
    cli_camera_zoom(&camera, 4, 0.5);
    CHECK_NEAR(camera.view_point[2], 2, 1e-6);
    CHECK(camera.view_width == 1);
    camera = glint_camera_desc_default();
    camera.type = GLINT_CAMERA_PARALLEL;
    camera.view_width = 6;
    cli_camera_pan(&camera, 4, 0.5, 0);
    CHECK_NEAR(camera.view_point[0], -3, 1e-6);
    cli_camera_zoom(&camera, 4, 0.5);
    CHECK(camera.view_width == 3 && camera.view_height == 0.5 && camera.view_point[2] == 0);
}

/* What can be read in a file is drawn: no number needs more than eight digits or so. */
static void short_numbers(void) {
    GlintCameraDesc camera = some_camera(GLINT_CAMERA_PERSPECTIVE);
    char text[CLI_CAMERA_NUMBER_SIZE];
    for (int i = 0; i < 50; i++) {
        cli_camera_orbit(&camera, 7, 7.3, i % 2 == 0 ? 3.1 : -2.9);
        cli_camera_zoom(&camera, 7, i % 2 == 0 ? 0.9 : 1.1);
        for (int k = 0; k < 3; k++) {
            cli_camera_number(camera.view_point[k], text);
            CHECK(strlen(text) <= 11 && strtod(text, NULL) == camera.view_point[k]);
            cli_camera_number(camera.view_direction[k], text);
            CHECK(strlen(text) <= 11 && strtod(text, NULL) == camera.view_direction[k]);
        }
    }
    static const struct {
        double value;
        const char *text;
    } numbers[] = {{0, "0"}, {12, "12"}, {0.1, "0.1"}, {-3.25, "-3.25"}, {1200, "1200"},
        {1e-7, "1e-07"}, {1e60, "1e+60"}, {0.00015, "0.00015"}, {1.0 / 3, "0.3333333333333333"}};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        cli_camera_number(numbers[i].value, text);
        CHECK_TEXT(text, numbers[i].text);
    }
}

/* ---------------------------------------------------------------- text */

/* Moves the camera of a text and compares. The camera's start tag stands where `<camera` does for
 * the first time. */
static bool move_camera(const char *text, CliBytes *result, char reason[160]) {
    const char *tag = strstr(text, "<camera");
    CliCameraText place = {text, strlen(text), 1, 1};
    for (const char *c = text; c < tag; c++) {
        bool pair = c[0] == '\r' && c[1] == '\n';
        if (*c == '\n' || (*c == '\r' && !pair)) {
            place.line++;
            place.column = 0;
        }
        if (((unsigned char)*c & 0xc0) != 0x80 && !pair) place.column++;
    }
    GlintCameraDesc before = glint_camera_desc_default(), after = before;
    before.view_point[2] = 4;
    after.view_point[0] = 1.5;
    after.view_width = 2;
    return cli_camera_text_replace(&place, &before, &after, result, reason, 160);
}

static void expect_text(const char *text, const char *expected) {
    CliBytes result = {0};
    char reason[160] = "";
    CHECK(move_camera(text, &result, reason));
    CHECK_TEXT(reason, "");
    CHECK_TEXT(cli_bytes_text(&result), expected);
    cli_bytes_reset(&result);
}

#define NEW "<viewPoint>1.5 0 0</viewPoint>"

static void texts(void) {
    /* All but the values stays as it is, to the byte. */
    expect_text("<scene>\r\n<!-- < > -->\r\n\t<camera type = 'P>' >\r\n\t\t<viewPoint>\r\n 0 0 4 "
                "</viewPoint>\r\n\t\t<!-- <viewWidth>7</viewWidth> --> <viewWidth >1</viewWidth >"
                "\r\n\t</camera>\r\n<surface  type='Sphere'/></scene>  ",
        "<scene>\r\n<!-- < > -->\r\n\t<camera type = 'P>' >\r\n\t\t<viewPoint>\r\n 1.5 0 0 "
        "</viewPoint>\r\n\t\t<!-- <viewWidth>7</viewWidth> --> <viewWidth >2</viewWidth >"
        "\r\n\t</camera>\r\n<surface  type='Sphere'/></scene>  ");
    /* What is missing comes behind the rest, indented like it. */
    expect_text("<scene>\n <camera>\n   <viewPoint>0 0 4</viewPoint>\n   <image>3 4</image>\n"
                " </camera>\n</scene>",
        "<scene>\n <camera>\n   " NEW "\n   <image>3 4</image>\n   <viewWidth>2</viewWidth>\n"
        " </camera>\n</scene>");
    expect_text("<scene><camera><viewPoint>0 0 4</viewPoint></camera></scene>",
        "<scene><camera>" NEW "<viewWidth>2</viewWidth></camera></scene>");
    expect_text("<scene>\n  <camera/>\n</scene>",
        "<scene>\n  <camera>\n    " NEW "\n    <viewWidth>2</viewWidth>\n  </camera>\n</scene>");
    expect_text("\xef\xbb\xbf<scene>\xc3\xa4<camera></camera></scene>",
        "\xef\xbb\xbf<scene>\xc3\xa4<camera>" NEW "<viewWidth>2</viewWidth></camera></scene>");
    /* The last of two counts; a value by reference becomes one of its own. */
    expect_text("<a><camera><viewPoint>9 9 9</viewPoint><viewPoint ref='p'/>"
                "<viewWidth ref='w'></viewWidth></camera></a>",
        "<a><camera><viewPoint>9 9 9</viewPoint>" NEW "<viewWidth>2</viewWidth></camera></a>");
    /* Values that are the same are not touched, whatever they look like. */
    expect_text("<a><camera><viewUp>0.0 1.00 0</viewUp><viewPoint>0 0 4</viewPoint>"
                "<viewWidth>1<!-- one --></viewWidth></camera></a>",
        "<a><camera><viewUp>0.0 1.00 0</viewUp>" NEW "<viewWidth>2</viewWidth></camera></a>");
}

static void refused_texts(void) {
    CliBytes result = {0};
    char reason[160] = "", name[16];
    CHECK(!move_camera(
        "<a><camera><viewPoint name='p'>0 0 4</viewPoint></camera></a>", &result, reason));
    CHECK_TEXT(reason, "viewPoint has a name, and what refers to it would change as well");
    cli_bytes_clear(&result);
    CHECK(!move_camera("<a><camera><viewPoint>0 0 4</viewPoint>", &result, reason));
    CHECK_TEXT(reason, "the camera is not found in the text of the scene");
    cli_bytes_reset(&result);
    static const char text[] = "<a>\n<camera ref=\"main\"/></a>";
    CliCameraText place = {text, sizeof text - 1, 2, 1};
    CHECK(cli_camera_text_ref(&place, name, sizeof name));
    CHECK_TEXT(name, "main");
    place.line = 1;
    CHECK(!cli_camera_text_ref(&place, name, sizeof name));
}

const GiTest tests_watch_camera[] = {TEST(orbits), TEST(poles), TEST(normals), TEST(pans_and_zooms),
    TEST(short_numbers), TEST(texts), TEST(refused_texts), TEST_END};
