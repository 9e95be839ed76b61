/* FMI 2.0, model exchange and co-simulation, over bricard.h: the same for all mechanisms.
   It is included by a file that says which one: MECHANISM_CREATE, MECHANISM_GUID, and
   MECHANISM_INPUTS, what inputs are told to be until they are set. */
#include "bricard.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined _WIN32 || defined __CYGWIN__
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

/* ---- what the standard declares ---------------------------------------------------------- */

typedef void *fmi2Component;
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef const char *fmi2String;
typedef char fmi2Byte;

typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum {
    fmi2DoStepStatus,
    fmi2PendingStatus,
    fmi2LastSuccessfulTime,
    fmi2Terminated
} fmi2StatusKind;

typedef struct {
    void (*logger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
    void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;

typedef struct {
    fmi2Boolean newDiscreteStatesNeeded;
    fmi2Boolean terminateSimulation;
    fmi2Boolean nominalsOfContinuousStatesChanged;
    fmi2Boolean valuesOfContinuousStatesChanged;
    fmi2Boolean nextEventTimeDefined;
    fmi2Real nextEventTime;
} fmi2EventInfo;

/* ---- an instance -------------------------------------------------------------------------- */

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
    double t, begin;
    size_t n, r, parameters, inputs, outputs, events;
    /* Coordinates, velocities, inputs, and room for what is evaluated of them. */
    double *q, *v, *u, *room;
    char *name;
    fmi2CallbackFunctions functions;
} Instance;

/* What value references count, in this order. */
enum { Q, V, A, R, PARAMETER, INPUT, OUTPUT, START_Q, START_V, KINETIC, POTENTIAL, KINDS };

static size_t sized(const Instance *x, int kind)
{
    switch (kind) {
    case PARAMETER:
        return x->parameters;
    case INPUT:
        return x->inputs;
    case OUTPUT:
        return x->outputs;
    case KINETIC:
    case POTENTIAL:
        return 1;
    default:
        return x->n;
    }
}

/* The kind and the place of a variable; KINDS if there is none. */
static int place_of(const Instance *x, fmi2ValueReference reference, size_t *place)
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

static fmi2Status complain(Instance *x, fmi2Status status, const char *message)
{
    if (x->functions.logger && (x->logging || status >= fmi2Error))
        x->functions.logger(x->functions.componentEnvironment, x->name, status, "logStatusError",
                            "%s", message);
    if (status >= fmi2Error)
        x->phase = FAILED;
    return status;
}

/* The status of a call of bricard.h. */
static fmi2Status done(Instance *x, bricard_status status)
{
    return status < 0 ? complain(x, fmi2Error, bricard_message(x->m)) : fmi2OK;
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
    complain(x, fmi2Error, text);
    return 1;
}

#define EXPECT(x, allowed)                                                                  \
    do {                                                                                    \
        if (refuses((x), (allowed), __func__))                                              \
            return fmi2Error;                                                               \
    } while (0)

#define TRY(x, call)                                                                        \
    do {                                                                                    \
        if (done((x), (call)) != fmi2OK)                                                    \
            return fmi2Error;                                                               \
    } while (0)

/* Puts the mechanism on its constraints, unless it is there. */
static fmi2Status place(Instance *x)
{
    if (!x->placed) {
        TRY(x, bricard_assemble(x->m, x->begin));
        TRY(x, bricard_state(x->m, &x->t, x->q, x->v, x->n));
        x->placed = 1;
    }
    return fmi2OK;
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

EXPORT const char *fmi2GetTypesPlatform(void)
{
    return "default";
}

EXPORT const char *fmi2GetVersion(void)
{
    return "2.0";
}

EXPORT void fmi2FreeInstance(fmi2Component component)
{
    Instance *x = (Instance *)component;
    if (!x)
        return;
    bricard_free(&x->m);
    free(x->q);
    free(x->v);
    free(x->u);
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
    return MECHANISM_CREATE(&x->m);
}

static int make(Instance *x, fmi2String name)
{
    size_t most;
    if (begin_anew(x) != BRICARD_OK || bricard_count(x->m, BRICARD_COORDINATES, &x->n) ||
        bricard_count(x->m, BRICARD_CONSTRAINTS, &x->r) ||
        bricard_count(x->m, BRICARD_PARAMETERS, &x->parameters) ||
        bricard_count(x->m, BRICARD_INPUTS, &x->inputs) ||
        bricard_count(x->m, BRICARD_OUTPUTS, &x->outputs) ||
        bricard_count(x->m, BRICARD_EVENTS, &x->events))
        return 0;
    most = x->n + x->r + x->outputs + x->events + 4;
    x->q = (double *)calloc(x->n, sizeof(double));
    x->v = (double *)calloc(x->n, sizeof(double));
    x->u = (double *)calloc(x->inputs + 1, sizeof(double));
    x->room = (double *)calloc(most, sizeof(double));
    x->name = (char *)malloc(strlen(name) + 1);
    if (!x->q || !x->v || !x->u || !x->room || !x->name)
        return 0;
    strcpy(x->name, name);
    memcpy(x->u, INPUTS, x->inputs * sizeof(double));
    return 1;
}

EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid,
                                     fmi2String resources,
                                     const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                                     fmi2Boolean logging)
{
    Instance *x;
    (void)resources;
    (void)visible;
    if (!functions || !name || !*name)
        return NULL;
    if (!guid || strcmp(guid, MECHANISM_GUID)) {
        if (functions->logger)
            functions->logger(functions->componentEnvironment, name, fmi2Error, "logStatusError",
                              "this is another mechanism: its guid is " MECHANISM_GUID);
        return NULL;
    }
    x = (Instance *)calloc(1, sizeof *x);
    if (!x)
        return NULL;
    x->functions = *functions;
    x->is_cosimulation = type == fmi2CoSimulation;
    x->logging = logging;
    if (!make(x, name)) {
        fmi2FreeInstance(x);
        return NULL;
    }
    return x;
}

EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component component, fmi2Boolean logging, size_t count,
                                      const fmi2String categories[])
{
    Instance *x = (Instance *)component;
    (void)count;
    (void)categories;
    EXPECT(x, ANY);
    x->logging = logging;
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean with_tolerance,
                                      fmi2Real tolerance, fmi2Real start, fmi2Boolean with_stop,
                                      fmi2Real stop)
{
    Instance *x = (Instance *)component;
    bricard_options options;
    (void)with_stop;
    (void)stop;
    EXPECT(x, INSTANTIATED);
    x->t = x->begin = start;
    if (with_tolerance) {
        TRY(x, bricard_get_options(x->m, &options));
        options.rtol = options.atol = tolerance;
        TRY(x, bricard_set_options(x->m, &options));
    }
    return fmi2OK;
}

EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component component)
{
    Instance *x = (Instance *)component;
    EXPECT(x, INSTANTIATED);
    x->phase = INITIALISING;
    return fmi2OK;
}

EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component component)
{
    Instance *x = (Instance *)component;
    EXPECT(x, INITIALISING);
    if (place(x) != fmi2OK)
        return fmi2Error;
    x->phase = x->is_cosimulation ? STEPPING : EVENT;
    return fmi2OK;
}

EXPORT fmi2Status fmi2Terminate(fmi2Component component)
{
    Instance *x = (Instance *)component;
    EXPECT(x, EVENT | CONTINUOUS | STEPPING);
    x->phase = TERMINATED;
    return fmi2OK;
}

EXPORT fmi2Status fmi2Reset(fmi2Component component)
{
    Instance *x = (Instance *)component;
    EXPECT(x, ANY);
    return done(x, begin_anew(x));
}

/* ---- values --------------------------------------------------------------------------------- */

/* The energies, outputs, … that are evaluated together. */
static fmi2Status value(Instance *x, int kind, size_t place, double *out)
{
    int held;
    switch (kind) {
    case Q:
        *out = x->q[place];
        return fmi2OK;
    case V:
        *out = x->v[place];
        return fmi2OK;
    case A:
        TRY(x, evaluate(x, BRICARD_ACCELERATION, x->n));
        break;
    case R:
        TRY(x, evaluate(x, BRICARD_REACTION, x->n));
        break;
    case OUTPUT:
        TRY(x, evaluate(x, BRICARD_OUTPUT, x->outputs));
        break;
    case KINETIC:
    case POTENTIAL:
        TRY(x, evaluate(x, BRICARD_ENERGY, 4));
        place = kind == POTENTIAL;
        break;
    case PARAMETER:
        TRY(x, bricard_parameter(x->m, place, out));
        return fmi2OK;
    case START_Q:
    case START_V:
        TRY(x, bricard_start(x->m, place, kind == START_V, out, &held));
        return fmi2OK;
    default:
        *out = x->u[place];
        return fmi2OK;
    }
    *out = x->room[place];
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetReal(fmi2Component component, const fmi2ValueReference references[],
                              size_t count, fmi2Real values[])
{
    Instance *x = (Instance *)component;
    size_t i, at;
    EXPECT(x, RUNNING | TERMINATED);
    for (i = 0; i < count; i++) {
        int kind = place_of(x, references[i], &at);
        if (kind == KINDS)
            return complain(x, fmi2Error, "there is no variable of this value reference");
        if (kind != PARAMETER && kind != START_Q && kind != START_V && place(x) != fmi2OK)
            return fmi2Error;
        if (value(x, kind, at, &values[i]) != fmi2OK)
            return fmi2Error;
    }
    return fmi2OK;
}

static fmi2Status set(Instance *x, fmi2ValueReference reference, double number)
{
    size_t at;
    double before;
    int held, kind = place_of(x, reference, &at);
    switch (kind) {
    case INPUT:
        TRY(x, bricard_hold_input(x->m, at, number));
        x->u[at] = number;
        return fmi2OK;
    case PARAMETER:
    case START_Q:
    case START_V:
        if (!(x->phase & (INSTANTIATED | INITIALISING)))
            return complain(x, fmi2Error, "parameters are set before the motion begins");
        x->placed = 0;
        if (kind == PARAMETER) {
            TRY(x, bricard_set_parameter(x->m, at, number));
            return fmi2OK;
        }
        TRY(x, bricard_start(x->m, at, kind == START_V, &before, &held));
        TRY(x, bricard_set_start(x->m, at, kind == START_V, number, held));
        return fmi2OK;
    default:
        return complain(x, fmi2Error, "there is no variable of this value reference to be set");
    }
}

EXPORT fmi2Status fmi2SetReal(fmi2Component component, const fmi2ValueReference references[],
                              size_t count, const fmi2Real values[])
{
    Instance *x = (Instance *)component;
    size_t i;
    EXPECT(x, INSTANTIATED | RUNNING);
    for (i = 0; i < count; i++)
        if (set(x, references[i], values[i]) != fmi2OK)
            return fmi2Error;
    return fmi2OK;
}

/* There are no variables but real ones. */
static fmi2Status none(fmi2Component component, size_t count)
{
    Instance *x = (Instance *)component;
    EXPECT(x, ANY);
    return count ? complain(x, fmi2Error, "all variables are real") : fmi2OK;
}

#define NO_VARIABLES(name, type)                                                            \
    EXPORT fmi2Status fmi2Get##name(fmi2Component component,                                \
                                    const fmi2ValueReference references[], size_t count,    \
                                    type values[])                                          \
    {                                                                                       \
        (void)references;                                                                   \
        (void)values;                                                                       \
        return none(component, count);                                                      \
    }                                                                                       \
    EXPORT fmi2Status fmi2Set##name(fmi2Component component,                                \
                                    const fmi2ValueReference references[], size_t count,    \
                                    const type values[])                                    \
    {                                                                                       \
        (void)references;                                                                   \
        (void)values;                                                                       \
        return none(component, count);                                                      \
    }

