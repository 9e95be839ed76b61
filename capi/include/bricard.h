/*
 * bricard.h: mechanisms that bricard has compiled, for C99 and C++.
 *
 * Each mechanism is a library that exports one name; its own header, such as
 * `four_bar.h`, declares it and has `four_bar_create`. Everything else is here,
 * the same for all mechanisms, so that one program can use several.
 *
 *     bricard *m = NULL;
 *     if (four_bar_create(&m) != BRICARD_OK) return 1;
 *     if (bricard_assemble(m, 0.0) || bricard_run(m, 8.0, NULL, NULL))
 *         fprintf(stderr, "%s\n", bricard_message(m));
 *     bricard_free(&m);
 *
 * Rules
 *  - A function returns BRICARD_OK (0), a positive number if a run ended early
 *    because it was to, or a negative one if it failed; bricard_message then says
 *    why, in words. What failed has changed nothing, but for a run: the mechanism
 *    is then where the last good step led, and can be used on.
 *  - All numbers are in SI units. Matrices are written row by row.
 *  - Arrays that are written to hold numbers already (any will do).
 *  - Only ..._create and bricard_clone allocate, and only bricard_free frees.
 *  - Nothing is global. Handles may be used from any thread, each by one at a
 *    time; a second call on the same handle, from a thread or from a callback,
 *    is turned away with BRICARD_ERROR_BUSY. Only bricard_stop may come any time.
 *  - Callbacks are called in the thread of the call. They must return: no longjmp,
 *    no exception.
 *  - No panic crosses this boundary: it would be BRICARD_ERROR_PANIC.
 */
#ifndef BRICARD_H
#define BRICARD_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this interface. A library of another version hands nothing out. */
#define BRICARD_ABI 2u

/* How a call ended. */
typedef int32_t bricard_status;
enum {
    BRICARD_OK = 0,
    BRICARD_STOPPED = 1,            /* a run ended early: somebody wanted it to */
    BRICARD_FULL = 2,               /* a run ended early: its rows are full */
    BRICARD_ERROR_NULL = -1,        /* a pointer that has to lead somewhere is NULL */
    BRICARD_ERROR_LENGTH = -2,      /* an array has another length than is wanted */
    BRICARD_ERROR_INDEX = -3,       /* there is nothing at an index */
    BRICARD_ERROR_NAME = -4,        /* there is nothing of a name */
    BRICARD_ERROR_NOT_FINITE = -5,  /* a number that was given is infinite or NaN */
    BRICARD_ERROR_ARGUMENT = -6,    /* a value makes no sense */
    BRICARD_ERROR_ORDER = -7,       /* there is no state yet */
    BRICARD_ERROR_BUSY = -8,        /* another call is at work on the same handle */
    BRICARD_ERROR_ASSEMBLY = -9,    /* no consistent initial state was found */
    BRICARD_ERROR_RUN = -10,        /* the motion could not be computed */
    BRICARD_ERROR_CALLBACK = -11,   /* a callback failed */
    BRICARD_ERROR_PANIC = -12,      /* a defect of the library: free the handle */
    BRICARD_ERROR_ABI = -13         /* header and library are of different versions */
};

/* What has names: bricard_count, bricard_name, bricard_unit, bricard_docs, bricard_find. */
enum {
    BRICARD_MECHANISM = 0,          /* one: its name; its file as unit */
    BRICARD_COORDINATES = 1,
    BRICARD_PARAMETERS = 2,
    BRICARD_INPUTS = 3,
    BRICARD_OUTPUTS = 4,
    BRICARD_EVENTS = 5,
    BRICARD_CONSTRAINTS = 6,        /* one for each row; the equation as written */
    BRICARD_STATES = 7              /* of the first order; they stand behind the velocities */
};

