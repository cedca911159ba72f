/* mpm.h - the material point method in one header: 3D explicit MUSL with contact.
   Version 0.2.0. SPDX-License-Identifier: MIT

   DO THIS
     In ONE source file:                          everywhere else:
       #define MPM_IMPLEMENTATION                   #include "mpm.h"
       #include "mpm.h"
     Describe the grid (mpm_desc), give it memory (mpm_init), fill bodies (mpm_body_add), then
     call the phases of the step in a loop - they are listed, in order, in mpm_step below.
     Link with -lm.

   WHAT IT DOES NOT DO
     No heat conduction, no fracture, no oxide film, no implicit time integration, no threads,
     no adaptive grid. It never prints, exits or aborts: every routine that can fail returns an mpm_status and
     leaves the reason in an mpm_fault. It allocates only where it was given no memory: in mpm_init, when bodies,
     points, rules or fields are added, and in mpm_locate when the bodies spread over more nodes than there is room for.

   A COMPLETE PROGRAM
       #define MPM_IMPLEMENTATION
       #include "mpm.h"
       int main(void) {
           mpm_world w;
           mpm_body_desc b = mpm_body_desc_default();
           mpm_desc d = mpm_desc_default();
           d.cell = 0.1; d.cells[0] = d.cells[1] = d.cells[2] = 10;
           b.shape = mpm_sphere(0.5, 0.5, 0.5, 0.2); b.spacing = 0.05; b.density = 1000; b.velocity[2] = 1;
           if (mpm_init(&w, &d, NULL, 0) != MPM_OK) return 1;
           if (mpm_body_add(&w, &b) != MPM_OK) return 1;
           while (w.time < 0.1)
               if (mpm_step(&w, 0.001) < 0) return 1;
           mpm_free(&w);
           return 0;
       }

   CONTENTS
     status, tools, units      mpm_status, mpm_fault; mpm_sqrt .. mpm_rotate, mpm_want, mpm_carve; mpm_units_*
     describing                mpm_block and mpm_stress_fn; lists of choices; mpm_shape; mpm_contact; mpm_desc
     points, bodies, grid      mpm_points, mpm_body, mpm_node, mpm_run, mpm_pair, mpm_ledger, mpm_world
     setting up                mpm_init, mpm_body_add, mpm_body_add_points, mpm_contact_set, mpm_field_take
     the step                  mpm_step = locate, calm, p2g, forces, grid_update, contact_find, contact_apply, g2p,
                               musl, stress, move; two in one sweep: mpm_to_nodes, _to_points, _stress_and_move
     between the phases        mpm_support_of, mpm_support_at, mpm_push, mpm_node_push, mpm_pair_push: for extensions
     looking at it, restart    mpm_body_totals; mpm_blobs, mpm_restored
     implementation            in the order of the step; then locate, memory, shapes, bodies, checks

   CONFIGURATION (define before including)
     MPM_FLOAT            GLOBAL  mpm_real is float. Public symbols then end in _f32, so that
                                  units compiled differently fail to link instead of misbehaving.
     MPM_STATIC           IMPL    every function is static inline; implies MPM_IMPLEMENTATION.
     MPM_COMPILED         GLOBAL  mpm.c is compiled and linked in: MPM_IMPLEMENTATION is ignored, so that a
                                  program of one file is compiled faster, without a change.
     MPM_MALLOC(n), MPM_FREE(p)  IMPL  used only where the caller passes NULL for memory.
     MPM_BLOCK            IMPL    points per constitutive block (1 .. 1024; 64), and most points that a sweep or a
                                  material treats together. 8 is right for small machines: the same bits, a
                                  tenth slower, frames of 5 KiB (float, -Os) instead of 15.
     MPM_NO_INLINE        IMPL    the kernels are not inlined by force: slower, but quick to compile.
     MPM_NO_WIDE          IMPL    no vector types of gcc and clang: slower, the same bits.
     MPM_FINITE_MATH      GLOBAL  compile in spite of -ffinite-math-only, which -ffast-math and -Ofast
                                  bring: values that are not numbers then go unnoticed.

   CONVENTIONS
     Units        any consistent system. um, us, ng is the natural one for cold spray: then stress
                  is MPa, velocity m/s, energy pJ, energy per area J/m^2. Temperature in K.
     Axes         x = 0, y = 1, z = 2. In two dimensions the plane is x-z and y is out of it: the
                  thickness direction in plane strain, the hoop direction in axisymmetry (x = r).
     Tensors      symmetric: xx yy zz yz xz xy (tensor components, never engineering shear).
     Stress       Cauchy, tension positive. Pressure p = -tr(stress)/3, compression positive.
     Rotation     increments are vectors about x, y, z: w_x = (dv_z/dy - dv_y/dz) dt / 2.
     Time         velocities at t^k; the step takes points from t^k to t^(k+1).
     Order        bodies are numbered as added; the last one leads ranked contact normals, so add
                  the substrate last. Points of one body are contiguous and kept in cell order.

   WORDS
     point        a piece of material that carries all its state; many make a body.
     node         a corner of the grid's cells. Nodes are emptied and filled anew in every step.
     slot         a node as one body sees it: world.node[slot]. Several bodies at a node have a slot each, in a
                  chain from world.head.
     pair         two slots of one node, so two bodies that meet there.
     touch        what a slot carries besides where bodies meet, or meet a wall.
     base         the lowest node that a point touches.
     run          consecutive points of a body with the same base; they share their nodes.
     span, part   up to MPM_BLOCK points of a body, swept together; a part of them lies in one run.
     piece        up to MPM_BLOCK points of a run, where runs are swept one by one.
     block        a span handed to the body's material.
     mirror       a symmetry plane: nodes behind it are images of those before it.
     ghost        with GIMP and splines, the layer of nodes around the grid that points near its sides reach.

   Equation numbers "A n" are those of source A: the thesis this library reproduces (README; docs/source_a.md). */
#ifndef MPM_H
#define MPM_H

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* The version; mpm_version() is that of the library that was linked. */
#define MPM_VERSION_MAJOR 0
#define MPM_VERSION_MINOR 2
#define MPM_VERSION_PATCH 0
#define MPM_VERSION_NUMBER 200 /* 10000 major + 100 minor + patch: what the other headers compare */
#define MPM_VERSION "0.2.0"

#if ((defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || defined(_M_FP_FAST)) && !defined(MPM_FINITE_MATH)
#error "mpm.h checks for NaN and uses infinity: add -fno-finite-math-only (/fp:precise), or define MPM_FINITE_MATH"
#endif

/* The number type, literals of it, and the distance from 1 to the next of its numbers. */
#ifdef MPM_FLOAT
typedef float mpm_real;
#define MPM_R(x) x##f
#define MPM_EPSILON 1.1920929e-7f
#define MPM_DIGITS 9            /* decimal digits that bring every mpm_real back exactly */
#else
typedef double mpm_real;
#define MPM_R(x) x
#define MPM_EPSILON 2.2204460492503131e-16
#define MPM_DIGITS 17
#endif

/* What stands before every function of the library. */
#ifdef MPM_STATIC
#ifndef MPM_IMPLEMENTATION
#define MPM_IMPLEMENTATION
#endif
#define MPM_API static inline
#else
#define MPM_API extern
#endif

#ifdef MPM_FLOAT /* other types, other names: mixed units must not link */
#define mpm_sphere mpm_sphere_f32
#define mpm_ellipsoid mpm_ellipsoid_f32
#define mpm_cylinder mpm_cylinder_f32
#define mpm_box mpm_box_f32
#define mpm_shape_contains mpm_shape_contains_f32
#define mpm_desc_default mpm_desc_default_f32
#define mpm_body_desc_default mpm_body_desc_default_f32
#define mpm_shape_count mpm_shape_count_f32
#define mpm_desc_check mpm_desc_check_f32
#define mpm_bytes mpm_bytes_f32
#define mpm_init mpm_init_f32
#define mpm_free mpm_free_f32
#define mpm_body_add mpm_body_add_f32
#define mpm_reserve mpm_reserve_f32
#define mpm_reserve_bytes mpm_reserve_bytes_f32
#define mpm_wave_speed_p mpm_wave_speed_p_f32
#define mpm_wave_speed_s mpm_wave_speed_s_f32
#define mpm_time_step mpm_time_step_f32
#define mpm_step mpm_step_f32
#define mpm_to_nodes mpm_to_nodes_f32
#define mpm_to_points mpm_to_points_f32
#define mpm_stress_and_move mpm_stress_and_move_f32
#define mpm_locate mpm_locate_f32
#define mpm_calm mpm_calm_f32
#define mpm_p2g mpm_p2g_f32
#define mpm_forces mpm_forces_f32
#define mpm_grid_update mpm_grid_update_f32
#define mpm_contact_find mpm_contact_find_f32
#define mpm_contact_apply mpm_contact_apply_f32
#define mpm_g2p mpm_g2p_f32
#define mpm_musl mpm_musl_f32
#define mpm_stress mpm_stress_f32
#define mpm_move mpm_move_f32
#define mpm_shape_user mpm_shape_user_f32
#define mpm_contact_check mpm_contact_check_f32
#define mpm_body_add_points mpm_body_add_points_f32
#define mpm_points_add mpm_points_add_f32
#define mpm_point_take mpm_point_take_f32
#define mpm_contact_set mpm_contact_set_f32
#define mpm_contact_of mpm_contact_of_f32
#define mpm_field_take mpm_field_take_f32
#define mpm_support_of mpm_support_of_f32
#define mpm_support_at mpm_support_at_f32
#define mpm_support_velocity mpm_support_velocity_f32
#define mpm_support_mapped mpm_support_mapped_f32
#define mpm_support_work mpm_support_work_f32
#define mpm_push mpm_push_f32
#define mpm_node_push mpm_node_push_f32
#define mpm_node_find mpm_node_find_f32
#define mpm_node_position mpm_node_position_f32
#define mpm_pair_stick mpm_pair_stick_f32
#define mpm_pair_area mpm_pair_area_f32
#define mpm_pair_push mpm_pair_push_f32
#define mpm_body_totals mpm_body_totals_f32
#define mpm_bytes_used mpm_bytes_used_f32
#define mpm_blobs mpm_blobs_f32
#define mpm_restored mpm_restored_f32
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- status and faults --------------------------------------------------------------------- */

/* Every status, its number and its meaning. 0: done. Negative: failed, the state is as it was
   unless the routine says otherwise. Positive: done, with something worth knowing. */
#define MPM_STATUS_LIST(X)                                                              \
    X(MPM_OK, 0, "done")                                                                \
    X(MPM_ERR_ARGUMENT, -1, "an argument is out of its valid range")                    \
    X(MPM_ERR_NAN, -2, "a value is not a finite number")                                \
    X(MPM_ERR_MEMORY, -3, "not enough memory was given or could be had")                \
    X(MPM_ERR_FULL, -4, "a capacity is exhausted")                                      \
    X(MPM_ERR_OVERLAP, -5, "two bodies overlap")                                        \
    X(MPM_ERR_OUTSIDE, -6, "something lies outside the grid")                           \
    X(MPM_ERR_UNKNOWN, -7, "a name is not known")                                       \
    X(MPM_ERR_FILE, -8, "a file could not be written or read")                          \
    X(MPM_ERR_STATE, -9, "a point has left the range of its model")                     \
    X(MPM_ERR_VERSION, -10, "a file is of another version, real type or description")   \
    X(MPM_CLAMPED, 1, "a value was limited to its valid range")                         \
    X(MPM_NOT_CONVERGED, 2, "an iteration reached its limit; the last value is usable") \
    X(MPM_RETIRED, 3, "points left the grid and were retired")                          \
    X(MPM_UNSTABLE, 4, "the step is longer than the fastest wave takes through a cell")

typedef enum mpm_status {
#define MPM__STATUS_ENUM(name, number, text) name = number,
    MPM_STATUS_LIST(MPM__STATUS_ENUM)
#undef MPM__STATUS_ENUM
    MPM_STATUS_LAST = 5
} mpm_status;

/* The first thing that went wrong, so that a message can name it. `field` is a text that stays. */
typedef struct mpm_fault {
    mpm_status status;
    const char *field;  /* what was wrong: "cell", "density of point", ... */
    mpm_real value;     /* the offending value */
    int64_t index;      /* point, body or axis it belongs to; -1 for none */
} mpm_fault;

/* ---- tools --------------------------------------------------------------------------------- */

/* What the headers share, for your own laws too: static inline, free to use. */

#define MPM_MARK 0x6d706d32u /* what a _default function leaves in `mark`: a zeroed description is told by it */

#define MPM_PI MPM_R(3.14159265358979323846) /* pi */
#define MPM_ALIGN 64 /* bytes: of what mpm_carve hands out */

/* For functions that must be inlined to be fast: into loops that are to be done several points at a time, or, with
   constants for arguments, into specialised code. */
#if (defined(__GNUC__) || defined(__clang__)) && !defined(MPM_NO_INLINE)
#define MPM_KERNEL static inline __attribute__((always_inline))
#else
#define MPM_KERNEL static inline
#endif

/* mpm_sqrt(x), mpm_exp(x), ...: libm in mpm_real. */
#define MPM_MATH_LIST(X) X(sqrt) X(cbrt) X(exp) X(expm1) X(log) X(erf) X(tanh) X(fabs)
#ifdef MPM_FLOAT
#define MPM__MATH(name) static inline mpm_real mpm_##name(mpm_real x) { return name##f(x); }
static inline mpm_real mpm_pow(mpm_real x, mpm_real y) { return powf(x, y); }
#else
#define MPM__MATH(name) static inline mpm_real mpm_##name(mpm_real x) { return name(x); }
static inline mpm_real mpm_pow(mpm_real x, mpm_real y) { return pow(x, y); }
#endif
MPM_MATH_LIST(MPM__MATH)
#undef MPM__MATH

/* Turns a symmetric tensor s, xx yy zz yz xz xy, as a step turns the material: by w, a point's rotation increment about
   x, y, z [rad] (mpm_block.spin). The turning part of an objective rate, for laws that keep a stress: turn the old one,
   then add what the strain increment asks for. s <- R s R^T with R of Hughes and Winget (Int. J. Numer. Methods Eng. 15
   (1980) 1862): R = I + u (H + H^2), H v = h x v, h = w/2, u = 2/(1 + h.h), by the angle 2 atan(|w|/2). R is
   orthogonal for any w, so invariants are kept to rounding. Test: 20_method. */
MPM_KERNEL void mpm_rotate(const mpm_real w[3], mpm_real s[6])
{
    const mpm_real x = w[0] / 2, y = w[1] / 2, z = w[2] / 2, u = 2 / (1 + x * x + y * y + z * z);
    const mpm_real r00 = 1 - u * (y * y + z * z), r01 = u * (x * y - z), r02 = u * (x * z + y);
    const mpm_real r10 = u * (x * y + z), r11 = 1 - u * (x * x + z * z), r12 = u * (y * z - x);
    const mpm_real r20 = u * (x * z - y), r21 = u * (y * z + x), r22 = 1 - u * (x * x + y * y);
    const mpm_real m00 = r00 * s[0] + r01 * s[5] + r02 * s[4], m01 = r00 * s[5] + r01 * s[1] + r02 * s[3];
    const mpm_real m02 = r00 * s[4] + r01 * s[3] + r02 * s[2], m10 = r10 * s[0] + r11 * s[5] + r12 * s[4];
    const mpm_real m11 = r10 * s[5] + r11 * s[1] + r12 * s[3], m12 = r10 * s[4] + r11 * s[3] + r12 * s[2];
    const mpm_real m20 = r20 * s[0] + r21 * s[5] + r22 * s[4], m21 = r20 * s[5] + r21 * s[1] + r22 * s[3];
    const mpm_real m22 = r20 * s[4] + r21 * s[3] + r22 * s[2];
    s[0] = m00 * r00 + m01 * r01 + m02 * r02;
    s[1] = m10 * r10 + m11 * r11 + m12 * r12;
    s[2] = m20 * r20 + m21 * r21 + m22 * r22;
    s[3] = m10 * r20 + m11 * r21 + m12 * r22;
    s[4] = m00 * r20 + m01 * r21 + m02 * r22;
    s[5] = m00 * r10 + m01 * r11 + m02 * r12;
}

/* Finite, told without C99 macros that C++ hides: both comparisons fail for NaN. */
static inline int mpm_finite(mpm_real x)
{
#ifdef MPM_FLOAT
    return x >= -FLT_MAX && x <= FLT_MAX;
#else
    return x >= -DBL_MAX && x <= DBL_MAX;
#endif
}

/* Notes a fault, if the caller wants one, and hands its status on. */
static inline mpm_status mpm_fail(mpm_fault *f, mpm_status s, const char *field, mpm_real value, int64_t index)
{
    if (f) {
        f->status = s;
        f->field = field;
        f->value = value;
        f->index = index;
    }
    return s;
}

/* MPM_OK if `ok` and the value is finite; else a fault that names the field: MPM_ERR_ARGUMENT or MPM_ERR_NAN. */
static inline mpm_status mpm_want(int ok, mpm_fault *f, const char *field, mpm_real value, int64_t index)
{
    if (!mpm_finite(value)) return mpm_fail(f, MPM_ERR_NAN, field, value, index);
    return ok ? MPM_OK : mpm_fail(f, MPM_ERR_ARGUMENT, field, value, index);
}

/* Sizes that stick at the top instead of wrapping around. */
static inline size_t mpm_size_add(size_t a, size_t b) { return a > (size_t)-1 - b ? (size_t)-1 : a + b; }
static inline size_t mpm_size_mul(size_t a, size_t b) { return b && a > (size_t)-1 / b ? (size_t)-1 : a * b; }

/* Takes n items of `size` bytes from a block, aligned; with base == NULL it only counts them into `used`. */
static inline void *mpm_carve(char *base, size_t *used, size_t n, size_t size)
{
    size_t at = mpm_size_add(*used, MPM_ALIGN - 1) / MPM_ALIGN * MPM_ALIGN;
    *used = mpm_size_add(at, mpm_size_mul(n, size));
    return base ? base + at : NULL;
}

/* 0 if memory begins where any of our arrays may, at a multiple of what numbers, counters and pointers ask for, as
   malloc's does; else how many bytes beside. Test: 21_world. */
struct mpm_widest {
    char first;
    union { double real; int64_t count; void *pointer; } value;
};
static inline int mpm_unaligned(const void *memory)
{
    return (int)((uintptr_t)memory % offsetof(struct mpm_widest, value));
}

/* Copies text to the end of buffer[n], which holds `used` characters, cut to fit and always terminated when n > 0.
   Returns the new length. */
static inline size_t mpm_append(char *buffer, size_t n, size_t used, const char *text)
{
    size_t i;
    for (i = 0; used + 1 < n && text[i]; i++) buffer[used++] = text[i];
    if (n) buffer[used] = 0;
    return used;
}

/* A named stretch of memory: of such the state of a world or a spray is made, and yours, for a checkpoint (mpm_io.h).
   Its bits are stored as they are; pointers among them must be set again after reading. */
typedef struct mpm_blob {
    const char *name; /* shorter than 64 bytes */
    void *data;       /* read from when storing, written to when reading */
    size_t bytes;     /* to be stored; after reading, those that were */
    size_t room;      /* the most that may be read; 0: exactly `bytes` */
} mpm_blob;

/* One of fixed size, and one of `count` items of `size` bytes where there is room for `room` items.
   Test: 40_io "checkpoint". */
static inline mpm_blob mpm_blob_of(const char *name, void *data, size_t bytes)
{
    mpm_blob b;
    b.name = name;
    b.data = data;
    b.bytes = bytes;
    b.room = 0;
    return b;
}

/* The second of them. Test: 40_io "checkpoint". */
static inline mpm_blob mpm_blob_array(const char *name, void *data, size_t count, size_t room, size_t size)
{
    mpm_blob b = mpm_blob_of(name, data, count * size);
    b.room = room * size;
    return b;
}

/* ---- units --------------------------------------------------------------------------------- */

/* A consistent unit system: the SI value of one unit of each base quantity. Temperature is K. */
typedef struct mpm_units {
    double length;  /* m per length unit */
    double mass;    /* kg per mass unit */
    double time;    /* s per time unit */
} mpm_units;

/* Systems ready made. Test: 21_world. */
MPM_API mpm_units mpm_units_si(void);         /* m, kg, s */
MPM_API mpm_units mpm_units_um_us_ng(void);   /* um, us, ng = 1e-12 kg: stress in MPa, velocity in m/s */
MPM_API mpm_units mpm_units_mm_ms_g(void);    /* mm, ms, g: stress in MPa, velocity in m/s */

/* The SI value of one unit of a derived quantity: divide an SI number by it to enter the system. Test: 21_world. */
MPM_API double mpm_units_velocity(const mpm_units *u);        /* m/s */
MPM_API double mpm_units_density(const mpm_units *u);         /* kg/m^3 */
MPM_API double mpm_units_stress(const mpm_units *u);          /* Pa */
MPM_API double mpm_units_energy(const mpm_units *u);          /* J */
MPM_API double mpm_units_specific_energy(const mpm_units *u); /* J/kg */
MPM_API double mpm_units_area_energy(const mpm_units *u);     /* J/m^2 */

/* ---- the constitutive block ---------------------------------------------------------------- */

#define MPM_USER_FIELDS 8 /* most user fields a point can have */

/* What a material sees: `count` consecutive points of one body, as plain arrays. The strain
   increment and the rotation increment are those of the step k -> k+1 and the density is already
   that of k+1; everything else is the state at k, to be brought to k+1 in place. */
typedef struct mpm_block {
    int count;                    /* points, 1 .. MPM_BLOCK */
    mpm_real dt;                  /* step [time] */
    mpm_real cell;                /* grid cell edge [length], for bulk viscosity and regularisation */
    const mpm_real *strain[6];    /* strain increment, xx yy zz yz xz xy (tensor components) */
    const mpm_real *spin[3];      /* rotation increment about x, y, z [rad] */
    const mpm_real *density;      /* at k+1 [mass/length^3] */
    mpm_real *stress[6];          /* Cauchy stress, tension positive */
    mpm_real *energy;             /* internal energy per mass */
    mpm_real *temperature;        /* [K] */
    mpm_real *plastic_strain;     /* effective plastic strain */
    mpm_real *plastic_rate;       /* effective plastic strain rate of this step [1/time] */
    mpm_real *plastic_work;       /* integral of flow stress d(plastic strain) [stress] (A 4.15) */
    mpm_real *user[MPM_USER_FIELDS]; /* the points' user fields, for a law's own history; NULL beyond
                                     user_fields of the description. Test: 24_manufactured */
    int64_t *tally;               /* counters of the world, for what a law wants counted: see MPM_TALLIES */
    mpm_fault *fault;             /* filled by the material when it fails; index within the block */
} mpm_block;

/* Counters in the world that laws may use, so that materials and bonds stay const in a step: 0 .. 3 belong to
   mpm_ptw.h, 4 .. 7 to mpm_bond.h, the others to your own. */
#define MPM_TALLIES 16

/* A constitutive update: material points to the caller's parameters. Returns a status; a negative
   one stops the step, a positive one is counted in world.notices. Old stress is not turned yet: mpm_rotate does it.
   examples/09_shear.c is one. */
typedef mpm_status (*mpm_stress_fn)(const void *material, const mpm_block *block);

/* ---- lists --------------------------------------------------------------------------------- */

/* Each choice stands once, as X(constant, "word", "meaning"): the enum, the checks and the option lists of the
   programs are made from it. MPM_NAMES(MPM_BASIS_LIST) is "linear|gimp|quadratic|cubic". */
#define MPM_LIST_ENUM(name, word, text) name,
#define MPM__NAME_BAR(name, word, text) "|" word
#define MPM_NAMES(LIST) (&("" LIST(MPM__NAME_BAR))[1])

/* What the grid and the points are in space. */
#define MPM_GEOMETRY_LIST(X)                                                     \
    X(MPM_3D, "3d", "three dimensions")                                          \
    X(MPM_PLANE_STRAIN, "plane", "the plane x-z, per unit depth in y")           \
    X(MPM_AXISYMMETRIC, "axisymmetric", "rings about z: x is the radius")

/* The functions between points and nodes. */
#define MPM_BASIS_LIST(X)                                                        \
    X(MPM_LINEAR, "linear", "trilinear hexahedra, the thesis's (A 3.20)")        \
    X(MPM_GIMP, "gimp", "uGIMP, Bardenhagen and Kober 2004: points are boxes of fixed size") \
    X(MPM_QUADRATIC, "quadratic", "quadratic B-splines, Steffen, Kirby and Berzins 2008") \
    X(MPM_CUBIC, "cubic", "cubic B-splines, the same: twice continuously differentiable")

/* What happens at a side of the grid. */
#define MPM_SIDE_LIST(X)                                                         \
    X(MPM_SIDE_OPEN, "open", "nothing; points that cross it are retired")        \
    X(MPM_SIDE_SYMMETRY, "symmetry", "no motion through it: a symmetry or sliding plane") \
    X(MPM_SIDE_FIXED, "fixed", "no motion at all")                               \
    X(MPM_SIDE_WALL, "wall", "a rigid wall: no motion into it, free to leave, Coulomb friction")

/* How two bodies act on each other at a node that carries both. */
#define MPM_CONTACT_LIST(X)                                                      \
    X(MPM_CONTACT_FRICTION, "friction", "approaching: equal normal velocity, Coulomb friction (0: frictionless)") \
    X(MPM_CONTACT_STICK, "stick", "approaching: equal velocity (A 3.31); separating: free") \
    X(MPM_CONTACT_WELD, "weld", "always equal velocity: one velocity field, as in MPM without contact") \
    X(MPM_CONTACT_NONE, "none", "bodies pass through each other")                \
    X(MPM_CONTACT_USER, "user", "a law of your own: mpm_contact.fn")

/* Where the contact normal of a pair of bodies comes from. All are collinear: n_i = -n_j. "ranked" and "vertical" go by
   the numbers of the bodies: with them the order of mpm_body_add is part of the scene (a substrate comes last). The
   others treat both bodies alike: in the consistent scheme nothing but round-off depends on the order. (In the thesis's
   it does: pairs come one after the other, and of two equal gradients "mvg" takes the higher-numbered body's; in the
   consistent scheme their difference, as "average".) Test: 27_schemes. */
#define MPM_NORMAL_LIST(X)                                                       \
    X(MPM_NORMAL_RANKED, "ranked", "of the higher-numbered body; of the other where that vanishes") \
    X(MPM_NORMAL_MVG, "mvg", "of the body with the larger volume gradient")      \
    X(MPM_NORMAL_AVERAGE, "average", "of the difference of the two volume gradients") \
    X(MPM_NORMAL_FIXED, "vertical", "along z: of two bodies the higher-numbered lies below") \
    X(MPM_NORMAL_LOGISTIC, "logistic", "of the plane that parts their points best (Nairn, Hammerquist, Smith 2020)")

/* When contact and walls act in a step. The consistent scheme takes approach out of the grid at all three levels of
   velocity, and gives the points only what the new forces ask for: a rebound is never faster than the impact. The
   thesis's gives them all that stands in P(k+1) and strains with what MUSL maps back: simple, with energy to spare. */
#define MPM_SCHEME_LIST(X)                                                       \
    X(MPM_SCHEME_CONSISTENT, "consistent", "on P(k), P(k+1) and MUSL's velocities, all bodies of a node together") \
    X(MPM_SCHEME_THESIS, "thesis", "on P(k+1) alone, one pair after the other (A 3.31)")

typedef enum mpm_geometry { MPM_GEOMETRY_LIST(MPM_LIST_ENUM) MPM_GEOMETRIES } mpm_geometry;
typedef enum mpm_basis { MPM_BASIS_LIST(MPM_LIST_ENUM) MPM_BASES } mpm_basis;
typedef enum mpm_side { MPM_SIDE_LIST(MPM_LIST_ENUM) MPM_SIDE_KINDS } mpm_side;
typedef enum mpm_contact_law { MPM_CONTACT_LIST(MPM_LIST_ENUM) MPM_CONTACT_LAWS } mpm_contact_law;
typedef enum mpm_scheme { MPM_SCHEME_LIST(MPM_LIST_ENUM) MPM_SCHEMES } mpm_scheme;
typedef enum mpm_normal_rule { MPM_NORMAL_LIST(MPM_LIST_ENUM) MPM_NORMAL_RULES } mpm_normal_rule;

/* ---- shapes -------------------------------------------------------------------------------- */

/* What a shape is; the functions below make them. */
typedef enum mpm_shape_kind {
    MPM_SHAPE_NONE = 0,   /* bodies made from points */
    MPM_SHAPE_ELLIPSOID,  /* a sphere if the three half axes are equal */
    MPM_SHAPE_CYLINDER,   /* axis along z */
    MPM_SHAPE_BOX,
    MPM_SHAPE_USER        /* a function that says what is inside */
} mpm_shape_kind;

/* Whether x lies inside a shape of your own; in two dimensions x[1] is 0. */
typedef int (*mpm_inside_fn)(void *context, const mpm_real x[3]);

/* A solid given by its centre and half extents [length]. In two dimensions its x-z section. */
typedef struct mpm_shape {
    mpm_shape_kind kind;
    mpm_real center[3];
    mpm_real half[3];
    mpm_inside_fn inside; /* of MPM_SHAPE_USER: asked within centre +- half */
    void *context;        /* passed to it */
} mpm_shape;

/* Shapes from centre and half axes, or from corners [length]. Nothing is checked here: mpm_body_add
   refuses what is not positive or not finite. Test: 21_world. */
MPM_API mpm_shape mpm_sphere(mpm_real x, mpm_real y, mpm_real z, mpm_real radius);
MPM_API mpm_shape mpm_ellipsoid(mpm_real x, mpm_real y, mpm_real z, mpm_real a, mpm_real b, mpm_real c);
MPM_API mpm_shape mpm_cylinder(mpm_real x, mpm_real y, mpm_real z_bottom, mpm_real radius, mpm_real height);
MPM_API mpm_shape mpm_box(mpm_real x0, mpm_real y0, mpm_real z0, mpm_real x1, mpm_real y1, mpm_real z1);

/* A shape of your own: what of the box low .. high `inside` says yes to, on the box's lattice. It has a surface
   layer like the others, and no faces for dampers. Test: 26_extend. */
MPM_API mpm_shape mpm_shape_user(mpm_inside_fn inside, void *context, const mpm_real low[3], const mpm_real high[3]);

/* 1 if the point (x, y, z) lies inside the shape, else 0. Test: 21_world. */
MPM_API int mpm_shape_contains(const mpm_shape *s, mpm_real x, mpm_real y, mpm_real z);

/* ---- contact rules ------------------------------------------------------------------------- */

struct mpm_world;
struct mpm_pair;

/* A contact law of your own: asked for each pair of bodies at each node that carries both, once in a step,
   between mpm_contact_find and the return to the points. All that is known of the pair is in *p: the slots of
   its nodes (w->node[p->a], p->b) with mass and momentum at k+1, normal, separation, hold, limit. Writes to j the
   momentum that a shall gain and b lose, and returns 1; or returns 0 for none. It acts on P(k+1) alone in either
   scheme: what it does along the normal has the energy errors of the thesis's. For a law along the surface only, leave
   MPM_CONTACT_FRICTION with friction 0 to settle the normal, and give yours by mpm_pair_push between
   mpm_contact_apply and mpm_g2p. Test: 26_extend. */
typedef int (*mpm_contact_fn)(void *context, const struct mpm_world *w, const struct mpm_pair *p, mpm_real j[3]);

/* How two bodies meet. */
typedef struct mpm_contact {
    mpm_contact_law law;
    mpm_normal_rule normal;
    mpm_real friction;  /* Coulomb coefficient, >= 0 */
    mpm_real cutoff;    /* a node has contact where both bodies weigh more than this share of a point
                           there. Below it a point that barely reaches the node would push with its
                           whole stress, which MUSL never lets it relieve. */
    int touch;          /* 1: bodies touch where their points do; 0: where they share a node (thesis) */
    mpm_contact_fn fn;  /* of MPM_CONTACT_USER */
    void *context;      /* passed to it */
} mpm_contact;

/* ---- the description of a problem ---------------------------------------------------------- */

/* The problem: grid, geometry, capacities. Start from mpm_desc_default() and set at least cell and cells. */
typedef struct mpm_desc {
    unsigned mark;           /* set by mpm_desc_default */
    mpm_geometry geometry;
    mpm_basis basis;
    mpm_real origin[3];      /* lowest corner of the grid [length] */
    mpm_real cell;           /* cell edge [length], > 0 */
    int32_t cells[3];        /* cells per direction, >= 1; cells[1] is ignored in two dimensions */
    mpm_side side[6];        /* x low, x high, y low, y high, z low, z high */
    mpm_real wall_friction;  /* Coulomb coefficient of MPM_SIDE_WALL, >= 0 */
    mpm_contact contact;     /* of every pair of bodies without a rule of its own: mpm_contact_set */
    mpm_scheme scheme;       /* of contact and walls */
    mpm_real gravity[3];     /* [length/time^2] */
    mpm_real mass_cutoff;    /* nodes lighter than this share of a mean point's mass are passed over:
                                beyond it lie numbers too small to divide by (GIMP's outermost nodes) */
    mpm_real calm;           /* time in which what the grid does not see of the points' velocities and pressures falls
                                to 1/e, see mpm_calm; 0: never */
    /* capacities: in memory from MPM_MALLOC they may be 0 and grow by themselves; in yours they are final */
    int32_t points;          /* of all bodies; see mpm_shape_count */
    int32_t bodies;
    int32_t rules;           /* contact rules set by mpm_contact_set */
    int32_t nodes;           /* (node, body) pairs; 0: estimated */
    int user_fields;         /* further mpm_real per point, 0 .. MPM_USER_FIELDS, carried along */
} mpm_desc;

/* Linear functions in three dimensions, frictionless contact at nodes, open sides, no gravity. Test: 21_world. */
MPM_API mpm_desc mpm_desc_default(void);

/* ---- points -------------------------------------------------------------------------------- */

/* Flags of a point: where on its body it was born. */
enum {
    MPM_POINT_SURFACE = 1, /* within one shell of a free face: the points that contact and bond */
    MPM_FACE_TOP = 2,      /* within one spacing of a cylinder's or box's upper face */
    MPM_FACE_BOTTOM = 4,   /* ... of its lower face */
    MPM_FACE_RIM = 8       /* ... of its circumference */
};

