/* mpm_spray.h - the spray: powder carried from a nozzle to a target, colliding, sticking, piling up.
   Version 0.2.0. SPDX-License-Identifier: MIT

   DO THIS
     In ONE source file:                          everywhere else:
       #define MPM_IMPLEMENTATION                   #include "mpm_spray.h"
       #include "mpm_spray.h"
     Describe the spray, give it memory (mpm_spray_init), call mpm_spray_step until the time is up,
     measure. Link with -lm.

   WHAT IT DOES NOT DO
     No action of the particles on the gas, no turbulence, no stagnation of the gas at the target,
     no heat, no melting, no deformation of the particles (rigid spheres that touch for an instant),
     no enduring contacts or rolling resistance, no motion of what has been deposited, no lift or
     added mass, no threads. It never prints, exits, aborts or allocates inside a step.

   A COMPLETE PROGRAM
       #define MPM_IMPLEMENTATION
       #include "mpm_spray.h"
       #include <stdio.h>
       int main(void) {
           mpm_spray s;
           mpm_spray_metrics m;
           mpm_spray_desc d = mpm_spray_desc_default();
           d.alpha = 1e4;
           d.capacity = 10000;
           if (mpm_spray_init(&s, &d, NULL, 0) != MPM_OK) return 1;
           while (s.tally.step < 10000)
               if (mpm_spray_step(&s) < 0) return 1;
           mpm_spray_measure(&s, &m);
           printf("%ld of %ld deposited\n", (long)m.deposited, (long)m.injected);
           mpm_spray_free(&s);
           return 0;
       }

   CONTENTS
     description               mpm_spray_desc and the enums and small structs before it
     state                     mpm_spray; mpm_spray_init, _free, _add, _check, _bytes
     the step, phase by phase  mpm_spray_step = inject, fly, bin, find, resolve, move, escape
     the measures              mpm_spray_measure
     restart                   mpm_spray_blobs, _restored
     the models, one by one    mpm_spray_restitution, _stick_speed, _drag_cd_re, _jet_velocity, ...

   CONFIGURATION: that of mpm.h (MPM_FLOAT, MPM_STATIC, MPM_MALLOC, MPM_FREE).

   CONVENTIONS
     Units        SI: m, kg, s. (Only the defaults know that; any consistent system works.)
     Axes         x is the axis of the jet, from the nozzle (x = 0) to the target; y and z across.
     Particles    particles in flight are numbered 0 .. live-1, in order of injection; each keeps
                  its id. Deposited ones are 0 .. deposited-1, in order of arrival.
     Normals      point from what is hit to the particle that hits it.
     Time         positions and velocities at t = step * dt. Within a step the drag of the whole
                  step is applied first (theta scheme); the straight path it leads along is then
                  searched for contacts, and each contact is one impulse at its own instant.
     Same binary, same description, same seed: same bits.

   Equation numbers "B n" are those of source B, Mukherjee and Zohdi, A discrete element based
   simulation framework to investigate particulate spray deposition processes (2015). Where its
   text is open or misprinted the code says what was done instead; the list is in docs/spray_model.md. */
#ifndef MPM_SPRAY_H
#define MPM_SPRAY_H

#include "mpm.h"
#if MPM_VERSION_NUMBER != 200
#error "mpm_spray.h 0.2.0 needs mpm.h 0.2.0"
#endif

#ifdef MPM_FLOAT
#define mpm_spray_desc_default mpm_spray_desc_default_f32
#define mpm_spray_check mpm_spray_check_f32
#define mpm_spray_bytes mpm_spray_bytes_f32
#define mpm_spray_init mpm_spray_init_f32
#define mpm_spray_free mpm_spray_free_f32
#define mpm_spray_add mpm_spray_add_f32
#define mpm_spray_step mpm_spray_step_f32
#define mpm_spray_inject mpm_spray_inject_f32
#define mpm_spray_fly mpm_spray_fly_f32
#define mpm_spray_bin mpm_spray_bin_f32
#define mpm_spray_find mpm_spray_find_f32
#define mpm_spray_resolve mpm_spray_resolve_f32
#define mpm_spray_move mpm_spray_move_f32
#define mpm_spray_escape mpm_spray_escape_f32
#define mpm_spray_time mpm_spray_time_f32
#define mpm_spray_measure mpm_spray_measure_f32
#define mpm_spray_blobs mpm_spray_blobs_f32
#define mpm_spray_restored mpm_spray_restored_f32
#define mpm_spray_modulus mpm_spray_modulus_f32
#define mpm_spray_limit_speed mpm_spray_limit_speed_f32
#define mpm_spray_restitution mpm_spray_restitution_f32
#define mpm_spray_elastic_time mpm_spray_elastic_time_f32
#define mpm_spray_compression_time mpm_spray_compression_time_f32
#define mpm_spray_gamma12 mpm_spray_gamma12_f32
#define mpm_spray_stick_speed mpm_spray_stick_speed_f32
#define mpm_spray_stick_adhesion mpm_spray_stick_adhesion_f32
#define mpm_spray_window_aluminium mpm_spray_window_aluminium_f32
#define mpm_spray_window_critical mpm_spray_window_critical_f32
#define mpm_spray_stick_window mpm_spray_stick_window_f32
#define mpm_spray_collide mpm_spray_collide_f32
#define mpm_spray_collide_fixed mpm_spray_collide_fixed_f32
#define mpm_spray_drag_cd_re mpm_spray_drag_cd_re_f32
#define mpm_spray_drag_rate mpm_spray_drag_rate_f32
#define mpm_spray_jet_make mpm_spray_jet_make_f32
#define mpm_spray_jet_velocity mpm_spray_jet_velocity_f32
#define mpm_spray_random mpm_spray_random_f32
#define mpm_spray_size_scale mpm_spray_size_scale_f32
#define mpm_spray_size mpm_spray_size_f32
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- description --------------------------------------------------------------------------- */

#define MPM_SPRAY_PLANES 8 /* most planes of one spray */

/* Each choice once, as X(constant, "word", "meaning"), as in mpm.h. */
#define MPM_SPRAY_GAS_LIST(X)                                                                                    \
    X(MPM_SPRAY_GAS_JET, "jet", "B 26, 27 with y replaced by the distance r from the axis, as the paper does")   \
    X(MPM_SPRAY_GAS_AXISYMMETRIC, "jet-axisymmetric", "the same axial velocity, radial as continuity then asks") \
    X(MPM_SPRAY_GAS_UNIFORM, "uniform", "gas_speed along x everywhere")                                          \
    X(MPM_SPRAY_GAS_STILL, "still", "no flow")                                                                   \
    X(MPM_SPRAY_GAS_USER, "user", "gas_fn")

/* How contacts are found. */
#define MPM_SPRAY_CONTACT_LIST(X)                                                                                \
    X(MPM_SPRAY_SWEPT, "swept", "along the path: no particle passes through anything at any speed")              \
    X(MPM_SPRAY_OVERLAP, "overlap", "at the ends of steps (the paper's 4.4): fast ones are missed, to compare")

/* What a particle that hits a deposited one does. */
#define MPM_SPRAY_DEPOSIT_LIST(X)                                                                                \
    X(MPM_SPRAY_DEPOSIT_STICK, "stick", "as at the target")                                                      \
    X(MPM_SPRAY_DEPOSIT_ALWAYS, "always", "always sticks")                                                       \
    X(MPM_SPRAY_DEPOSIT_BOUNCE, "bounce", "never sticks")                                                        \
    X(MPM_SPRAY_DEPOSIT_IGNORE, "ignore", "passes through as if nothing were there")

/* How fast particles part. */
#define MPM_SPRAY_REBOUND_LIST(X)                                                                                \
    X(MPM_SPRAY_REBOUND_JOHNSON, "johnson", "restitution from the impact speed (B 18)")                          \
    X(MPM_SPRAY_REBOUND_CONSTANT, "constant", "one restitution for all contacts")

/* Interface energy of two surface energies g1, g2. */
#define MPM_SPRAY_MIXING_LIST(X)                                                                                 \
    X(MPM_SPRAY_MIXING_DISPERSION, "dispersion", "2 sqrt(g1 g2) (the text below B 32)")                          \
    X(MPM_SPRAY_MIXING_DIFFERENCE, "difference", "(sqrt g1 - sqrt g2)^2 (B 31)")

/* How particles that may meet are found. */
#define MPM_SPRAY_SEARCH_LIST(X)                                                                                 \
    X(MPM_SPRAY_BINS, "bins", "neighbours from bins")                                                            \
    X(MPM_SPRAY_ALL_PAIRS, "all", "every pair: the reference the bins are tested against")

typedef enum mpm_spray_gas { MPM_SPRAY_GAS_LIST(MPM_LIST_ENUM) MPM_SPRAY_GASES } mpm_spray_gas;
typedef enum mpm_spray_contact { MPM_SPRAY_CONTACT_LIST(MPM_LIST_ENUM) MPM_SPRAY_CONTACTS } mpm_spray_contact;
typedef enum mpm_spray_deposit { MPM_SPRAY_DEPOSIT_LIST(MPM_LIST_ENUM) MPM_SPRAY_DEPOSITS } mpm_spray_deposit;
typedef enum mpm_spray_rebound { MPM_SPRAY_REBOUND_LIST(MPM_LIST_ENUM) MPM_SPRAY_REBOUNDS } mpm_spray_rebound;
typedef enum mpm_spray_mixing { MPM_SPRAY_MIXING_LIST(MPM_LIST_ENUM) MPM_SPRAY_MIXINGS } mpm_spray_mixing;
typedef enum mpm_spray_search { MPM_SPRAY_SEARCH_LIST(MPM_LIST_ENUM) MPM_SPRAY_SEARCHES } mpm_spray_search;

/* What a solid is made of. */
typedef struct mpm_spray_solid {
    mpm_real shear, bulk;     /* moduli [Pa], > 0 */
    mpm_real yield;           /* [Pa], > 0 */
    mpm_real surface_energy;  /* [J/m^2], >= 0 */
} mpm_spray_solid;

/* A plane wall in general position. A target collects particles and must be at rest; any other
   plane only reflects, and may move: its point travels with its velocity. */
typedef struct mpm_spray_plane {
    mpm_real point[3];     /* a point on it [m] */
    mpm_real normal[3];    /* towards the particles; made a unit vector by mpm_spray_init */
    mpm_real velocity[3];  /* of its surface [m/s] */
    int target;            /* 1: particles may stick */
} mpm_spray_plane;

/* A particle to be added. */
typedef struct mpm_spray_ball {
    mpm_real x[3], v[3], spin[3];  /* [m], [m/s], [rad/s] */
    mpm_real radius, density;      /* [m], [kg/m^3] */
} mpm_spray_ball;

/* What is known when a particle touches a target plane or a deposited particle. */
typedef struct mpm_spray_touch {
    mpm_real time;            /* [s] */
    mpm_real x[3], v[3];      /* centre, velocity before [m], [m/s] */
    mpm_real normal[3];       /* from the target to the particle */
    mpm_real normal_speed;    /* approach speed along the normal, > 0 [m/s] */
    mpm_real radius, density; /* of the particle [m], [kg/m^3] */
    mpm_real radius_effective;/* R, or R1 R2 / (R1 + R2) on a deposited particle [m] */
    mpm_real mass;            /* of the particle (what it hits does not move) [kg] */
    mpm_real yield, gamma;    /* of the softer of the two [Pa]; of the interface [J/m^2] */
    mpm_real alpha;           /* alpha_ADH of the description */
    int64_t id;               /* of the particle */
    int32_t plane, host;      /* which plane, or which deposited particle; the other is -1 */
    int first;                /* 1: this particle touches the target or deposit for the first time */
    int stuck;                /* the outcome; not yet known (0) when a criterion is asked */
} mpm_spray_touch;

/* Functions of your own: the velocity u of the gas at a place; whether a particle sticks; what to note of a touch. */
typedef void (*mpm_spray_gas_fn)(void *user, mpm_real time, const mpm_real x[3], mpm_real u[3]);
typedef int (*mpm_spray_stick_fn)(void *user, const mpm_spray_touch *touch); /* 1: it sticks */
typedef void (*mpm_spray_touch_fn)(void *user, const mpm_spray_touch *touch);

/* Everything that makes a spray. mpm_spray_desc_default gives the paper's Table 1. */
typedef struct mpm_spray_desc {
    unsigned mark;                 /* set by mpm_spray_desc_default */
    /* solids */
    mpm_spray_solid particle, target;
    mpm_real density;              /* of the particles [kg/m^3] */
    /* powder: Rosin-Rammler (Weibull) diameters, B 36, 37 */
    mpm_real median_radius;        /* [m] */
    mpm_real size_shape;           /* n of B 36, > 0 */
    mpm_real diameter_min;         /* truncation [m], >= 0 */
    mpm_real diameter_max;         /* truncation [m]; 0: the nozzle radius */
    /* inlet, a disc at x = 0 */
    mpm_real nozzle_radius;        /* [m] */
    mpm_real feed;                 /* particles per second (B 35); unused when batch is 0 */
    int32_t batch;                 /* particles injected together (N_in); 0: none, use mpm_spray_add */
    int64_t total;                 /* stop the feed after so many; 0: never */
    mpm_real release[2];           /* axial release velocity, uniform between the two [m/s] */
    /* gas */
    mpm_spray_gas gas;
    mpm_real gas_speed;            /* on the axis in the core, or uniform [m/s] */
    mpm_real gas_density;          /* [kg/m^3]; 0: vacuum */
    mpm_real gas_viscosity;        /* kinematic [m^2/s] (Table 1 calls it viscosity) */
    mpm_real core_length;          /* of the potential core [m]; 0: 12 nozzle radii */
    mpm_real core_blend;           /* half length over which the core turns into the jet [m] */
    mpm_spray_gas_fn gas_fn;       /* for MPM_SPRAY_GAS_USER */
    void *gas_user;
    mpm_real gravity[3];           /* [m/s^2] */
    /* contact */
    mpm_real friction;             /* Coulomb mu, >= 0 */
    mpm_real friction_speed;       /* eps of B 11 [m/s], > 0 */
    mpm_spray_rebound rebound;
    mpm_real restitution;          /* for MPM_SPRAY_REBOUND_CONSTANT, 0 .. 1 */
    mpm_spray_contact contact;
    /* sticking */
    mpm_real alpha;                /* alpha_ADH, >= 0; infinity: everything sticks at first touch */
    mpm_spray_mixing mixing;
    mpm_real gamma_target;         /* gamma_12 particle-target [J/m^2]; 0: by mixing */
    mpm_real gamma_deposit;        /* particle-deposit [J/m^2]; 0: 2 x particle's, see gamma12 */
    mpm_spray_deposit deposit;
    mpm_spray_stick_fn stick;      /* criterion; NULL: mpm_spray_stick_adhesion (B 34) */
    void *stick_user;
    mpm_spray_touch_fn touch;      /* told of every touch of target or deposit; may be NULL */
    void *touch_user;
    /* domain */
    mpm_real stand_off;            /* of the default target plane at right angles to x [m] */
    mpm_real low[3], high[3];      /* a centre outside this box has escaped [m] */
    const mpm_spray_plane *planes; /* copied by mpm_spray_init */
    int plane_count;               /* 0: one target plane at stand_off */
    /* numbers */
    mpm_real dt;                   /* [s] */
    mpm_real theta;                /* phi of B 42: 0 explicit, 1/2 trapezoidal, 1 implicit */
    mpm_real tolerance;            /* of the fixed point: largest relative change */
    int iterations;                /* most of them (K_max) */
    int contacts_max;              /* most contacts of one particle in one step */
    mpm_spray_search search;
    uint64_t seed;
    int32_t capacity;              /* most particles in flight and deposited together, > 0 */
    /* measures (5.2) */
    mpm_real target_radius;        /* of the pellet of the volume fraction [m] */
    mpm_real target_thickness;     /* [m] */
    mpm_real late;                 /* the last part of the time over which the rate is taken, 0 .. 1 */
} mpm_spray_desc;

/* ---- state --------------------------------------------------------------------------------- */

/* The jet's constants (B 26, 27) for a profile whose half width at the end of the core is given. */
typedef struct mpm_spray_jet {
    mpm_real c1, c2, c3;   /* C1 [m^(4/3)/s], C2 = C1 / (3 C3) [m^(5/3)/s], C3 [m^(-1/3)] */
    mpm_real core, blend;  /* end of the core, half length of the blend [m] */
    mpm_real core_root;    /* core^(1/3) */
} mpm_spray_jet;

