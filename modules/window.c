/* SPDX-License-Identifier: MIT
 * glint-window.so: a window, with SDL 2. It shows pixels and tells what the user does; what to show
 * is the program's business. */
#include "watch/window_module.h"

#include "glint/glint.h"

#include <SDL.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Texture {
    SDL_Texture *texture;
    Uint32 format;
    int width, height;
} Texture;

typedef struct Window {
    SDL_Window *window;
    SDL_Renderer *renderer;
    Texture picture, sheet;
    Uint32 wake_event;
    bool visible;
} Window;

/* ---------------------------------------------------------------- open, close */

static void close_window(void *user) {
    Window *window = user;
    if (window->picture.texture != NULL) SDL_DestroyTexture(window->picture.texture);
    if (window->sheet.texture != NULL) SDL_DestroyTexture(window->sheet.texture);
    if (window->renderer != NULL) SDL_DestroyRenderer(window->renderer);
    if (window->window != NULL) SDL_DestroyWindow(window->window);
    SDL_Quit();
    free(window);
}

static void *open_window(const char *title, char *message, size_t size) {
    /* Signals stay the program's; and a screen without windows is not taken over. */
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "x11,wayland");
    SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
    Window *window = calloc(1, sizeof *window);
    if (window == NULL || SDL_Init(SDL_INIT_VIDEO) != 0) {
        snprintf(message, size, "no window can be opened: %s",
            window == NULL ? "not enough memory" : SDL_GetError());
        free(window);
        return NULL;
    }
    Uint32 flags = SDL_WINDOW_HIDDEN | SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI;
    window->window =
        SDL_CreateWindow(title, SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, 320, 240, flags);
    if (window->window != NULL) {
        window->renderer = SDL_CreateRenderer(window->window, -1, 0);
        if (window->renderer == NULL) {
            window->renderer = SDL_CreateRenderer(window->window, -1, SDL_RENDERER_SOFTWARE);
        }
    }
    if (window->renderer == NULL) {
        snprintf(message, size, "no window can be opened: %s", SDL_GetError());
        close_window(window);
        return NULL;
    }
    window->wake_event = SDL_RegisterEvents(1);
    return window;
}

static void measure(void *user, int *width, int *height) {
    Window *window = user;
    *width = *height = 0;
    SDL_GetRendererOutputSize(window->renderer, width, height);
}

static void set_size(void *user, int width, int height) {
    Window *window = user;
    SDL_Rect room;
    int display = SDL_GetWindowDisplayIndex(window->window);
    if (SDL_GetDisplayUsableBounds(display < 0 ? 0 : display, &room) == 0) {
        double scale = 1;
        if (width * scale > 0.95 * room.w) scale = 0.95 * room.w / width;
        if (height * scale > 0.9 * room.h) scale = 0.9 * room.h / height;
        width = (int)(width * scale);
        height = (int)(height * scale);
    }
    SDL_SetWindowMinimumSize(window->window, 64, 48);
    SDL_SetWindowSize(window->window, width < 64 ? 64 : width, height < 48 ? 48 : height);
    SDL_SetWindowPosition(window->window, SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED);
    if (!window->visible) SDL_ShowWindow(window->window);
    window->visible = true;
}

static void set_title(void *user, const char *title) {
    Window *window = user;
    SDL_SetWindowTitle(window->window, title);
}

/* ---------------------------------------------------------------- show */

/* Copies rows of pixels into a texture, which is made anew when the size is another. */
static bool fill(Window *window, Texture *texture, Uint32 format, int width, int height,
    const uint8_t *pixels, int pixel_size) {
    if (texture->texture == NULL || texture->width != width || texture->height != height) {
        if (texture->texture != NULL) SDL_DestroyTexture(texture->texture);
        texture->texture =
            SDL_CreateTexture(window->renderer, format, SDL_TEXTUREACCESS_STREAMING, width, height);
        texture->width = width;
        texture->height = height;
    }
    return texture->texture != NULL &&
           SDL_UpdateTexture(texture->texture, NULL, pixels, width * pixel_size) == 0;
}

static bool show(void *user, const CliWindowImage *image) {
    Window *window = user;
    SDL_SetRenderDrawColor(window->renderer, 48, 48, 52, 255);
    SDL_RenderClear(window->renderer);
    bool good = true;
    if (image->rgb != NULL) {
        SDL_Rect place = {image->x, image->y, image->shown_width, image->shown_height};
        good = fill(window, &window->picture, SDL_PIXELFORMAT_RGB24, image->width, image->height,
            image->rgb, 3);
        if (good) {
            SDL_SetTextureScaleMode(window->picture.texture,
                image->smooth ? SDL_ScaleModeLinear : SDL_ScaleModeNearest);
            SDL_RenderCopy(window->renderer, window->picture.texture, NULL, &place);
        }
    }
    if (image->rgba != NULL) {
        SDL_Rect place = {0, 0, image->sheet_width, image->sheet_height};
        bool filled = fill(window, &window->sheet, SDL_PIXELFORMAT_RGBA32, image->sheet_width,
            image->sheet_height, image->rgba, 4);
        if (filled) {
            SDL_SetTextureBlendMode(window->sheet.texture, SDL_BLENDMODE_BLEND);
            SDL_RenderCopy(window->renderer, window->sheet.texture, NULL, &place);
        }
        good = good && filled;
    }
    SDL_RenderPresent(window->renderer);
    return good;
}