/* What a point carries, as X(field, components, "unit", "meaning"): the members below, their places in memory
   and in a checkpoint are made from it. */
#define MPM_POINT_VECTORS(X)                                                          \
    X(x, 3, "length", "position")                                                     \
    X(v, 3, "length/time", "velocity")                                                \
    X(stress, 6, "stress", "Cauchy stress, xx yy zz yz xz xy, tension positive")
#define MPM_POINT_SCALARS(X)                                                          \
    X(mass, 1, "mass", "in axisymmetry that of the whole ring")                       \
    X(density, 1, "mass/length^3", "now")                                             \
    X(energy, 1, "energy/mass", "internal energy")                                    \
    X(temperature, 1, "K", "")                                                        \
    X(plastic_strain, 1, "1", "effective plastic strain")                             \
    X(plastic_rate, 1, "1/time", "its rate in the last step")                         \
    X(plastic_work, 1, "stress", "per current volume (A 4.15)")                       \
    X(bond, 1, "1", "D, the bonding history of a surface point (A 4.3, 4.16)")

/* The points of all bodies, one array per field. Body b owns [first, first + count); of these the
   last count - active are retired: they have left the grid and stay as they were. */
typedef struct mpm_points {
    int32_t count;            /* points of all bodies */
    int32_t capacity;
#define MPM__POINT_VECTOR(name, components, unit, text) mpm_real *name[components];
#define MPM__POINT_SCALAR(name, components, unit, text) mpm_real *name;
    MPM_POINT_VECTORS(MPM__POINT_VECTOR)
    MPM_POINT_SCALARS(MPM__POINT_SCALAR)
#undef MPM__POINT_VECTOR
#undef MPM__POINT_SCALAR
    mpm_real *user[MPM_USER_FIELDS]; /* see mpm_field_take */
    uint8_t *flags;           /* MPM_POINT_SURFACE ... */
    int32_t *id;              /* number of the point as created: survives sorting */
} mpm_points;

/* Points to make a body of, or to add to one: `count` entries per array, which must not be the world's own. NULL where
   the body's description says it for all. */
typedef struct mpm_cloud {
    int32_t count;
    const mpm_real *x[3];     /* position; x[1] may be NULL in two dimensions */
    const mpm_real *v[3];     /* velocity; NULL: the body's */
    const mpm_real *mass;     /* in axisymmetry of the whole ring; NULL: volume times the body's density */
    const mpm_real *volume;   /* NULL: a whole cube, square or ring section of the body's spacing. Where mass and
                                 volume are given, the density is the one over the other, else the body's */
    const uint8_t *flags;     /* MPM_POINT_SURFACE ...; NULL: 0, so that none bonds */
} mpm_cloud;

/* ---- bodies -------------------------------------------------------------------------------- */

/* A body to add: its shape is filled with points on a cubic lattice, or its points are given. */
typedef struct mpm_body_desc {
    unsigned mark;           /* set by mpm_body_desc_default */
    mpm_shape shape;
    mpm_real spacing;        /* distance of points [length], 0 < spacing <= cell */
    mpm_real density;        /* [mass/length^3], > 0 */
    mpm_real velocity[3];
    mpm_real temperature;    /* [K] */
    mpm_stress_fn stress;    /* constitutive update, or NULL for a body without stress */
    const void *material;    /* passed to it */
    mpm_real wave_p, wave_s; /* longitudinal and shear wave speeds: time step and dampers */
    int absorb;              /* faces with a viscous damper: MPM_FACE_BOTTOM | MPM_FACE_RIM (A 3.46) */
    mpm_real absorb_normal, absorb_shear; /* damper factors a and b of A 3.46 (thesis: 1) */
    mpm_real absorb_spring;  /* springs beside the dampers, for the half space that is not there: 1 is right, 0 none.
                                They take user fields, "first x" and so on, where the points began */
    mpm_real shell;          /* thickness of the MPM_POINT_SURFACE layer in spacings */
    int32_t id;              /* number of its first point, the others count on; -1: after the last one made */
} mpm_body_desc;

/* No motion, 298 K, no stress, full dampers where asked for, a surface layer of one spacing. Test: 21_world. */
MPM_API mpm_body_desc mpm_body_desc_default(void);

/* A body in the world: its description, and its points, one behind the other. */
typedef struct mpm_body {
    mpm_body_desc desc;
    int32_t first, count, active;
    mpm_real point_mass;     /* mean mass of its points */
    mpm_real mass[2];        /* mass of the points at the damped bottom and circumference */
    mpm_real area[2];        /* area of those faces, where any is damped */
    int place[3];            /* user fields where its points' first places are, for springs; -1: none */
} mpm_body;

/* ---- the grid ------------------------------------------------------------------------------ */

/* One node as one body sees it: a slot. Slots exist only where a body has points: memory grows with what
   bodies occupy. Slots of the same node form a chain, highest body first. */
typedef struct mpm_node {
    mpm_real mass;
    mpm_real momentum[3];  /* at k, then k+1 */
    mpm_real force[3];     /* internal + external + contact */
    mpm_real velocity[3];  /* at k+1, mapped back from the updated points (MUSL) */
    mpm_real reaction[3];  /* momentum given from outside in this step: walls, mpm_push, mpm_node_push */
    int32_t index;         /* number of the node in the grid */
    int32_t next;          /* next slot of this node, or -1 */
    int32_t body;
    int32_t flags;         /* bit s: on side s of the grid; MPM_NODE_CONTACT; bit 8 + s: wall s pushed */
    int32_t touch;         /* its record in world.touch, or -1: at contact nodes and walls only */
} mpm_node;

#define MPM_NODE_CONTACT 64 /* a flag of a node: bodies meet there */

/* What a slot carries besides where bodies meet, or meet a wall. */
typedef struct mpm_touch {
    mpm_real gradient[3];  /* sum of m grad N (A 3.30): out of the body */
    mpm_real shift[3];     /* added to the momentum of level k, without a force on the points */
    mpm_real inner[3];     /* internal force and dampers; after mpm_stress, with the new internal force added */
    mpm_real cut[3];       /* added to the velocity of MUSL, so that no strain goes through contact */
    mpm_real work[2];      /* for your sums over points, 0 after mpm_contact_find (mpm_bond.h: D and weights) */
    int32_t pair;          /* first pair of the node; those of one node follow each other */
} mpm_touch;

/* A run: consecutive points of one body that share a base node, so that nodal values are fetched
   once and points are swept in plain loops. */
typedef struct mpm_run {
    int32_t first, count;
    int32_t base[3];   /* lowest node of the support */
    int32_t body;
    int32_t flags;     /* bit d, 3+d: first, last node in direction d is an image of one inside; bit 6: contact;
                          bit 7+d, 10+d: as bit d, 3+d, where the side is fixed */
} mpm_run;

/* Two bodies meeting at a node. */
typedef struct mpm_pair {
    int32_t a, b;        /* slots; b belongs to the higher-numbered body */
    const mpm_contact *rule;
    mpm_real normal[3];  /* unit, outward of a, into b; zero where no normal can be told */
    mpm_real separation; /* gap between the bodies' points along it [length]; with rule.touch */
    mpm_real high, low;  /* ... whose ends these are, counted from the node */
    mpm_real hold;       /* share of the separating momentum that is taken, 0 .. 1: set it between
                            mpm_contact_find and mpm_contact_apply, as mpm_bond.h does */
    mpm_real limit;      /* largest impulse of the hold [mass length/time]; 0: none */
    mpm_real impulse[3]; /* momentum that a got and b gave in this step */
    mpm_real settled[3], next[3]; /* what a got so far at the level of velocity being settled, and shall get */
    int held;            /* 1 if the hold gave it, or in the consistent scheme if it holds all of the pair */
} mpm_pair;

/* Work space of the plane that parts the points of a pair: see mpm__plane_normals. */
typedef struct mpm_plane {
    mpm_real phi[4];     /* normal and offset: tanh((phi . (x, 1))/2) tells a (-1) from b (+1) */
    mpm_real matrix[10]; /* lower triangle of the normal equations, row by row */
    mpm_real right[4];
    mpm_real points[2];  /* how many of a, of b */
} mpm_plane;

/* Where energy and momentum went, summed over the steps. A nodal force f does the work
   f dt . (v_k + v_musl) / 2 on the points, exactly: so kinetic + internal + absorbed + contact + hold
   + walls - work is constant but for the error of the stress work, integrated in time. */
typedef struct mpm_ledger {
    double absorbed;     /* energy taken by the viscous dampers, and held by springs beside them */
    double contact;      /* energy lost in contact: nodal impact and friction */
    double hold;         /* energy lost in holding pairs: bonds */
    double walls;        /* energy lost at rigid walls; less what mpm_push and mpm_node_push brought in */
    double work;         /* done by gravity */
    double calm;         /* of motion and strain turned into heat by mpm_calm: it is part of internal */
    double impulse[3];   /* momentum brought in by all but contact: dampers, sides, mirror images, gravity, pushes */
} mpm_ledger;

/* A contact rule of a pair of bodies; -1 stands for any. */
typedef struct mpm_rule {
    int32_t a, b;
    mpm_contact contact;
} mpm_rule;

/* Everything. Plain data: read it, and write it between phases if you know why. When a world grows, its arrays move:
   points, body, rule and the grid's; take no pointers into them across calls that add. */
typedef struct mpm_world {
    mpm_desc desc;
    mpm_real time, dt;       /* now; the step under way, set by mpm_locate */
    mpm_real dt_last;        /* the step before it, whose rates the points hold */
    int64_t steps;
    mpm_points points;
    mpm_body *body;
    int32_t bodies;
    mpm_ledger ledger;
    mpm_fault fault;         /* the last failure */
    int64_t retired;         /* points that left the grid */
    int64_t sorts;           /* times the points were put back in cell order */
    int64_t notices;         /* positive statuses returned by materials; and MPM_UNSTABLE */
    int64_t tally[MPM_TALLIES]; /* counters of laws */
    int64_t held;            /* pairs that were held in the last step */
    int32_t next_id;         /* of the next point made */
    mpm_rule *rule;          /* of mpm_contact_set; the last that fits a pair is its rule */
    int32_t rules;
    const char *user_name[MPM_USER_FIELDS]; /* of mpm_field_take; NULL: not taken */

    int32_t nodes_per_axis[3], ghost; /* grid nodes, ghost layers included */
    int support[3];          /* nodes a point touches per direction */
    int32_t *head;           /* per grid node: first slot, or -1 */
    mpm_node *node;          /* slots */
    int32_t nodes, node_capacity;
    mpm_touch *touch;
    int32_t touches;
    mpm_run *run;
    int32_t *slot;           /* per run: support[0]*support[1]*support[2] slots */
    int32_t runs, run_capacity, sorted_runs;
    mpm_pair *pair;
    int32_t pairs, pair_capacity, pairs_possible;
    mpm_plane *plane;        /* per pair, once a rule wants MPM_NORMAL_LOGISTIC; else NULL */
    int planes;              /* 1: there is one */
    int32_t *key, *order;    /* per point: base node; permutation */
    mpm_real *field;         /* all real point arrays: field f at field + f * stride */
    mpm_real *scratch;       /* one array more */
    size_t stride;
    int fields;
    void *memory, *work;     /* the two blocks: points and grid table; nodes, runs, pairs */
    size_t memory_bytes, work_bytes;
    int owns_memory, owns_work;
} mpm_world;

/* ---- setting up ---------------------------------------------------------------------------- */

/* Points that mpm_body_add will create for this shape (those cut off by symmetry planes excluded). 0 for a
   shape or spacing that is not positive, or when the box around the shape would hold 2^31 of them.
   Test: 21_world. */
MPM_API int32_t mpm_shape_count(const mpm_desc *d, const mpm_shape *s, mpm_real spacing);

/* Checks a description. On failure fills fault (may be NULL) with the field and its value.
   MPM_ERR_ARGUMENT, MPM_ERR_NAN. Test: 21_world. */
MPM_API mpm_status mpm_desc_check(const mpm_desc *d, mpm_fault *fault);

/* The same of a contact rule. Test: 26_extend. */
MPM_API mpm_status mpm_contact_check(const mpm_contact *c, mpm_fault *fault);

/* Bytes that mpm_init needs for d; 0 if d is invalid or the size overflows. Test: 21_world. */
MPM_API size_t mpm_bytes(const mpm_desc *d);

/* Prepares a world in caller's memory (kept until the end; aligned as malloc aligns, see mpm_unaligned), or with
   memory == NULL in memory from MPM_MALLOC, which then grows by itself: in mpm_body_add and its like, and where
   mpm_locate finds more nodes than there is room for. MPM_ERR_ARGUMENT / NAN (see w->fault; value: how many bytes
   beside the alignment the memory begins), MPM_ERR_MEMORY.
   Test: 21_world. */
MPM_API mpm_status mpm_init(mpm_world *w, const mpm_desc *d, void *memory, size_t bytes);

/* Gives back what MPM_MALLOC gave. Safe on a world whose mpm_init failed. Test: 21_world. */
MPM_API void mpm_free(mpm_world *w);

/* Fills a shape with points, before the first step or between steps. Numbered in the order of the calls; add the
   substrate last. MPM_ERR_ARGUMENT / NAN: a field of b; MPM_ERR_OUTSIDE: a point outside the grid (points beyond a
   symmetry plane are cut off instead, and those next to it weigh what is left of their cubes);
   MPM_ERR_OVERLAP: with body fault.index, of whose points one lies in the shape,
   or (before the first step) whose shape holds a new one; MPM_ERR_FULL; MPM_ERR_MEMORY. On failure the world is
   unchanged. Test: 21_world, 26_extend. */
MPM_API mpm_status mpm_body_add(mpm_world *w, const mpm_body_desc *b);

/* A body of given points: b says what the cloud leaves open, its shape is not read, so that it can have no
   dampers. spacing is the size of the points with GIMP. MPM_ERR_ARGUMENT / NAN: an entry of the cloud, whose
   number is fault.index; others as mpm_body_add. Test: 26_extend. */
MPM_API mpm_status mpm_body_add_points(mpm_world *w, const mpm_body_desc *b, const mpm_cloud *points);

/* Adds points to a body, between steps: those of later bodies move up in the arrays (their ids tell them).
   Errors as mpm_body_add_points. Test: 26_extend. */
MPM_API mpm_status mpm_points_add(mpm_world *w, int32_t body, const mpm_cloud *points);

/* Takes point i (an index, not an id) out of the world, with its mass, between steps. Other points move; the sums of
   its body are made anew, a pass over its points. MPM_ERR_ARGUMENT: there is none. Test: 26_extend. */
MPM_API mpm_status mpm_point_take(mpm_world *w, int32_t i);

/* The rule of contact between bodies a and b, in any order, -1 for any body, between steps: of several that fit, the
   one set last; set again for the same two, it replaces theirs. Bodies need not be there yet. MPM_ERR_ARGUMENT / NAN:
   a body below -1, a field of the rule; MPM_ERR_FULL: desc.rules; in caller's memory logistic normals must stand in
   desc.contact too, for their room. Test: 26_extend. */
MPM_API mpm_status mpm_contact_set(mpm_world *w, int32_t a, int32_t b, const mpm_contact *rule);

/* The rule that bodies a and b meet by. Test: 26_extend. */
MPM_API const mpm_contact *mpm_contact_of(const mpm_world *w, int32_t a, int32_t b);

/* Takes a user field of the points by name (a text that stays): its number f, for points.user[f], 0 in all
   points. The same name gives the same number again. -1 when there is none left. Between steps. Test: 26_extend. */
MPM_API int mpm_field_take(mpm_world *w, const char *name);

/* Makes room after MPM_ERR_FULL in caller's memory: at least doubles nodes, runs and pairs, in the caller's block
   (used instead of the old one, which is then free) or with NULL in memory from MPM_MALLOC. The
   points are untouched; repeat the step from mpm_locate. MPM_ERR_MEMORY; MPM_ERR_ARGUMENT: not aligned.
   Test: 21_world. */
MPM_API mpm_status mpm_reserve(mpm_world *w, void *memory, size_t bytes);
MPM_API size_t mpm_reserve_bytes(const mpm_world *w); /* bytes that mpm_reserve wants */

/* Longitudinal and shear wave speeds of an isotropic solid (A 3.37, 3.45): sqrt((lambda + 2 mu) / rho),
   sqrt(mu / rho). E > 0, -1 < nu < 1/2. Test: 21_world. */
MPM_API mpm_real mpm_wave_speed_p(mpm_real young, mpm_real poisson, mpm_real density);
MPM_API mpm_real mpm_wave_speed_s(mpm_real young, mpm_real poisson, mpm_real density);

/* factor * cell / the fastest wave of any body (A 3.37). 0, which mpm_step refuses, where no body has a wave speed or
   one with a stress law has none (wave_p 0): how fast its waves are is then not known. Test: 21_world. */
MPM_API mpm_real mpm_time_step(const mpm_world *w, mpm_real factor);

/* ---- the step, phase by phase -------------------------------------------------------------- */

/* One step of dt [time] > 0: the phases below in their order. Write your own loop to put something
   between them. Returns MPM_OK, MPM_RETIRED, MPM_UNSTABLE; an error of mpm_locate (MPM_ERR_ARGUMENT, FULL, MEMORY,
   NAN), before the step began; or an error of mpm_stress, with the step incomplete. Test: 20_method, 71_step. */
MPM_API mpm_status mpm_step(mpm_world *w, mpm_real dt);

/* Finds each point's base node, retires points outside the grid, restores cell order when it has
   decayed, and gives every body slots for the nodes its points touch. The step dt is kept in w->dt for all that
   follows. MPM_ERR_ARGUMENT / NAN: dt, which must be > 0: nothing has changed then (where it is 0 since mpm_time_step
   knew no wave speed, fault.index is the body); position of point fault.index. MPM_ERR_FULL in
   caller's memory: see mpm_reserve; MPM_ERR_MEMORY. Points beyond a closed side are put back on it, others stay.
   MPM_UNSTABLE, once, as the step grows longer than cell / the fastest wave known, which no explicit step stands for
   long: it is taken, and counted in w->notices. (MPM_RETIRED may be hidden by it; see w->retired.)
   Test: 21_world, 28_planes. */
MPM_API mpm_status mpm_locate(mpm_world *w, mpm_real dt);

/* Lets die out, in the time desc.calm, what the grid does not see of the points' velocities and pressures: the rest of
   f_p = sum N_I f_I + rest_p, where sum m_p N_I rest_p = 0 at every node. Points that cross cells leave noise there,
   which has no momentum on the grid and stays for ever.
     v_p -= (1 - e^(-t/calm)) rest_p,  e_p += (1 - e^(-2 t/calm)) rest_p^2/2
   with t an eighth of calm, or the step where that is longer: momentum and energy stay, and nearly all that the grid
   gets of velocities. Pressures lose theirs by exchange of volume between neighbours,
     m_p d(1/rho_p) = dV_p = m_p (1 - e^(-t/calm)) rest_p/(rho0 K),  m_p de_p = -p dV_p with p = sum N_I p_I,
     K = rho0 (wave_p^2 - 4/3 wave_s^2) of the body
   so that volume and energy stay; wave speeds must be the material's, bodies without stress keep their volumes.
     sum_J (sum_p m_p N_I N_J) f_J = sum_p m_p N_I f_p
   is solved with the whole mass matrix, as in FMPM (Nairn, Hammerquist, Comput. Methods Appl. Mech. Engrg. 377 (2021)
   113667; XPIC, Hammerquist, Nairn, ibid. 318 (2017) 724, is its series), by conjugate gradients upon the lumped one:
   10 steps for velocities, 2 for pressures. What they have not found by then the grid hardly sees, and it goes with the
   rest (docs/quiet.md). Temperatures are not told of the heat. Between mpm_locate and mpm_p2g; nothing where
   desc.calm is 0. Test: 29_calm. */
MPM_API void mpm_calm(mpm_world *w);

/* Mass m_I = sum m_p N_I and momentum P_I = sum m_p v_p N_I to the nodes (A 3.23, 3.24), then essential
   boundary conditions. Test: 20_method, 71_step. */
MPM_API void mpm_p2g(mpm_world *w);

/* Forces to the nodes: internal -sum V_p sigma_p . grad N_I (A 3.25), gravity m_I g (A 3.26) and viscous dampers
   (A 3.45, 3.46). Test: 20_method, 71_step. */
MPM_API void mpm_forces(mpm_world *w);

/* Nodal momentum P_I += f_I dt (A 3.28), with boundary conditions. Test: 20_method, 71_step. */
MPM_API void mpm_grid_update(mpm_world *w);

/* Lists the pairs of bodies that meet at nodes, with their normals, along sum m_p grad N_I (A 3.30).
   Test: 23_solid, 25_contact. */
MPM_API void mpm_contact_find(mpm_world *w);

/* Contact on the pairs, in the scheme of the description: approaching ones, (m_b P_a - m_a P_b) . n > 0 (A 3.29), get
   the impulse that their rule asks for, at most (m_a P_b - m_b P_a) / (m_a + m_b) on a (A 3.31); separating ones are
   held as far as pair.hold says (A 4.7). Test: 23_solid, 25_contact, 27_schemes, 30_bond. */
MPM_API void mpm_contact_apply(mpm_world *w);

/* Velocity of the points from nodal accelerations, v_p += dt sum N_I f_I / m_I (A 3.32, first half).
   Test: 20_method, 71_step. */
MPM_API void mpm_g2p(mpm_world *w);

/* Nodal velocities from the updated points, v_I = sum m_p v_p N_I / m_I (A 3.33, 3.34): the M of MUSL. Keeps the
   energy ledger. Test: 20_method, 71_step. */
MPM_API void mpm_musl(mpm_world *w);

/* Strain and rotation increments, d eps = dt sym grad v (A 3.35), density rho / (1 + tr d eps) (A 3.36), then the
   bodies' constitutive update. MPM_ERR_STATE / NAN, or a law's own error: fault names field, value and point; the
   step is then incomplete. Test: 20_method, 71_step. */
MPM_API mpm_status mpm_stress(mpm_world *w);

/* Position of the points, x_p += dt sum N_I P_I / m_I (A 3.32, second half), and time. Last, since all phases use
   level k. Test: 20_method, 71_step. */
MPM_API void mpm_move(mpm_world *w);

/* ---- two phases in one sweep ---------------------------------------------------------------- */

/* Phases that follow each other, with one reading of the points and their weights for both: the same bits as one after
   the other, faster. Test: 71_step. */
MPM_API void mpm_to_nodes(mpm_world *w);               /* mpm_p2g and mpm_forces */
MPM_API void mpm_to_points(mpm_world *w);              /* mpm_g2p and mpm_musl */

/* mpm_stress and mpm_move. On an error of mpm_stress, which it returns, some points have been moved. Test: 71_step. */
MPM_API mpm_status mpm_stress_and_move(mpm_world *w);

/* ---- between the phases: what extensions use ------------------------------------------------ */

#define MPM_SUPPORT 64 /* most nodes a point touches: cubic splines in three dimensions */

/* The nodes a point touches, with the values N and the gradients G of their functions at the point. */
typedef struct mpm_support {
    int count;
    int32_t slot[MPM_SUPPORT];      /* world.node[slot[a]], a < count */
    mpm_real N[MPM_SUPPORT];
    mpm_real G[3][MPM_SUPPORT];     /* [1/length] */
    uint8_t image[MPM_SUPPORT];     /* bit d: the node stands for its image behind a symmetry plane or a fixed side
                                       across axis d */
    uint8_t mirror[MPM_SUPPORT];    /* bit d: component d of that image's motion is the negative of the node's */
} mpm_support;

/* Of point i, which lies in `run` (world.run[k], whose points are first .. first + count - 1). Between mpm_locate
   and mpm_move. Test: 26_extend. */
MPM_API void mpm_support_of(const mpm_world *w, const mpm_run *run, int32_t i, mpm_support *s);

/* Of any place x on the grid [length], as body `body` has it: its slots alone, so that the N sum to less than 1 where
   some node near x carries nothing of the body. 1; 0 if it has none there, or x is beyond an open side. Between
   mpm_locate and mpm_move. Test: 26_extend. */
MPM_API int mpm_support_at(const mpm_world *w, int32_t body, const mpm_real x[3], mpm_support *s);

/* The grid's velocity at the point, sum N_I P_I / m_I. After mpm_p2g. Test: 26_extend. */
MPM_API void mpm_support_velocity(const mpm_world *w, const mpm_support *s, mpm_real v[3]);

/* The velocity that MUSL has mapped back from the points, sum N_I v_I: the one that strains them, and that matter moves
   with. sum N_I P_I / m_I also has the kick that light nodes get from the step's forces. Between mpm_musl and mpm_move.
   Test: 26_extend. */
MPM_API void mpm_support_mapped(const mpm_world *w, const mpm_support *s, mpm_real v[3]);

/* An outer force f on a point, N_I f to its nodes: body forces, tractions. What sides forbid is taken out of f; the
   rest is in the ledger: in `impulse`, its work in `walls` (negative: brought in). Between mpm_p2g and
   mpm_grid_update. Test: 26_extend. */
MPM_API void mpm_push(mpm_world *w, const mpm_support *s, const mpm_real f[3]);

/* The work [energy] that such a force f does in this step: what the ledger has booked as `walls` (with the other sign),
   for contact of your own to book elsewhere. Between mpm_musl and mpm_move. Test: 26_extend. */
MPM_API double mpm_support_work(const mpm_world *w, const mpm_support *s, const mpm_real f[3]);

/* Momentum j to a slot from outside: rigid tools, prescribed velocities. What symmetry and fixed sides forbid is taken
   out of j; a wall, which has acted by then, resists it from the next step on. The rest is in the ledger: in
   `impulse`, its work in `walls` (negative: brought in). Between mpm_grid_update and mpm_g2p. Test: 32_pull. */
MPM_API void mpm_node_push(mpm_world *w, int32_t slot, mpm_real j[3]);

/* The slot of a body at grid node `index`, or -1. Test: 26_extend. */
MPM_API int32_t mpm_node_find(const mpm_world *w, int32_t index, int32_t body);

/* Where a node lies [length]; y is 0 in two dimensions. Test: 26_extend. */
MPM_API void mpm_node_position(const mpm_world *w, const mpm_node *n, mpm_real x[3]);

/* The impulse on a that gives both sides of a pair one velocity, (m_a P_b - m_b P_a) / (m_a + m_b) (A 3.31).
   Returns its approach, -j . n: > 0 where they approach (A 3.29). Test: 26_extend. */
MPM_API mpm_real mpm_pair_stick(const mpm_world *w, const mpm_pair *p, mpm_real j[3]);

/* Surface that a pair stands for [length^2; per depth in plane strain]: the smaller of the two bodies' there,
   |sum m grad N . n| / initial density. In a quarter model it is a quarter. Splines smear the edges of a face: of one
   four cells wide it lacks 13 to 17 %. Test: 30_bond, 26_extend. */
MPM_API double mpm_pair_area(const mpm_world *w, const mpm_pair *p);

/* Momentum j to a and -j to b, as contact laws give it, less what sides forbid: kept in pair.impulse for the ledger.
   Between mpm_contact_find and mpm_g2p. Test: 26_extend. */
MPM_API void mpm_pair_push(mpm_world *w, mpm_pair *p, const mpm_real j[3]);

/* ---- looking at it ------------------------------------------------------------------------- */

/* Sums over points [first, first + count) of any body: retired points are included, so that mass
   is the same for ever. Compensated sums. */
typedef struct mpm_totals {
    double mass, momentum[3], kinetic, internal;
    double plastic;          /* plastic work done, part of internal: sum of plastic_work m/density */
    double temperature_max, plastic_strain_mean, plastic_work_mean; /* means are mass-weighted */
    double low[3], high[3];  /* extents of the active points' centres */
    long points, retired;
} mpm_totals;

/* Of one body, or of all (-1). Test: 21_world. */
MPM_API mpm_totals mpm_body_totals(const mpm_world *w, int32_t body);

/* Bytes in use. Test: 21_world. */
MPM_API size_t mpm_bytes_used(const mpm_world *w);

/* ---- restart ------------------------------------------------------------------------------- */

/* The state of a world: all that its next step depends on, and what is counted. Fills blob[], at most
   MPM_BLOBS(w->bodies) of them, and returns how many. To go on from stored ones, set a world up as before - the
   same description, bodies, rules and user fields, room for as many points -, read them (mpm_io_checkpoint_read)
   and call mpm_restored. Test: 40_io "restart": the run goes on bit for bit. */
#define MPM_BLOBS(bodies) (48 + 2 * (bodies))
MPM_API int mpm_blobs(mpm_world *w, mpm_blob *blob);

/* Checks what was read into the blobs of mpm_blobs, before anything of it is used: numbers of points against each
   other and the memory there is. MPM_ERR_ARGUMENT / NAN, named by w->fault: the world is then without points.
   Test: 40_io "restart". */
MPM_API mpm_status mpm_restored(mpm_world *w, const mpm_blob *blob);

/* ---- what it is ---------------------------------------------------------------------------- */

/* What a status means, and the version of the implementation. Test: 21_world. */
MPM_API const char *mpm_status_text(mpm_status s);
MPM_API const char *mpm_version(void);

#ifdef __cplusplus
}
#endif
#endif /* MPM_H - stop here if you only want the API */

/* ============================================================================================ */
#if defined(MPM_COMPILED) && !defined(MPM_STATIC) /* also where it is defined after the first #include */
#undef MPM_IMPLEMENTATION
#endif
#if defined(MPM_IMPLEMENTATION) && !defined(MPM__IMPLEMENTED)
#define MPM__IMPLEMENTED

#include <string.h>

#ifndef MPM_MALLOC
#include <stdlib.h>
#define MPM_MALLOC(n) malloc(n)
#define MPM_FREE(p) free(p)
#endif

#ifndef MPM_BLOCK
#define MPM_BLOCK 64
#elif MPM_BLOCK < 1 || MPM_BLOCK > 1024
#error "MPM_BLOCK is a number of points on the stack: at least 1, at most 1024"
#endif

#define MPM__LANES (MPM_BLOCK + 4) /* room for the points of a span, and for what is written beyond the last */
#ifdef MPM_FLOAT
#define MPM__HAIR MPM_R(1e-5) /* cells; see mpm__weights_axis */
#else
#define MPM__HAIR 1e-9
#endif

/* Beside the spacing: a lattice point this near to a plane lies on it. */
#ifdef MPM_FLOAT
#define MPM__SNAP MPM_R(1e-4)
#else
#define MPM__SNAP 1e-6
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the step ----------------------------------------------------------------------------- */

MPM_API mpm_status mpm_step(mpm_world *w, mpm_real dt)
{
    mpm_status s = mpm_locate(w, dt), stressed;
    if (s < 0) return s;
    mpm_calm(w);
    mpm_to_nodes(w);      /* mpm_p2g, mpm_forces */
    mpm_grid_update(w);
    mpm_contact_find(w);
    mpm_contact_apply(w);
    mpm_to_points(w);     /* mpm_g2p, mpm_musl */
    stressed = mpm_stress_and_move(w); /* mpm_stress, mpm_move */
    return stressed < 0 ? stressed : s;
}

static inline int mpm__flat(const mpm_desc *d) { return d->geometry != MPM_3D; }

static inline mpm_real mpm__grid_high(const mpm_desc *d, int axis)
{
    return d->origin[axis] + (mpm_real)d->cells[axis] * d->cell;
}

static inline size_t mpm__grid_nodes(const mpm_world *w)
{
    return (size_t)w->nodes_per_axis[0] * (size_t)w->nodes_per_axis[1] * (size_t)w->nodes_per_axis[2];
}

/* ---- several numbers at a time ---------------------------------------------------------------- */

/* As many numbers as the compiler is told that the machine does at once, at most 4; one where it is told none. The
   operators are those of a single number, and so are the bits. */
#if (defined(__SSE2__) || defined(__ARM_NEON) || defined(__VSX__)) && !defined(MPM_NO_WIDE) && !defined(_MSC_VER)
#if defined(MPM_FLOAT) || defined(__AVX__)
enum { MPM__WIDE = 4 };
#else
enum { MPM__WIDE = 2 };
#endif
#ifdef MPM_FLOAT
#define MPM__MASK int32_t
#else
#define MPM__MASK int64_t
#endif
typedef mpm_real mpm__wide __attribute__((vector_size(MPM__WIDE * sizeof(mpm_real))));
typedef MPM__MASK mpm__mask __attribute__((vector_size(MPM__WIDE * sizeof(mpm_real))));
#else
enum { MPM__WIDE = 1 };
typedef mpm_real mpm__wide;
#endif

MPM_KERNEL mpm__wide mpm__load(const mpm_real *from)
{
    mpm__wide v;
    memcpy(&v, from, sizeof v);
    return v;
}

MPM_KERNEL void mpm__store(mpm_real *to, mpm__wide v) { memcpy(to, &v, sizeof v); }

/* v where m is more than least, else 0. */
MPM_KERNEL mpm__wide mpm__where_more(mpm__wide m, mpm_real least, mpm__wide v)
{
#ifdef MPM__MASK
    return (mpm__wide)((mpm__mask)v & (m > least));
#else
    return m > least ? v : 0;
#endif
}

/* ---- shape functions and the sweep over a run ------------------------------------------------ */

/* Shape functions and derivatives, per direction, of up to MPM_BLOCK points of a body. */
typedef struct mpm__weights {
    int n;
    mpm_real slope;           /* of linear functions: 1/cell */
    mpm_real N[3][4][MPM__LANES];
    mpm_real dN[3][4][MPM__LANES];
} mpm__weights;

/* A place in its cell, 0 to 1. A point on a grid plane would give its far node a gradient but no mass, hence no
   velocity: it is kept a hair's breadth inside. */
MPM_KERNEL mpm_real mpm__within(mpm_real t)
{
    const mpm_real in = t > MPM__HAIR ? t : MPM__HAIR;
    return in < 1 - MPM__HAIR ? in : 1 - MPM__HAIR;
}

/* One direction: t is the distance from the base node in cells. The linear hat, 1 - |e| at e cells from the node
   (A 3.20). */
MPM_KERNEL void mpm__hats(mpm__weights *s, int axis, const mpm_real *t, mpm_real inv)
{
    const int n = s->n;
    int p;
    for (p = 0; p < n; p++) {
        const mpm_real u = mpm__within(t[p]);
        s->N[axis][0][p] = 1 - u;
        s->N[axis][1][p] = u;
        s->dN[axis][0][p] = -inv;
        s->dN[axis][1][p] = inv;
    }
}

