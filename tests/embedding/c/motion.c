/* Moves an engine in all ways there are, and says where it came to, for the test to compare
   with the same in Rust. Correct C99, and correct C++. */
#include "double_pendulum.h"
#include "engine.h"

#include "check.h"

#include <string.h>

/* Numbers, to the last bit, behind a word. */
static void say(const char *word, const double *numbers, size_t count)
{
    size_t i;
    printf("%s", word);
    for (i = 0; i < count; i++)
        printf(" %a", numbers[i]);
    printf("\n");
}

enum { WIDTH = 1 + 2 * ENGINE_N + 3 + ENGINE_N + 2 + 2 };

static bricard *engine(void)
{
    bricard *m = NULL;
    CHECK(engine_create(&m) == BRICARD_OK);
    DONE(m, bricard_assemble(m, 0.0));
    return m;
}

static void say_state(const char *word, bricard *m)
{
    double state[1 + 2 * ENGINE_N];
    memset(state, 0, sizeof state);
    DONE(m, bricard_state(m, &state[0], &state[1], &state[1 + ENGINE_N], ENGINE_N));
    say(word, state, 1 + 2 * ENGINE_N);
}

static int take(void *user, const double *rows, size_t count)
{
    size_t i;
    (void)user;
    for (i = 0; i < count; i++)
        say("row", rows + i * WIDTH, WIDTH);
    return 0;
}

static int take_states(void *user, const double *rows, size_t count)
{
    size_t i;
    (void)user;
    for (i = 0; i < count; i++)
        say("sampled", rows + i * (1 + 2 * ENGINE_N), 1 + 2 * ENGINE_N);
    return 0;
}

static int event(void *user, size_t index, int rising, double t, const double *q,
                 const double *v)
{
    double numbers[5];
    (void)user;
    numbers[0] = (double)index;
    numbers[1] = rising;
    numbers[2] = t;
    numbers[3] = q[ENGINE_Q_crank];
    numbers[4] = v[ENGINE_Q_crank];
    say("event", numbers, 5);
    return 0;
}

static int passage(void *user, double t, double sine, size_t rank, size_t regular)
{
    double numbers[4];
    (void)user;
    numbers[0] = t;
    numbers[1] = sine;
    numbers[2] = (double)rank;
    numbers[3] = (double)regular;
    say("passage", numbers, 4);
    return 0;
}

/* A run with everything recorded. Room for a few rows at a time. */
static void run(void)
{
    bricard *m = engine();
    double rows[7 * WIDTH];
    double done[8];
    bricard_watch watch = bricard_watch_nothing();
    bricard_summary summary;
    memset(rows, 0, sizeof rows);
    memset(&summary, 0, sizeof summary);
    watch.columns = BRICARD_WITH_OUTPUTS | BRICARD_WITH_REACTIONS | BRICARD_WITH_ENERGIES |
                    BRICARD_WITH_ERRORS;
    watch.rows = rows;
    watch.room = sizeof rows / sizeof rows[0];
    watch.take = take;
    watch.event = event;
    watch.passage = passage;
    DONE(m, bricard_run(m, 8.0, &watch, &summary));
    CHECK(watch.written == 0);
    CHECK(summary.size == sizeof summary);
    done[0] = (double)summary.steps;
    done[1] = (double)summary.rejected;
    done[2] = (double)summary.evaluations;
    done[3] = (double)summary.events;
    done[4] = (double)summary.passages;
    done[5] = summary.constraint_error;
    done[6] = summary.energy_error;
    done[7] = summary.energy_supplied;
    say("summary", done, 8);
    say_state("end", m);
    bricard_free(&m);
    CHECK(m == NULL);
    bricard_free(&m);
}

/* Rows at equal distances. */
static void sample(void)
{
    bricard *m = engine();
    double rows[10 * (1 + 2 * ENGINE_N)];
    bricard_watch watch = bricard_watch_nothing();
    memset(rows, 0, sizeof rows);
    watch.every = 0.03;
    watch.rows = rows;
    watch.room = sizeof rows / sizeof rows[0];
    watch.take = take_states;
    DONE(m, bricard_run(m, 2.0, &watch, NULL));
    bricard_free(&m);
}

