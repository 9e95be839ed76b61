/* Simulates the mechanism for ten seconds: a row each half second. */
#include "MODULE.h"

#include <stdio.h>

enum { STATES = 1 + 2 * UPPER_F, WIDTH = 1 + UPPER_F + UPPER_N };

/* Is handed rows: time, coordinates, velocities, states of the first order. Velocities are
   left out here. */
static int print_rows(void *user, const double *rows, size_t count)
{
    size_t i, j;
    (void)user;
    for (i = 0; i < count; i++) {
        printf("%6.2f", rows[i * WIDTH]);
        for (j = 1; j <= UPPER_F; j++)
            printf(" %12.6f", rows[i * WIDTH + j]);
        for (j = STATES; j < WIDTH; j++)
            printf(" %12.6f", rows[i * WIDTH + j]);
        printf("\n");
    }
    return 0;
}

int main(void)
{
    bricard *m = NULL;
    bricard_watch watch = bricard_watch_nothing();
    bricard_summary summary;
    double rows[8 * WIDTH] = {0};
    size_t j;
    int failed;

    if (MODULE_create(&m) != BRICARD_OK) {
        fprintf(stderr, "header and library are of different versions\n");
        return 1;
    }
    printf("%6s", "t");
    for (j = 0; j < UPPER_F; j++)
        printf(" %12s", bricard_name(m, BRICARD_COORDINATES, j));
    for (j = STATES; j < WIDTH; j++)
        printf(" %12s", bricard_name(m, BRICARD_STATES, j - STATES));
    printf("\n");

    watch.every = 0.5;
    watch.rows = rows;
    watch.room = sizeof rows / sizeof rows[0];
    watch.take = print_rows;
    failed = bricard_assemble(m, 0.0) || bricard_run(m, 10.0, &watch, &summary);
    if (failed)
        fprintf(stderr, "%s\n", bricard_message(m));
    else if (UPPER_R == 0)
        printf("%lu steps\n", (unsigned long)summary.steps);
    else
        printf("%lu steps, %lu passages through singular positions, "
               "largest constraint error %.1e\n",
               (unsigned long)summary.steps, (unsigned long)summary.passages,
               summary.constraint_error);
    bricard_free(&m);
    return failed;
}
