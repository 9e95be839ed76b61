/* The steps of `boundaries` by an FMU of FMI 3.0, given its library and its token: the median of
   what one takes, in microseconds. */
#define _POSIX_C_SOURCE 199309L
#include "median.h"
#include <dlfcn.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { STEPS = 200 };

typedef void *Instance;
static Instance x;
static int (*reset)(Instance);
static int (*enter)(Instance, bool, double, double, bool, double);
static int (*leave)(Instance);
static int (*do_step)(Instance, double, double, bool, bool *, bool *, bool *, double *);

static int steps(void)
{
    bool event, terminate, early;
    double t = 0.0;
    int i;
    if (reset(x) || enter(x, true, 1e-9, 0.0, false, 0.0) || leave(x))
        return 1;
    for (i = 0; i < STEPS; i++)
        if (do_step(x, t, 1e-3, true, &event, &terminate, &early, &t))
            return 1;
    return 0;
}

/* A function of the library; objects and functions have addresses of one kind here. */
static void find(void *library, const char *name, void *function)
{
    void *found = dlsym(library, name);
    if (!found) {
        fprintf(stderr, "there is no %s\n", name);
        exit(1);
    }
    memcpy(function, &found, sizeof found);
}

int main(int count, char **arguments)
{
    Instance (*instantiate)(const char *, const char *, const char *, bool, bool, bool, bool,
                            const uint32_t *, size_t, void *, void *, void *);
    void *library = count == 3 ? dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL) : NULL;
    if (!library) {
        fprintf(stderr, "usage: fmu LIBRARY TOKEN\n");
        return 1;
    }
    find(library, "fmi3InstantiateCoSimulation", &instantiate);
    find(library, "fmi3Reset", &reset);
    find(library, "fmi3EnterInitializationMode", &enter);
    find(library, "fmi3ExitInitializationMode", &leave);
    find(library, "fmi3DoStep", &do_step);
    x = instantiate("one", arguments[2], NULL, false, false, false, false, NULL, 0, NULL, NULL,
                    NULL);
    if (!x)
        return 1;
    printf("step %g\n", median(steps) / STEPS);
    return 0;
}