/* The hat averaged over a point of half size l cells (uGIMP): 1 - (e^2 + l^2)/(2 l) for |e| < l, 1 - |e| up to 1 - l,
   (1 + l - |e|)^2/(4 l) up to 1 + l; over a whole cell, l = 1/2, it is the quadratic B-spline. */
static inline void mpm__averaged_hats(mpm__weights *s, int axis, const mpm_real *t, mpm_real l, mpm_real inv)
{
    const mpm_real half = 1 / (2 * l), quarter = half / 2, steep = inv / l;
    const int n = s->n;
    int p, i;
    for (i = 0; i < 3; i++)
        for (p = 0; p < n; p++) {
            const mpm_real e = t[p] - (mpm_real)i, a = e < 0 ? -e : e, sign = e < 0 ? inv : -inv;
            const mpm_real reach = 1 + l - a > 0 ? 1 + l - a : 0;
            const mpm_real outer = reach * reach * quarter, inner = 1 - (e * e + l * l) * half;
            const mpm_real douter = sign * reach * half, dinner = -e * steep;
            s->N[axis][i][p] = a < l ? inner : (a <= 1 - l ? 1 - a : outer);
            s->dN[axis][i][p] = a < l ? dinner : (a <= 1 - l ? sign : douter);
        }
}

/* The cubic B-spline, 2/3 - e^2 + |e|^3/2 for |e| < 1, (2 - |e|)^3/6 up to 2. */
static inline void mpm__cubics(mpm__weights *s, int axis, const mpm_real *t, mpm_real inv)
{
    const mpm_real sixth = MPM_R(1.0) / 6, two_thirds = MPM_R(2.0) / 3, half = inv / 2;
    const int n = s->n;
    int p;
    for (p = 0; p < n; p++) { /* t - 1 and 2 - t are the distances from the two inner nodes */
        const mpm_real u = t[p] - 1, v = 2 - t[p];
        s->N[axis][0][p] = v * v * v * sixth;
        s->N[axis][1][p] = two_thirds - u * u * (1 - u / 2);
        s->N[axis][2][p] = two_thirds - v * v * (1 - v / 2);
        s->N[axis][3][p] = u * u * u * sixth;
        s->dN[axis][0][p] = -half * v * v;
        s->dN[axis][1][p] = -inv * u * (2 - MPM_R(1.5) * u);
        s->dN[axis][2][p] = inv * v * (2 - MPM_R(1.5) * v);
        s->dN[axis][3][p] = half * u * u;
    }
}

/* The direction that two dimensions have not. */
static inline void mpm__ones(mpm__weights *s, int axis)
{
    const int n = s->n;
    int p;
    for (p = 0; p < n; p++) {
        s->N[axis][0][p] = 1;
        s->dN[axis][0][p] = 0;
    }
}

/* How many of the points [at, at + n) are in run r, which has the first. */
MPM_KERNEL int mpm__part(const mpm_run *r, int32_t at, int n)
{
    const int32_t most = r->first + r->count - at;
    return most < n ? (int)most : n;
}

/* Points [first, first + n) of a body run by run, the first of them in run r: [at, at + part) of them are in run r. */
#define MPM__EACH_PART(r, first, n, at, part)                                                                   \
    for (at = 0; at < (n) && (part = mpm__part(r, (first) + at, (n) - at)) > 0; at += part, (r)++)

MPM_KERNEL void mpm__weights_axis(mpm__weights *s, int axis, int k, const mpm_real *t, mpm_real l, mpm_real inv)
{
    if (k == 1) mpm__ones(s, axis);
    else if (k == 2) mpm__hats(s, axis, t, inv);
    else if (k == 3) mpm__averaged_hats(s, axis, t, l, inv);
    else mpm__cubics(s, axis, t, inv);
}

/* Edge of the cube over which a body's functions average the hat [cells]. */
MPM_KERNEL mpm_real mpm__point_size(const mpm_world *w, int32_t body)
{
    return w->desc.basis == MPM_QUADRATIC ? 1 : w->body[body].desc.spacing * (1 / w->desc.cell);
}

/* Distances of points [first, first + n), which begin in run r, from the bases of their runs in cells: t[d]. Up to
   MPM__WIDE - 1 more are written. */
MPM_KERNEL void mpm__distances(const mpm_world *w, const mpm_run *r, int32_t first, int n, mpm_real *const t[3])
{
    const mpm_real inv = 1 / w->desc.cell;
    int at, part, d, p;
    MPM__EACH_PART(r, first, n, at, part)
        for (d = 0; d < 3; d++) {
            const mpm_real *x = w->points.x[d] + first, o = w->desc.origin[d];
            const mpm_real base = (mpm_real)(r->base[d] - w->ghost);
            for (p = at; p < at + part; p += MPM__WIDE) mpm__store(t[d] + p, (mpm__load(x + p) - o) * inv - base);
        }
}

/* Weights of points [first, first + n), which begin in run r. */
MPM_KERNEL void mpm__weigh(const mpm_world *w, const mpm_run *r, int32_t first, int n, int k, int ky, mpm__weights *s)
{
    const mpm_real inv = 1 / w->desc.cell, l = mpm__point_size(w, r->body) / 2;
    mpm_real place[3][MPM__LANES], *t[3];
    int d;
    for (d = 0; d < 3; d++) t[d] = place[d];
    s->n = n;
    s->slope = inv;
    mpm__distances(w, r, first, n, t);
    for (d = 0; d < 3; d++) mpm__weights_axis(s, d, d == 1 ? ky : k, t[d], l, inv);
}

/* ... for a sweep, which of linear functions reads the weights of the upper nodes alone. */
MPM_KERNEL void mpm__weigh_span(const mpm_world *w, const mpm_run *r, int32_t first, int n, int k, int ky,
                                mpm__weights *s)
{
    mpm_real *t[3];
    int d, p;
    if (k != 2) {
        mpm__weigh(w, r, first, n, k, ky, s);
        return;
    }
    for (d = 0; d < 3; d++) t[d] = s->N[d][1];
    s->n = n;
    s->slope = 1 / w->desc.cell;
    mpm__distances(w, r, first, n, t);
    for (d = 0; d < 3; d++)
        for (p = 0; p < n; p++) t[d][p] = mpm__within(t[d][p]);
}

/* The product weights of point p at all nodes of its support. */
MPM_KERNEL void mpm__products(const mpm__weights *s, int p, int k, int ky, mpm_real *N)
{
    int ix, iy, iz;
    for (iz = 0; iz < k; iz++)
        for (iy = 0; iy < ky; iy++) {
            mpm_real yz = s->N[1][iy][p] * s->N[2][iz][p];
            for (ix = 0; ix < k; ix++) N[(iz * ky + iy) * k + ix] = s->N[0][ix][p] * yz;
        }
}

/* ... and their gradients G[0], G[1], G[2]. */
MPM_KERNEL void mpm__gradients(const mpm__weights *s, int p, int k, int ky, mpm_real G[3][MPM_SUPPORT])
{
    int ix, iy, iz;
    for (iz = 0; iz < k; iz++)
        for (iy = 0; iy < ky; iy++) {
            mpm_real yz = s->N[1][iy][p] * s->N[2][iz][p];
            mpm_real dyz = s->dN[1][iy][p] * s->N[2][iz][p], ydz = s->N[1][iy][p] * s->dN[2][iz][p];
            for (ix = 0; ix < k; ix++) {
                const int a = (iz * ky + iy) * k + ix;
                G[0][a] = s->dN[0][ix][p] * yz;
                G[1][a] = s->N[0][ix][p] * dyz;
                G[2][a] = s->N[0][ix][p] * ydz;
            }
        }
}

/* Nodal values of linear functions turned into the coefficients of their polynomial 1, x, z, xz (in 3D 1, x, y, xy, z,
   xz, yz, xyz) in the cell: a point then costs half. Others stay as they are. */
MPM_KERNEL void mpm__as_polynomial(int k, int ky, mpm_real (*V)[4])
{
    int a, d, stride;
    if (k != 2) return;
    for (stride = 1; stride < k * ky * k; stride *= 2)
        for (a = 0; a < k * ky * k; a++)
            for (d = 0; d < 4 && a & stride; d += MPM__WIDE)
                mpm__store(V[a] + d, mpm__load(V[a] + d) - mpm__load(V[a - stride] + d));
}

/* c0 + c1 x + (c2 + c3 x) z of a plane of cells, in 3D with y for z, and that of the upper face times z: component d at
   point p of the weights and those beside it. */
MPM_KERNEL mpm__wide mpm__polynomial(const mpm__weights *s, int p, int ky, mpm_real (*c)[4], int d)
{
    const mpm__wide x = mpm__load(&s->N[0][1][p]), z = mpm__load(&s->N[2][1][p]);
    const mpm__wide y = ky > 1 ? mpm__load(&s->N[1][1][p]) : z;
    const mpm__wide low = (c[0][d] + x * c[1][d]) + y * (c[2][d] + x * c[3][d]);
    return ky > 1 ? low + z * ((c[4][d] + x * c[5][d]) + y * (c[6][d] + x * c[7][d])) : low;
}

/* ... and its gradient. */
MPM_KERNEL mpm__wide mpm__polynomial_gradient(const mpm__weights *s, int p, int ky, mpm_real (*c)[4], int d,
                                              mpm__wide *g)
{
    const mpm__wide x = mpm__load(&s->N[0][1][p]), z = mpm__load(&s->N[2][1][p]);
    const mpm__wide y = ky > 1 ? mpm__load(&s->N[1][1][p]) : z;
    const mpm__wide c0 = c[0][d] + x * c[1][d], c2 = c[2][d] + x * c[3][d], c1 = c[1][d] + y * c[3][d];
    const mpm__wide low = c0 + y * c2;
    if (ky > 1) {
        const mpm__wide c6 = c[6][d] + x * c[7][d], high = (c[4][d] + x * c[5][d]) + y * c6;
        g[0] = s->slope * (c1 + z * (c[5][d] + y * c[7][d]));
        g[1] = s->slope * (c2 + z * c6);
        g[2] = s->slope * high;
        return low + z * high;
    }
    g[0] = s->slope * c1;
    g[1] = c1 * 0;
    g[2] = s->slope * c2;
    return low;
}

/* Sums over the support of V N, component d, direction by direction: with k and ky constants no loop is left. */
MPM_KERNEL mpm__wide mpm__sums(const mpm__weights *s, int p, int k, int ky, mpm_real (*V)[4], int d)
{
    mpm__wide all = mpm__load(&s->N[0][0][p]) * 0;
    int ix, iy, iz;
    for (iz = 0; iz < k; iz++) {
        mpm__wide plane = all * 0;
        for (iy = 0; iy < ky; iy++) {
            mpm__wide line = all * 0;
            for (ix = 0; ix < k; ix++) line += mpm__load(&s->N[0][ix][p]) * V[(iz * ky + iy) * k + ix][d];
            plane += mpm__load(&s->N[1][iy][p]) * line;
        }
        all += mpm__load(&s->N[2][iz][p]) * plane;
    }
    return all;
}

/* ... and the sums of V grad N: g[0], g[1], g[2]. */
MPM_KERNEL mpm__wide mpm__gradient_sums(const mpm__weights *s, int p, int k, int ky, mpm_real (*V)[4], int d,
                                        mpm__wide *g)
{
    mpm__wide all = mpm__load(&s->N[0][0][p]) * 0;
    int ix, iy, iz;
    g[0] = g[1] = g[2] = all;
    for (iz = 0; iz < k; iz++) {
        const mpm__wide z = mpm__load(&s->N[2][iz][p]);
        mpm__wide plane = all * 0, plane_x = plane, plane_y = plane;
        for (iy = 0; iy < ky; iy++) {
            const mpm__wide y = mpm__load(&s->N[1][iy][p]);
            mpm__wide line = all * 0, line_x = line;
            for (ix = 0; ix < k; ix++) {
                const mpm_real v = V[(iz * ky + iy) * k + ix][d];
                line += mpm__load(&s->N[0][ix][p]) * v;
                line_x += mpm__load(&s->dN[0][ix][p]) * v;
            }
            plane += y * line;
            plane_x += y * line_x;
            plane_y += mpm__load(&s->dN[1][iy][p]) * line;
        }
        all += z * plane;
        g[0] += z * plane_x;
        g[1] += z * plane_y;
        g[2] += mpm__load(&s->dN[2][iz][p]) * plane;
    }
    return all;
}

/* The same at points [at, at + n) of the weights, with the supports there are beside those of linear functions. */
#define MPM__WIDE_SUMS(k, ky) \
    for (p = at; p < at + n; p += MPM__WIDE) mpm__store(sum + p, mpm__sums(s, p, k, ky, V, d))
static inline void mpm__wide_sums(const mpm__weights *s, int at, int n, int k, int ky, mpm_real (*V)[4], int d,
                                  mpm_real *sum)
{
    int p;
    if (k == 3 && ky == 3) MPM__WIDE_SUMS(3, 3);
    else if (k == 3) MPM__WIDE_SUMS(3, 1);
    else if (ky == 4) MPM__WIDE_SUMS(4, 4);
    else MPM__WIDE_SUMS(4, 1);
}
#undef MPM__WIDE_SUMS

/* Sums over the support of V N, for V from mpm__gather_polynomial, component d, at points [at, at + n) of the
   weights. */
MPM_KERNEL void mpm__values(const mpm__weights *s, int at, int n, int k, int ky, mpm_real (*V)[4], int d, mpm_real *sum)
{
    int p;
    if (k != 2) mpm__wide_sums(s, at, n, k, ky, V, d, sum);
    else
        for (p = at; p < at + n; p += MPM__WIDE) mpm__store(sum + p, mpm__polynomial(s, p, ky, V, d));
}

/* ... and the sums of V grad N: g[0], g[1], g[2]. */
MPM_KERNEL void mpm__put_gradient(mpm__wide value, const mpm__wide *slope, int p, mpm_real *sum,
                                  mpm_real (*g)[MPM__LANES])
{
    int e;
    mpm__store(sum + p, value);
    for (e = 0; e < 3; e++) mpm__store(&g[e][p], slope[e]);
}

#define MPM__WIDE_SUMS(k, ky)                                                    \
    for (p = at; p < at + n; p += MPM__WIDE) {                                   \
        const mpm__wide value = mpm__gradient_sums(s, p, k, ky, V, d, slope);    \
        mpm__put_gradient(value, slope, p, sum, g);                              \
    }
static inline void mpm__wide_gradient_sums(const mpm__weights *s, int at, int n, int k, int ky, mpm_real (*V)[4], int d,
                                           mpm_real *sum, mpm_real (*g)[MPM__LANES])
{
    mpm__wide slope[3];
    int p;
    if (k == 3 && ky == 3) MPM__WIDE_SUMS(3, 3)
    else if (k == 3) MPM__WIDE_SUMS(3, 1)
    else if (ky == 4) MPM__WIDE_SUMS(4, 4)
    else MPM__WIDE_SUMS(4, 1)
}
#undef MPM__WIDE_SUMS

MPM_KERNEL void mpm__values_gradient(const mpm__weights *s, int at, int n, int k, int ky, mpm_real (*V)[4], int d,
                                     mpm_real *sum, mpm_real (*g)[MPM__LANES])
{
    int p;
    if (k != 2) mpm__wide_gradient_sums(s, at, n, k, ky, V, d, sum, g);
    else
        for (p = at; p < at + n; p += MPM__WIDE) {
            mpm__wide slope[3];
            const mpm__wide value = mpm__polynomial_gradient(s, p, ky, V, d, slope);
            mpm__put_gradient(value, slope, p, sum, g);
        }
}

/* Nodes of a support. No constant to the compiler: it then does the sums of several nodes at a time, point by point,
   rather than of several points, which have to be added in order. */
MPM_KERNEL int mpm__reach(const mpm_world *w) { return w->support[0] * w->support[1] * w->support[2]; }

MPM_KERNEL const int32_t *mpm__run_nodes(const mpm_world *w, const mpm_run *r)
{
    return w->slot + (size_t)(r - w->run) * (size_t)mpm__reach(w);
}

/* 1 if node a of a run is the image of its slot behind a plane across axis d, 2 if behind a fixed side; else 0. */
MPM_KERNEL int mpm__behind(const mpm_run *r, int a, int d, int k, int ky)
{
    const int i[3] = {a % k, a / k % ky, a / k / ky};
    const int last = i[d] == (d == 1 ? ky : k) - 1 ? r->flags >> (3 + d) & 129 : 0;
    const int first = i[d] == 0 ? r->flags >> d & 129 : 0;
    return ((first | last) & 1) + (first | last) / 128;
}

/* -1 where component d of a place is turned round in the image that node a of a run is. */
MPM_KERNEL mpm_real mpm__turned(const mpm_run *r, int a, int d, int k, int ky)
{
    return mpm__behind(r, a, d, k, ky) ? MPM_R(-1.0) : MPM_R(1.0);
}

/* The same of a motion: across a symmetry plane the normal component, across a fixed side all. */
MPM_KERNEL mpm_real mpm__mirror(const mpm_run *r, int a, int d, int k, int ky)
{
    mpm_real sign = 1;
    int e;
    for (e = 0; e < 3; e++) {
        const int behind = mpm__behind(r, a, e, k, ky);
        if (behind == 2 || (behind && e == d)) sign = -sign;
    }
    return sign;
}

/* Which vector of a node a sweep fetches or adds to. */
typedef enum mpm__vector { MPM__MOMENTUM, MPM__FORCE, MPM__VELOCITY } mpm__vector;

MPM_KERNEL size_t mpm__offset(mpm__vector which)
{
    switch (which) {
    case MPM__MOMENTUM: return offsetof(mpm_node, momentum);
    case MPM__FORCE: return offsetof(mpm_node, force);
    default: return offsetof(mpm_node, velocity);
    }
}

MPM_KERNEL mpm_real *mpm__node_vector(mpm_node *n, mpm__vector which)
{
    return (mpm_real *)(void *)((char *)n + mpm__offset(which));
}

/* The turning of images in V, which has a node's components at V[a node + d part]. */
static inline void mpm__turn(const mpm_run *r, int k, int ky, mpm_real *V, int node, int part)
{
    int a, d;
    for (a = 0; a < k * ky * k; a++)
        for (d = 0; d < 3; d++) V[a * node + d * part] *= mpm__mirror(r, a, d, k, ky);
}

/* Adds V, summed over points of a run, to its nodes. */
MPM_KERNEL void mpm__scatter(mpm_world *w, const mpm_run *r, int k, int ky, mpm__vector which,
                             mpm_real V[3][MPM_SUPPORT])
{
    const int32_t *slot = mpm__run_nodes(w, r);
    int a, d;
    if (r->flags & 63) mpm__turn(r, k, ky, V[0], 1, MPM_SUPPORT);
    for (a = 0; a < k * ky * k; a++) {
        mpm_real *to = mpm__node_vector(&w->node[slot[a]], which);
        for (d = 0; d < 3; d++) to[d] += V[d][a];
    }
}

/* Fetches a vector of a run's nodes, divided by the nodal mass if per_mass, with a fourth number beside it that nobody
   uses. Nodes lighter than the cutoff give zero. */
MPM_KERNEL void mpm__gather(const mpm_world *w, const mpm_run *r, int k, int ky, mpm__vector which, int per_mass,
                            mpm_real (*V)[4])
{
    const int32_t *slot = mpm__run_nodes(w, r);
    const mpm_real cutoff = w->desc.mass_cutoff * w->body[r->body].point_mass;
    mpm_real share[MPM_SUPPORT + 4];
    int a, d;
    for (a = 0; a < k * ky * k; a++) share[a] = w->node[slot[a]].mass;
    for (a = 0; a < k * ky * k; a += MPM__WIDE) {
        const mpm__wide m = mpm__load(share + a);
        mpm__store(share + a, mpm__where_more(m, cutoff, per_mass ? 1 / m : m * 0 + 1));
    }
    for (a = 0; a < k * ky * k; a++) {
        const mpm_real *from = (const mpm_real *)(const void *)((const char *)&w->node[slot[a]] + mpm__offset(which));
        for (d = 0; d < 4; d += MPM__WIDE) mpm__store(V[a] + d, mpm__load(from + d) * share[a]);
    }
    if (r->flags & 63) mpm__turn(r, k, ky, V[0], 4, 1);
}

/* ... as mpm__values wants it. */
MPM_KERNEL void mpm__gather_polynomial(const mpm_world *w, const mpm_run *r, int k, int ky, mpm__vector which,
                                       int per_mass, mpm_real (*V)[4])
{
    mpm__gather(w, r, k, ky, which, per_mass, V);
    mpm__as_polynomial(k, ky, V);
}

/* call(k, ky, hoop) with the support and the geometry of a world: as constants for linear functions, whose few nodes
   are then no loops. rings: 1 where hoop matters. */
#define MPM__SPECIALISED(w, rings, call)                                                       \
    do {                                                                                       \
        const int mpm__k = (w)->support[0], mpm__ky = (w)->support[1];                         \
        const int mpm__hoop = (rings) && (w)->desc.geometry == MPM_AXISYMMETRIC;               \
        if (mpm__k != 2) call(mpm__k, mpm__ky, mpm__hoop);                                     \
        else if (mpm__ky == 2) call(2, 2, 0);                                                  \
        else if (!mpm__hoop) call(2, 1, 0);                                                    \
        else call(2, 1, 1);                                                                    \
    } while (0)

/* call(k, ky, hoop) for every body of w: its runs are [from, to) there. */
#define MPM__EACH_BODY(w, rings, call)                                                \
    do {                                                                              \
        int32_t body, from, to = 0;                                                   \
        for (body = 0; body < (w)->bodies; body++) {                                  \
            for (from = to; to < (w)->runs && (w)->run[to].body == body; to++) {}     \
            MPM__SPECIALISED(w, rings, call);                                         \
        }                                                                             \
    } while (0)

/* Splits a run into pieces of at most MPM_BLOCK points. */
#define MPM__EACH_PIECE(r, at, n)                                                                        \
    for (at = (r)->first; at < (r)->first + (r)->count &&                                                \
         ((n = (int)((r)->first + (r)->count - at) < MPM_BLOCK ? (int)((r)->first + (r)->count - at)     \
                                                               : MPM_BLOCK) > 0);                        \
         at += n)

/* 1 if no point of run r comes after those before `at`. */
MPM_KERNEL int mpm__run_ends(const mpm_run *r, int32_t at) { return at == r->first + r->count; }

/* Points of the next span of the runs [*r, end), which begins at `at`; *r is moved to the run of its first. */
static inline int mpm__span(const mpm_run **r, const mpm_run *end, int32_t at)
{
    int32_t left;
    while (*r < end && (*r)->first + (*r)->count <= at) (*r)++;
    left = *r < end ? end[-1].first + end[-1].count - at : 0;
    return left < MPM_BLOCK ? (int)left : MPM_BLOCK;
}

/* Splits the points of a body's runs [r, end) into spans of at most MPM_BLOCK, r being the run of a span's first. */
#define MPM__EACH_SPAN(r, end, at, n)                                                                        \
    for (at = (r) < (end) ? (r)->first : 0; (n = mpm__span(&(r), end, at)) > 0; at += n)

/* ---- boundary conditions --------------------------------------------------------------------- */

/* Essential conditions on a nodal vector: no component through a symmetry plane, none at all at a
   fixed side. What is taken away is added to `removed`. */
static inline void mpm__constrain(const mpm_world *w, const mpm_node *n, mpm_real *v, double *removed)
{
    int s, d;
    for (s = 0; s < 6; s++) {
        if (!(n->flags >> s & 1) || w->desc.side[s] == MPM_SIDE_WALL) continue;
        for (d = 0; d < 3; d++) {
            if (w->desc.side[s] == MPM_SIDE_SYMMETRY && d != s / 2) continue;
            if (removed) removed[d] += (double)v[d];
            v[d] = 0;
        }
    }
}

/* Momentum j to a node from outside. */
static inline void mpm__give(mpm_world *w, mpm_node *n, const mpm_real *j)
{
    int d;
    for (d = 0; d < 3; d++) {
        n->momentum[d] += j[d];
        n->force[d] += j[d] / w->dt;
        n->reaction[d] += j[d];
        w->ledger.impulse[d] += (double)j[d];
    }
}

MPM_API void mpm_node_push(mpm_world *w, int32_t slot, mpm_real j[3])
{
    mpm__constrain(w, &w->node[slot], j, NULL);
    mpm__give(w, &w->node[slot], j);
}

static inline int mpm__has_walls(const mpm_desc *d)
{
    int s, found = 0;
    for (s = 0; s < 6; s++) found |= d->side[s] == MPM_SIDE_WALL;
    return found;
}

/* The record of a node where a wall or another body may act, made before they do. */
static inline mpm_touch *mpm__touch(mpm_world *w, mpm_node *n)
{
    mpm_touch *t;
    int d;
    if (n->touch < 0) {
        n->touch = w->touches++;
        t = &w->touch[n->touch];
        memset(t, 0, sizeof *t);
        for (d = 0; d < 3; d++) t->inner[d] = n->force[d] - n->reaction[d] / w->dt - n->mass * w->desc.gravity[d];
    }
    return &w->touch[n->touch];
}

/* Which way wall s pushes: +1, -1. */
static inline mpm_real mpm__wall_sign(int s) { return s & 1 ? MPM_R(-1.0) : MPM_R(1.0); }

/* A rigid wall takes away the momentum into it; friction takes up to wall_friction times as much of the tangential.
   In the consistent scheme what stands in P(k) is taken from the grid alone, as at a mirror: the points get what
   the new forces ask for. */
static inline void mpm__wall(mpm_world *w, mpm_node *n, int s)
{
    const int axis = s / 2;
    mpm_touch *t = mpm__touch(w, n);
    const mpm_real old = n->momentum[axis] - n->force[axis] * w->dt;
    mpm_real slip = 0, keep, jn, j[3] = {0, 0, 0};
    int d;
    if (w->desc.scheme == MPM_SCHEME_CONSISTENT && mpm__wall_sign(s) * old < 0) {
        n->momentum[axis] -= old;
        t->shift[axis] -= old;
    }
    jn = -mpm__wall_sign(s) * n->momentum[axis];
    if (jn <= 0) return;
    n->flags |= 256 << s;
    j[axis] = -n->momentum[axis];
    for (d = 0; d < 3; d++)
        if (d != axis) slip += n->momentum[d] * n->momentum[d];
    slip = mpm_sqrt(slip);
    keep = slip > w->desc.wall_friction * jn ? 1 - w->desc.wall_friction * jn / slip : 0;
    for (d = 0; d < 3; d++)
        if (d != axis) j[d] = (keep - 1) * n->momentum[d];
    mpm__give(w, n, j);
}

static inline void mpm__walls(mpm_world *w, mpm_node *n)
{
    int s;
    for (s = 0; s < 6; s++)
        if ((n->flags >> s & 1) && w->desc.side[s] == MPM_SIDE_WALL) mpm__wall(w, n, s);
}

/* No strain through a wall: the velocity that MUSL maps back loses what goes into it, and in the consistent scheme
   all of its normal part while the wall pushes. */
static inline void mpm__walls_mapped(mpm_world *w, mpm_node *n)
{
    int s;
    for (s = 0; s < 6; s++) {
        mpm_real *v = &n->velocity[s / 2];
        const int pushes = w->desc.scheme == MPM_SCHEME_CONSISTENT && (n->flags >> (8 + s) & 1);
        if (!(n->flags >> s & 1) || w->desc.side[s] != MPM_SIDE_WALL) continue;
        if (!pushes && mpm__wall_sign(s) * *v >= 0) continue;
        w->touch[n->touch].cut[s / 2] -= *v;
        *v = 0;
    }
}

/* The mean nodal velocity of the step, through which nodal forces work on the points. */
static inline mpm_real mpm__mean_velocity(const mpm_world *w, const mpm_node *n, int d)
{
    const mpm_real shift = n->touch < 0 ? 0 : w->touch[n->touch].shift[d];
    return MPM_R(0.5) * ((n->momentum[d] - n->force[d] * w->dt - shift) / n->mass + n->velocity[d]);
}

/* ---- what extensions use ---------------------------------------------------------------------- */

/* The node that stands for node g of axis d. Beyond a symmetry plane or a fixed side there are none: what points lend
   to a ghost there belongs, mirrored, to the node on this side; the run's flags then say so. */
static inline int32_t mpm__image_node(const mpm_world *w, int d, int32_t g, int32_t *flags)
{
    const int32_t last = w->nodes_per_axis[d] - 1 - w->ghost;
    const mpm_side low = w->desc.side[2 * d], high = w->desc.side[2 * d + 1];
    if (g < w->ghost && (low == MPM_SIDE_SYMMETRY || low == MPM_SIDE_FIXED)) {
        *flags |= (low == MPM_SIDE_FIXED ? 129 : 1) << d;
        return 2 * w->ghost - g;
    }
    if (g > last && (high == MPM_SIDE_SYMMETRY || high == MPM_SIDE_FIXED)) {
        *flags |= (high == MPM_SIDE_FIXED ? 1032 : 8) << d;
        return 2 * last - g;
    }
    return g;
}

/* Fills a support with values, gradients and images from the weights of a place whose base and sides are a run's. */
static inline void mpm__support(const mpm_world *w, const mpm_run *run, const mpm__weights *one, mpm_support *s)
{
    const int k = w->support[0], ky = w->support[1];
    int a, d;
    mpm__products(one, 0, k, ky, s->N);
    mpm__gradients(one, 0, k, ky, s->G);
    s->count = k * ky * k;
    memset(s->mirror, 0, sizeof s->mirror);
    memset(s->image, 0, sizeof s->image);
    for (a = 0; a < s->count && run->flags & 63; a++)
        for (d = 0; d < 3; d++) {
            if (mpm__mirror(run, a, d, k, ky) < 0) s->mirror[a] = (uint8_t)(s->mirror[a] | 1 << d);
            if (mpm__turned(run, a, d, k, ky) < 0) s->image[a] = (uint8_t)(s->image[a] | 1 << d);
        }
}

MPM_API void mpm_support_of(const mpm_world *w, const mpm_run *run, int32_t i, mpm_support *s)
{
    mpm__weights one;
    mpm__weigh(w, run, i, 1, w->support[0], w->support[1], &one);
    mpm__support(w, run, &one, s);
    memcpy(s->slot, mpm__run_nodes(w, run), (size_t)s->count * sizeof s->slot[0]);
}

/* Takes the nodes without a slot out of a support. */
static inline void mpm__support_close(mpm_support *s)
{
    int a, d, n = 0;
    for (a = 0; a < s->count; a++) {
        if (s->slot[a] < 0) continue;
        s->slot[n] = s->slot[a];
        s->N[n] = s->N[a];
        for (d = 0; d < 3; d++) s->G[d][n] = s->G[d][a];
        s->image[n] = s->image[a];
        s->mirror[n++] = s->mirror[a];
    }
    s->count = n;
}

MPM_API int mpm_support_at(const mpm_world *w, int32_t body, const mpm_real x[3], mpm_support *s)
{
    const int *n = w->support;
    mpm__weights one;
    mpm_run at;
    int32_t node[3][4];
    int i, d;
    s->count = 0;
    memset(&at, 0, sizeof at);
    one.n = 1;
    for (d = 0; d < 3; d++) {
        const int32_t last = w->nodes_per_axis[d] - n[d];
        const mpm_real shift = n[d] == 3 ? MPM_R(0.5) : 0, high = (mpm_real)w->desc.cells[d];
        mpm_real t = n[d] == 1 ? 0 : (x[d] - w->desc.origin[d]) / w->desc.cell;
        if (t < 0 && w->desc.side[2 * d] != MPM_SIDE_OPEN) t = 0; /* what lies behind a closed side is on it */
        if (t > high && w->desc.side[2 * d + 1] != MPM_SIDE_OPEN) t = high;
        if (!(t >= 0 && t <= high)) return 0;
        at.base[d] = (int32_t)(t + shift) < last ? (int32_t)(t + shift) : last;
        t -= (mpm_real)(at.base[d] - (n[d] == 1 ? 0 : w->ghost));
        mpm__weights_axis(&one, d, n[d], &t, mpm__point_size(w, body) / 2, 1 / w->desc.cell);
        for (i = 0; i < n[d]; i++) node[d][i] = mpm__image_node(w, d, at.base[d] + i, &at.flags);
    }
    mpm__support(w, &at, &one, s);
    for (i = 0; i < s->count; i++) {
        const int32_t ix = node[0][i % n[0]], iy = node[1][i / n[0] % n[1]], iz = node[2][i / n[0] / n[1]];
        s->slot[i] = mpm_node_find(w, (iz * w->nodes_per_axis[1] + iy) * w->nodes_per_axis[0] + ix, body);
    }
    mpm__support_close(s);
    return s->count > 0;
}

/* -1 where component d of node a of a support moves against its node. */
static inline mpm_real mpm__sign(const mpm_support *s, int a, int d)
{
    return s->mirror[a] >> d & 1 ? MPM_R(-1.0) : MPM_R(1.0);
}

MPM_API void mpm_support_velocity(const mpm_world *w, const mpm_support *s, mpm_real v[3])
{
    int a, d;
    v[0] = v[1] = v[2] = 0;
    for (a = 0; a < s->count; a++) {
        const mpm_node *n = &w->node[s->slot[a]];
        if (!(n->mass > w->desc.mass_cutoff * w->body[n->body].point_mass)) continue;
        for (d = 0; d < 3; d++) v[d] += s->N[a] * mpm__sign(s, a, d) * n->momentum[d] / n->mass;
    }
}

MPM_API void mpm_support_mapped(const mpm_world *w, const mpm_support *s, mpm_real v[3])
{
    int a, d;
    v[0] = v[1] = v[2] = 0;
    for (a = 0; a < s->count; a++)
        for (d = 0; d < 3; d++) v[d] += s->N[a] * mpm__sign(s, a, d) * w->node[s->slot[a]].velocity[d];
}

/* Momentum j that node a of a support takes of a force f in a step, as far as its mass and its sides let it. */
static inline void mpm__pushed(const mpm_world *w, const mpm_support *s, int a, const mpm_real *f, mpm_real *j)
{
    const mpm_node *n = &w->node[s->slot[a]];
    const int light = !(n->mass > w->desc.mass_cutoff * w->body[n->body].point_mass);
    int d;
    for (d = 0; d < 3; d++) j[d] = light ? 0 : s->N[a] * mpm__sign(s, a, d) * f[d] * w->dt;
    mpm__constrain(w, n, j, NULL);
}

