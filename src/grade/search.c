/* SPDX-License-Identifier: MIT
 * First every mistake alone. Where one explains nearly all, that is it; otherwise pairs. A pair of
 * a mistake of the scene and one of the finished picture costs one drawing for all of the latter;
 * of two mistakes of the scene each pair is drawn, but only a window where the best mistake alone
 * leaves most. Pairs are so weighed by some of the pixels, and those that do best by all. */
#include "grade/grade.h"

#include "base/error.h"
#include "math/gamma.h"

#include <math.h>
#include <string.h>

#define LEAST_NOTED 0.01 /* what explains less is no hypothesis */

enum {
    CANDIDATE_LIMIT = 256,
    LIGHTS_TRIED = 16,
    SAMPLED_PIXELS = 8192,
    SMALL_PICTURE = 100 * 100,
    FINALISTS = 12,
    PARTNERS = 6 /* of the scene's mistakes, those that do best alone */
};

/* A mistake to try. */
typedef struct Candidate {
    GlintMistakes mistakes;
    double left;
    bool active; /* it changes something, and may be one of a pair */
} Candidate;

/* A pair to be weighed by all pixels. */
typedef struct Finalist {
    GlintMistakes mistakes;
    double left; /* a part of what the right picture leaves there */
} Finalist;

typedef struct Search {
    const GiGradeTask *task;
    GlintGrade *grade;
    GlintError *error;
    uint8_t *mine;
    float *drawn;
    size_t size; /* of drawn */
    int tolerance, step;
    double whole;           /* what the right picture leaves */
    double best_single;     /* what the best mistake leaves */
    double whole_sampled;   /* what the right picture leaves of every step-th pixel */
    double whole_inside;    /* ... and of the window */
    GiGradeWindow window;   /* that is drawn for pairs */
    int scene_count, count; /* candidates: those of the scene come first */
    Candidate candidates[CANDIDATE_LIMIT];
    int finalist_count;
    Finalist finalists[FINALISTS];
} Search;

/* ---------------------------------------------------------------- what to try */

static void add(Search *search, GlintMistakes mistakes) {
    if (search->count == CANDIDATE_LIMIT) return;
    search->candidates[search->count++] = (Candidate){.mistakes = mistakes, .active = true};
}

static GlintMistakes one(GlintMistake mistake) {
    return (GlintMistakes){.set = GLINT_MISTAKE_BIT(mistake)};
}

/* By half pixels to all eight sides, and by whole ones to four. */
static void add_shifts(Search *search) {
    for (int y = -1; y <= 1; y++) {
        for (int x = -1; x <= 1; x++) {
            if (x == 0 && y == 0) continue;
            GlintMistakes mistakes = one(GLINT_MISTAKE_SHIFTED);
            mistakes.shift_x = x, mistakes.shift_y = y;
            add(search, mistakes);
            mistakes.shift_x = 2 * x, mistakes.shift_y = 2 * y;
            if (x == 0 || y == 0) add(search, mistakes);
        }
    }
}

static void add_lights(Search *search) {
    const GiGradeTask *task = search->task;
    int placed = 0;
    for (int k = 0; k < task->light_count && k < GI_GRADE_LIGHT_LIMIT; k++) {
        if (!task->placed[k] || ++placed > LIGHTS_TRIED) continue;
        GlintMistakes mistakes = one(GLINT_MISTAKE_LIGHT_MISSING);
        mistakes.light = k + 1;
        add(search, mistakes);
    }
    /* Of two lights the last alone is the same as the first missing. */
    if (placed > 2) add(search, one(GLINT_MISTAKE_LAST_LIGHT));
}

static void list_candidates(Search *search) {
    for (int i = 0; i < GLINT_MISTAKE_FLIPPED; i++) {
        if (i == GLINT_MISTAKE_SHIFTED) {
            add_shifts(search);
        } else if (i == GLINT_MISTAKE_LIGHT_MISSING) {
            if (search->task->from_scene) add_lights(search);
        } else if (i != GLINT_MISTAKE_LAST_LIGHT && search->task->from_scene) {
            add(search, one((GlintMistake)i));
        }
    }
    search->scene_count = search->count;
    for (int i = GLINT_MISTAKE_FLIPPED; i < GLINT_MISTAKE_COUNT; i++) {
        if (i == GLINT_MISTAKE_TRANSPOSED && search->task->width != search->task->height) continue;
        add(search, one((GlintMistake)i));
    }
}