/* Counters, statistics and the random state: with the arrays, all that a restart needs. */
typedef struct mpm_spray_tally {
    int64_t step, particle_steps;
    int64_t injected, deposited, escaped;     /* injected = live + deposited + escaped, always */
    int64_t batches, pending;                 /* fed so far; waiting for a free place at the inlet */
    int64_t pair_hits, collided;              /* collisions in flight; particles that had one */
    int64_t wall_hits, target_hits, deposit_hits;
    int64_t first_hits, first_hits_stuck;     /* on target or deposit */
    int64_t not_converged, exponential;       /* particle-steps of the fixed point, see mpm_spray_fly */
    int64_t capped;                           /* particle-steps that reached contacts_max */
    uint64_t random;
    double speed_mean, speed_m2;              /* of first hits: mean, sum of squared deviations */
    double wait_radius, wait_speed;           /* the particle waiting at the inlet; radius 0: none */
} mpm_spray_tally;

/* Items in cells, found by hashing the cell's three whole numbers. Private to the implementation. */
typedef struct mpm_spray_grid {
    mpm_real cell, per_cell; /* edge [m], 1 / edge */
    uint32_t mask;     /* slots in use - 1 */
    int32_t count;     /* items */
    int32_t *head;     /* per slot: last item, -1 none */
    int32_t *next;     /* per item: the item before it in its slot */
    int32_t *where;    /* per item: its cell, 3 numbers */
} mpm_spray_grid;

/* Particles in flight in the order of their cells. A row of cells along z lies in one run of slots, so what is in it
   stands together. Private to the implementation. */
typedef struct mpm_spray_rows {
    mpm_real per_cell;   /* 1 / edge [1/m] */
    uint32_t mask;       /* slots in use - 1 */
    int32_t count;       /* particles */
    int32_t *start;      /* per slot: the first of its places; one more: count */
    mpm_real *place;     /* where those that stand there are binned, 3 per place [m] */
    int32_t *particle;   /* ... which they are */
} mpm_spray_rows;

/* A spray under way: its particles, its deposit, what was counted. */
typedef struct mpm_spray {
    mpm_spray_desc desc;
    mpm_spray_jet jet;
    mpm_spray_tally tally;
    mpm_spray_plane plane[MPM_SPRAY_PLANES];
    int planes;
    mpm_fault fault;

    /* in flight: arrays of `live` entries; vectors have 3 numbers per particle */
    int32_t live;
    mpm_real *x, *v, *spin, *radius, *density;
    int64_t *id;
    int32_t *collisions;   /* with particles in flight, so far */
    int32_t *touches;      /* of target and deposit, so far */
    mpm_real *drag;        /* acceleration at the end of the last step, 3 per particle [m/s^2] */
    int32_t *known;        /* 1: drag belongs to x and v as they are; clear it if you change them */

    /* deposited */
    int32_t deposited;
    mpm_real *deposit_x, *deposit_radius, *deposit_time;
    int64_t *deposit_id;
    int32_t *deposit_collisions;
    mpm_real deposit_low[3], deposit_high[3]; /* box around their centres */
    mpm_real deposit_radius_max;

    /* of the step under way */
    mpm_real *path;        /* velocity along the path from `clock` to the end of the step */
    mpm_real *middle;      /* of the path: where the particle is binned */
    mpm_real *clock;       /* time in the step at which x holds */
    mpm_real *when;        /* of the next contact */
    int32_t *kind, *with;  /* of the next contact: what, and which */
    int32_t *stamp;        /* contacts in this step: a prediction holds while it is unchanged */
    int32_t *with_stamp;   /* the partner's stamp when the contact was predicted */
    int32_t *heap, *slot;  /* particles with a contact, earliest first; place of each in the heap */
    int32_t heap_count;
    int32_t *gone;         /* 1: deposited in this step */
    int32_t *list;         /* neighbours just gathered */
    mpm_spray_rows rows;
    mpm_spray_grid inlet_bins, deposit_bins;
    mpm_real radius_max, reach;  /* largest radius; farthest from the binned place in this step */

    /* constants worked out from the description */
    mpm_real modulus_target, modulus_pair, yield_target, yield_pair;
    mpm_real gamma_target, gamma_deposit, size_scale;
    void *memory;
    size_t bytes;
    int owns_memory;
} mpm_spray;

/* The paper's Table 1 and 5.1, with the open points as docs/spray_model.md settles them. capacity is
   50 100, enough for the 50 050 particles of the paper's Fig. 6. Test: 50_spray. */
MPM_API mpm_spray_desc mpm_spray_desc_default(void);

/* Checks a description. On failure fills fault (may be NULL) with the field's name and value.
   MPM_ERR_ARGUMENT, MPM_ERR_NAN. Test: 51_spray_input. */
MPM_API mpm_status mpm_spray_check(const mpm_spray_desc *d, mpm_fault *fault);

/* Bytes that mpm_spray_init needs; 0 if d is invalid or the size overflows. Test: 51_spray_input. */
MPM_API size_t mpm_spray_bytes(const mpm_spray_desc *d);

/* Prepares a spray in the caller's memory (kept until the end, aligned as malloc aligns: others are refused), or with
   NULL in memory from MPM_MALLOC. MPM_ERR_ARGUMENT / NAN (see s->fault), MPM_ERR_MEMORY.
   Test: 51_spray_input, 52_spray_flow. */
MPM_API mpm_status mpm_spray_init(mpm_spray *s, const mpm_spray_desc *d, void *memory, size_t bytes);

/* Gives back what MPM_MALLOC gave. Safe after a failed mpm_spray_init. Test: 51_spray_input. */
MPM_API void mpm_spray_free(mpm_spray *s);

/* Puts one particle into flight; it counts as injected. Whether it overlaps another is not checked
   (overlapping particles that approach collide at once). MPM_ERR_ARGUMENT / NAN, MPM_ERR_FULL.
   Test: 51_spray_input. */
MPM_API mpm_status mpm_spray_add(mpm_spray *s, const mpm_spray_ball *ball);

/* ---- the step, phase by phase -------------------------------------------------------------- */

/* One step of dt: the phases below in their order. MPM_NOT_CONVERGED: the drag iteration of some
   particle reached its limit and the exponential update was used for it (tally.not_converged).
   MPM_ERR_FULL, MPM_ERR_NAN: see inject and fly; the step is then incomplete. Test: 52_spray_flow. */
MPM_API mpm_status mpm_spray_step(mpm_spray *s);

/* Feeds the batches that are due (B 35), one particle after the other, each at a random place of
   the inlet disc where it overlaps nothing. One that finds no place waits for the next step.
   MPM_ERR_FULL: capacity. Tests: 52_spray_flow (no overlap, bookkeeping). */
MPM_API mpm_status mpm_spray_inject(mpm_spray *s);

/* Drag and gravity over the whole step: B 42, 43 with the fixed point B 51, 52. Sets the velocity
   at the end of the step and the straight path that leads there.
   MPM_ERR_NAN: velocity of particle fault.index (its id) - usually a gas field that is not finite.
   Tests: 50_spray (transit times, terminal speed, orders), 52_spray_flow (dust). */
MPM_API mpm_status mpm_spray_fly(mpm_spray *s);

/* Puts the particles into bins (4.3, "direct binning"): linear in their number. Test: 53_spray_search. */
MPM_API void mpm_spray_bin(mpm_spray *s);

/* Finds the first contact on each particle's path (B 40, 41). Test: 53_spray_search. */
MPM_API void mpm_spray_find(mpm_spray *s);

/* Carries out the contacts in the order of time: impulse (B 7-15, 22, 23) or deposition (B 34). A
   particle that has been hit looks for its next contact along its new path. Test: 50_spray, 53_spray_search. */
MPM_API void mpm_spray_resolve(mpm_spray *s);

/* Takes everything to the end of the step, moving planes included. Test: 50_spray. */
MPM_API void mpm_spray_move(mpm_spray *s);

/* Closes the ranks: removes what was deposited or has left the box (4.1). Test: 52_spray_flow. */
MPM_API void mpm_spray_escape(mpm_spray *s);

/* step * dt [s]. Test: 52_spray_flow. */
MPM_API mpm_real mpm_spray_time(const mpm_spray *s);

/* ---- the measures -------------------------------------------------------------------------- */

/* The deposit's measures (5.2) and the flight's. Distances are in the plane of the first target,
   from the point where the axis of the jet meets it. */
typedef struct mpm_spray_metrics {
    int64_t injected, deposited, escaped, in_flight;
    double deposit_fraction;        /* deposited / injected at this time */
    double late_rate_over_feed;     /* arrivals in the last part of the time / what was fed in it */
    double mean_spread, scatter;    /* mean of the distance, its standard deviation [m] */
    double thickness;               /* largest minus smallest height of the centres [m] */
    double volume_fraction;         /* volume inside the pellet / the pellet's */
    double volume_r5mm, volume_r10mm; /* volume within 5 and 10 mm of the axis [m^3] */
    double collisions_per_particle; /* two per collision in flight, over injected */
    double collided_fraction;       /* of the injected */
    double impact_speed_mean, impact_speed_sd; /* speed (not normal) at the first touch [m/s] */
    double first_hit_stuck_fraction;
} mpm_spray_metrics;

/* Fills m from the state. Test: 52_spray_flow. */
MPM_API void mpm_spray_measure(const mpm_spray *s, mpm_spray_metrics *m);

/* ---- restart ------------------------------------------------------------------------------- */

/* The state: all that the next step depends on, and what is counted. Fills blob[], at most MPM_SPRAY_BLOBS of them,
   and returns how many. To go on from stored ones, prepare a spray with the same description and room for as many
   particles, read them (mpm_io_checkpoint_read) and call mpm_spray_restored.
   Test: 52_spray_flow (restart gives the same bytes as the uninterrupted run). */
#define MPM_SPRAY_BLOBS (18 + MPM_SPRAY_PLANES)
MPM_API int mpm_spray_blobs(mpm_spray *s, mpm_blob *blob);

/* Checks what was read into the blobs of mpm_spray_blobs, before anything of it is used, and builds what follows
   from it. MPM_ERR_ARGUMENT / NAN, named by s->fault: the spray is then without particles.
   Test: 51_spray_input. */
MPM_API mpm_status mpm_spray_restored(mpm_spray *s, const mpm_blob *blob);

/* ---- the models, one by one ---------------------------------------------------------------- */

/* E* of two solids [Pa]: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, E and nu from the moduli. Test: 50_spray. */
MPM_API mpm_real mpm_spray_modulus(const mpm_spray_solid *a, const mpm_spray_solid *b);

/* Speed below which a contact stays elastic [m/s] (B 17). mass, radius: those of the particle at a
   wall, m1 m2/(m1 + m2) and R1 R2/(R1 + R2) for a pair (the text leaves them undefined there). Test: 50_spray. */
MPM_API mpm_real mpm_spray_limit_speed(mpm_real mass, mpm_real radius, mpm_real yield, mpm_real modulus);

/* Restitution e at a normal speed >= 0 (B 18), never above 1: as printed it is 2.277 at the limit
   speed and above 1 up to 26.9 of them. Test: 50_spray. */
MPM_API mpm_real mpm_spray_restitution(mpm_real speed, mpm_real mass, mpm_real radius, mpm_real yield,
                                       mpm_real modulus);

/* Duration of an elastic contact [s] (B 16), speed > 0, and of the compression phase of an
   inelastic one (B 19); the recovery then takes 1.2 e times as long as the compression. Test: 50_spray. */
MPM_API mpm_real mpm_spray_elastic_time(mpm_real speed, mpm_real mass, mpm_real radius, mpm_real modulus);
MPM_API mpm_real mpm_spray_compression_time(mpm_real mass, mpm_real radius, mpm_real yield);

/* Interface energy of two surface energies [J/m^2]. The paper has three different ones; since only
   alpha times it matters, the choice rescales alpha. Test: 50_spray. */
MPM_API mpm_real mpm_spray_gamma12(mpm_spray_mixing rule, mpm_real gamma1, mpm_real gamma2);

/* Largest normal speed that sticks [m/s]: 0.2 alpha F dt1 / m (B 34, last line), with the
   attractive force F = 4 pi gamma R (the size of B 32, whose sign is a misprint). Test: 50_spray. */
MPM_API mpm_real mpm_spray_stick_speed(mpm_real alpha, mpm_real gamma, mpm_real mass, mpm_real radius,
                                       mpm_real yield);

/* The paper's criterion, for mpm_spray_desc.stick: below that speed it sticks. user is not used. Test: 50_spray. */
MPM_API int mpm_spray_stick_adhesion(void *user, const mpm_spray_touch *touch);

/* The cold-spray window, which the paper names as the natural other criterion: bonds from a
   critical velocity on, which depends on size, up to an erosion velocity. */
typedef struct mpm_spray_window {
    mpm_real critical;   /* at `diameter` [m/s] */
    mpm_real diameter;   /* [m] */
    mpm_real slope;      /* d critical / d diameter [1/s] */
    mpm_real erosion;    /* [m/s]; infinity: none */
} mpm_spray_window;

/* Aluminium on aluminium by source A: 824 m/s at 14 um to 761 m/s at 30 um, linear (its table 5.4).
   It gives no erosion velocity; set one if you know it. Test: 50_spray. */
MPM_API mpm_spray_window mpm_spray_window_aluminium(void);

/* The critical velocity of a diameter [m/s], >= 0. Test: 50_spray. */
MPM_API mpm_real mpm_spray_window_critical(const mpm_spray_window *w, mpm_real diameter);

/* The criterion for mpm_spray_desc.stick; user points to a mpm_spray_window. Test: 50_spray. */
MPM_API int mpm_spray_stick_window(void *user, const mpm_spray_touch *touch);

/* Collision of two balls that touch (B 7-15): changes v and spin, returns the normal impulse
   [kg m/s], 0 if they do not approach. friction: mu, speed: eps of B 11. Friction is
   min(mu R J_n, m_t s): uncapped, as printed, it can reverse the slip s and create energy.
   Test: 50_spray (momentum, restitution, energy over 1e5 random pairs). */
MPM_API mpm_real mpm_spray_collide(mpm_spray_ball *a, mpm_spray_ball *b, mpm_real e, mpm_real friction,
                                   mpm_real speed);

/* The same against something that does not recoil (B 20-23), with unit normal n towards the ball
   and surface velocity u. Test: 50_spray. */
MPM_API mpm_real mpm_spray_collide_fixed(mpm_spray_ball *a, const mpm_real n[3], const mpm_real u[3],
                                         mpm_real e, mpm_real friction, mpm_real speed);

/* Cd Re of a sphere (Haider and Levenspiel, B 25 times Re: finite at Re = 0, where it is 24). Test: 50_spray. */
MPM_API mpm_real mpm_spray_drag_cd_re(mpm_real re);

/* 1 / relaxation time [1/s]: dv/dt = rate (u - v) (B 24). slip: |u - v| [m/s]. Test: 50_spray. */
MPM_API mpm_real mpm_spray_drag_rate(mpm_real slip, mpm_real radius, mpm_real density,
                                     mpm_real gas_density, mpm_real gas_viscosity);

/* The jet that leaves a nozzle with a given speed: half width (sech^2 = 1/2) equal to the nozzle
   radius at the end of the core. All > 0; blend <= core. Test: 50_spray. */
MPM_API mpm_spray_jet mpm_spray_jet_make(mpm_real speed, mpm_real nozzle_radius, mpm_real core,
                                         mpm_real blend);

/* Gas velocity at x (B 26, 27). axisymmetric: 0 the planar radial velocity (continuity holds in the
   plane), 1 the axisymmetric one. Continuous everywhere. Test: 50_spray (divergence). */
MPM_API void mpm_spray_jet_velocity(const mpm_spray_jet *j, int axisymmetric, const mpm_real x[3],
                                    mpm_real u[3]);

/* Uniform number in [0, 1) from a 64-bit state, which it advances. Any seed will do. Test: 50_spray. */
MPM_API mpm_real mpm_spray_random(uint64_t *state);

/* Weibull scale lambda from the median diameter and the shape n (B 37). Test: 50_spray. */
MPM_API mpm_real mpm_spray_size_scale(mpm_real median, mpm_real shape);

/* Diameter at the quantile u in [0, 1) of the distribution B 36 truncated to [least, most] (`most` may be infinite),
   however small the part of the powder that lies between. Test: 50_spray (medians over 1e6 samples, sieved tails). */
MPM_API mpm_real mpm_spray_size(mpm_real u, mpm_real scale, mpm_real shape, mpm_real least, mpm_real most);

#ifdef __cplusplus
}
#endif
#endif /* MPM_SPRAY_H - stop here if you only want the API */

/* ============================================================================================ */
#if defined(MPM_IMPLEMENTATION) && !defined(MPM__SPRAY_IMPLEMENTED)
#define MPM__SPRAY_IMPLEMENTED

#include <float.h>
#include <math.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MPM__SPRAY_NEVER MPM_R(1e30)  /* later than any contact */
#define MPM__SPRAY_TRIES 1000         /* places tried for one particle at the inlet */

/* What the next contact of a particle is with. */
enum { MPM__SPRAY_NOTHING, MPM__SPRAY_PLANE, MPM__SPRAY_DEPOSIT, MPM__SPRAY_PAIR };

/* ---- small tools --------------------------------------------------------------------------- */

