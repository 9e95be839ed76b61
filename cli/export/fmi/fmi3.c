/* FMI 3.0, model exchange and co-simulation: what the standard declares, over `instance.c`. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef void *fmi3Instance;
typedef void *fmi3InstanceEnvironment;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef char fmi3Char;
typedef const fmi3Char *fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte *fmi3Binary;
typedef bool fmi3Clock;

typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef enum {
    fmi3Independent,
    fmi3Constant,
    fmi3Fixed,
    fmi3Tunable,
    fmi3Discrete,
    fmi3Dependent
} fmi3DependencyKind;
typedef enum {
    fmi3IntervalNotYetKnown,
    fmi3IntervalUnchanged,
    fmi3IntervalChanged
} fmi3IntervalQualifier;

typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment, fmi3Status, fmi3String,
                                       fmi3String);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment);
typedef void (*fmi3IntermediateUpdateCallback)(fmi3InstanceEnvironment, fmi3Float64, fmi3Boolean,
                                               fmi3Boolean, fmi3Boolean, fmi3Boolean,
                                               fmi3Boolean *, fmi3Float64 *);
typedef void (*fmi3LockPreemptionCallback)(void);
typedef void (*fmi3UnlockPreemptionCallback)(void);

/* Who is told of errors. */
typedef struct {
    fmi3LogMessageCallback log;
    fmi3InstanceEnvironment environment;
} Host;

/* How a call ended, by the names that `instance.c` has for it. */
typedef fmi3Status Status;
#define OK fmi3OK
#define DISCARD fmi3Discard
#define ERROR fmi3Error

#include "instance.c"

static void tell_host(const Host *host, const char *name, fmi3Status status, const char *message)
{
    (void)name;
    if (host->log)
        host->log(host->environment, status, category(status), message);
}

/* ---- life ----------------------------------------------------------------------------------- */

EXPORT const char *fmi3GetVersion(void)
{
    return "3.0";
}

EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean logging, size_t count,
                                      const fmi3String categories[])
{
    EXPECT(instance, ANY);
    (void)count;
    (void)categories;
    x->logging = logging;
    return fmi3OK;
}

EXPORT fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token,
                                                 fmi3String resources, fmi3Boolean visible,
                                                 fmi3Boolean logging,
                                                 fmi3InstanceEnvironment environment,
                                                 fmi3LogMessageCallback log)
{
    Host host;
    (void)resources;
    (void)visible;
    host.log = log;
    host.environment = environment;
    return instantiate(name, token, 0, logging, &host);
}

EXPORT fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3Boolean event_mode, fmi3Boolean early_return,
    const fmi3ValueReference intermediate[], size_t count, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update)
{
    Host host;
    (void)resources;
    (void)visible;
    (void)early_return;
    (void)intermediate;
    (void)update;
    host.log = log;
    host.environment = environment;
    if (event_mode || count) {
        tell_host(&host, name, ERROR,
                  event_mode ? "there is no event mode in co-simulation"
                             : "there are no variables between communication points");
        return NULL;
    }
    return instantiate(name, token, 1, logging, &host);
}

EXPORT fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
    fmi3UnlockPreemptionCallback unlock)
{
    Host host;
    (void)token;
    (void)resources;
    (void)visible;
    (void)logging;
    (void)update;
    (void)lock;
    (void)unlock;
    host.log = log;
    host.environment = environment;
    tell_host(&host, name, ERROR, "this is for model exchange and co-simulation");
    return NULL;
}

EXPORT void fmi3FreeInstance(fmi3Instance instance)
{
    release((Instance *)instance);
}

EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean with_tolerance,
                                              fmi3Float64 tolerance, fmi3Float64 start,
                                              fmi3Boolean with_stop, fmi3Float64 stop)
{
    EXPECT(instance, INSTANTIATED);
    if (set_up(x, start, with_stop ? &stop : NULL, with_tolerance ? &tolerance : NULL) != OK)
        return fmi3Error;
    x->phase = INITIALISING;
    return fmi3OK;
}

EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance instance)
{
    EXPECT(instance, INITIALISING);
    return set_free(x);
}

EXPORT fmi3Status fmi3Terminate(fmi3Instance instance)
{
    EXPECT(instance, EVENT | CONTINUOUS | STEPPING);
    x->phase = TERMINATED;
    return fmi3OK;
}

EXPORT fmi3Status fmi3Reset(fmi3Instance instance)
{
    EXPECT(instance, ANY);
    return done(x, begin_anew(x));
}

/* ---- values --------------------------------------------------------------------------------- */

EXPORT fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference references[],
                                 size_t count, fmi3Float64 values[], size_t length)
{
    EXPECT(instance, RUNNING | TERMINATED);
    if (counted(x, length, count) != OK)
        return fmi3Error;
    return get(x, references, count, values);
}

EXPORT fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference references[],
                                 size_t count, const fmi3Float64 values[], size_t length)
{
    EXPECT(instance, INSTANTIATED | RUNNING);
    if (counted(x, length, count) != OK)
        return fmi3Error;
    return set(x, references, count, values);
}

/* There are no variables but these. */
static fmi3Status none(fmi3Instance instance, size_t count)
{
    EXPECT(instance, ANY);
    return count ? complain(x, ERROR, "all variables are Float64") : fmi3OK;
}

#define NO_VARIABLES(type)                                                                  \
    EXPORT fmi3Status fmi3Get##type(fmi3Instance instance,                                  \
                                    const fmi3ValueReference references[], size_t count,    \
                                    fmi3##type values[], size_t length)                     \
    {                                                                                       \
        (void)references;                                                                   \
        (void)values;                                                                       \
        (void)length;                                                                       \
        return none(instance, count);                                                       \
    }                                                                                       \
    EXPORT fmi3Status fmi3Set##type(fmi3Instance instance,                                  \
                                    const fmi3ValueReference references[], size_t count,    \
                                    const fmi3##type values[], size_t length)               \
    {                                                                                       \
        (void)references;                                                                   \
        (void)values;                                                                       \
        (void)length;                                                                       \
        return none(instance, count);                                                       \
    }

NO_VARIABLES(Float32)
NO_VARIABLES(Int8)
NO_VARIABLES(UInt8)
NO_VARIABLES(Int16)
NO_VARIABLES(UInt16)
NO_VARIABLES(Int32)
NO_VARIABLES(UInt32)
NO_VARIABLES(Int64)
NO_VARIABLES(UInt64)
NO_VARIABLES(Boolean)
NO_VARIABLES(String)

EXPORT fmi3Status fmi3GetBinary(fmi3Instance instance, const fmi3ValueReference references[],
                                size_t count, size_t sizes[], fmi3Binary values[], size_t length)
{
    (void)references;
    (void)sizes;
    (void)values;
    (void)length;
    return none(instance, count);
}

EXPORT fmi3Status fmi3SetBinary(fmi3Instance instance, const fmi3ValueReference references[],
                                size_t count, const size_t sizes[], const fmi3Binary values[],
                                size_t length)
{
    (void)references;
    (void)sizes;
    (void)values;
    (void)length;
    return none(instance, count);
}

EXPORT fmi3Status fmi3GetClock(fmi3Instance instance, const fmi3ValueReference references[],
                               size_t count, fmi3Clock values[])
{
    (void)references;
    (void)values;
    return none(instance, count);
}

EXPORT fmi3Status fmi3SetClock(fmi3Instance instance, const fmi3ValueReference references[],
                               size_t count, const fmi3Clock values[])
{
    (void)references;
    (void)values;
    return none(instance, count);
}

/* Refuses what an FMU may lack. */
static fmi3Status lacking(fmi3Instance instance, const char *what)
{
    EXPECT(instance, ANY);
    return complain(x, ERROR, what);
}

EXPORT fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance instance,
                                                      fmi3ValueReference reference,
                                                      size_t *count)
{
    (void)reference;
    (void)count;
    return lacking(instance, "dependencies of elements are not provided");
}