/* ---------------------------------------------------------------- weighing */

static double left_of(
    const Search *search, const float *pixels, const GlintMistakes *mistakes, int step) {
    return gi_grade_left(search->task, search->mine, pixels, mistakes, search->tolerance, step);
}

/* The mistakes with the factor that fits, when BRIGHTNESS is one of them. */
static GlintMistakes fitted(const Search *search, const float *pixels, GlintMistakes mistakes) {
    if (GI_MISTAKE_HAS(&mistakes, BRIGHTNESS)) {
        mistakes.factor = gi_grade_factor(search->task, search->mine, pixels, search->step);
    }
    return mistakes;
}

static GlintMistakes of_scene(GlintMistakes mistakes) {
    mistakes.set &= ~GI_MISTAKES_OF_PICTURE;
    return mistakes;
}

/* Draws with the mistakes of the scene. *pixels: what is drawn, or null when they change nothing.
 */
static GlintStatus draw(Search *search, GlintMistakes mistakes, const float **pixels) {
    const GiGradeTask *task = search->task;
    const GlintMistakes scene = of_scene(mistakes);
    const GiGradeWindow all = {0, 0, task->width, task->height};
    bool differs = false;
    *pixels = task->right;
    if (scene.set == 0) return GLINT_OK;
    GlintStatus status =
        task->draw(task->user, &scene, &all, search->drawn, &differs, search->error);
    bool same = !differs || memcmp(search->drawn, task->right, search->size) == 0;
    *pixels = same ? NULL : search->drawn;
    return status;
}

/* Into the list of the result, which is sorted; of equals the first stays first. */
static void note(Search *search, const GlintMistakes *mistakes, double left) {
    GlintGrade *grade = search->grade;
    GlintHypothesis found = {*mistakes, 1 - left / search->whole};
    if (found.explains < LEAST_NOTED) return;
    int at = grade->hypothesis_count;
    while (at > 0 && grade->hypotheses[at - 1].explains < found.explains) at--;
    if (at == GLINT_HYPOTHESIS_LIMIT) return;
    int last = grade->hypothesis_count < GLINT_HYPOTHESIS_LIMIT ? grade->hypothesis_count++
                                                                : GLINT_HYPOTHESIS_LIMIT - 1;
    for (; last > at; last--) grade->hypotheses[last] = grade->hypotheses[last - 1];
    grade->hypotheses[at] = found;
}

/* ---------------------------------------------------------------- one mistake */

static GlintStatus try_single(Search *search, Candidate *candidate) {
    const float *pixels;
    GlintStatus status = draw(search, candidate->mistakes, &pixels);
    candidate->active = status == GLINT_OK && pixels != NULL;
    if (!candidate->active) return status;
    candidate->mistakes = fitted(search, pixels, candidate->mistakes);
    candidate->left = left_of(search, pixels, &candidate->mistakes, 1);
    search->grade->tried++;
    return GLINT_OK;
}

/* Where surfaces shadow themselves is a matter of a program's own rounding, so it is enough that
 * light is missing here and there. */
static GlintStatus try_acne(Search *search) {
    const GiGradeTask *task = search->task;
    for (int i = 0; i < search->scene_count; i++) {
        Candidate *candidate = &search->candidates[i];
        if (!GI_MISTAKE_HAS(&candidate->mistakes, SHADOW_ACNE)) continue;
        double left;
        GlintStatus status = gi_grade_acne(task, search->mine, &left, search->error);
        if (status != GLINT_OK) return status;
        if (left < 0) continue;
        if (!candidate->active || left < candidate->left) candidate->left = left;
        candidate->active = true;
        if (left < search->best_single) search->best_single = left;
    }
    return GLINT_OK;
}

