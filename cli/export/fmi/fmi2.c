/* FMI 2.0, model exchange and co-simulation: what the standard declares, over `instance.c`. */
#include <stddef.h>

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

typedef fmi2CallbackFunctions Host;

/* How a call ended, by the names that `instance.c` has for it. */
typedef fmi2Status Status;
#define OK fmi2OK
#define DISCARD fmi2Discard
#define ERROR fmi2Error

#include "instance.c"

static void tell_host(const Host *host, const char *name, fmi2Status status, const char *message)
{
    if (host->logger)
        host->logger(host->componentEnvironment, name, status, category(status), "%s", message);
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
    release((Instance *)component);
}

EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid,
                                     fmi2String resources,
                                     const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                                     fmi2Boolean logging)
{
    (void)resources;
    (void)visible;
    return functions ? instantiate(name, guid, type == fmi2CoSimulation, logging, functions)
                     : NULL;
}

EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component component, fmi2Boolean logging, size_t count,
                                      const fmi2String categories[])
{
    EXPECT(component, ANY);
    (void)count;
    (void)categories;
    x->logging = logging;
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean with_tolerance,
                                      fmi2Real tolerance, fmi2Real start, fmi2Boolean with_stop,
                                      fmi2Real stop)
{
    EXPECT(component, INSTANTIATED);
    return set_up(x, start, with_stop ? &stop : NULL, with_tolerance ? &tolerance : NULL);
}

EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component component)
{
    EXPECT(component, INSTANTIATED);
    x->phase = INITIALISING;
    return fmi2OK;
}

EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component component)
{
    EXPECT(component, INITIALISING);
    return set_free(x);
}

EXPORT fmi2Status fmi2Terminate(fmi2Component component)
{
    EXPECT(component, EVENT | CONTINUOUS | STEPPING);
    x->phase = TERMINATED;
    return fmi2OK;
}

EXPORT fmi2Status fmi2Reset(fmi2Component component)
{
    EXPECT(component, ANY);
    return done(x, begin_anew(x));
}

/* ---- values --------------------------------------------------------------------------------- */

EXPORT fmi2Status fmi2GetReal(fmi2Component component, const fmi2ValueReference references[],
                              size_t count, fmi2Real values[])
{
    EXPECT(component, RUNNING | TERMINATED);
    return get(x, references, count, values);
}

EXPORT fmi2Status fmi2SetReal(fmi2Component component, const fmi2ValueReference references[],
                              size_t count, const fmi2Real values[])
{
    EXPECT(component, INSTANTIATED | RUNNING);
    return set(x, references, count, values);
}

