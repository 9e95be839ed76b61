/* An instance of an FMU over bricard.h: the same for all mechanisms and for all versions of
   FMI. It is included by `fmi2.c` or `fmi3.c`, which declare what the standard has, say who
   is told of errors (Host, tell_host) and how a call ended (Status, OK, DISCARD, ERROR), and
   give the functions below their names.

   A file that says which mechanism it is includes that one: MECHANISM_CREATE,
   MECHANISM_TOKEN, and MECHANISM_INPUTS, what inputs are told to be until they are set. */
#include "bricard.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined _WIN32 || defined __CYGWIN__
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

static const double INPUTS[] = {MECHANISM_INPUTS};

/* Where in the life of an instance calls are allowed. */
enum {
    INSTANTIATED = 1,
    INITIALISING = 2,
    EVENT = 4,
    CONTINUOUS = 8,
    STEPPING = 16,
    TERMINATED = 32,
    FAILED = 64,
    RUNNING = INITIALISING | EVENT | CONTINUOUS | STEPPING,
    ANY = 127
};

/* How far a motion may leave the constraints before it is brought back, in the unit of the
   constraint: an outer solver knows nothing of them. */
#define DRIFT 1e-9

typedef struct {
    bricard *m;
    int phase;
    int is_cosimulation, logging, placed, drifted;
    double t, begin, stop;
    /* How many there are: coordinates; those and states of the first order; constraint
       equations; … */
    size_t f, n, r, parameters, inputs, outputs, events;
    /* Coordinates; velocities and states; inputs; a direction; room for what is evaluated. */
    double *q, *v, *u, *along, *room;
    char *name;
    Host host;
} Instance;

/* What value references count, in this order. */
enum {
    Q,
    V,
    Z,
    A,
    RATE_Z,
    R,
    PARAMETER,
    INPUT,
    OUTPUT,
    START_Q,
    START_V,
    START_Z,
    KINETIC,
    POTENTIAL,
    INDICATOR,
    TIME,
    KINDS
};

static size_t sized(const Instance *x, int kind)
{
    switch (kind) {
    case Z:
    case RATE_Z:
    case START_Z:
        return x->n - x->f;
    case PARAMETER:
        return x->parameters;
    case INPUT:
        return x->inputs;
    case OUTPUT:
        return x->outputs;
    case INDICATOR:
        return x->events;
    case KINETIC:
    case POTENTIAL:
    case TIME:
        return 1;
    default:
        return x->f;
    }
}

/* The kind and the place of a variable; KINDS if there is none. */
static int place_of(const Instance *x, unsigned int reference, size_t *place)
{
    int kind;
    *place = reference;
    for (kind = Q; kind < KINDS; kind++) {
        if (*place < sized(x, kind))
            break;
        *place -= sized(x, kind);
    }
    return kind;
}

/* The category of the log that a status is told in. */
static const char *category(Status status)
{
    return status < ERROR ? "logStatusDiscard" : "logStatusError";
}

static void tell_host(const Host *host, const char *name, Status status, const char *message);

static Status complain(Instance *x, Status status, const char *message)
{
    if (x->logging || status >= ERROR)
        tell_host(&x->host, x->name, status, message);
    if (status >= ERROR)
        x->phase = FAILED;
    return status;
}

/* The status of a call of bricard.h about one of its mechanisms, that of the instance or of a
   copy. */
static Status done_by(Instance *x, bricard *m, bricard_status status)
{
    return status < 0 ? complain(x, ERROR, bricard_message(m)) : OK;
}

static Status done(Instance *x, bricard_status status)
{
    return done_by(x, x->m, status);
}

/* Refuses a call that comes out of order. */
static int refuses(Instance *x, int allowed, const char *function)
{
    char text[128];
    if (!x)
        return 1;
    if (x->phase & allowed)
        return 0;
    snprintf(text, sizeof text, "%s can't be called now%s", function,
             x->phase == FAILED ? ": an earlier call has failed; reset the instance" : "");
    complain(x, ERROR, text);
    return 1;
}