/* Not those of mpm.h: with floats too these compute in double and round once. */
static inline mpm_real mpm__spray_sqrt(mpm_real a) { return (mpm_real)sqrt((double)a); }
static inline mpm_real mpm__spray_exp(mpm_real a) { return (mpm_real)exp((double)a); }
static inline mpm_real mpm__spray_pow(mpm_real a, mpm_real b) { return (mpm_real)pow((double)a, (double)b); }
static inline mpm_real mpm__spray_cbrt(mpm_real a) { return (mpm_real)cbrt((double)a); }
static inline mpm_real mpm__spray_max(mpm_real a, mpm_real b) { return a > b ? a : b; }
static inline mpm_real mpm__spray_min(mpm_real a, mpm_real b) { return a < b ? a : b; }

static inline mpm_real mpm__spray_dot(const mpm_real *a, const mpm_real *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline mpm_real mpm__spray_length(const mpm_real *a) { return mpm__spray_sqrt(mpm__spray_dot(a, a)); }

/* c += f a x b */
static inline void mpm__spray_add_cross(mpm_real *c, mpm_real f, const mpm_real *a, const mpm_real *b)
{
    c[0] += f * (a[1] * b[2] - a[2] * b[1]);
    c[1] += f * (a[2] * b[0] - a[0] * b[2]);
    c[2] += f * (a[0] * b[1] - a[1] * b[0]);
}

static inline mpm_real mpm__spray_mass(mpm_real radius, mpm_real density)
{
    return 4 * MPM_PI / 3 * density * radius * radius * radius;
}

/* ---- contact models ------------------------------------------------------------------------ */

MPM_API mpm_real mpm_spray_modulus(const mpm_spray_solid *a, const mpm_spray_solid *b)
{
    /* (1 - nu^2)/E in terms of the moduli is (3K + 4G) / (4 G (3K + G)) */
    mpm_real ca = (3 * a->bulk + 4 * a->shear) / (4 * a->shear * (3 * a->bulk + a->shear));
    mpm_real cb = (3 * b->bulk + 4 * b->shear) / (4 * b->shear * (3 * b->bulk + b->shear));
    return 1 / (ca + cb);
}

MPM_API mpm_real mpm_spray_limit_speed(mpm_real mass, mpm_real radius, mpm_real yield, mpm_real modulus)
{
    mpm_real ratio = yield / modulus; /* powers of the ratio stay in the range of a float */
    return mpm__spray_sqrt(106 * radius * radius * radius / mass * yield * ratio * ratio * ratio * ratio);
}

MPM_API mpm_real mpm_spray_restitution(mpm_real speed, mpm_real mass, mpm_real radius, mpm_real yield,
                                       mpm_real modulus)
{
    mpm_real energy = mass * speed * speed / (2 * yield * radius * radius * radius);
    mpm_real e = MPM_R(3.74) * mpm__spray_sqrt(yield / modulus) * mpm__spray_pow(energy, MPM_R(-0.125));
    return mpm__spray_min(1, e);
}

MPM_API mpm_real mpm_spray_elastic_time(mpm_real speed, mpm_real mass, mpm_real radius, mpm_real modulus)
{
    mpm_real a = mass / modulus;
    return MPM_R(2.87) * mpm__spray_pow(a * (a / (radius * speed)), MPM_R(0.2));
}

MPM_API mpm_real mpm_spray_compression_time(mpm_real mass, mpm_real radius, mpm_real yield)
{
    return mpm__spray_sqrt(MPM_PI * mass / (24 * radius * yield));
}

MPM_API mpm_real mpm_spray_gamma12(mpm_spray_mixing rule, mpm_real gamma1, mpm_real gamma2)
{
    mpm_real both = 2 * mpm__spray_sqrt(gamma1 * gamma2);
    return rule == MPM_SPRAY_MIXING_DISPERSION ? both : gamma1 + gamma2 - both;
}

MPM_API mpm_real mpm_spray_stick_speed(mpm_real alpha, mpm_real gamma, mpm_real mass, mpm_real radius,
                                       mpm_real yield)
{
    mpm_real force = 4 * MPM_PI * gamma * radius;
    return MPM_R(0.2) * alpha * (force * mpm_spray_compression_time(mass, radius, yield) / mass);
}

MPM_API int mpm_spray_stick_adhesion(void *user, const mpm_spray_touch *t)
{
    (void)user;
    /* The paper derives B 34 for inelastic contacts; it is applied at all speeds, since at alpha = 1
       the speed it gives is far below where plastic flow sets in. */
    return t->normal_speed < mpm_spray_stick_speed(t->alpha, t->gamma, t->mass, t->radius_effective, t->yield);
}

MPM_API mpm_spray_window mpm_spray_window_aluminium(void)
{
    mpm_spray_window w;
    w.critical = 824;
    w.diameter = MPM_R(14e-6);
    w.slope = (761 - 824) / MPM_R(16e-6);
    w.erosion = (mpm_real)HUGE_VAL;
    return w;
}

MPM_API mpm_real mpm_spray_window_critical(const mpm_spray_window *w, mpm_real diameter)
{
    return mpm__spray_max(0, w->critical + w->slope * (diameter - w->diameter));
}

MPM_API int mpm_spray_stick_window(void *user, const mpm_spray_touch *t)
{
    const mpm_spray_window *w = (const mpm_spray_window *)user;
    return t->normal_speed >= mpm_spray_window_critical(w, 2 * t->radius) && t->normal_speed <= w->erosion;
}

/* The impulse between a and b, or between a and a surface of velocity u when b is NULL. n points to
   a. The external forces during the contact (B 7, 8: drag, for 3e-7 s) are left out: the step has
   already applied them, for its whole length. */
static inline mpm_real mpm__spray_impulse(mpm_spray_ball *a, mpm_spray_ball *b, const mpm_real *n,
                                          const mpm_real *u, mpm_real e, mpm_real friction, mpm_real speed)
{
    mpm_real ia = 1 / mpm__spray_mass(a->radius, a->density);
    mpm_real ib = b ? 1 / mpm__spray_mass(b->radius, b->density) : 0;
    mpm_real g[3], j[3], gn, jn, jt = 0, slip;
    int d;
    for (d = 0; d < 3; d++) g[d] = a->v[d] - (b ? b->v[d] : u[d]);
    mpm__spray_add_cross(g, -a->radius, a->spin, n);      /* B 2: the contact point of a is at -R n */
    if (b) mpm__spray_add_cross(g, -b->radius, b->spin, n); /* B 3 */
    gn = mpm__spray_dot(g, n);
    if (!(gn < 0)) return 0;                              /* B 40: only approaching bodies collide */
    jn = -(1 + e) * gn / (ia + ib);                       /* B 7, 22 */
    for (d = 0; d < 3; d++) g[d] -= gn * n[d];
    slip = mpm__spray_length(g);
    if (slip > 0) /* B 10-13. B 11 is printed with 2 eps, which would make it jump at slip = eps. */
        jt = mpm__spray_min(friction * mpm__spray_min(1, slip / speed) * jn, slip / (MPM_R(3.5) * (ia + ib)));
    for (d = 0; d < 3; d++) j[d] = jn * n[d] - (slip > 0 ? jt / slip * g[d] : 0);
    for (d = 0; d < 3; d++) a->v[d] += ia * j[d];         /* B 8, 12, 23 */
    mpm__spray_add_cross(a->spin, -MPM_R(2.5) * ia / a->radius, n, j); /* B 14 with R_i, I = 2/5 m R^2 */
    if (b) {
        for (d = 0; d < 3; d++) b->v[d] -= ib * j[d];     /* B 9, 13 */
        mpm__spray_add_cross(b->spin, -MPM_R(2.5) * ib / b->radius, n, j); /* B 15 with R_j */
    }
    return jn;
}

MPM_API mpm_real mpm_spray_collide(mpm_spray_ball *a, mpm_spray_ball *b, mpm_real e, mpm_real friction,
                                   mpm_real speed)
{
    mpm_real n[3], d;
    int k;
    for (k = 0; k < 3; k++) n[k] = a->x[k] - b->x[k]; /* B 1 */
    d = mpm__spray_length(n);
    if (!(d > 0)) return 0; /* same place: no direction to push */
    for (k = 0; k < 3; k++) n[k] /= d;
    return mpm__spray_impulse(a, b, n, NULL, e, friction, speed);
}

MPM_API mpm_real mpm_spray_collide_fixed(mpm_spray_ball *a, const mpm_real n[3], const mpm_real u[3],
                                         mpm_real e, mpm_real friction, mpm_real speed)
{
    return mpm__spray_impulse(a, NULL, n, u, e, friction, speed);
}

/* ---- gas and drag -------------------------------------------------------------------------- */

MPM_API mpm_real mpm_spray_drag_cd_re(mpm_real re)
{
    if (!(re > 0)) return 24;
    return 24 * (1 + MPM_R(0.1806) * mpm__spray_pow(re, MPM_R(0.6459))) +
           MPM_R(0.4251) * re * re / (re + MPM_R(6880.95));
}

MPM_API mpm_real mpm_spray_drag_rate(mpm_real slip, mpm_real radius, mpm_real density,
                                     mpm_real gas_density, mpm_real gas_viscosity)
{
    mpm_real cd_re = mpm_spray_drag_cd_re(2 * radius * slip / gas_viscosity);
    return MPM_R(0.1875) * gas_density * gas_viscosity / (density * radius * radius) * cd_re;
}

MPM_API mpm_spray_jet mpm_spray_jet_make(mpm_real speed, mpm_real nozzle_radius, mpm_real core,
                                         mpm_real blend)
{
    mpm_spray_jet j;
    j.core = core;
    j.blend = blend;
    j.core_root = mpm__spray_cbrt(core);
    j.c1 = speed * j.core_root;
    j.c3 = MPM_R(0.88137358701954302) * j.core_root * j.core_root / nozzle_radius; /* arcosh sqrt 2 */
    j.c2 = j.c1 / (3 * j.c3); /* what continuity asks of B 27 */
    return j;
}

/* The jet's own length coordinate X and its slope: X = core up to core - blend, X = x from core +
   blend on, a parabola between. With X in place of x in the stream function the axial velocity is
   B 26 at X and the cross velocity that of B 27 at X times dX/dx: nothing is entrained in the core,
   the field has no jumps, and it still has no sources. (The paper's core ends abruptly.) */
static inline mpm_real mpm__spray_jet_length(const mpm_spray_jet *j, mpm_real x, mpm_real *slope)
{
    mpm_real into = x - (j->core - j->blend);
    *slope = into <= 0 ? 0 : into >= 2 * j->blend ? 1 : into / (2 * j->blend);
    return into <= 0 ? j->core : into >= 2 * j->blend ? x : j->core + into * into / (4 * j->blend);
}

MPM_API void mpm_spray_jet_velocity(const mpm_spray_jet *j, int axisymmetric, const mpm_real x[3],
                                    mpm_real u[3])
{
    mpm_real slope, length = mpm__spray_jet_length(j, x[0], &slope);
    mpm_real root = 1 / (slope > 0 ? mpm__spray_cbrt(length) : j->core_root); /* X^(-1/3) */
    mpm_real r = mpm__spray_sqrt(x[1] * x[1] + x[2] * x[2]);
    mpm_real xi = j->c3 * root * root * r, q = mpm__spray_exp(-2 * xi), p = 1 / (1 + q);
    mpm_real tanh_xi = (1 - q) * p, sech2 = 4 * q * p * p, vr;
    u[0] = j->c1 * root * sech2;
    u[1] = u[2] = 0;
    if (!(slope > 0) || !(r > 0)) return;
    if (!axisymmetric) { /* B 27 with the y that is missing from its first term */
        vr = j->c2 * root * root * (2 * xi * sech2 - tanh_xi);
    } else {
        mpm_real g;
        if (xi < MPM_R(0.02)) /* the series: the terms below cancel there */
            g = xi * (MPM_R(-1.0) / 6 + MPM_R(5.0) / 12 * xi * xi);
        else
            g = tanh_xi - (xi + (mpm_real)log1p((double)q) - MPM_R(0.69314718055994531)) / xi -
                MPM_R(2.0) / 3 * xi * sech2;
        vr = -j->c1 / j->c3 * root * root * g;
    }
    vr *= slope / r;
    u[1] = vr * x[1];
    u[2] = vr * x[2];
}

static inline void mpm__spray_gas_at(const mpm_spray *s, mpm_real time, const mpm_real *x, mpm_real *u)
{
    const mpm_spray_desc *d = &s->desc;
    u[0] = u[1] = u[2] = 0;
    switch (d->gas) {
    case MPM_SPRAY_GAS_JET: mpm_spray_jet_velocity(&s->jet, 0, x, u); break;
    case MPM_SPRAY_GAS_AXISYMMETRIC: mpm_spray_jet_velocity(&s->jet, 1, x, u); break;
    case MPM_SPRAY_GAS_UNIFORM: u[0] = d->gas_speed; break;
    case MPM_SPRAY_GAS_STILL:
    case MPM_SPRAY_GASES: break;
    case MPM_SPRAY_GAS_USER: d->gas_fn(d->gas_user, time, x, u); break;
    }
}

/* ---- random numbers and sizes -------------------------------------------------------------- */

/* Counter with a mixing of its bits (the SplitMix64 sequence). */
MPM_API mpm_real mpm_spray_random(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    z ^= z >> 31;
#ifdef MPM_FLOAT
    return (mpm_real)(z >> 40) / MPM_R(16777216.0);
#else
    return (mpm_real)(z >> 11) / 9007199254740992.0;
#endif
}

MPM_API mpm_real mpm_spray_size_scale(mpm_real median, mpm_real shape)
{
    return median / mpm__spray_pow(MPM_R(0.69314718055994531), 1 / shape);
}

/* t = (D / scale)^n has the law e^-t. Within the window it is counted from the lower end: what is added there is never
   lost beside what is subtracted, so a tail that holds next to nothing keeps its shape. */
MPM_API mpm_real mpm_spray_size(mpm_real u, mpm_real scale, mpm_real shape, mpm_real least, mpm_real most)
{
    const double n = (double)shape, v = (double)u, least_t = pow((double)least / (double)scale, n);
    const double most_t = pow((double)most / (double)scale, n);
    double diameter = (double)scale * pow(least_t - log1p(v * expm1(least_t - most_t)), 1 / n);
    if (most_t < DBL_MIN) /* e^-t is 1 in all of the window: D^n is uniform */
        diameter = (double)most * pow(v + (1 - v) * pow((double)least / (double)most, n), 1 / n);
    if (!(diameter > (double)least) || !(least_t < DBL_MAX)) return least; /* far out all of the tail is at its start */
    return diameter < (double)most ? (mpm_real)diameter : most;
}

/* ---- description and memory ---------------------------------------------------------------- */

MPM_API mpm_spray_desc mpm_spray_desc_default(void)
{
    mpm_spray_desc d;
    memset(&d, 0, sizeof d);
    d.mark = MPM_MARK;
    d.particle.shear = MPM_R(77e9);
    d.particle.bulk = MPM_R(167e9);
    d.particle.yield = MPM_R(690e6); /* not in the paper: taken equal to the target's */
    d.particle.surface_energy = MPM_R(46e-3);
    d.target.shear = MPM_R(80e9);
    d.target.bulk = MPM_R(160e9);
    d.target.yield = MPM_R(690e6);
    d.target.surface_energy = MPM_R(1.1);
    d.density = 5680;
    d.median_radius = MPM_R(80e-6);
    d.size_shape = 5;
    d.diameter_min = MPM_R(1e-6);
    d.nozzle_radius = MPM_R(0.01);
    d.feed = MPM_R(1e5);
    d.batch = 50;
    d.release[1] = 50;
    d.gas = MPM_SPRAY_GAS_JET;
    d.gas_speed = 50;
    d.gas_density = MPM_R(1.10);
    d.gas_viscosity = MPM_R(25e-6);
    d.core_blend = MPM_R(0.0025);
    d.friction = MPM_R(0.55); /* the middle of the paper's 0.50 - 0.60 */
    d.friction_speed = MPM_R(1e-4);
    d.rebound = MPM_SPRAY_REBOUND_JOHNSON;
    d.restitution = MPM_R(0.8);
    d.alpha = MPM_R(1e5);
    d.stand_off = MPM_R(0.30);
    d.low[0] = MPM_R(-0.02);
    d.low[1] = d.low[2] = MPM_R(-0.05);
    d.high[0] = MPM_R(0.32);
    d.high[1] = d.high[2] = MPM_R(0.05);
    d.dt = MPM_R(5e-6);
    d.theta = MPM_R(0.5);
    d.tolerance = MPM_R(1e-6);
    d.iterations = 20;
    d.contacts_max = 32;
    d.seed = 1;
    d.capacity = 50100;
    d.target_radius = MPM_R(0.005); /* "the circular pellet of width 0.01 m": one number for two */
    d.target_thickness = MPM_R(0.01);
    d.late = MPM_R(0.2);
    return d;
}

static inline mpm_real mpm__spray_diameter_max(const mpm_spray_desc *d)
{
    return d->diameter_max > 0 ? d->diameter_max : d->nozzle_radius;
}

static inline mpm_real mpm__spray_core(const mpm_spray_desc *d)
{
    return d->core_length > 0 ? d->core_length : 12 * d->nozzle_radius;
}

/* One rule about one value. Rules are tried in order; the first broken one is reported. */
typedef struct mpm__spray_rule {
    const char *field;
    mpm_real value;
    int ok;
} mpm__spray_rule;

static inline mpm__spray_rule mpm__spray_rule_of(const char *field, mpm_real value, int ok)
{
    mpm__spray_rule r;
    r.field = field;
    r.value = value;
    r.ok = ok;
    return r;
}

static inline mpm_status mpm__spray_judge(const mpm__spray_rule *rule, int count, mpm_fault *f)
{
    mpm_status status = MPM_OK;
    int i;
    for (i = 0; i < count && status == MPM_OK; i++)
        status = mpm_want(rule[i].ok, f, rule[i].field, rule[i].value, -1);
    return status;
}

static inline mpm_status mpm__spray_check_solid(const mpm_spray_solid *s, mpm_fault *f)
{
    mpm__spray_rule r[4];
    r[0] = mpm__spray_rule_of("shear", s->shear, s->shear > 0);
    r[1] = mpm__spray_rule_of("bulk", s->bulk, s->bulk > 0);
    r[2] = mpm__spray_rule_of("yield", s->yield, s->yield > 0);
    r[3] = mpm__spray_rule_of("surface_energy", s->surface_energy, s->surface_energy >= 0);
    return mpm__spray_judge(r, 4, f);
}

static inline mpm_status mpm__spray_check_powder(const mpm_spray_desc *d, mpm_fault *f)
{
    mpm__spray_rule r[10];
    mpm_real largest = mpm__spray_diameter_max(d);
    int n = 0;
    r[n++] = mpm__spray_rule_of("density", d->density, d->density > 0);
    r[n++] = mpm__spray_rule_of("nozzle_radius", d->nozzle_radius, d->nozzle_radius > 0);
    r[n++] = mpm__spray_rule_of("median_radius", d->median_radius, d->median_radius > 0);
    r[n++] = mpm__spray_rule_of("size_shape", d->size_shape, d->size_shape > 0);
    r[n++] = mpm__spray_rule_of("diameter_min", d->diameter_min, d->diameter_min >= 0);
    r[n++] = mpm__spray_rule_of("diameter_max", d->diameter_max, d->diameter_max >= 0 && largest > d->diameter_min &&
                                                                     largest <= 2 * d->nozzle_radius);
    r[n++] = mpm__spray_rule_of("batch", (mpm_real)d->batch, d->batch >= 0);
    r[n++] = mpm__spray_rule_of("feed", d->feed, d->batch == 0 || d->feed > 0);
    r[n++] = mpm__spray_rule_of("release[0]", d->release[0], d->release[0] >= 0);
    r[n++] = mpm__spray_rule_of("release[1]", d->release[1], d->release[1] >= d->release[0]);
    return mpm__spray_judge(r, n, f);
}

static inline mpm_status mpm__spray_check_gas(const mpm_spray_desc *d, mpm_fault *f)
{
    mpm__spray_rule r[9];
    int n = 0, jet = d->gas == MPM_SPRAY_GAS_JET || d->gas == MPM_SPRAY_GAS_AXISYMMETRIC;
    r[n++] = mpm__spray_rule_of("gas", (mpm_real)d->gas, d->gas >= 0 && d->gas < MPM_SPRAY_GASES &&
                                                             (d->gas != MPM_SPRAY_GAS_USER || d->gas_fn));
    r[n++] = mpm__spray_rule_of("gas_speed", d->gas_speed, !jet || d->gas_speed > 0);
    r[n++] = mpm__spray_rule_of("gas_density", d->gas_density, d->gas_density >= 0);
    r[n++] = mpm__spray_rule_of("gas_viscosity", d->gas_viscosity, d->gas_viscosity > 0);
    r[n++] = mpm__spray_rule_of("core_length", d->core_length, d->core_length >= 0);
    r[n++] = mpm__spray_rule_of("core_blend", d->core_blend,
                                !jet || (d->core_blend > 0 && d->core_blend <= mpm__spray_core(d)));
    r[n++] = mpm__spray_rule_of("gravity[0]", d->gravity[0], 1);
    r[n++] = mpm__spray_rule_of("gravity[1]", d->gravity[1], 1);
    r[n++] = mpm__spray_rule_of("gravity[2]", d->gravity[2], 1);
    return mpm__spray_judge(r, n, f);
}

static inline mpm_status mpm__spray_check_contact(const mpm_spray_desc *d, mpm_fault *f)
{
    mpm__spray_rule r[9];
    int n = 0;
    if (!(d->alpha >= 0)) /* may be infinite, so not judged with the rest */
        return mpm_fail(f, d->alpha < 0 ? MPM_ERR_ARGUMENT : MPM_ERR_NAN, "alpha", d->alpha, -1);
    r[n++] = mpm__spray_rule_of("friction", d->friction, d->friction >= 0);
    r[n++] = mpm__spray_rule_of("friction_speed", d->friction_speed, d->friction_speed > 0);
    r[n++] = mpm__spray_rule_of("restitution", d->restitution, d->restitution >= 0 && d->restitution <= 1);
    r[n++] = mpm__spray_rule_of("rebound", (mpm_real)d->rebound,
                                d->rebound >= 0 && d->rebound < MPM_SPRAY_REBOUNDS);
    r[n++] = mpm__spray_rule_of("contact", (mpm_real)d->contact, d->contact >= 0 && d->contact < MPM_SPRAY_CONTACTS);
    r[n++] = mpm__spray_rule_of("mixing", (mpm_real)d->mixing,
                                d->mixing >= 0 && d->mixing < MPM_SPRAY_MIXINGS);
    r[n++] = mpm__spray_rule_of("deposit", (mpm_real)d->deposit,
                                d->deposit >= 0 && d->deposit < MPM_SPRAY_DEPOSITS);
    r[n++] = mpm__spray_rule_of("gamma_target", d->gamma_target, d->gamma_target >= 0);
    r[n++] = mpm__spray_rule_of("gamma_deposit", d->gamma_deposit, d->gamma_deposit >= 0);
    return mpm__spray_judge(r, n, f);
}

static inline mpm_status mpm__spray_check_plane(const mpm_spray_plane *p, mpm_fault *f, int index)
{
    mpm_real normal = mpm__spray_length(p->normal), speed = mpm__spray_length(p->velocity);
    mpm__spray_rule r[3];
    mpm_status status;
    r[0] = mpm__spray_rule_of("normal of plane", normal, normal > 0);
    r[1] = mpm__spray_rule_of("velocity of plane", speed, !p->target || speed == 0);
    r[2] = mpm__spray_rule_of("point of plane", p->point[0] + p->point[1] + p->point[2], 1);
    if ((status = mpm__spray_judge(r, 3, f)) != MPM_OK && f) f->index = index;
    return status;
}

static inline mpm_status mpm__spray_check_domain(const mpm_spray_desc *d, mpm_fault *f)
{
    static const char *const low[3] = {"low[0]", "low[1]", "low[2]"};
    static const char *const high[3] = {"high[0]", "high[1]", "high[2]"};
    mpm__spray_rule r[8];
    mpm_status status;
    int n = 0, k;
    r[n++] = mpm__spray_rule_of("stand_off", d->stand_off, /* a target inside the nozzle */
                                d->plane_count > 0 || d->stand_off > mpm__spray_diameter_max(d));
    for (k = 0; k < 3; k++) {
        r[n++] = mpm__spray_rule_of(low[k], d->low[k], !(d->low[k] >= d->high[k]));
        r[n++] = mpm__spray_rule_of(high[k], d->high[k], d->high[k] > d->low[k]);
    }
    r[n++] = mpm__spray_rule_of("plane_count", (mpm_real)d->plane_count,
                                d->plane_count >= 0 && d->plane_count <= MPM_SPRAY_PLANES &&
                                    (d->plane_count == 0 || d->planes));
    if ((status = mpm__spray_judge(r, n, f)) != MPM_OK) return status;
    for (k = 0; k < d->plane_count; k++)
        if ((status = mpm__spray_check_plane(&d->planes[k], f, k)) != MPM_OK) return status;
    return MPM_OK;
}

static inline mpm_status mpm__spray_check_numbers(const mpm_spray_desc *d, mpm_fault *f)
{
    mpm__spray_rule r[12];
    /* The swept test takes the path of a step as straight: it must be short against the jet. */
    mpm_real fastest = mpm__spray_max(d->gas == MPM_SPRAY_GAS_STILL ? 0 : (mpm_real)fabs((double)d->gas_speed),
                                      d->release[1]);
    int n = 0;
    r[n++] = mpm__spray_rule_of("dt", d->dt, d->dt > 0 && d->dt * fastest <= d->nozzle_radius);
    r[n++] = mpm__spray_rule_of("feed", d->feed, d->batch == 0 || d->feed * d->dt < MPM_R(1e9)); /* a step's */
    r[n++] = mpm__spray_rule_of("theta", d->theta, d->theta >= 0 && d->theta <= 1);
    r[n++] = mpm__spray_rule_of("tolerance", d->tolerance, d->tolerance > 0);
    r[n++] = mpm__spray_rule_of("iterations", (mpm_real)d->iterations, d->iterations > 0);
    r[n++] = mpm__spray_rule_of("contacts_max", (mpm_real)d->contacts_max, d->contacts_max > 0);
    r[n++] = mpm__spray_rule_of("search", (mpm_real)d->search, d->search >= 0 && d->search < MPM_SPRAY_SEARCHES);
    r[n++] = mpm__spray_rule_of("capacity", (mpm_real)d->capacity, d->capacity > 0 && d->capacity < (1 << 30));
    r[n++] = mpm__spray_rule_of("total", (mpm_real)d->total, d->total >= 0);
    r[n++] = mpm__spray_rule_of("target_radius", d->target_radius, d->target_radius > 0);
    r[n++] = mpm__spray_rule_of("target_thickness", d->target_thickness, d->target_thickness > 0);
    r[n++] = mpm__spray_rule_of("late", d->late, d->late > 0 && d->late <= 1);
    return mpm__spray_judge(r, n, f);
}

MPM_API mpm_status mpm_spray_check(const mpm_spray_desc *d, mpm_fault *fault)
{
    mpm_status s;
    if (!d) return mpm_fail(fault, MPM_ERR_ARGUMENT, "desc (NULL)", 0, -1);
    if (d->mark != MPM_MARK)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "desc (not from mpm_spray_desc_default)", (mpm_real)d->mark, -1);
    if ((s = mpm__spray_check_solid(&d->particle, fault)) != MPM_OK) return s;
    if ((s = mpm__spray_check_solid(&d->target, fault)) != MPM_OK) return s;
    if ((s = mpm__spray_check_powder(d, fault)) != MPM_OK) return s;
    if ((s = mpm__spray_check_gas(d, fault)) != MPM_OK) return s;
    if ((s = mpm__spray_check_contact(d, fault)) != MPM_OK) return s;
    if ((s = mpm__spray_check_domain(d, fault)) != MPM_OK) return s;
    return mpm__spray_check_numbers(d, fault);
}

