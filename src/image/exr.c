/* SPDX-License-Identifier: MIT
 * Makes a list of channels and lends the module a file to write to. */
#include "image/exr.h"

#include "base/error.h"
#include "image/exr_writer.h"
#include "port/machine.h"
#include "port/module.h"
#include "sched/pool.h"

#include <stdio.h>
#include <string.h>

/* Names stay below the 31 bytes of the format. A chunk, 16 rows, must stay below 2^31 bytes. */
enum { LAYER_LIMIT = 256, NAME_LIMIT = 28, COMPONENT_LIMIT = 4, ROW_LIMIT = 1 << 25 };

typedef char ChannelName[NAME_LIMIT + 3]; /* with a point, a letter and the end */

/* ---------------------------------------------------------------- checks */

static GlintStatus open_module(GiModule *module, GlintError *error) {
    GlintStatus status =
        gi_module_open(module, "exr", GI_EXR_WRITER_SYMBOL, "write EXR pictures", error);
    if (status != GLINT_OK) return status;
    const GiExrWriter *writer = module->interface;
    if (writer->version == GI_EXR_WRITER_VERSION) return GLINT_OK;
    gi_module_close(module);
    return gi_error_set(error, GLINT_ERROR_FILE,
        "Glint cannot write EXR pictures: its module is of another version");
}

GlintStatus gi_exr_check(GlintError *error) {
    GiModule module;
    GlintStatus status = open_module(&module, error);
    if (status == GLINT_OK) gi_module_close(&module);
    return status;
}

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

static bool is_name(const char *name) {
    size_t length = strlen(name);
    if (length == 0 || length > NAME_LIMIT) return false;
    for (size_t i = 0; i < length; i++) {
        bool inner = i > 0 && ((name[i] >= '0' && name[i] <= '9') || strchr("._-", name[i]));
        if (!is_letter(name[i]) && !inner) return false;
    }
    return true;
}

static bool are_components(const char *letters) {
    size_t length = strlen(letters);
    if (length == 0 || length > COMPONENT_LIMIT) return false;
    for (size_t i = 0; i < length; i++) {
        if (!is_letter(letters[i]) || strchr(letters + i + 1, letters[i]) != NULL) return false;
    }
    return true;
}

static const char *check_layer(const GlintSaveDesc *desc, int index) {
    const GlintLayer *layer = &desc->layers[index];
    if (layer->pixels == NULL) return "a layer has no pixels";
    if (layer->name == NULL || !is_name(layer->name)) {
        return "the name of a layer must be 1 to 28 letters, digits, '.', '_' and '-', a letter "
               "first";
    }
    if (layer->components == NULL || !are_components(layer->components)) {
        return "the components of a layer must be 1 to 4 different letters";
    }
    for (int i = 0; i < index; i++) {
        if (strcmp(desc->layers[i].name, layer->name) == 0) return "two layers have one name";
    }
    return NULL;
}

const char *gi_exr_check_picture(const GlintImage *image, const GlintSaveDesc *desc) {
    if (desc->layer_count < 0 || desc->layer_count > LAYER_LIMIT) {
        return "there can be 0 to 256 layers";
    }
    if (desc->layer_count > 0 && desc->layers == NULL) return "there are no layers";
    int channel_count = 3;
    for (int i = 0; i < desc->layer_count; i++) {
        const char *fault = check_layer(desc, i);
        if (fault != NULL) return fault;
        channel_count += (int)strlen(desc->layers[i].components);
    }
    return image->width <= ROW_LIMIT / channel_count - 1 ? NULL : "the picture is too wide for EXR";
}

/* ---------------------------------------------------------------- writing */

static GiExrChannel make_channel(
    ChannelName name, const char *layer, char component, const float *values, int stride) {
    size_t length = strlen(layer);
    memcpy(name, layer, length);
    if (length > 0) name[length++] = '.';
    name[length++] = component;
    name[length] = '\0';
    return (GiExrChannel){name, values, stride};
}

/* Returns how many. */
static int make_channels(const GlintImage *image, const GlintSaveDesc *desc, GiExrChannel *channels,
    ChannelName *names) {
    int count = 0;
    for (; count < 3; count++) {
        channels[count] = make_channel(names[count], "", "RGB"[count], image -> pixels + count, 3);
    }
    for (int i = 0; i < desc->layer_count; i++) {
        const GlintLayer *layer = &desc->layers[i];
        int stride = (int)strlen(layer->components);
        for (int k = 0; k < stride; k++, count++) {
            channels[count] = make_channel(
                names[count], layer->name, layer->components[k], layer->pixels + k, stride);
        }
    }
    return count;
}

