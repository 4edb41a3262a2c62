/* Many initial value problems at once by DOP853, each with its own steps.

   LANES runs advance together; a lane whose run has ended takes the next one. `rate` and the weights of the
   method are written above. Runs are (runs, D) starts and (runs, P) parameters, both without gaps; what comes
   out is (runs, points, D) at even times from 0 to T, NaN where a run did not get. */

enum { DONE = 0, TOO_MANY_STEPS = 1, STEP_TOO_SMALL = 2, OUT_OF_RANGE = 3 };

typedef double State[D][LANES];

typedef struct {
    State y, next, trial, k[16], dense[7];
    double p[P][LANES], t[LANES], h[LANES], error[LANES];
    int64_t run[LANES], attempts[LANES], sample[LANES];
    int rejected[LANES];
} Lanes;

typedef struct {
    const double *y0, *p;
    double T, tolerance, absolute, *out;
    int64_t runs, points, most, started;
    int32_t *status, *steps;
} Task;

#define EVERYWHERE                                                                                                     \
    for (int i = 0; i < D; i++)                                                                                        \
        _Pragma("omp simd") for (int l = 0; l < LANES; l++)

#define STAGE(number, weights)                                                                                         \
    EVERYWHERE s->trial[i][l] = s->y[i][l] + s->h[l] * (weights);                                                      \
    rate(s->trial, s->p, s->k[number]);

static void step(Lanes *s)
{
    STAGE(1, STAGE_1)
    STAGE(2, STAGE_2)
    STAGE(3, STAGE_3)
    STAGE(4, STAGE_4)
    STAGE(5, STAGE_5)
    STAGE(6, STAGE_6)
    STAGE(7, STAGE_7)
    STAGE(8, STAGE_8)
    STAGE(9, STAGE_9)
    STAGE(10, STAGE_10)
    STAGE(11, STAGE_11)
    EVERYWHERE s->next[i][l] = s->y[i][l] + s->h[l] * (STEP);
    rate(s->next, s->p, s->k[12]);
}

/* The error per step, at most 1 if it is within the tolerance. */
static void estimate(Lanes *s, const Task *task)
{
    double fifth[LANES] = {0}, third[LANES] = {0};
    EVERYWHERE
    {
        const double scale = task->absolute + task->tolerance * larger(fabs(s->y[i][l]), fabs(s->next[i][l]));
        const double a = (ERROR_5) / scale, b = (ERROR_3) / scale;
        fifth[l] += a * a;
        third[l] += b * b;
    }
    for (int l = 0; l < LANES; l++) {
        const double both = fifth[l] + 0.01 * third[l];
        s->error[l] = both == 0.0 ? 0.0 : s->h[l] * fifth[l] / sqrt(both * D);
    }
}

/* The polynomial between the two ends of a step. */
static void between(Lanes *s)
{
    STAGE(13, EXTRA_13)
    STAGE(14, EXTRA_14)
    STAGE(15, EXTRA_15)
    EVERYWHERE
    {
        const double rise = s->next[i][l] - s->y[i][l], h = s->h[l];
        s->dense[0][i][l] = rise;
        s->dense[1][i][l] = h * s->k[0][i][l] - rise;
        s->dense[2][i][l] = 2.0 * rise - h * (s->k[12][i][l] + s->k[0][i][l]);
        s->dense[3][i][l] = h * (DENSE_3);
        s->dense[4][i][l] = h * (DENSE_4);
        s->dense[5][i][l] = h * (DENSE_5);
        s->dense[6][i][l] = h * (DENSE_6);
    }
}

/* Where a step ends, with room for the rounding of the last one. */
static double reach(const Lanes *s, const Task *task, int l)
{
    return s->t[l] + s->h[l] + 1e-14 * task->T;
}

static double time_of(const Task *task, int64_t sample)
{
    return task->T * (double)sample / (double)(task->points - 1);
}

static void write_samples(Lanes *s, const Task *task, int l)
{
    double f[7][D], y[D];
    const double end = reach(s, task, l);
    for (int i = 0; i < D; i++) {
        y[i] = s->y[i][l];
        for (int j = 0; j < 7; j++)
            f[j][i] = s->dense[j][i][l];
    }
    double *out = task->out + (s->run[l] * task->points + s->sample[l]) * D;
    for (; s->sample[l] < task->points && time_of(task, s->sample[l]) <= end; s->sample[l]++, out += D) {
        const double x = (time_of(task, s->sample[l]) - s->t[l]) / s->h[l], z = 1.0 - x;
#pragma omp simd
        for (int i = 0; i < D; i++)
            out[i] = y[i] + x * (f[0][i] + z * (f[1][i] + x * (f[2][i] + z * (f[3][i]
                   + x * (f[4][i] + z * (f[5][i] + x * f[6][i]))))));
    }
}