/* A controller that acts each millisecond. */
static void control(void)
{
    bricard *m = engine();
    bricard_options options;
    double q[ENGINE_N] = {0}, v[ENGINE_N] = {0};
    int i;
    DONE(m, bricard_get_options(m, &options));
    options.method = BRICARD_RK4;
    options.step = 1e-3;
    DONE(m, bricard_set_options(m, &options));
    DONE(m, bricard_set_parameter_named(m, "ms", 0.75));
    for (i = 0; i < 2000; i++) {
        DONE(m, bricard_state(m, NULL, q, v, ENGINE_N));
        DONE(m, bricard_hold_input(m, ENGINE_U_torque, 20.0 * (10.0 - v[ENGINE_Q_crank])));
        DONE(m, bricard_step(m, 1e-3));
    }
    say_state("controlled", m);
    bricard_free(&m);
}

/* One adaptive step after the other, from another start; a copy goes the same way. */
static void steps(void)
{
    bricard *m = NULL, *copy = NULL;
    bricard_options options;
    double t = 0.0, q[ENGINE_N] = {0}, v[ENGINE_N] = {0};
    double *saved;
    size_t size = 0;
    int i;
    CHECK(engine_create(&m) == BRICARD_OK);
    DONE(m, bricard_set_start_named(m, "crank", 0, 0.5, 1));
    DONE(m, bricard_set_start_named(m, "crank", 1, 3.0, 1));
    DONE(m, bricard_assemble(m, 0.25));
    DONE(m, bricard_get_options(m, &options));
    options.method = BRICARD_DP5;
    options.rtol = options.atol = 1e-7;
    DONE(m, bricard_set_options(m, &options));
    for (i = 0; i < 20; i++)
        DONE(m, bricard_step_once(m, 100.0));
    DONE(m, bricard_clone(m, &copy));
    DONE(m, bricard_size(m, BRICARD_SAVED, &size));
    saved = (double *)calloc(size, sizeof *saved);
    CHECK(saved != NULL);
    DONE(m, bricard_save(m, saved, size));
    for (i = 0; i < 20; i++)
        DONE(m, bricard_step_once(m, 100.0));
    say_state("stepped", m);
    DONE(m, bricard_assign(m, copy));
    for (i = 0; i < 20; i++)
        DONE(m, bricard_step_once(m, 100.0));
    say_state("again", m);
    DONE(m, bricard_load(m, saved, size));
    DONE(m, bricard_state(m, &t, q, v, ENGINE_N));
    DONE(copy, bricard_run(copy, t + 1.0, NULL, NULL));
    DONE(m, bricard_run(m, t + 1.0, NULL, NULL));
    say_state("copied", copy);
    say_state("loaded", m);
    free(saved);
    bricard_free(&copy);
    bricard_free(&m);
}

static int constant(void *user, double t, const double *q, const double *v, double *value)
{
    (void)t;
    (void)q;
    (void)v;
    *value = *(double *)user;
    return 0;
}

static int brake(void *user, double t, const double *q, const double *v, double *value)
{
    (void)t;
    (void)q;
    *value = -0.5 * v[ENGINE_Q_crank];
    ++*(long *)user;
    return 0;
}

/* Inputs that follow functions. */
static void laws(void)
{
    bricard *m = engine();
    bricard_options options;
    bricard_summary summary;
    double torque = 1.5, supplied[2];
    long calls = 0;
    DONE(m, bricard_drive_input_named(m, "torque", constant, &torque));
    DONE(m, bricard_run(m, 3.0, NULL, NULL));
    say_state("constant", m);
    bricard_free(&m);

    m = engine();
    DONE(m, bricard_drive_input(m, ENGINE_U_torque, brake, &calls));
    DONE(m, bricard_run(m, 3.0, NULL, &summary));
    say_state("braked", m);
    CHECK((uint64_t)calls >= summary.evaluations);
    supplied[0] = summary.energy_supplied;
    supplied[1] = summary.energy_error;
    say("supplied", supplied, 2);
    bricard_free(&m);

    m = engine();
    DONE(m, bricard_get_options(m, &options));
    options.rtol = options.atol = 1e-12;
    DONE(m, bricard_set_options(m, &options));
    DONE(m, bricard_drive_input(m, ENGINE_U_torque, brake, &calls));
    DONE(m, bricard_run(m, 3.0, NULL, NULL));
    say_state("braked_well", m);
    DONE(m, bricard_release_input(m, ENGINE_U_torque));
    bricard_free(&m);
}