typedef struct Run {
    GiFileWriter *file;
    const GlintMonitor *monitor;
    GiPool *pool; /* null: only the caller's thread */
    bool cancelled;
} Run;

static bool write_part(void *user, const void *bytes, size_t size, uint64_t offset) {
    Run *run = user;
    return gi_file_write_at(run->file, bytes, size, offset);
}

static bool step(void *user, double fraction) {
    Run *run = user;
    const GlintMonitor *monitor = run->monitor;
    if (monitor == NULL) return true;
    if (monitor->cancelled != NULL && monitor->cancelled(monitor->user)) run->cancelled = true;
    if (monitor->progress != NULL && !run->cancelled) {
        monitor->progress(monitor->user, GLINT_PHASE_WRITE, fraction);
    }
    return !run->cancelled;
}

typedef struct Jobs {
    void (*job)(void *context, size_t index);
    void *context;
} Jobs;

static void do_jobs(void *context, size_t begin, size_t end, int worker) {
    const Jobs *jobs = context;
    (void)worker;
    for (size_t i = begin; i < end; i++) jobs->job(jobs->context, i);
}

static void run_jobs(
    void *user, size_t count, void (*job)(void *context, size_t index), void *context) {
    Run *run = user;
    Jobs jobs = {job, context};
    if (run->pool != NULL) {
        gi_parallel_for(run->pool, count, 1, do_jobs, &jobs);
    } else {
        do_jobs(&jobs, 0, count, 0);
    }
}

/* A thread has to earn its start, with two chunks of 16 rows. */
static GlintStatus create_pool(GiMemory *memory, int thread_count, int height, GiPool **pool) {
    int workers = thread_count > 0 ? thread_count : gi_machine_core_count();
    if (workers > height / 32) workers = height / 32;
    GlintStatus status = workers > 1 ? gi_pool_create(memory, workers, pool) : GLINT_OK;
    if (status == GLINT_OK) return status;
    *pool = NULL;
    return status == GLINT_ERROR_MEMORY ? status : GLINT_OK; /* without threads it takes longer */
}

static GlintStatus run_module(const GiExrWriter *writer, GiMemory *memory,
    const GiExrPicture *picture, const GlintSaveDesc *desc, GiFileWriter *file, GlintError *error) {
    char message[200] = "";
    Run run = {.file = file, .monitor = desc->monitor};
    GlintStatus status = create_pool(memory, desc->thread_count, picture->height, &run.pool);
    if (status != GLINT_OK) return gi_error_memory(error);
    size_t workers = run.pool != NULL ? (size_t)gi_pool_worker_count(run.pool) : 1;
    GiExrTarget target = {.write = write_part,
        .step = step,
        .run = run_jobs,
        .batch_size = 2 * workers,
        .user = &run,
        .message = message,
        .message_size = sizeof message};
    switch (writer->write(picture, &target)) {
    case GI_EXR_GOOD: break;
    case GI_EXR_MEMORY: status = gi_error_memory(error); break;
    case GI_EXR_FAILED: status = gi_error_set(error, GLINT_ERROR_FILE, "%s", message); break;
    case GI_EXR_STOPPED:
        status = run.cancelled ? gi_error_set(error, GLINT_CANCELLED, "cancelled")
                               : gi_error_set(error, GLINT_ERROR_FILE, "the file refused");
        break;
    }
    gi_pool_destroy(run.pool);
    return status;
}

GlintStatus gi_exr_write(GiMemory *memory, const GlintImage *image, const GlintSaveDesc *desc,
    GiFileWriter *file, GlintError *error) {
    GiModule module;
    GlintStatus status = open_module(&module, error);
    if (status != GLINT_OK) return status;
    size_t limit = 3 + COMPONENT_LIMIT * (size_t)desc->layer_count;
    GiExrChannel *channels = gi_memory_allocate(memory, limit * sizeof *channels);
    ChannelName *names = gi_memory_allocate(memory, limit * sizeof *names);
    if (channels != NULL && names != NULL) {
        char software[64];
        snprintf(software, sizeof software, "Glint %s", glint_version_text());
        GiExrPicture picture = {.width = image->width,
            .height = image->height,
            .channels = channels,
            .channel_count = make_channels(image, desc, channels, names),
            .software = software,
            .title = desc->title};
        status = run_module(module.interface, memory, &picture, desc, file, error);
    } else {
        status = gi_error_memory(error);
    }
    gi_memory_free(memory, channels, limit * sizeof *channels);
    gi_memory_free(memory, names, limit * sizeof *names);
    gi_module_close(&module);
    return status;
}