/* End the run of a lane; samples it did not reach are NaN. */
static void finish(Lanes *s, const Task *task, int l, int status)
{
    task->status[s->run[l]] = status;
    task->steps[s->run[l]] = (int32_t)s->attempts[l];
    double *out = task->out + s->run[l] * task->points * D;
    for (int64_t j = s->sample[l] * D; j < task->points * D; j++)
        out[j] = NAN;
    s->run[l] = -1;
}

static int in_range(const Lanes *s, int l)
{
    int good = 1;
    for (int i = 0; i < D; i++)
        good &= fabs(s->next[i][l]) <= (i < N ? LARGEST_ANGLE : LARGEST_STATE);
    return good;
}

static void accept_step(Lanes *s, const Task *task, int l)
{
    write_samples(s, task, l);
    s->t[l] += s->h[l];
    for (int i = 0; i < D; i++) {
        s->y[i][l] = s->next[i][l];
        s->k[0][i][l] = s->k[12][i][l];
    }
}

/* The next step of a lane, from the error of the last one. */
static void decide(Lanes *s, const Task *task, int l)
{
    const double error = s->error[l], last = s->h[l];
    const double wanted = error == 0.0 ? 10.0 : error < INFINITY ? 0.9 / sqrt(sqrt(sqrt(error))) : 0.2;
    const int good = error < 1.0;
    const double most = good && !s->rejected[l] ? 10.0 : 1.0;
    s->attempts[l]++;
    if (good && !in_range(s, l)) {
        finish(s, task, l, OUT_OF_RANGE);
        return;
    }
    if (good)
        accept_step(s, task, l);
    s->rejected[l] = !good;
    const double left = task->T - s->t[l], next = last * larger(0.2, smaller(wanted, most));
    s->h[l] = smaller(next, left);
    if (s->sample[l] == task->points)
        finish(s, task, l, DONE);
    else if (s->attempts[l] >= task->most)
        finish(s, task, l, TOO_MANY_STEPS);
    else if (!(next > 1e-15 * task->T))
        finish(s, task, l, STEP_TOO_SMALL);
    else if (left - s->h[l] < 1e-12 * task->T)
        s->h[l] = left;
}

static double first_step(const Lanes *s, const Task *task, int l)
{
    double size = 0.0, speed = 0.0;
    for (int i = 0; i < D; i++) {
        const double scale = task->absolute + task->tolerance * fabs(s->y[i][l]);
        size += s->y[i][l] / scale * (s->y[i][l] / scale);
        speed += s->k[0][i][l] / scale * (s->k[0][i][l] / scale);
    }
    size = sqrt(size / D), speed = sqrt(speed / D);
    const double h = size < 1e-5 || speed < 1e-5 ? 1e-6 : 0.01 * size / speed;
    return smaller(h, task->T);
}

/* Give every idle lane the next run; whether any lane has one. */
static int take_runs(Lanes *s, Task *task)
{
    int fresh[LANES] = {0}, any = 0, busy = 0;
    for (int l = 0; l < LANES; l++) {
        if (s->run[l] < 0 && task->started < task->runs) {
            const int64_t run = s->run[l] = task->started++;
            for (int i = 0; i < D; i++)
                s->y[i][l] = task->out[run * task->points * D + i] = task->y0[run * D + i];
            for (int i = 0; i < P; i++)
                s->p[i][l] = task->p[run * P + i];
            s->t[l] = 0.0, s->attempts[l] = 0, s->sample[l] = 1, s->rejected[l] = 0;
            fresh[l] = any = 1;
        }
        busy |= s->run[l] >= 0;
    }
    if (any) {
        rate(s->y, s->p, s->trial);
        for (int l = 0; l < LANES; l++)
            if (fresh[l]) {
                for (int i = 0; i < D; i++)
                    s->k[0][i][l] = s->trial[i][l];
                s->h[l] = first_step(s, task, l);
            }
    }
    return busy;
}

static int samples_due(const Lanes *s, const Task *task)
{
    int due = 0;
    for (int l = 0; l < LANES; l++)
        due |= s->run[l] >= 0 && s->error[l] < 1.0 && time_of(task, s->sample[l]) <= reach(s, task, l);
    return due;
}

void integrate_runs(int64_t runs, int64_t points, const double *y0, const double *p, double T, double tolerance,
                    double absolute, int64_t most, double *out, int32_t *status, int32_t *steps)
{
    Task task = {y0, p, T, tolerance, absolute, out, runs, points, most, 0, status, steps};
    Lanes s;
    memset(&s, 0, sizeof s);
    for (int l = 0; l < LANES; l++)
        s.run[l] = -1;
    while (take_runs(&s, &task)) {
        step(&s);
        estimate(&s, &task);
        if (samples_due(&s, &task))
            between(&s);
        for (int l = 0; l < LANES; l++)
            if (s.run[l] >= 0)
                decide(&s, &task, l);
    }
}
