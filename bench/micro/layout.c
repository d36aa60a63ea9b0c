/* SPDX-License-Identifier: MIT
 *
 * layout.c - the first stage of a pair on one instruction set, by layout: B's pose in A's frame, circles against each
 * other, and the pairs that are left packed into a queue, as the kernels do it (kernels/base). All layouts do the same
 * arithmetic with the same vectors; only how a shape's eight words come into registers differs.
 *
 * The compiler's command line defines NARC_ISA and NARC_SIMD as for the kernels.
 */
#include "layout.h"

#include "simd/simd.h"

enum { BLOCK = 128, FIELDS = 12 };

/* Eight words of a shape in each lane, in the order of struct shape_row. */
struct words {
    vf word[SHAPE_WORDS];
};

#if V_WIDTH == 16
INLINE vf gather(const float *plane, vi index) { return _mm512_i32gather_ps(index, plane, 4); }
INLINE vf gather_some(const float *plane, vi index, vm lanes) {
    return _mm512_mask_i32gather_ps(_mm512_setzero_ps(), lanes, index, plane, 4);
}
#else
INLINE vf gather(const float *plane, vi index) { return _mm256_i32gather_ps(plane, index, 4); }
INLINE vf gather_some(const float *plane, vi index, vm lanes) {
    return _mm256_mask_i32gather_ps(_mm256_setzero_ps(), plane, index, lanes, 4);
}
#endif

INLINE vf load_each(const float *plane, const int32_t *index) {
    float lanes[V_WIDTH];
    for (int k = 0; k < V_WIDTH; k++)
        lanes[k] = plane[(uint32_t)index[k]];
    return v_load(lanes);
}

/* Words 2 to 4, the bounding circle. */
INLINE void load_bound(const struct layout_input *in, enum layout layout, const int32_t *shape, struct words *out) {
    if (layout == ROWS) {
        v_rows(in->rows, sizeof *in->rows, shape, out->word);
        v_rows(&in->rows->bound_radius, sizeof *in->rows, shape, out->word + 4);
        return;
    }
    UNROLL
    for (int w = 2; w < 5; w++)
        out->word[w] = layout == LOADED ? load_each(in->planes[w], shape) : gather(in->planes[w], vi_load(shape));
}

/* The other words, of the lanes that need them; rows have them already. */
INLINE void load_rest(const struct layout_input *in, enum layout layout, const int32_t *shape, vm lanes,
                      struct words *out) {
    static const int rest[] = {0, 1, 5, 6, 7};
    UNROLL
    for (int k = 0; k < 5 && layout != ROWS; k++) {
        const float *plane = in->planes[rest[k]];
        out->word[rest[k]] = layout == LOADED   ? load_each(plane, shape)
                             : layout == MASKED ? gather_some(plane, vi_load(shape), lanes)
                                                : gather(plane, vi_load(shape));
    }
}

/* The vector between two circles' centres in A's frame, squared, and its parts. */
struct between {
    vf x, y, square;
};

INLINE struct between between_of(vf t_x, vf t_y, vf q_c, vf q_s, const vf *a, const vf *b) {
    struct between between;
    between.x = v_sub(v_add(t_x, v_sub(v_mul(q_c, b[0]), v_mul(q_s, b[1]))), a[0]);
    between.y = v_sub(v_add(t_y, v_add(v_mul(q_s, b[0]), v_mul(q_c, b[1]))), a[1]);
    between.square = v_add(v_mul(between.x, between.x), v_mul(between.y, between.y));
    return between;
}

/* The bodies and shapes of a block of pairs, read ahead of the vectors that use them. */
struct indices {
    _Alignas(64) int32_t body_a[BLOCK], body_b[BLOCK], shape_a[BLOCK], shape_b[BLOCK];
};

INLINE void load_indices(const struct layout_input *in, size_t first, int count, struct indices *out) {
    for (int k = 0; k < count; k++) {
        const struct pair pair = in->pairs[first + (size_t)k];
        out->body_a[k] = (int32_t)pair.a;
        out->body_b[k] = (int32_t)pair.b;
        out->shape_a[k] = (int32_t)in->bodies[pair.a].shape;
        out->shape_b[k] = (int32_t)in->bodies[pair.b].shape;
    }
}

/* Pairs between stages: dense, structure of arrays. */
struct queue {
    _Alignas(64) float item[FIELDS][BLOCK + V_WIDTH];
    int count;
};

