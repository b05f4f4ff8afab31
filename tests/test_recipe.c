/* SPDX-License-Identifier: MIT
 * Recipes: what is written is what is read, and broken pictures are refused. */
#include "test.h"

#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static GlintScene *embeddable(const char *text) {
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.keep_sources = true;
    GlintScene *scene = NULL;
    CHECK_INT(glint_scene_create(&desc, &scene, NULL), GLINT_OK);
    CHECK_INT(load_text(scene, text, NULL), GLINT_OK);
    CHECK_INT(glint_scene_commit(scene, NULL, NULL), GLINT_OK);
    return scene;
}

static const char *picture_path(void) {
    static char path[600];
    snprintf(path, sizeof path, "%s/recipe.png", test_scratch_dir());
    return path;
}

/* Draws with a recipe that holds the scene. */
static void draw(GlintScene *scene, const GlintRenderDesc *desc) {
    GlintRecipe *recipe = NULL;
    CHECK_INT(glint_scene_recipe(scene, desc, true, &recipe, NULL), GLINT_OK);
    GlintSaveDesc save = glint_save_desc_default();
    save.recipe = recipe;
    CHECK_INT(glint_render_save(scene, desc, picture_path(), &save, NULL), GLINT_OK);
    glint_recipe_destroy(recipe);
}

static void what_is_written_is_read(void) {
    GlintScene *scene = embeddable(small_scene);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = 50;
    desc.height = 40;
    desc.crop_x = 3;
    desc.crop_y = 4;
    desc.crop_width = 30;
    desc.samples = 4;
    desc.light = 2;
    desc.sampling = GLINT_SAMPLING_RANDOM;
    draw(scene, &desc);
    GlintRecipe *recipe = NULL;
    CHECK_INT(glint_recipe_load(picture_path(), &recipe, NULL), GLINT_OK);
    CHECK_TEXT(recipe->version, glint_version_text());
    CHECK(recipe->width == 50 && recipe->height == 40);
    CHECK(recipe->crop_x == 3 && recipe->crop_y == 4);
    CHECK(recipe->crop_width == 30 && recipe->crop_height == 36);
    CHECK(recipe->samples == 4 && recipe->light == 2);
    CHECK_INT(recipe->sampling, GLINT_SAMPLING_RANDOM);
    GlintSceneInfo info;
    glint_scene_info(scene, &info);
    CHECK_INT(recipe->dialect, info.dialect);
    CHECK_INT(recipe->file_count, 1);
    CHECK_INT(recipe->files[0].size, strlen(small_scene));
    CHECK(memcmp(recipe->files[0].bytes, small_scene, strlen(small_scene)) == 0);
    Picture picture = picture_of_scene(scene, &desc);
    GlintImage image = {picture.width, picture.height, picture.pixels};
    uint64_t linear = 0, file = 0;
    CHECK_INT(glint_image_digest(&image, &linear, NULL), GLINT_OK);
    CHECK(recipe->has_pixels && recipe->pixels == linear);
    GlintError error;
    GlintStatus status = glint_picture_digest(picture_path(), &file, &error);
    bool no_module = status == GLINT_ERROR_FILE && strstr(error.message, "module") != NULL;
    CHECK(no_module || (status == GLINT_OK && file == linear));
    picture_free(&picture);
    glint_recipe_destroy(recipe);
    glint_scene_destroy(scene);
}

/* Any byte changed, or the file cut anywhere: a status, and no crash. */
static void broken_pictures(void) {
    GlintScene *scene = embeddable(small_scene);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = desc.height = 4;
    draw(scene, &desc);
    glint_scene_destroy(scene);
    FILE *file = fopen(picture_path(), "rb");
    static uint8_t bytes[20000], changed[20000];
    size_t size = file != NULL ? fread(bytes, 1, sizeof bytes, file) : 0;
    CHECK(size > 100 && size < sizeof bytes && fclose(file) == 0);
    int refused = 0;
    for (size_t i = 0; i < 2 * size; i += 3) {
        size_t length = i < size ? size : i - size;
        memcpy(changed, bytes, size);
        if (i < size) changed[i] ^= (uint8_t)(1u << i % 8);
        file = fopen(picture_path(), "wb");
        CHECK(file != NULL && fwrite(changed, 1, length, file) == length && fclose(file) == 0);
        GlintRecipe *recipe = NULL;
        GlintError error = {0};
        GlintStatus status = glint_recipe_load(picture_path(), &recipe, &error);
        CHECK(status == GLINT_OK || (recipe == NULL && error.message[0] != '\0'));
        refused += status != GLINT_OK;
        glint_recipe_destroy(recipe);
    }
    CHECK(refused > (int)size / 3);
}

static void arguments(void) {
    GlintScene *scene = scene_from_text(small_scene, NULL, 1);
    GlintRenderDesc desc = glint_render_desc_default();
    GlintRecipe *recipe = NULL;
    GlintError error;
    CHECK_INT(glint_scene_recipe(scene, &desc, true, &recipe, &error), GLINT_ERROR_ARGUMENT);
    CHECK(strstr(error.message, "keep_sources") != NULL && recipe == NULL);
    CHECK_INT(glint_scene_recipe(NULL, &desc, false, &recipe, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_recipe_load("/nowhere/a.png", &recipe, &error), GLINT_ERROR_FILE);
    CHECK_INT(glint_recipe_load(NULL, &recipe, NULL), GLINT_ERROR_ARGUMENT);
    glint_recipe_destroy(NULL);
    CHECK_INT(glint_scene_recipe(scene, &desc, false, &recipe, NULL), GLINT_OK);
    char text[1000], cut[20];
    size_t length = glint_recipe_format(recipe, text, sizeof text);
    CHECK(length == strlen(text) && glint_recipe_format(recipe, cut, sizeof cut) == length);
    CHECK(strlen(cut) == sizeof cut - 1 && strncmp(cut, text, sizeof cut - 1) == 0);
    glint_recipe_destroy(recipe);
    glint_scene_destroy(scene);
}

const GiTest tests_recipe[] = {
    TEST(what_is_written_is_read), TEST(broken_pictures), TEST(arguments), TEST_END};