MPM_API void mpm_push(mpm_world *w, const mpm_support *s, const mpm_real f[3])
{
    int a, d;
    for (a = 0; a < s->count; a++) {
        mpm_node *n = &w->node[s->slot[a]];
        mpm_real j[3];
        mpm__pushed(w, s, a, f, j);
        for (d = 0; d < 3; d++) {
            n->force[d] += j[d] / w->dt;
            n->reaction[d] += j[d];
            w->ledger.impulse[d] += (double)j[d];
        }
    }
}

MPM_API double mpm_support_work(const mpm_world *w, const mpm_support *s, const mpm_real f[3])
{
    double work = 0;
    int a, d;
    for (a = 0; a < s->count; a++) {
        const mpm_node *n = &w->node[s->slot[a]];
        mpm_real j[3];
        mpm__pushed(w, s, a, f, j);
        for (d = 0; d < 3 && n->mass > 0; d++) work += (double)(j[d] * mpm__mean_velocity(w, n, d));
    }
    return work;
}

MPM_API int32_t mpm_node_find(const mpm_world *w, int32_t index, int32_t body)
{
    int32_t s = index >= 0 && (size_t)index < mpm__grid_nodes(w) ? w->head[index] : -1;
    while (s >= 0 && w->node[s].body != body) s = w->node[s].next;
    return s;
}

MPM_API void mpm_node_position(const mpm_world *w, const mpm_node *n, mpm_real x[3])
{
    const int32_t nx = w->nodes_per_axis[0], ny = w->nodes_per_axis[1];
    const int32_t at[3] = {n->index % nx, n->index / nx % ny, n->index / nx / ny};
    int d;
    for (d = 0; d < 3; d++) x[d] = w->desc.origin[d] + (mpm_real)(at[d] - w->ghost) * w->desc.cell;
    if (mpm__flat(&w->desc)) x[1] = 0;
}

/* ---- calming ------------------------------------------------------------------------------ */

#define MPM__CALM_BEATS 8       /* of mpm_calm in its time */
#define MPM__CALM_VELOCITIES 10 /* steps of conjugate gradients: most of what the grid sees is left to it, and
                                   round-off, which they amplify, is still small */
#define MPM__CALM_PRESSURES 2   /* ... what it hardly sees goes too */

/* What of a body is calmed: `parts` 3 its velocities; 1 its pressures, which are the same on both sides of a mirror.
   Its runs and nodes, first ones and those after the last. Nodes hold f_I as momentum; of conjugate gradients, what is
   left of the right hand side as velocity, the direction as reaction, the matrix times it as force. */
typedef struct mpm__calmed {
    int parts, held;          /* bit d: a side holds part d at some node */
    int32_t run, runs, node, nodes;
    double left[3], first[3]; /* left . left / mass, now and at first */
    double sum[3], mass;      /* of the points: of m f, of m */
} mpm__calmed;

static inline mpm_real mpm__mean_pressure(const mpm_points *q, int32_t i)
{
    return -(q->stress[0][i] + q->stress[1][i] + q->stress[2][i]) / 3;
}

/* Part d of what is calmed, of point i. */
static inline mpm_real mpm__calm_part(const mpm_points *q, const mpm__calmed *c, int d, int32_t i)
{
    return c->parts == 3 ? q->v[d][i] : mpm__mean_pressure(q, i);
}

/* The direction of a run's nodes, or f_I. */
static inline void mpm__calm_fetch(const mpm_world *w, const mpm_run *r, const mpm__calmed *c, int direction,
                                   mpm_real (*V)[4])
{
    const int k = w->support[0], ky = w->support[1];
    const int32_t *slot = mpm__run_nodes(w, r);
    int a, d;
    for (a = 0; a < k * ky * k; a++) {
        const mpm_node *n = &w->node[slot[a]];
        for (V[a][3] = 0, d = 0; d < 3; d++) V[a][d] = direction ? n->reaction[d] : n->momentum[d];
    }
    if (c->parts == 3 && r->flags & 63) mpm__turn(r, k, ky, V[0], 4, 1);
    mpm__as_polynomial(k, ky, V);
}

/* To the forces of a run's nodes: sum m N f of the points' f and the mass, or of f = S direction. */
MPM_KERNEL void mpm__calm_map_run(mpm_world *w, const mpm_run *r, int k, int ky, const mpm__calmed *c, int direction)
{
    const int32_t *slot = mpm__run_nodes(w, r);
    mpm_real V[MPM_SUPPORT][4], F[3][MPM_SUPPORT] = {{0}}, M[MPM_SUPPORT] = {0}, N[MPM_SUPPORT], seen[3][MPM__LANES];
    mpm__weights s;
    int32_t at;
    int n, p, a, d;
    if (direction) mpm__calm_fetch(w, r, c, 1, V);
    MPM__EACH_PIECE(r, at, n) {
        mpm__weigh(w, r, at, n, k, ky, &s);
        for (d = 0; d < c->parts && direction; d++) mpm__values(&s, 0, n, k, ky, V, d, seen[d]);
        for (p = 0; p < n; p++) {
            const mpm_real m = w->points.mass[at + p];
            mpm__products(&s, p, k, ky, N);
            for (a = 0; a < k * ky * k && !direction; a++) M[a] += m * N[a];
            for (d = 0; d < c->parts; d++) {
                const mpm_real f = m * (direction ? seen[d][p] : mpm__calm_part(&w->points, c, d, at + p));
                for (a = 0; a < k * ky * k; a++) F[d][a] += f * N[a];
            }
        }
    }
    if (c->parts == 3 && r->flags & 63) mpm__turn(r, k, ky, F[0], 1, MPM_SUPPORT);
    for (a = 0; a < k * ky * k; a++) {
        w->node[slot[a]].mass += M[a];
        for (d = 0; d < 3; d++) w->node[slot[a]].force[d] += F[d][a];
    }
}

/* ... of all runs of the body, without what sides forbid. */
static inline void mpm__calm_map(mpm_world *w, const mpm__calmed *c, int direction)
{
    int32_t i;
#define MPM__CALL(k, ky, hoop) mpm__calm_map_run(w, &w->run[i], k, ky, c, direction)
    for (i = c->run; i < c->runs; i++) MPM__SPECIALISED(w, 0, MPM__CALL);
#undef MPM__CALL
    for (i = c->node; i < c->nodes; i++)
        if (c->parts == 3 && w->node[i].flags) mpm__constrain(w, &w->node[i], w->node[i].force, NULL);
}

/* The next direction, conjugate to those before it. */
static inline void mpm__calm_turn(mpm_world *w, mpm__calmed *c)
{
    int32_t i;
    int d;
    for (d = 0; d < c->parts; d++) {
        const double before = c->left[d];
        mpm_real keep;
        c->left[d] = 0;
        for (i = c->node; i < c->nodes; i++) {
            const mpm_node *n = &w->node[i];
            if (n->mass > 0) c->left[d] += (double)(n->velocity[d] * (n->velocity[d] / n->mass));
        }
        keep = (mpm_real)(before > 0 ? c->left[d] / before : 0);
        for (i = c->node; i < c->nodes; i++) {
            mpm_node *n = &w->node[i];
            n->reaction[d] = (n->mass > 0 ? n->velocity[d] / n->mass : 0) + keep * n->reaction[d];
        }
    }
}

/* As far along the direction as is best. */
static inline void mpm__calm_go(mpm_world *w, const mpm__calmed *c)
{
    int32_t i;
    int d;
    for (d = 0; d < c->parts; d++) {
        const double enough = (double)MPM_EPSILON * (double)MPM_EPSILON * c->first[d];
        double slope = 0;
        mpm_real go;
        for (i = c->node; i < c->nodes; i++) slope += (double)(w->node[i].reaction[d] * w->node[i].force[d]);
        go = (mpm_real)(c->left[d] > enough && slope > 0 ? c->left[d] / slope : 0);
        for (i = c->node; i < c->nodes; i++) {
            mpm_node *n = &w->node[i];
            n->momentum[d] += go * n->reaction[d];
            n->velocity[d] -= go * n->force[d];
            n->force[d] = 0;
        }
    }
}

/* Lifts f_I to the momentum of the points: at the beginning to their mean, which all directions then keep, but for the
   round-off that is taken out at the end. Not in a part that a side holds somewhere. */
static inline void mpm__calm_level(mpm_world *w, const mpm__calmed *c)
{
    int32_t i;
    int d;
    for (d = 0; d < c->parts; d++) {
        double lacks = c->sum[d];
        mpm_real lift;
        for (i = c->node; i < c->nodes; i++) lacks -= (double)(w->node[i].mass * w->node[i].momentum[d]);
        lift = (mpm_real)(c->held >> d & 1 ? 0 : lacks / c->mass);
        for (i = c->node; i < c->nodes; i++) w->node[i].momentum[d] += lift;
    }
}

/* The parts that sides hold at this node, as bits. */
static inline int mpm__calm_held(const mpm_world *w, const mpm__calmed *c, const mpm_node *n)
{
    mpm_real free_parts[3] = {1, 1, 1};
    int d, held = 0;
    if (c->parts == 3) mpm__constrain(w, n, free_parts, NULL);
    for (d = 0; d < 3; d++) held |= free_parts[d] < 1 ? 1 << d : 0;
    return held;
}

/* Maps the points, and sums up what they map. */
static inline void mpm__calm_begin(mpm_world *w, mpm__calmed *c)
{
    int32_t i;
    int d;
    mpm__calm_map(w, c, 0);
    for (c->held = 0, c->mass = 0, d = 0; d < 3; d++) c->sum[d] = c->left[d] = 0;
    for (i = c->node; i < c->nodes; i++) {
        c->held |= mpm__calm_held(w, c, &w->node[i]);
        for (c->mass += (double)w->node[i].mass, d = 0; d < 3; d++) c->sum[d] += (double)w->node[i].force[d];
    }
    mpm__calm_level(w, c);
    for (i = c->node; i < c->nodes; i++)
        for (d = 0; d < 3; d++) {
            mpm_node *n = &w->node[i];
            n->velocity[d] = n->force[d] - n->mass * n->momentum[d];
            n->force[d] = 0;
        }
}

/* f_I of the body's points. */
static inline void mpm__calm_see(mpm_world *w, mpm__calmed *c, int steps)
{
    int step;
    mpm__calm_begin(w, c);
    for (step = 0; step < steps; step++) {
        mpm__calm_turn(w, c);
        if (step == 0) memcpy(c->first, c->left, sizeof c->first);
        mpm__calm_map(w, c, 1);
        mpm__calm_go(w, c);
    }
    mpm__calm_level(w, c);
}

/* Takes `share` of what is not seen from the velocity of point i. */
static inline void mpm__calm_velocity(mpm_world *w, int32_t i, const mpm_real *rest, mpm_real share)
{
    mpm_points *q = &w->points;
    const mpm_real heat = share * (1 - share / 2) * (rest[0] * rest[0] + rest[1] * rest[1] + rest[2] * rest[2]);
    int d;
    for (d = 0; d < 3; d++) {
        q->v[d][i] -= share * rest[d];
        w->ledger.impulse[d] -= (double)(q->mass[i] * share * rest[d]); /* of mirrors and fixed sides: else 0 in sum */
    }
    q->energy[i] += heat;
    w->ledger.calm += (double)(q->mass[i] * heat);
}

/* ... from its pressure, by exchange of volume. */
static inline void mpm__calm_pressure(mpm_world *w, const mpm_body_desc *b, int32_t i, mpm_real rest, mpm_real share)
{
    mpm_points *q = &w->points;
    const mpm_real K = b->density * (b->wave_p * b->wave_p - MPM_R(4.0) / 3 * b->wave_s * b->wave_s);
    const mpm_real volume = share * rest / (b->density * K); /* per mass */
    int d;
    q->energy[i] -= (mpm__mean_pressure(q, i) - rest) * volume;
    q->density[i] /= 1 + q->density[i] * volume;
    for (d = 0; d < 3; d++) q->stress[d][i] += share * rest;
    w->ledger.calm += (double)(q->mass[i] * (1 - share / 2) * rest * volume);
}

MPM_KERNEL void mpm__calm_run(mpm_world *w, const mpm_run *r, int k, int ky, const mpm__calmed *c, mpm_real share)
{
    mpm_real V[MPM_SUPPORT][4], seen[3][MPM__LANES], rest[3];
    mpm__weights s;
    int32_t at;
    int n, p, d;
    mpm__calm_fetch(w, r, c, 0, V);
    MPM__EACH_PIECE(r, at, n) {
        mpm__weigh(w, r, at, n, k, ky, &s);
        for (d = 0; d < c->parts; d++) mpm__values(&s, 0, n, k, ky, V, d, seen[d]);
        for (p = 0; p < n; p++) {
            for (d = 0; d < c->parts; d++) rest[d] = mpm__calm_part(&w->points, c, d, at + p) - seen[d][p];
            if (c->parts == 3) mpm__calm_velocity(w, at + p, rest, share);
            else mpm__calm_pressure(w, &w->body[r->body].desc, at + p, rest[0], share);
        }
    }
}

/* Velocities or pressures of a body. Leaves its nodes as they were: empty. */
static inline void mpm__calm_body(mpm_world *w, mpm__calmed *c, int parts, int steps, mpm_real share)
{
    const size_t bytes = sizeof w->node->momentum;
    int32_t i;
    c->parts = parts;
    mpm__calm_see(w, c, steps);
#define MPM__CALL(k, ky, hoop) mpm__calm_run(w, &w->run[i], k, ky, c, share)
    for (i = c->run; i < c->runs; i++) MPM__SPECIALISED(w, 0, MPM__CALL);
#undef MPM__CALL
    for (i = c->node; i < c->nodes; i++) {
        mpm_node *n = &w->node[i];
        n->mass = 0;
        memset(n->momentum, 0, bytes);
        memset(n->velocity, 0, bytes);
        memset(n->reaction, 0, bytes);
    }
}

/* The share that dies out in this step: in short steps, where it reaches the next beat. */
static inline mpm_real mpm__calm_share(const mpm_world *w)
{
    const mpm_real beat = w->desc.calm / MPM__CALM_BEATS;
    mpm_real t = w->dt;
    if (!(w->desc.calm > 0)) return 0;
    if (t < beat) t = beat * (mpm_real)((int64_t)((w->time + t) / beat) - (int64_t)(w->time / beat));
    return -mpm_expm1(-t / w->desc.calm);
}

MPM_API void mpm_calm(mpm_world *w)
{
    const mpm_real share = mpm__calm_share(w);
    int32_t b;
    mpm__calmed c;
    memset(&c, 0, sizeof c);
    for (b = 0; b < w->bodies && share > 0; b++) { /* runs and nodes lie in the order of bodies */
        const mpm_body_desc *d = &w->body[b].desc;
        c.run = c.runs;
        c.node = c.nodes;
        while (c.runs < w->runs && w->run[c.runs].body == b) c.runs++;
        while (c.nodes < w->nodes && w->node[c.nodes].body == b) c.nodes++;
        mpm__calm_body(w, &c, 3, MPM__CALM_VELOCITIES, share);
        if (d->stress && d->wave_p * d->wave_p > MPM_R(4.0) / 3 * d->wave_s * d->wave_s)
            mpm__calm_body(w, &c, 1, MPM__CALM_PRESSURES, share);
    }
}

/* ---- to the nodes ------------------------------------------------------------------------- */

/* What a sweep over the points does; two that follow each other share one sweep and its weights. */
enum { MPM__P2G = 1, MPM__FORCES = 2, MPM__G2P = 4, MPM__MUSL = 8 };

/* What the points of a span give to their nodes: mass, momentum, stress times minus their volume, and in rings the pull
   of the hoop stress inwards. */
typedef struct mpm__gifts {
    mpm_real mass[MPM__LANES], momentum[3][MPM__LANES], stress[6][MPM__LANES], pull[MPM__LANES];
} mpm__gifts;

/* Their sums at the nodes of a run, in lines of four along x: with three nodes along x the fourth is idle. */
typedef struct mpm__shares {
    mpm_real mass[MPM_SUPPORT], momentum[3][MPM_SUPPORT], force[3][MPM_SUPPORT];
} mpm__shares;

/* Some of these sums, side by side. */
typedef struct mpm__lot {
    mpm__wide mass, momentum[3], force[3];
} mpm__lot;

/* m_p v_p of points [at, at + n). */
MPM_KERNEL void mpm__give_momentum(const mpm_points *q, int32_t at, int n, mpm__gifts *g)
{
    int p, d;
    for (p = 0; p < n; p++) g->mass[p] = q->mass[at + p];
    for (d = 0; d < 3; d++)
        for (p = 0; p < n; p++) g->momentum[d][p] = g->mass[p] * q->v[d][at + p];
}

/* -(m_p / rho_p) sigma_p of points [at, at + n), and the part of it that pulls rings inwards. */
MPM_KERNEL void mpm__give_stress(const mpm_points *q, int32_t at, int n, int hoop, mpm__gifts *g)
{
    mpm_real volume[MPM__LANES];
    int p, c;
    for (p = 0; p < n; p++) volume[p] = -q->mass[at + p] / q->density[at + p];
    for (c = 0; c < 6; c++)
        for (p = 0; p < n; p++) g->stress[c][p] = volume[p] * q->stress[c][at + p];
    for (p = 0; p < n && hoop; p++) g->pull[p] = g->stress[1][p] / q->x[0][at + p];
}

MPM_KERNEL void mpm__lot_fetch(mpm__lot *l, const mpm__shares *from, int a)
{
    int d;
    l->mass = mpm__load(from->mass + a);
    for (d = 0; d < 3; d++) l->momentum[d] = mpm__load(from->momentum[d] + a);
    for (d = 0; d < 3; d++) l->force[d] = mpm__load(from->force[d] + a);
}

MPM_KERNEL void mpm__lot_put(const mpm__lot *l, mpm__shares *to, int a, int what)
{
    int d;
    if (what & MPM__P2G) mpm__store(to->mass + a, l->mass);
    for (d = 0; d < 3 && what & (MPM__P2G | MPM__MUSL); d++) mpm__store(to->momentum[d] + a, l->momentum[d]);
    for (d = 0; d < 3 && what & MPM__FORCES; d++) mpm__store(to->force[d] + a, l->force[d]);
}

/* m_I += m_p N_I (A 3.23), P_I += m_p v_p N_I (A 3.24, 3.33) and f_I -= (m_p / rho_p) sigma_p . grad N_I (A 3.25), in
   rings with f_Ir -= (m_p / rho_p) sigma_hoop N_I / r_p, of point p at the nodes that N and G belong to. */
MPM_KERNEL void mpm__lot_add(mpm__lot *l, const mpm__gifts *g, int p, mpm__wide N, const mpm__wide *G, int hoop,
                             int what)
{
    int d;
    if (what & MPM__P2G) l->mass += g->mass[p] * N;
    for (d = 0; d < 3 && what & (MPM__P2G | MPM__MUSL); d++) l->momentum[d] += g->momentum[d][p] * N;
    if (what & MPM__FORCES) {
        const mpm_real xx = g->stress[0][p], yy = g->stress[1][p], zz = g->stress[2][p];
        const mpm_real yz = g->stress[3][p], xz = g->stress[4][p], xy = g->stress[5][p];
        l->force[0] += xx * G[0] + xy * G[1] + xz * G[2];
        l->force[1] += xy * G[0] + yy * G[1] + yz * G[2];
        l->force[2] += xz * G[0] + yz * G[1] + zz * G[2];
        if (hoop) l->force[0] += g->pull[p] * N;
    }
}

/* Which of 1 - u and u a corner of a cell has of an axis: 1 - u = 1 + (-1) u, u = 0 + 1 u. */
MPM_KERNEL mpm__wide mpm__corner_sign(int a, int stride)
{
    static const mpm_real sign[3][8] = {
        {-1, 1, -1, 1, -1, 1, -1, 1}, {-1, -1, 1, 1, -1, -1, 1, 1}, {-1, -1, -1, -1, 1, 1, 1, 1}};
    return mpm__load(sign[stride / 2] + a);
}

MPM_KERNEL mpm__wide mpm__corner_start(int a, int stride)
{
    static const mpm_real start[3][8] = {{1, 0, 1, 0, 1, 0, 1, 0}, {1, 1, 0, 0, 1, 1, 0, 0}, {1, 1, 1, 1, 0, 0, 0, 0}};
    return mpm__load(start[stride / 2] + a);
}

/* Adds points [at, at + n) of a span to the corners of their cell: linear functions. */
MPM_KERNEL void mpm__share_corners(const mpm__weights *s, const mpm__gifts *g, int at, int n, int ky, int hoop,
                                   int what, mpm__shares *to)
{
    int a, p;
    for (a = 0; a < 4 * ky; a += MPM__WIDE) {
        const mpm__wide sx = mpm__corner_sign(a, 1), x0 = mpm__corner_start(a, 1), dx = sx * s->slope;
        const mpm__wide sy = mpm__corner_sign(a, 2), y0 = mpm__corner_start(a, 2), dy = sy * s->slope;
        const mpm__wide sz = mpm__corner_sign(a, 2 * ky), z0 = mpm__corner_start(a, 2 * ky), dz = sz * s->slope;
        mpm__lot l;
        mpm__lot_fetch(&l, to, a);
        for (p = at; p < at + n; p++) {
            const mpm__wide X = x0 + sx * s->N[0][1][p], Z = z0 + sz * s->N[2][1][p];
            const mpm__wide Y = ky > 1 ? y0 + sy * s->N[1][1][p] : Z, YZ = ky > 1 ? Y * Z : Z;
            const mpm__wide G[3] = {dx * YZ, ky > 1 ? X * (dy * Z) : X * 0, ky > 1 ? X * (Y * dz) : X * dz};
            mpm__lot_add(&l, g, p, X * YZ, G, hoop, what);
        }
        mpm__lot_put(&l, to, a, what);
    }
}

/* The weights along x of each point side by side. */
typedef struct mpm__along {
    mpm_real N[MPM__LANES][4], dN[MPM__LANES][4];
} mpm__along;

static inline void mpm__along_x(const mpm__weights *s, int k, mpm__along *x)
{
    int p, i;
    for (p = 0; p < s->n; p++)
        for (i = 0; i < 4; i++) {
            x->N[p][i] = i < k ? s->N[0][i][p] : 0;
            x->dN[p][i] = i < k ? s->dN[0][i][p] : 0;
        }
}

/* Adds points [at, at + n) of a span to the lines of their nodes: all other functions. */
MPM_KERNEL void mpm__share_lines(const mpm__weights *s, const mpm__along *x, const mpm__gifts *g, int at, int n, int k,
                                 int ky, int hoop, int what, mpm__shares *to)
{
    int iy, iz, i, p;
    for (iz = 0; iz < k; iz++)
        for (iy = 0; iy < ky; iy++)
            for (i = 0; i < 4; i += MPM__WIDE) {
                const int a = (iz * ky + iy) * 4 + i;
                mpm__lot l;
                mpm__lot_fetch(&l, to, a);
                for (p = at; p < at + n; p++) {
                    const mpm_real y = s->N[1][iy][p], z = s->N[2][iz][p];
                    const mpm_real yz = y * z, dyz = s->dN[1][iy][p] * z, ydz = y * s->dN[2][iz][p];
                    const mpm__wide X = mpm__load(x->N[p] + i);
                    const mpm__wide G[3] = {mpm__load(x->dN[p] + i) * yz, X * dyz, X * ydz};
                    mpm__lot_add(&l, g, p, X * yz, G, hoop, what);
                }
                mpm__lot_put(&l, to, a, what);
            }
}

/* Where node a of a run is among its lines of four. */
MPM_KERNEL int mpm__in_lines(int a, int k) { return k == 3 ? a / 3 * 4 + a % 3 : a; }

MPM_KERNEL void mpm__share_out(const mpm__weights *s, const mpm__along *x, const mpm__gifts *g, int at, int n, int k,
                               int ky, int hoop, int what, mpm__shares *to)
{
    if (k == 2) mpm__share_corners(s, g, at, n, ky, hoop, what, to);
    else mpm__share_lines(s, x, g, at, n, k, ky, hoop, what, to);
}

MPM_KERNEL void mpm__clear_shares(int k, int ky, mpm__shares *s)
{
    const int n = k == 2 ? 4 * ky : 4 * ky * k;
    int a, d;
    for (a = 0; a < n; a++) s->mass[a] = 0;
    for (d = 0; d < 3; d++)
        for (a = 0; a < n; a++) s->momentum[d][a] = s->force[d][a] = 0;
}

/* The turning of images in what a run's nodes get. */
static inline void mpm__turn_shares(const mpm_run *r, int k, int ky, mpm__shares *s)
{
    int a, d;
    for (a = 0; a < k * ky * k; a++)
        for (d = 0; d < 3; d++) {
            const mpm_real turn = mpm__mirror(r, a, d, k, ky);
            s->momentum[d][mpm__in_lines(a, k)] *= turn;
            s->force[d][mpm__in_lines(a, k)] *= turn;
        }
}

/* The sums to the nodes of run r; nothing is left of them. */
MPM_KERNEL void mpm__hand_out(mpm_world *w, const mpm_run *r, int k, int ky, int what, mpm__shares *s)
{
    const int32_t *slot = mpm__run_nodes(w, r);
    int a, d;
    if (r->flags & 63) mpm__turn_shares(r, k, ky, s);
    for (a = 0; a < k * ky * k; a++) {
        const int from = mpm__in_lines(a, k);
        mpm_node *n = &w->node[slot[a]];
        if (what & MPM__P2G) n->mass += s->mass[from];
        for (d = 0; d < 3 && what & MPM__P2G; d++) n->momentum[d] += s->momentum[d][from];
        for (d = 0; d < 3 && what & MPM__FORCES; d++) n->force[d] += s->force[d][from];
        for (d = 0; d < 3 && what & MPM__MUSL; d++) n->velocity[d] += s->momentum[d][from];
    }
    mpm__clear_shares(k, ky, s);
}

MPM_KERNEL void mpm__to_nodes_body(mpm_world *w, const mpm_run *r, const mpm_run *end, int k, int ky, int hoop,
                                   int what)
{
    mpm__weights s;
    mpm__along x;
    mpm__gifts g;
    mpm__shares sums;
    int32_t first;
    int n, at, part;
    mpm__clear_shares(k, ky, &sums);
    MPM__EACH_SPAN(r, end, first, n) {
        const mpm_run *of = r;
        mpm__weigh_span(w, r, first, n, k, ky, &s);
        if (k != 2) mpm__along_x(&s, k, &x);
        if (what & MPM__P2G) mpm__give_momentum(&w->points, first, n, &g);
        if (what & MPM__FORCES) mpm__give_stress(&w->points, first, n, hoop, &g);
        MPM__EACH_PART(of, first, n, at, part) {
            mpm__share_out(&s, &x, &g, at, part, k, ky, hoop, what, &sums);
            if (mpm__run_ends(of, first + at + part)) mpm__hand_out(w, of, k, ky, what, &sums);
        }
    }
}

static inline void mpm__sweep_to_nodes(mpm_world *w, int what)
{
#define MPM__CALL(k, ky, hoop) mpm__to_nodes_body(w, w->run + from, w->run + to, k, ky, hoop, what)
    MPM__EACH_BODY(w, 1, MPM__CALL);
#undef MPM__CALL
}

/* Essential boundary conditions on the momentum of level k. */
static inline void mpm__constrain_momentum(mpm_world *w)
{
    int32_t i;
    for (i = 0; i < w->nodes; i++)
        if (w->node[i].flags) mpm__constrain(w, &w->node[i], w->node[i].momentum, NULL);
}

MPM_API void mpm_p2g(mpm_world *w)
{
    mpm__sweep_to_nodes(w, MPM__P2G);
    mpm__constrain_momentum(w);
}

/* Stiffness of the springs beside the dampers at point i, times its area: 2.5 G/r along the face's normal and 0.4 of
   that across, r from the middle of the body's upper face. A point load on a half space leaves tractions and
   displacements that fall as 1/r^2 and 1/r: their ratio is G/r times a number (viscous-spring boundary: Deeks,
   Randolph, J. Eng. Mech. 120 (1994) 25; Liu, Du, Du, Wang, Wu, Earthq. Eng. Eng. Vib. 5 (2006) 29). */
static inline mpm_real mpm__spring(const mpm_world *w, const mpm_body *b, int32_t i, mpm_real area)
{
    const mpm_shape *s = &b->desc.shape;
    const mpm_real shear = b->desc.density * b->desc.wave_s * b->desc.wave_s;
    mpm_real square = 0;
    int d;
    for (d = 0; d < 3; d++) {
        const mpm_real from = w->points.x[d][i] - s->center[d] - (d == 2 ? s->half[2] : 0);
        if (d != 1 || !mpm__flat(&w->desc)) square += from * from;
    }
    return MPM_R(2.5) * b->desc.absorb_spring * shear * area / mpm_sqrt(square);
}

/* Traction of springs on a point of a damped face, -K u, added to t; vn: how far it is out along the normal. */
static inline void mpm__spring_pull(const mpm_world *w, const mpm_body *b, int32_t i, mpm_real area,
                                    const mpm_real *normal, mpm_real *t)
{
    const mpm_real stiff = mpm__spring(w, b, i, area);
    mpm_real u[3] = {0, 0, 0}, un = 0;
    int d;
    for (d = 0; d < 3; d++)
        if (b->place[d] >= 0) u[d] = w->points.x[d][i] - w->points.user[b->place[d]][i];
    for (d = 0; d < 3; d++) un += u[d] * normal[d];
    for (d = 0; d < 3; d++) t[d] -= stiff * (MPM_R(0.4) * u[d] + MPM_R(0.6) * un * normal[d]);
}

/* Viscous dampers of one run: traction -a rho Vp v_n - b rho Vs v_t at the points of the damped
   faces, times the area they represent: of the true face, their share of its mass. The velocity is
   the grid's at the point, so that the damper takes energy and nothing else. Springs stand beside them on request. */
static inline void mpm__absorb_run(mpm_world *w, const mpm_run *r)
{
    const mpm_real dt = w->dt;
    const int k = w->support[0], ky = w->support[1];
    const mpm_points *q = &w->points;
    const mpm_body *b = &w->body[r->body];
    const mpm_body_desc *d = &b->desc;
    mpm_real F[3][MPM_SUPPORT] = {{0}}, V[MPM_SUPPORT][4], N[MPM_SUPPORT], moves[3][MPM__LANES];
    mpm__weights s;
    int32_t at;
    int n, p, a, c, face, any = 0;
    for (at = r->first; at < r->first + r->count; at++) any |= q->flags[at];
    if (!(any & d->absorb)) return;
    mpm__gather_polynomial(w, r, k, ky, MPM__MOMENTUM, 1, V);
    MPM__EACH_PIECE(r, at, n) {
        mpm__weigh(w, r, at, n, k, ky, &s);
        for (c = 0; c < 3; c++) mpm__values(&s, 0, n, k, ky, V, c, moves[c]);
        for (p = 0; p < n; p++)
            for (face = 0; face < 2; face++) {
                const int32_t i = at + p;
                mpm_real v[3], normal[3] = {0, 0, 1}, vn = 0, cn, ct, t[3];
                if (!(q->flags[i] & d->absorb & (face ? MPM_FACE_RIM : MPM_FACE_BOTTOM))) continue;
                if (face) { /* radial, whatever the section */
                    mpm_real x = q->x[0][i] - d->shape.center[0], y = ky > 1 ? q->x[1][i] - d->shape.center[1] : 0;
                    mpm_real radius = mpm_sqrt(x * x + y * y);
                    normal[0] = radius > 0 ? x / radius : 1;
                    normal[1] = radius > 0 ? y / radius : 0;
                    normal[2] = 0;
                }
                cn = d->absorb_normal * d->density * d->wave_p * b->area[face] * q->mass[i] / b->mass[face];
                ct = d->absorb_shear * d->density * d->wave_s * b->area[face] * q->mass[i] / b->mass[face];
                for (c = 0; c < 3; c++) v[c] = moves[c][p];
                for (c = 0; c < 3; c++) vn += v[c] * normal[c];
                mpm__products(&s, p, k, ky, N);
                for (c = 0; c < 3; c++) t[c] = -(cn - ct) * vn * normal[c] - ct * v[c];
                if (d->absorb_spring > 0)
                    mpm__spring_pull(w, b, i, b->area[face] * q->mass[i] / b->mass[face], normal, t);
                for (c = 0; c < 3; c++) {
                    for (a = 0; a < k * ky * k; a++) F[c][a] += t[c] * N[a];
                    w->ledger.absorbed -= (double)(t[c] * v[c] * dt);
                }
            }
    }
    for (c = 0; c < 3; c++)
        for (a = 0; a < k * ky * k; a++) w->ledger.impulse[c] += (double)(F[c][a] * mpm__mirror(r, a, c, k, ky) * dt);
    mpm__scatter(w, r, k, ky, MPM__FORCE, F);
}

/* With ghosts, internal forces cross a symmetry plane or a fixed side: what the nodes of this side then sum to, along
   the normal or at all, comes from the mirror image. */
static inline void mpm__mirror_force(mpm_world *w)
{
    const mpm_side *side = w->desc.side;
    int32_t i;
    int d, fixed = 0;
    for (d = 0; d < 6; d++) fixed |= side[d] == MPM_SIDE_FIXED;
    for (d = 0; d < 3; d++)
        if (w->ghost && (side[2 * d] == MPM_SIDE_SYMMETRY || side[2 * d + 1] == MPM_SIDE_SYMMETRY || fixed))
            for (i = 0; i < w->nodes; i++) w->ledger.impulse[d] += (double)(w->node[i].force[d] * w->dt);
}

static inline int mpm__has_gravity(const mpm_world *w)
{
    const mpm_real *g = w->desc.gravity;
    return g[0] < 0 || g[0] > 0 || g[1] < 0 || g[1] > 0 || g[2] < 0 || g[2] > 0;
}

/* Momentum that gravity gives a node in a step, as if it did so to all its mass, to its force or to the ledger. */
static inline void mpm__weigh_node(mpm_world *w, mpm_node *n, const mpm_real *mass, int work)
{
    mpm_real j[3];
    int d;
    for (d = 0; d < 3; d++) j[d] = mass[d] * w->desc.gravity[d] * w->dt;
    if (work && n->flags) mpm__constrain(w, n, j, NULL);
    for (d = 0; d < 3; d++) {
        if (work) w->ledger.work += (double)(j[d] * mpm__mean_velocity(w, n, d));
        else n->force[d] += j[d] / w->dt, w->ledger.impulse[d] += (double)j[d];
    }
}

