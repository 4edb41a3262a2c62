/* One step of the method DOP853 for LANES runs that advance together, and the polynomial between its ends.

   `rate` and the weights of the method are written above. */

typedef double State[D][LANES];

typedef struct {
    State y, next, trial, k[16], dense[7];
    double p[P][LANES], t[LANES], h[LANES], error[LANES], tolerance, absolute;
} Lanes;

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
static void estimate(Lanes *s)
{
    double fifth[LANES] = {0}, third[LANES] = {0};
    EVERYWHERE
    {
        const double scale = s->absolute + s->tolerance * larger(fabs(s->y[i][l]), fabs(s->next[i][l]));
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

/* A component of a lane at a fraction x of the step. */
static inline double polynomial(const Lanes *s, int i, int l, double x)
{
    const double z = 1.0 - x;
    return s->y[i][l] + x * (s->dense[0][i][l] + z * (s->dense[1][i][l] + x * (s->dense[2][i][l]
           + z * (s->dense[3][i][l] + x * (s->dense[4][i][l] + z * (s->dense[5][i][l]
           + x * s->dense[6][i][l]))))));
}
