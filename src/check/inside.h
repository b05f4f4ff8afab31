/* SPDX-License-Identifier: MIT
 * What the files of this room share: the scene being checked, what has been found, and a survey of
 * it that several rules ask.
 *
 *     census.c     which surfaces stand where, and which solids a point is in
 *     survey.c     a small picture: what the camera sees
 *     view.c, lights.c, shaders.c, surfaces.c, meshes.c, dialect.c     the rules
 */
#pragma once

#include "base/error.h"
#include "check/check.h"
#include "check/rule.h"

enum {
    GI_CHECK_LIMIT = 10, /* findings of a rule that are told one by one */
    GI_CHECK_MESSAGE = 480,
    GI_CHECK_NAME = 80
};

typedef struct GiCheckFinding {
    GiRule rule;
    int64_t offset;                 /* of the start tag it is about, or -1 */
    size_t number;                  /* in the order of finding */
    char message[GI_CHECK_MESSAGE]; /* and behind a line end the hint, when there is one */
} GiCheckFinding;

/* Something that stands in a tree: a shape, a placed shape, an instance, or a mesh as it is, whose
 * ref is of the kind GI_SHAPE_MESH. */
typedef struct GiCheckItem {
    GiShapeRef ref;
    uint32_t order;  /* in the file; of a group that of its first surface */
    uint32_t shader; /* GI_NONE: of a group */
    GiBox bounds;
} GiCheckItem;

typedef GI_ARRAY(GiCheckItem) GiCensus;

/* A picture of at most side x side pixels. */
typedef struct GiSurvey {
    int width, height;
    float *color;      /* 3 a pixel */
    uint32_t *surface; /* order + 1 of the surface that is seen, or 0 */
    size_t seen;       /* pixels that show one */
} GiSurvey;

typedef struct GiCheck {
    const GiCheckInput *input;
    const GiWorld *world;
    const GiScene *scene;
    GiMemory *memory;
    GI_ARRAY(GiCheckFinding) findings;
    size_t counts[GI_CHECK_COUNT];
    GiCensus census; /* of the scene's own tree, in the order of the file */
    GiSurvey survey;
    bool *shader_used;  /* some surface has it, or what glazes it */
    int64_t root;       /* place of the scene element, or -1 */
    bool in_view;       /* a camera ray meets something */
    GlintStatus status; /* of what went wrong on the way */
} GiCheck;

/* ---- check.c */

/* Notes a finding. After a line end the text goes on with a hint. */
GI_PRINTF(4, 5)
void gi_check_add(GiCheck *check, GiRule rule, int64_t offset, const char *format, ...);

/* Whether another one of the rule will only be counted: then do not bother. */
static inline bool gi_check_is_full(const GiCheck *check, GiRule rule) {
    return check->counts[rule] >= GI_CHECK_LIMIT;
}

/* Where an object stands; index1 counts from 1, as everywhere. */
int64_t gi_check_place(const GiCheck *check, GlintObjectKind kind, uint32_t index1);

/* "of line 14", or "number 3" where no line is known. Returns buffer. */
const char *gi_check_name(
    const GiCheck *check, GlintObjectKind kind, uint32_t index1, char buffer[GI_CHECK_NAME]);

/* Whether somebody wants to stop; asks. Also when something has gone wrong. */
bool gi_check_stopped(GiCheck *check);

/* ---- census.c */

/* What stands in a tree, in the order of the file. */
bool gi_census(const GiCheck *check, const GiTree *tree, GiCensus *items);

/* Whether an instance's tree is that of a mesh, which then holds nothing else. */
bool gi_census_is_mesh(const GiTree *tree);

/* "sphere", "cylinder", "mesh", ... */
const char *gi_check_word(const GiCheck *check, GiShapeRef ref);

/* A solid: a closed surface that a point is in. */
typedef struct GiSolid {
    GiShapeRef ref;
    uint32_t order, shader;
} GiSolid;
enum { GI_SOLID_LIMIT = 32 };

/* The solids round a point, at most GI_SOLID_LIMIT. slack: how far outside, as a part of its size,
 * a solid still has the point; negative: how far inside it must be. Less than a millionth. A mesh
 * counts when its back is seen in all directions. Returns how many. */
int gi_check_solids(
    const GiCheck *check, GiVec point, double slack, GiSolid solids[GI_SOLID_LIMIT]);

/* ---- survey.c */

/* Draws what the camera sees, of one light (from 1) or of all (0), at most side pixels wide and
 * high. False: memory, or stopped. */
bool gi_survey_draw(GiCheck *check, int side, int light, GiSurvey *survey);
void gi_survey_free(const GiCheck *check, GiSurvey *survey);

/* Which surface a camera ray through a place of the window meets, and at which t; both coordinates
 * from 0 to 1. */
typedef struct GiSight {
    GiVec origin, direction;
    GiTraceHit hit;
} GiSight;
bool gi_survey_look(const GiCheck *check, double a, double b, GiSight *sight);

/* ---- the rules */
void gi_check_view(GiCheck *check);
void gi_check_lights(GiCheck *check);
void gi_check_shaders(GiCheck *check);
void gi_check_surfaces(GiCheck *check);
void gi_check_meshes(GiCheck *check);
void gi_check_dialect(GiCheck *check);

/* Whether a shader shows more the more light falls on it. */
bool gi_check_needs_light(const GiCheck *check, uint32_t shader);