/* Slots of a hash table for n items: a power of two, at least 2 n. */
static inline uint32_t mpm__spray_slots(int32_t n)
{
    uint32_t slots = 64;
    while (slots < 2 * (uint32_t)n) slots *= 2;
    return slots;
}

/* Points the arrays into base and returns their bytes; with base NULL only counts. */
static inline size_t mpm__spray_layout(mpm_spray *s, char *base)
{
    size_t at = 0, n = (size_t)s->desc.capacity, slots = mpm__spray_slots(s->desc.capacity);
    const size_t real = sizeof(mpm_real), i32 = sizeof(int32_t), i64 = sizeof(int64_t);
    s->x = (mpm_real *)mpm_carve(base, &at, 3 * n, real);
    s->v = (mpm_real *)mpm_carve(base, &at, 3 * n, real);
    s->spin = (mpm_real *)mpm_carve(base, &at, 3 * n, real);
    s->radius = (mpm_real *)mpm_carve(base, &at, n, real);
    s->density = (mpm_real *)mpm_carve(base, &at, n, real);
    s->id = (int64_t *)mpm_carve(base, &at, n, i64);
    s->collisions = (int32_t *)mpm_carve(base, &at, n, i32);
    s->touches = (int32_t *)mpm_carve(base, &at, n, i32);
    s->drag = (mpm_real *)mpm_carve(base, &at, 3 * n, real);
    s->known = (int32_t *)mpm_carve(base, &at, n, i32);
    s->deposit_x = (mpm_real *)mpm_carve(base, &at, 3 * n, real);
    s->deposit_radius = (mpm_real *)mpm_carve(base, &at, n, real);
    s->deposit_time = (mpm_real *)mpm_carve(base, &at, n, real);
    s->deposit_id = (int64_t *)mpm_carve(base, &at, n, i64);
    s->deposit_collisions = (int32_t *)mpm_carve(base, &at, n, i32);
    s->path = (mpm_real *)mpm_carve(base, &at, 3 * n, real);
    s->middle = (mpm_real *)mpm_carve(base, &at, 3 * n, real);
    s->clock = (mpm_real *)mpm_carve(base, &at, n, real);
    s->when = (mpm_real *)mpm_carve(base, &at, n, real);
    s->kind = (int32_t *)mpm_carve(base, &at, n, i32);
    s->with = (int32_t *)mpm_carve(base, &at, n, i32);
    s->stamp = (int32_t *)mpm_carve(base, &at, n, i32);
    s->with_stamp = (int32_t *)mpm_carve(base, &at, n, i32);
    s->heap = (int32_t *)mpm_carve(base, &at, n, i32);
    s->slot = (int32_t *)mpm_carve(base, &at, n, i32);
    s->gone = (int32_t *)mpm_carve(base, &at, n, i32);
    s->list = (int32_t *)mpm_carve(base, &at, n, i32);
    s->rows.start = (int32_t *)mpm_carve(base, &at, slots + 1, i32);
    s->rows.place = (mpm_real *)mpm_carve(base, &at, 3 * n, real);
    s->rows.particle = (int32_t *)mpm_carve(base, &at, n, i32);
    s->inlet_bins.head = (int32_t *)mpm_carve(base, &at, slots, i32);
    s->inlet_bins.next = (int32_t *)mpm_carve(base, &at, n, i32);
    s->inlet_bins.where = (int32_t *)mpm_carve(base, &at, 3 * n, i32);
    s->deposit_bins.head = (int32_t *)mpm_carve(base, &at, slots, i32);
    s->deposit_bins.next = (int32_t *)mpm_carve(base, &at, n, i32);
    s->deposit_bins.where = (int32_t *)mpm_carve(base, &at, 3 * n, i32);
    return at;
}

MPM_API size_t mpm_spray_bytes(const mpm_spray_desc *d)
{
    mpm_spray s;
    size_t bytes;
    if (mpm_spray_check(d, NULL) != MPM_OK) return 0;
    s.desc = *d;
    bytes = mpm__spray_layout(&s, NULL);
    return bytes == (size_t)-1 ? 0 : bytes;
}

/* Copies the caller's planes, or makes the default target at right angles to the axis. */
static inline void mpm__spray_set_planes(mpm_spray *s)
{
    const mpm_spray_desc *d = &s->desc;
    int k, c;
    s->planes = d->plane_count > 0 ? d->plane_count : 1;
    s->plane[0].point[0] = d->stand_off;
    s->plane[0].normal[0] = -1;
    s->plane[0].target = 1;
    for (k = 0; k < d->plane_count; k++) {
        mpm_real length = mpm__spray_length(d->planes[k].normal);
        s->plane[k] = d->planes[k];
        for (c = 0; c < 3; c++) s->plane[k].normal[c] /= length;
    }
    s->desc.planes = NULL; /* the caller's array is not used after this */
}

static inline void mpm__spray_set_constants(mpm_spray *s)
{
    const mpm_spray_desc *d = &s->desc;
    s->modulus_target = mpm_spray_modulus(&d->particle, &d->target);
    s->modulus_pair = mpm_spray_modulus(&d->particle, &d->particle);
    s->yield_target = mpm__spray_min(d->particle.yield, d->target.yield);
    s->yield_pair = d->particle.yield;
    s->gamma_target = d->gamma_target > 0 ? d->gamma_target
        : mpm_spray_gamma12(d->mixing, d->particle.surface_energy, d->target.surface_energy);
    /* B 31 gives nothing between equal solids, so the deposit always takes the text's rule. */
    s->gamma_deposit = d->gamma_deposit > 0 ? d->gamma_deposit : 2 * d->particle.surface_energy;
    s->size_scale = mpm_spray_size_scale(2 * d->median_radius, d->size_shape);
    s->jet = mpm_spray_jet_make(d->gas_speed, d->nozzle_radius, mpm__spray_core(d), d->core_blend);
    s->tally.random = d->seed;
}