/* What points lend to images that move the other way falls the other way: it is taken off twice. */
static inline void mpm__weigh_images(mpm_world *w, const mpm_run *r, int work)
{
    mpm_support s;
    int32_t i;
    int a, d;
    for (i = r->first; i < r->first + r->count; i++) {
        mpm_support_of(w, r, i, &s);
        for (a = 0; a < s.count; a++) {
            mpm_real mass[3] = {0, 0, 0};
            if (!s.mirror[a]) continue;
            for (d = 0; d < 3; d++)
                if (s.mirror[a] >> d & 1) mass[d] = -2 * w->points.mass[i] * s.N[a];
            mpm__weigh_node(w, &w->node[s.slot[a]], mass, work);
        }
    }
}

/* Gravity on all nodes: its force, or its work once the velocities of the step are known. */
static inline void mpm__gravity(mpm_world *w, int work)
{
    int32_t i;
    for (i = 0; i < w->nodes; i++) {
        const mpm_real m = w->node[i].mass, mass[3] = {m, m, m};
        if (m > 0) mpm__weigh_node(w, &w->node[i], mass, work);
    }
    for (i = 0; i < w->runs; i++)
        if (w->run[i].flags & 63) mpm__weigh_images(w, &w->run[i], work);
}

/* What acts beside the internal forces, and the ledger of images. */
static inline void mpm__other_forces(mpm_world *w)
{
    int32_t i;
    mpm__mirror_force(w);
    for (i = 0; i < w->runs; i++)
        if (w->body[w->run[i].body].desc.absorb) mpm__absorb_run(w, &w->run[i]);
    if (mpm__has_gravity(w)) mpm__gravity(w, 0);
}

MPM_API void mpm_forces(mpm_world *w)
{
    mpm__sweep_to_nodes(w, MPM__FORCES);
    mpm__other_forces(w);
}

MPM_API void mpm_to_nodes(mpm_world *w)
{
    mpm__sweep_to_nodes(w, MPM__P2G | MPM__FORCES);
    mpm__constrain_momentum(w);
    mpm__other_forces(w);
}

MPM_API void mpm_grid_update(mpm_world *w)
{
    int32_t i;
    int d;
    for (i = 0; i < w->nodes; i++) {
        mpm_node *n = &w->node[i];
        if (n->flags) {
            double removed[3] = {0, 0, 0};
            mpm__constrain(w, n, n->force, removed);
            for (d = 0; d < 3; d++) w->ledger.impulse[d] -= removed[d] * (double)w->dt;
        }
        for (d = 0; d < 3; d++) n->momentum[d] += n->force[d] * w->dt;
        if (n->flags) mpm__walls(w, n);
    }
}

/* ---- contact --------------------------------------------------------------------------------- */

/* The sum of m grad N(x_p) at the nodes of a run (A 3.30). grad N is taken at the point, towards the
   node: at a surface node, which has points on one side only, the sum points OUT of the body. (The
   gradient of the mass density, which points into it, is its negative.) In axisymmetry rings grow
   with the radius, which adds a term; inside a uniform body the sum then vanishes there too. */
static inline void mpm__gradient_run(mpm_world *w, const mpm_run *r)
{
    const int k = w->support[0], ky = w->support[1], hoop = w->desc.geometry == MPM_AXISYMMETRIC;
    const mpm_points *q = &w->points;
    mpm_real F[3][MPM_SUPPORT] = {{0}}, G[3][MPM_SUPPORT], N[MPM_SUPPORT];
    mpm__weights s;
    int32_t at;
    int n, p, a, d;
    MPM__EACH_PIECE(r, at, n) {
        mpm__weigh(w, r, at, n, k, ky, &s);
        for (p = 0; p < n; p++) {
            const mpm_real m = q->mass[at + p];
            mpm__gradients(&s, p, k, ky, G);
            for (d = 0; d < 3; d++)
                for (a = 0; a < k * ky * k; a++) F[d][a] += m * G[d][a];
            if (hoop) {
                const mpm_real ring = m / q->x[0][at + p];
                mpm__products(&s, p, k, ky, N);
                for (a = 0; a < k * ky * k; a++) F[0][a] += ring * N[a];
            }
        }
    }
    for (a = 0; a < k * ky * k; a++) {
        const int32_t touch = w->node[mpm__run_nodes(w, r)[a]].touch;
        if (touch < 0) continue;
        for (d = 0; d < 3; d++) w->touch[touch].gradient[d] += F[d][a] * mpm__turned(r, a, d, k, ky);
    }
}

/* n = g / |g|; 0 if g is no direction at all: shorter than round-off beside `scale`. */
static inline int mpm__unit(const mpm_real *g, mpm_real scale, mpm_real *n)
{
    mpm_real big = 0, length;
    int d;
    for (d = 0; d < 3; d++) {
        mpm_real size = g[d] < 0 ? -g[d] : g[d];
        if (size > big) big = size;
    }
    if (!(big > scale)) return 0;
    length = mpm_sqrt((g[0] / big) * (g[0] / big) + (g[1] / big) * (g[1] / big) + (g[2] / big) * (g[2] / big));
    for (d = 0; d < 3; d++) n[d] = g[d] / big / length;
    return 1;
}

/* The normal of a pair, outward of a: along the gradient sum of a, against that of b. The sums are
   divided by the bodies' initial densities, which makes them volume gradients. */
static inline void mpm__pair_normal(const mpm_world *w, mpm_pair *pair)
{
    const mpm_node *a = &w->node[pair->a], *b = &w->node[pair->b];
    const mpm_real *sum_a = w->touch[a->touch].gradient, *sum_b = w->touch[b->touch].gradient;
    const mpm_real ra = w->body[a->body].desc.density, rb = w->body[b->body].desc.density;
    const mpm_normal_rule rule = pair->rule->normal;
    const mpm_real tiny = MPM_R(1024.0) * MPM_EPSILON / w->desc.cell;
    mpm_real ga[3], gb[3], mean[3], na[3] = {0, 0, 0}, nb[3] = {0, 0, 0}, la = 0, lb = 0;
    int d, has_a, has_b, use_b = 1, alike = rule == MPM_NORMAL_AVERAGE;
    for (d = 0; d < 3; d++) {
        ga[d] = sum_a[d] / ra;
        gb[d] = -sum_b[d] / rb;
        mean[d] = ga[d] + gb[d];
        la += ga[d] * ga[d];
        lb += gb[d] * gb[d];
    }
    has_a = mpm__unit(ga, tiny * a->mass / ra, na);
    has_b = mpm__unit(gb, tiny * b->mass / rb, nb);
    if (rule == MPM_NORMAL_MVG) {
        use_b = lb >= la;
        if (w->desc.scheme == MPM_SCHEME_CONSISTENT) /* round-off must not choose, nor the number of a body */
            alike = mpm_fabs(lb - la) <= 4096 * MPM_EPSILON * (la + lb);
    }
    if (alike && mpm__unit(mean, tiny * (a->mass / ra + b->mass / rb), pair->normal)) return;
    if (rule == MPM_NORMAL_FIXED) {
        na[0] = na[1] = nb[0] = nb[1] = 0;
        na[2] = nb[2] = -1; /* the higher-numbered body, the substrate, lies below */
        has_a = has_b = 1;
    }
    for (d = 0; d < 3; d++) pair->normal[d] = (use_b && has_b) || !has_a ? nb[d] : na[d];
}

/* Adds a contact point at x (in cells, from the node) to the normal equations of a pair: Gauss-Newton for
   the least squares of c - tanh((phi . (x, 1))/2), with c = -1 for points of a and +1 for those of b. */
static inline void mpm__plane_point(mpm_plane *f, int of_b, const mpm_real *x)
{
    const mpm_real X[4] = {x[0], x[1], x[2], 1};
    mpm_real z = 0, L, slope, left;
    int i, j, at = 0;
    for (i = 0; i < 4; i++) z += f->phi[i] * X[i];
    L = mpm_tanh(z / 2);
    slope = (1 - L * L) / 2;
    left = (of_b ? 1 : -1) - L;
    for (i = 0; i < 4; i++) {
        for (j = 0; j <= i; j++) f->matrix[at++] += slope * X[i] * slope * X[j];
        f->right[i] += slope * X[i] * left;
    }
    f->points[of_b] += 1;
}

/* A Gauss-Newton step: solves the normal equations, penalty included, by Cholesky's method and empties
   them. The penalty keeps phi finite where the points are parted cleanly, as they should be. */
static inline void mpm__plane_step(mpm_plane *f)
{
    const mpm_real penalty = MPM_R(1e-4) * (f->points[0] + f->points[1]);
    mpm_real *A = f->matrix, *b = f->right;
    int i, j, k;
    if (!(f->points[0] > 0 && f->points[1] > 0)) return;
    for (i = 0; i < 4; i++) {
        A[i * (i + 1) / 2 + i] += penalty;
        b[i] -= penalty * f->phi[i];
    }
    for (i = 0; i < 4; i++) {
        mpm_real *row = A + i * (i + 1) / 2;
        for (j = 0; j <= i; j++) {
            const mpm_real *other = A + j * (j + 1) / 2;
            for (k = 0; k < j; k++) row[j] -= row[k] * other[k];
            row[j] = j < i ? row[j] / other[j] : mpm_sqrt(row[j]);
        }
        for (k = 0; k < i; k++) b[i] -= row[k] * b[k];
        b[i] /= row[i];
    }
    for (i = 3; i >= 0; i--) {
        for (k = i + 1; k < 4; k++) b[i] -= A[k * (k + 1) / 2 + i] * b[k];
        b[i] /= A[i * (i + 1) / 2 + i];
        f->phi[i] += b[i];
    }
    memset(f->matrix, 0, sizeof f->matrix);
    memset(f->right, 0, sizeof f->right);
    f->points[0] = f->points[1] = 0;
}

/* Half the edge of the cube, square or square ring section that a point fills. */
static inline mpm_real mpm__point_radius(const mpm_world *w, int32_t i)
{
    const mpm_real volume = w->points.mass[i] / w->points.density[i];
    if (w->desc.geometry == MPM_3D) return mpm_cbrt(volume) / 2;
    if (w->desc.geometry == MPM_PLANE_STRAIN) return mpm_sqrt(volume) / 2;
    return mpm_sqrt(volume / (2 * MPM_PI * w->points.x[0][i])) / 2;
}

/* Shows point i, at x from a contact node [cells], to the pairs of its body there: to their planes if
   `fit`, else to their separations. */
static inline void mpm__show(mpm_world *w, int32_t slot, int32_t i, const mpm_real *x, int fit)
{
    const int32_t index = w->node[slot].index;
    int32_t j;
    for (j = w->touch[w->node[slot].touch].pair; j < w->pairs && w->node[w->pair[j].a].index == index; j++) {
        mpm_pair *pair = &w->pair[j];
        const int of_b = pair->b == slot;
        if (!of_b && pair->a != slot) continue;
        if (fit) {
            if (pair->rule->normal == MPM_NORMAL_LOGISTIC) mpm__plane_point(&w->plane[j], of_b, x);
        } else if (pair->rule->touch) {
            const mpm_real *n = pair->normal, radius = mpm__point_radius(w, i);
            const mpm_real along = (x[0] * n[0] + x[1] * n[1] + x[2] * n[2]) * w->desc.cell;
            if (of_b) pair->low = along - radius < pair->low ? along - radius : pair->low;
            else pair->high = along + radius > pair->high ? along + radius : pair->high;
        }
    }
}

/* Shows every point of a run to the contact nodes it touches. Positions count from the node; across a
   mirror, in the image. */
static inline void mpm__show_run(mpm_world *w, const mpm_run *r, int fit)
{
    const int k = w->support[0], ky = w->support[1];
    const int32_t *slot = mpm__run_nodes(w, r);
    const mpm_real inv = 1 / w->desc.cell;
    mpm_real N[MPM_SUPPORT];
    mpm__weights s;
    int32_t at;
    int n, p, a, d;
    MPM__EACH_PIECE(r, at, n) {
        mpm__weigh(w, r, at, n, k, ky, &s);
        for (p = 0; p < n; p++) {
            mpm__products(&s, p, k, ky, N);
            for (a = 0; a < k * ky * k; a++) {
                const mpm_node *node = &w->node[slot[a]];
                const int step[3] = {a % k, a / k % ky, a / k / ky};
                mpm_real x[3] = {0, 0, 0};
                if (!(node->flags & MPM_NODE_CONTACT) || !(N[a] > 0)) continue;
                for (d = 0; d < 3; d++) {
                    if (d == 1 && ky == 1) continue;
                    x[d] = (w->points.x[d][at + p] - w->desc.origin[d]) * inv -
                           (mpm_real)(r->base[d] - w->ghost + step[d]);
                    x[d] *= mpm__turned(r, a, d, k, ky);
                }
                if (fit) mpm__constrain(w, node, x, NULL); /* on a mirror the image cancels it */
                mpm__show(w, slot[a], at + p, x, fit);
            }
        }
    }
}

#define MPM__PLANE_STEPS 6 /* the first is the linear discriminant; the fit moves little after the fifth */

/* Normals by logistic regression: the plane that parts the points of a from those of b best. */
static inline void mpm__plane_normals(mpm_world *w)
{
    int32_t i;
    int n, d;
    memset(w->plane, 0, (size_t)w->pairs * sizeof *w->plane);
    for (n = 0; n < MPM__PLANE_STEPS; n++) {
        for (i = 0; i < w->runs; i++)
            if (w->run[i].flags & MPM_NODE_CONTACT) mpm__show_run(w, &w->run[i], 1);
        for (i = 0; i < w->pairs; i++) mpm__plane_step(&w->plane[i]);
    }
    for (i = 0; i < w->pairs; i++) {
        mpm_real normal[3];
        if (w->pair[i].rule->normal == MPM_NORMAL_LOGISTIC && mpm__unit(w->plane[i].phi, 1024 * MPM_EPSILON, normal))
            for (d = 0; d < 3; d++) w->pair[i].normal[d] = normal[d];
    }
}

/* The gap between the points of a and those of b along the normal, points taken as large as they are. */
static inline void mpm__separations(mpm_world *w)
{
    int32_t i;
    for (i = 0; i < w->pairs; i++) {
        w->pair[i].high = -MPM_R(1e30);
        w->pair[i].low = MPM_R(1e30);
    }
    for (i = 0; i < w->runs; i++)
        if (w->run[i].flags & MPM_NODE_CONTACT) mpm__show_run(w, &w->run[i], 0);
    for (i = 0; i < w->pairs; i++)
        if (w->pair[i].rule->touch) w->pair[i].separation = w->pair[i].low - w->pair[i].high;
}

/* Whether a body weighs enough at a node to be in contact there. In axisymmetry points are rings, as
   heavy as their radius makes them; on a symmetry plane half of a node lies behind the mirror. */
static inline int mpm__counts_in_contact(const mpm_world *w, const mpm_contact *rule, const mpm_node *n)
{
    const mpm_body *b = &w->body[n->body];
    const int rings = w->desc.geometry == MPM_AXISYMMETRIC;
    mpm_real point = b->point_mass;
    int s;
    if (rings) {
        mpm_real r = w->desc.origin[0] + (mpm_real)(n->index % w->nodes_per_axis[0] - w->ghost) * w->desc.cell;
        if (r < w->desc.cell / 2) r = w->desc.cell / 2;
        point = b->desc.density * b->desc.spacing * b->desc.spacing * 2 * MPM_PI * r;
    }
    for (s = rings ? 2 : 0; s < 6; s++)
        if ((n->flags >> s & 1) && w->desc.side[s] == MPM_SIDE_SYMMETRY) point /= 2;
    if (rule->law == MPM_CONTACT_WELD) point = 0; /* one velocity everywhere, without exception */
    return n->mass > rule->cutoff * point && n->mass > w->desc.mass_cutoff * b->point_mass;
}

/* Whether a rule is for a first and a second body. */
static inline int mpm__rule_fits(const mpm_rule *r, int32_t first, int32_t second)
{
    return (r->a < 0 || r->a == first) && (r->b < 0 || r->b == second);
}

MPM_API const mpm_contact *mpm_contact_of(const mpm_world *w, int32_t a, int32_t b)
{
    int32_t i;
    for (i = w->rules - 1; i >= 0; i--)
        if (mpm__rule_fits(&w->rule[i], a, b) || mpm__rule_fits(&w->rule[i], b, a)) return &w->rule[i].contact;
    return &w->desc.contact;
}

/* Makes a slot one of a contact node. */
static inline void mpm__meet(mpm_world *w, int32_t slot, int32_t pair)
{
    mpm_touch *t = mpm__touch(w, &w->node[slot]);
    if (w->node[slot].flags & MPM_NODE_CONTACT) return;
    w->node[slot].flags |= MPM_NODE_CONTACT;
    memset(t->gradient, 0, sizeof t->gradient);
    memset(t->work, 0, sizeof t->work);
    t->pair = pair;
}

/* Lists the pairs of slots that meet at a grid node whose first slot is i. */
static inline void mpm__pairs_at(mpm_world *w, int32_t i)
{
    const int32_t first = w->pairs;
    int32_t a, b;
    for (b = i; b >= 0; b = w->node[b].next)
        for (a = w->node[b].next; a >= 0; a = w->node[a].next) {
            const mpm_node *low = &w->node[a], *high = &w->node[b];
            const mpm_contact *rule = mpm_contact_of(w, low->body, high->body);
            mpm_pair *pair = &w->pair[w->pairs];
            if (!mpm__counts_in_contact(w, rule, low) || !mpm__counts_in_contact(w, rule, high)) continue;
            memset(pair, 0, sizeof *pair);
            pair->a = a;
            pair->b = b;
            pair->rule = rule;
            mpm__meet(w, a, first);
            mpm__meet(w, b, first);
            w->pairs++;
        }
}

/* The lowest and the highest layer of nodes along z that has pairs. */
static inline void mpm__pair_layers(const mpm_world *w, int32_t *low, int32_t *high)
{
    const int32_t layer = w->nodes_per_axis[0] * w->nodes_per_axis[1];
    int32_t i;
    *low = w->nodes_per_axis[2];
    *high = -1;
    for (i = 0; i < w->pairs; i++) {
        const int32_t z = w->node[w->pair[i].a].index / layer;
        *low = z < *low ? z : *low;
        *high = z > *high ? z : *high;
    }
}

/* Marks the runs that touch a contact node. */
static inline void mpm__contact_runs(mpm_world *w)
{
    const int reach = mpm__reach(w);
    int32_t i, low, high;
    int s;
    mpm__pair_layers(w, &low, &high);
    for (i = 0; i < w->runs; i++) {
        mpm_run *r = &w->run[i];
        const int32_t *slot = mpm__run_nodes(w, r);
        if (!(r->flags & 63) && (r->base[2] > high || r->base[2] + w->support[2] <= low)) continue;
        for (s = 0; s < reach; s++)
            if (w->node[slot[s]].flags & MPM_NODE_CONTACT) r->flags |= MPM_NODE_CONTACT;
    }
}

MPM_API void mpm_contact_find(mpm_world *w)
{
    int32_t i;
    int planes = 0, gaps = 0;
    w->pairs = 0;
    for (i = 0; i < w->nodes; i++) w->node[i].flags &= ~MPM_NODE_CONTACT;
    for (i = 0; i < w->nodes; i++)
        if (w->head[w->node[i].index] == i && w->node[i].next >= 0) mpm__pairs_at(w, i);
    if (w->pairs == 0) return;
    mpm__contact_runs(w);
    for (i = 0; i < w->runs; i++)
        if (w->run[i].flags & MPM_NODE_CONTACT) mpm__gradient_run(w, &w->run[i]);
    for (i = 0; i < w->pairs; i++) {
        mpm_pair *pair = &w->pair[i];
        const mpm_node *a = &w->node[pair->a], *b = &w->node[pair->b];
        mpm__constrain(w, a, w->touch[a->touch].gradient, NULL);
        mpm__constrain(w, b, w->touch[b->touch].gradient, NULL);
        mpm__pair_normal(w, pair);
        planes |= pair->rule->normal == MPM_NORMAL_LOGISTIC;
        gaps |= pair->rule->touch;
    }
    if (planes) mpm__plane_normals(w);
    if (gaps) mpm__separations(w);
}

MPM_API mpm_real mpm_pair_stick(const mpm_world *w, const mpm_pair *p, mpm_real j[3])
{
    const mpm_node *a = &w->node[p->a], *b = &w->node[p->b];
    mpm_real toward = 0;
    int d;
    for (d = 0; d < 3; d++) {
        j[d] = (a->mass * b->momentum[d] - b->mass * a->momentum[d]) / (a->mass + b->mass);
        toward -= j[d] * p->normal[d];
    }
    return toward;
}

MPM_API double mpm_pair_area(const mpm_world *w, const mpm_pair *p)
{
    const mpm_node *a = &w->node[p->a], *b = &w->node[p->b];
    const mpm_real *ga = w->touch[a->touch].gradient, *gb = w->touch[b->touch].gradient;
    double one = 0, two = 0;
    int d;
    for (d = 0; d < 3; d++) {
        one += (double)(ga[d] * p->normal[d] / w->body[a->body].desc.density);
        two -= (double)(gb[d] * p->normal[d] / w->body[b->body].desc.density);
    }
    if (two < one) one = two;
    return one < 0 ? 0 : one;
}

MPM_API void mpm_pair_push(mpm_world *w, mpm_pair *p, const mpm_real j[3])
{
    mpm_node *a = &w->node[p->a], *b = &w->node[p->b];
    mpm_real to[3];
    int d;
    for (d = 0; d < 3; d++) to[d] = j[d];
    mpm__constrain(w, a, to, NULL);
    for (d = 0; d < 3; d++) {
        p->impulse[d] += to[d];
        a->momentum[d] += to[d];
        b->momentum[d] -= to[d];
        a->force[d] += to[d] / w->dt;
        b->force[d] -= to[d] / w->dt;
    }
}

/* Turns the sticking impulse into one with Coulomb friction: the normal part whole, the tangential
   part at most mu times as large. */
static inline void mpm__coulomb(const mpm_real *normal, mpm_real mu, mpm_real *j)
{
    mpm_real jn = j[0] * normal[0] + j[1] * normal[1] + j[2] * normal[2], jt = 0, keep, t[3];
    int d;
    for (d = 0; d < 3; d++) {
        t[d] = j[d] - jn * normal[d];
        jt += t[d] * t[d];
    }
    jt = mpm_sqrt(jt);
    keep = mu * (jn < 0 ? -jn : jn);
    keep = jt > keep ? keep / jt : 1;
    for (d = 0; d < 3; d++) j[d] = jn * normal[d] + (mu > 0 ? keep * t[d] : 0);
}

/* Turns the sticking impulse into that of a hold: its share, of at most `limit`. */
static inline void mpm__hold(const mpm_pair *p, mpm_real *j)
{
    mpm_real size, keep = p->hold;
    int d;
    if (p->limit > 0) {
        size = keep * mpm_sqrt(j[0] * j[0] + j[1] * j[1] + j[2] * j[2]);
        if (size > p->limit) keep *= p->limit / size;
    }
    for (d = 0; d < 3; d++) j[d] *= keep;
}

/* The impulse on a that the rule of a pair asks for in the thesis's scheme; 0 for none. */
static inline int mpm__contact_impulse(const mpm_world *w, mpm_pair *p, mpm_real *j)
{
    const mpm_contact *c = p->rule;
    int approaching;
    if (c->law == MPM_CONTACT_NONE) return 0;
    if (c->law == MPM_CONTACT_USER) return c->fn(c->context, w, p, j);
    approaching = mpm_pair_stick(w, p, j) > 0 && !(c->touch && p->separation > 0);
    p->held = !approaching && p->hold > 0;
    if (c->law == MPM_CONTACT_WELD) return 1;
    if (approaching && c->law == MPM_CONTACT_FRICTION) mpm__coulomb(p->normal, c->friction, j);
    if (p->held) mpm__hold(p, j);
    return approaching || p->held;
}

/* The levels of velocity at which the consistent scheme settles contact: P(k), P(k+1), and MUSL's. */
enum { MPM__OLD, MPM__NEW, MPM__MAPPED };

/* Component d of a node's momentum at a level. */
static inline mpm_real mpm__at_level(const mpm_world *w, const mpm_node *n, int d, int level)
{
    if (level == MPM__MAPPED) return n->mass * n->velocity[d];
    return level == MPM__OLD ? n->momentum[d] - n->force[d] * w->dt : n->momentum[d];
}

/* Momentum j to a and -j to b at a level. Only that of P(k+1) goes to the points. */
static inline void mpm__settle_add(mpm_world *w, mpm_pair *p, int level, mpm_real *j)
{
    mpm_node *a = &w->node[p->a], *b = &w->node[p->b];
    mpm_touch *ta = &w->touch[a->touch], *tb = &w->touch[b->touch];
    int d;
    mpm__constrain(w, a, j, NULL);
    if (level == MPM__NEW) mpm_pair_push(w, p, j);
    for (d = 0; d < 3 && level == MPM__OLD; d++) {
        a->momentum[d] += j[d];
        b->momentum[d] -= j[d];
        ta->shift[d] += j[d];
        tb->shift[d] -= j[d];
    }
    for (d = 0; d < 3 && level == MPM__MAPPED; d++) {
        a->velocity[d] += j[d] / a->mass;
        b->velocity[d] -= j[d] / b->mass;
        ta->cut[d] += j[d] / a->mass;
        tb->cut[d] -= j[d] / b->mass;
    }
}

/* Parts the impulse of a held pair into compression along the normal and the rest, which the hold bears. Returns the
   size of the rest. */
static inline mpm_real mpm__borne(const mpm_pair *p, const mpm_real *j, mpm_real *rest)
{
    const mpm_real along = j[0] * p->normal[0] + j[1] * p->normal[1] + j[2] * p->normal[2];
    mpm_real size = 0;
    int d;
    for (d = 0; d < 3; d++) {
        rest[d] = j[d] - (along < 0 ? along * p->normal[d] : 0);
        size += rest[d] * rest[d];
    }
    return mpm_sqrt(size);
}

/* Whether a pair is one body at a level: welded, or held by all of a bond that has not slipped. */
static inline int mpm__is_one(const mpm_pair *p, int level)
{
    mpm_real rest[3];
    if (p->rule->law == MPM_CONTACT_WELD) return 1;
    if (!(p->hold >= 1)) return 0;
    if (!(p->limit > 0) || level == MPM__NEW) return 1;
    return level == MPM__MAPPED && mpm__borne(p, p->impulse, rest) < p->limit * (1 - 64 * MPM_EPSILON);
}

/* What a held pair's whole impulse j may be: compression without limit, the rest as far as the hold bears. */
static inline void mpm__bear(const mpm_pair *p, mpm_real *j)
{
    mpm_real rest[3], size;
    int d;
    if (!(p->limit > 0)) return;
    size = mpm__borne(p, j, rest);
    for (d = 0; d < 3 && size > p->limit; d++) j[d] += rest[d] * (p->limit / size - 1);
}

/* 1 if a pair was pressed together at P(k+1), by more than round-off beside a cell per step. */
static inline int mpm__pressed(const mpm_world *w, const mpm_pair *p)
{
    const mpm_real ma = w->node[p->a].mass, mb = w->node[p->b].mass, *j = p->impulse, *n = p->normal;
    const mpm_real least = 4096 * MPM_EPSILON * ma * mb / (ma + mb) * w->desc.cell / w->dt;
    return -(j[0] * n[0] + j[1] * n[1] + j[2] * n[2]) > least;
}

/* Turns the whole impulse j that would stop a pair at a level into what its rule allows. */
static inline void mpm__allow(const mpm_world *w, const mpm_pair *p, int level, mpm_real *j)
{
    const mpm_real *n = p->normal;
    const mpm_real press = -(j[0] * n[0] + j[1] * n[1] + j[2] * n[2]);
    mpm_real t[3], size = 0, keep = 0;
    int d;
    for (d = 0; d < 3; d++) {
        t[d] = j[d] + press * n[d];
        size += t[d] * t[d];
    }
    size = mpm_sqrt(size);
    if (p->rule->law == MPM_CONTACT_STICK) keep = 1;
    else if (level == MPM__NEW) keep = size > p->rule->friction * press ? p->rule->friction * press / size : 1;
    if (press > 0 || (level == MPM__MAPPED && mpm__pressed(w, p))) /* strained neither into each other nor apart */
        for (d = 0; d < 3; d++) j[d] = keep * t[d] - press * n[d];
    else
        for (d = 0; d < 3; d++) j[d] = 0;
}

/* What a pair's impulse at a level should be, seen from the velocities as they are: `share` of the way to where it
   would stop the pair, as far as its rule allows. Returns the size of the change. */
static inline mpm_real mpm__settle_pair(const mpm_world *w, mpm_pair *p, int level, mpm_real share)
{
    const mpm_node *a = &w->node[p->a], *b = &w->node[p->b];
    const mpm_real ma = a->mass, mb = b->mass;
    mpm_real size = 0;
    int d;
    for (d = 0; d < 3; d++) {
        const mpm_real stop = ma * mpm__at_level(w, b, d, level) - mb * mpm__at_level(w, a, d, level);
        p->next[d] = p->settled[d] + share * stop / (ma + mb);
    }
    if (!mpm__is_one(p, level)) mpm__allow(w, p, level, p->next);
    else if (level == MPM__NEW && p->rule->law != MPM_CONTACT_WELD) mpm__bear(p, p->next);
    for (d = 0; d < 3; d++) {
        const mpm_real change = mpm_fabs(p->next[d] - p->settled[d]);
        size = change > size ? change : size;
    }
    return size;
}

static inline void mpm__settle_take(mpm_world *w, mpm_pair *p, int level)
{
    mpm_real change[3];
    int d;
    for (d = 0; d < 3; d++) {
        change[d] = p->next[d] - p->settled[d];
        p->settled[d] = p->next[d];
    }
    mpm__settle_add(w, p, level, change);
}

/* Whether the consistent scheme settles a pair: it has a law, and its bodies touch or are held together. */
static inline int mpm__settles(const mpm_pair *p)
{
    if (p->rule->law == MPM_CONTACT_NONE || p->rule->law == MPM_CONTACT_USER) return 0;
    return p->rule->law == MPM_CONTACT_WELD || p->hold >= 1 || !(p->rule->touch && p->separation > 0);
}

#define MPM__SETTLE_SWEEPS 200

/* Settles all pairs of a node at a level, [first, last): all of them seen from the same velocities, again and again
   until nothing changes, or 200 times. So it does not matter how bodies are numbered. Of n bodies each pair goes 2/n
   of its way:
   two stop each other at once. */
static inline void mpm__settle_node(mpm_world *w, int32_t first, int32_t last, int level)
{
    mpm_real change, size, start = 0, bodies = 2;
    int32_t i;
    int sweep;
    while (bodies * (bodies - 1) / 2 < (mpm_real)(last - first)) bodies += 1;
    for (i = first; i < last; i++) memset(w->pair[i].settled, 0, sizeof w->pair[i].settled);
    for (sweep = 0; sweep < MPM__SETTLE_SWEEPS; sweep++) {
        for (change = 0, i = first; i < last; i++) {
            if (!mpm__settles(&w->pair[i])) continue;
            size = mpm__settle_pair(w, &w->pair[i], level, 2 / bodies);
            change = size > change ? size : change;
        }
        if (!(change > 0)) return;
        for (i = first; i < last; i++)
            if (mpm__settles(&w->pair[i])) mpm__settle_take(w, &w->pair[i], level);
        if (sweep == 0) start = change;
        if (last - first == 1 || !(change > 2 * MPM_EPSILON * start)) return;
    }
}

static inline void mpm__settle(mpm_world *w, int level)
{
    int32_t i, last;
    for (i = 0; i < w->pairs; i = last) {
        const int32_t index = w->node[w->pair[i].a].index;
        for (last = i + 1; last < w->pairs && w->node[w->pair[last].a].index == index; last++) {}
        mpm__settle_node(w, i, last, level);
    }
}

/* The thesis's scheme: each pair once, with P(k+1) as the pairs before it left it. */
static inline void mpm__apply_in_turn(mpm_world *w)
{
    int32_t i;
    for (i = 0; i < w->pairs; i++) {
        mpm_pair *p = &w->pair[i];
        mpm_real j[3];
        if (mpm__contact_impulse(w, p, j)) mpm_pair_push(w, p, j);
    }
}

/* The consistent scheme: laws of the user's and softened holds act on P(k+1) once, the others are settled. */
static inline void mpm__apply_settled(mpm_world *w)
{
    int32_t i;
    for (i = 0; i < w->pairs; i++) w->pair[i].held = w->pair[i].hold >= 1 && mpm__settles(&w->pair[i]);
    mpm__settle(w, MPM__OLD);
    for (i = 0; i < w->pairs; i++) {
        mpm_pair *p = &w->pair[i];
        mpm_real j[3];
        if (p->rule->law == MPM_CONTACT_USER && p->rule->fn(p->rule->context, w, p, j)) mpm_pair_push(w, p, j);
    }
    mpm__settle(w, MPM__NEW);
    for (i = 0; i < w->pairs; i++) {
        mpm_pair *p = &w->pair[i];
        mpm_real j[3];
        if (!(p->hold > 0 && p->hold < 1) || p->rule->law >= MPM_CONTACT_WELD || mpm__pressed(w, p)) continue;
        if (mpm_pair_stick(w, p, j) > 0) continue;
        p->held = 1;
        mpm__hold(p, j);
        mpm_pair_push(w, p, j);
    }
    for (i = 0; i < w->nodes; i++)
        if (w->node[i].flags & MPM_NODE_CONTACT) mpm__walls(w, &w->node[i]);
}

MPM_API void mpm_contact_apply(mpm_world *w)
{
    int32_t i;
    if (w->desc.scheme == MPM_SCHEME_THESIS) mpm__apply_in_turn(w);
    else mpm__apply_settled(w);
    for (w->held = 0, i = 0; i < w->pairs; i++) w->held += w->pair[i].held;
}

/* ---- back to the points ---------------------------------------------------------------------- */

