/* The bench: LANES runs at once, each PERIODS long with SUBSTEPS steps of the arm a period.

   `controller` and `arm` are written above. Starts are (runs, 2N), parameters (runs, P); what comes out is
   (runs, periods + 1, 3N): q, w and the torque held from then on, the last one repeated. */

static void take(const double *from, int size, int64_t runs, int64_t first, double to[][LANES])
{
    for (int l = 0; l < LANES; l++) {
        const int64_t run = first + l < runs ? first + l : runs - 1;
        for (int i = 0; i < size; i++)
            to[i][l] = from[run * size + i];
    }
}

static void write_sample(double *out, int64_t samples, int64_t sample, int64_t runs, int64_t first,
                         const double y[2 * N][LANES], const double torque[N][LANES])
{
    for (int l = 0; l < LANES && first + l < runs; l++) {
        double *place = out + ((first + l) * samples + sample) * 3 * N;
        for (int i = 0; i < 2 * N; i++)
            place[i] = y[i][l];
        for (int i = 0; i < N; i++)
            place[2 * N + i] = torque[i][l];
    }
}

void bench_runs(int64_t runs, int64_t periods, const double *starts, const double *parameters, double *out)
{
    double y[2 * N][LANES], last[N][LANES], torque[N][LANES], p[P][LANES];
    for (int64_t first = 0; first < runs; first += LANES) {
        take(starts, 2 * N, runs, first, y);
        take(parameters, P, runs, first, p);
        for (int i = 0; i < N; i++)
            for (int l = 0; l < LANES; l++)
                last[i][l] = y[i][l] - PERIOD * y[N + i][l];
        for (int64_t k = 0; k < periods; k++) {
            controller(y, p, last, torque);
            write_sample(out, periods + 1, k, runs, first, y, torque);
            for (int step = 0; step < SUBSTEPS; step++)
                arm(y, p, torque);
        }
        write_sample(out, periods + 1, periods, runs, first, y, torque);
    }
}
