/* SPDX-License-Identifier: MIT
 * The files that a scene names: where they are found, that each is loaded once, and what is said
 * when one is missing or broken. */
#define _XOPEN_SOURCE 700 /* nftw */
#include "test_reader_input.h"

#include "base/digest.h"
#include "glint/glint.h"

#include <errno.h>
#include <ftw.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static const char triangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/* A path in the scratch folder; a few at a time. */
static const char *in_scratch(const char *name) {
    static char paths[4][600];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, 600, "%s/files/%s", test_scratch_dir(), name);
    return path;
}

static void write_file(const char *name, const char *text, size_t size) {
    FILE *file = fopen(in_scratch(name), "wb");
    CHECK(file != NULL && fwrite(text, 1, size, file) == size && fclose(file) == 0);
}

static void make_folders(void) {
    static const char *const folders[] = {"", "a", "a/b", "a/meshes", "meshes"};
    for (size_t i = 0; i < sizeof folders / sizeof folders[0]; i++) {
        int made = mkdir(in_scratch(folders[i]), 0777);
        CHECK(made == 0 || errno == EEXIST);
    }
    write_file("a/b/near.obj", triangle, sizeof triangle - 1);
    write_file("meshes/far.obj", triangle, sizeof triangle - 1);
    write_file("broken.obj", "v 0 0 0\nf 1 2 3\n", 16);
    static const char white[] = "PF\n3 4\n-1\n";
    char map[sizeof white - 1 + 3 * 4 * 12] = {0};
    memcpy(map, white, sizeof white - 1);
    write_file("map.pfm", map, sizeof map);
}

/* Loads a scene that stands in a/b, from memory. */
static GiScene *load_here(const char *middle) {
    static char text[4000], name[600];
    snprintf(text, sizeof text, "%s%s%s", BEGIN, middle, END);
    snprintf(name, sizeof name, "%s", in_scratch("a/b/scene.xml"));
    load_input((Input){.head = text, .head_size = strlen(text), .name = name}, 0,
        GLINT_DIALECT_AUTO, NULL);
    return &loaded.scene;
}

static void expect_finding(const char *middle, const char *finding) {
    load_here(middle);
    CHECK_INT(loaded.status, GLINT_ERROR_SCENE);
    if (strstr(loaded.findings, finding) == NULL) {
        test_fail(__FILE__, __LINE__, "\"%s\" is not in:\n%s", finding, loaded.findings);
    }
    unload();
}

#define MESH(name) "<surface type='Mesh'><data>" name "</data></surface>"

static void places(void) {
    make_folders();
    GiScene *scene = load_here(MESH("near.obj") MESH("../../meshes/far.obj")
            MESH("../meshes/far.obj") MESH(" meshes/far.obj ") MESH("./near.obj"));
    CHECK_TEXT(loaded.findings, "");
    CHECK_INT(scene->mesh_surfaces.count, 5);
    CHECK_INT(scene->meshes.meshes.count, 2); /* by whatever path */
    CHECK_INT(scene->mesh_surfaces.data[4].mesh, 0);
    /* The scene and its files, each once, under the name by which it was first called. */
    CHECK_INT(scene->files.count, 3);
    static const struct {
        const char *name;
        GlintFileKind kind;
    } noted[] = {{"near.obj", GLINT_FILE_MESH}, {"../../meshes/far.obj", GLINT_FILE_MESH}};
    for (size_t i = 0; i < 2; i++) {
        const GiSceneFile *file = &scene->files.data[i + 1];
        CHECK_TEXT(scene->file_names.data + file->name, noted[i].name);
        CHECK_INT(file->kind, noted[i].kind);
        CHECK_INT(file->size, sizeof triangle - 1);
        CHECK(file->digest == gi_digest_plain(0, triangle, sizeof triangle - 1));
    }
    CHECK_INT(scene->files.data[0].kind, GLINT_FILE_SCENE);
    CHECK(scene->files.data[0].size > 100 && scene->files.data[0].digest != 0);
    unload();
    char text[1000];
    snprintf(text, sizeof text, MESH("%s"), in_scratch("meshes/far.obj"));
    CHECK_INT(load_here(text)->meshes.meshes.count, 1);
    unload();
    /* From a relative name of the scene one climbs to the root as well. */
    snprintf(text, sizeof text, BEGIN MESH("%s") END, in_scratch("meshes/far.obj") + 1);
    static const char *const names[] = {"scene.xml", "./scene.xml", "no/such/folder/scene.xml",
        "/scene.xml", "../scene.xml", "/a//b//scene.xml"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        load_input((Input){.head = text, .head_size = strlen(text), .name = names[i]}, 0,
            GLINT_DIALECT_AUTO, NULL);
        CHECK_TEXT(loaded.findings, "");
        CHECK_INT(loaded.scene.meshes.meshes.count, 1);
        unload();
    }
}