/* There are no variables but real ones. */
static fmi2Status none(fmi2Component component, size_t count)
{
    EXPECT(component, ANY);
    return count ? complain(x, ERROR, "all variables are real") : fmi2OK;
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

EXPORT fmi2Status fmi2GetDirectionalDerivative(fmi2Component component,
                                               const fmi2ValueReference unknown[],
                                               size_t unknowns, const fmi2ValueReference known[],
                                               size_t knowns, const fmi2Real seed[],
                                               fmi2Real result[])
{
    EXPECT(component, RUNNING | TERMINATED);
    return directional(x, unknown, unknowns, known, knowns, seed, result);
}

/* ---- snapshots ------------------------------------------------------------------------------ */

EXPORT fmi2Status fmi2GetFMUstate(fmi2Component component, fmi2FMUstate *state)
{
    EXPECT(component, ANY);
    return keep(x, state);
}

EXPORT fmi2Status fmi2SetFMUstate(fmi2Component component, fmi2FMUstate state)
{
    EXPECT(component, ANY);
    return become(x, (const Instance *)state);
}

EXPORT fmi2Status fmi2FreeFMUstate(fmi2Component component, fmi2FMUstate *state)
{
    EXPECT(component, ANY);
    forget(state);
    return fmi2OK;
}

EXPORT fmi2Status fmi2SerializedFMUstateSize(fmi2Component component, fmi2FMUstate state,
                                             size_t *size)
{
    EXPECT(component, ANY);
    (void)state;
    return written_size(x, size);
}

EXPORT fmi2Status fmi2SerializeFMUstate(fmi2Component component, fmi2FMUstate state,
                                        fmi2Byte bytes[], size_t size)
{
    EXPECT(component, ANY);
    return write_down(x, (const Instance *)state, bytes, size);
}

EXPORT fmi2Status fmi2DeSerializeFMUstate(fmi2Component component, const fmi2Byte bytes[],
                                          size_t size, fmi2FMUstate *state)
{
    EXPECT(component, ANY);
    return read_back(x, bytes, size, state);
}

/* ---- model exchange ------------------------------------------------------------------------- */

EXPORT fmi2Status fmi2EnterEventMode(fmi2Component component)
{
    EXPECT(component, EVENT | CONTINUOUS);
    x->phase = EVENT;
    return fmi2OK;
}

EXPORT fmi2Status fmi2NewDiscreteStates(fmi2Component component, fmi2EventInfo *info)
{
    EXPECT(component, EVENT);
    memset(info, 0, sizeof *info);
    return bring_back(x, &info->valuesOfContinuousStatesChanged);
}

EXPORT fmi2Status fmi2EnterContinuousTimeMode(fmi2Component component)
{
    EXPECT(component, EVENT);
    x->phase = CONTINUOUS;
    return fmi2OK;
}

EXPORT fmi2Status fmi2CompletedIntegratorStep(fmi2Component component, fmi2Boolean no_prior,
                                              fmi2Boolean *event, fmi2Boolean *terminate)
{
    Status status;
    EXPECT(component, CONTINUOUS);
    (void)no_prior;
    status = check_drift(x);
    *event = x->drifted;
    *terminate = 0;
    return status;
}

EXPORT fmi2Status fmi2SetTime(fmi2Component component, fmi2Real t)
{
    EXPECT(component, EVENT | CONTINUOUS);
    x->t = t;
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetContinuousStates(fmi2Component component, const fmi2Real states[],
                                          size_t count)
{
    EXPECT(component, EVENT | CONTINUOUS);
    return set_states(x, states, count);
}

EXPORT fmi2Status fmi2GetContinuousStates(fmi2Component component, fmi2Real states[],
                                          size_t count)
{
    EXPECT(component, RUNNING | TERMINATED);
    return get_states(x, states, count);
}

EXPORT fmi2Status fmi2GetDerivatives(fmi2Component component, fmi2Real derivatives[],
                                     size_t count)
{
    EXPECT(component, RUNNING | TERMINATED);
    return get_derivatives(x, derivatives, count);
}

EXPORT fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component component,
                                                    fmi2Real nominals[], size_t count)
{
    EXPECT(component, RUNNING | TERMINATED);
    return get_nominals(x, nominals, count);
}

EXPORT fmi2Status fmi2GetEventIndicators(fmi2Component component, fmi2Real indicators[],
                                         size_t count)
{
    EXPECT(component, RUNNING | TERMINATED);
    return get_indicators(x, indicators, count);
}

/* ---- co-simulation -------------------------------------------------------------------------- */

EXPORT fmi2Status fmi2DoStep(fmi2Component component, fmi2Real t, fmi2Real step,
                             fmi2Boolean no_prior)
{
    EXPECT(component, STEPPING);
    (void)no_prior;
    return go_on(x, t, step);
}

EXPORT fmi2Status fmi2CancelStep(fmi2Component component)
{
    EXPECT(component, ANY);
    return complain(x, ERROR, "steps are done when they return");
}

EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component component,
                                              const fmi2ValueReference references[], size_t count,
                                              const fmi2Integer orders[], const fmi2Real values[])
{
    EXPECT(component, ANY);
    (void)references;
    (void)count;
    (void)orders;
    (void)values;
    return complain(x, ERROR, "derivatives of inputs are not used");
}

EXPORT fmi2Status fmi2GetRealOutputDerivatives(fmi2Component component,
                                               const fmi2ValueReference references[],
                                               size_t count, const fmi2Integer orders[],
                                               fmi2Real values[])
{
    EXPECT(component, ANY);
    (void)references;
    (void)count;
    (void)orders;
    (void)values;
    return complain(x, ERROR, "derivatives of outputs are not provided");
}

EXPORT fmi2Status fmi2GetStatus(fmi2Component component, fmi2StatusKind kind, fmi2Status *status)
{
    EXPECT(component, ANY);
    (void)kind;
    *status = x->phase == FAILED ? fmi2Error : fmi2OK;
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetRealStatus(fmi2Component component, fmi2StatusKind kind, fmi2Real *value)
{
    EXPECT(component, ANY);
    if (kind != fmi2LastSuccessfulTime)
        return fmi2Discard;
    *value = x->t;
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetIntegerStatus(fmi2Component component, fmi2StatusKind kind,
                                       fmi2Integer *value)
{
    EXPECT(component, ANY);
    (void)kind;
    (void)value;
    return fmi2Discard;
}

EXPORT fmi2Status fmi2GetBooleanStatus(fmi2Component component, fmi2StatusKind kind,
                                       fmi2Boolean *value)
{
    EXPECT(component, ANY);
    if (kind != fmi2Terminated)
        return fmi2Discard;
    *value = x->phase == FAILED;
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetStringStatus(fmi2Component component, fmi2StatusKind kind,
                                      fmi2String *value)
{
    EXPECT(component, ANY);
    (void)kind;
    (void)value;
    return fmi2Discard;
}
