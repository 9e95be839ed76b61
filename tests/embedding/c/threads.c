/* Each of four threads has a mechanism of its own; a fifth stops one that another runs. */
#include "engine.h"

#include "check.h"

#include <pthread.h>
#include <string.h>

static void *move(void *end)
{
    bricard *m = NULL;
    double q[ENGINE_N] = {0};
    CHECK(engine_create(&m) == BRICARD_OK);
    DONE(m, bricard_assemble(m, 0.0));
    DONE(m, bricard_run(m, 20.0, NULL, NULL));
    DONE(m, bricard_state(m, NULL, q, (double *)end, ENGINE_N));
    bricard_free(&m);
    return NULL;
}

static void *run_for_ever(void *m)
{
    CHECK(bricard_run((bricard *)m, 1e9, NULL, NULL) == BRICARD_STOPPED);
    return NULL;
}

int main(void)
{
    pthread_t threads[4], runner;
    double ends[4][ENGINE_N];
    bricard *m = NULL;
    int i;
    memset(ends, 0, sizeof ends);
    for (i = 0; i < 4; i++)
        CHECK(pthread_create(&threads[i], NULL, move, ends[i]) == 0);
    for (i = 0; i < 4; i++)
        CHECK(pthread_join(threads[i], NULL) == 0);
    for (i = 1; i < 4; i++)
        CHECK(memcmp(ends[0], ends[i], sizeof ends[0]) == 0);
    CHECK(ends[0][0] != 0.0);

    CHECK(engine_create(&m) == BRICARD_OK);
    DONE(m, bricard_assemble(m, 0.0));
    CHECK(pthread_create(&runner, NULL, run_for_ever, m) == 0);
    DONE(m, bricard_stop(m));
    CHECK(pthread_join(runner, NULL) == 0);
    bricard_free(&m);
    return 0;
}