/* Sums N_I V_I at the points of a span, V a vector of the nodes. */
MPM_KERNEL void mpm__span_values(const mpm_world *w, const mpm_run *r, const mpm__weights *s, int32_t first, int k,
                                 int ky, mpm__vector which, mpm_real (*sum)[MPM__LANES])
{
    mpm_real V[MPM_SUPPORT][4];
    int at, part, d;
    MPM__EACH_PART(r, first, s->n, at, part) {
        mpm__gather_polynomial(w, r, k, ky, which, 1, V);
        for (d = 0; d < 3; d++) mpm__values(s, at, part, k, ky, V, d, sum[d]);
    }
}

/* x_p += f sum_p of points [at, at + n), for a vector x of the points. */
MPM_KERNEL void mpm__advance(mpm_real *const x[3], int32_t at, int n, mpm_real f, mpm_real (*sum)[MPM__LANES])
{
    int p, d;
    for (d = 0; d < 3; d++) {
        mpm_real *to = x[d] + at;
        for (p = 0; p < n; p++) to[p] += f * sum[d][p];
    }
}

/* v_p += dt sum N_I f_I / m_I of one body (A 3.32), v_I += m_p v_p N_I (A 3.33), or both. */
MPM_KERNEL void mpm__velocities_body(mpm_world *w, const mpm_run *r, const mpm_run *end, int k, int ky, int what)
{
    mpm_real sum[3][MPM__LANES];
    mpm__weights s;
    mpm__along x;
    mpm__gifts g;
    mpm__shares sums;
    int32_t first;
    int n, at, part;
    mpm__clear_shares(k, ky, &sums);
    MPM__EACH_SPAN(r, end, first, n) {
        const mpm_run *of = r;
        mpm__weigh_span(w, r, first, n, k, ky, &s);
        if (what & MPM__G2P) {
            mpm__span_values(w, r, &s, first, k, ky, MPM__FORCE, sum);
            mpm__advance(w->points.v, first, n, w->dt, sum);
        }
        if (!(what & MPM__MUSL)) continue;
        if (k != 2) mpm__along_x(&s, k, &x);
        mpm__give_momentum(&w->points, first, n, &g);
        MPM__EACH_PART(of, first, n, at, part) {
            mpm__share_out(&s, &x, &g, at, part, k, ky, 0, MPM__MUSL, &sums);
            if (mpm__run_ends(of, first + at + part)) mpm__hand_out(w, of, k, ky, MPM__MUSL, &sums);
        }
    }
}

static inline void mpm__sweep_velocities(mpm_world *w, int what)
{
#define MPM__CALL(k, ky, hoop) mpm__velocities_body(w, w->run + from, w->run + to, k, ky, what)
    MPM__EACH_BODY(w, 0, MPM__CALL);
#undef MPM__CALL
}

/* Points that reach through a symmetry plane take a ghost's acceleration with its sign turned: twice
   that share of their momentum comes from the mirror image. */
static inline void mpm__mirror_run(mpm_world *w, const mpm_run *r)
{
    const int k = w->support[0], ky = w->support[1];
    mpm_real A[MPM_SUPPORT][4], N[MPM_SUPPORT];
    mpm__weights s;
    int32_t at;
    int n, p, a, d;
    mpm__gather(w, r, k, ky, MPM__FORCE, 1, A);
    MPM__EACH_PIECE(r, at, n) {
        mpm__weigh(w, r, at, n, k, ky, &s);
        for (p = 0; p < n; p++) {
            const mpm_real m = 2 * w->dt * w->points.mass[at + p];
            mpm__products(&s, p, k, ky, N);
            for (d = 0; d < 3; d++)
                for (a = 0; a < k * ky * k; a++)
                    if (mpm__mirror(r, a, d, k, ky) < 0) w->ledger.impulse[d] += (double)(m * N[a] * A[a][d]);
        }
    }
}

/* What points that reach through a side get from images, to the ledger. */
static inline void mpm__account_images(mpm_world *w)
{
    int32_t i;
    for (i = 0; i < w->runs; i++)
        if (w->run[i].flags & 63) mpm__mirror_run(w, &w->run[i]);
}

MPM_API void mpm_g2p(mpm_world *w)
{
    mpm__sweep_velocities(w, MPM__G2P);
    mpm__account_images(w);
}

/* Energy lost in contact, in bonds and at walls. */
static inline void mpm__account(mpm_world *w)
{
    int32_t i;
    int d;
    for (i = 0; i < w->pairs; i++) {
        const mpm_pair *pair = &w->pair[i];
        const mpm_node *a = &w->node[pair->a], *b = &w->node[pair->b];
        double loss = 0;
        for (d = 0; d < 3; d++)
            loss -= (double)(pair->impulse[d] * (mpm__mean_velocity(w, a, d) - mpm__mean_velocity(w, b, d)));
        if (pair->held) w->ledger.hold += loss;
        else w->ledger.contact += loss;
    }
    for (i = 0; i < w->nodes; i++) {
        const mpm_node *n = &w->node[i];
        for (d = 0; d < 3; d++)
            if (n->reaction[d] < 0 || n->reaction[d] > 0)
                w->ledger.walls -= (double)(n->reaction[d] * mpm__mean_velocity(w, n, d));
    }
}

/* Once the momenta of the new velocities are at the nodes: velocities, boundary conditions, contact, the ledger. */
static inline void mpm__close_musl(mpm_world *w)
{
    int32_t i;
    int d;
    for (i = 0; i < w->nodes; i++) {
        mpm_node *n = &w->node[i];
        for (d = 0; d < 3; d++) n->velocity[d] = n->mass > 0 ? n->velocity[d] / n->mass : 0;
    }
    mpm__account(w);
    if (mpm__has_gravity(w)) mpm__gravity(w, 1);
    for (i = 0; i < w->nodes; i++)
        if (w->node[i].flags) mpm__constrain(w, &w->node[i], w->node[i].velocity, NULL);
    if (w->desc.scheme == MPM_SCHEME_CONSISTENT) mpm__settle(w, MPM__MAPPED);
    for (i = 0; i < w->nodes; i++) {
        mpm_node *n = &w->node[i];
        if (n->flags) mpm__walls_mapped(w, n);
    }
}

MPM_API void mpm_musl(mpm_world *w)
{
    mpm__sweep_velocities(w, MPM__MUSL);
    mpm__close_musl(w);
}

MPM_API void mpm_to_points(mpm_world *w)
{
    mpm__sweep_velocities(w, MPM__G2P | MPM__MUSL);
    mpm__account_images(w);
    mpm__close_musl(w);
}

/* Velocity and its gradient, dv_i/dx_j = sum v_Ii dN_I/dx_j, at the points of a span: v[i] and g[i][j]. */
MPM_KERNEL void mpm__span_gradients(const mpm_world *w, const mpm_run *r, const mpm__weights *s, int32_t first, int k,
                                    int ky, mpm_real (*v)[MPM__LANES], mpm_real (*g)[3][MPM__LANES])
{
    mpm_real V[MPM_SUPPORT][4];
    int at, part, d;
    MPM__EACH_PART(r, first, s->n, at, part) {
        mpm__gather_polynomial(w, r, k, ky, MPM__VELOCITY, 0, V);
        for (d = 0; d < 3; d++) mpm__values_gradient(s, at, part, k, ky, V, d, v[d], g[d]);
    }
}

/* Strain and rotation increments of n points, d eps_ij = dt (dv_i/dx_j + dv_j/dx_i) / 2, and half the curl of v times
   dt (A 3.35); in rings d eps_hoop = dt v_r / r. */
MPM_KERNEL void mpm__strains(mpm_real dt, int n, int hoop, const mpm_real *radius, mpm_real (*v)[MPM__LANES],
                             mpm_real (*g)[3][MPM__LANES], mpm_real (*e)[MPM_BLOCK], mpm_real (*spin)[MPM_BLOCK])
{
    const mpm_real half = MPM_R(0.5) * dt;
    int p;
    for (p = 0; p < n; p++) {
        e[0][p] = dt * g[0][0][p];
        e[1][p] = dt * (hoop ? v[0][p] / radius[p] : g[1][1][p]);
        e[2][p] = dt * g[2][2][p];
        e[3][p] = half * (g[1][2][p] + g[2][1][p]);
        e[4][p] = half * (g[0][2][p] + g[2][0][p]);
        e[5][p] = half * (g[0][1][p] + g[1][0][p]);
        spin[0][p] = half * (g[2][1][p] - g[1][2][p]);
        spin[1][p] = half * (g[0][2][p] - g[2][0][p]);
        spin[2][p] = half * (g[1][0][p] - g[0][1][p]);
    }
}

/* Density rho / (1 + tr d eps) (A 3.36), then the material, for points [first, first + n) whose strains are ready. */
static inline mpm_status mpm__constitute(mpm_world *w, const mpm_body *body, int32_t first, int n,
                                         mpm_real (*e)[MPM_BLOCK], mpm_real (*spin)[MPM_BLOCK])
{
    mpm_points *q = &w->points;
    mpm_real *rho = q->density + first, worst = 0;
    const mpm_status last = w->fault.status;
    mpm_block b;
    mpm_status s;
    int i, p;
    for (p = 0; p < n; p++) {
        const mpm_real volume = 1 + e[0][p] + e[1][p] + e[2][p];
        worst = volume > MPM_EPSILON && volume < 1 / MPM_EPSILON ? worst : 1;
        rho[p] /= volume;
    }
    if (worst > 0)
        for (p = 0; p < n; p++) {
            const mpm_real volume = 1 + e[0][p] + e[1][p] + e[2][p];
            if (!mpm_finite(volume)) return mpm_fail(&w->fault, MPM_ERR_NAN, "strain of point", volume, first + p);
            if (!(volume > MPM_EPSILON && volume < 1 / MPM_EPSILON))
                return mpm_fail(&w->fault, MPM_ERR_STATE, "volume ratio of point in one step", volume, first + p);
        }
    if (!body->desc.stress) return MPM_OK;
    b.count = n;
    b.dt = w->dt;
    b.cell = w->desc.cell;
    for (i = 0; i < 6; i++) b.strain[i] = e[i];
    for (i = 0; i < 3; i++) b.spin[i] = spin[i];
    for (i = 0; i < 6; i++) b.stress[i] = q->stress[i] + first;
    b.density = rho;
    b.energy = q->energy + first;
    b.temperature = q->temperature + first;
    b.plastic_strain = q->plastic_strain + first;
    b.plastic_rate = q->plastic_rate + first;
    b.plastic_work = q->plastic_work + first;
    for (i = 0; i < MPM_USER_FIELDS; i++) b.user[i] = i < w->desc.user_fields ? q->user[i] + first : NULL;
    b.tally = w->tally;
    b.fault = &w->fault;
    w->fault.status = MPM_OK;
    s = body->desc.stress(body->desc.material, &b);
    if (s < 0 && w->fault.status >= 0) mpm_fail(&w->fault, s, "stress law of a body", 0, 0);
    if (s >= 0) w->fault.status = last;
    else if (w->fault.index >= 0) w->fault.index += first; /* of the block, so far */
    if (s > 0) w->notices++;
    return s;
}

/* 0 where no node of the run has a record, told without a look at them. */
static inline int mpm__may_touch(const mpm_world *w, const mpm_run *r)
{
    return w->touches > 0 && (r->flags & MPM_NODE_CONTACT || mpm__has_walls(&w->desc));
}

/* 1 if a node of the run has a record: of a contact or a wall. */
static inline int mpm__run_touches(const mpm_world *w, const mpm_run *r)
{
    const int32_t *slot = mpm__run_nodes(w, r);
    int a;
    if (!mpm__may_touch(w, r)) return 0;
    for (a = 0; a < mpm__reach(w); a++)
        if (w->node[slot[a]].touch >= 0) return 1;
    return 0;
}

/* Moves the points of a span, x_p += dt sum N_I P_I / m_I (A 3.32), but for runs that touch unless `all`. */
MPM_KERNEL void mpm__span_moves(mpm_world *w, const mpm_run *r, const mpm__weights *s, int32_t first, int k, int ky,
                                int all)
{
    mpm_real V[MPM_SUPPORT][4], sum[3][MPM__LANES];
    int at, part, p, d;
    MPM__EACH_PART(r, first, s->n, at, part) {
        if (all || !mpm__run_touches(w, r)) {
            mpm__gather_polynomial(w, r, k, ky, MPM__MOMENTUM, 1, V);
            for (d = 0; d < 3; d++) mpm__values(s, at, part, k, ky, V, d, sum[d]);
        } else {
            for (d = 0; d < 3; d++)
                for (p = at; p < at + part; p++) sum[d][p] = 0;
        }
    }
    mpm__advance(w->points.x, first, s->n, w->dt, sum);
}

/* Strain increments of all points of one body, a block at a time. With `move` points are moved too, but not those of
   runs that touch: the ledger of their cut velocities asks for level k. */
MPM_KERNEL mpm_status mpm__stress_body(mpm_world *w, int32_t body, const mpm_run *r, const mpm_run *end, int k, int ky,
                                       int hoop, int move)
{
    mpm_real e[6][MPM_BLOCK], spin[3][MPM_BLOCK], v[3][MPM__LANES], g[3][3][MPM__LANES];
    int32_t first;
    int n;
    mpm__weights s;
    MPM__EACH_SPAN(r, end, first, n) {
        mpm_status status;
        mpm__weigh_span(w, r, first, n, k, ky, &s);
        mpm__span_gradients(w, r, &s, first, k, ky, v, g);
        mpm__strains(w->dt, n, hoop, w->points.x[0] + first, v, g, e, spin);
        if (move) mpm__span_moves(w, r, &s, first, k, ky, 0);
        if ((status = mpm__constitute(w, &w->body[body], first, n, e, spin)) < 0) return status;
    }
    return MPM_OK;
}

/* Adds the internal forces of the new stress to those of the old one, at the nodes of a run that have a record. */
static inline void mpm__inner_again(mpm_world *w, const mpm_run *r)
{
    const mpm_points *q = &w->points;
    mpm_support s;
    int32_t i;
    int a;
    for (i = r->first; i < r->first + r->count; i++) {
        const mpm_real V = -q->mass[i] / q->density[i];
        const mpm_real pull = w->desc.geometry == MPM_AXISYMMETRIC ? q->stress[1][i] / q->x[0][i] : 0;
        mpm_support_of(w, r, i, &s);
        for (a = 0; a < s.count; a++) {
            const int32_t touch = w->node[s.slot[a]].touch;
            const mpm_real x = s.G[0][a], y = s.G[1][a], z = s.G[2][a];
            mpm_real f[3];
            int d;
            if (touch < 0) continue;
            f[0] = q->stress[0][i] * x + q->stress[5][i] * y + q->stress[4][i] * z + pull * s.N[a];
            f[1] = q->stress[5][i] * x + q->stress[1][i] * y + q->stress[3][i] * z;
            f[2] = q->stress[4][i] * x + q->stress[3][i] * y + q->stress[2][i] * z;
            for (d = 0; d < 3; d++) w->touch[touch].inner[d] += V * mpm__sign(&s, a, d) * f[d];
        }
    }
}

/* 1 if a node of the run was cut: the velocity that its points were strained by is not what MUSL mapped back. */
static inline int mpm__run_is_cut(const mpm_world *w, const mpm_run *r)
{
    const int32_t *slot = mpm__run_nodes(w, r);
    int a;
    if (!mpm__may_touch(w, r)) return 0;
    for (a = 0; a < mpm__reach(w); a++) {
        const int32_t touch = w->node[slot[a]].touch;
        const mpm_real *cut = touch < 0 ? NULL : w->touch[touch].cut;
        if (cut && (cut[0] < 0 || cut[0] > 0 || cut[1] < 0 || cut[1] > 0 || cut[2] < 0 || cut[2] > 0)) return 1;
    }
    return 0;
}

/* Stress works through the cut velocities, forces on the points through those that were mapped: what the cuts
   kept from the stress, cut . (f_k + f_k+1) dt / 2, went to contact, holds and walls. A node of several pairs is booked
   by its first. */
static inline void mpm__account_cuts(mpm_world *w)
{
    int32_t i;
    int d;
    if (w->touches == 0 || (w->desc.scheme == MPM_SCHEME_THESIS && !mpm__has_walls(&w->desc))) return; /* no cuts */
    for (i = 0; i < w->runs; i++)
        if (mpm__run_is_cut(w, &w->run[i])) mpm__inner_again(w, &w->run[i]);
    for (i = 0; i < w->nodes; i++) {
        const mpm_touch *t = w->node[i].touch < 0 ? NULL : &w->touch[w->node[i].touch];
        double work = 0;
        if (!t) continue;
        for (d = 0; d < 3; d++) work += (double)(t->cut[d] * t->inner[d] * w->dt / 2);
        if (!(w->node[i].flags & MPM_NODE_CONTACT)) w->ledger.walls += work;
        else if (w->pair[t->pair].held) w->ledger.hold += work;
        else w->ledger.contact += work;
    }
}

static inline mpm_status mpm__sweep_stress(mpm_world *w, int move)
{
    mpm_status s = MPM_OK;
#define MPM__CALL(k, ky, hoop) \
    s = s < 0 ? s : mpm__stress_body(w, body, w->run + from, w->run + to, k, ky, hoop, move)
    MPM__EACH_BODY(w, 1, MPM__CALL);
#undef MPM__CALL
    if (s < 0) return s;
    mpm__account_cuts(w);
    return MPM_OK;
}

MPM_KERNEL void mpm__move_body(mpm_world *w, const mpm_run *r, const mpm_run *end, int k, int ky)
{
    mpm__weights s;
    int32_t first;
    int n;
    MPM__EACH_SPAN(r, end, first, n) {
        mpm__weigh_span(w, r, first, n, k, ky, &s);
        mpm__span_moves(w, r, &s, first, k, ky, 1);
    }
}

/* Moves the points of a run. */
static inline void mpm__move_run(mpm_world *w, const mpm_run *r)
{
#define MPM__CALL(k, ky, hoop) mpm__move_body(w, r, r + 1, k, ky)
    MPM__SPECIALISED(w, 0, MPM__CALL);
#undef MPM__CALL
}

/* Moves the points of all runs, or of those that touch, and the time. */
static inline void mpm__sweep_move(mpm_world *w, int all)
{
    int32_t i;
    if (all) {
#define MPM__CALL(k, ky, hoop) mpm__move_body(w, w->run + from, w->run + to, k, ky)
        MPM__EACH_BODY(w, 0, MPM__CALL);
#undef MPM__CALL
    } else {
        for (i = 0; i < w->runs && w->touches > 0; i++)
            if (mpm__run_touches(w, &w->run[i])) mpm__move_run(w, &w->run[i]);
    }
    w->time += w->dt;
    w->dt_last = w->dt;
    w->steps++;
}

MPM_API mpm_status mpm_stress(mpm_world *w) { return mpm__sweep_stress(w, 0); }

MPM_API void mpm_move(mpm_world *w) { mpm__sweep_move(w, 1); }

MPM_API mpm_status mpm_stress_and_move(mpm_world *w)
{
    const mpm_status s = mpm__sweep_stress(w, 1);
    if (s >= 0) mpm__sweep_move(w, 0);
    return s;
}

/* ---- locate: points in cell order, runs, slots ---------------------------------------------- */

/* Forgets all slots: the table of nodes is empty again. */
static inline void mpm__grid_reset(mpm_world *w)
{
    const size_t all = mpm__grid_nodes(w);
    int32_t s;
    if (all / 16 < (size_t)w->nodes) memset(w->head, 255, all * sizeof *w->head); /* all bits: -1 */
    else
        for (s = 0; s < w->nodes; s++) w->head[w->node[s].index] = -1;
    w->nodes = w->runs = w->pairs = w->pairs_possible = w->touches = 0;
}

/* Puts point j's fields where point i's are, and the reverse. */
static inline void mpm__swap_points(mpm_world *w, int32_t i, int32_t j)
{
    mpm_points *p = &w->points;
    int32_t id = p->id[i], key = w->key[i];
    uint8_t flags = p->flags[i];
    int f;
    for (f = 0; f < w->fields; f++) {
        mpm_real *a = w->field + (size_t)f * w->stride, t = a[i];
        a[i] = a[j];
        a[j] = t;
    }
    p->id[i] = p->id[j];
    p->id[j] = id;
    p->flags[i] = p->flags[j];
    p->flags[j] = flags;
    w->key[i] = w->key[j];
    w->key[j] = key;
}

/* The key of a point that lies on or beyond a closed side: it is put back on it, for nothing leaves there. -1 if it
   is beyond an open one, or no number. */
static inline int32_t mpm__key_at_side(mpm_world *w, int32_t i)
{
    const mpm_desc *d = &w->desc;
    int32_t at[3] = {0, 0, 0};
    int a;
    for (a = 0; a < 3; a++) {
        mpm_real *x = &w->points.x[a][i], t = (*x - d->origin[a]) / d->cell;
        if (a == 1 && mpm__flat(d)) continue;
        if (!mpm_finite(t)) return -1;
        if (t < 0 && d->side[2 * a] == MPM_SIDE_OPEN) return -1;
        if (t >= (mpm_real)d->cells[a] && d->side[2 * a + 1] == MPM_SIDE_OPEN) return -1;
        if (t < 0) *x = d->origin[a];
        if (t > (mpm_real)d->cells[a]) *x = mpm__grid_high(d, a);
        t = t < 0 ? 0 : t < (mpm_real)d->cells[a] ? t : (mpm_real)d->cells[a];
        at[a] = w->support[0] == 3 ? (int32_t)(t + MPM_R(0.5))
                                   : t < (mpm_real)d->cells[a] ? (int32_t)t : d->cells[a] - 1;
    }
    if (d->geometry == MPM_AXISYMMETRIC && !(w->points.x[0][i] > 0)) return -1; /* no ring without radius */
    return (at[2] * w->nodes_per_axis[1] + at[1]) * w->nodes_per_axis[0] + at[0];
}

/* The base node of every active point of a body, or -1 outside the grid; returns 1 if any is. A point's base is the
   lowest node it touches: of its cell with linear functions, of the nearest node's lower neighbour with GIMP and
   quadratic splines, the one below its cell with cubic ones. */
static inline int mpm__keys(mpm_world *w, const mpm_body *b)
{
    const mpm_desc *d = &w->desc;
    const mpm_real *x = w->points.x[0], *y = w->points.x[1], *z = w->points.x[2];
    const mpm_real inv = 1 / d->cell, shift = w->support[0] == 3 ? MPM_R(0.5) : 0;
    const mpm_real hx = (mpm_real)d->cells[0], hy = (mpm_real)d->cells[1], hz = (mpm_real)d->cells[2];
    const mpm_real ox = d->origin[0], oy = d->origin[1], oz = d->origin[2];
    const int32_t nx = w->nodes_per_axis[0], ny = w->nodes_per_axis[1];
    const int32_t from = b->first, to = from + b->active;
    const int flat = mpm__flat(d);
    int32_t i, *key = w->key, away = 0, lost = 0;
    for (i = from; i < to; i++) {
        const mpm_real tx = (x[i] - ox) * inv, ty = flat ? 0 : (y[i] - oy) * inv, tz = (z[i] - oz) * inv;
        /* truncation of t gives the cell's lower node, of t + 1/2 the nearest node; its lower neighbour is, with
           the ghost layer counted, of the same number */
        const int32_t ix = (int32_t)((tx >= 0 ? (tx < hx ? tx : -2) : -2) + shift);
        const int32_t iy = flat ? 0 : (int32_t)((ty >= 0 ? (ty < hy ? ty : -2) : -2) + shift);
        const int32_t iz = (int32_t)((tz >= 0 ? (tz < hz ? tz : -2) : -2) + shift);
        const int32_t out = (ix | iy | iz) < 0 ? -1 : 0;
        key[i] = out | ((iz * ny + iy) * nx + ix);
        away |= out;
    }
    for (i = from; i < to && away; i++) {
        if (key[i] < 0) key[i] = mpm__key_at_side(w, i);
        lost |= key[i] < 0;
    }
    return lost;
}

/* Takes points with key -1 out of the active range, in order. A position that is not a number is
   a failure, found before anything is moved. */
static inline mpm_status mpm__retire(mpm_world *w, mpm_body *b)
{
    const mpm_points *p = &w->points;
    int32_t i;
    int a;
    for (i = b->first; i < b->first + b->active; i++)
        for (a = 0; a < 3 && w->key[i] < 0; a++)
            if (!mpm_finite(p->x[a][i]))
                return mpm_fail(&w->fault, MPM_ERR_NAN, "position of point", p->x[a][i], i);
    for (i = b->first; i < b->first + b->active; i++)
        while (w->key[i] < 0 && i < b->first + b->active) {
            mpm__swap_points(w, i, b->first + b->active - 1);
            b->active--;
            w->retired++;
        }
    return MPM_OK;
}

enum { MPM__SORTED = 64 }; /* points that are put in order together */

/* How many of the points [i, to) that is, but none where they stay as they are: order[i] is -1 there. */
static inline int32_t mpm__moved(const int32_t *order, int32_t *i, int32_t to)
{
    while (*i < to && order[*i] < 0) *i += MPM__SORTED;
    return *i >= to ? 0 : to - *i < MPM__SORTED ? to - *i : MPM__SORTED;
}

/* Puts entries of `size` bytes of points [from, to) in order, by way of spare. */
MPM_KERNEL void mpm__reorder(void *array, void *spare, const int32_t *order, int32_t from, int32_t to, size_t size)
{
    char *a = (char *)array, *b = (char *)spare;
    int32_t i, j, n;
    for (i = from; (n = mpm__moved(order, &i, to)) > 0; i += n)
        for (j = i; j < i + n; j++) memcpy(b + (size_t)j * size, a + (size_t)order[j] * size, size);
    for (i = from; (n = mpm__moved(order, &i, to)) > 0; i += n)
        memcpy(a + (size_t)i * size, b + (size_t)i * size, (size_t)n * size);
}

/* Notes in `order` which points [from, to) need not be put in order. */
static inline void mpm__mark_sorted(int32_t *order, int32_t from, int32_t to)
{
    int32_t i, j;
    for (i = from; i < to; i += MPM__SORTED) {
        const int32_t end = to - i < MPM__SORTED ? to : i + MPM__SORTED;
        int32_t moved = 0;
        for (j = i; j < end; j++) moved |= order[j] ^ j;
        if (!moved) order[i] = -1;
    }
}

/* Counting sort of a body's points by base node, to w->order. The table of nodes, unused between steps, holds
   the counts; stable, hence deterministic. */
static inline void mpm__sorted_order(mpm_world *w, int32_t from, int32_t to)
{
    const int32_t *key = w->key;
    int32_t i, lo = key[from], hi = lo, sum = from, *head = w->head, *order = w->order;
    for (i = from; i < to; i++) {
        lo = key[i] < lo ? key[i] : lo;
        hi = key[i] > hi ? key[i] : hi;
    }
    for (i = lo; i <= hi; i++) head[i] = 0;
    for (i = from; i < to; i++) head[key[i]]++;
    for (i = lo; i <= hi; i++) {
        const int32_t n = head[i];
        head[i] = sum;
        sum += n;
    }
    for (i = from; i < to; i++) order[head[key[i]]++] = i;
    for (i = lo; i <= hi; i++) head[i] = -1;
}

static inline void mpm__sort(mpm_world *w, const mpm_body *b)
{
    const int32_t from = b->first, to = from + b->active;
    int f;
    if (from == to) return;
    mpm__sorted_order(w, from, to);
    mpm__mark_sorted(w->order, from, to);
    for (f = 0; f < w->fields; f++)
        mpm__reorder(w->field + (size_t)f * w->stride, w->scratch, w->order, from, to, sizeof *w->field);
    mpm__reorder(w->points.id, w->scratch, w->order, from, to, sizeof *w->points.id);
    mpm__reorder(w->key, w->scratch, w->order, from, to, sizeof *w->key);
    mpm__reorder(w->points.flags, w->scratch, w->order, from, to, sizeof *w->points.flags);
}

/* Runs there would be with the points as they lie. */
static inline int32_t mpm__count_runs(const mpm_world *w)
{
    const int32_t *key = w->key;
    int32_t b, i, n = 0;
    for (b = 0; b < w->bodies; b++) {
        const int32_t from = w->body[b].first, to = from + w->body[b].active;
        if (to > from) n++;
        for (i = from + 1; i < to; i++) n += key[i] != key[i - 1];
    }
    return n;
}

/* The slot of a body at a node, made if there is none; -1 if there is no room. */
static inline int32_t mpm__slot(mpm_world *w, int32_t body, const int32_t *at)
{
    const int32_t *n = w->nodes_per_axis;
    const int32_t index = (at[2] * n[1] + at[1]) * n[0] + at[0];
    int32_t s, others = 0, sides = 0;
    mpm_node *node;
    int d;
    for (s = w->head[index]; s >= 0; s = w->node[s].next, others++)
        if (w->node[s].body == body) return s;
    if (w->nodes == w->node_capacity) return -1;
    w->pairs_possible += others;
    s = w->nodes++;
    node = &w->node[s];
    memset(node, 0, sizeof *node);
    for (d = 0; d < 3; d++) {
        if (d == 1 && mpm__flat(&w->desc)) continue;
        if (at[d] <= w->ghost && w->desc.side[2 * d]) sides |= 1 << (2 * d);
        if (at[d] >= n[d] - 1 - w->ghost && w->desc.side[2 * d + 1]) sides |= 1 << (2 * d + 1);
    }
    node->index = index;
    node->body = body;
    node->flags = sides;
    node->touch = -1;
    node->next = w->head[index];
    w->head[index] = s;
    return s;
}

/* 1 if run r lies one node further along x than the one before it in the list: they share all but the ends of lines. */
static inline int mpm__follows(const mpm_world *w, const mpm_run *r)
{
    const mpm_run *before = r - 1;
    return r > w->run && before->body == r->body && before->base[0] + 1 == r->base[0] &&
           before->base[1] == r->base[1] && before->base[2] == r->base[2];
}

/* Gives a run its slots. */
static inline int mpm__run_slots(mpm_world *w, mpm_run *r, int32_t *slot)
{
    const int *n = w->support, shared = mpm__follows(w, r) ? n[0] - 1 : 0, reach = mpm__reach(w);
    int32_t at[3], mirrored[3][4];
    int i[3], d;
    for (d = 0; d < 3; d++)
        for (i[0] = 0; i[0] < n[d]; i[0]++) mirrored[d][i[0]] = mpm__image_node(w, d, r->base[d] + i[0], &r->flags);
    for (i[2] = 0; i[2] < n[2]; i[2]++)
        for (i[1] = 0; i[1] < n[1]; i[1]++, slot += n[0]) {
            for (i[0] = 0; i[0] < shared; i[0]++) slot[i[0]] = slot[i[0] + 1 - reach];
            for (; i[0] < n[0]; i[0]++) {
                for (d = 0; d < 3; d++) at[d] = mirrored[d][i[d]];
                if ((slot[i[0]] = mpm__slot(w, r->body, at)) < 0) return 0;
            }
        }
    return 1;
}

/* Lists runs and slots for the points as they lie. */
static inline mpm_status mpm__list_runs(mpm_world *w)
{
    const int32_t nx = w->nodes_per_axis[0], ny = w->nodes_per_axis[1];
    const int reach = mpm__reach(w);
    int32_t b, i;
    for (b = 0; b < w->bodies; b++) {
        const int32_t to = w->body[b].first + w->body[b].active;
        for (i = w->body[b].first; i < to;) {
            mpm_run *r = &w->run[w->runs];
            const int32_t key = w->key[i];
            if (w->runs == w->run_capacity) return MPM_ERR_FULL;
            r->first = i;
            while (++i < to && w->key[i] == key) {}
            r->count = i - r->first;
            r->base[0] = key % nx;
            r->base[1] = key / nx % ny;
            r->base[2] = key / nx / ny;
            r->body = b;
            r->flags = 0;
            if (!mpm__run_slots(w, r, w->slot + (size_t)w->runs * (size_t)reach)) return MPM_ERR_FULL;
            w->runs++;
        }
    }
    return w->pairs_possible > w->pair_capacity ? MPM_ERR_FULL : MPM_OK;
}

/* Sorts the points again once their order has cost a quarter more runs. */
static inline void mpm__keep_order(mpm_world *w)
{
    int32_t b, runs = mpm__count_runs(w);
    if (runs <= w->sorted_runs + w->sorted_runs / 4) return;
    for (b = 0; b < w->bodies; b++) mpm__sort(w, &w->body[b]);
    w->sorted_runs = mpm__count_runs(w);
    w->sorts++;
}

/* mpm_locate with the room there is, or with what MPM_MALLOC gives. */
static inline mpm_status mpm__locate(mpm_world *w)
{
    const int64_t retired = w->retired;
    int32_t b, possible;
    mpm_status s;
    mpm__grid_reset(w);
    for (b = 0; b < w->bodies; b++) {
        if (mpm__keys(w, &w->body[b]) && (s = mpm__retire(w, &w->body[b])) != MPM_OK) return s;
    }
    mpm__keep_order(w);
    while (mpm__list_runs(w) != MPM_OK) {
        possible = w->pairs_possible;
        mpm__grid_reset(w);
        w->pairs_possible = possible;
        if (!w->owns_work) return mpm_fail(&w->fault, MPM_ERR_FULL, "nodes", (mpm_real)w->node_capacity, -1);
        if ((s = mpm_reserve(w, NULL, 0)) != MPM_OK) return s;
    }
    return w->retired > retired ? MPM_RETIRED : MPM_OK;
}

/* The first body with a stress law and without a wave speed, or -1. */
static inline int32_t mpm__without_wave(const mpm_world *w)
{
    int32_t b;
    for (b = 0; b < w->bodies; b++)
        if (w->body[b].desc.stress && !(w->body[b].desc.wave_p > 0)) return b;
    return -1;
}

static inline mpm_real mpm__fastest_wave(const mpm_world *w)
{
    mpm_real c = 0;
    int32_t b;
    for (b = 0; b < w->bodies; b++)
        if (w->body[b].desc.wave_p > c) c = w->body[b].desc.wave_p;
    return c;
}

MPM_API mpm_real mpm_time_step(const mpm_world *w, mpm_real factor)
{
    const mpm_real c = mpm__fastest_wave(w);
    return c > 0 && mpm__without_wave(w) < 0 ? factor * w->desc.cell / c : 0;
}