/* ---- bins ---------------------------------------------------------------------------------- */

static inline void mpm__spray_grid_clear(mpm_spray_grid *g, mpm_real cell, uint32_t slots)
{
    g->cell = cell;
    g->per_cell = 1 / cell;
    g->mask = slots - 1;
    g->count = 0;
    memset(g->head, 0xff, slots * sizeof *g->head); /* -1 */
}

static inline int32_t mpm__spray_cell(mpm_real x, mpm_real per_cell)
{
    mpm_real c = x * per_cell;
    int32_t i;
    if (!(c > MPM_R(-1e9))) return -1000000000; /* far away: all in one cell */
    if (c > MPM_R(1e9)) return 1000000000;
    i = (int32_t)c;
    return (mpm_real)i > c ? i - 1 : i; /* floor */
}

static inline uint32_t mpm__spray_hash(int32_t i, int32_t j, int32_t k)
{
    uint32_t h = (uint32_t)i * 0x9E3779B1u + (uint32_t)j * 0x85EBCA77u + (uint32_t)k * 0xC2B2AE3Du;
    return h ^ (h >> 15);
}

/* Adds item number g->count at x. */
static inline void mpm__spray_grid_add(mpm_spray_grid *g, const mpm_real *x)
{
    int32_t item = g->count++, *w = g->where + 3 * item;
    uint32_t h;
    w[0] = mpm__spray_cell(x[0], g->per_cell);
    w[1] = mpm__spray_cell(x[1], g->per_cell);
    w[2] = mpm__spray_cell(x[2], g->per_cell);
    h = mpm__spray_hash(w[0], w[1], w[2]) & g->mask;
    g->next[item] = g->head[h];
    g->head[h] = item;
}

/* Lists all of them. */
static inline int32_t mpm__spray_numbers(int32_t count, int32_t *list)
{
    int32_t i;
    for (i = 0; i < count; i++) list[i] = i;
    return count;
}

/* Lists the items whose cells meet the box low .. high (and so all whose place is in it). */
static inline int32_t mpm__spray_gather(const mpm_spray_grid *g, const mpm_real *low, const mpm_real *high,
                                        int32_t *list)
{
    int32_t a[3], b[3], n = 0, i, j, k, item;
    mpm_real cells = 1;
    int d;
    for (d = 0; d < 3; d++) {
        a[d] = mpm__spray_cell(low[d], g->per_cell);
        b[d] = mpm__spray_cell(high[d], g->per_cell);
        cells *= (mpm_real)(b[d] - a[d] + 1);
    }
    if (cells > 64 && cells > (mpm_real)g->count) return mpm__spray_numbers(g->count, list);
    for (i = a[0]; i <= b[0]; i++)
        for (j = a[1]; j <= b[1]; j++)
            for (k = a[2]; k <= b[2]; k++)
                for (item = g->head[mpm__spray_hash(i, j, k) & g->mask]; item >= 0; item = g->next[item]) {
                    const int32_t *w = g->where + 3 * item;
                    if (w[0] == i && w[1] == j && w[2] == k) list[n++] = item; /* slots are shared */
                }
    return n;
}

/* Lists the items in the box low .. high and some more, as desc.search has them found. Returns their number. */
static inline int32_t mpm__spray_list(mpm_spray *s, const mpm_spray_grid *g, const mpm_real *low, const mpm_real *high)
{
    return s->desc.search == MPM_SPRAY_BINS ? mpm__spray_gather(g, low, high, s->list)
                                            : mpm__spray_numbers(g->count, s->list);
}

/* The same for the box of `margin` around x. */
static inline int32_t mpm__spray_list_around(mpm_spray *s, const mpm_spray_grid *g, const mpm_real *x, mpm_real margin)
{
    mpm_real low[3], high[3];
    int d;
    for (d = 0; d < 3; d++) {
        low[d] = x[d] - margin;
        high[d] = x[d] + margin;
    }
    return mpm__spray_list(s, g, low, high);
}

/* ---- rows ---------------------------------------------------------------------------------- */

#define MPM__SPRAY_WIDER MPM_R(1.001) /* boxes by this: more than rounding takes from them */

static inline uint32_t mpm__spray_row(int32_t i, int32_t j)
{
    const uint32_t h = (uint32_t)i * 0x9E3779B1u + (uint32_t)j * 0x85EBCA77u;
    return h ^ (h >> 15);
}

static inline uint32_t mpm__spray_row_slot(const mpm_spray_rows *r, const mpm_real *x)
{
    const int32_t i = mpm__spray_cell(x[0], r->per_cell), j = mpm__spray_cell(x[1], r->per_cell);
    return (mpm__spray_row(i, j) + (uint32_t)mpm__spray_cell(x[2], r->per_cell)) & r->mask;
}

/* Enters `count` particles at x, in the order of their slots; `slot` is room for one number each. */
static inline void mpm__spray_rows_fill(mpm_spray_rows *r, mpm_real cell, uint32_t slots, const mpm_real *x,
                                        int32_t count, int32_t *slot)
{
    int32_t i, sum = 0;
    uint32_t h;
    r->per_cell = 1 / cell;
    r->mask = slots - 1;
    r->count = count;
    memset(r->start, 0, slots * sizeof *r->start);
    for (i = 0; i < count; i++) r->start[slot[i] = (int32_t)mpm__spray_row_slot(r, x + 3 * i)]++;
    for (h = 0; h < slots; h++) r->start[h] = sum += r->start[h];
    r->start[slots] = count;
    for (i = count - 1; i >= 0; i--) {
        const int32_t at = --r->start[slot[i]];
        memcpy(r->place + 3 * at, x + 3 * i, 3 * sizeof *x);
        r->particle[at] = i;
    }
}

/* Puts those of the slots from..to-1 that are in the box behind the n of a list. Returns how many there are then, -1 if
   there might be more than particles. */
static inline int32_t mpm__spray_rows_take(const mpm_spray_rows *r, uint32_t from, uint32_t to, const mpm_real *low,
                                           const mpm_real *high, int32_t *list, int32_t n)
{
    int32_t at;
    if (r->start[to] - r->start[from] > r->count - n) return -1;
    for (at = r->start[from]; at < r->start[to]; at++) {
        const mpm_real *x = r->place + 3 * at;
        list[n] = r->particle[at];
        n += (x[0] >= low[0]) & (x[0] <= high[0]) & (x[1] >= low[1]) & (x[1] <= high[1]) & (x[2] >= low[2]) &
             (x[2] <= high[2]);
    }
    return n;
}

/* Lists the particles that are binned in the box, some perhaps twice, or all there are. Returns their number. */
static inline int32_t mpm__spray_rows_gather(const mpm_spray_rows *r, const mpm_real *low, const mpm_real *high,
                                             int32_t *list)
{
    const uint32_t slots = r->mask + 1;
    int32_t a[3], b[3], n = 0, i, j;
    mpm_real cells = 1;
    int d;
    for (d = 0; d < 3; d++) {
        a[d] = mpm__spray_cell(low[d], r->per_cell);
        b[d] = mpm__spray_cell(high[d], r->per_cell);
        cells *= (mpm_real)(b[d] - a[d] + 1);
    }
    if (cells > 64 && cells > (mpm_real)r->count) return mpm__spray_numbers(r->count, list);
    for (i = a[0]; i <= b[0]; i++)
        for (j = a[1]; j <= b[1]; j++) {
            const uint32_t from = (mpm__spray_row(i, j) + (uint32_t)a[2]) & r->mask;
            const uint32_t to = from + (uint32_t)(b[2] - a[2]) + 1;
            n = mpm__spray_rows_take(r, from, to < slots ? to : slots, low, high, list, n);
            if (to > slots && n >= 0) n = mpm__spray_rows_take(r, 0, to - slots, low, high, list, n);
            if (n < 0) return mpm__spray_numbers(r->count, list); /* rows that share slots, met time and again */
        }
    return n;
}

/* ---- setting up ---------------------------------------------------------------------------- */

MPM_API mpm_status mpm_spray_init(mpm_spray *s, const mpm_spray_desc *d, void *memory, size_t bytes)
{
    mpm_status status;
    size_t need;
    memset(s, 0, sizeof *s);
    s->fault.index = -1;
    if ((status = mpm_spray_check(d, &s->fault)) != MPM_OK) return status;
    s->desc = *d;
    need = mpm__spray_layout(s, NULL);
    if ((status = mpm_want(!mpm_unaligned(memory), &s->fault, "memory (not aligned)", (mpm_real)mpm_unaligned(memory),
                           -1)) != MPM_OK)
        return status;
    if (need == (size_t)-1 || (memory && bytes < need))
        return mpm_fail(&s->fault, MPM_ERR_MEMORY, memory ? "bytes" : "capacity",
                               memory ? (mpm_real)bytes : (mpm_real)d->capacity, -1);
    s->memory = memory ? memory : MPM_MALLOC(need);
    s->owns_memory = !memory;
    if (!s->memory) return mpm_fail(&s->fault, MPM_ERR_MEMORY, "bytes", (mpm_real)need, -1);
    s->bytes = need;
    memset(s->memory, 0, need);
    mpm__spray_layout(s, (char *)s->memory);
    mpm__spray_set_planes(s);
    mpm__spray_set_constants(s);
    mpm__spray_grid_clear(&s->deposit_bins, 4 * d->median_radius, mpm__spray_slots(d->capacity));
    return MPM_OK;
}

MPM_API void mpm_spray_free(mpm_spray *s)
{
    if (s->owns_memory && s->memory) MPM_FREE(s->memory);
    s->memory = NULL;
    s->owns_memory = 0;
    s->live = s->deposited = 0;
}

/* A spray that was never prepared, or has been freed, has no arrays. */
static inline mpm_status mpm__spray_ready(mpm_spray *s)
{
    return s->memory ? MPM_OK : mpm_fail(&s->fault, MPM_ERR_ARGUMENT, "spray (not from mpm_spray_init)", 0, -1);
}

static inline mpm_status mpm__spray_check_ball(const mpm_spray_ball *b, mpm_fault *f)
{
    mpm__spray_rule r[5];
    r[0] = mpm__spray_rule_of("position of particle", b->x[0] + b->x[1] + b->x[2], 1);
    r[1] = mpm__spray_rule_of("velocity of particle", b->v[0] + b->v[1] + b->v[2], 1);
    r[2] = mpm__spray_rule_of("spin of particle", b->spin[0] + b->spin[1] + b->spin[2], 1);
    r[3] = mpm__spray_rule_of("radius of particle", b->radius, b->radius > 0);
    r[4] = mpm__spray_rule_of("density of particle", b->density, b->density > 0);
    return mpm__spray_judge(r, 5, f);
}

static inline void mpm__spray_get(const mpm_spray *s, int32_t i, mpm_spray_ball *b)
{
    memcpy(b->x, s->x + 3 * i, sizeof b->x);
    memcpy(b->v, s->v + 3 * i, sizeof b->v);
    memcpy(b->spin, s->spin + 3 * i, sizeof b->spin);
    b->radius = s->radius[i];
    b->density = s->density[i];
}

static inline void mpm__spray_put(mpm_spray *s, int32_t i, const mpm_spray_ball *b)
{
    memcpy(s->x + 3 * i, b->x, sizeof b->x);
    memcpy(s->v + 3 * i, b->v, sizeof b->v);
    memcpy(s->spin + 3 * i, b->spin, sizeof b->spin);
    s->radius[i] = b->radius;
    s->density[i] = b->density;
    s->known[i] = 0;
}

MPM_API mpm_status mpm_spray_add(mpm_spray *s, const mpm_spray_ball *ball)
{
    mpm_status status = mpm__spray_ready(s);
    int32_t i = s->live;
    if (status == MPM_OK) status = mpm__spray_check_ball(ball, &s->fault);
    if (status != MPM_OK) return status;
    if (s->live + s->deposited >= s->desc.capacity) /* so that the deposit can never overflow */
        return mpm_fail(&s->fault, MPM_ERR_FULL, "capacity", (mpm_real)s->desc.capacity, -1);
    mpm__spray_put(s, i, ball);
    s->id[i] = s->tally.injected++;
    s->collisions[i] = s->touches[i] = 0;
    s->live++;
    return MPM_OK;
}

/* ---- inject -------------------------------------------------------------------------------- */

/* Batch k is due in the step that contains t = k batch / feed; the sliver absorbs rounding. */
static inline void mpm__spray_feed(mpm_spray *s)
{
    const mpm_spray_desc *d = &s->desc;
    double per_step = (double)d->dt * (double)d->feed / d->batch;
    int64_t due = (int64_t)(((double)s->tally.step + 1e-3) * per_step) + 1;
    if (s->tally.batches < due) {
        s->tally.pending += (due - s->tally.batches) * d->batch;
        s->tally.batches = due;
    }
    if (d->total > 0 && s->tally.injected + s->tally.pending > d->total)
        s->tally.pending = d->total > s->tally.injected ? d->total - s->tally.injected : 0;
}

/* Size and speed of the next particle. They are kept until it has found a place: drawing again
   after a failure would favour the small. */
static inline void mpm__spray_draw(mpm_spray *s)
{
    const mpm_spray_desc *d = &s->desc;
    mpm_real u = mpm_spray_random(&s->tally.random);
    mpm_real size = mpm_spray_size(u, s->size_scale, d->size_shape, d->diameter_min, mpm__spray_diameter_max(d));
    u = mpm_spray_random(&s->tally.random);
    s->tally.wait_radius = (double)(size / 2);
    s->tally.wait_speed = (double)(d->release[0] + u * (d->release[1] - d->release[0]));
}

/* A random place of the inlet disc, the whole sphere inside it. */
static inline void mpm__spray_place(mpm_spray *s, mpm_spray_ball *b)
{
    mpm_real r = (s->desc.nozzle_radius - b->radius) * mpm__spray_sqrt(mpm_spray_random(&s->tally.random));
    double angle = 2 * (double)MPM_PI * (double)mpm_spray_random(&s->tally.random);
    b->x[0] = 0;
    b->x[1] = r * (mpm_real)cos(angle);
    b->x[2] = r * (mpm_real)sin(angle);
}

/* Puts those in flight into the bins as they stand, for the places of those that wait; the step bins them anew along
   their paths. radius_max is then the largest in flight. */
static inline void mpm__spray_bin_places(mpm_spray *s)
{
    const int64_t most = s->live + s->tally.pending, room = s->desc.capacity;
    const uint32_t slots = mpm__spray_slots((int32_t)(most < room ? most : room));
    int32_t i;
    s->radius_max = 0;
    mpm__spray_grid_clear(&s->inlet_bins, 4 * s->desc.median_radius, slots);
    for (i = 0; i < s->live; i++) {
        s->radius_max = mpm__spray_max(s->radius_max, s->radius[i]);
        mpm__spray_grid_add(&s->inlet_bins, s->x + 3 * i);
    }
}

static inline int mpm__spray_place_free(mpm_spray *s, const mpm_spray_ball *b)
{
    /* by more than rounding can take from it */
    const mpm_real margin = MPM_R(1.001) * (b->radius + s->radius_max) + 8 * MPM_EPSILON * s->desc.nozzle_radius;
    const int32_t n = mpm__spray_list_around(s, &s->inlet_bins, b->x, margin);
    int32_t k;
    for (k = 0; k < n; k++) {
        const mpm_real *x = s->x + 3 * s->list[k];
        mpm_real d0 = x[0] - b->x[0], d1 = x[1] - b->x[1], d2 = x[2] - b->x[2];
        mpm_real reach = s->radius[s->list[k]] + b->radius;
        if (d0 * d0 + d1 * d1 + d2 * d2 <= reach * reach) return 0;
    }
    return 1;
}

MPM_API mpm_status mpm_spray_inject(mpm_spray *s)
{
    if (mpm__spray_ready(s) != MPM_OK) return MPM_ERR_ARGUMENT;
    if (s->desc.batch == 0) return MPM_OK;
    mpm__spray_feed(s);
    if (s->tally.pending == 0) return MPM_OK;
    mpm__spray_bin_places(s);
    while (s->tally.pending > 0) {
        mpm_spray_ball b;
        mpm_status status;
        int tries = 0;
        memset(&b, 0, sizeof b);
        if (!(s->tally.wait_radius > 0)) mpm__spray_draw(s);
        b.radius = (mpm_real)s->tally.wait_radius;
        b.density = s->desc.density;
        b.v[0] = (mpm_real)s->tally.wait_speed;
        do mpm__spray_place(s, &b);
        while (!mpm__spray_place_free(s, &b) && ++tries < MPM__SPRAY_TRIES);
        if (tries == MPM__SPRAY_TRIES) return MPM_OK; /* no room: it waits */
        if ((status = mpm_spray_add(s, &b)) != MPM_OK) return status;
        mpm__spray_grid_add(&s->inlet_bins, s->x + 3 * (s->live - 1));
        s->radius_max = mpm__spray_max(s->radius_max, b.radius);
        s->tally.wait_radius = 0;
        s->tally.pending--;
    }
    return MPM_OK;
}

