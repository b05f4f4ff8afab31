/* SPDX-License-Identifier: MIT */
#include "mesh/input.h"

#include "math/eight.h"
#include "mesh/decimal.h"

#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* ---------------------------------------------------------------- faults */

bool gi_mesh_refuse(GiMeshInput *input, int worker, const char *at, const char *format, ...) {
    GiMeshFinding *finding = &input->findings[worker];
    if (finding->at != NULL && finding->at <= at) return false;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(finding->message, sizeof finding->message, format, arguments);
    va_end(arguments);
    finding->at = at;
    return false;
}

GlintStatus gi_mesh_fault(GiMeshFault *fault, GlintStatus status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fault->line = 0;
    vsnprintf(fault->message, sizeof fault->message, format, arguments);
    va_end(arguments);
    return status;
}

static uint64_t line_of(const GiMeshInput *input, const char *at) {
    uint64_t line = 1;
    for (const char *p = input->text; p < at; p++, line++) {
        p = memchr(p, '\n', (size_t)(at - p));
        if (p == NULL) break;
    }
    return line;
}

GlintStatus gi_mesh_input_status(GiMeshInput *input) {
    const GiMeshFinding *first = NULL;
    for (int i = 0; i < input->worker_count; i++) {
        const GiMeshFinding *finding = &input->findings[i];
        if (finding->at != NULL && (first == NULL || finding->at < first->at)) first = finding;
    }
    GlintStatus stop = (GlintStatus)atomic_load(&input->stop);
    if (stop != GLINT_OK) return gi_mesh_fault(input->fault, stop, "%s", glint_status_text(stop));
    if (first == NULL) return GLINT_OK;
    gi_mesh_fault(input->fault, GLINT_ERROR_SCENE, "%s", first->message);
    if (input->has_lines) input->fault->line = line_of(input, first->at);
    return GLINT_ERROR_SCENE;
}

/* ---------------------------------------------------------------- chunks */

typedef struct Run {
    GiMeshInput *input;
    size_t count;
    GiMeshChunkFn function;
    void *context;
    _Atomic size_t next;
    _Atomic bool failed;
} Run;

bool gi_mesh_is_cancelled(GiMeshInput *input) {
    const GlintMonitor *monitor = input->monitor;
    if (monitor == NULL || monitor->cancelled == NULL || !monitor->cancelled(monitor->user)) {
        return false;
    }
    atomic_store(&input->stop, GLINT_CANCELLED);
    return true;
}

static void run_chunks(void *context, size_t begin, size_t end, int worker) {
    Run *run = context;
    (void)begin, (void)end;
    for (;;) {
        /* The caller's thread is worker 0, and the monitor is called on no other. */
        if (worker == 0 && gi_mesh_is_cancelled(run->input)) return;
        if (atomic_load(&run->failed) || atomic_load(&run->input->stop) != GLINT_OK) return;
        size_t chunk = atomic_fetch_add(&run->next, 1);
        if (chunk >= run->count) return;
        if (!run->function(run->context, chunk, worker)) atomic_store(&run->failed, true);
    }
}

void gi_mesh_run(GiMeshInput *input, size_t count, GiMeshChunkFn function, void *context) {
    Run run = {.input = input, .count = count, .function = function, .context = context};
    if (input->pool == NULL) {
        run_chunks(&run, 0, 1, 0);
    } else {
        gi_parallel_for(input->pool, (size_t)input->worker_count, 1, run_chunks, &run);
    }
}

GlintStatus gi_mesh_chunks_init(GiMeshChunks *chunks, const GiMeshInput *input, const char *from,
    bool (*is_border)(const GiMeshInput *input, const char *p)) {
    size_t size = (size_t)(input->end - from);
    chunks->capacity = size / input->chunk_size + 2;
    chunks->count = 0;
    chunks->begin = gi_memory_allocate(input->memory, chunks->capacity * sizeof *chunks->begin);
    if (chunks->begin == NULL) {
        return gi_mesh_fault(input->fault, GLINT_ERROR_MEMORY, "not enough memory");
    }
    chunks->begin[0] = from;
    for (const char *p = from; p < input->end;) {
        p = (size_t)(input->end - p) > input->chunk_size ? p + input->chunk_size : input->end;
        while (p < input->end && !is_border(input, p)) p++;
        chunks->begin[++chunks->count] = p;
    }
    return GLINT_OK;
}

void gi_mesh_chunks_reset(GiMeshChunks *chunks, const GiMeshInput *input) {
    gi_memory_free(input->memory, chunks->begin, chunks->capacity * sizeof *chunks->begin);
}

void gi_mesh_forget(const GiMeshInput *input, const char *begin, const char *end) {
    if (input->file == NULL) return;
    gi_file_bytes_forget(input->file, (size_t)(begin - input->text), (size_t)(end - input->text));
}

/* ---------------------------------------------------------------- words */

const char *gi_mesh_skip_words(const char *p, const char *end, uint64_t count) {
    if (count == 0) return p;
    bool in_word = false;
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    uint64_t last = 0x80; /* whether the byte before these eight is white space */
    for (; end - p >= 8; p += 8) {
        uint64_t spaces = gi_eight_space(gi_eight_load(p));
        uint64_t word_ends = spaces & ~(spaces << 8 | last);
        uint64_t found = (word_ends >> 7) * UINT64_C(0x0101010101010101) >> 56;
        if (found >= count) {
            for (; count > 1; count--) word_ends &= word_ends - 1;
            return p + __builtin_ctzll(word_ends) / 8;
        }
        count -= found;
        last = spaces >> 56;
    }
    in_word = last == 0;
#endif
    for (; p < end; p++) {
        bool is_space = gi_mesh_is_space(*p);
        if (is_space && in_word && --count == 0) return p;
        in_word = !is_space;
    }
    return in_word && count == 1 ? end : NULL;
}

GiMeshQuote gi_mesh_quote(const char *p, const char *end) {
    GiMeshQuote quote;
    size_t length = 0, limit = sizeof quote.text - 4;
    for (; p < end && !gi_mesh_is_space(*p) && length < limit; p++) {
        quote.text[length++] = *p > ' ' && *p <= '~' ? *p : '?';
    }
    bool cut = p < end && !gi_mesh_is_space(*p);
    memcpy(quote.text + length, cut ? "..." : "", cut ? 4 : 1);
    return quote;
}

bool gi_mesh_no_number(GiMeshInput *input, int worker, const char *p, const char *end) {
    return gi_mesh_refuse(
        input, worker, p, "expected a number, found \"%s\"", gi_mesh_quote(p, end).text);
}

const char *gi_mesh_number(
    GiMeshInput *input, int worker, const char *p, const char *end, float *value) {
    const char *number_end = gi_decimal_read(p, end, value);
    if (number_end == NULL) {
        gi_mesh_no_number(input, worker, p, end);
    } else if (*value > FLT_MAX || *value < -FLT_MAX) {
        gi_mesh_refuse(input, worker, p, "%s is beyond the range of single precision",
            gi_mesh_quote(p, end).text);
        number_end = NULL;
    }
    return number_end;
}
