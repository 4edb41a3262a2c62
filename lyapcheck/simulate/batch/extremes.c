/* What is largest along a run and when each joint settles, from the polynomials between the ends of steps.

   `watch` of |τ_i| and V is written above. Looked at are the ends of the PARTS of each step; where a torque
   turns near the largest of them, the polynomial is searched; e_i turns where w_i is zero. */

enum { PARTS = 4, CUTS = 16, HALVINGS = 48 };

/* What a run hands back: N largest |τ_i|, N largest −sign(e_i(0)) e_i, N settling times, then the largest rise
   of V above what it was before, of |V + D − V(0)|, of |V| and of the dissipated D. */
enum { TORQUE = 0, BEYOND = N, SETTLED = 2 * N, RISE = 3 * N, BALANCE, ENERGY, LOST, SEEN };

typedef struct {
    State at[PARTS + 1];
    double watched[PARTS + 1][N + 1][LANES];
    double seen[SEEN][LANES], least[LANES], first[LANES], band[N][LANES], sign[N][LANES];
    int outside[N][LANES];
} Watch;

/* The largest of some torque between two fractions of the step of every lane, by the golden section. */
static void search(const Lanes *s, int joint, double low[LANES], double high[LANES], double top[LANES])
{
    State y;
    double value[2][N + 1][LANES], x[2][LANES];
    for (int cut = 0; cut < CUTS; cut++) {
        for (int k = 0; k < 2; k++) {
            for (int l = 0; l < LANES; l++)
                x[k][l] = low[l] + (k ? 0.6180339887498949 : 0.3819660112501051) * (high[l] - low[l]);
            EVERYWHERE y[i][l] = polynomial(s, i, l, x[k][l]);
            watch(y, s->p, value[k]);
        }
        for (int l = 0; l < LANES; l++) {
            const int left = value[0][joint][l] > value[1][joint][l];
            top[l] = larger(top[l], larger(value[0][joint][l], value[1][joint][l]));
            if (left)
                high[l] = x[1][l];
            else
                low[l] = x[0][l];
        }
    }
}

/* Whether a torque may turn beside the largest end of a part and be larger there than ever before; where. */
static int may_turn(const Watch *a, int joint, int l, double *low, double *high)
{
    double v[PARTS + 1], bend = 0.0, near = INFINITY;
    int top = 0;
    for (int k = 0; k <= PARTS; k++) {
        v[k] = a->watched[k][joint][l];
        top = v[k] > v[top] ? k : top;
    }
    for (int k = 1; k < PARTS; k++)
        bend = larger(bend, fabs(v[k - 1] - 2.0 * v[k] + v[k + 1]));
    for (int k = -1; k <= 1; k += 2)
        if (0 <= top + k && top + k <= PARTS)
            near = smaller(near, v[top] - v[top + k]);
    if (near > bend || v[top] + bend <= a->seen[TORQUE + joint][l])
        return 0;
    *low = (top > 0 ? top - 1 : 0) / (double)PARTS;
    *high = (top < PARTS ? top + 1 : PARTS) / (double)PARTS;
    return 1;
}