/* ---- fly ----------------------------------------------------------------------------------- */

#define MPM__SPRAY_BLOCK 32 /* particles that are worked on together */

/* How many, from particle i on. */
static inline int mpm__spray_block(const mpm_spray *s, int32_t i)
{
    return (int)(s->live - i < MPM__SPRAY_BLOCK ? s->live - i : MPM__SPRAY_BLOCK);
}

/* Where one particle is, and how it moves there. */
typedef struct mpm__spray_state {
    mpm_real x[3], v[3];
} mpm__spray_state;

/* What the gas does to it there. */
typedef struct mpm__spray_pull {
    mpm_real gas[3], acceleration[3]; /* the gas's velocity; by drag (B 24) and gravity */
    mpm_real rate;                    /* of the drag */
} mpm__spray_pull;

/* Pulls on a block of n particles, each in its state. Gas and drag take long to work out, one thing from the other: in
   loops of their own a processor has several particles in hand. */
static inline void mpm__spray_pulls(const mpm_spray *s, mpm_real time, const int32_t *i, const mpm__spray_state *at,
                                    mpm__spray_pull *pull, int n)
{
    const mpm_spray_desc *d = &s->desc;
    mpm_real slip[3], speed[MPM__SPRAY_BLOCK];
    int m, k;
    for (m = 0; m < n; m++) mpm__spray_gas_at(s, time, at[m].x, pull[m].gas);
    for (m = 0; m < n; m++) {
        for (k = 0; k < 3; k++) slip[k] = pull[m].gas[k] - at[m].v[k];
        speed[m] = mpm__spray_length(slip);
    }
    for (m = 0; m < n; m++)
        pull[m].rate = mpm_spray_drag_rate(speed[m], s->radius[i[m]], s->density[i[m]], d->gas_density,
                                           d->gas_viscosity);
    for (m = 0; m < n; m++)
        for (k = 0; k < 3; k++)
            pull[m].acceleration[k] = pull[m].rate * (pull[m].gas[k] - at[m].v[k]) + d->gravity[k];
}

/* The exact motion with gas velocity and drag rate held at their values at the start. It cannot
   overshoot, whatever dt; used for dust, whose relaxation time is not long against dt. */
static inline void mpm__spray_relax(const mpm_spray *s, const mpm__spray_state *from, const mpm_real *gas,
                                    mpm_real rate, mpm__spray_state *to)
{
    mpm_real dt = s->desc.dt, decay = mpm__spray_exp(-rate * dt);
    int k;
    for (k = 0; k < 3; k++) {
        mpm_real final = gas[k] + s->desc.gravity[k] / rate, excess = from->v[k] - final;
        to->v[k] = final + excess * decay;
        to->x[k] = from->x[k] + final * dt + excess * (1 - decay) / rate;
    }
}

/* B 42, 43 for given accelerations at both ends: writes `to`, and tells whether the relative change
   against what was there is within the tolerance. The paper's measure (B 53) adds m/s to m, is 0/0
   for a particle that did not change, and its loop runs while the error is small; here velocity
   (against the speed) and position (against the way of the step) are judged apart, and the loop runs
   while it is large. */
static inline int mpm__spray_theta(const mpm_spray *s, const mpm__spray_state *from, const mpm_real *a0,
                                   const mpm_real *a1, mpm__spray_state *to)
{
    mpm_real dt = s->desc.dt, theta = s->desc.theta;
    mpm_real tolerance = mpm__spray_max(s->desc.tolerance, 8 * MPM_EPSILON);
    mpm_real dv = 0, dx = 0, speed = 0, way = 0, rounding;
    int k;
    for (k = 0; k < 3; k++) {
        mpm_real v = from->v[k] + dt * (theta * a1[k] + (1 - theta) * a0[k]);
        mpm_real step = dt * (theta * v + (1 - theta) * from->v[k]), x = from->x[k] + step;
        dv += (v - to->v[k]) * (v - to->v[k]);
        dx += (x - to->x[k]) * (x - to->x[k]);
        speed += v * v;
        way += step * step;
        to->v[k] = v;
        to->x[k] = x;
    }
    rounding = 16 * MPM_EPSILON * MPM_EPSILON * mpm__spray_dot(to->x, to->x); /* of x: not a change */
    return dv <= tolerance * tolerance * speed && dx <= tolerance * tolerance * way + rounding;
}

/* The start of one particle's step: a first guess of its end. Returns 1 if the fixed point is to be iterated, 0 if that
   was all. */
static inline int mpm__spray_set_off(mpm_spray *s, int32_t i, const mpm__spray_state *from, mpm__spray_state *to)
{
    const mpm_spray_desc *d = &s->desc;
    mpm_real *a = s->drag + 3 * i;
    mpm__spray_pull pull;
    int k;
    if (!s->known[i]) {
        mpm__spray_pulls(s, mpm_spray_time(s), &i, from, &pull, 1);
        memcpy(a, pull.acceleration, sizeof pull.acceleration);
        if (pull.rate * d->dt > MPM_R(0.5)) { /* B 51 would contract slowly or not at all */
            mpm__spray_relax(s, from, pull.gas, pull.rate, to);
            s->tally.exponential++;
            return 0;
        }
    }
    s->known[i] = 0;
    for (k = 0; k < 3; k++) { /* first guess: constant acceleration */
        to->v[k] = from->v[k] + d->dt * a[k];
        to->x[k] = from->x[k] + d->dt * (d->theta * to->v[k] + (1 - d->theta) * from->v[k]);
    }
    return d->theta > 0; /* explicit: nothing to iterate */
}

/* The fixed point, from the first guess and the pull there. What it ends with is the acceleration at the end of the
   step, to within the tolerance, and the next step begins with it: halves the work where nothing is hit.
   Returns MPM_NOT_CONVERGED after falling back to mpm__spray_relax. */
static inline mpm_status mpm__spray_iterate(mpm_spray *s, int32_t i, const mpm__spray_state *from,
                                            mpm__spray_state *to, mpm__spray_pull *pull)
{
    const mpm_spray_desc *d = &s->desc;
    mpm_real time = mpm_spray_time(s), *a = s->drag + 3 * i;
    int k;
    for (k = 0; k < d->iterations; k++) {
        if (k > 0) mpm__spray_pulls(s, time + d->dt, &i, to, pull, 1);
        if (mpm__spray_theta(s, from, a, pull->acceleration, to)) {
            memcpy(a, pull->acceleration, sizeof pull->acceleration);
            s->known[i] = pull->rate * d->dt <= MPM_R(0.5);
            return MPM_OK;
        }
    }
    mpm__spray_pulls(s, time, &i, from, pull, 1);
    mpm__spray_relax(s, from, pull->gas, mpm__spray_max(pull->rate, MPM_EPSILON / d->dt), to);
    s->tally.not_converged++;
    return MPM_NOT_CONVERGED;
}

MPM_API mpm_real mpm_spray_time(const mpm_spray *s)
{
    return (mpm_real)((double)s->tally.step * (double)s->desc.dt);
}

/* Velocity at the end of the step and the straight path there. */
static inline mpm_status mpm__spray_take(mpm_spray *s, int32_t i, const mpm__spray_state *from,
                                         const mpm__spray_state *to)
{
    const mpm_real per_step = 1 / s->desc.dt;
    mpm_real sum = 0;
    int k;
    for (k = 0; k < 3; k++) {
        sum += to->v[k] + to->x[k];
        s->path[3 * i + k] = (to->x[k] - from->x[k]) * per_step;
        s->v[3 * i + k] = to->v[k];
    }
    return mpm_finite(sum) ? MPM_OK : mpm_fail(&s->fault, MPM_ERR_NAN, "velocity of particle", sum, s->id[i]);
}

/* ... of `count` particles from `first` on. */
static inline mpm_status mpm__spray_fly_block(mpm_spray *s, int32_t first, int count)
{
    mpm__spray_state from[MPM__SPRAY_BLOCK], to[MPM__SPRAY_BLOCK];
    mpm__spray_pull pull[MPM__SPRAY_BLOCK];
    int32_t particle[MPM__SPRAY_BLOCK];
    mpm_status result = MPM_OK, status;
    int m, k, n = 0;
    for (m = 0; m < count; m++) {
        const int32_t i = first + m;
        for (k = 0; k < 3; k++) {
            from[n].x[k] = s->x[3 * i + k];
            from[n].v[k] = s->v[3 * i + k];
        }
        particle[n] = i;
        if (mpm__spray_set_off(s, i, &from[n], &to[n])) n++;
        else if ((status = mpm__spray_take(s, i, &from[n], &to[n])) < 0) return status;
    }
    if (n > 0) mpm__spray_pulls(s, mpm_spray_time(s) + s->desc.dt, particle, to, pull, n);
    for (m = 0; m < n; m++) {
        if (mpm__spray_iterate(s, particle[m], &from[m], &to[m], &pull[m]) != MPM_OK) result = MPM_NOT_CONVERGED;
        if ((status = mpm__spray_take(s, particle[m], &from[m], &to[m])) < 0) return status;
    }
    return result;
}

MPM_API mpm_status mpm_spray_fly(mpm_spray *s)
{
    mpm_status result = MPM_OK, status;
    int32_t i;
    for (i = 0; i < s->live; i += MPM__SPRAY_BLOCK) {
        status = mpm__spray_fly_block(s, i, mpm__spray_block(s, i));
        if (status < 0) return status;
        if (status != MPM_OK) result = status;
    }
    s->tally.particle_steps += s->live;
    return result;
}

/* ---- bin ----------------------------------------------------------------------------------- */

/* The edge of the bins. A particle is binned at the middle of its path, so it is never farther from there than `reach`,
   and the box around another's path is widened by that: any edge finds every contact. With this one the box meets two
   bins along each axis, at most. */
static inline mpm_real mpm__spray_bin_edge(const mpm_spray *s)
{
    return mpm__spray_max(MPM__SPRAY_WIDER * 4 * (s->radius_max + s->reach), MPM_R(1e-12));
}

MPM_API void mpm_spray_bin(mpm_spray *s)
{
    mpm_real fastest = 0, dt = s->desc.dt, largest = 0;
    int32_t i;
    int k;
    if (!s->memory) return;
    for (i = 0; i < s->live; i++) {
        for (k = 0; k < 3; k++) s->middle[3 * i + k] = s->x[3 * i + k] + dt / 2 * s->path[3 * i + k];
        fastest = mpm__spray_max(fastest, mpm__spray_dot(s->path + 3 * i, s->path + 3 * i));
        largest = mpm__spray_max(largest, s->radius[i]);
        s->clock[i] = 0;
        s->stamp[i] = s->gone[i] = 0;
        s->kind[i] = MPM__SPRAY_NOTHING;
        s->slot[i] = -1;
    }
    s->reach = mpm__spray_sqrt(fastest) * dt * (MPM_R(0.5) + 4 * MPM_EPSILON);
    s->radius_max = largest;
    s->heap_count = 0;
    mpm__spray_rows_fill(&s->rows, mpm__spray_bin_edge(s), mpm__spray_slots(s->live), s->middle, s->live, s->list);
}

/* ---- contacts in order of time ------------------------------------------------------------- */

/* The heap holds the particles that have a contact ahead, the earliest at 0. */
static inline int mpm__spray_before(const mpm_spray *s, int32_t a, int32_t b)
{
    return s->when[a] < s->when[b] || (s->when[a] == s->when[b] && a < b);
}

static inline void mpm__spray_heap_put(mpm_spray *s, int32_t at, int32_t i)
{
    s->heap[at] = i;
    s->slot[i] = at;
}

/* Lets particle i, meant for place `at`, rise or sink to where it belongs. */
static inline void mpm__spray_heap_settle(mpm_spray *s, int32_t at, int32_t i)
{
    while (at > 0 && mpm__spray_before(s, i, s->heap[(at - 1) / 2])) {
        mpm__spray_heap_put(s, at, s->heap[(at - 1) / 2]);
        at = (at - 1) / 2;
    }
    for (;;) {
        int32_t child = 2 * at + 1;
        if (child >= s->heap_count) break;
        if (child + 1 < s->heap_count && mpm__spray_before(s, s->heap[child + 1], s->heap[child])) child++;
        if (!mpm__spray_before(s, s->heap[child], i)) break;
        mpm__spray_heap_put(s, at, s->heap[child]);
        at = child;
    }
    mpm__spray_heap_put(s, at, i);
}

/* Enters, moves or removes particle i after its next contact has changed. */
static inline void mpm__spray_heap_update(mpm_spray *s, int32_t i)
{
    int32_t at = s->slot[i];
    if (s->kind[i] != MPM__SPRAY_NOTHING) {
        mpm__spray_heap_settle(s, at >= 0 ? at : s->heap_count++, i);
    } else if (at >= 0) {
        int32_t last = s->heap[--s->heap_count];
        s->slot[i] = -1;
        if (last != i) mpm__spray_heap_settle(s, at, last);
    }
}

/* ---- find ---------------------------------------------------------------------------------- */

/* Time until two spheres touch whose centres differ by x and drift apart with w, if that is within
   `left`; else NEVER. The nearer root of |x + w t| = reach, in the form that does not cancel. */
static inline mpm_real mpm__spray_meet(const mpm_spray *s, const mpm_real *x, const mpm_real *w,
                                       mpm_real reach, mpm_real left)
{
    mpm_real b = mpm__spray_dot(x, w), c = mpm__spray_dot(x, x) - reach * reach, a, root, t;
    if (s->desc.contact == MPM_SPRAY_OVERLAP) { /* only the end of the step is looked at */
        a = mpm__spray_dot(w, w);
        return b + a * left < 0 && c + 2 * b * left + a * left * left <= 0 ? left : MPM__SPRAY_NEVER;
    }
    if (!(b < 0)) return MPM__SPRAY_NEVER;          /* drifting apart (B 40) */
    if (c <= 0) return 0;                           /* touching already */
    if (c > -2 * b * left) return MPM__SPRAY_NEVER; /* too far: the root below is at least -c / 2b */
    a = mpm__spray_dot(w, w);
    root = b * b - a * c;
    if (root < 0) return MPM__SPRAY_NEVER;          /* passing by */
    t = c / (mpm__spray_sqrt(root) - b);
    return t <= left ? t : MPM__SPRAY_NEVER;
}

/* The same for a plane at signed distance `gap`, changing at rate w. (B 41 has the distance without
   its sign and asks for no approach: it would miss a particle that is past the plane.) */
static inline mpm_real mpm__spray_meet_plane(const mpm_spray *s, mpm_real gap, mpm_real w, mpm_real left)
{
    mpm_real t;
    if (!(w < 0)) return MPM__SPRAY_NEVER;
    if (s->desc.contact == MPM_SPRAY_OVERLAP) return gap + w * left <= 0 ? left : MPM__SPRAY_NEVER;
    if (gap > -2 * w * left) return MPM__SPRAY_NEVER; /* too far, by more than rounding */
    t = gap > 0 ? -gap / w : 0;
    return t <= left ? t : MPM__SPRAY_NEVER;
}

/* Offers particle i a contact; it keeps the earliest. Ties are decided by what it is with, so the
   order in which contacts are offered does not matter. */
static inline void mpm__spray_offer(mpm_spray *s, int32_t i, mpm_real when, int32_t kind, int32_t with)
{
    if (when > s->desc.dt) return;
    if (s->kind[i] != MPM__SPRAY_NOTHING) {
        if (when > s->when[i]) return;
        if (when == s->when[i] && (kind > s->kind[i] || (kind == s->kind[i] && with >= s->with[i]))) return;
    }
    s->when[i] = when;
    s->kind[i] = kind;
    s->with[i] = with;
    s->with_stamp[i] = kind == MPM__SPRAY_PAIR ? s->stamp[with] : 0;
}

static inline void mpm__spray_offer_plane(mpm_spray *s, int32_t i, int k)
{
    const mpm_spray_plane *p = &s->plane[k];
    mpm_real gap = -s->radius[i], w = 0, clock = s->clock[i];
    int d;
    for (d = 0; d < 3; d++) {
        gap += p->normal[d] * (s->x[3 * i + d] - p->point[d] - clock * p->velocity[d]);
        w += p->normal[d] * (s->path[3 * i + d] - p->velocity[d]);
    }
    mpm__spray_offer(s, i, clock + mpm__spray_meet_plane(s, gap, w, s->desc.dt - clock), MPM__SPRAY_PLANE, k);
}

