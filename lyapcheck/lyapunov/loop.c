/* Applies the statements below to lanes first … last − 1 of some arrays.

   Array g has SIZES[g] entries a lane: entry i of lane l stands at at[g][i * step[2 g] + l * step[2 g + 1]]; the
   last array is written. Lanes are turned into columns of LANES, so that one statement serves many at a time. */

static inline void fill(double column[][LANES], int size, const double *at, const long *step, long first, int lanes)
{
    for (int i = 0; i < size; i++) {
        const double *from = at + i * step[0] + first * step[1];
        if (step[1] == 0)
            for (int l = 0; l < LANES; l++)
                column[i][l] = from[0];
        else {
            for (int l = 0; l < lanes; l++)
                column[i][l] = from[l * step[1]];
            for (int l = lanes; l < LANES; l++)
                column[i][l] = from[0];
        }
    }
}

void run(long first, long last, double *const *at, const long *step)
{
    double x[INPUTS][LANES], y[OUTPUTS][LANES];
    for (; first < last; first += LANES) {
        const int lanes = last - first < LANES ? (int)(last - first) : LANES;
        for (int g = 0, i = 0; g < GROUPS; i += SIZES[g++])
            fill(x + i, SIZES[g], at[g], step + 2 * g, first, lanes);
#pragma omp simd
        for (int l = 0; l < LANES; l++) {
            BODY
        }
        for (int i = 0; i < OUTPUTS; i++)
            for (int l = 0; l < lanes; l++)
                at[GROUPS][i * step[2 * GROUPS] + (first + l) * step[2 * GROUPS + 1]] = y[i][l];
    }
}