/* Whether dt is one. Of 0 it says where that may come from. */
static inline mpm_status mpm__dt_check(mpm_world *w, mpm_real dt)
{
    const int32_t body = mpm__without_wave(w);
    if (dt <= 0 && dt >= 0 && body >= 0)
        return mpm_fail(&w->fault, MPM_ERR_ARGUMENT, "dt (mpm_time_step: no wave_p of body)", dt, body);
    return mpm_want(dt > 0, &w->fault, "dt", dt, -1);
}

MPM_API mpm_status mpm_locate(mpm_world *w, mpm_real dt)
{
    const mpm_real c = mpm__fastest_wave(w), most = c > 0 ? w->desc.cell / c : 0;
    mpm_status s = mpm__dt_check(w, dt);
    if (s != MPM_OK) return s;
    w->dt = dt;
    s = mpm__locate(w);
    if (s < 0 || !(c > 0) || dt <= most || w->dt_last > most) return s;
    w->notices++;
    return MPM_UNSTABLE;
}

/* ---- looking at it --------------------------------------------------------------------------- */

/* Neumaier's sum: exact to the last place for any order of the points. */
static inline void mpm__sum(double *sum, double *rest, double a)
{
    double t = *sum + a, big = *sum < 0 ? -*sum : *sum, size = a < 0 ? -a : a;
    *rest += big >= size ? (*sum - t) + a : (a - t) + *sum;
    *sum = t;
}

MPM_API mpm_totals mpm_body_totals(const mpm_world *w, int32_t body)
{
    const mpm_points *q = &w->points;
    const int32_t from = body < 0 ? 0 : body, to = body < 0 ? w->bodies : body + 1;
    double rest[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
    mpm_totals t;
    int32_t b, i;
    int d, any = 0;
    memset(&t, 0, sizeof t);
    for (b = from; b < to; b++) {
        const mpm_body *B = &w->body[b];
        t.points += B->count;
        t.retired += B->count - B->active;
        for (i = B->first; i < B->first + B->count; i++) {
            const double m = (double)q->mass[i];
            double v2 = 0;
            for (d = 0; d < 3; d++) {
                const double v = (double)q->v[d][i], x = (double)q->x[d][i];
                v2 += v * v;
                mpm__sum(&t.momentum[d], &rest[d], m * v);
                if (i >= B->first + B->active) continue;
                if (!any || x < t.low[d]) t.low[d] = x;
                if (!any || x > t.high[d]) t.high[d] = x;
            }
            if (i < B->first + B->active) any = 1;
            mpm__sum(&t.mass, &rest[3], m);
            mpm__sum(&t.kinetic, &rest[4], 0.5 * m * v2);
            mpm__sum(&t.internal, &rest[5], m * (double)q->energy[i]);
            mpm__sum(&t.plastic_strain_mean, &rest[6], m * (double)q->plastic_strain[i]);
            mpm__sum(&t.plastic_work_mean, &rest[7], m * (double)q->plastic_work[i]);
            mpm__sum(&t.plastic, &rest[8], m / (double)q->density[i] * (double)q->plastic_work[i]);
            if ((double)q->temperature[i] > t.temperature_max) t.temperature_max = (double)q->temperature[i];
        }
    }
    for (d = 0; d < 3; d++) t.momentum[d] += rest[d];
    t.mass += rest[3];
    t.kinetic += rest[4];
    t.internal += rest[5];
    t.plastic += rest[8];
    if (t.mass > 0) {
        t.plastic_strain_mean = (t.plastic_strain_mean + rest[6]) / t.mass;
        t.plastic_work_mean = (t.plastic_work_mean + rest[7]) / t.mass;
    }
    return t;
}

/* ---- restart --------------------------------------------------------------------------------- */

MPM_API int mpm_blobs(mpm_world *w, mpm_blob *blob)
{
    mpm_points *p = &w->points;
    const size_t count = (size_t)p->count, room = (size_t)p->capacity, real = sizeof(mpm_real);
    int n = 0, i;
    int32_t b;
#define MPM__VECTOR(name, components, unit, text) \
    for (i = 0; i < components; i++) blob[n++] = mpm_blob_array(#name, p->name[i], count, room, real);
#define MPM__SCALAR(name, components, unit, text) blob[n++] = mpm_blob_array(#name, p->name, count, room, real);
    MPM_POINT_VECTORS(MPM__VECTOR)
    MPM_POINT_SCALARS(MPM__SCALAR)
#undef MPM__VECTOR
#undef MPM__SCALAR
    for (i = 0; i < w->desc.user_fields; i++) blob[n++] = mpm_blob_array("user", p->user[i], count, room, real);
    blob[n++] = mpm_blob_array("flags", p->flags, count, room, 1);
    blob[n++] = mpm_blob_array("id", p->id, count, room, sizeof(int32_t));
    blob[n++] = mpm_blob_of("points", &p->count, sizeof p->count);
    blob[n++] = mpm_blob_of("next id", &w->next_id, sizeof w->next_id);
    blob[n++] = mpm_blob_of("time", &w->time, sizeof w->time);
    blob[n++] = mpm_blob_of("last step", &w->dt_last, sizeof w->dt_last);
    blob[n++] = mpm_blob_of("steps", &w->steps, sizeof w->steps);
    blob[n++] = mpm_blob_of("ledger", &w->ledger, sizeof w->ledger);
    blob[n++] = mpm_blob_of("retired", &w->retired, sizeof w->retired);
    blob[n++] = mpm_blob_of("sorts", &w->sorts, sizeof w->sorts);
    blob[n++] = mpm_blob_of("sorted runs", &w->sorted_runs, sizeof w->sorted_runs);
    blob[n++] = mpm_blob_of("notices", &w->notices, sizeof w->notices);
    blob[n++] = mpm_blob_of("tally", w->tally, sizeof w->tally);
    blob[n++] = mpm_blob_of("held", &w->held, sizeof w->held);
    for (b = 0; b < w->bodies; b++) { /* first, count and active stand side by side */
        blob[n++] = mpm_blob_of("points of body", &w->body[b].first, 3 * sizeof(int32_t));
        blob[n++] = mpm_blob_of("masses of body", &w->body[b].point_mass, 3 * sizeof(mpm_real)); /* mean, faces */
    }
    return n;
}

/* Every body's points follow those of the body before it, within the memory there is. */
static inline mpm_status mpm__restored_counts(const mpm_world *w, mpm_fault *f)
{
    const mpm_points *p = &w->points;
    mpm_status s = mpm_want(p->count >= 0 && p->count <= p->capacity, f, "points", (mpm_real)p->count, -1);
    int32_t b, next = 0;
    for (b = 0; b < w->bodies && s == MPM_OK; b++) {
        const mpm_body *B = &w->body[b];
        s = mpm_want(B->first == next && B->count >= 0 && B->count <= p->count - next, f, "points of body",
                     (mpm_real)B->count, b);
        if (s == MPM_OK)
            s = mpm_want(B->active >= 0 && B->active <= B->count, f, "active points of body", (mpm_real)B->active, b);
        if (s == MPM_OK) s = mpm_want(B->point_mass > 0, f, "mean mass of body", B->point_mass, b);
        if (s == MPM_OK) s = mpm_want(B->mass[0] >= 0, f, "mass at the bottom of body", B->mass[0], b);
        if (s == MPM_OK) s = mpm_want(B->mass[1] >= 0, f, "mass at the rim of body", B->mass[1], b);
        if (s == MPM_OK) next += B->count;
    }
    if (s == MPM_OK) s = mpm_want(next == p->count, f, "points of all bodies", (mpm_real)next, -1);
    if (s == MPM_OK) s = mpm_want(w->next_id >= 0, f, "next id", (mpm_real)w->next_id, -1);
    if (s == MPM_OK) s = mpm_want(w->sorted_runs >= 0, f, "sorted runs", (mpm_real)w->sorted_runs, -1);
    return s == MPM_OK ? mpm_want(1, f, "time", w->time, -1) : s;
}

/* As many values per array as there are points, and what is divided by. Positions are seen to by mpm_locate. */
static inline mpm_status mpm__restored_points(const mpm_world *w, const mpm_blob *blob, mpm_fault *f)
{
    const mpm_points *p = &w->points;
    mpm_status s = MPM_OK;
    int32_t i;
    int k;
    for (k = 0; k < w->fields + 2 && s == MPM_OK; k++) {
        const size_t size = k < w->fields ? sizeof(mpm_real) : k == w->fields ? 1 : sizeof(int32_t);
        const size_t values = blob[k].bytes / size;
        s = mpm_want(blob[k].bytes == (size_t)p->count * size, f, blob[k].name, (mpm_real)values, -1);
    }
    for (i = 0; i < p->count && s == MPM_OK; i++) {
        if ((s = mpm_want(p->mass[i] > 0, f, "mass of point", p->mass[i], i)) != MPM_OK) break;
        if ((s = mpm_want(p->density[i] > 0, f, "density of point", p->density[i], i)) != MPM_OK) break;
        s = mpm_want(p->id[i] >= 0, f, "id of point", (mpm_real)p->id[i], i);
    }
    return s;
}

MPM_API mpm_status mpm_restored(mpm_world *w, const mpm_blob *blob)
{
    mpm_status s = mpm__restored_counts(w, &w->fault);
    int32_t b;
    if (s == MPM_OK) s = mpm__restored_points(w, blob, &w->fault);
    mpm__grid_reset(w);
    if (s == MPM_OK) return s;
    w->points.count = 0;
    for (b = 0; b < w->bodies; b++) w->body[b].first = w->body[b].count = w->body[b].active = 0;
    return s;
}

/* ---- small tools --------------------------------------------------------------------------- */

MPM_API const char *mpm_version(void) { return MPM_VERSION; }

MPM_API const char *mpm_status_text(mpm_status s)
{
    switch (s) {
#define MPM__STATUS_TEXT(name, number, text) \
    case name: return text;
        MPM_STATUS_LIST(MPM__STATUS_TEXT)
#undef MPM__STATUS_TEXT
    default: return "unknown status";
    }
}

static inline mpm_units mpm__units(double length, double mass, double time)
{
    mpm_units u;
    u.length = length;
    u.mass = mass;
    u.time = time;
    return u;
}

MPM_API mpm_units mpm_units_si(void) { return mpm__units(1, 1, 1); }
MPM_API mpm_units mpm_units_um_us_ng(void) { return mpm__units(1e-6, 1e-12, 1e-6); }
MPM_API mpm_units mpm_units_mm_ms_g(void) { return mpm__units(1e-3, 1e-3, 1e-3); }

MPM_API double mpm_units_velocity(const mpm_units *u) { return u->length / u->time; }
MPM_API double mpm_units_density(const mpm_units *u) { return u->mass / (u->length * u->length * u->length); }
MPM_API double mpm_units_stress(const mpm_units *u) { return u->mass / (u->length * u->time * u->time); }
MPM_API double mpm_units_energy(const mpm_units *u)
{
    return u->mass * u->length * u->length / (u->time * u->time);
}
MPM_API double mpm_units_specific_energy(const mpm_units *u)
{
    return u->length * u->length / (u->time * u->time);
}
MPM_API double mpm_units_area_energy(const mpm_units *u) { return u->mass / (u->time * u->time); }

MPM_API mpm_real mpm_wave_speed_p(mpm_real young, mpm_real poisson, mpm_real density)
{
    return mpm_sqrt(young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson) * density));
}

MPM_API mpm_real mpm_wave_speed_s(mpm_real young, mpm_real poisson, mpm_real density)
{
    return mpm_sqrt(young / (2 * (1 + poisson) * density));
}

/* ---- memory -------------------------------------------------------------------------------- */

/* How many arrays the named fields of the points take. */
#define MPM__COMPONENTS(name, components, unit, text) +components
#define MPM__NAMED_FIELDS (0 MPM_POINT_VECTORS(MPM__COMPONENTS) MPM_POINT_SCALARS(MPM__COMPONENTS))

static inline void mpm__grid_sizes(mpm_world *w)
{
    int a;
    w->ghost = w->desc.basis == MPM_LINEAR ? 0 : 1;
    for (a = 0; a < 3; a++) {
        w->support[a] = w->desc.basis == MPM_CUBIC ? 4 : 2 + w->ghost;
        w->nodes_per_axis[a] = w->desc.cells[a] + 1 + 2 * w->ghost;
    }
    if (mpm__flat(&w->desc)) {
        w->support[1] = 1;
        w->nodes_per_axis[1] = 1;
    }
}

/* Points the members of w->points at their arrays, one after the other. */
static inline void mpm__layout_fields(mpm_world *w)
{
    mpm_points *p = &w->points;
    mpm_real *f = w->field;
    int i;
#define MPM__VECTOR(name, components, unit, text) \
    for (i = 0; i < components; i++, f += w->stride) p->name[i] = f;
#define MPM__SCALAR(name, components, unit, text) \
    p->name = f;                                  \
    f += w->stride;
    MPM_POINT_VECTORS(MPM__VECTOR)
    MPM_POINT_SCALARS(MPM__SCALAR)
#undef MPM__VECTOR
#undef MPM__SCALAR
    for (i = 0; i < w->desc.user_fields; i++, f += w->stride) p->user[i] = f;
}

/* Lays out the first block: points and the grid table. Returns its size. Field strides are an odd
   number of cache lines, so that fields of one point do not compete for the same cache set. */
static inline size_t mpm__layout_points(mpm_world *w, char *base)
{
    mpm_points *p = &w->points;
    size_t used = 0, n = (size_t)w->desc.points, lines = (n * sizeof(mpm_real) + MPM_ALIGN - 1) / MPM_ALIGN;
    w->fields = MPM__NAMED_FIELDS + w->desc.user_fields;
    w->stride = (lines | 1) * (MPM_ALIGN / sizeof(mpm_real));
    w->body = (mpm_body *)mpm_carve(base, &used, (size_t)w->desc.bodies, sizeof(mpm_body));
    w->rule = (mpm_rule *)mpm_carve(base, &used, (size_t)w->desc.rules, sizeof(mpm_rule));
    w->field = (mpm_real *)mpm_carve(base, &used, mpm_size_mul(w->stride, (size_t)w->fields), sizeof(mpm_real));
    w->scratch = (mpm_real *)mpm_carve(base, &used, w->stride, sizeof(mpm_real));
    p->id = (int32_t *)mpm_carve(base, &used, n, sizeof(int32_t));
    p->flags = (uint8_t *)mpm_carve(base, &used, n, 1);
    w->key = (int32_t *)mpm_carve(base, &used, n, sizeof(int32_t));
    w->order = (int32_t *)mpm_carve(base, &used, n, sizeof(int32_t));
    w->head = (int32_t *)mpm_carve(base, &used, mpm__grid_nodes(w), sizeof(int32_t));
    if (base) mpm__layout_fields(w);
    return used;
}

/* Lays out the second block for a number of slots: there are as many runs as slots, and far fewer pairs. Each pair
   touches two slots, walls any. */
static inline size_t mpm__layout_work(mpm_world *w, char *base, int32_t nodes)
{
    const int32_t pairs = nodes / 4 + 64;
    size_t used = 0, n = (size_t)nodes, touches = 2 * (size_t)pairs + (mpm__has_walls(&w->desc) ? n : 0);
    size_t reach = (size_t)w->support[0] * (size_t)w->support[1] * (size_t)w->support[2];
    w->node_capacity = w->run_capacity = nodes;
    w->pair_capacity = pairs;
    w->node = (mpm_node *)mpm_carve(base, &used, n, sizeof(mpm_node));
    w->run = (mpm_run *)mpm_carve(base, &used, n, sizeof(mpm_run));
    w->slot = (int32_t *)mpm_carve(base, &used, mpm_size_mul(n, reach), sizeof(int32_t));
    w->pair = (mpm_pair *)mpm_carve(base, &used, (size_t)pairs, sizeof(mpm_pair));
    w->touch = (mpm_touch *)mpm_carve(base, &used, touches, sizeof(mpm_touch));
    w->plane = (mpm_plane *)mpm_carve(base, &used, w->planes ? (size_t)pairs : 0, sizeof(mpm_plane));
    if (!w->planes) w->plane = NULL;
    return used;
}

/* A first guess of the slots needed; mpm_body_add corrects it where it may. */
static inline int32_t mpm__guess_nodes(const mpm_desc *d)
{
    return d->nodes ? d->nodes : d->points / 10 + 256;
}

/* Size of the first block, so that the second is aligned behind it. */
static inline size_t mpm__points_bytes(const mpm_world *w)
{
    mpm_world copy = *w;
    return mpm_size_add(mpm__layout_points(&copy, NULL), MPM_ALIGN) / MPM_ALIGN * MPM_ALIGN;
}

/* A world with a description and nothing else. */
static inline void mpm__describe(mpm_world *w, const mpm_desc *d)
{
    w->desc = *d;
    w->planes = d->contact.normal == MPM_NORMAL_LOGISTIC;
    if (mpm__flat(d)) {
        w->desc.cells[1] = 1;
        w->desc.side[2] = w->desc.side[3] = MPM_SIDE_OPEN;
    }
    mpm__grid_sizes(w);
}

MPM_API size_t mpm_bytes(const mpm_desc *d)
{
    mpm_world w;
    size_t n;
    if (mpm_desc_check(d, NULL) != MPM_OK) return 0;
    memset(&w, 0, sizeof w);
    mpm__describe(&w, d);
    n = mpm__points_bytes(&w);
    if (n > (size_t)-1 - MPM_ALIGN) return 0;
    n = mpm_size_add(n, mpm__layout_work(&w, NULL, mpm__guess_nodes(d)));
    return n == (size_t)-1 ? 0 : n;
}

MPM_API size_t mpm_bytes_used(const mpm_world *w) { return w->memory_bytes + w->work_bytes; }

/* Whether memory of the caller's is aligned; NULL is none. */
static inline mpm_status mpm__memory_check(mpm_fault *f, const void *memory)
{
    return mpm_want(!mpm_unaligned(memory), f, "memory (not aligned)", (mpm_real)mpm_unaligned(memory), -1);
}

/* The two blocks, from the caller's memory or from MPM_MALLOC. */
static inline int mpm__take_memory(mpm_world *w, void *memory, size_t points, size_t work)
{
    w->memory = memory ? memory : MPM_MALLOC(points);
    w->owns_memory = w->owns_work = memory == NULL;
    if (memory) w->work = (char *)memory + points;
    else w->work = w->memory ? MPM_MALLOC(work) : NULL;
    if (!w->work) mpm_free(w);
    w->memory_bytes = points;
    w->work_bytes = work;
    return w->work != NULL;
}

/* An empty first block. */
static inline void mpm__clear_points(mpm_world *w)
{
    size_t i, nodes = mpm__grid_nodes(w);
    memset(w->memory, 0, w->memory_bytes);
    mpm__layout_points(w, (char *)w->memory);
    w->points.capacity = w->desc.points;
    for (i = 0; i < nodes; i++) w->head[i] = -1;
}

MPM_API mpm_status mpm_init(mpm_world *w, const mpm_desc *d, void *memory, size_t bytes)
{
    size_t points, work;
    mpm_status s;
    memset(w, 0, sizeof *w);
    w->fault.index = -1;
    if ((s = mpm_desc_check(d, &w->fault)) != MPM_OK || (s = mpm__memory_check(&w->fault, memory)) != MPM_OK) return s;
    mpm__describe(w, d);
    points = mpm__points_bytes(w);
    work = mpm__layout_work(w, NULL, mpm__guess_nodes(d));
    if (mpm_size_add(points, work) == (size_t)-1)
        return mpm_fail(&w->fault, MPM_ERR_MEMORY, "points", (mpm_real)d->points, -1);
    if (memory && bytes < points + work) return mpm_fail(&w->fault, MPM_ERR_MEMORY, "bytes", (mpm_real)bytes, -1);
    if (!mpm__take_memory(w, memory, points, work))
        return mpm_fail(&w->fault, MPM_ERR_MEMORY, "bytes", (mpm_real)(points + work), -1);
    mpm__clear_points(w);
    mpm__layout_work(w, (char *)w->work, mpm__guess_nodes(d));
    return MPM_OK;
}

MPM_API void mpm_free(mpm_world *w)
{
    if (w->owns_memory && w->memory) MPM_FREE(w->memory);
    if (w->owns_work && w->work) MPM_FREE(w->work);
    w->memory = w->work = NULL;
    w->owns_memory = w->owns_work = 0;
    w->points.count = 0;
    w->bodies = 0;
}

static inline int32_t mpm__grown(const mpm_world *w)
{
    const int32_t pairs = w->pairs_possible < 250000000 ? 4 * w->pairs_possible : 1000000000;
    int32_t need = pairs > w->node_capacity && w->pairs_possible > w->pair_capacity ? pairs : w->node_capacity;
    return need > 1000000000 ? 2000000000 : 2 * need;
}

MPM_API size_t mpm_reserve_bytes(const mpm_world *w)
{
    mpm_world copy = *w;
    return mpm__layout_work(&copy, NULL, mpm__grown(w));
}

MPM_API mpm_status mpm_reserve(mpm_world *w, void *memory, size_t bytes)
{
    const int32_t nodes = mpm__grown(w);
    size_t need = mpm_reserve_bytes(w);
    void *block;
    mpm_status s = mpm__memory_check(&w->fault, memory);
    if (s != MPM_OK) return s;
    block = memory ? memory : MPM_MALLOC(need);
    if (!block || (memory && bytes < need))
        return mpm_fail(&w->fault, MPM_ERR_MEMORY, "bytes", (mpm_real)need, -1);
    mpm__grid_reset(w);
    if (w->owns_work) MPM_FREE(w->work);
    w->work = block;
    w->work_bytes = need;
    w->owns_work = memory == NULL;
    mpm__layout_work(w, (char *)block, nodes);
    return MPM_OK;
}

/* Copies what the points, bodies and rules of `from` hold into the larger arrays of w. */
static inline void mpm__copy_points(mpm_world *w, const mpm_world *from)
{
    const size_t n = (size_t)from->points.count;
    int f;
    if (from->bodies > 0) memcpy(w->body, from->body, (size_t)from->bodies * sizeof *w->body);
    if (from->rules > 0) memcpy(w->rule, from->rule, (size_t)from->rules * sizeof *w->rule);
    if (n == 0) return;
    for (f = 0; f < from->fields; f++)
        memcpy(w->field + (size_t)f * w->stride, from->field + (size_t)f * from->stride, n * sizeof *w->field);
    memcpy(w->points.id, from->points.id, n * sizeof *w->points.id);
    memcpy(w->points.flags, from->points.flags, n);
}

/* Room for the capacities that w->desc now asks for, where `before` had less. The grid is empty after it. */
static inline mpm_status mpm__enlarge(mpm_world *w, const mpm_world *before)
{
    const size_t bytes = mpm__points_bytes(w);
    void *block = MPM_MALLOC(bytes);
    if (!block) {
        *w = *before;
        return mpm_fail(&w->fault, MPM_ERR_MEMORY, "bytes", (mpm_real)bytes, -1);
    }
    w->memory = block;
    w->memory_bytes = bytes;
    mpm__clear_points(w);
    mpm__copy_points(w, before);
    w->nodes = w->runs = w->pairs = w->pairs_possible = w->touches = 0;
    MPM_FREE(before->memory);
    return MPM_OK;
}

/* Room for so many points, bodies, rules, user fields more. Only memory of our own grows. */
static inline mpm_status mpm__room(mpm_world *w, int32_t points, int32_t bodies, int32_t rules, int fields)
{
    const mpm_world before = *w;
    const int32_t count = w->points.count;
    if (points > 2147483647 - count) return mpm_fail(&w->fault, MPM_ERR_FULL, "points", (mpm_real)points, -1);
    if (count + points <= w->desc.points && w->bodies + bodies <= w->desc.bodies && w->rules + rules <= w->desc.rules &&
        fields <= w->desc.user_fields)
        return MPM_OK;
    if (!w->owns_memory) {
        if (count + points > w->desc.points)
            return mpm_fail(&w->fault, MPM_ERR_FULL, "points", (mpm_real)w->desc.points, -1);
        if (w->bodies + bodies > w->desc.bodies)
            return mpm_fail(&w->fault, MPM_ERR_FULL, "bodies", (mpm_real)w->desc.bodies, w->bodies);
        if (w->rules + rules > w->desc.rules)
            return mpm_fail(&w->fault, MPM_ERR_FULL, "rules", (mpm_real)w->desc.rules, -1);
        return mpm_fail(&w->fault, MPM_ERR_FULL, "user_fields", (mpm_real)w->desc.user_fields, -1);
    }
    if (count + points > w->desc.points) w->desc.points = points > count / 4 ? count + points : count + count / 4;
    if (w->bodies + bodies > w->desc.bodies) w->desc.bodies = 2 * w->bodies + bodies;
    if (w->rules + rules > w->desc.rules) w->desc.rules = 2 * w->rules + rules;
    if (fields > w->desc.user_fields) w->desc.user_fields = fields;
    return mpm__enlarge(w, &before);
}

MPM_API int mpm_field_take(mpm_world *w, const char *name)
{
    int f;
    for (f = 0; f < MPM_USER_FIELDS && w->user_name[f]; f++)
        if (!strcmp(w->user_name[f], name)) return f;
    if (f == MPM_USER_FIELDS || mpm__room(w, 0, 0, 0, f + 1) != MPM_OK) return -1;
    w->user_name[f] = name;
    return f;
}

/* Room for the planes of logistic normals. */
static inline mpm_status mpm__plane_room(mpm_world *w)
{
    mpm_status s;
    if (w->planes) return MPM_OK;
    if (!w->owns_work) return mpm_fail(&w->fault, MPM_ERR_FULL, "planes of logistic normals", 0, -1);
    w->planes = 1;
    s = mpm_reserve(w, NULL, 0);
    if (s != MPM_OK) w->planes = 0;
    return s;
}

/* Takes the rule of a and b out, if they have one. */
static inline void mpm__rule_drop(mpm_world *w, int32_t a, int32_t b)
{
    int32_t i, kept = 0;
    for (i = 0; i < w->rules; i++) {
        const mpm_rule r = w->rule[i];
        if (!(r.a == a && r.b == b) && !(r.a == b && r.b == a)) w->rule[kept++] = r;
    }
    w->rules = kept;
}

MPM_API mpm_status mpm_contact_set(mpm_world *w, int32_t a, int32_t b, const mpm_contact *rule)
{
    const mpm_contact own = *rule; /* it may be one of the world's, which move */
    mpm_status s = mpm_contact_check(&own, &w->fault);
    if (s == MPM_OK) s = mpm_want(a >= -1, &w->fault, "body", (mpm_real)a, -1);
    if (s == MPM_OK) s = mpm_want(b >= -1, &w->fault, "body", (mpm_real)b, -1);
    if (s == MPM_OK && own.normal == MPM_NORMAL_LOGISTIC) s = mpm__plane_room(w);
    if (s != MPM_OK) return s;
    mpm__rule_drop(w, a, b);
    if ((s = mpm__room(w, 0, 0, 1, 0)) != MPM_OK) return s; /* none was dropped, or there is room */
    w->rule[w->rules].a = a;
    w->rule[w->rules].b = b;
    w->rule[w->rules++].contact = own;
    return MPM_OK;
}

/* ---- shapes -------------------------------------------------------------------------------- */

static inline mpm_shape mpm__shape(mpm_shape_kind kind, const mpm_real *low, const mpm_real *high)
{
    mpm_shape s;
    int d;
    memset(&s, 0, sizeof s);
    s.kind = kind;
    for (d = 0; d < 3; d++) {
        s.center[d] = (low[d] + high[d]) / 2;
        s.half[d] = (high[d] - low[d]) / 2;
    }
    return s;
}

MPM_API mpm_shape mpm_ellipsoid(mpm_real x, mpm_real y, mpm_real z, mpm_real a, mpm_real b, mpm_real c)
{
    mpm_shape s;
    memset(&s, 0, sizeof s);
    s.kind = MPM_SHAPE_ELLIPSOID;
    s.center[0] = x;
    s.center[1] = y;
    s.center[2] = z;
    s.half[0] = a;
    s.half[1] = b;
    s.half[2] = c;
    return s;
}

MPM_API mpm_shape mpm_sphere(mpm_real x, mpm_real y, mpm_real z, mpm_real radius)
{
    return mpm_ellipsoid(x, y, z, radius, radius, radius);
}

MPM_API mpm_shape mpm_cylinder(mpm_real x, mpm_real y, mpm_real z_bottom, mpm_real radius, mpm_real height)
{
    mpm_real low[3], high[3];
    low[0] = x - radius;
    low[1] = y - radius;
    low[2] = z_bottom;
    high[0] = x + radius;
    high[1] = y + radius;
    high[2] = z_bottom + height;
    return mpm__shape(MPM_SHAPE_CYLINDER, low, high);
}

MPM_API mpm_shape mpm_box(mpm_real x0, mpm_real y0, mpm_real z0, mpm_real x1, mpm_real y1, mpm_real z1)
{
    mpm_real low[3], high[3];
    low[0] = x0;
    low[1] = y0;
    low[2] = z0;
    high[0] = x1;
    high[1] = y1;
    high[2] = z1;
    return mpm__shape(MPM_SHAPE_BOX, low, high);
}

MPM_API mpm_shape mpm_shape_user(mpm_inside_fn inside, void *context, const mpm_real low[3], const mpm_real high[3])
{
    mpm_shape s = mpm__shape(MPM_SHAPE_USER, low, high);
    s.inside = inside;
    s.context = context;
    return s;
}

/* Whether a shape of the user's contains x: in its box, and by its function. */
static inline int mpm__contains_own(const mpm_shape *s, const mpm_real *x, int flat)
{
    int d;
    for (d = 0; d < 3; d++) {
        const mpm_real q = (d == 1 && flat) ? 0 : (x[d] - s->center[d]) / s->half[d];
        if (!(q >= -1 && q <= 1)) return 0;
    }
    return s->inside(s->context, x);
}

/* ... and all that lies `shrink` away from it, along axes and diagonals. */
static inline int mpm__contains_user(const mpm_shape *s, const mpm_real *x, int flat, mpm_real shrink)
{
    int i, d;
    for (i = 0; i < 27; i++) {
        const int way[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
        const int square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
        const mpm_real part = square > 1 ? shrink / mpm_sqrt((mpm_real)square) : shrink;
        mpm_real at[3];
        if ((square && !(shrink > 0)) || (flat && way[1])) continue;
        for (d = 0; d < 3; d++) at[d] = d == 1 && flat ? 0 : x[d] + (mpm_real)way[d] * part;
        if (!mpm__contains_own(s, at, flat)) return 0;
    }
    return 1;
}

/* The section of s in the plane of a two-dimensional problem: y no longer matters. */
static inline int mpm__contains(const mpm_shape *s, const mpm_real *x, int flat, mpm_real shrink)
{
    mpm_real q[3];
    int d;
    if (s->kind == MPM_SHAPE_USER) return mpm__contains_user(s, x, flat, shrink);
    for (d = 0; d < 3; d++) {
        const mpm_real half = s->half[d] - shrink;
        q[d] = 0;
        if (d == 1 && flat) continue;
        if (half <= 0) return 0;
        q[d] = (x[d] - s->center[d]) / half;
    }
    switch (s->kind) {
    case MPM_SHAPE_ELLIPSOID: return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] <= 1;
    case MPM_SHAPE_CYLINDER: return q[0] * q[0] + q[1] * q[1] <= 1 && q[2] >= -1 && q[2] <= 1;
    case MPM_SHAPE_BOX: return q[0] >= -1 && q[0] <= 1 && q[1] >= -1 && q[1] <= 1 && q[2] >= -1 && q[2] <= 1;
    default: return 0;
    }
}

MPM_API int mpm_shape_contains(const mpm_shape *s, mpm_real x, mpm_real y, mpm_real z)
{
    mpm_real q[3];
    q[0] = x;
    q[1] = y;
    q[2] = z;
    return mpm__contains(s, q, 0, 0);
}

/* A walk over the lattice points of a shape, in order of z, y, x. The lattice is symmetric about
   the centre; a cylinder's or box's last layer lies half a spacing below its upper face. */
typedef struct mpm__lattice {
    int32_t n[3], i[3];
    mpm_real start[3], spacing;
} mpm__lattice;

static inline mpm__lattice mpm__lattice_begin(const mpm_desc *d, const mpm_shape *s, mpm_real spacing)
{
    mpm__lattice l;
    int a;
    l.spacing = spacing;
    for (a = 0; a < 3; a++) {
        mpm_real across = s->half[a] / spacing;
        if (s->kind == MPM_SHAPE_BOX || s->kind == MPM_SHAPE_USER || (s->kind == MPM_SHAPE_CYLINDER && a == 2))
            l.n[a] = (int32_t)(2 * across + MPM_R(0.5));
        else
            l.n[a] = 2 * (int32_t)(across + 1);
        if (l.n[a] < 1) l.n[a] = 1;
        l.start[a] = s->center[a] - MPM_R(0.5) * (mpm_real)(l.n[a] - 1) * spacing;
        l.i[a] = 0;
    }
    if (s->kind != MPM_SHAPE_ELLIPSOID)
        l.start[2] = s->center[2] + s->half[2] - ((mpm_real)l.n[2] - MPM_R(0.5)) * spacing;
    if (mpm__flat(d)) {
        l.n[1] = 1;
        l.start[1] = 0;
    }
    l.i[0] = -1;
    return l;
}

/* Puts x on a symmetry plane of axis a if it lies there but for rounding; 1 if it lies behind one. */
static inline int mpm__cut_off(const mpm_desc *d, int a, mpm_real spacing, mpm_real *x)
{
    const mpm_real plane[2] = {d->origin[a], mpm__grid_high(d, a)};
    int s;
    for (s = 0; s < 2; s++) {
        const mpm_real depth = s ? plane[1] - *x : *x - plane[0];
        if (d->side[2 * a + s] != MPM_SIDE_SYMMETRY) continue;
        if (depth < -MPM__SNAP * spacing) return 1;
        if (depth < MPM__SNAP * spacing) *x = plane[s];
    }
    return 0;
}