static inline void mpm__spray_offer_deposit(mpm_spray *s, int32_t i, int32_t host)
{
    mpm_real x[3], clock = s->clock[i];
    int d;
    for (d = 0; d < 3; d++) x[d] = s->x[3 * i + d] - s->deposit_x[3 * host + d];
    mpm__spray_offer(s, i, clock + mpm__spray_meet(s, x, s->path + 3 * i,
                                                   s->radius[i] + s->deposit_radius[host], s->desc.dt - clock),
                     MPM__SPRAY_DEPOSIT, host);
}

static inline void mpm__spray_offer_pair(mpm_spray *s, int32_t i, int32_t j)
{
    const mpm_real *xi = s->x + 3 * i, *xj = s->x + 3 * j, *wi = s->path + 3 * i, *wj = s->path + 3 * j;
    mpm_real now = mpm__spray_max(s->clock[i], s->clock[j]);
    mpm_real ti = now - s->clock[i], tj = now - s->clock[j];
    mpm_real w[3], x[3]; /* spelt out below: this is where a dense spray spends its time */
    w[0] = wi[0] - wj[0];
    w[1] = wi[1] - wj[1];
    w[2] = wi[2] - wj[2];
    x[0] = xi[0] + ti * wi[0] - xj[0] - tj * wj[0];
    x[1] = xi[1] + ti * wi[1] - xj[1] - tj * wj[1];
    x[2] = xi[2] + ti * wi[2] - xj[2] - tj * wj[2];
    mpm__spray_offer(s, i, now + mpm__spray_meet(s, x, w, s->radius[i] + s->radius[j], s->desc.dt - now),
                     MPM__SPRAY_PAIR, j);
}

/* The box around the rest of particle i's path, widened by `margin`. */
static inline void mpm__spray_path_box(const mpm_spray *s, int32_t i, mpm_real margin, mpm_real *low,
                                       mpm_real *high)
{
    mpm_real left = s->desc.dt - s->clock[i];
    int d;
    for (d = 0; d < 3; d++) {
        mpm_real a = s->x[3 * i + d], b = a + left * s->path[3 * i + d];
        low[d] = mpm__spray_min(a, b) - margin;
        high[d] = mpm__spray_max(a, b) + margin;
    }
}

/* ... so that whatever particle i may touch in flight is binned in it. */
static inline void mpm__spray_flight_box(const mpm_spray *s, int32_t i, mpm_real *low, mpm_real *high)
{
    mpm__spray_path_box(s, i, MPM__SPRAY_WIDER * (s->radius[i] + s->radius_max + s->reach), low, high);
}

static inline void mpm__spray_look_at_deposit(mpm_spray *s, int32_t i)
{
    mpm_real low[3], high[3];
    int32_t n, k;
    int d;
    if (s->deposited == 0 || s->desc.deposit == MPM_SPRAY_DEPOSIT_IGNORE) return;
    mpm__spray_path_box(s, i, s->radius[i] + s->deposit_radius_max, low, high);
    for (d = 0; d < 3; d++)
        if (low[d] > s->deposit_high[d] || high[d] < s->deposit_low[d]) return;
    n = mpm__spray_list(s, &s->deposit_bins, low, high);
    for (k = 0; k < n; k++) mpm__spray_offer_deposit(s, i, s->list[k]);
}

/* The partners of particle i. In the first round a pair is looked at from its lower number only;
   later every partner counts, since only i's path has changed. */
static inline void mpm__spray_look_at_flight(mpm_spray *s, int32_t i, int first_round)
{
    mpm_real low[3], high[3];
    int32_t j, n, k, first = first_round ? i + 1 : 0;
    if (s->desc.search == MPM_SPRAY_ALL_PAIRS) {
        for (j = first; j < s->live; j++)
            if (j != i && !s->gone[j]) mpm__spray_offer_pair(s, i, j);
        return;
    }
    mpm__spray_flight_box(s, i, low, high);
    n = mpm__spray_rows_gather(&s->rows, low, high, s->list);
    for (k = 0; k < n; k++) {
        j = s->list[k];
        if (j >= first && j != i && !s->gone[j]) mpm__spray_offer_pair(s, i, j);
    }
}

static inline void mpm__spray_look_at_fixed(mpm_spray *s, int32_t i)
{
    int k;
    for (k = 0; k < s->planes; k++) mpm__spray_offer_plane(s, i, k);
    mpm__spray_look_at_deposit(s, i);
}

/* Finds the next contact of particle i, whose path has changed. */
static inline void mpm__spray_look(mpm_spray *s, int32_t i)
{
    s->kind[i] = MPM__SPRAY_NOTHING;
    if (s->stamp[i] < s->desc.contacts_max) { /* else it has stopped for this step: see set_out */
        mpm__spray_look_at_fixed(s, i);
        mpm__spray_look_at_flight(s, i, 0);
    }
    mpm__spray_heap_update(s, i);
}

#define MPM__SPRAY_ROOM (16 * MPM__SPRAY_BLOCK + 4) /* four places of four rows each, and what is written beyond */

/* Places of rows that the boxes of a block meet. */
typedef struct mpm__spray_notes {
    mpm_real low[MPM__SPRAY_BLOCK][3], high[MPM__SPRAY_BLOCK][3];
    int32_t at[MPM__SPRAY_ROOM], of[MPM__SPRAY_ROOM]; /* the place, whose box */
    int n;
} mpm__spray_notes;

/* Notes the places in the bins that box m meets, two or fewer along each axis. Returns 0 if it meets more, or there are
   too many. Most runs are of no, one or two places, in no order that a processor could guess: so without asking, four
   are written, and those that are there are counted. */
static inline int mpm__spray_note(mpm__spray_notes *p, const mpm_spray_rows *r, int m)
{
    int32_t a[3], b[3];
    int d, c, n = p->n;
    for (d = 0; d < 3; d++) {
        a[d] = mpm__spray_cell(p->low[m][d], r->per_cell);
        b[d] = mpm__spray_cell(p->high[m][d], r->per_cell);
        if (b[d] - a[d] > 1) return 0;
    }
    for (c = 0; c < 4; c++) {
        const int again = ((c & 1) & (a[0] == b[0])) | ((c >> 1) & (a[1] == b[1]));
        const uint32_t from = (mpm__spray_row(c & 1 ? b[0] : a[0], c >> 1 ? b[1] : a[1]) + (uint32_t)a[2]) & r->mask;
        const uint32_t to = from + (uint32_t)(b[2] - a[2]) + 1;
        int32_t at, run;
        if (to > r->mask + 1) return 0; /* the run goes on at the first slot */
        at = r->start[from];
        run = (1 - again) * (r->start[to] - at);
        if (run > 4) return 0;
        for (d = 0; d < 4; d++) {
            p->at[n + d] = at + d;
            p->of[n + d] = m;
        }
        n += run;
    }
    p->n = n;
    return 1;
}

/* Offers the pairs that were noted, to the lower number of the two, if the higher is binned in the lower's box. */
static inline void mpm__spray_offer_noted(mpm_spray *s, int32_t first, mpm__spray_notes *p)
{
    const mpm_spray_rows *r = &s->rows;
    int k, kept = 0;
    for (k = 0; k < p->n; k++) {
        const int32_t at = p->at[k], m = p->of[k];
        const mpm_real *x = r->place + 3 * at, *low = p->low[m], *high = p->high[m];
        p->at[kept] = at;
        p->of[kept] = m;
        kept += (r->particle[at] > first + m) & (x[0] >= low[0]) & (x[0] <= high[0]) & (x[1] >= low[1]) &
                (x[1] <= high[1]) & (x[2] >= low[2]) & (x[2] <= high[2]);
    }
    for (k = 0; k < kept; k++) mpm__spray_offer_pair(s, first + p->of[k], r->particle[p->at[k]]);
}

/* First contacts of `count` particles from `first` on. */
static inline void mpm__spray_find_block(mpm_spray *s, int32_t first, int count)
{
    mpm__spray_notes p;
    int m;
    p.n = 0;
    for (m = 0; m < count; m++) {
        const int32_t i = first + m;
        mpm__spray_look_at_fixed(s, i);
        mpm__spray_flight_box(s, i, p.low[m], p.high[m]);
        if (s->desc.search == MPM_SPRAY_ALL_PAIRS || !mpm__spray_note(&p, &s->rows, m))
            mpm__spray_look_at_flight(s, i, 1);
    }
    mpm__spray_offer_noted(s, first, &p);
    for (m = 0; m < count; m++) mpm__spray_heap_update(s, first + m);
}

MPM_API void mpm_spray_find(mpm_spray *s)
{
    int32_t i;
    for (i = 0; i < s->live; i += MPM__SPRAY_BLOCK)
        mpm__spray_find_block(s, i, mpm__spray_block(s, i));
}

/* ---- resolve ------------------------------------------------------------------------------- */

static inline void mpm__spray_go_to(mpm_spray *s, int32_t i, mpm_real when)
{
    int d;
    for (d = 0; d < 3; d++) s->x[3 * i + d] += (when - s->clock[i]) * s->path[3 * i + d];
    s->clock[i] = when;
}

/* After a contact the path follows the new velocity. A particle with contacts_max contacts in one
   step (caught between others that push) stays where it is for the rest of the step: it still
   cannot pass through anything, and the step ends. */
static inline void mpm__spray_set_out(mpm_spray *s, int32_t i)
{
    mpm_real left = s->desc.dt - s->clock[i], far2 = 0, off;
    int d, stop = ++s->stamp[i] >= s->desc.contacts_max;
    s->known[i] = 0;
    if (s->stamp[i] == s->desc.contacts_max) s->tally.capped++;
    for (d = 0; d < 3; d++) {
        s->path[3 * i + d] = stop ? 0 : s->v[3 * i + d];
        off = s->x[3 * i + d] - s->middle[3 * i + d];
        far2 += off * off;
    }
    /* It may now get farther from the place it is binned at. */
    s->reach = mpm__spray_max(s->reach, mpm__spray_sqrt(far2) + left * mpm__spray_length(s->path + 3 * i));
}

static inline mpm_real mpm__spray_bounce(const mpm_spray *s, mpm_real speed, mpm_real mass, mpm_real radius,
                                         mpm_real yield, mpm_real modulus)
{
    return s->desc.rebound == MPM_SPRAY_REBOUND_CONSTANT
               ? s->desc.restitution
               : mpm_spray_restitution(speed, mass, radius, yield, modulus);
}

static inline void mpm__spray_count_collision(mpm_spray *s, int32_t i)
{
    if (s->collisions[i]++ == 0) s->tally.collided++;
}

static inline void mpm__spray_hit_pair(mpm_spray *s, int32_t i, int32_t j)
{
    mpm_spray_ball a, b;
    mpm_real n[3], u[3], length, speed, ma, mb, e;
    int d;
    mpm__spray_get(s, i, &a);
    mpm__spray_get(s, j, &b);
    for (d = 0; d < 3; d++) {
        n[d] = a.x[d] - b.x[d];
        u[d] = b.v[d] - a.v[d];
    }
    length = mpm__spray_length(n);
    speed = length > 0 ? mpm__spray_dot(u, n) / length : 0;
    if (speed > 0) { /* else the drag has already turned them: follow the velocities, no impulse */
        ma = mpm__spray_mass(a.radius, a.density);
        mb = mpm__spray_mass(b.radius, b.density);
        e = mpm__spray_bounce(s, speed, ma * (mb / (ma + mb)), a.radius * (b.radius / (a.radius + b.radius)),
                              s->yield_pair, s->modulus_pair);
        mpm_spray_collide(&a, &b, e, s->desc.friction, s->desc.friction_speed);
        mpm__spray_put(s, i, &a);
        mpm__spray_put(s, j, &b);
        s->tally.pair_hits++;
        mpm__spray_count_collision(s, i);
        mpm__spray_count_collision(s, j);
    }
    mpm__spray_set_out(s, i);
    mpm__spray_set_out(s, j);
}

/* Enters a deposited particle into the deposit's bins and box. */
static inline void mpm__spray_deposit_enter(mpm_spray *s, int32_t host)
{
    const mpm_real *x = s->deposit_x + 3 * host;
    int d;
    for (d = 0; d < 3; d++) {
        s->deposit_low[d] = host ? mpm__spray_min(s->deposit_low[d], x[d]) : x[d];
        s->deposit_high[d] = host ? mpm__spray_max(s->deposit_high[d], x[d]) : x[d];
    }
    s->deposit_radius_max = mpm__spray_max(s->deposit_radius_max, s->deposit_radius[host]);
    mpm__spray_grid_add(&s->deposit_bins, x);
}

/* Tells those in flight that something now stands in their way. */
static inline void mpm__spray_warn(mpm_spray *s, int32_t host)
{
    const mpm_real margin = MPM__SPRAY_WIDER * (s->deposit_radius[host] + s->radius_max + s->reach);
    mpm_real low[3], high[3];
    int32_t n, k;
    int d;
    if (s->desc.deposit == MPM_SPRAY_DEPOSIT_IGNORE) return;
    for (d = 0; d < 3; d++) {
        low[d] = s->deposit_x[3 * host + d] - margin;
        high[d] = s->deposit_x[3 * host + d] + margin;
    }
    n = mpm__spray_rows_gather(&s->rows, low, high, s->list);
    for (k = 0; k < n; k++) {
        int32_t j = s->list[k];
        if (s->gone[j]) continue;
        mpm__spray_offer_deposit(s, j, host);
        mpm__spray_heap_update(s, j);
    }
}

/* Particle i stays at x, exactly in contact with what it hit. */
static inline void mpm__spray_stop(mpm_spray *s, int32_t i, const mpm_real *x)
{
    int32_t host = s->deposited++;
    memcpy(s->deposit_x + 3 * host, x, 3 * sizeof *x);
    s->deposit_radius[host] = s->radius[i];
    s->deposit_time[host] = mpm_spray_time(s) + s->clock[i];
    s->deposit_id[host] = s->id[i];
    s->deposit_collisions[host] = s->collisions[i];
    s->tally.deposited++;
    s->gone[i] = 1;
    s->stamp[i]++;
    s->kind[i] = MPM__SPRAY_NOTHING;
    mpm__spray_heap_update(s, i);
    mpm__spray_deposit_enter(s, host);
    mpm__spray_warn(s, host);
}

/* First touches make the statistics of impact: running mean and squared deviation of the speed. */
static inline void mpm__spray_count_touch(mpm_spray *s, int32_t i, const mpm_spray_touch *t)
{
    double speed = (double)mpm__spray_length(t->v), off;
    if (t->plane >= 0) s->tally.target_hits++;
    else s->tally.deposit_hits++;
    if (s->touches[i]++ > 0) return;
    s->tally.first_hits++;
    s->tally.first_hits_stuck += t->stuck;
    off = speed - s->tally.speed_mean;
    s->tally.speed_mean += off / (double)s->tally.first_hits;
    s->tally.speed_m2 += off * (speed - s->tally.speed_mean);
}

static inline int mpm__spray_sticks(const mpm_spray *s, const mpm_spray_touch *t)
{
    if (t->host >= 0 && s->desc.deposit == MPM_SPRAY_DEPOSIT_ALWAYS) return 1;
    if (t->host >= 0 && s->desc.deposit == MPM_SPRAY_DEPOSIT_BOUNCE) return 0;
    if (s->desc.stick) return s->desc.stick(s->desc.stick_user, t) != 0;
    if (!mpm_finite(t->alpha)) return 1; /* also where gamma is 0 */
    return mpm_spray_stick_adhesion(NULL, t);
}

/* Particle b (number i) touches something fixed with normal n, surface velocity u: the common part
   of target and deposit. t comes with plane, host, radius_effective, yield and gamma filled in;
   `contact` is where the centre is when they exactly touch. */
static inline void mpm__spray_touch_fixed(mpm_spray *s, int32_t i, mpm_spray_ball *b, mpm_spray_touch *t,
                                          const mpm_real *u, mpm_real modulus, const mpm_real *contact)
{
    mpm_real e;
    t->time = mpm_spray_time(s) + s->clock[i];
    memcpy(t->x, contact, sizeof t->x);
    memcpy(t->v, b->v, sizeof t->v);
    t->radius = b->radius;
    t->density = b->density;
    t->mass = mpm__spray_mass(b->radius, b->density);
    t->alpha = s->desc.alpha;
    t->id = s->id[i];
    t->first = s->touches[i] == 0;
    t->stuck = 0;
    t->stuck = (t->host >= 0 || s->plane[t->plane].target) && mpm__spray_sticks(s, t);
    if (t->host >= 0 || s->plane[t->plane].target) {
        mpm__spray_count_touch(s, i, t);
        if (s->desc.touch) s->desc.touch(s->desc.touch_user, t);
    } else {
        s->tally.wall_hits++;
    }
    if (t->stuck) {
        mpm__spray_stop(s, i, contact);
        return;
    }
    e = mpm__spray_bounce(s, t->normal_speed, t->mass, t->radius_effective, t->yield, modulus);
    mpm_spray_collide_fixed(b, t->normal, u, e, s->desc.friction, s->desc.friction_speed);
    mpm__spray_put(s, i, b);
    mpm__spray_set_out(s, i);
}