NO_VARIABLES(Integer, fmi2Integer)
NO_VARIABLES(Boolean, fmi2Boolean)
NO_VARIABLES(String, fmi2String)

/* ---- snapshots ------------------------------------------------------------------------------ */

/* The head of what is written of an instance, before the numbers of the mechanism. */
enum { HEAD = 5 };

EXPORT fmi2Status fmi2FreeFMUstate(fmi2Component component, fmi2FMUstate *state)
{
    Instance *x = (Instance *)component;
    EXPECT(x, ANY);
    if (state) {
        fmi2FreeInstance(*state);
        *state = NULL;
    }
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetFMUstate(fmi2Component component, fmi2FMUstate state)
{
    Instance *x = (Instance *)component;
    const Instance *y = (const Instance *)state;
    EXPECT(x, ANY);
    if (!y)
        return complain(x, fmi2Error, "there is no such state");
    TRY(x, bricard_assign(x->m, y->m));
    memcpy(x->q, y->q, x->n * sizeof(double));
    memcpy(x->v, y->v, x->n * sizeof(double));
    memcpy(x->u, y->u, x->inputs * sizeof(double));
    x->phase = y->phase;
    x->placed = y->placed;
    x->drifted = y->drifted;
    x->t = y->t;
    x->begin = y->begin;
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetFMUstate(fmi2Component component, fmi2FMUstate *state)
{
    Instance *x = (Instance *)component;
    EXPECT(x, ANY);
    if (!state)
        return complain(x, fmi2Error, "there is no place for the state");
    if (!*state)
        *state = fmi2Instantiate(x->name, x->is_cosimulation ? fmi2CoSimulation : fmi2ModelExchange,
                                 MECHANISM_GUID, NULL, &x->functions, 0, 0);
    if (!*state)
        return complain(x, fmi2Error, "there is no memory for the state");
    return fmi2SetFMUstate(*state, x);
}

EXPORT fmi2Status fmi2SerializedFMUstateSize(fmi2Component component, fmi2FMUstate state,
                                             size_t *size)
{
    Instance *x = (Instance *)component;
    size_t numbers = 0;
    EXPECT(x, ANY);
    (void)state;
    TRY(x, bricard_size(x->m, BRICARD_SAVED, &numbers));
    *size = (HEAD + 2 * x->n + x->inputs + numbers) * sizeof(double);
    return fmi2OK;
}

EXPORT fmi2Status fmi2SerializeFMUstate(fmi2Component component, fmi2FMUstate state,
                                        fmi2Byte bytes[], size_t size)
{
    Instance *x = (Instance *)component, *y = (Instance *)state;
    size_t wanted = 0, count;
    double *numbers;
    bricard_status saved;
    EXPECT(x, ANY);
    TRY(x, fmi2SerializedFMUstateSize(x, state, &wanted) == fmi2OK ? 0 : -1);
    if (!y || size < wanted)
        return complain(x, fmi2Error, "there is not room for the state");
    numbers = (double *)calloc(wanted, 1);
    if (!numbers)
        return complain(x, fmi2Error, "there is no memory for the state");
    count = wanted / sizeof(double) - HEAD - 2 * x->n - x->inputs;
    numbers[0] = y->phase;
    numbers[1] = y->placed;
    numbers[2] = y->drifted;
    numbers[3] = y->t;
    numbers[4] = y->begin;
    memcpy(numbers + HEAD, y->q, x->n * sizeof(double));
    memcpy(numbers + HEAD + x->n, y->v, x->n * sizeof(double));
    memcpy(numbers + HEAD + 2 * x->n, y->u, x->inputs * sizeof(double));
    saved = bricard_save(y->m, numbers + HEAD + 2 * x->n + x->inputs, count);
    memcpy(bytes, numbers, wanted);
    free(numbers);
    return done(x, saved);
}

EXPORT fmi2Status fmi2DeSerializeFMUstate(fmi2Component component, const fmi2Byte bytes[],
                                          size_t size, fmi2FMUstate *state)
{
    Instance *x = (Instance *)component, *y;
    size_t wanted = 0, count;
    double *numbers;
    bricard_status loaded;
    EXPECT(x, ANY);
    if (fmi2SerializedFMUstateSize(x, NULL, &wanted) != fmi2OK || size != wanted)
        return complain(x, fmi2Error, "this is no state of this mechanism");
    if (fmi2GetFMUstate(x, state) != fmi2OK)
        return fmi2Error;
    y = (Instance *)*state;
    numbers = (double *)malloc(wanted);
    if (!numbers)
        return complain(x, fmi2Error, "there is no memory for the state");
    memcpy(numbers, bytes, wanted);
    count = wanted / sizeof(double) - HEAD - 2 * x->n - x->inputs;
    y->phase = (int)numbers[0];
    y->placed = (int)numbers[1];
    y->drifted = (int)numbers[2];
    y->t = numbers[3];
    y->begin = numbers[4];
    memcpy(y->q, numbers + HEAD, x->n * sizeof(double));
    memcpy(y->v, numbers + HEAD + x->n, x->n * sizeof(double));
    memcpy(y->u, numbers + HEAD + 2 * x->n, x->inputs * sizeof(double));
    loaded = bricard_load(y->m, numbers + HEAD + 2 * x->n + x->inputs, count);
    free(numbers);
    return done(x, loaded);
}

EXPORT fmi2Status fmi2GetDirectionalDerivative(fmi2Component component,
                                               const fmi2ValueReference unknown[],
                                               size_t unknowns, const fmi2ValueReference known[],
                                               size_t knowns, const fmi2Real seed[],
                                               fmi2Real result[])
{
    Instance *x = (Instance *)component;
    (void)unknown;
    (void)unknowns;
    (void)known;
    (void)knowns;
    (void)seed;
    (void)result;
    EXPECT(x, ANY);
    return complain(x, fmi2Error, "directional derivatives are not provided");
}

/* ---- model exchange ------------------------------------------------------------------------- */

EXPORT fmi2Status fmi2EnterEventMode(fmi2Component component)
{
    Instance *x = (Instance *)component;
    EXPECT(x, EVENT | CONTINUOUS);
    x->phase = EVENT;
    return fmi2OK;
}

EXPORT fmi2Status fmi2NewDiscreteStates(fmi2Component component, fmi2EventInfo *info)
{
    Instance *x = (Instance *)component;
    EXPECT(x, EVENT);
    memset(info, 0, sizeof *info);
    if (x->drifted) {
        TRY(x, bricard_project(x->m, x->t, x->q, x->v, x->n));
        info->valuesOfContinuousStatesChanged = 1;
        x->drifted = 0;
    }
    return fmi2OK;
}

EXPORT fmi2Status fmi2EnterContinuousTimeMode(fmi2Component component)
{
    Instance *x = (Instance *)component;
    EXPECT(x, EVENT);
    x->phase = CONTINUOUS;
    return fmi2OK;
}

EXPORT fmi2Status fmi2CompletedIntegratorStep(fmi2Component component, fmi2Boolean no_prior,
                                              fmi2Boolean *event, fmi2Boolean *terminate)
{
    Instance *x = (Instance *)component;
    size_t i;
    (void)no_prior;
    EXPECT(x, CONTINUOUS);
    *event = *terminate = 0;
    TRY(x, evaluate(x, BRICARD_RESIDUAL, x->r));
    for (i = 0; i < x->r; i++)
        x->drifted |= fabs(x->room[i]) > DRIFT;
    TRY(x, evaluate(x, BRICARD_RATE, x->r));
    for (i = 0; i < x->r; i++)
        x->drifted |= fabs(x->room[i]) > DRIFT;
    *event = x->drifted;
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetTime(fmi2Component component, fmi2Real t)
{
    Instance *x = (Instance *)component;
    EXPECT(x, EVENT | CONTINUOUS);
    x->t = t;
    return fmi2OK;
}

/* Refuses a number of states or indicators that is another. */
static fmi2Status counted(Instance *x, size_t count, size_t wanted)
{
    return count == wanted ? fmi2OK : complain(x, fmi2Error, "an array has another length");
}

EXPORT fmi2Status fmi2SetContinuousStates(fmi2Component component, const fmi2Real states[],
                                          size_t count)
{
    Instance *x = (Instance *)component;
    EXPECT(x, EVENT | CONTINUOUS);
    if (counted(x, count, 2 * x->n) != fmi2OK)
        return fmi2Error;
    memcpy(x->q, states, x->n * sizeof(double));
    memcpy(x->v, states + x->n, x->n * sizeof(double));
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetContinuousStates(fmi2Component component, fmi2Real states[],
                                          size_t count)
{
    Instance *x = (Instance *)component;
    EXPECT(x, RUNNING | TERMINATED);
    if (counted(x, count, 2 * x->n) != fmi2OK || place(x) != fmi2OK)
        return fmi2Error;
    memcpy(states, x->q, x->n * sizeof(double));
    memcpy(states + x->n, x->v, x->n * sizeof(double));
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetDerivatives(fmi2Component component, fmi2Real derivatives[],
                                     size_t count)
{
    Instance *x = (Instance *)component;
    EXPECT(x, RUNNING | TERMINATED);
    if (counted(x, count, 2 * x->n) != fmi2OK || place(x) != fmi2OK)
        return fmi2Error;
    TRY(x, evaluate(x, BRICARD_ACCELERATION, x->n));
    memcpy(derivatives, x->v, x->n * sizeof(double));
    memcpy(derivatives + x->n, x->room, x->n * sizeof(double));
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component component,
                                                    fmi2Real nominals[], size_t count)
{
    Instance *x = (Instance *)component;
    size_t i;
    EXPECT(x, RUNNING | TERMINATED);
    if (counted(x, count, 2 * x->n) != fmi2OK)
        return fmi2Error;
    for (i = 0; i < count; i++)
        nominals[i] = 1.0;
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetEventIndicators(fmi2Component component, fmi2Real indicators[],
                                         size_t count)
{
    Instance *x = (Instance *)component;
    EXPECT(x, RUNNING | TERMINATED);
    if (counted(x, count, x->events) != fmi2OK || place(x) != fmi2OK)
        return fmi2Error;
    TRY(x, evaluate(x, BRICARD_EVENT, x->events));
    memcpy(indicators, x->room, count * sizeof(double));
    return fmi2OK;
}

/* ---- co-simulation -------------------------------------------------------------------------- */

EXPORT fmi2Status fmi2DoStep(fmi2Component component, fmi2Real t, fmi2Real step,
                             fmi2Boolean no_prior)
{
    Instance *x = (Instance *)component;
    (void)no_prior;
    EXPECT(x, STEPPING);
    if (!(step >= 0.0) || fabs(t - x->t) > 1e-9 * (1.0 + fabs(t)))
        return complain(x, fmi2Error, "a step begins where the last one ended, and goes on");
    TRY(x, bricard_step(x->m, t + step - x->t));
    TRY(x, bricard_state(x->m, &x->t, x->q, x->v, x->n));
    return fmi2OK;
}

EXPORT fmi2Status fmi2CancelStep(fmi2Component component)
{
    Instance *x = (Instance *)component;
    EXPECT(x, ANY);
    return complain(x, fmi2Error, "steps are done when they return");
}

EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component component,
                                              const fmi2ValueReference references[], size_t count,
                                              const fmi2Integer orders[], const fmi2Real values[])
{
    Instance *x = (Instance *)component;
    (void)references;
    (void)count;
    (void)orders;
    (void)values;
    EXPECT(x, ANY);
    return complain(x, fmi2Error, "derivatives of inputs are not used");
}

EXPORT fmi2Status fmi2GetRealOutputDerivatives(fmi2Component component,
                                               const fmi2ValueReference references[],
                                               size_t count, const fmi2Integer orders[],
                                               fmi2Real values[])
{
    Instance *x = (Instance *)component;
    (void)references;
    (void)count;
    (void)orders;
    (void)values;
    EXPECT(x, ANY);
    return complain(x, fmi2Error, "derivatives of outputs are not provided");
}

EXPORT fmi2Status fmi2GetStatus(fmi2Component component, fmi2StatusKind kind, fmi2Status *status)
{
    Instance *x = (Instance *)component;
    (void)kind;
    EXPECT(x, ANY);
    *status = x->phase == FAILED ? fmi2Error : fmi2OK;
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetRealStatus(fmi2Component component, fmi2StatusKind kind, fmi2Real *value)
{
    Instance *x = (Instance *)component;
    EXPECT(x, ANY);
    if (kind != fmi2LastSuccessfulTime)
        return fmi2Discard;
    *value = x->t;
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetIntegerStatus(fmi2Component component, fmi2StatusKind kind,
                                       fmi2Integer *value)
{
    Instance *x = (Instance *)component;
    (void)kind;
    (void)value;
    EXPECT(x, ANY);
    return fmi2Discard;
}

EXPORT fmi2Status fmi2GetBooleanStatus(fmi2Component component, fmi2StatusKind kind,
                                       fmi2Boolean *value)
{
    Instance *x = (Instance *)component;
    EXPECT(x, ANY);
    if (kind != fmi2Terminated)
        return fmi2Discard;
    *value = x->phase == FAILED;
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetStringStatus(fmi2Component component, fmi2StatusKind kind,
                                      fmi2String *value)
{
    Instance *x = (Instance *)component;
    (void)kind;
    (void)value;
    EXPECT(x, ANY);
    return fmi2Discard;
}