/*
 * What can be evaluated. F is the number of coordinates, N that of coordinates and states of
 * the first order, the same if the description has none: arrays `v` hold the velocities and, behind them, the states, N
 * numbers; arrays `q` hold the F coordinates. Accelerations have the
 * rates of the states behind them, in M each state is a mass of one.
 *
 * With R constraint equations, and U inputs, the equations of motion are M a + r = p1, A a = p2, with the accelerations a and the generalized reaction
 * forces r of the constraints g = 0 (Phong & Hoang 2012, eqs. 2.1-2.10).
 */
enum {
    BRICARD_MASS = 0,               /* M, N x N */
    BRICARD_FORCE = 1,              /* p1, N */
    BRICARD_JACOBIAN = 2,           /* A, R x N */
    BRICARD_BIAS = 3,               /* p2, R */
    BRICARD_RESIDUAL = 4,           /* g, R; zero in rows that restrict velocities only */
    BRICARD_RATE = 5,               /* A v + b, R: zero on the constraints */
    BRICARD_ACCELERATION = 6,       /* a, N */
    BRICARD_REACTION = 7,           /* r, N; unique where constraints are redundant, too */
    BRICARD_OUTPUT = 8,             /* the outputs */
    BRICARD_EVENT = 9,              /* the functions of the events */
    BRICARD_ENERGY = 10,            /* 4: kinetic, potential, their balance (J), power (W) */
    BRICARD_RANK = 11,              /* 3: rank of A, rank at regular positions, and the sine
                                       of the weakest row: zero in a singular position */
    BRICARD_SLOPE = 12,             /* da/d(q, v, u), N rows; exact, by the derived equations */
    BRICARD_OUTPUT_SLOPE = 13,      /* of the outputs, a row for each: outputs of accelerations
                                       change with those */
    BRICARD_EVENT_SLOPE = 14,       /* of the functions of the events. Of a mechanism whose
                                       derivatives would be too long bricard_size says 0 for
                                       the three, and near singular positions they fail */
    BRICARD_SAVED = -1              /* only for bricard_size: what bricard_save writes */
};

/* How steps are made: bricard_options.method. */
enum {
    BRICARD_RK4 = 0,                /* of fixed step only */
    BRICARD_DP5 = 1,
    BRICARD_DOP853 = 2,
    BRICARD_RADAU5 = 3,             /* implicit, for stiff mechanisms */
    BRICARD_RADAU9 = 4
};

/* The form of the equations of motion: bricard_options.form. */
enum {
    BRICARD_REDUCED = 0,            /* passes singular positions */
    BRICARD_FULL_FORM = 1,          /* passes them, too */
    BRICARD_MULTIPLIERS = 2,        /* ends there */
    BRICARD_PARTITIONING = 3        /* ends there */
};

/* What keeps a motion on the constraints: bricard_options.stabilisation. */
enum { BRICARD_PROJECTION = 0, BRICARD_NONE = 1, BRICARD_BAUMGARTE = 2 };

/* Shapes of a picture. */
enum { BRICARD_LINE = 0, BRICARD_CIRCLE = 1, BRICARD_POLYGON = 2, BRICARD_TRACE = 3 };

/* What rows hold besides t, coordinates, velocities and states, in this order: bricard_watch.columns, or-ed. */
enum {
    BRICARD_WITH_OUTPUTS = 1,
    BRICARD_WITH_REACTIONS = 2,
    BRICARD_WITH_ENERGIES = 4,      /* kinetic, potential */
    BRICARD_WITH_ERRORS = 8         /* the largest |g|, the largest |A v + b| */
};

/* A mechanism: where it is, its parameters and inputs, how it is integrated. */
typedef struct bricard bricard;

/* A state to evaluate something at. */
typedef struct bricard_point {
    double t;
    const double *q;
    const double *v;
    size_t n;                       /* N: numbers in v */
} bricard_point;

/* How a motion is integrated. Get them, change them, set them. */
typedef struct bricard_options {
    size_t size;                    /* sizeof(bricard_options) */
    int method;                     /* BRICARD_DOP853 */
    int form;                       /* BRICARD_REDUCED */
    int stabilisation;              /* BRICARD_PROJECTION */
    int keep_energy;                /* 0; else the energy is kept, for long runs */
    int audit;                      /* 1; 0: nothing is checked along the way */
    int published;                  /* 0; else singular positions as published */
    double alpha, beta;             /* gains of Baumgarte's stabilisation (1/s) */
    double step;                    /* 0; else the length of all steps (s) */
    double rtol, atol;              /* 1e-9; accepted errors of a step, if step is 0 */
    uint64_t most_steps;            /* 0; else a run is given up after so many */
} bricard_options;