/* A vector of pairs: k ... of the block that begins at `first`. */
INLINE void run_vector(const struct layout_input *in, enum layout layout, const struct indices *indices, size_t first,
                       int k, struct queue *queue, uint64_t *out_apart, uint64_t *out_deep) {
    const int32_t *shape_a = indices->shape_a + k, *shape_b = indices->shape_b + k;
    const size_t pair = first + (size_t)k;
    struct words a, b;
    vf of_a[4], of_b[4]; /* x, y, cosine, sine */
    v_rows(in->bodies, sizeof *in->bodies, indices->body_a + k, of_a);
    v_rows(in->bodies, sizeof *in->bodies, indices->body_b + k, of_b);
    load_bound(in, layout, shape_a, &a);
    load_bound(in, layout, shape_b, &b);
    const vf d_x = v_sub(of_b[0], of_a[0]), d_y = v_sub(of_b[1], of_a[1]);
    const vf t_x = v_add(v_mul(of_a[2], d_x), v_mul(of_a[3], d_y));
    const vf t_y = v_sub(v_mul(of_a[2], d_y), v_mul(of_a[3], d_x));
    const vf q_c = v_add(v_mul(of_a[2], of_b[2]), v_mul(of_a[3], of_b[3]));
    const vf q_s = v_sub(v_mul(of_a[2], of_b[3]), v_mul(of_a[3], of_b[2]));
    const vf reach = v_add(a.word[4], b.word[4]);
    const struct between bounds = between_of(t_x, t_y, q_c, q_s, a.word + 2, b.word + 2);
    const vm apart = v_lt(v_mul(reach, reach), bounds.square);
    load_rest(in, layout, shape_a, vm_not(apart), &a);
    load_rest(in, layout, shape_b, vm_not(apart), &b);
    const vf core = v_add(a.word[7], b.word[7]);
    const struct between axis = between_of(t_x, t_y, q_c, q_s, a.word + 5, b.word + 5);
    const vm deep = vm_and_not(v_lt(axis.square, v_mul(core, core)), apart), left = vm_not(vm_or(apart, deep));
    const vp packing = vm_packing(left);
    const vf item[FIELDS] = {t_x,  t_y,       q_c,       q_s,       axis.x,    axis.y,
                             core, a.word[0], b.word[0], a.word[1], b.word[1], v_of_bits(vi_set((int32_t)pair))};
    UNROLL
    for (int f = 0; f < FIELDS; f++)
        v_store(queue->item[f] + queue->count, v_pack(packing, item[f]));
    queue->count += __builtin_popcount(vm_bits(left));
    out_apart[pair / 64] |= (uint64_t)vm_bits(apart) << pair % 64;
    out_deep[pair / 64] |= (uint64_t)vm_bits(deep) << pair % 64;
}

INLINE void run(const struct layout_input *in, enum layout layout, uint64_t *out_apart, uint64_t *out_deep) {
    struct indices indices;
    struct queue queue;
    for (size_t first = 0; first < in->pair_count; first += BLOCK) {
        const int count = (int)(in->pair_count - first < BLOCK ? in->pair_count - first : BLOCK);
        load_indices(in, first, count, &indices);
        for (int k = 0; k < count; k += 64)
            out_apart[(first + (size_t)k) / 64] = out_deep[(first + (size_t)k) / 64] = 0;
        queue.count = 0;
        for (int k = 0; k < count; k += V_WIDTH)
            run_vector(in, layout, &indices, first, k, &queue, out_apart, out_deep);
        __asm__ volatile("" : : "r"(&queue) : "memory"); /* here the next stage would read the queue */
    }
}

static void run_rows(const struct layout_input *in, uint64_t *out_apart, uint64_t *out_deep) {
    run(in, ROWS, out_apart, out_deep);
}

static void run_gathered(const struct layout_input *in, uint64_t *out_apart, uint64_t *out_deep) {
    run(in, GATHERED, out_apart, out_deep);
}

static void run_masked(const struct layout_input *in, uint64_t *out_apart, uint64_t *out_deep) {
    run(in, MASKED, out_apart, out_deep);
}

static void run_loaded(const struct layout_input *in, uint64_t *out_apart, uint64_t *out_deep) {
    run(in, LOADED, out_apart, out_deep);
}

#define JOIN_(a, b) a##b
#define JOIN(a, b)  JOIN_(a, b)
layout_stage *const JOIN(layouts_, NARC_ISA)[LAYOUTS] = {run_rows, run_gathered, run_masked, run_loaded};