/* Turns a component into an instance, `x`, in whose life this call is allowed. */
#define EXPECT(component, allowed)                                                          \
    Instance *x = (Instance *)(component);                                                  \
    if (refuses(x, (allowed), __func__))                                                    \
    return ERROR

#define TRY(x, call)                                                                        \
    do {                                                                                    \
        if (done((x), (call)) != OK)                                                        \
            return ERROR;                                                                   \
    } while (0)

/* Puts the mechanism on its constraints, unless it is there. */
static Status place(Instance *x)
{
    if (!x->placed) {
        TRY(x, bricard_assemble(x->m, x->begin));
        TRY(x, bricard_state(x->m, &x->t, x->q, x->v, x->n));
        x->placed = 1;
    }
    return OK;
}

static bricard_status evaluate(Instance *x, int quantity, size_t size)
{
    bricard_point at;
    at.t = x->t;
    at.q = x->q;
    at.v = x->v;
    at.n = x->n;
    return bricard_evaluate(x->m, quantity, &at, x->room, size);
}

/* ---- life ----------------------------------------------------------------------------------- */

static void release(Instance *x)
{
    if (!x)
        return;
    bricard_free(&x->m);
    free(x->q);
    free(x->v);
    free(x->u);
    free(x->along);
    free(x->room);
    free(x->name);
    free(x);
}

/* Everything as the description has it. */
static bricard_status begin_anew(Instance *x)
{
    bricard_free(&x->m);
    x->phase = INSTANTIATED;
    x->placed = x->drifted = 0;
    x->t = x->begin = 0.0;
    x->stop = INFINITY;
    if (x->u)
        memcpy(x->u, INPUTS, x->inputs * sizeof(double));
    return MECHANISM_CREATE(&x->m);
}

static int count_all(Instance *x)
{
    size_t states = 0;
    if (bricard_count(x->m, BRICARD_COORDINATES, &x->f) ||
        bricard_count(x->m, BRICARD_STATES, &states) ||
        bricard_count(x->m, BRICARD_CONSTRAINTS, &x->r) ||
        bricard_count(x->m, BRICARD_PARAMETERS, &x->parameters) ||
        bricard_count(x->m, BRICARD_INPUTS, &x->inputs) ||
        bricard_count(x->m, BRICARD_OUTPUTS, &x->outputs) ||
        bricard_count(x->m, BRICARD_EVENTS, &x->events))
        return 0;
    x->n = x->f + states;
    return 1;
}

static double *doubles(size_t count)
{
    return (double *)calloc(count + 1, sizeof(double));
}

/* An instance of a name; NULL if there is no memory. */
static Instance *make(const char *name, int is_cosimulation, int logging, const Host *host)
{
    static const int EVALUATED[] = {BRICARD_RESIDUAL, BRICARD_RATE,         BRICARD_ACCELERATION,
                                    BRICARD_REACTION, BRICARD_OUTPUT,       BRICARD_EVENT,
                                    BRICARD_ENERGY,   BRICARD_SLOPE,        BRICARD_OUTPUT_SLOPE,
                                    BRICARD_EVENT_SLOPE};
    size_t most = 0, i;
    Instance *x = (Instance *)calloc(1, sizeof *x);
    if (!x)
        return NULL;
    x->host = *host;
    x->is_cosimulation = is_cosimulation;
    x->logging = logging;
    x->name = (char *)malloc(strlen(name) + 1);
    if (!x->name || begin_anew(x) != BRICARD_OK || !count_all(x)) {
        release(x);
        return NULL;
    }
    strcpy(x->name, name);
    for (i = 0; i < sizeof EVALUATED / sizeof *EVALUATED; i++) {
        size_t size = 0;
        bricard_size(x->m, EVALUATED[i], &size);
        most = size > most ? size : most;
    }
    x->q = doubles(x->f);
    x->v = doubles(x->n);
    x->u = doubles(x->inputs);
    x->along = doubles(x->f + x->n + x->inputs);
    x->room = doubles(most);
    if (!x->q || !x->v || !x->u || !x->along || !x->room) {
        release(x);
        return NULL;
    }
    memcpy(x->u, INPUTS, x->inputs * sizeof(double));
    return x;
}