static void evaluate(void)
{
    static const struct {
        int quantity;
        const char *word;
    } all[] = {
        {BRICARD_MASS, "mass"},         {BRICARD_FORCE, "force"},
        {BRICARD_JACOBIAN, "jacobian"}, {BRICARD_BIAS, "bias"},
        {BRICARD_RESIDUAL, "residual"}, {BRICARD_RATE, "rate"},
        {BRICARD_ACCELERATION, "acceleration"},
        {BRICARD_REACTION, "reaction"}, {BRICARD_OUTPUT, "output"},
        {BRICARD_EVENT, "function"},    {BRICARD_ENERGY, "energy"},
        {BRICARD_RANK, "rank"},
    };
    bricard *m = engine();
    double q[ENGINE_N] = {0}, v[ENGINE_N] = {0}, out[16] = {0};
    bricard_point at;
    size_t i, size = 0;
    q[0] = 0.3;
    q[1] = 0.31;
    q[2] = 0.95;
    v[0] = 1.0;
    v[1] = 1.1;
    v[2] = -0.3;
    DONE(m, bricard_project(m, 0.5, q, v, ENGINE_N));
    at.t = 0.5;
    at.q = q;
    at.v = v;
    at.n = ENGINE_N;
    for (i = 0; i < sizeof all / sizeof all[0]; i++) {
        DONE(m, bricard_size(m, all[i].quantity, &size));
        CHECK(size <= 16);
        DONE(m, bricard_evaluate(m, all[i].quantity, &at, out, size));
        say(all[i].word, out, size);
    }
    DONE(m, bricard_draw(m, &at, NULL, 0, &size));
    CHECK(size == 11);
    DONE(m, bricard_draw(m, &at, out, 16, &size));
    say("drawn", out, size);
    /* The result may lie where the state does. */
    DONE(m, bricard_evaluate(m, BRICARD_ACCELERATION, &at, v, ENGINE_N));
    say("acceleration", v, ENGINE_N);
    bricard_free(&m);
}

/* Another mechanism in the same program; it has no constraints. */
static void other(void)
{
    bricard *pendulum = NULL, *m = engine();
    double q[DOUBLE_PENDULUM_N] = {0}, v[DOUBLE_PENDULUM_N] = {0};
    size_t count = 9;
    CHECK(double_pendulum_create(&pendulum) == BRICARD_OK);
    DONE(pendulum, bricard_assemble(pendulum, 0.0));
    DONE(pendulum, bricard_count(pendulum, BRICARD_CONSTRAINTS, &count));
    CHECK(count == 0 && DOUBLE_PENDULUM_R == 0);
    DONE(pendulum, bricard_run(pendulum, 1.0, NULL, NULL));
    DONE(pendulum, bricard_state(pendulum, NULL, q, v, DOUBLE_PENDULUM_N));
    say("pendulum", q, DOUBLE_PENDULUM_N);
    CHECK(bricard_assign(pendulum, m) == BRICARD_ERROR_ARGUMENT);
    bricard_free(&pendulum);
    bricard_free(&m);
}

/* What Rust has to agree with. */
static void sizes(void)
{
    double bytes[8];
    bytes[0] = (double)sizeof(bricard_point);
    bytes[1] = (double)sizeof(bricard_options);
    bytes[2] = (double)sizeof(bricard_watch);
    bytes[3] = (double)sizeof(bricard_summary);
    bytes[4] = (double)sizeof(bricard_interface);
    bytes[5] = (double)offsetof(bricard_options, most_steps);
    bytes[6] = (double)offsetof(bricard_watch, take);
    bytes[7] = (double)offsetof(bricard_summary, energy_supplied);
    say("sizes", bytes, 8);
}

int main(void)
{
    sizes();
    run();
    sample();
    control();
    steps();
    laws();
    evaluate();
    other();
    return 0;
}