/* Of many shifts only the best is a hypothesis of its own, or one of a pair. */
static void keep_best_shift(Search *search) {
    Candidate *best = NULL;
    for (int i = 0; i < search->scene_count; i++) {
        Candidate *candidate = &search->candidates[i];
        if (!candidate->active || !GI_MISTAKE_HAS(&candidate->mistakes, SHIFTED)) continue;
        if (best == NULL || candidate->left < best->left) {
            if (best != NULL) best->active = false;
            best = candidate;
        } else {
            candidate->active = false;
        }
    }
}

static void report(const Search *search, double fraction) {
    if (search->task->progress != NULL) search->task->progress(search->task->user, fraction);
}

/* The part of the progress that mistakes alone take when pairs may follow. */
#define SINGLES_PART 0.3

static GlintStatus try_singles(Search *search) {
    search->best_single = search->whole;
    for (int i = 0; i < search->count; i++) {
        report(search, SINGLES_PART * i / search->count);
        GlintStatus status = try_single(search, &search->candidates[i]);
        if (status != GLINT_OK) return status;
        const Candidate *candidate = &search->candidates[i];
        if (candidate->active && candidate->left < search->best_single) {
            search->best_single = candidate->left;
        }
    }
    if (search->task->from_scene && search->best_single > 0.03 * search->whole) {
        GlintStatus status = try_acne(search);
        if (status != GLINT_OK) return status;
    }
    keep_best_shift(search);
    for (int i = 0; i < search->count; i++) {
        const Candidate *candidate = &search->candidates[i];
        if (candidate->active) note(search, &candidate->mistakes, candidate->left);
    }
    return GLINT_OK;
}

/* ---------------------------------------------------------------- two mistakes */

static GlintMistakes both(const GlintMistakes *a, const GlintMistakes *b) {
    GlintMistakes sum = *a;
    sum.set |= b->set;
    if (b->light != 0) sum.light = b->light;
    if (GI_MISTAKE_HAS(b, SHIFTED)) sum.shift_x = b->shift_x, sum.shift_y = b->shift_y;
    return sum;
}

static void consider(Search *search, const GlintMistakes *mistakes, double left) {
    search->grade->pairs_tried++;
    int at = search->finalist_count;
    while (at > 0 && search->finalists[at - 1].left > left) at--;
    if (at == FINALISTS) return;
    int last = search->finalist_count < FINALISTS ? search->finalist_count++ : FINALISTS - 1;
    for (; last > at; last--) search->finalists[last] = search->finalists[last - 1];
    search->finalists[at] = (Finalist){*mistakes, left};
}

/* Pixels of a, drawn with a mistake of the scene or the right ones, with those of the picture. */
static void pair_with_picture(
    Search *search, const GlintMistakes *a, const float *pixels, int first) {
    for (int i = first; i < search->count; i++) {
        const Candidate *candidate = &search->candidates[i];
        if (!candidate->active) continue;
        GlintMistakes pair = fitted(search, pixels, both(a, &candidate->mistakes));
        consider(
            search, &pair, left_of(search, pixels, &pair, search->step) / search->whole_sampled);
    }
}

/* Whether the candidate is among the few that are paired with all others. */
static bool is_partner(const Search *search, int index) {
    int better = 0;
    for (int i = 0; i < search->scene_count; i++) {
        const Candidate *other = &search->candidates[i], *own = &search->candidates[index];
        better +=
            other->active && (other->left < own->left || (other->left == own->left && i < index));
    }
    return better < PARTNERS;
}

static GlintStatus pair_with_scene(Search *search, int first) {
    bool partner = search->task->many_pairs || is_partner(search, first);
    const Candidate *a = &search->candidates[first];
    for (int i = first + 1; i < search->scene_count; i++) {
        const Candidate *b = &search->candidates[i];
        if (!b->active || b->mistakes.set == a->mistakes.set) continue;
        if (!partner && !is_partner(search, i)) continue;
        GlintMistakes pair = both(&a->mistakes, &b->mistakes);
        bool differs = false;
        GlintStatus status = search->task->draw(
            search->task->user, &pair, &search->window, search->drawn, &differs, search->error);
        if (status != GLINT_OK) return status;
        if (!differs) continue;
        double left = gi_grade_left_in(
            search->task, search->mine, search->drawn, &search->window, search->tolerance);
        consider(search, &pair, left / search->whole_inside);
    }
    return GLINT_OK;
}