/* Makes an instance for a host that names the mechanism it wants by its token. */
static Instance *instantiate(const char *name, const char *token, int is_cosimulation,
                             int logging, const Host *host)
{
    if (!name || !*name)
        return NULL;
    if (!token || strcmp(token, MECHANISM_TOKEN)) {
        tell_host(host, name, ERROR, "this is another mechanism: its token is " MECHANISM_TOKEN);
        return NULL;
    }
    return make(name, is_cosimulation, logging, host);
}

/* When the motion begins, when it ends and the tolerance of steps, if these are given. */
static Status set_up(Instance *x, double start, const double *stop, const double *tolerance)
{
    bricard_options options;
    x->t = x->begin = start;
    x->stop = stop ? *stop : INFINITY;
    if (tolerance) {
        TRY(x, bricard_get_options(x->m, &options));
        options.rtol = options.atol = *tolerance;
        TRY(x, bricard_set_options(x->m, &options));
    }
    return OK;
}

static Status set_free(Instance *x)
{
    if (place(x) != OK)
        return ERROR;
    x->phase = x->is_cosimulation ? STEPPING : EVENT;
    return OK;
}

/* ---- values --------------------------------------------------------------------------------- */

/* Evaluates a quantity at the state at hand. Where there is none at one that an integrator
   tries, it may try another one. */
static Status evaluate_here(Instance *x, int quantity, size_t size)
{
    if (!x->is_cosimulation)
        return evaluate(x, quantity, size) < 0 ? complain(x, DISCARD, bricard_message(x->m)) : OK;
    return done(x, evaluate(x, quantity, size));
}

/* The energies, outputs, … that are evaluated together. */
static Status value(Instance *x, int kind, size_t place, double *out)
{
    int held;
    Status status;
    switch (kind) {
    case Q:
        *out = x->q[place];
        return OK;
    case V:
        *out = x->v[place];
        return OK;
    case Z:
        *out = x->v[x->f + place];
        return OK;
    case TIME:
        *out = x->t;
        return OK;
    case A:
        status = evaluate_here(x, BRICARD_ACCELERATION, x->n);
        break;
    case RATE_Z:
        status = evaluate_here(x, BRICARD_ACCELERATION, x->n);
        place += x->f;
        break;
    case R:
        status = evaluate_here(x, BRICARD_REACTION, x->n);
        break;
    case OUTPUT:
        status = evaluate_here(x, BRICARD_OUTPUT, x->outputs);
        break;
    case INDICATOR:
        status = evaluate_here(x, BRICARD_EVENT, x->events);
        break;
    case KINETIC:
    case POTENTIAL:
        status = evaluate_here(x, BRICARD_ENERGY, 4);
        place = kind == POTENTIAL;
        break;
    case PARAMETER:
        TRY(x, bricard_parameter(x->m, place, out));
        return OK;
    case START_Q:
    case START_V:
        TRY(x, bricard_start(x->m, place, kind == START_V, out, &held));
        return OK;
    case START_Z:
        TRY(x, bricard_start(x->m, x->f + place, 1, out, &held));
        return OK;
    default:
        *out = x->u[place];
        return OK;
    }
    if (status == OK)
        *out = x->room[place];
    return status;
}

/* Whether a variable is known without a state. */
static int is_given(int kind)
{
    return kind == PARAMETER || kind == START_Q || kind == START_V || kind == START_Z;
}

static Status get(Instance *x, const unsigned int references[], size_t count, double values[])
{
    size_t i, at;
    Status status;
    for (i = 0; i < count; i++) {
        int kind = place_of(x, references[i], &at);
        if (kind == KINDS)
            return complain(x, ERROR, "there is no variable of this value reference");
        if (!is_given(kind) && place(x) != OK)
            return ERROR;
        status = value(x, kind, at, &values[i]);
        if (status != OK)
            return status;
    }
    return OK;
}

/* A velocity that the host sets to another value is held; so is a position that the description
   holds, and a guess remains one. Hosts that set all variables to what they are change nothing. */
