/* Many initial value problems at once, each with its own steps.

   A lane whose run has ended takes the next one. Runs are (runs, D) starts, (runs, P) parameters and (runs, N)
   bands, all without gaps; what comes out is (runs, points, D) at even times from 0 to T, NaN where a run did not
   get, and (runs, SEEN) of what was seen along it, NaN where it did not reach T. */

enum { DONE = 0, TOO_MANY_STEPS = 1, STEP_TOO_SMALL = 2, OUT_OF_RANGE = 3 };

typedef struct {
    const double *y0, *p, *band;
    double T, *out, *seen;
    int64_t runs, points, most, started;
    int32_t *status, *steps;
} Task;

typedef struct {
    Lanes lanes;
    Watch watch;
    int64_t run[LANES], attempts[LANES], sample[LANES];
    int rejected[LANES];
} Course;

/* Where a step ends, with room for the rounding of the last one. */
static double reach(const Lanes *s, const Task *task, int l)
{
    return s->t[l] + s->h[l] + 1e-14 * task->T;
}

static double time_of(const Task *task, int64_t sample)
{
    return task->T * (double)sample / (double)(task->points - 1);
}

static void write_samples(Course *c, const Task *task, int l)
{
    const Lanes *s = &c->lanes;
    const double end = reach(s, task, l);
    double *out = task->out + (c->run[l] * task->points + c->sample[l]) * D;
    for (; c->sample[l] < task->points && time_of(task, c->sample[l]) <= end; c->sample[l]++, out += D) {
        const double x = (time_of(task, c->sample[l]) - s->t[l]) / s->h[l];
        for (int i = 0; i < D; i++)
            out[i] = polynomial(s, i, l, x);
    }
}

/* End the run of a lane; samples it did not reach are NaN. */
static void finish(Course *c, const Task *task, int l, int status)
{
    const int64_t run = c->run[l];
    task->status[run] = status;
    task->steps[run] = (int32_t)c->attempts[l];
    for (int64_t j = c->sample[l] * D; j < task->points * D; j++)
        task->out[run * task->points * D + j] = NAN;
    for (int i = 0; i < SEEN; i++)
        task->seen[run * SEEN + i] = status == DONE ? c->watch.seen[i][l] : NAN;
    for (int i = 0; i < N; i++)
        if (c->watch.outside[i][l])
            task->seen[run * SEEN + SETTLED + i] = NAN;
    c->run[l] = -1;
}

static int in_range(const Lanes *s, int l)
{
    int good = 1;
    for (int i = 0; i < D; i++)
        good &= fabs(s->next[i][l]) <= (i < N ? LARGEST_ANGLE : LARGEST_STATE);
    return good;
}

static void accept_step(Course *c, const Task *task, int l)
{
    Lanes *s = &c->lanes;
    write_samples(c, task, l);
    s->t[l] += s->h[l];
    for (int i = 0; i < D; i++) {
        s->y[i][l] = s->next[i][l];
        s->k[0][i][l] = s->k[12][i][l];
    }
}

/* The next step of a lane, from the error of the last one. */
static void decide(Course *c, const Task *task, int l)
{
    Lanes *s = &c->lanes;
    const double error = s->error[l], last = s->h[l];
    const double wanted = error == 0.0 ? 10.0 : error < INFINITY ? 0.9 / sqrt(sqrt(sqrt(error))) : 0.2;
    const int good = error < 1.0;
    const double most = good && !c->rejected[l] ? 10.0 : 1.0;
    c->attempts[l]++;
    if (good && !in_range(s, l)) {
        finish(c, task, l, OUT_OF_RANGE);
        return;
    }
    if (good)
        accept_step(c, task, l);
    c->rejected[l] = !good;
    const double left = task->T - s->t[l], next = last * larger(0.2, smaller(wanted, most));
    s->h[l] = smaller(next, left);
    if (c->sample[l] == task->points)
        finish(c, task, l, DONE);
    else if (c->attempts[l] >= task->most)
        finish(c, task, l, TOO_MANY_STEPS);
    else if (!(next > 1e-15 * task->T))
        finish(c, task, l, STEP_TOO_SMALL);
    else if (left - s->h[l] < 1e-12 * task->T)
        s->h[l] = left;
}

static double first_step(const Lanes *s, const Task *task, int l)
{
    double size = 0.0, speed = 0.0;
    for (int i = 0; i < D; i++) {
        const double scale = s->absolute + s->tolerance * fabs(s->y[i][l]);
        size += s->y[i][l] / scale * (s->y[i][l] / scale);
        speed += s->k[0][i][l] / scale * (s->k[0][i][l] / scale);
    }
    size = sqrt(size / D), speed = sqrt(speed / D);
    const double h = size < 1e-5 || speed < 1e-5 ? 1e-6 : 0.01 * size / speed;
    return smaller(h, task->T);
}

/* Give every idle lane the next run; whether any lane has one. */
static int take_runs(Course *c, Task *task)
{
    Lanes *s = &c->lanes;
    double watched[N + 1][LANES];
    int fresh[LANES] = {0}, any = 0, busy = 0;
    for (int l = 0; l < LANES; l++) {
        if (c->run[l] < 0 && task->started < task->runs) {
            const int64_t run = c->run[l] = task->started++;
            for (int i = 0; i < D; i++)
                s->y[i][l] = task->out[run * task->points * D + i] = task->y0[run * D + i];
            for (int i = 0; i < P; i++)
                s->p[i][l] = task->p[run * P + i];
            s->t[l] = 0.0, c->attempts[l] = 0, c->sample[l] = 1, c->rejected[l] = 0;
            fresh[l] = any = 1;
        }
        busy |= c->run[l] >= 0;
    }
    if (any) {
        rate(s->y, s->p, s->trial);
        watch(s->y, s->p, watched);
        for (int l = 0; l < LANES; l++)
            if (fresh[l]) {
                for (int i = 0; i < D; i++)
                    s->k[0][i][l] = s->trial[i][l];
                s->h[l] = first_step(s, task, l);
                look_at_start(s, &c->watch, watched, task->band + c->run[l] * N, l);
            }
    }
    return busy;
}

void integrate_runs(int64_t runs, int64_t points, const double *y0, const double *p, const double *band, double T,
                    double tolerance, double absolute, int64_t most, double *out, double *seen, int32_t *status,
                    int32_t *steps)
{
    Task task = {y0, p, band, T, out, seen, runs, points, most, 0, status, steps};
    Course c;
    memset(&c, 0, sizeof c);
    c.lanes.tolerance = tolerance, c.lanes.absolute = absolute;
    for (int l = 0; l < LANES; l++)
        c.run[l] = -1;
    while (take_runs(&c, &task)) {
        int good[LANES], any = 0;
        step(&c.lanes);
        estimate(&c.lanes);
        for (int l = 0; l < LANES; l++)
            any |= good[l] = c.run[l] >= 0 && c.lanes.error[l] < 1.0;
        if (any) {
            between(&c.lanes);
            look(&c.lanes, &c.watch, good);
        }
        for (int l = 0; l < LANES; l++)
            if (c.run[l] >= 0)
                decide(&c, &task, l);
    }
}
