/* SPDX-License-Identifier: MIT
 * A committed scene as a program with mistakes would draw it: a shallow copy of the world with
 * other rules, another view, and lights and shaders of its own. Shapes and trees are shared, so
 * that one commit serves all mistakes, and drawing without any costs nothing. */
#pragma once

#include "mistake/mistake.h"
#include "render/render.h"

typedef struct GiBroken {
    GiWorld world;
    GiScene scene; /* what it points to is the right scene's, but for shaders and lights */
    GiRules rules;
    bool differs; /* from the right world, in something that counts in this scene */
} GiBroken;

/* camera: the one to be spoiled. The world must outlive it, and it must not move. False when memory
 * is short; there is nothing to reset then. */
bool gi_broken_init(GiBroken *broken, const GiWorld *world, const GiCamera *camera,
    const GlintMistakes *mistakes, const GiRenderArea *area);
void gi_broken_reset(GiBroken *broken);