static Status set_start(Instance *x, size_t at, int velocity, double number)
{
    double before;
    int held;
    TRY(x, bricard_start(x->m, at, velocity, &before, &held));
    held |= velocity && number != before;
    TRY(x, bricard_set_start(x->m, at, velocity, number, held));
    return OK;
}

static Status set_one(Instance *x, unsigned int reference, double number)
{
    size_t at;
    int kind = place_of(x, reference, &at);
    if (kind == INPUT) {
        TRY(x, bricard_hold_input(x->m, at, number));
        x->u[at] = number;
        return OK;
    }
    if (!is_given(kind))
        return complain(x, ERROR, "there is no variable of this value reference to be set");
    if (!(x->phase & (INSTANTIATED | INITIALISING)))
        return complain(x, ERROR, "parameters are set before the motion begins");
    x->placed = 0;
    if (kind != PARAMETER)
        return set_start(x, kind == START_Z ? x->f + at : at, kind != START_Q, number);
    TRY(x, bricard_set_parameter(x->m, at, number));
    return OK;
}

static Status set(Instance *x, const unsigned int references[], size_t count,
                  const double values[])
{
    size_t i;
    for (i = 0; i < count; i++)
        if (set_one(x, references[i], values[i]) != OK)
            return ERROR;
    return OK;
}

/* ---- derivatives ---------------------------------------------------------------------------- */

/* What changes by itself with a coordinate, velocity, state or input: its place in a
   direction. The derivative of a coordinate is the velocity. */
static int place_in_direction(const Instance *x, int kind, size_t at, size_t *place)
{
    switch (kind) {
    case Q:
        *place = at;
        return 1;
    case V:
        *place = x->f + at;
        return 1;
    case Z:
        *place = x->f + x->f + at;
        return 1;
    case INPUT:
        *place = x->f + x->n + at;
        return 1;
    default:
        return 0;
    }
}

/* How an unknown changes along the direction; `evaluated` is what the room holds the
   derivatives of. */
static Status change(Instance *x, unsigned int reference, int *evaluated, double *result)
{
    const size_t width = x->f + x->n + x->inputs;
    size_t at, own, size = 0, i;
    int quantity, kind = place_of(x, reference, &at);
    *result = 0.0;
    if (place_in_direction(x, kind, at, &own)) {
        *result = x->along[own];
        return OK;
    }
    switch (kind) {
    case A:
    case RATE_Z:
        quantity = BRICARD_SLOPE;
        at += kind == RATE_Z ? x->f : 0;
        break;
    case OUTPUT:
        quantity = BRICARD_OUTPUT_SLOPE;
        break;
    case INDICATOR:
        quantity = BRICARD_EVENT_SLOPE;
        break;
    default:
        return complain(x, ERROR, "derivatives are those of states, outputs and events");
    }
    if (*evaluated != quantity) {
        TRY(x, bricard_size(x->m, quantity, &size));
        TRY(x, evaluate(x, quantity, size));
        *evaluated = quantity;
    }
    for (i = 0; i < width; i++)
        *result += x->room[at * width + i] * x->along[i];
    return OK;
}

static Status directional(Instance *x, const unsigned int unknown[], size_t unknowns,
                          const unsigned int known[], size_t knowns, const double seed[],
                          double result[])
{
    size_t i, at, own, size = 0;
    int evaluated = -1;
    TRY(x, bricard_size(x->m, BRICARD_SLOPE, &size));
    if (!size)
        return complain(x, ERROR, "directional derivatives are not provided");
    if (place(x) != OK)
        return ERROR;
    memset(x->along, 0, (x->f + x->n + x->inputs) * sizeof(double));
    for (i = 0; i < knowns; i++) {
        int kind = place_of(x, known[i], &at);
        if (!place_in_direction(x, kind, at, &own))
            return complain(x, ERROR, "derivatives are by states and inputs");
        x->along[own] += seed[i];
    }
    for (i = 0; i < unknowns; i++)
        if (change(x, unknown[i], &evaluated, &result[i]) != OK)
            return ERROR;
    return OK;
}