/* What is recorded of a run, and who is told of it. Begin with bricard_watch_nothing(). */
typedef struct bricard_watch {
    size_t size;                    /* sizeof(bricard_watch) */
    void *user;                     /* given back to the functions */
    double every;                   /* rows each so many seconds; 0: one after each step */
    uint32_t columns;               /* BRICARD_WITH_... */
    uint32_t inside;                /* with every = 0: so many rows within each step, where
                                       its polynomial is determined best (0 to 32) */
    double *rows;                   /* where rows go, one after the other */
    size_t room;                    /* numbers there is room for */
    /* Takes `count` rows when there is no room for more, and the last ones; not 0: stop.
       Without it a run ends when there is no room, with BRICARD_FULL. */
    int (*take)(void *user, const double *rows, size_t count);
    /* An event; not 0: stop there. */
    int (*event)(void *user, size_t index, int rising, double t, const double *q,
                 const double *v);
    /* A passage through a singular position; not 0: stop. */
    int (*passage)(void *user, double t, double sine, size_t rank, size_t regular);
    /* Each 64 steps; not 0: stop. */
    int (*go_on)(void *user, double t, uint64_t steps);
    size_t written;                 /* told at the end: rows that were not taken */
} bricard_watch;

/* What a run did. */
typedef struct bricard_summary {
    size_t size;                    /* sizeof(bricard_summary) */
    double t;                       /* time that was reached */
    uint64_t steps, rejected, evaluations, events, passages;
    uint64_t undetermined;          /* starts at rest exactly in a singular position */
    double constraint_error;        /* the largest |g| */
    double velocity_error;          /* the largest |A v + b| */
    double energy_error;            /* the largest error of the energy balance (J) */
    double energy_supplied;         /* by the power (J) */
} bricard_summary;

/* The value of an input at a state, asked for at each stage of each step; not 0: it failed,
   and the run ends with BRICARD_ERROR_CALLBACK. */
typedef int (*bricard_law)(void *user, double t, const double *q, const double *v,
                           double *value);

/* The functions of a mechanism. Call those below, which have the same names. */
typedef struct bricard_interface {
    uint32_t abi;
    bricard_status (*create)(bricard **m);
    bricard_status (*clone)(bricard *m, bricard **copy);
    bricard_status (*assign)(bricard *into, bricard *from);
    void (*free)(bricard **m);
    const char *(*message)(bricard *m);
    bricard_status (*failed_at)(bricard *m, double *t);
    bricard_status (*count)(bricard *m, int list, size_t *count);
    const char *(*name)(bricard *m, int list, size_t index);
    const char *(*unit)(bricard *m, int list, size_t index);
    const char *(*docs)(bricard *m, int list, size_t index);
    bricard_status (*find)(bricard *m, int list, const char *name, size_t *index);
    bricard_status (*parameter)(bricard *m, size_t index, double *value);
    bricard_status (*set_parameter)(bricard *m, size_t index, double value);
    bricard_status (*hold_input)(bricard *m, size_t index, double value);
    bricard_status (*release_input)(bricard *m, size_t index);
    bricard_status (*drive_input)(bricard *m, size_t index, bricard_law law, void *user);
    bricard_status (*start)(bricard *m, size_t index, int velocity, double *value, int *held);
    bricard_status (*set_start)(bricard *m, size_t index, int velocity, double value, int held);
    bricard_status (*assemble)(bricard *m, double t);
    bricard_status (*state)(bricard *m, double *t, double *q, double *v, size_t n);
    bricard_status (*set_state)(bricard *m, double t, const double *q, const double *v,
                                size_t n);
    bricard_status (*options)(bricard *m, bricard_options *options);
    bricard_status (*set_options)(bricard *m, const bricard_options *options);
    bricard_status (*run)(bricard *m, double until, bricard_watch *watch,
                          bricard_summary *summary);
    bricard_status (*stop)(bricard *m);
    bricard_status (*step)(bricard *m, double span);
    bricard_status (*step_once)(bricard *m, double bound);
    bricard_status (*size)(bricard *m, int quantity, size_t *size);
    bricard_status (*row_size)(bricard *m, uint32_t columns, size_t *size);
    bricard_status (*evaluate)(bricard *m, int quantity, const bricard_point *at, double *out,
                               size_t n);
    bricard_status (*draw)(bricard *m, const bricard_point *at, double *out, size_t n,
                           size_t *count);
    bricard_status (*project)(bricard *m, double t, double *q, double *v, size_t n);
    bricard_status (*save)(bricard *m, double *out, size_t n);
    bricard_status (*load)(bricard *m, const double *saved, size_t n);
} bricard_interface;

