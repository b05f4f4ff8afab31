/* SPDX-License-Identifier: MIT */
#include "rays_report.h"

#include <math.h>

/* Hits that may differ, of all rays: edges are met or not by rounding alone. */
#define DIFFERENCE_LIMIT 1e-4

static double rate(const RaysKindResult *result, double seconds) {
    return seconds > 0 ? 1e-6 * (double)result->ray_count / seconds : 0;
}

static double net_seconds(const RaysKindResult *result) {
    return result->embree.median - result->harness.median;
}

static double difference(const RaysKindResult *result) {
    return ((double)result->embree_hit_count - (double)result->hit_count) /
           (double)result->ray_count;
}

void rays_report_head(void) {
    printf("\nMray/s on one thread; gross: with what the harness costs Embree, net: without it\n");
    printf(
        "nodes, leaves, shapes: how many of each are tested for a ray; a bundle counts once\n\n");
    printf("%-16s %-7s %9s %8s %8s %8s %8s %7s %7s  %-15s %6s %8s %8s %8s %8s\n", "scene", "rays",
        "count", "glint", "single", "Embree", "net", "ratio", "net", "best way", "hits", "differ",
        "nodes", "leaves", "shapes");
}

static double each(const RaysKindResult *result, double count) {
    return count / (double)result->ray_count;
}

static void print_counts(const RaysKindResult *result) {
    const RaysCounts *counts = &result->counts;
    printf(" %8.3f %8.3f %8.3f", each(result, counts->nodes), each(result, counts->leaves),
        each(result, counts->shapes));
}

static bool print_kind(const RaysResult *scene, RayKind kind) {
    const RaysKindResult *result = &scene->kinds[kind];
    if (result->ray_count == 0) return true;
    double hits = (double)result->hit_count / (double)result->ray_count;
    printf("%-16s %-7s %9zu %8.2f %8.2f", scene->name, rays_kind_name(kind), result->ray_count,
        rate(result, result->together.median), rate(result, result->single.median));
    bool agree = result->counts.hit_count == result->hit_count;
    if (scene->has_embree) {
        agree = agree && fabs(difference(result)) <= DIFFERENCE_LIMIT;
        printf(" %8.2f %8.2f %7.2f %7.2f  %-15s %5.1f%% %+4.0f ppm",
            rate(result, result->embree.median), rate(result, net_seconds(result)),
            result->embree.median / result->together.median,
            net_seconds(result) / result->together.median, result->way, 100 * hits,
            1e6 * difference(result));
    } else {
        printf(" %8s %8s %7s %7s  %-15s %5.1f%% %8s", "-", "-", "-", "-", "-", 100 * hits, "-");
    }
    print_counts(result);
    puts(agree ? "" : "  HITS DIFFER");
    return agree;
}

int rays_report(const RaysResult *result) {
    int fault_count = 0;
    for (int kind = 0; kind < RAY_KIND_COUNT; kind++) {
        fault_count += !print_kind(result, (RayKind)kind);
    }
    double primitives = (double)result->primitive_count;
    printf("%-16s %-7s %9zu %.1f ms, %.1f bytes per primitive", "", "tree", result->primitive_count,
        1e3 * result->build_seconds, result->tree_bytes / primitives);
    if (result->has_embree) {
        printf("; Embree %.1f ms, %.1f bytes (%s)", 1e3 * result->embree_build_seconds,
            result->embree_tree_bytes / primitives, result->tree);
    } else if (result->no_embree[0] != '\0') {
        printf("; not for Embree: %s", result->no_embree);
    }
    printf("\n");
    fflush(stdout);
    return fault_count;
}

void rays_report_csv_head(FILE *file) {
    fputs("scene,primitives,rays,count,hits,embree_hits,glint_mray_per_second,"
          "glint_single_mray_per_second,embree_mray_per_second,embree_net_mray_per_second,"
          "embree_way,ratio,net_ratio,build_ms,tree_bytes,embree_build_ms,embree_tree_bytes,"
          "nodes_per_ray,leaves_per_ray,shapes_per_ray,date\n",
        file);
}

void rays_report_csv(const RaysResult *scene, const char *date, FILE *file) {
    for (int kind = 0; kind < RAY_KIND_COUNT; kind++) {
        const RaysKindResult *result = &scene->kinds[kind];
        if (result->ray_count == 0) continue;
        fprintf(file, "%s,%zu,%s,%zu,%zu,", scene->name, scene->primitive_count,
            rays_kind_name((RayKind)kind), result->ray_count, result->hit_count);
        if (scene->has_embree) fprintf(file, "%zu", result->embree_hit_count);
        fprintf(file, ",%.3f,%.3f,", rate(result, result->together.median),
            rate(result, result->single.median));
        if (scene->has_embree) {
            fprintf(file, "%.3f,%.3f,%s,%.3f,%.3f,", rate(result, result->embree.median),
                rate(result, net_seconds(result)), result->way,
                result->embree.median / result->together.median,
                net_seconds(result) / result->together.median);
        } else {
            fputs(",,,,,", file);
        }
        fprintf(file, "%.3f,%.0f,", 1e3 * scene->build_seconds, scene->tree_bytes);
        if (scene->has_embree) {
            fprintf(file, "%.3f,%.0f", 1e3 * scene->embree_build_seconds, scene->embree_tree_bytes);
        } else {
            fputs(",", file);
        }
        fprintf(file, ",%.4f,%.4f,%.4f,%s\n", each(result, result->counts.nodes),
            each(result, result->counts.leaves), each(result, result->counts.shapes), date);
    }
}