/* ---- snapshots ------------------------------------------------------------------------------ */

/* The head of what is written of an instance, before the numbers of the mechanism. */
enum { HEAD = 8 };

static Status become(Instance *x, const Instance *y)
{
    if (!y)
        return complain(x, ERROR, "there is no such state");
    TRY(x, bricard_assign(x->m, y->m));
    memcpy(x->q, y->q, x->f * sizeof(double));
    memcpy(x->v, y->v, x->n * sizeof(double));
    memcpy(x->u, y->u, x->inputs * sizeof(double));
    x->phase = y->phase;
    x->placed = y->placed;
    x->drifted = y->drifted;
    x->t = y->t;
    x->begin = y->begin;
    x->stop = y->stop;
    return OK;
}

static Status keep(Instance *x, void **state)
{
    if (!state)
        return complain(x, ERROR, "there is no place for the state");
    if (!*state)
        *state = make(x->name, x->is_cosimulation, 0, &x->host);
    if (!*state)
        return complain(x, ERROR, "there is no memory for the state");
    return become((Instance *)*state, x);
}

/* How many numbers are written besides those of the mechanism. */
static size_t own_numbers(const Instance *x)
{
    return HEAD + x->f + x->n + x->inputs;
}

static Status written_size(Instance *x, size_t *size)
{
    size_t numbers = 0;
    TRY(x, bricard_size(x->m, BRICARD_SAVED, &numbers));
    *size = (own_numbers(x) + numbers) * sizeof(double);
    return OK;
}

static Status write_down(Instance *x, const Instance *y, void *bytes, size_t size)
{
    size_t wanted = 0;
    double *numbers, *next;
    bricard_options options;
    bricard_status saved;
    if (written_size(x, &wanted) != OK || !y || size < wanted)
        return complain(x, ERROR, "there is no such state, or no room for it");
    TRY(x, bricard_get_options(y->m, &options));
    numbers = (double *)malloc(wanted);
    if (!numbers)
        return complain(x, ERROR, "there is no memory for the state");
    numbers[0] = y->phase;
    numbers[1] = y->placed;
    numbers[2] = y->drifted;
    numbers[3] = y->t;
    numbers[4] = y->begin;
    numbers[5] = y->stop;
    numbers[6] = options.rtol;
    numbers[7] = options.atol;
    next = numbers + HEAD;
    memcpy(next, y->q, x->f * sizeof(double));
    next += x->f;
    memcpy(next, y->v, x->n * sizeof(double));
    next += x->n;
    memcpy(next, y->u, x->inputs * sizeof(double));
    next += x->inputs;
    saved = bricard_save(y->m, next, wanted / sizeof(double) - own_numbers(x));
    memcpy(bytes, numbers, wanted);
    free(numbers);
    return done_by(x, y->m, saved);
}

static void forget(void **state)
{
    if (state) {
        release((Instance *)*state);
        *state = NULL;
    }
}

static Status read_back(Instance *x, const void *bytes, size_t size, void **state)
{
    Instance *y;
    size_t wanted = 0;
    double *numbers, *next;
    bricard_options options;
    bricard_status loaded;
    Status status;
    const int is_new = state && !*state;
    if (written_size(x, &wanted) != OK || size != wanted)
        return complain(x, ERROR, "this is no state of this mechanism");
    numbers = (double *)malloc(wanted);
    if (!numbers)
        return complain(x, ERROR, "there is no memory for the state");
    if (keep(x, state) != OK) {
        free(numbers);
        return ERROR;
    }
    y = (Instance *)*state;
    memcpy(numbers, bytes, wanted);
    y->phase = (int)numbers[0];
    y->placed = (int)numbers[1];
    y->drifted = (int)numbers[2];
    y->t = numbers[3];
    y->begin = numbers[4];
    y->stop = numbers[5];
    next = numbers + HEAD;
    memcpy(y->q, next, x->f * sizeof(double));
    next += x->f;
    memcpy(y->v, next, x->n * sizeof(double));
    next += x->n;
    memcpy(y->u, next, x->inputs * sizeof(double));
    next += x->inputs;
    loaded = bricard_load(y->m, next, wanted / sizeof(double) - own_numbers(x));
    if (loaded >= 0)
        loaded = bricard_get_options(y->m, &options);
    if (loaded >= 0) {
        options.rtol = numbers[6];
        options.atol = numbers[7];
        loaded = bricard_set_options(y->m, &options);
    }
    free(numbers);
    status = done_by(x, y->m, loaded);
    if (status != OK && is_new)
        forget(state);
    return status;
}