struct bricard {
    const bricard_interface *interface_;
};

/* ---- handles -------------------------------------------------------------------------- */

/* A copy, which goes on to the same bits: a snapshot. Inputs that follow functions follow
   the same ones. */
static inline bricard_status bricard_clone(bricard *m, bricard **copy)
{
    return m ? m->interface_->clone(m, copy) : BRICARD_ERROR_NULL;
}

/* Makes one handle a copy of another of the same mechanism, without allocating: going back
   to a snapshot. BRICARD_ERROR_ARGUMENT if it is another mechanism. */
static inline bricard_status bricard_assign(bricard *into, bricard *from)
{
    return into ? into->interface_->assign(into, from) : BRICARD_ERROR_NULL;
}

/* Frees a mechanism and makes the pointer to it NULL; one that is NULL is left alone. */
static inline void bricard_free(bricard **m)
{
    if (m && *m)
        (*m)->interface_->free(m);
}

/* Why the last call failed that did; valid until the next call on the same handle. */
static inline const char *bricard_message(bricard *m)
{
    return m ? m->interface_->message(m) : "the mechanism is NULL";
}

/* When the last motion that failed could not go on (s). */
static inline bricard_status bricard_failed_at(bricard *m, double *t)
{
    return m ? m->interface_->failed_at(m, t) : BRICARD_ERROR_NULL;
}

/* ---- names ---------------------------------------------------------------------------- */

/* How many there are of BRICARD_PARAMETERS, ... */
static inline bricard_status bricard_count(bricard *m, int list, size_t *count)
{
    return m ? m->interface_->count(m, list, count) : BRICARD_ERROR_NULL;
}

/* The name of one of them as the description has it; NULL if there is none. */
static inline const char *bricard_name(bricard *m, int list, size_t index)
{
    return m ? m->interface_->name(m, list, index) : NULL;
}

/* Its unit, "" if none was given; NULL if there is none. */
static inline const char *bricard_unit(bricard *m, int list, size_t index)
{
    return m ? m->interface_->unit(m, list, index) : NULL;
}

/* Its documentation, "" if there is none; NULL if there is none of them. */
static inline const char *bricard_docs(bricard *m, int list, size_t index)
{
    return m ? m->interface_->docs(m, list, index) : NULL;
}

/* The place of a name. */
static inline bricard_status bricard_find(bricard *m, int list, const char *name, size_t *index)
{
    return m ? m->interface_->find(m, list, name, index) : BRICARD_ERROR_NULL;
}

/* ---- parameters and inputs ------------------------------------------------------------ */

static inline bricard_status bricard_parameter(bricard *m, size_t index, double *value)
{
    return m ? m->interface_->parameter(m, index, value) : BRICARD_ERROR_NULL;
}

static inline bricard_status bricard_set_parameter(bricard *m, size_t index, double value)
{
    return m ? m->interface_->set_parameter(m, index, value) : BRICARD_ERROR_NULL;
}

