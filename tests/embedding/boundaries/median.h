/* Times a function. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { TRIALS = 101 };

static double microseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e6 + (double)now.tv_nsec * 1e-3;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median of some trials (microseconds); ends the program if one fails. */
static double median(int (*once)(void))
{
    double times[TRIALS];
    int i;
    for (i = 0; i < TRIALS; i++) {
        double begun = microseconds();
        if (once()) {
            fprintf(stderr, "a trial failed\n");
            exit(1);
        }
        times[i] = microseconds() - begun;
    }
    qsort(times, TRIALS, sizeof(double), ascending);
    return times[TRIALS / 2];
}