/* The next lattice point that belongs to the shape and is not cut off by a symmetry plane. */
static inline int mpm__lattice_next(mpm__lattice *l, const mpm_desc *d, const mpm_shape *s, mpm_real *x)
{
    for (;;) {
        int a, b, cut = 0;
        for (a = 0; ++l->i[a] == l->n[a]; a++) {
            if (a == 2) return 0;
            l->i[a] = 0;
        }
        for (a = 2; a >= 0 && !cut; a--) {
            x[a] = l->start[a] + (mpm_real)l->i[a] * l->spacing;
            if (a == 1 && mpm__flat(d)) continue;
            cut = mpm__cut_off(d, a, l->spacing, &x[a]);
            for (b = 0; cut && b < a; b++) l->i[b] = l->n[b] - 1; /* and with it the rest of its row or layer */
        }
        if (cut) continue;
        /* the lattice itself bounds boxes and the height of cylinders */
        if (s->kind == MPM_SHAPE_BOX) return 1;
        if (s->kind == MPM_SHAPE_CYLINDER) {
            mpm_real q[3];
            q[0] = x[0];
            q[1] = x[1];
            q[2] = s->center[2];
            if (mpm__contains(s, q, mpm__flat(d), 0)) return 1;
        } else if (mpm__contains(s, x, mpm__flat(d), 0)) {
            return 1;
        }
    }
}

/* Whether the lattice of a shape can be counted. */
static inline int mpm__countable(const mpm_desc *d, const mpm_shape *s, mpm_real spacing)
{
    mpm__lattice l;
    int a;
    if (!(spacing > 0)) return 0;
    for (a = 0; a < 3; a++)
        if (!(s->half[a] > 0 && s->half[a] / spacing < 1e6)) return 0;
    l = mpm__lattice_begin(d, s, spacing);
    return (double)l.n[0] * l.n[1] * l.n[2] <= 2147483647.0;
}

MPM_API int32_t mpm_shape_count(const mpm_desc *d, const mpm_shape *s, mpm_real spacing)
{
    mpm__lattice l;
    mpm_real x[3];
    int32_t n = 0;
    if (!mpm__countable(d, s, spacing)) return 0;
    l = mpm__lattice_begin(d, s, spacing);
    while (mpm__lattice_next(&l, d, s, x)) n++;
    return n;
}

/* ---- bodies -------------------------------------------------------------------------------- */

/* What a shape must be to be filled with points. */
static inline mpm_status mpm__shape_check(const mpm_body_desc *b, mpm_fault *f)
{
    const mpm_shape *s = &b->shape;
    mpm_status st = mpm_want(s->kind > MPM_SHAPE_NONE && s->kind <= MPM_SHAPE_USER, f, "shape", (mpm_real)s->kind, -1);
    int a;
    for (a = 0; a < 3 && st == MPM_OK; a++) {
        if ((st = mpm_want(1, f, "shape.center", s->center[a], a)) != MPM_OK) break;
        st = mpm_want(s->half[a] > 0, f, "shape.half", s->half[a], a);
    }
    if (st == MPM_OK) st = mpm_want(s->kind != MPM_SHAPE_USER || s->inside, f, "shape.inside", 0, -1);
    return st;
}

static inline mpm_status mpm__body_check(const mpm_world *w, const mpm_body_desc *b, mpm_fault *f)
{
    mpm_status st = mpm_want(b->mark == MPM_MARK, f, "body (not from mpm_body_desc_default)", (mpm_real)b->mark, -1);
    int a;
    for (a = 0; a < 3 && st == MPM_OK; a++) st = mpm_want(1, f, "velocity", b->velocity[a], a);
    if (st != MPM_OK) return st;
    if ((st = mpm_want(b->spacing > 0, f, "spacing", b->spacing, -1)) != MPM_OK) return st;
    if (b->spacing > w->desc.cell * (1 + 16 * MPM_EPSILON))
        return mpm_fail(f, MPM_ERR_ARGUMENT, "spacing (larger than the cell)", b->spacing, -1);
    if ((st = mpm_want(b->density > 0, f, "density", b->density, -1)) != MPM_OK) return st;
    if ((st = mpm_want(b->temperature >= 0, f, "temperature", b->temperature, -1)) != MPM_OK) return st;
    if ((st = mpm_want(b->wave_p >= 0, f, "wave_p", b->wave_p, -1)) != MPM_OK) return st;
    if ((st = mpm_want(b->wave_s >= 0, f, "wave_s", b->wave_s, -1)) != MPM_OK) return st;
    if ((st = mpm_want(b->absorb_normal >= 0, f, "absorb_normal", b->absorb_normal, -1)) != MPM_OK) return st;
    if ((st = mpm_want(b->absorb_shear >= 0, f, "absorb_shear", b->absorb_shear, -1)) != MPM_OK) return st;
    if ((st = mpm_want(b->absorb_spring >= 0, f, "absorb_spring", b->absorb_spring, -1)) != MPM_OK) return st;
    if ((st = mpm_want(b->id >= -1, f, "id", (mpm_real)b->id, -1)) != MPM_OK) return st;
    return mpm_want(b->shell >= 0, f, "shell", b->shell, -1);
}

/* Dampers stand on the faces of cylinders and boxes. */
static inline mpm_status mpm__absorb_check(const mpm_body_desc *b, int faces, mpm_fault *f)
{
    const int known = faces ? MPM_FACE_BOTTOM | MPM_FACE_RIM : 0;
    return mpm_want((b->absorb & ~known) == 0, f, "absorb (a face the body has not)", (mpm_real)b->absorb, -1);
}

/* Where on its body a new point lies. Damped faces are cuts through a larger body, not surfaces. */
static inline uint8_t mpm__flags(const mpm_body_desc *b, const mpm_real *x, int flat)
{
    const mpm_shape *s = &b->shape;
    mpm_shape core = *s;
    int f = 0, d;
    if (s->kind == MPM_SHAPE_CYLINDER || s->kind == MPM_SHAPE_BOX) {
        mpm_shape wide = *s; /* the circumference alone: without upper and lower face */
        if (x[2] > s->center[2] + s->half[2] - b->spacing) f |= MPM_FACE_TOP;
        if (x[2] < s->center[2] - s->half[2] + b->spacing) f |= MPM_FACE_BOTTOM;
        wide.half[2] *= 4;
        if (!mpm__contains(&wide, x, flat, b->spacing)) f |= MPM_FACE_RIM;
    }
    if (b->absorb & MPM_FACE_BOTTOM) core.center[2] -= 2 * s->half[2], core.half[2] += 2 * s->half[2];
    if (b->absorb & MPM_FACE_RIM)
        for (d = 0; d < 2; d++) core.half[d] += 2 * b->shell * b->spacing + s->half[d];
    if (!mpm__contains(&core, x, flat, b->shell * b->spacing * (1 - 64 * MPM_EPSILON))) f |= MPM_POINT_SURFACE;
    return (uint8_t)f;
}

/* How wide the cube of a shape's lattice point is along axis a, in spacings: 1, but for the layer next to a symmetry
   plane. At e spacings from the plane it reaches from there to half a spacing beyond the point, e + 1/2: a half on the
   plane itself; and with what the next layer, if the shape has one behind the plane, would have left on this side. */
static inline mpm_real mpm__width(const mpm_desc *d, const mpm_shape *s, mpm_real spacing, const mpm_real *x, int a)
{
    const mpm_real depth[2] = {(x[a] - d->origin[a]) / spacing, (mpm__grid_high(d, a) - x[a]) / spacing};
    mpm_real width = 1;
    int i;
    for (i = 0; i < 2; i++) {
        const mpm_real beyond = depth[i] - MPM_R(0.5);
        mpm_real next[3] = {x[0], x[1], x[2]};
        next[a] += i ? spacing : -spacing;
        if (d->side[2 * a + i] != MPM_SIDE_SYMMETRY || depth[i] > 1 - MPM__SNAP) continue;
        if (beyond < -MPM__SNAP || (beyond > MPM__SNAP && mpm__contains(s, next, mpm__flat(d), 0))) width += beyond;
    }
    return width;
}

/* The share of a full point that symmetry planes leave at x; along the radius of rings it is in the ring's area. */
static inline mpm_real mpm__share(const mpm_desc *d, const mpm_shape *s, mpm_real spacing, const mpm_real *x)
{
    mpm_real share = 1;
    int a;
    for (a = d->geometry == MPM_AXISYMMETRIC ? 2 : 0; a < 3; a++)
        if (!(a == 1 && mpm__flat(d))) share *= mpm__width(d, s, spacing, x, a);
    return share;
}

/* Half the cross-section of a ring through x over pi and the spacing: between x - h and x + h it is 2 x h; next to a
   symmetry plane, from there. */
static inline mpm_real mpm__ring(const mpm_desc *d, const mpm_shape *s, mpm_real spacing, const mpm_real *x)
{
    const mpm_real width = mpm__width(d, s, spacing, x, 0), outer = x[0] + spacing / 2;
    const mpm_real inner = outer - width * spacing;
    return width < 1 || width > 1 ? (outer * outer - inner * inner) / (2 * spacing) : x[0];
}

/* Mass that a lattice point stands for: a cube, a unit-depth square, or a ring. */
static inline mpm_real mpm__point_mass(const mpm_desc *d, const mpm_body_desc *b, const mpm_real *x)
{
    mpm_real square = b->density * b->spacing * b->spacing, share = mpm__share(d, &b->shape, b->spacing, x);
    if (d->geometry == MPM_3D) return square * b->spacing * share;
    if (d->geometry == MPM_PLANE_STRAIN) return square * share;
    return 2 * MPM_PI * mpm__ring(d, &b->shape, b->spacing, x) * square * share;
}

/* The share of a shape that the symmetry planes leave in the grid. */
static inline mpm_real mpm__kept(const mpm_desc *d, const mpm_body_desc *b)
{
    mpm__lattice l = mpm__lattice_begin(d, &b->shape, b->spacing);
    mpm_desc open = *d;
    double kept = 0;
    mpm_real x[3];
    int a;
    for (a = 0; a < 6; a++) open.side[a] = MPM_SIDE_OPEN;
    while (mpm__lattice_next(&l, d, &b->shape, x)) kept += (double)mpm__share(d, &b->shape, b->spacing, x);
    return (mpm_real)kept / (mpm_real)mpm_shape_count(&open, &b->shape, b->spacing);
}

/* The true areas of the damped faces, bottom and circumference (A 3.45, 3.46). */
static inline void mpm__areas(const mpm_desc *d, mpm_body *b)
{
    const mpm_shape *s = &b->desc.shape;
    mpm_real kept = mpm__kept(d, &b->desc), a = 2 * s->half[0], h = 2 * s->half[2];
    if (d->geometry == MPM_PLANE_STRAIN) {
        b->area[0] = a * kept;
        b->area[1] = 2 * h * kept;
    } else if (s->kind == MPM_SHAPE_BOX && d->geometry == MPM_3D) {
        b->area[0] = a * 2 * s->half[1] * kept;
        b->area[1] = 2 * (a + 2 * s->half[1]) * h * kept;
    } else {
        if (d->geometry == MPM_AXISYMMETRIC) kept = 1; /* rings are whole */
        b->area[0] = MPM_PI * s->half[0] * s->half[0] * kept;
        b->area[1] = 2 * MPM_PI * s->half[0] * h * kept;
    }
}

/* The body, other than `own`, whose shape contains x, or -1. After the first step bodies are elsewhere. */
static inline int32_t mpm__body_at(const mpm_world *w, const mpm_real *x, int32_t own)
{
    int32_t b;
    for (b = 0; b < w->bodies && w->steps == 0; b++)
        if (b != own && mpm__contains(&w->body[b].desc.shape, x, mpm__flat(&w->desc), 0)) return b;
    return -1;
}

/* The first axis along which x lies outside the grid, or -1. */
static inline int mpm__axis_outside(const mpm_desc *d, const mpm_real *x)
{
    int a;
    if (d->geometry == MPM_AXISYMMETRIC && !(x[0] > 0)) return 0; /* a ring without mass or radius */
    for (a = 0; a < 3; a++) {
        const mpm_real t = (x[a] - d->origin[a]) * (1 / d->cell);
        const mpm_real cells = (mpm_real)d->cells[a], below = d->side[2 * a] == MPM_SIDE_OPEN ? 0 : MPM__SNAP;
        if (a == 1 && mpm__flat(d)) continue;
        if (!(t >= -below)) return a;
        if (d->side[2 * a + 1] == MPM_SIDE_OPEN ? !(t < cells) : !(t <= cells + MPM__SNAP)) return a;
    }
    return -1;
}

/* Writes a point at index i of the arrays, with its body's values for what is not told. */
static inline void mpm__put_point(mpm_world *w, const mpm_body_desc *d, int32_t i, const mpm_real *x, mpm_real mass,
                                  uint8_t flags)
{
    mpm_points *p = &w->points;
    int a;
    for (a = 0; a < w->fields; a++) w->field[(size_t)a * w->stride + (size_t)i] = 0;
    for (a = 0; a < 3; a++) {
        p->x[a][i] = x[a];
        p->v[a][i] = d->velocity[a];
    }
    p->mass[i] = mass;
    p->density[i] = d->density;
    p->temperature[i] = d->temperature;
    p->flags[i] = flags;
}

/* A point outside the grid along axis a. */
static inline mpm_status mpm__outside(int a, const mpm_real *x, int64_t index, mpm_fault *f)
{
    static const char *const name[3] = {"x of a point", "y of a point", "z of a point"};
    return mpm_fail(f, MPM_ERR_OUTSIDE, name[a], x[a], index);
}

/* Whether a point of body `own` may be placed at x: inside the grid, in no other body's shape. */
static inline mpm_status mpm__place_check(const mpm_world *w, int32_t own, const mpm_real *x, int64_t index,
                                          mpm_fault *f)
{
    const int a = mpm__axis_outside(&w->desc, x);
    int32_t other;
    if (a >= 0) return mpm__outside(a, x, index, f);
    if ((other = mpm__body_at(w, x, own)) >= 0)
        return mpm_fail(f, MPM_ERR_OVERLAP, "overlap with body", (mpm_real)other, other);
    return MPM_OK;
}

/* A lattice point on the axis is a disc, half a spacing wide: it goes to the middle of its mass, for a ring needs a
   radius. */
static inline void mpm__off_axis(const mpm_desc *d, mpm_real spacing, mpm_real *x)
{
    if (d->geometry == MPM_AXISYMMETRIC && d->side[0] == MPM_SIDE_SYMMETRY && !(x[0] < 0) && !(x[0] > 0))
        x[0] = spacing / 3;
}

/* Writes the points of b behind those in the world, without counting them in. */
static inline mpm_status mpm__fill(mpm_world *w, mpm_body *b, mpm_fault *f)
{
    const mpm_body_desc *d = &b->desc;
    mpm__lattice l = mpm__lattice_begin(&w->desc, &d->shape, d->spacing);
    int32_t i = w->points.count;
    mpm_status s;
    mpm_real x[3];
    while (mpm__lattice_next(&l, &w->desc, &d->shape, x)) {
        const mpm_real mass = mpm__point_mass(&w->desc, d, x);
        mpm__off_axis(&w->desc, d->spacing, x);
        if ((s = mpm__place_check(w, w->bodies, x, w->bodies, f)) != MPM_OK) return s;
        mpm__put_point(w, d, i++, x, mass, mpm__flags(d, x, mpm__flat(&w->desc)));
    }
    b->count = i - w->points.count;
    return MPM_OK;
}

/* The mean mass of a body's points, and the mass at its damped faces. */
static inline void mpm__masses(const mpm_world *w, mpm_body *b)
{
    const mpm_points *p = &w->points;
    double mass = 0, bottom = 0, rim = 0;
    int32_t i;
    for (i = b->first; i < b->first + b->count; i++) {
        const double m = (double)p->mass[i];
        if (p->flags[i] & MPM_FACE_BOTTOM) bottom += m;
        if (p->flags[i] & MPM_FACE_RIM) rim += m;
        mass += m;
    }
    b->mass[0] = (mpm_real)bottom;
    b->mass[1] = (mpm_real)rim;
    if (b->count > 0) b->point_mass = (mpm_real)(mass / b->count);
}

/* Sums of the points just written, and their numbers. */
static inline void mpm__body_sums(mpm_world *w, mpm_body *b)
{
    int32_t i;
    b->first = w->points.count;
    b->active = b->count;
    if (b->desc.id >= 0) w->next_id = b->desc.id;
    for (i = b->first; i < b->first + b->count; i++) w->points.id[i] = w->next_id++;
    mpm__masses(w, b);
}

/* A body added earlier may stick into the new one without the reverse. */
static inline int32_t mpm__point_inside(const mpm_world *w, const mpm_shape *s)
{
    const mpm_points *p = &w->points;
    int32_t b, i;
    for (b = 0; b < w->bodies; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++) {
            mpm_real x[3];
            x[0] = p->x[0][i];
            x[1] = p->x[1][i];
            x[2] = p->x[2][i];
            if (mpm__contains(s, x, mpm__flat(&w->desc), 0)) return b;
        }
    return -1;
}

/* Counts a written body in and makes room for its nodes, with half as much again to spare. */
static inline mpm_status mpm__body_join(mpm_world *w, mpm_body *b)
{
    const int32_t next_id = w->next_id, id = b->desc.id >= 0 ? b->desc.id : next_id;
    mpm_status s = mpm_want(id <= 2147483647 - b->count, &w->fault, "id", (mpm_real)id, -1);
    if (s != MPM_OK) return s;
    mpm__body_sums(w, b);
    w->body[w->bodies++] = *b;
    w->points.count += b->count;
    w->sorted_runs = 0;
    s = mpm__locate(w);
    if (s >= 0 && w->owns_work && w->nodes + w->nodes / 2 > w->node_capacity) {
        s = mpm_reserve(w, NULL, 0);
        if (s == MPM_OK) s = mpm__locate(w);
    }
    if (s >= 0) return MPM_OK; /* points of other bodies may have left: see w->retired */
    w->bodies--;
    w->points.count -= b->count;
    w->next_id = next_id;
    return s;
}

/* How many points a body will have; it ends at the first that lies outside the grid, so that a shape far larger than
   the grid is not walked through. */
static inline mpm_status mpm__count_inside(const mpm_desc *d, const mpm_body_desc *b, int32_t *count, mpm_fault *f)
{
    mpm__lattice l;
    mpm_real x[3];
    *count = 0;
    if (!mpm__countable(d, &b->shape, b->spacing)) return MPM_OK;
    l = mpm__lattice_begin(d, &b->shape, b->spacing);
    while (mpm__lattice_next(&l, d, &b->shape, x)) {
        int a;
        mpm__off_axis(d, b->spacing, x);
        if ((a = mpm__axis_outside(d, x)) >= 0) return mpm__outside(a, x, *count, f);
        ++*count;
    }
    return MPM_OK;
}

/* User fields for the first places of a body with springs. */
static inline mpm_status mpm__places_take(mpm_world *w, const mpm_body_desc *b, int *place)
{
    static const char *const name[3] = {"first x", "first y", "first z"};
    int d;
    for (d = 0; d < 3; d++) {
        const int needed = b->absorb && b->absorb_spring > 0 && (d != 1 || !mpm__flat(&w->desc));
        place[d] = needed ? mpm_field_take(w, name[d]) : -1;
        if (needed && place[d] < 0) return w->fault.status;
    }
    return MPM_OK;
}

/* Keeps the places of points [first, first + count) of a body with springs. */
static inline void mpm__places(mpm_world *w, const mpm_body *b, int32_t first, int32_t count)
{
    int32_t i;
    int d;
    for (d = 0; d < 3; d++)
        for (i = first; i < first + count && b->place[d] >= 0; i++) w->points.user[b->place[d]][i] = w->points.x[d][i];
}

MPM_API mpm_status mpm_body_add(mpm_world *w, const mpm_body_desc *desc)
{
    const mpm_body_desc own = *desc; /* it may be one of the world's, which move */
    const int faces = own.shape.kind == MPM_SHAPE_CYLINDER || own.shape.kind == MPM_SHAPE_BOX;
    mpm_fault *f = &w->fault;
    mpm_body b;
    mpm_status s;
    int32_t other, count;
    memset(&b, 0, sizeof b);
    if ((s = mpm__body_check(w, &own, f)) != MPM_OK || (s = mpm__shape_check(&own, f)) != MPM_OK ||
        (s = mpm__absorb_check(&own, faces, f)) != MPM_OK)
        return s;
    if ((other = mpm__point_inside(w, &own.shape)) >= 0)
        return mpm_fail(f, MPM_ERR_OVERLAP, "overlap with body", (mpm_real)other, other);
    if ((s = mpm__count_inside(&w->desc, &own, &count, f)) != MPM_OK) return s;
    if (count == 0) return mpm_fail(f, MPM_ERR_ARGUMENT, "shape (holds no point at spacing)", own.spacing, -1);
    if ((s = mpm__room(w, count, 1, 0, 0)) != MPM_OK || (s = mpm__places_take(w, &own, b.place)) != MPM_OK) return s;
    b.desc = own;
    if (own.absorb) mpm__areas(&w->desc, &b);
    if ((s = mpm__fill(w, &b, f)) != MPM_OK) return s;
    mpm__places(w, &b, w->points.count, b.count);
    return mpm__body_join(w, &b);
}

/* ---- bodies from points ---------------------------------------------------------------------- */

/* Entry i of an array of a cloud, or what stands for it. */
static inline mpm_real mpm__given(const mpm_real *array, int32_t i, mpm_real otherwise)
{
    return array ? array[i] : otherwise;
}

static inline mpm_real mpm__cloud_mass(const mpm_world *w, const mpm_body_desc *d, const mpm_cloud *c, int32_t i,
                                       const mpm_real *x)
{
    const mpm_real square = d->density * d->spacing * d->spacing;
    if (c->mass) return c->mass[i];
    if (c->volume) return c->volume[i] * d->density;
    if (w->desc.geometry == MPM_PLANE_STRAIN) return square;
    return square * (w->desc.geometry == MPM_3D ? d->spacing : 2 * MPM_PI * x[0]);
}

/* Where point i of a cloud lies. */
static inline void mpm__cloud_place(const mpm_world *w, const mpm_cloud *c, int32_t i, mpm_real *x)
{
    int a;
    for (a = 0; a < 3; a++) x[a] = a == 1 && mpm__flat(&w->desc) ? 0 : mpm__given(c->x[a], i, 0);
}

/* Whether the points of a cloud may join body `own`, described by d. */
static inline mpm_status mpm__cloud_check(const mpm_world *w, int32_t own, const mpm_body_desc *d, const mpm_cloud *c,
                                          mpm_fault *f)
{
    mpm_real x[3], mass;
    mpm_status s = mpm_want(c->count >= 1, f, "points", (mpm_real)c->count, -1);
    int32_t i;
    int a;
    for (a = 0; a < 3 && s == MPM_OK; a++)
        s = mpm_want(c->x[a] || (a == 1 && mpm__flat(&w->desc)), f, "x (missing)", 0, a);
    for (i = 0; i < c->count && s == MPM_OK; i++) {
        mpm__cloud_place(w, c, i, x);
        for (a = 0; a < 3 && s == MPM_OK; a++) {
            s = mpm_want(1, f, "x of a point", x[a], i);
            if (s == MPM_OK) s = mpm_want(1, f, "v of a point", mpm__given(c->v[a], i, 0), i);
        }
        if (s == MPM_OK) s = mpm__place_check(w, own, x, i, f);
        if (s != MPM_OK) return s;
        if (c->volume) s = mpm_want(c->volume[i] > 0, f, "volume of a point", c->volume[i], i);
        mass = mpm__cloud_mass(w, d, c, i, x);
        if (s == MPM_OK) s = mpm_want(mass > 0, f, "mass of a point", mass, i);
    }
    return s;
}

/* Point i of a cloud, at index `to` of the arrays. */
static inline void mpm__put_cloud(mpm_world *w, const mpm_body_desc *d, const mpm_cloud *c, int32_t i, int32_t to)
{
    mpm_real x[3];
    int a;
    mpm__cloud_place(w, c, i, x);
    mpm__put_point(w, d, to, x, mpm__cloud_mass(w, d, c, i, x), (uint8_t)(c->flags ? c->flags[i] : 0));
    for (a = 0; a < 3; a++) w->points.v[a][to] = mpm__given(c->v[a], i, d->velocity[a]);
    if (c->mass && c->volume) w->points.density[to] = c->mass[i] / c->volume[i];
}

/* The box around a cloud, half a spacing wide of it, as a shape that contains nothing. */
static inline mpm_shape mpm__cloud_extent(const mpm_world *w, const mpm_cloud *c, mpm_real spacing)
{
    mpm_real low[3] = {0, 0, 0}, high[3] = {0, 0, 0}, x[3];
    int32_t i;
    int a;
    for (i = 0; i < c->count; i++) {
        mpm__cloud_place(w, c, i, x);
        for (a = 0; a < 3; a++) {
            if (i == 0 || x[a] - spacing / 2 < low[a]) low[a] = x[a] - spacing / 2;
            if (i == 0 || x[a] + spacing / 2 > high[a]) high[a] = x[a] + spacing / 2;
        }
    }
    return mpm__shape(MPM_SHAPE_NONE, low, high);
}

MPM_API mpm_status mpm_body_add_points(mpm_world *w, const mpm_body_desc *desc, const mpm_cloud *c)
{
    const mpm_body_desc own = *desc; /* it may be one of the world's, which move */
    mpm_fault *f = &w->fault;
    mpm_body b;
    mpm_status s;
    memset(&b, 0, sizeof b);
    if ((s = mpm__body_check(w, &own, f)) != MPM_OK || (s = mpm__absorb_check(&own, 0, f)) != MPM_OK ||
        (s = mpm__cloud_check(w, w->bodies, &own, c, f)) != MPM_OK || (s = mpm__room(w, c->count, 1, 0, 0)) != MPM_OK)
        return s;
    mpm__places_take(w, &own, b.place); /* it has no faces, so none */
    b.desc = own;
    b.desc.shape = mpm__cloud_extent(w, c, own.spacing);
    for (b.count = 0; b.count < c->count; b.count++)
        mpm__put_cloud(w, &own, c, b.count, w->points.count + b.count);
    return mpm__body_join(w, &b);
}

/* Copies a point over another. */
static inline void mpm__copy_point(mpm_world *w, int32_t from, int32_t to)
{
    int f;
    for (f = 0; f < w->fields; f++) {
        mpm_real *field = w->field + (size_t)f * w->stride;
        field[to] = field[from];
    }
    w->points.id[to] = w->points.id[from];
    w->points.flags[to] = w->points.flags[from];
}

/* Opens a place behind the active points of a body: the bodies after it move up by one, first to last. */
static inline int32_t mpm__open_place(mpm_world *w, int32_t body)
{
    int32_t c, hole = w->points.count;
    for (c = w->bodies - 1; c >= body; c--) {
        mpm_body *b = &w->body[c];
        const int32_t retired = b->first + b->active;
        if (b->active < b->count) {
            mpm__copy_point(w, retired, hole);
            hole = retired;
        }
        if (c == body) break;
        if (b->active > 0) mpm__copy_point(w, b->first, hole);
        hole = b->first++;
    }
    return hole;
}

/* Closes the place of point i of a body: its points and the bodies after it move down. */
static inline void mpm__close_place(mpm_world *w, int32_t body, int32_t i)
{
    int32_t c, hole = i;
    for (c = body; c < w->bodies; c++) {
        mpm_body *b = &w->body[c];
        const int32_t end = b->first + b->active, last = b->first + b->count;
        if (c > body) b->first--;
        if (hole < end) {
            if (end - 1 > hole) mpm__copy_point(w, end - 1, hole);
            hole = end - 1;
            if (c == body) b->active--;
        }
        if (last - 1 > hole) mpm__copy_point(w, last - 1, hole);
        hole = last - 1;
        if (c == body) b->count--;
    }
    w->points.count--;
}

MPM_API mpm_status mpm_points_add(mpm_world *w, int32_t body, const mpm_cloud *c)
{
    mpm_fault *f = &w->fault;
    int32_t i;
    mpm_status s = mpm_want(body >= 0 && body < w->bodies, f, "body", (mpm_real)body, -1);
    if (s != MPM_OK || (s = mpm__cloud_check(w, body, &w->body[body].desc, c, f)) != MPM_OK ||
        (s = mpm_want(w->next_id <= 2147483647 - c->count, f, "id", (mpm_real)w->next_id, -1)) != MPM_OK ||
        (s = mpm__room(w, c->count, 0, 0, 0)) != MPM_OK)
        return s;
    mpm__grid_reset(w);
    for (i = 0; i < c->count; i++) {
        const int32_t place = mpm__open_place(w, body);
        mpm__put_cloud(w, &w->body[body].desc, c, i, place);
        mpm__places(w, &w->body[body], place, 1);
        w->points.id[place] = w->next_id++;
        w->body[body].count++;
        w->body[body].active++;
        w->points.count++;
    }
    mpm__masses(w, &w->body[body]);
    w->sorted_runs = 0;
    return MPM_OK;
}

MPM_API mpm_status mpm_point_take(mpm_world *w, int32_t i)
{
    int32_t b = 0;
    mpm_status s = mpm_want(i >= 0 && i < w->points.count, &w->fault, "point", (mpm_real)i, i);
    if (s != MPM_OK) return s;
    mpm__grid_reset(w);
    while (i >= w->body[b].first + w->body[b].count) b++;
    mpm__close_place(w, b, i);
    mpm__masses(w, &w->body[b]);
    return MPM_OK;
}

/* ---- describing a problem ------------------------------------------------------------------ */

MPM_API mpm_desc mpm_desc_default(void)
{
    mpm_desc d;
    memset(&d, 0, sizeof d);
    d.cells[0] = d.cells[1] = d.cells[2] = 1;
    d.mass_cutoff = MPM_EPSILON * MPM_EPSILON;
    d.contact.cutoff = MPM_R(1e-3);
    d.mark = MPM_MARK;
    return d;
}

MPM_API mpm_body_desc mpm_body_desc_default(void)
{
    mpm_body_desc b;
    memset(&b, 0, sizeof b);
    b.temperature = 298;
    b.absorb_normal = b.absorb_shear = 1;
    b.shell = 1;
    b.id = -1;
    b.mark = MPM_MARK;
    return b;
}

MPM_API mpm_status mpm_contact_check(const mpm_contact *c, mpm_fault *f)
{
    mpm_status s = mpm_want((int)c->law >= 0 && c->law < MPM_CONTACT_LAWS, f, "contact.law", (mpm_real)c->law, -1);
    if (s == MPM_OK)
        s = mpm_want((int)c->normal >= 0 && c->normal < MPM_NORMAL_RULES, f, "contact.normal", (mpm_real)c->normal, -1);
    if (s == MPM_OK) s = mpm_want(c->touch == 0 || c->touch == 1, f, "contact.touch", (mpm_real)c->touch, -1);
    if (s == MPM_OK) s = mpm_want(c->friction >= 0, f, "contact.friction", c->friction, -1);
    if (s == MPM_OK) s = mpm_want(c->cutoff >= 0, f, "contact.cutoff", c->cutoff, -1);
    if (s == MPM_OK) s = mpm_want(c->law != MPM_CONTACT_USER || c->fn, f, "contact.fn", 0, -1);
    return s;
}

/* The grid of a description. */
static inline mpm_status mpm__desc_grid(const mpm_desc *d, mpm_fault *f)
{
    double nodes = 1;
    mpm_status s = mpm_want(d->cell > 0, f, "cell", d->cell, -1);
    int a;
    for (a = 0; a < 6 && s == MPM_OK; a++)
        s = mpm_want((int)d->side[a] >= 0 && d->side[a] < MPM_SIDE_KINDS, f, "side", (mpm_real)d->side[a], a);
    if (s != MPM_OK) return s;
    for (a = 0; a < 3; a++) {
        if ((s = mpm_want(1, f, "origin", d->origin[a], a)) != MPM_OK) return s;
        if ((s = mpm_want(1, f, "gravity", d->gravity[a], a)) != MPM_OK) return s;
        if (a == 1 && d->geometry != MPM_3D) continue;
        if ((s = mpm_want(d->cells[a] >= 1, f, "cells", (mpm_real)d->cells[a], a)) != MPM_OK) return s;
        nodes *= d->cells[a] + 3.0;
    }
    if (d->geometry == MPM_AXISYMMETRIC && !(d->origin[0] >= 0))
        return mpm_fail(f, MPM_ERR_ARGUMENT, "origin of r", d->origin[0], 0);
    return mpm_want(nodes < 2147483647.0, f, "cells in all", (mpm_real)nodes, -1);
}

/* Its capacities: whole numbers from 0. */
static inline mpm_status mpm__desc_capacities(const mpm_desc *d, mpm_fault *f)
{
    mpm_status s = mpm_want(d->points >= 0, f, "points", (mpm_real)d->points, -1);
    if (s == MPM_OK) s = mpm_want(d->bodies >= 0, f, "bodies", (mpm_real)d->bodies, -1);
    if (s == MPM_OK) s = mpm_want(d->rules >= 0, f, "rules", (mpm_real)d->rules, -1);
    if (s == MPM_OK) s = mpm_want(d->nodes >= 0, f, "nodes", (mpm_real)d->nodes, -1);
    if (s == MPM_OK)
        s = mpm_want(d->user_fields >= 0 && d->user_fields <= MPM_USER_FIELDS, f, "user_fields",
                     (mpm_real)d->user_fields, -1);
    return s;
}

MPM_API mpm_status mpm_desc_check(const mpm_desc *d, mpm_fault *f)
{
    mpm_status s = mpm_want(d->mark == MPM_MARK, f, "desc (not from mpm_desc_default)", (mpm_real)d->mark, -1);
    if (s == MPM_OK)
        s = mpm_want((int)d->geometry >= 0 && d->geometry < MPM_GEOMETRIES, f, "geometry", (mpm_real)d->geometry, -1);
    if (s == MPM_OK) s = mpm_want((int)d->basis >= 0 && d->basis < MPM_BASES, f, "basis", (mpm_real)d->basis, -1);
    if (s == MPM_OK) s = mpm_want((int)d->scheme >= 0 && d->scheme < MPM_SCHEMES, f, "scheme", (mpm_real)d->scheme, -1);
    if (s == MPM_OK) s = mpm__desc_grid(d, f);
    if (s == MPM_OK) s = mpm__desc_capacities(d, f);
    if (s == MPM_OK) s = mpm_contact_check(&d->contact, f);
    if (s == MPM_OK) s = mpm_want(d->wall_friction >= 0, f, "wall_friction", d->wall_friction, -1);
    if (s == MPM_OK) s = mpm_want(d->mass_cutoff >= 0, f, "mass_cutoff", d->mass_cutoff, -1);
    if (s == MPM_OK) s = mpm_want(d->calm >= 0, f, "calm", d->calm, -1);
    return s;
}

#ifdef __cplusplus
}
#endif
#endif /* MPM_IMPLEMENTATION */