static inline bricard_status bricard_set_parameter_named(bricard *m, const char *name,
                                                         double value)
{
    size_t index = 0;
    bricard_status status = bricard_find(m, BRICARD_PARAMETERS, name, &index);
    return status ? status : bricard_set_parameter(m, index, value);
}

/* Holds an input at a value. */
static inline bricard_status bricard_hold_input(bricard *m, size_t index, double value)
{
    return m ? m->interface_->hold_input(m, index, value) : BRICARD_ERROR_NULL;
}

static inline bricard_status bricard_hold_input_named(bricard *m, const char *name, double value)
{
    size_t index = 0;
    bricard_status status = bricard_find(m, BRICARD_INPUTS, name, &index);
    return status ? status : bricard_hold_input(m, index, value);
}

/* Returns an input to the law of the description. */
static inline bricard_status bricard_release_input(bricard *m, size_t index)
{
    return m ? m->interface_->release_input(m, index) : BRICARD_ERROR_NULL;
}

/* Lets an input follow a function, as long as it is not held or released. */
static inline bricard_status bricard_drive_input(bricard *m, size_t index, bricard_law law,
                                                 void *user)
{
    return m ? m->interface_->drive_input(m, index, law, user) : BRICARD_ERROR_NULL;
}

static inline bricard_status bricard_drive_input_named(bricard *m, const char *name,
                                                       bricard_law law, void *user)
{
    size_t index = 0;
    bricard_status status = bricard_find(m, BRICARD_INPUTS, name, &index);
    return status ? status : bricard_drive_input(m, index, law, user);
}

/* ---- where it is ---------------------------------------------------------------------- */

/* What is given for the start of a coordinate, or of its velocity: held, or a guess. States
   stand behind the velocities: the first one is at the index after the last coordinate's. */
static inline bricard_status bricard_start(bricard *m, size_t index, int velocity,
                                           double *value, int *held)
{
    return m ? m->interface_->start(m, index, velocity, value, held) : BRICARD_ERROR_NULL;
}

static inline bricard_status bricard_set_start(bricard *m, size_t index, int velocity,
                                               double value, int held)
{
    return m ? m->interface_->set_start(m, index, velocity, value, held) : BRICARD_ERROR_NULL;
}

static inline bricard_status bricard_set_start_named(bricard *m, const char *name, int velocity,
                                                     double value, int held)
{
    size_t index = 0;
    size_t states = 0, count = 0;
    bricard_status status = bricard_count(m, BRICARD_STATES, &states);
    if (!status && states && !bricard_find(m, BRICARD_STATES, name, &index)) {
        velocity = 1;
        status = bricard_count(m, BRICARD_COORDINATES, &count);
        index += count;
    } else if (!status) {
        status = bricard_find(m, BRICARD_COORDINATES, name, &index);
    }
    return status ? status : bricard_set_start(m, index, velocity, value, held);
}

/* Puts the mechanism on its constraints at time t: held values stay, guesses give way. */
static inline bricard_status bricard_assemble(bricard *m, double t)
{
    return m ? m->interface_->assemble(m, t) : BRICARD_ERROR_NULL;
}

/* Where it is: t may be NULL, n is N. */
static inline bricard_status bricard_state(bricard *m, double *t, double *q, double *v, size_t n)
{
    return m ? m->interface_->state(m, t, q, v, n) : BRICARD_ERROR_NULL;
}

/* Puts the mechanism somewhere; bricard_project finds states on the constraints. */
static inline bricard_status bricard_set_state(bricard *m, double t, const double *q,
                                               const double *v, size_t n)
{
    return m ? m->interface_->set_state(m, t, q, v, n) : BRICARD_ERROR_NULL;
}

/* ---- motion --------------------------------------------------------------------------- */

static inline bricard_status bricard_get_options(bricard *m, bricard_options *options)
{
    return m ? m->interface_->options(m, options) : BRICARD_ERROR_NULL;
}

static inline bricard_status bricard_set_options(bricard *m, const bricard_options *options)
{
    return m ? m->interface_->set_options(m, options) : BRICARD_ERROR_NULL;
}

