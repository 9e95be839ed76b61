/* The motions of `boundaries` in C: medians of what they take, in microseconds. */
#define _POSIX_C_SOURCE 199309L
#include "median.h"
#include "slider_crank.h"

enum { STEPS = 200, ROWS = 802 };

static bricard *m;
static double *rows;
static size_t width;

static int step(void)
{
    int i;
    if (bricard_assemble(m, 0.0))
        return 1;
    for (i = 0; i < STEPS; i++)
        if (bricard_step(m, 1e-3))
            return 1;
    return 0;
}

static int span(void)
{
    return bricard_assemble(m, 0.0) || bricard_step(m, 8.0);
}

static uint32_t columns;

static int run(void)
{
    bricard_watch watch = bricard_watch_nothing();
    watch.every = 0.01;
    watch.columns = columns;
    watch.rows = rows;
    watch.room = ROWS * width;
    return bricard_assemble(m, 0.0) || bricard_run(m, 8.0, &watch, NULL);
}

int main(void)
{
    if (slider_crank_create(&m) != BRICARD_OK)
        return 1;
    if (bricard_row_size(m, 15, &width))
        return 1;
    rows = (double *)calloc(ROWS * width, sizeof(double));
    if (!rows)
        return 1;
    printf("step %g\nspan %g\n", median(step) / STEPS, median(span));
    printf("run %g\n", median(run));
    columns = BRICARD_WITH_OUTPUTS | BRICARD_WITH_REACTIONS | BRICARD_WITH_ENERGIES |
              BRICARD_WITH_ERRORS;
    printf("full %g\n", median(run));
    free(rows);
    bricard_free(&m);
    return 0;
}