/* ---- model exchange ------------------------------------------------------------------------- */

/* Brings a state that has drifted back onto the constraints; whether that was necessary. */
static Status bring_back(Instance *x, int *changed)
{
    *changed = x->drifted;
    if (x->drifted)
        TRY(x, bricard_project(x->m, x->t, x->q, x->v, x->n));
    x->drifted = 0;
    return OK;
}

/* Whether a state is off the constraints by too much. */
static Status check_drift(Instance *x)
{
    size_t i;
    TRY(x, evaluate(x, BRICARD_RESIDUAL, x->r));
    for (i = 0; i < x->r; i++)
        x->drifted |= fabs(x->room[i]) > DRIFT;
    TRY(x, evaluate(x, BRICARD_RATE, x->r));
    for (i = 0; i < x->r; i++)
        x->drifted |= fabs(x->room[i]) > DRIFT;
    return OK;
}

/* Refuses a number of states or indicators that is another. */
static Status counted(Instance *x, size_t count, size_t wanted)
{
    return count == wanted ? OK : complain(x, ERROR, "an array has another length");
}

static Status set_states(Instance *x, const double states[], size_t count)
{
    if (counted(x, count, x->f + x->n) != OK)
        return ERROR;
    memcpy(x->q, states, x->f * sizeof(double));
    memcpy(x->v, states + x->f, x->n * sizeof(double));
    return OK;
}

static Status get_states(Instance *x, double states[], size_t count)
{
    if (counted(x, count, x->f + x->n) != OK || place(x) != OK)
        return ERROR;
    memcpy(states, x->q, x->f * sizeof(double));
    memcpy(states + x->f, x->v, x->n * sizeof(double));
    return OK;
}

static Status get_derivatives(Instance *x, double derivatives[], size_t count)
{
    Status status;
    if (counted(x, count, x->f + x->n) != OK || place(x) != OK)
        return ERROR;
    status = evaluate_here(x, BRICARD_ACCELERATION, x->n);
    if (status != OK)
        return status;
    memcpy(derivatives, x->v, x->f * sizeof(double));
    memcpy(derivatives + x->f, x->room, x->n * sizeof(double));
    return OK;
}

static Status get_nominals(Instance *x, double nominals[], size_t count)
{
    size_t i;
    if (counted(x, count, x->f + x->n) != OK)
        return ERROR;
    for (i = 0; i < count; i++)
        nominals[i] = 1.0;
    return OK;
}

static Status get_indicators(Instance *x, double indicators[], size_t count)
{
    Status status;
    if (counted(x, count, x->events) != OK || place(x) != OK)
        return ERROR;
    status = evaluate_here(x, BRICARD_EVENT, x->events);
    if (status == OK)
        memcpy(indicators, x->room, count * sizeof(double));
    return status;
}

/* ---- co-simulation -------------------------------------------------------------------------- */

static Status go_on(Instance *x, double t, double step)
{
    if (!(step >= 0.0) || fabs(t - x->t) > 1e-9 * (1.0 + fabs(t)))
        return complain(x, ERROR, "a step begins where the last one ended, and goes on");
    if (t + step - x->stop > 1e-9 * (1.0 + fabs(x->stop)))
        return complain(x, ERROR, "a step goes beyond the stop time of the experiment");
    /* What is left of sums of steps may end at the time that it is, or a trifle before. */
    if (!(t + step > x->t))
        return OK;
    TRY(x, bricard_step(x->m, t + step - x->t));
    TRY(x, bricard_state(x->m, &x->t, x->q, x->v, x->n));
    return OK;
}