/* The fraction of the step at which e_i comes into its band, or w_i is zero; the sign changes from a to b. */
static double crossing(const Lanes *s, const Watch *a, int joint, int l, double low, double high, int turns)
{
    const int i = turns ? N + joint : joint;
    const double shift = turns ? 0.0 : s->p[joint][l], band = turns ? 0.0 : a->band[joint][l];
    const double start = polynomial(s, i, l, low) - shift, side = start < 0.0 ? -1.0 : 1.0;
    for (int cut = 0; cut < HALVINGS; cut++) {
        const double middle = 0.5 * (low + high);
        if (side * (polynomial(s, i, l, middle) - shift) > band)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

static void look_at_error(const Lanes *s, Watch *a, int joint, int l)
{
    const double goal = s->p[joint][l], sign = a->sign[joint][l], band = a->band[joint][l];
    double *beyond = &a->seen[BEYOND + joint][l];
    for (int k = 0; k < PARTS; k++) {
        double last = k / (double)PARTS;
        const double error = goal - a->at[k + 1][joint][l];
        if (a->at[k][N + joint][l] * a->at[k + 1][N + joint][l] < 0.0) {
            const double x = crossing(s, a, joint, l, last, (k + 1) / (double)PARTS, 1);
            const double turn = goal - polynomial(s, joint, l, x);
            *beyond = larger(*beyond, -sign * turn);
            if (fabs(turn) > band)
                a->outside[joint][l] = 1, last = x;
        }
        *beyond = larger(*beyond, -sign * error);
        if (fabs(error) > band)
            a->outside[joint][l] = 1;
        else if (a->outside[joint][l]) {
            const double x = crossing(s, a, joint, l, last, (k + 1) / (double)PARTS, 0);
            a->seen[SETTLED + joint][l] = s->t[l] + s->h[l] * x;
            a->outside[joint][l] = 0;
        }
    }
}

static void look_at_end(Watch *a, int k, int l)
{
    const double V = a->watched[k][N][l], lost = a->at[k][D - 2][l];
    for (int i = 0; i < N; i++)
        a->seen[TORQUE + i][l] = larger(a->seen[TORQUE + i][l], a->watched[k][i][l]);
    a->seen[RISE][l] = larger(a->seen[RISE][l], V - a->least[l]);
    a->least[l] = smaller(a->least[l], V);
    a->seen[BALANCE][l] = larger(a->seen[BALANCE][l], fabs(V + lost - a->first[l]));
    a->seen[ENERGY][l] = larger(a->seen[ENERGY][l], fabs(V));
    a->seen[LOST][l] = larger(a->seen[LOST][l], fabs(lost));
}

/* The whole step, between its ends too, of the lanes that are good. */
static void look(const Lanes *s, Watch *a, const int good[LANES])
{
    double low[LANES], high[LANES], top[LANES];
    for (int k = 1; k <= PARTS; k++) {
        const double x = k / (double)PARTS;
        EVERYWHERE a->at[k][i][l] = k < PARTS ? polynomial(s, i, l, x) : s->next[i][l];
        watch(a->at[k], s->p, a->watched[k]);
    }
    for (int joint = 0; joint < N; joint++) {
        int any = 0;
        for (int l = 0; l < LANES; l++) {
            top[l] = low[l] = high[l] = 0.0;
            any |= good[l] && may_turn(a, joint, l, &low[l], &high[l]);
        }
        if (any)
            search(s, joint, low, high, top);
        for (int l = 0; l < LANES; l++)
            if (good[l])
                a->seen[TORQUE + joint][l] = larger(a->seen[TORQUE + joint][l], top[l]);
    }
    for (int l = 0; l < LANES; l++)
        if (good[l]) {
            for (int joint = 0; joint < N; joint++)
                look_at_error(s, a, joint, l);
            for (int k = 1; k <= PARTS; k++)
                look_at_end(a, k, l);
            for (int i = 0; i < D; i++)
                a->at[0][i][l] = s->next[i][l];
            for (int i = 0; i <= N; i++)
                a->watched[0][i][l] = a->watched[PARTS][i][l];
        }
}

/* A run that begins: (N + 1) torques and V, (N) bands. */
static void look_at_start(const Lanes *s, Watch *a, const double watched[N + 1][LANES], const double *band, int l)
{
    for (int i = 0; i < SEEN; i++)
        a->seen[i][l] = 0.0;
    for (int i = 0; i < D; i++)
        a->at[0][i][l] = s->y[i][l];
    for (int i = 0; i <= N; i++)
        a->watched[0][i][l] = watched[i][l];
    for (int i = 0; i < N; i++) {
        const double error = s->p[i][l] - s->y[i][l];
        a->band[i][l] = band[i];
        a->sign[i][l] = error > 0.0 ? 1.0 : error < 0.0 ? -1.0 : 0.0;
        a->outside[i][l] = fabs(error) > band[i];
        a->seen[TORQUE + i][l] = watched[i][l];
    }
    a->least[l] = a->first[l] = watched[N][l];
    a->seen[RISE][l] = -INFINITY;
    a->seen[ENERGY][l] = fabs(watched[N][l]);
}