EXPORT fmi3Status fmi3GetVariableDependencies(fmi3Instance instance, fmi3ValueReference dependent,
                                              size_t elements[],
                                              fmi3ValueReference independents[],
                                              size_t elements_of_independents[],
                                              fmi3DependencyKind kinds[], size_t count)
{
    (void)dependent;
    (void)elements;
    (void)independents;
    (void)elements_of_independents;
    (void)kinds;
    (void)count;
    return lacking(instance, "dependencies of elements are not provided");
}

EXPORT fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance,
                                               const fmi3ValueReference unknowns[],
                                               size_t unknown_count,
                                               const fmi3ValueReference knowns[],
                                               size_t known_count, const fmi3Float64 seed[],
                                               size_t seeds, fmi3Float64 sensitivity[],
                                               size_t sensitivities)
{
    EXPECT(instance, RUNNING | TERMINATED);
    if (counted(x, seeds, known_count) != OK || counted(x, sensitivities, unknown_count) != OK)
        return fmi3Error;
    return directional(x, unknowns, unknown_count, knowns, known_count, seed,
                                   sensitivity);
}

EXPORT fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance,
                                           const fmi3ValueReference unknowns[],
                                           size_t unknown_count,
                                           const fmi3ValueReference knowns[], size_t known_count,
                                           const fmi3Float64 seed[], size_t seeds,
                                           fmi3Float64 sensitivity[], size_t sensitivities)
{
    (void)unknowns;
    (void)unknown_count;
    (void)knowns;
    (void)known_count;
    (void)seed;
    (void)seeds;
    (void)sensitivity;
    (void)sensitivities;
    return lacking(instance, "adjoint derivatives are not provided");
}

/* ---- snapshots ------------------------------------------------------------------------------ */

EXPORT fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *state)
{
    EXPECT(instance, ANY);
    return keep(x, state);
}

EXPORT fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state)
{
    EXPECT(instance, ANY);
    return become(x, (const Instance *)state);
}

EXPORT fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *state)
{
    EXPECT(instance, ANY);
    forget(state);
    return fmi3OK;
}

EXPORT fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state,
                                             size_t *size)
{
    EXPECT(instance, ANY);
    (void)state;
    return written_size(x, size);
}

EXPORT fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState state,
                                        fmi3Byte bytes[], size_t size)
{
    EXPECT(instance, ANY);
    return write_down(x, (const Instance *)state, bytes, size);
}

EXPORT fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte bytes[],
                                          size_t size, fmi3FMUState *state)
{
    EXPECT(instance, ANY);
    return read_back(x, bytes, size, state);
}

/* ---- what only other FMUs have: structural parameters and clocks ---------------------------- */

EXPORT fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance)
{
    return lacking(instance, "there are no structural parameters");
}

EXPORT fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance)
{
    return lacking(instance, "there are no structural parameters");
}

#define NO_CLOCKS(name, ...)                                                                \
    EXPORT fmi3Status fmi3##name(fmi3Instance instance, const fmi3ValueReference *references, \
                                 size_t count, __VA_ARGS__)                                 \
    {                                                                                       \
        (void)references;                                                                   \
        (void)count;                                                                        \
        return lacking(instance, "there are no clocks");                                    \
    }

NO_CLOCKS(GetIntervalDecimal, fmi3Float64 *intervals, fmi3IntervalQualifier *qualifiers)
NO_CLOCKS(GetIntervalFraction, fmi3UInt64 *counters, fmi3UInt64 *resolutions,
          fmi3IntervalQualifier *qualifiers)
NO_CLOCKS(GetShiftDecimal, fmi3Float64 *shifts)
NO_CLOCKS(GetShiftFraction, fmi3UInt64 *counters, fmi3UInt64 *resolutions)
NO_CLOCKS(SetIntervalDecimal, const fmi3Float64 *intervals)
NO_CLOCKS(SetIntervalFraction, const fmi3UInt64 *counters, const fmi3UInt64 *resolutions)
NO_CLOCKS(SetShiftDecimal, const fmi3Float64 *shifts)
NO_CLOCKS(SetShiftFraction, const fmi3UInt64 *counters, const fmi3UInt64 *resolutions)

