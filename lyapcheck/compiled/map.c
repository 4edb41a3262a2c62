/* Apply the straight line in map_block to `count` states of each of `groups` groups.

   q, e, w are (groups, count, N), p is (groups, P) and out is (groups, count, OUT), all without gaps. States
   are turned into columns of LANES, so that one line of the body serves many states at a time. Returns how many
   numbers lay outside the range of the elementary functions: then the output means nothing. */

static int64_t outside(const double *x, int64_t count, double limit)
{
    int64_t bad = 0;
#pragma omp simd reduction(+ : bad)
    for (int64_t i = 0; i < count; i++)
        bad += !(fabs(x[i]) <= limit);
    return bad;
}

static void to_columns(const double *x, int lanes, double column[N][LANES])
{
    for (int l = 0; l < lanes; l++)
        for (int i = 0; i < N; i++)
            column[i][l] = x[l * N + i];
    for (int l = lanes; l < LANES; l++)
        for (int i = 0; i < N; i++)
            column[i][l] = 0.0;
}

static void map_block(const double q[N][LANES], const double e[N][LANES], const double w[N][LANES], const double *p,
                      double out[OUT][LANES])
{
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        MAP_BODY
    }
}

int64_t map_states(int64_t groups, int64_t count, const double *q, const double *e, const double *w, const double *p,
                   double *out)
{
    double columns[3][N][LANES], results[OUT][LANES];
    int64_t bad = 0;
    for (int64_t group = 0; group < groups; group++, p += P) {
        for (int64_t start = 0; start < count; start += LANES) {
            const int lanes = count - start < LANES ? (int)(count - start) : LANES;
            bad += outside(q, lanes * N, LARGEST_ANGLE) + outside(e, lanes * N, LARGEST_STATE)
                 + outside(w, lanes * N, LARGEST_STATE);
            to_columns(q, lanes, columns[0]);
            to_columns(e, lanes, columns[1]);
            to_columns(w, lanes, columns[2]);
            map_block(columns[0], columns[1], columns[2], p, results);
            for (int l = 0; l < lanes; l++)
                for (int k = 0; k < OUT; k++)
                    out[l * OUT + k] = results[k][l];
            q += lanes * N, e += lanes * N, w += lanes * N, out += lanes * OUT;
        }
    }
    return bad;
}