/* A watch to begin with. */
static inline bricard_watch bricard_watch_nothing(void)
{
    bricard_watch watch;
    watch.size = sizeof watch;
    watch.user = NULL;
    watch.every = 0.0;
    watch.columns = 0;
    watch.inside = 0;
    watch.rows = NULL;
    watch.room = 0;
    watch.take = NULL;
    watch.event = NULL;
    watch.passage = NULL;
    watch.go_on = NULL;
    watch.written = 0;
    return watch;
}

/* Advances to a time, as `simulate` does in Rust, to the same bits. `watch` and `summary`
   may be NULL. */
static inline bricard_status bricard_run(bricard *m, double until, bricard_watch *watch,
                                         bricard_summary *summary)
{
    return m ? m->interface_->run(m, until, watch, summary) : BRICARD_ERROR_NULL;
}

/* Ends the run that is at work, or the next one, after a step. From any thread. */
static inline bricard_status bricard_stop(bricard *m)
{
    return m ? m->interface_->stop(m) : BRICARD_ERROR_NULL;
}

/* Goes on by a span of time, in as many steps as the options want: with a fixed step of
   this length, one. For programs that act in between; inputs that are held stay what they
   are meanwhile, and nobody is told of anything. */
static inline bricard_status bricard_step(bricard *m, double span)
{
    return m ? m->interface_->step(m, span) : BRICARD_ERROR_NULL;
}

/* Goes on by one step, as long as the options allow, but not beyond a time. */
static inline bricard_status bricard_step_once(bricard *m, double bound)
{
    return m ? m->interface_->step_once(m, bound) : BRICARD_ERROR_NULL;
}

/* ---- what is there -------------------------------------------------------------------- */

/* How many numbers BRICARD_MASS, ... is; for BRICARD_SAVED what bricard_save writes. */
static inline bricard_status bricard_size(bricard *m, int quantity, size_t *size)
{
    return m ? m->interface_->size(m, quantity, size) : BRICARD_ERROR_NULL;
}

/* How many numbers a row with BRICARD_WITH_... has. */
static inline bricard_status bricard_row_size(bricard *m, uint32_t columns, size_t *size)
{
    return m ? m->interface_->row_size(m, columns, size) : BRICARD_ERROR_NULL;
}

/* Evaluates BRICARD_MASS, ... at a state; where the mechanism is if `at` is NULL. */
static inline bricard_status bricard_evaluate(bricard *m, int quantity, const bricard_point *at,
                                              double *out, size_t n)
{
    return m ? m->interface_->evaluate(m, quantity, at, out, n) : BRICARD_ERROR_NULL;
}

/* Draws the mechanism at a state: for each shape BRICARD_LINE, ..., the number of its points,
   x, y, z of each, and the radius of a circle. `count` tells how many numbers that is, also
   where there is not room for all; `out` may be NULL with n = 0. */
static inline bricard_status bricard_draw(bricard *m, const bricard_point *at, double *out,
                                          size_t n, size_t *count)
{
    return m ? m->interface_->draw(m, at, out, n, count) : BRICARD_ERROR_NULL;
}

/* Brings a state near the constraints onto them. */
static inline bricard_status bricard_project(bricard *m, double t, double *q, double *v,
                                             size_t n)
{
    return m ? m->interface_->project(m, t, q, v, n) : BRICARD_ERROR_NULL;
}

/* Writes state, parameters, held inputs and start as numbers, for a file. A mechanism that
   is loaded begins there as bricard_run does. Functions and options are not in it: options stay
   as they are, and an input that follows a function follows its law again until it is driven. */
static inline bricard_status bricard_save(bricard *m, double *out, size_t n)
{
    return m ? m->interface_->save(m, out, n) : BRICARD_ERROR_NULL;
}

static inline bricard_status bricard_load(bricard *m, const double *saved, size_t n)
{
    return m ? m->interface_->load(m, saved, n) : BRICARD_ERROR_NULL;
}

#ifdef __cplusplus
}
#endif

#endif