EXPORT fmi3Status fmi3ActivateModelPartition(fmi3Instance instance, fmi3ValueReference clock,
                                             fmi3Float64 t)
{
    (void)clock;
    (void)t;
    return lacking(instance, "there are no clocks");
}

/* ---- model exchange ------------------------------------------------------------------------- */

EXPORT fmi3Status fmi3EnterEventMode(fmi3Instance instance)
{
    EXPECT(instance, EVENT | CONTINUOUS);
    x->phase = EVENT;
    return fmi3OK;
}

EXPORT fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance)
{
    EXPECT(instance, INITIALISING | EVENT);
    return fmi3OK;
}

EXPORT fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *again,
                                           fmi3Boolean *terminate, fmi3Boolean *nominals_changed,
                                           fmi3Boolean *values_changed,
                                           fmi3Boolean *next_time_defined, fmi3Float64 *next_time)
{
    int changed = 0;
    EXPECT(instance, EVENT);
    *again = *terminate = *nominals_changed = *next_time_defined = false;
    *next_time = 0.0;
    if (bring_back(x, &changed) != OK)
        return fmi3Error;
    *values_changed = changed != 0;
    return fmi3OK;
}

EXPORT fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance)
{
    EXPECT(instance, EVENT);
    x->phase = CONTINUOUS;
    return fmi3OK;
}

EXPORT fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean no_prior,
                                              fmi3Boolean *event, fmi3Boolean *terminate)
{
    Status status;
    EXPECT(instance, CONTINUOUS);
    (void)no_prior;
    status = check_drift(x);
    *event = x->drifted != 0;
    *terminate = false;
    return status;
}

EXPORT fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 t)
{
    EXPECT(instance, EVENT | CONTINUOUS);
    x->t = t;
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64 states[],
                                          size_t count)
{
    EXPECT(instance, EVENT | CONTINUOUS);
    return set_states(x, states, count);
}

EXPORT fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64 states[],
                                          size_t count)
{
    EXPECT(instance, RUNNING | TERMINATED);
    return get_states(x, states, count);
}

EXPORT fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance,
                                                    fmi3Float64 derivatives[], size_t count)
{
    EXPECT(instance, RUNNING | TERMINATED);
    return get_derivatives(x, derivatives, count);
}

EXPORT fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64 nominals[],
                                                    size_t count)
{
    EXPECT(instance, RUNNING | TERMINATED);
    return get_nominals(x, nominals, count);
}

EXPORT fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 indicators[],
                                         size_t count)
{
    EXPECT(instance, RUNNING | TERMINATED);
    return get_indicators(x, indicators, count);
}

EXPORT fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *count)
{
    EXPECT(instance, ANY);
    *count = x->events;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *count)
{
    EXPECT(instance, ANY);
    *count = x->f + x->n;
    return fmi3OK;
}

/* ---- co-simulation -------------------------------------------------------------------------- */

EXPORT fmi3Status fmi3EnterStepMode(fmi3Instance instance)
{
    return lacking(instance, "there is no event mode in co-simulation");
}

EXPORT fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance,
                                           const fmi3ValueReference references[], size_t count,
                                           const fmi3Int32 orders[], fmi3Float64 values[],
                                           size_t length)
{
    (void)references;
    (void)count;
    (void)orders;
    (void)values;
    (void)length;
    return lacking(instance, "derivatives of outputs are not provided");
}

EXPORT fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 t, fmi3Float64 step,
                             fmi3Boolean no_prior, fmi3Boolean *event, fmi3Boolean *terminate,
                             fmi3Boolean *early, fmi3Float64 *last)
{
    Status status;
    EXPECT(instance, STEPPING);
    (void)no_prior;
    *event = *terminate = *early = false;
    status = go_on(x, t, step);
    *last = x->t;
    return status;
}