/* What a picture leaves in the window. */
static double left_inside(const Search *search, const float *pixels) {
    const GiGradeTask *task = search->task;
    const GiGradeWindow *window = &search->window;
    double sum = 0;
    for (int y = window->y; y < window->y + window->height; y++) {
        const GiGradeWindow row = {window->x, y, window->width, 1};
        const float *from = pixels + 3 * ((size_t)y * (size_t)task->width + (size_t)window->x);
        sum += gi_grade_left_in(task, search->mine, from, &row, search->tolerance);
    }
    return sum;
}

/* Of a large picture a ninth: that where the best mistake of the scene leaves most. */
static GlintStatus choose_window(Search *search) {
    const GiGradeTask *task = search->task;
    const GlintMistakes none = {0};
    const Candidate *best = NULL;
    for (int i = 0; i < search->scene_count; i++) {
        const Candidate *other = &search->candidates[i];
        if (other->active && (best == NULL || other->left < best->left)) best = other;
    }
    int parts = (int64_t)task->width * task->height > SMALL_PICTURE ? 3 : 1;
    const float *pixels = task->right;
    GlintStatus status = GLINT_OK;
    if (best != NULL && best->left < search->whole) status = draw(search, best->mistakes, &pixels);
    if (status != GLINT_OK) return status;
    double most = -1;
    GiGradeWindow chosen = {0};
    for (int i = 0; i < parts * parts; i++) {
        int x = i % parts * task->width / parts, y = i / parts * task->height / parts;
        search->window = (GiGradeWindow){x, y, (i % parts + 1) * task->width / parts - x,
            (i / parts + 1) * task->height / parts - y};
        double left = left_inside(search, pixels);
        if (left <= most) continue;
        most = left;
        chosen = search->window;
    }
    search->window = chosen;
    search->whole_inside = fmax(left_inside(search, task->right), 1);
    search->whole_sampled = fmax(left_of(search, task->right, &none, search->step), 1);
    return GLINT_OK;
}

static GlintStatus list_pairs(Search *search) {
    GlintStatus status = choose_window(search);
    if (status != GLINT_OK) return status;
    for (int i = 0; i < search->scene_count; i++) {
        const Candidate *a = &search->candidates[i];
        report(search, SINGLES_PART + (1 - SINGLES_PART) * i / search->scene_count);
        if (!a->active) continue;
        const float *pixels;
        status = draw(search, a->mistakes, &pixels);
        if (status == GLINT_OK && pixels != NULL) {
            pair_with_picture(search, &a->mistakes, pixels, search->scene_count);
            status = pair_with_scene(search, i);
        }
        if (status != GLINT_OK) return status;
    }
    for (int i = search->scene_count; i < search->count; i++) {
        const Candidate *a = &search->candidates[i];
        if (!a->active) continue;
        pair_with_picture(search, &a->mistakes, search->task->right, i + 1);
    }
    return GLINT_OK;
}

/* A pair is believed only where it leaves far less than any mistake alone: there are so many pairs
 * that some fit a little better by chance. */
static GlintStatus weigh_finalists(Search *search) {
    double best = search->best_single / search->whole;
    for (int i = 0; i < search->finalist_count; i++) {
        const float *pixels;
        Finalist *finalist = &search->finalists[i];
        GlintStatus status = draw(search, finalist->mistakes, &pixels);
        if (status != GLINT_OK) return status;
        finalist->left = search->whole;
        if (pixels == NULL) continue;
        finalist->left = left_of(search, pixels, &finalist->mistakes, 1);
    }
    for (int i = 0; i < search->finalist_count; i++) {
        double left = search->finalists[i].left / search->whole;
        if (left > 0.5 * best || best - left < 0.03) continue;
        note(search, &search->finalists[i].mistakes, search->finalists[i].left);
    }
    return GLINT_OK;
}

