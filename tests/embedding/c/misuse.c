/* Does everything wrong that can be done wrong within the rules of bricard.h, and expects to
   be told so; prints each status, what brought it about in Markdown, and the message, with tabs between
   them. Correct C99, and correct C++. */
#include "double_pendulum.h"
#include "engine.h"

#include "check.h"

#include <math.h>
#include <string.h>

static const double NOTHING = 0.0;

static double not_a_number(void)
{
    return NOTHING / NOTHING;
}

/* A refusal with a word of its message, and what brings it about. */
#define REFUSED_AS(how, m, call, status, word)                                          \
    do {                                                                                \
        bricard_status refused_ = (call);                                               \
        if (refused_ != (status) || !strstr(bricard_message(m), word)) {                \
            fprintf(stderr, "%s:%d: %s: %d, %s\n", __FILE__, __LINE__, #call,           \
                    (int)refused_, bricard_message(m));                                 \
            exit(1);                                                                    \
        }                                                                               \
        printf("%s\t%s\t%s\n", #status, how, bricard_message(m));                       \
    } while (0)

#define REFUSED(m, call, status, word) REFUSED_AS("`" #call "`", m, call, status, word)

#define IS_NULL(m, call) REFUSED_AS("`" #call "`", m, call, BRICARD_ERROR_NULL, "null")

static void nulls(bricard *m)
{
    double x = 0.0;
    bricard *none = NULL;
    CHECK(engine_create(NULL) == BRICARD_ERROR_NULL);
    CHECK(engine_interface(BRICARD_ABI + 1) == NULL);
    CHECK(bricard_clone(NULL, &none) == BRICARD_ERROR_NULL);
    bricard_free(NULL);
    bricard_free(&none);
    CHECK(bricard_name(NULL, 0, 0) == NULL);
    REFUSED(NULL, bricard_step(NULL, 1.0), BRICARD_ERROR_NULL, "NULL");
    REFUSED(NULL, bricard_run(NULL, 1.0, NULL, NULL), BRICARD_ERROR_NULL, "NULL");
    REFUSED(m, bricard_failed_at(m, &x), BRICARD_ERROR_ORDER, "no motion");
    IS_NULL(m, bricard_parameter(m, 0, NULL));
    IS_NULL(m, bricard_clone(m, NULL));
    IS_NULL(m, bricard_assign(m, NULL));
    IS_NULL(m, bricard_find(m, BRICARD_PARAMETERS, NULL, NULL));
    IS_NULL(m, bricard_find(m, BRICARD_PARAMETERS, "L", NULL));
    IS_NULL(m, bricard_set_state(m, 0.0, NULL, &x, ENGINE_N));
    IS_NULL(m, bricard_evaluate(m, BRICARD_ENERGY, NULL, NULL, 4));
    IS_NULL(m, bricard_drive_input(m, 0, NULL, NULL));
    IS_NULL(m, bricard_get_options(m, NULL));
    IS_NULL(m, bricard_set_options(m, NULL));
}

static void names(bricard *m)
{
    int held = 0;
    size_t place = 7;
    double x = 0.0;
    CHECK(strcmp(bricard_name(m, BRICARD_MECHANISM, 0), "Engine") == 0);
    CHECK(strcmp(bricard_unit(m, BRICARD_PARAMETERS, ENGINE_P_J), "kg*m^2") == 0);
    CHECK(strcmp(bricard_docs(m, BRICARD_INPUTS, 0), "torque of the motor") == 0);
    CHECK(bricard_name(m, BRICARD_INPUTS, 1) == NULL);
    CHECK(bricard_name(m, 99, 0) == NULL);
    DONE(m, bricard_find(m, BRICARD_OUTPUTS, "pin_at.y", &place));
    CHECK(place == ENGINE_Y_pin_at_y);
    REFUSED(m, bricard_find(m, BRICARD_PARAMETERS, "l", &place), BRICARD_ERROR_NAME,
            "there is no parameter `l`; there are `L`, `m`");
    CHECK(place == ENGINE_Y_pin_at_y);
    REFUSED(m, bricard_find(m, -1, "L", &place), BRICARD_ERROR_ARGUMENT, "no list -1");
    REFUSED(m, bricard_count(m, 8, &place), BRICARD_ERROR_ARGUMENT, "no list 8");
    REFUSED(m, bricard_parameter(m, 4, &x), BRICARD_ERROR_INDEX, "they are 0 to 3");
    REFUSED(m, bricard_set_parameter(m, (size_t)-1, 1.0), BRICARD_ERROR_INDEX, "parameter");
    REFUSED(m, bricard_hold_input_named(m, "tork", 1.0), BRICARD_ERROR_NAME, "`torque`");
    REFUSED(m, bricard_release_input(m, 1), BRICARD_ERROR_INDEX, "input");
    REFUSED(m, bricard_set_start_named(m, "", 0, 1.0, 1), BRICARD_ERROR_NAME, "coordinate");
    REFUSED(m, bricard_size(m, 15, &place), BRICARD_ERROR_ARGUMENT, "no quantity 15");
    REFUSED(m, bricard_start(m, ENGINE_N, 1, &x, &held), BRICARD_ERROR_INDEX, "0 to 2");
    REFUSED(m, bricard_row_size(m, 16, &place), BRICARD_ERROR_ARGUMENT, "columns");
}

static void numbers(bricard *m)
{
    const double nan = not_a_number();
    double q[ENGINE_N] = {0}, v[ENGINE_N] = {0}, out[9] = {0};
    bricard_point at;
    REFUSED(m, bricard_set_parameter(m, ENGINE_P_L, nan), BRICARD_ERROR_NOT_FINITE, "`L`");
    REFUSED(m, bricard_hold_input(m, 0, 1.0 / NOTHING), BRICARD_ERROR_NOT_FINITE, "`torque`");
    REFUSED(m, bricard_set_start(m, 0, 0, nan, 1), BRICARD_ERROR_NOT_FINITE, "`crank`");
    REFUSED(m, bricard_assemble(m, nan), BRICARD_ERROR_NOT_FINITE, "t = NaN");
    v[1] = nan;
    REFUSED(m, bricard_set_state(m, 0.0, q, v, ENGINE_N), BRICARD_ERROR_NOT_FINITE, "finite");
    REFUSED(m, bricard_set_state(m, 0.0, q, v, 2), BRICARD_ERROR_LENGTH, "3 numbers, not 2");
    at.t = 0.0;
    at.q = q;
    at.v = v;
    at.n = ENGINE_N;
    REFUSED(m, bricard_evaluate(m, BRICARD_MASS, &at, out, 9), BRICARD_ERROR_NOT_FINITE, "NaN");
    v[1] = 0.0;
    REFUSED(m, bricard_evaluate(m, BRICARD_MASS, &at, out, 8), BRICARD_ERROR_LENGTH, "9");
    at.n = 4;
    REFUSED(m, bricard_evaluate(m, BRICARD_MASS, &at, out, 9), BRICARD_ERROR_LENGTH, "3");
    REFUSED(m, bricard_load(m, out, 9), BRICARD_ERROR_LENGTH, "not 9");
    REFUSED(m, bricard_save(m, out, 9), BRICARD_ERROR_LENGTH, "not 9");
    q[0] = nan;
    REFUSED_AS("`bricard_project` of a state with NaN", m,
               bricard_project(m, 0.0, q, v, ENGINE_N), BRICARD_ERROR_NOT_FINITE, "NaN");
}

/* A saved mechanism with a number that is none. */
static void saved(bricard *m)
{
    double kept[99] = {0};
    size_t n = 0;
    DONE(m, bricard_size(m, BRICARD_SAVED, &n));
    CHECK(n <= 99);
    DONE(m, bricard_save(m, kept, n));
    kept[1] = not_a_number();
    REFUSED_AS("`bricard_load` of NaN", m, bricard_load(m, kept, n), BRICARD_ERROR_NOT_FINITE,
               "NaN");
}

/* A mechanism of another kind. */
static void strangers(bricard *m)
{
    bricard *pendulum = NULL;
    CHECK(double_pendulum_create(&pendulum) == BRICARD_OK);
    REFUSED_AS("`bricard_assign` of another kind", m, bricard_assign(m, pendulum),
               BRICARD_ERROR_ARGUMENT, "kind");
    REFUSED_AS("`bricard_hold_input` of a mechanism without inputs", pendulum,
               bricard_hold_input(pendulum, 0, 1.0), BRICARD_ERROR_INDEX, "no input");
    bricard_free(&pendulum);
}

static void order(bricard *m)
{
    double t = 0.0, q[ENGINE_N] = {0}, v[ENGINE_N] = {0};
    REFUSED(m, bricard_step(m, 0.1), BRICARD_ERROR_ORDER, "bricard_assemble");
    REFUSED(m, bricard_run(m, 0.1, NULL, NULL), BRICARD_ERROR_ORDER, "bricard_assemble");
    REFUSED(m, bricard_state(m, &t, q, v, ENGINE_N), BRICARD_ERROR_ORDER, "bricard_assemble");
    /* A crank that is longer than the rod can't lie across. */
    DONE(m, bricard_set_start(m, ENGINE_Q_slider, 0, 3.0, 1));
    REFUSED(m, bricard_assemble(m, 0.0), BRICARD_ERROR_ASSEMBLY, "no position");
    DONE(m, bricard_set_start(m, ENGINE_Q_slider, 0, 0.7, 0));
    DONE(m, bricard_assemble(m, 0.0));
}

/* Options that are refused for one that differs. */
#define CHOOSE(m, change, word)                                                         \
    do {                                                                                \
        options = before;                                                               \
        options.change;                                                                 \
        REFUSED_AS("`bricard_set_options` with `" #change "`", m,                              \
                   bricard_set_options(m, &options), BRICARD_ERROR_ARGUMENT, word);     \
    } while (0)

static void options(bricard *m)
{
    bricard_options options, before;
    DONE(m, bricard_get_options(m, &before));
    CHOOSE(m, size = 0, "size");
    CHOOSE(m, method = 5, "method");
    CHOOSE(m, form = -1, "form");
    CHOOSE(m, rtol = 0.0, "tolerance");
    CHOOSE(m, rtol = not_a_number(), "tolerance");
    CHOOSE(m, step = -1.0, "positive");
    CHOOSE(m, method = BRICARD_RK4, "error estimate");
    CHOOSE(m, stabilisation = 3, "stabilisation");
    CHOOSE(m, stabilisation = BRICARD_BAUMGARTE, "gains");
    options = before;
    options.keep_energy = 1;
    DONE(m, bricard_set_options(m, &options));
    REFUSED_AS("`bricard_run` with `keep_energy = 1`", m, bricard_run(m, 1.0, NULL, NULL),
               BRICARD_ERROR_ARGUMENT, "energy");
    DONE(m, bricard_set_options(m, &before));
    REFUSED(m, bricard_run(m, -1.0, NULL, NULL), BRICARD_ERROR_ARGUMENT, "earlier");
    REFUSED(m, bricard_run(m, not_a_number(), NULL, NULL), BRICARD_ERROR_ARGUMENT, "end");
    REFUSED(m, bricard_step(m, not_a_number()), BRICARD_ERROR_ARGUMENT, "end");
    REFUSED(m, bricard_step_once(m, -2.0), BRICARD_ERROR_ARGUMENT, "end");
}

static int stop_soon(void *user, double t, uint64_t steps)
{
    (void)t;
    CHECK(steps % 64 == 0);
    ++*(int *)user;
    return 1;
}

static int stop_at_event(void *user, size_t index, int rising, double t, const double *q,
                         const double *v)
{
    (void)index;
    (void)rising;
    (void)q;
    (void)v;
    *(double *)user = t;
    return 1;
}

/* A watch that is refused for what it wants. */
#define WATCHED(m, wish, status, word)                                                  \
    do {                                                                                \
        watch = bricard_watch_nothing();                                                \
        watch.wish;                                                                     \
        REFUSED_AS("`bricard_run` with a watch of `" #wish "`", m,                             \
                   bricard_run(m, 1.0, &watch, NULL), status, word);                    \
    } while (0)

static void watches(bricard *m)
{
    double rows[20] = {0}, t = 0.0, end = 0.0;
    double q[ENGINE_N] = {0}, v[ENGINE_N] = {0};
    int asked = 0;
    bricard *copy = NULL;
    bricard_watch watch;
    WATCHED(m, size = 0, BRICARD_ERROR_ARGUMENT, "size");
    WATCHED(m, every = -1.0, BRICARD_ERROR_ARGUMENT, "distance");
    WATCHED(m, columns = 1u << 31, BRICARD_ERROR_ARGUMENT, "columns");
    WATCHED(m, room = 6; watch.rows = rows, BRICARD_ERROR_ARGUMENT, "room");
    WATCHED(m, room = 20; watch.rows = NULL, BRICARD_ERROR_NULL, "place");
    WATCHED(m, inside = 33, BRICARD_ERROR_ARGUMENT, "32");

    /* Two rows fit; the third ends the run. */
    DONE(m, bricard_clone(m, &copy));
    watch = bricard_watch_nothing();
    watch.every = 0.25;
    watch.rows = rows;
    watch.room = 20;
    CHECK(bricard_run(copy, 5.0, &watch, NULL) == BRICARD_FULL);
    CHECK(watch.written == 2 && rows[7] == 0.25);
    bricard_free(&copy);

    DONE(m, bricard_clone(m, &copy));
    watch = bricard_watch_nothing();
    watch.user = &asked;
    watch.go_on = stop_soon;
    CHECK(bricard_run(copy, 1000.0, &watch, NULL) == BRICARD_STOPPED);
    CHECK(asked == 1);
    DONE(copy, bricard_stop(copy));
    CHECK(bricard_run(copy, 1000.0, NULL, NULL) == BRICARD_STOPPED);
    DONE(copy, bricard_state(copy, &t, q, v, ENGINE_N));
    DONE(copy, bricard_run(copy, t + 0.1, NULL, NULL));
    bricard_free(&copy);

    DONE(m, bricard_clone(m, &copy));
    watch = bricard_watch_nothing();
    watch.user = &end;
    watch.event = stop_at_event;
    CHECK(bricard_run(copy, 100.0, &watch, NULL) == BRICARD_STOPPED);
    DONE(copy, bricard_state(copy, &t, q, v, ENGINE_N));
    CHECK(t == end && t > 0.0 && fabs(cos(q[ENGINE_Q_crank])) < 1e-12);
    bricard_free(&copy);
}

static int fails(void *user, double t, const double *q, const double *v, double *value)
{
    (void)user;
    (void)q;
    (void)v;
    *value = 0.0;
    return t > 0.5;
}

static int nonsense(void *user, double t, const double *q, const double *v, double *value)
{
    (void)user;
    (void)q;
    (void)v;
    *value = t > 0.5 ? not_a_number() : 0.0;
    return 0;
}

static int again(void *user, double t, const double *q, const double *v, double *value)
{
    bricard *m = *(bricard **)user;
    double out[3] = {0};
    (void)q;
    (void)v;
    *value = 0.0;
    if (t == 0.0)
        REFUSED_AS("a call by the function of an input", m, bricard_step(m, 0.1),
                   BRICARD_ERROR_BUSY, "at work");
    CHECK(bricard_step(m, 0.1) == BRICARD_ERROR_BUSY);
    CHECK(bricard_evaluate(m, BRICARD_ACCELERATION, NULL, out, 3) == BRICARD_ERROR_BUSY);
    CHECK(bricard_assign(m, m) == BRICARD_OK);
    CHECK(strstr(bricard_message(m), "at work") != NULL);
    return 0;
}

static void callbacks(bricard *m)
{
    double t = 0.0, at = 0.0, q[ENGINE_N] = {0}, v[ENGINE_N] = {0}, force[ENGINE_N] = {0};
    bricard *copy = NULL;
    bricard_point point;
    DONE(m, bricard_clone(m, &copy));
    DONE(copy, bricard_drive_input(copy, 0, fails, NULL));
    REFUSED_AS("`bricard_run` with a function of an input that fails", copy,
               bricard_run(copy, 1.0, NULL, NULL), BRICARD_ERROR_CALLBACK, "`torque` failed");
    DONE(copy, bricard_failed_at(copy, &at));
    DONE(copy, bricard_state(copy, &t, q, v, ENGINE_N));
    CHECK(t >= 0.0 && t <= 0.5 && at >= t);
    point.t = 0.75;
    point.q = q;
    point.v = v;
    point.n = ENGINE_N;
    REFUSED_AS("`bricard_evaluate` with a function of an input that fails", copy,
               bricard_evaluate(copy, BRICARD_FORCE, &point, force, ENGINE_N),
               BRICARD_ERROR_CALLBACK, "an input failed");
    /* It goes on from the last good state. */
    DONE(copy, bricard_release_input(copy, 0));
    DONE(copy, bricard_run(copy, 1.0, NULL, NULL));
    bricard_free(&copy);

    DONE(m, bricard_clone(m, &copy));
    DONE(copy, bricard_drive_input(copy, 0, nonsense, NULL));
    REFUSED_AS("`bricard_run` with a function of an input that gives NaN", copy,
               bricard_run(copy, 1.0, NULL, NULL), BRICARD_ERROR_RUN, "NaN");
    REFUSED(copy, bricard_step(copy, 1.0), BRICARD_ERROR_RUN, "NaN");
    REFUSED_AS("`bricard_evaluate` with a function of an input that gives NaN", copy,
               bricard_evaluate(copy, BRICARD_FORCE, &point, force, ENGINE_N),
               BRICARD_ERROR_RUN, "result");
    bricard_free(&copy);

    DONE(m, bricard_clone(m, &copy));
    DONE(copy, bricard_drive_input(copy, 0, again, &copy));
    DONE(copy, bricard_run(copy, 0.2, NULL, NULL));
    DONE(copy, bricard_step(copy, 0.2));
    bricard_free(&copy);
}

/* The slider over the bearing, where two constraints depend on one another. */
static void singular(bricard *m)
{
    const double right = 1.5707963267948966;
    double q[ENGINE_N] = {0}, v[ENGINE_N] = {0}, slopes[ENGINE_N * (2 * ENGINE_N + 1)];
    bricard_point point;
    q[ENGINE_Q_crank] = right;
    q[ENGINE_Q_rod] = right;
    point.t = 0.0;
    point.q = q;
    point.v = v;
    point.n = ENGINE_N;
    REFUSED_AS("`bricard_evaluate` of `BRICARD_SLOPE` at a singular position", m,
               bricard_evaluate(m, BRICARD_SLOPE, &point, slopes, sizeof slopes / sizeof *slopes),
               BRICARD_ERROR_RUN, "no derivatives");
}

int main(void)
{
    bricard *m = NULL;
    CHECK(engine_create(&m) == BRICARD_OK);
    nulls(m);
    names(m);
    numbers(m);
    saved(m);
    strangers(m);
    order(m);
    options(m);
    watches(m);
    callbacks(m);
    singular(m);
    bricard_free(&m);
    return 0;
}