static inline void mpm__spray_hit_plane(mpm_spray *s, int32_t i, int32_t k)
{
    const mpm_spray_plane *p = &s->plane[k];
    mpm_real gap, contact[3];
    mpm_spray_touch t;
    mpm_spray_ball b;
    int d;
    mpm__spray_get(s, i, &b);
    gap = -b.radius;
    t.normal_speed = 0;
    for (d = 0; d < 3; d++) {
        gap += p->normal[d] * (b.x[d] - p->point[d] - s->clock[i] * p->velocity[d]);
        t.normal_speed -= p->normal[d] * (b.v[d] - p->velocity[d]);
    }
    if (!(t.normal_speed > 0)) { /* the drag has already turned it */
        mpm__spray_set_out(s, i);
        return;
    }
    for (d = 0; d < 3; d++) contact[d] = b.x[d] - gap * p->normal[d];
    memcpy(t.normal, p->normal, sizeof t.normal);
    t.radius_effective = b.radius;
    t.yield = s->yield_target;
    t.gamma = s->gamma_target;
    t.plane = k;
    t.host = -1;
    mpm__spray_touch_fixed(s, i, &b, &t, p->velocity, s->modulus_target, contact);
}

static inline void mpm__spray_hit_deposit(mpm_spray *s, int32_t i, int32_t host)
{
    static const mpm_real at_rest[3] = {0, 0, 0};
    const mpm_real *x = s->deposit_x + 3 * host;
    mpm_real length, reach, contact[3];
    mpm_spray_touch t;
    mpm_spray_ball b;
    int d;
    mpm__spray_get(s, i, &b);
    for (d = 0; d < 3; d++) t.normal[d] = b.x[d] - x[d];
    length = mpm__spray_length(t.normal);
    for (d = 0; d < 3; d++) t.normal[d] = length > 0 ? t.normal[d] / length : 0;
    t.normal_speed = -mpm__spray_dot(b.v, t.normal);
    if (!(t.normal_speed > 0)) {
        mpm__spray_set_out(s, i);
        return;
    }
    reach = b.radius + s->deposit_radius[host];
    for (d = 0; d < 3; d++) contact[d] = x[d] + reach * t.normal[d];
    t.radius_effective = b.radius * (s->deposit_radius[host] / reach);
    t.yield = s->yield_pair;
    t.gamma = s->gamma_deposit;
    t.plane = -1;
    t.host = host;
    mpm__spray_touch_fixed(s, i, &b, &t, at_rest, s->modulus_pair, contact);
}

MPM_API void mpm_spray_resolve(mpm_spray *s)
{
    while (s->heap_count > 0) {
        int32_t i = s->heap[0], with = s->with[i], kind = s->kind[i];
        if (kind == MPM__SPRAY_PAIR && s->stamp[with] != s->with_stamp[i]) {
            mpm__spray_look(s, i); /* the partner has been hit meanwhile */
            continue;
        }
        mpm__spray_go_to(s, i, s->when[i]);
        if (kind == MPM__SPRAY_PAIR) {
            mpm__spray_go_to(s, with, s->when[i]);
            mpm__spray_hit_pair(s, i, with);
            mpm__spray_look(s, with);
        } else if (kind == MPM__SPRAY_PLANE) {
            mpm__spray_hit_plane(s, i, with);
        } else {
            mpm__spray_hit_deposit(s, i, with);
        }
        if (!s->gone[i]) mpm__spray_look(s, i);
    }
}

/* ---- move and escape ----------------------------------------------------------------------- */

MPM_API void mpm_spray_move(mpm_spray *s)
{
    int32_t i;
    int k, d;
    for (i = 0; i < s->live; i++) mpm__spray_go_to(s, i, s->desc.dt);
    for (k = 0; k < s->planes; k++)
        for (d = 0; d < 3; d++) s->plane[k].point[d] += s->desc.dt * s->plane[k].velocity[d];
}

static inline int mpm__spray_outside(const mpm_spray *s, int32_t i)
{
    int d;
    for (d = 0; d < 3; d++)
        if (s->x[3 * i + d] < s->desc.low[d] || s->x[3 * i + d] > s->desc.high[d]) return 1;
    return 0;
}

MPM_API void mpm_spray_escape(mpm_spray *s)
{
    int32_t i, kept = 0;
    for (i = 0; i < s->live; i++) {
        if (s->gone[i]) continue;
        if (mpm__spray_outside(s, i)) {
            s->tally.escaped++;
            continue;
        }
        if (kept < i) {
            mpm_spray_ball b;
            mpm__spray_get(s, i, &b);
            mpm__spray_put(s, kept, &b);
            memcpy(s->drag + 3 * kept, s->drag + 3 * i, 3 * sizeof *s->drag);
            s->known[kept] = s->known[i];
            s->id[kept] = s->id[i];
            s->collisions[kept] = s->collisions[i];
            s->touches[kept] = s->touches[i];
        }
        kept++;
    }
    s->live = kept;
}

MPM_API mpm_status mpm_spray_step(mpm_spray *s)
{
    mpm_status status, notice;
    if ((status = mpm_spray_inject(s)) < 0) return status;
    if ((notice = mpm_spray_fly(s)) < 0) return notice;
    mpm_spray_bin(s);
    mpm_spray_find(s);
    mpm_spray_resolve(s);
    mpm_spray_move(s);
    mpm_spray_escape(s);
    s->tally.step++;
    return notice;
}

/* ---- the measures -------------------------------------------------------------------------- */

/* Distance of deposited particle i from the axis in the target's plane, and its height above it. */
static inline void mpm__spray_on_target(const mpm_spray *s, int32_t i, double *distance, double *height)
{
    const mpm_spray_plane *p = &s->plane[0];
    const mpm_real *n;
    double foot[3], r2 = 0, along = 0, d[3];
    int k;
    for (k = s->planes - 1; k >= 0; k--)
        if (s->plane[k].target) p = &s->plane[k]; /* the first target */
    n = p->normal;
    /* where the axis y = z = 0 meets the plane; the plane's own point if it never does */
    for (k = 0; k < 3; k++) foot[k] = (double)p->point[k];
    if (n[0] > MPM_R(1e-6) || n[0] < MPM_R(-1e-6)) {
        foot[0] = (double)(mpm__spray_dot(n, p->point) / n[0]);
        foot[1] = foot[2] = 0;
    }
    for (k = 0; k < 3; k++) {
        d[k] = (double)s->deposit_x[3 * i + k] - foot[k];
        along += d[k] * (double)n[k];
    }
    for (k = 0; k < 3; k++) r2 += (d[k] - along * (double)n[k]) * (d[k] - along * (double)n[k]);
    *distance = sqrt(r2);
    *height = along;
}

static inline double mpm__spray_volume(mpm_real radius)
{
    return 4 * (double)MPM_PI / 3 * (double)radius * (double)radius * (double)radius;
}

/* Mean, scatter, thickness and volumes of the deposit (5.2). */
static inline void mpm__spray_measure_deposit(const mpm_spray *s, mpm_spray_metrics *m)
{
    double low = 0, high = 0, m2 = 0, inside = 0, r, h;
    double pellet = (double)MPM_PI * (double)s->desc.target_radius * (double)s->desc.target_radius *
                    (double)s->desc.target_thickness;
    int32_t i;
    for (i = 0; i < s->deposited; i++) {
        double volume = mpm__spray_volume(s->deposit_radius[i]), off;
        mpm__spray_on_target(s, i, &r, &h);
        low = i ? fmin(low, h) : h;
        high = i ? fmax(high, h) : h;
        off = r - m->mean_spread;
        m->mean_spread += off / (i + 1);
        m2 += off * (r - m->mean_spread);
        if (r <= 0.005) m->volume_r5mm += volume;
        if (r <= 0.010) m->volume_r10mm += volume;
        if (r <= (double)s->desc.target_radius && h <= (double)s->desc.target_thickness) inside += volume;
    }
    m->scatter = s->deposited ? sqrt(m2 / s->deposited) : 0;
    m->thickness = high - low;
    m->volume_fraction = inside / pellet;
}

/* Growth rate at the end of the run, over the feed. */
static inline double mpm__spray_late_rate(const mpm_spray *s)
{
    double time = (double)mpm_spray_time(s), span = time * (double)s->desc.late;
    int32_t i, late = 0;
    if (!(span > 0) || s->desc.batch == 0) return 0;
    for (i = 0; i < s->deposited; i++) late += (double)s->deposit_time[i] > time - span;
    return late / (span * (double)s->desc.feed);
}

MPM_API void mpm_spray_measure(const mpm_spray *s, mpm_spray_metrics *m)
{
    const mpm_spray_tally *t = &s->tally;
    double injected = t->injected ? (double)t->injected : 1, first = t->first_hits ? (double)t->first_hits : 1;
    memset(m, 0, sizeof *m);
    m->injected = t->injected;
    m->deposited = t->deposited;
    m->escaped = t->escaped;
    m->in_flight = s->live;
    m->deposit_fraction = (double)t->deposited / injected;
    m->late_rate_over_feed = mpm__spray_late_rate(s);
    m->collisions_per_particle = 2 * (double)t->pair_hits / injected;
    m->collided_fraction = (double)t->collided / injected;
    m->impact_speed_mean = t->speed_mean;
    m->impact_speed_sd = sqrt(t->speed_m2 / first);
    m->first_hit_stuck_fraction = (double)t->first_hits_stuck / first;
    mpm__spray_measure_deposit(s, m);
}

/* ---- restart ------------------------------------------------------------------------------- */

#define MPM__SPRAY_ARRAYS 15 /* come first */

MPM_API int mpm_spray_blobs(mpm_spray *s, mpm_blob *blob)
{
    const size_t real = sizeof(mpm_real), i32 = sizeof(int32_t), i64 = sizeof(int64_t);
    const size_t live = (size_t)s->live, stuck = (size_t)s->deposited, room = (size_t)s->desc.capacity;
    int n = 0, k;
    blob[n++] = mpm_blob_array("x", s->x, live, room, 3 * real);
    blob[n++] = mpm_blob_array("v", s->v, live, room, 3 * real);
    blob[n++] = mpm_blob_array("spin", s->spin, live, room, 3 * real);
    blob[n++] = mpm_blob_array("radius", s->radius, live, room, real);
    blob[n++] = mpm_blob_array("density", s->density, live, room, real);
    blob[n++] = mpm_blob_array("id", s->id, live, room, i64);
    blob[n++] = mpm_blob_array("collisions", s->collisions, live, room, i32);
    blob[n++] = mpm_blob_array("touches", s->touches, live, room, i32);
    blob[n++] = mpm_blob_array("drag", s->drag, live, room, 3 * real);
    blob[n++] = mpm_blob_array("known", s->known, live, room, i32);
    blob[n++] = mpm_blob_array("deposit x", s->deposit_x, stuck, room, 3 * real);
    blob[n++] = mpm_blob_array("deposit radius", s->deposit_radius, stuck, room, real);
    blob[n++] = mpm_blob_array("deposit time", s->deposit_time, stuck, room, real);
    blob[n++] = mpm_blob_array("deposit id", s->deposit_id, stuck, room, i64);
    blob[n++] = mpm_blob_array("deposit collisions", s->deposit_collisions, stuck, room, i32);
    blob[n++] = mpm_blob_of("live", &s->live, sizeof s->live);
    blob[n++] = mpm_blob_of("deposited", &s->deposited, sizeof s->deposited);
    blob[n++] = mpm_blob_of("tally", &s->tally, sizeof s->tally);
    for (k = 0; k < s->planes; k++)
        blob[n++] = mpm_blob_of("point of plane", s->plane[k].point, sizeof s->plane[k].point);
    return n;
}

/* The counts against each other and the capacity: as every step leaves them. */
static inline mpm_status mpm__spray_restored_counts(const mpm_spray *s, mpm_fault *f)
{
    const mpm_spray_tally *t = &s->tally;
    const mpm_spray_desc *d = &s->desc;
    const int64_t most = INT64_C(1) << 52;
    const double fed = d->batch > 0 ? (double)d->dt * (double)d->feed / d->batch : 0; /* batches per step */
    mpm__spray_rule r[10];
    int n = 0;
    r[n++] = mpm__spray_rule_of("live", (mpm_real)s->live, s->live >= 0 && s->live <= d->capacity);
    r[n++] = mpm__spray_rule_of("deposited", (mpm_real)s->deposited,
                                s->deposited >= 0 && (int64_t)s->live + s->deposited <= d->capacity);
    r[n++] = mpm__spray_rule_of("tally.deposited", (mpm_real)t->deposited, t->deposited == s->deposited);
    r[n++] = mpm__spray_rule_of("tally.escaped", (mpm_real)t->escaped, t->escaped >= 0 && t->escaped < most);
    r[n++] = mpm__spray_rule_of("tally.injected", (mpm_real)t->injected,
                                t->injected >= 0 && t->injected < most &&
                                    (double)t->injected - (double)t->escaped == (double)s->live + s->deposited);
    r[n++] = mpm__spray_rule_of("tally.step", (mpm_real)t->step,
                                t->step >= 0 && t->step < most && (double)t->step * fed < 1e15);
    r[n++] = mpm__spray_rule_of("tally.batches", (mpm_real)t->batches,
                                (double)t->batches >= ((double)t->step - 1) * fed - 1 && (double)t->batches < 1e15);
    r[n++] = mpm__spray_rule_of("tally.pending", (mpm_real)t->pending,
                                t->pending >= 0 && (double)t->pending <= (double)t->batches * d->batch);
    r[n++] = mpm__spray_rule_of("tally.wait_radius", (mpm_real)t->wait_radius,
                                t->wait_radius >= 0 && t->wait_radius <= (double)d->nozzle_radius);
    r[n++] = mpm__spray_rule_of("tally.wait_speed", (mpm_real)t->wait_speed, 1);
    return mpm__spray_judge(r, n, f);
}

/* As many values per array as there are particles. */
static inline mpm_status mpm__spray_restored_sizes(mpm_spray *s, const mpm_blob *blob, mpm_fault *f)
{
    mpm_blob wanted[MPM_SPRAY_BLOBS];
    mpm_status status = MPM_OK;
    int k;
    mpm_spray_blobs(s, wanted);
    for (k = 0; k < MPM__SPRAY_ARRAYS && status == MPM_OK; k++)
        status = mpm_want(blob[k].bytes == wanted[k].bytes, f, wanted[k].name, (mpm_real)blob[k].bytes, -1);
    return status;
}

/* The particles themselves and the places of the planes. */
static inline mpm_status mpm__spray_restored_particles(const mpm_spray *s, mpm_fault *f)
{
    mpm_status status = MPM_OK;
    mpm_spray_ball b;
    int32_t i;
    int k;
    for (i = 0; i < s->live && status == MPM_OK; i++) {
        mpm__spray_get(s, i, &b);
        if ((status = mpm__spray_check_ball(&b, f)) != MPM_OK && f) f->index = i;
    }
    for (i = 0; i < s->deposited && status == MPM_OK; i++) {
        const mpm_real *x = s->deposit_x + 3 * i;
        status = mpm_want(1, f, "position in deposit", x[0] + x[1] + x[2], i);
        if (status == MPM_OK)
            status = mpm_want(s->deposit_radius[i] > 0, f, "radius in deposit", s->deposit_radius[i], i);
    }
    for (k = 0; k < s->planes && status == MPM_OK; k++) {
        const mpm_real *x = s->plane[k].point;
        status = mpm_want(1, f, "point of plane", x[0] + x[1] + x[2], k);
    }
    return status;
}

MPM_API mpm_status mpm_spray_restored(mpm_spray *s, const mpm_blob *blob)
{
    mpm_status status = mpm__spray_ready(s);
    int32_t i;
    if (status != MPM_OK) return status;
    status = mpm__spray_restored_counts(s, &s->fault);
    if (status == MPM_OK) status = mpm__spray_restored_sizes(s, blob, &s->fault);
    if (status == MPM_OK) status = mpm__spray_restored_particles(s, &s->fault);
    if (status != MPM_OK) {
        s->live = s->deposited = 0;
        memset(&s->tally, 0, sizeof s->tally);
        s->tally.random = s->desc.seed;
    }
    /* the deposit's bins and box are made again, in the same order */
    mpm__spray_grid_clear(&s->deposit_bins, s->deposit_bins.cell, s->deposit_bins.mask + 1);
    s->deposit_radius_max = 0;
    for (i = 0; i < s->deposited; i++) mpm__spray_deposit_enter(s, i);
    return status;
}

#ifdef __cplusplus
}
#endif
#endif /* implementation */

/* References
     Johnson, Contact Mechanics (1987): restitution, limit of elasticity, contact times.
     Haider, Levenspiel, Powder Technol. 58 (1989) 63: drag of spheres.
     Bickley, Phil. Mag. 23 (1937) 727: the plane laminar jet.
     Lubachevsky, J. Comput. Phys. 94 (1991) 255: one next event per particle.
   Licence: MIT, see LICENSE. */