/* ---------------------------------------------------------------- rounding */

/* A picture that was written with 8 bits does not say which values are to be cut; but then all that
 * differ are one too small. */
static bool is_cut(const Search *search) {
    const GiGradeTask *task = search->task;
    size_t count = 3 * (size_t)task->width * (size_t)task->height, lower = 0;
    for (size_t i = 0; i < count; i++) {
        uint8_t right;
        gi_gamma_encode(task->right + i, 1, &right);
        if (search->mine[i] == right) continue;
        if (search->mine[i] + 1 != right) return false;
        lower++;
    }
    return lower > count / 8;
}

static void judge_rounding(Search *search) {
    const GlintMistakes none = {0}, cut = one(GLINT_MISTAKE_TRUNCATED);
    search->tolerance = 0;
    search->whole = left_of(search, search->task->right, &none, 1);
    double left = left_of(search, search->task->right, &cut, 1);
    search->grade->tried = 1;
    if (!search->task->from_scene) left = is_cut(search) ? 0 : search->whole;
    if (left <= 0.1 * search->whole) note(search, &cut, left);
    search->grade->verdict = GLINT_VERDICT_ROUNDING;
}

/* Whether so few pixels differ that any of many mistakes might explain them by chance. */
static bool are_few(const Search *search) {
    const GiGradeTask *task = search->task;
    double percent = search->grade->comparison.percent;
    return percent <= 0.01 || percent / 100 * task->width * task->height < 8.5;
}

/* ---------------------------------------------------------------- the whole */

static GlintStatus run(Search *search) {
    const GiGradeTask *task = search->task;
    GlintGrade *grade = search->grade;
    const GlintMistakes none = {0};
    size_t pixels = (size_t)task->width * (size_t)task->height;
    while (pixels / (size_t)(search->step * search->step) > SAMPLED_PIXELS) search->step++;
    if (grade->comparison.max == 0) {
        grade->verdict = GLINT_VERDICT_SAME;
        return GLINT_OK;
    }
    if (grade->comparison.max <= task->tolerance) {
        judge_rounding(search);
        return GLINT_OK;
    }
    if (are_few(search)) {
        grade->verdict = GLINT_VERDICT_ROUNDING;
        return GLINT_OK;
    }
    search->whole = left_of(search, task->right, &none, 1);
    list_candidates(search);
    GlintStatus status = try_singles(search);
    bool pairs = task->pairs && grade->comparison.percent > GI_GRADE_ISOLATED;
    if (status == GLINT_OK && pairs && search->best_single > 0.03 * search->whole) {
        status = list_pairs(search);
        if (status == GLINT_OK) status = weigh_finalists(search);
    }
    report(search, 1);
    gi_grade_judge(grade);
    return status;
}

GlintStatus gi_grade_search(const GiGradeTask *task, GlintGrade *grade, GlintError *error) {
    size_t count = 3 * (size_t)task->width * (size_t)task->height;
    Search *search = gi_memory_allocate(task->memory, sizeof *search);
    uint8_t *mine = gi_memory_allocate(task->memory, count);
    float *drawn = gi_memory_allocate(task->memory, count * sizeof *drawn);
    GlintStatus status = GLINT_ERROR_MEMORY;
    if (search != NULL && mine != NULL && drawn != NULL) {
        memset(search, 0, sizeof *search);
        search->task = task;
        search->grade = grade;
        search->error = error;
        search->mine = mine;
        search->drawn = drawn;
        search->size = count * sizeof *drawn;
        search->tolerance = task->tolerance;
        search->step = 1;
        gi_gamma_encode(task->mine, count, mine);
        status = run(search);
    } else {
        gi_error_memory(error);
    }
    gi_memory_free(task->memory, drawn, count * sizeof *drawn);
    gi_memory_free(task->memory, mine, count);
    gi_memory_free(task->memory, search, sizeof *search);
    return status;
}