static void missing_and_broken(void) {
    make_folders();
    expect_finding(MESH("nowhere.msh"), "1:62: there is no file `nowhere.msh`: neither from ");
    expect_finding(MESH("naer.obj"), "there is no file `naer.obj`: did you mean `near.obj`?");
    expect_finding(MESH("../meshes/fat.obj"), "did you mean `far.obj`?");
    expect_finding(MESH("/nowhere/x.obj"), "there is no file `/nowhere/x.obj`\n");
    expect_finding(MESH("../b"), "there is no file `../b`");
    expect_finding(MESH("../../broken.obj"), "/../../broken.obj:2: ");
    expect_finding("<shader type='Phong'><texture type='ClampTexture'><image>near.obj</image>"
                   "</texture></shader>",
        "near.obj: ");
    expect_finding("<cubemap><filename>near.obj</filename></cubemap>", "1:54: ");
    /* A broken file is told of once, a missing one wherever it is named. */
    load_here(MESH("../../broken.obj") MESH("../../../files/broken.obj") MESH("../../broken.obj"));
    CHECK_INT(loaded.count, 1);
    unload();
    load_here(MESH("nowhere.msh") MESH("nowhere.msh"));
    CHECK_INT(loaded.count, 2);
    unload();
}

static void environments(void) {
    make_folders();
    GiScene *scene = load_here("<cubemap name='c'><filename>../../map.pfm</filename></cubemap>"
                               "<environment type='Cubemap'><scaleFactor>3</scaleFactor><filename>"
                               "map.pfm</filename></environment>");
    CHECK_TEXT(loaded.findings, "");
    CHECK_INT(scene->environment.face, 1);
    CHECK_NEAR(scene->environment.scale, 3, 0);
    unload();
    scene =
        load_here("<cubemap name='c'><scaleFactor>2</scaleFactor><filename>map.pfm</filename>"
                  "</cubemap><cubemap><filename>map.pfm</filename></cubemap><cubemap ref='c'/>");
    CHECK_TEXT(loaded.findings, "");
    CHECK_NEAR(scene->environment.scale, 2, 0);
    unload();
}

static void textures(void) {
    make_folders();
    static const float pixels[12] = {0};
    GlintImage image = {2, 2, pixels};
    GlintSaveDesc save = glint_save_desc_default();
    CHECK_INT(glint_image_save(&image, in_scratch("dots.png"), &save, NULL), GLINT_OK);
    GiScene *scene = load_here(
        "<texture name='t' type='RepeatTexture'><image>dots.png</image></texture>"
        "<shader name='s' type='Lambertian'><texture type='ClampTexture'><image>../dots.png"
        "</image></texture></shader><shader name='r' type='Phong'><texture ref='t'/></shader>");
    CHECK_TEXT(loaded.findings, "");
    CHECK_INT(scene->pictures.count, 1);
    CHECK_INT(scene->textures.count, 2);
    CHECK(scene->pictures.count == 1 && scene->pictures.data[0].width == 2);
    CHECK_INT(scene->shaders.data[1].texture, 1);
    CHECK_INT(scene->shaders.data[2].texture, 0);
    unload();
}

static void *failing_reallocate(void *user, void *pointer, size_t old_size, size_t new_size) {
    long *left = user;
    (void)old_size;
    if (new_size == 0) {
        free(pointer);
        return NULL;
    }
    return (*left)-- == 0 ? NULL : realloc(pointer, new_size);
}

static void failing_allocator(void) {
    make_folders();
    static const char text[] =
        BEGIN "<cubemap name='c'><filename>map.pfm</filename></cubemap><cubemap ref='c'/>" MESH(
            "near.obj")
            MESH("./near.obj") "<bsdf name='b' type='GlazedBSDF'><substrate "
                               "type='GlassBSDF'/></bsdf>"
                               "<brdf name='r' type='GGX'><alpha>1</alpha><nt>2</nt></brdf>" END;
    char name[600];
    snprintf(name, sizeof name, "%s", in_scratch("a/b/scene.xml"));
    for (long request = 0;; request++) {
        long left = request;
        GlintAllocator allocator = {failing_reallocate, &left};
        load_input((Input){.head = text, .head_size = sizeof text - 1, .name = name}, 0,
            GLINT_DIALECT_AUTO, &allocator);
        GlintStatus status = loaded.status;
        unload();
        if (left >= 0) {
            CHECK_INT(status, GLINT_OK);
            CHECK(request > 20);
            break;
        }
        CHECK_INT(status, GLINT_ERROR_MEMORY);
    }
}

/* ---------------------------------------------------------------- the course's scenes */

static int scene_count;

static int read_scene(const char *path, const struct stat *info, int type, struct FTW *place) {
    (void)info, (void)place;
    size_t length = strlen(path);
    if (type != FTW_F || length < 4 || strcmp(path + length - 4, ".xml") != 0) return 0;
    GlintSceneDesc desc = glint_scene_desc_default();
    GlintScene *scene = NULL;
    GlintError error = {0};
    CHECK_INT(glint_scene_create(&desc, &scene, NULL), GLINT_OK);
    if (glint_scene_load_file(scene, path, NULL, &error) != GLINT_OK) {
        test_fail(
            __FILE__, __LINE__, "%s:%d:%d: %s", path, error.line, error.column, error.message);
    }
    glint_scene_destroy(scene);
    scene_count++;
    return 0;
}

static void reference_scenes(void) {
    char folder[5000];
    const char *shared = test_shared_dir();
    snprintf(folder, sizeof folder, "%s/reference", shared != NULL ? shared : "");
    if (shared == NULL || access(folder, R_OK) != 0) {
        test_skip("the reference scenes are not here");
        return;
    }
    CHECK_INT(nftw(folder, read_scene, 20, FTW_PHYS), 0);
    CHECK(scene_count > 70);
}

const GiTest tests_files[] = {TEST(places), TEST(missing_and_broken), TEST(environments),
    TEST(textures), TEST(failing_allocator), TEST(reference_scenes), TEST_END};