/* ---------------------------------------------------------------- events */

/* Mouse positions come in the screen's units, of which a fine screen has several pixels each. */
static void set_position(Window *window, CliWindowEvent *event, int x, int y) {
    int width, height, unit_width, unit_height;
    measure(window, &width, &height);
    SDL_GetWindowSize(window->window, &unit_width, &unit_height);
    event->x = unit_width > 0 ? (x + 0.5) * width / unit_width : x;
    event->y = unit_height > 0 ? (y + 0.5) * height / unit_height : y;
}

static int key_of(const SDL_Keysym *key) {
    switch (key->sym) {
    case SDLK_ESCAPE: return 27;
    case SDLK_LEFT: return CLI_WINDOW_LEFT;
    case SDLK_RIGHT: return CLI_WINDOW_RIGHT;
    case SDLK_UP: return CLI_WINDOW_UP;
    case SDLK_DOWN: return CLI_WINDOW_DOWN;
    default: return 0; /* the others come as text */
    }
}

static void take_window_event(CliWindowEvent *event, const SDL_WindowEvent *window) {
    switch (window->event) {
    case SDL_WINDOWEVENT_EXPOSED:
    case SDL_WINDOWEVENT_SIZE_CHANGED: event->kind = CLI_WINDOW_REDRAW; break;
    case SDL_WINDOWEVENT_CLOSE: event->kind = CLI_WINDOW_CLOSE; break;
    default: break;
    }
}

static void take_button(Window *window, CliWindowEvent *event, const SDL_MouseButtonEvent *button) {
    event->kind = button->type == SDL_MOUSEBUTTONDOWN ? CLI_WINDOW_PRESS : CLI_WINDOW_RELEASE;
    event->button = button->button;
    set_position(window, event, button->x, button->y);
}

/* What the event means; none for what does not matter here. */
static void take(Window *window, const SDL_Event *from, CliWindowEvent *event) {
    event->shift = (SDL_GetModState() & KMOD_SHIFT) != 0;
    switch (from->type) {
    case SDL_QUIT: event->kind = CLI_WINDOW_CLOSE; break;
    case SDL_WINDOWEVENT: take_window_event(event, &from->window); break;
    case SDL_KEYDOWN:
        event->key = key_of(&from->key.keysym);
        if (event->key != 0) event->kind = CLI_WINDOW_KEY;
        break;
    case SDL_TEXTINPUT:
        event->key = (unsigned char)from->text.text[0];
        if (event->key < 128) event->kind = CLI_WINDOW_KEY;
        break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP: take_button(window, event, &from->button); break;
    case SDL_MOUSEMOTION:
        event->kind = CLI_WINDOW_MOVE;
        set_position(window, event, from->motion.x, from->motion.y);
        break;
    case SDL_MOUSEWHEEL:
        event->kind = CLI_WINDOW_WHEEL;
        event->amount = (double)from->wheel.preciseY;
        break;
    default: break;
    }
}

/* A hand moves the mouse more often than pictures can follow: of several moves only the last one
 * counts. */
static void skip_moves(SDL_Event *event) {
    SDL_Event next;
    while (event->type == SDL_MOUSEMOTION &&
           SDL_PeepEvents(&next, 1, SDL_PEEKEVENT, SDL_FIRSTEVENT, SDL_LASTEVENT) == 1 &&
           next.type == SDL_MOUSEMOTION) {
        SDL_PollEvent(event);
    }
}

static void wait_for_event(void *user, int milliseconds, CliWindowEvent *event) {
    Window *window = user;
    SDL_Event from;
    *event = (CliWindowEvent){.kind = CLI_WINDOW_NONE};
    if (SDL_WaitEventTimeout(&from, milliseconds) == 0) return;
    skip_moves(&from);
    take(window, &from, event);
}

static void wake(void *user) {
    const Window *window = user;
    SDL_Event event = {.type = window->wake_event};
    SDL_PushEvent(&event);
}

GLINT_API extern const CliWindowModule glint_window;
const CliWindowModule glint_window = {CLI_WINDOW_VERSION, open_window, close_window, set_size,
    measure, set_title, show, wait_for_event, wake};
