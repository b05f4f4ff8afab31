/* SPDX-License-Identifier: MIT
 * Embree counts without the harness around it (net), which is the comparison that is better for
 * it. */
#include "page_rays.h"

#include <string.h>

static bool begins_scene(const Table *rays, int row) {
    const char *scene = table_text(rays, row, "scene");
    return row == 0 || strcmp(table_text(rays, row - 1, "scene"), scene) != 0;
}

static void write_number(FILE *file, const Table *rays, int row, const char *column, int digits) {
    double number = table_number(rays, row, column);
    if (number > 0) {
        fprintf(file, " %.*f |", digits, number);
    } else {
        fputs(" |", file);
    }
}

void page_rays(FILE *file, const Table *rays) {
    if (rays->row_count == 0) return;
    fprintf(file,
        "\n### Rays\n\n%s; %s. Millions of rays a second, on one thread.\n\n"
        "| scene | rays | Glint | Embree | Glint / Embree | Embree's best way | nodes | leaves "
        "| shapes |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        rays->head, table_text(rays, 0, "date"));
    for (int row = 0; row < rays->row_count; row++) {
        fprintf(file, "| %s | %s |", table_text(rays, row, "scene"), table_text(rays, row, "rays"));
        write_number(file, rays, row, "glint_mray_per_second", 2);
        write_number(file, rays, row, "embree_net_mray_per_second", 2);
        write_number(file, rays, row, "net_ratio", 2);
        fprintf(file, " %s |", table_text(rays, row, "embree_way"));
        write_number(file, rays, row, "nodes_per_ray", 3);
        write_number(file, rays, row, "leaves_per_ray", 3);
        write_number(file, rays, row, "shapes_per_ray", 3);
        fputc('\n', file);
    }
    fputs("\n| scene | primitives | build ms, Glint | Embree | bytes per primitive, Glint | Embree "
          "|\n| --- | --- | --- | --- | --- | --- |\n",
        file);
    for (int row = 0; row < rays->row_count; row++) {
        double count = table_number(rays, row, "primitives");
        double embree = table_number(rays, row, "embree_tree_bytes");
        if (!begins_scene(rays, row)) continue;
        fprintf(file, "| %s | %.0f |", table_text(rays, row, "scene"), count);
        write_number(file, rays, row, "build_ms", 1);
        write_number(file, rays, row, "embree_build_ms", 1);
        fprintf(file, " %.1f |", table_number(rays, row, "tree_bytes") / count);
        if (embree > 0) fprintf(file, " %.1f", embree / count);
        fputs(" |\n", file);
    }
}

static int write_lost_tree(FILE *file, const Table *rays, int row) {
    static const struct {
        const char *ours, *embree, *takes, *what;
    } columns[] = {{"build_ms", "embree_build_ms", "is built in", "time"},
        {"tree_bytes", "embree_tree_bytes", "takes", "memory"}};
    int count = 0;
    for (size_t i = 0; i < sizeof columns / sizeof columns[0]; i++) {
        double ours = table_number(rays, row, columns[i].ours);
        double embree = table_number(rays, row, columns[i].embree);
        if (embree == 0 || embree >= ours) continue;
        fprintf(file, "* %s: the tree of Embree %s %.2f of the %s.\n",
            table_text(rays, row, "scene"), columns[i].takes, embree / ours, columns[i].what);
        count++;
    }
    return count;
}

int page_rays_losses(FILE *file, const Table *rays) {
    int count = 0;
    for (int row = 0; row < rays->row_count; row++) {
        if (begins_scene(rays, row)) count += write_lost_tree(file, rays, row);
        double ratio = table_number(rays, row, "net_ratio");
        if (ratio == 0 || ratio >= 1) continue;
        fprintf(file, "* %s, %s rays: Embree (%s) traces %.2f times as many.\n",
            table_text(rays, row, "scene"), table_text(rays, row, "rays"),
            table_text(rays, row, "embree_way"), 1 / ratio);
        count++;
    }
    return count;
}
