/* NAME: COUNT_VALUE torques from balls, and what must be refused. Written by lyapcheck export; do not edit. */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "NAME.h"

/* N.m, computed bounds of rounding: for angles up to 4096 rad, and up to NAME_LARGEST */
static const double BOUND[2][NAME_JOINTS] = {
    BOUND_VALUES
};

/* The torque is high + low, to far below the bounds. */
static const struct {
    int far;
    double q[NAME_JOINTS], w[NAME_JOINTS], goal[NAME_JOINTS], high[NAME_JOINTS], low[NAME_JOINTS];
} VECTORS[COUNT_VALUE] = {
    VECTORS_TEXT
};

static int faults;

static void check(int right, const char *what)
{
    if (!right) {
        faults++;
        printf("FAIL: %s\n", what);
    }
}

static void check_bad(double bad, const char *what)
{
    double q[NAME_JOINTS] = {0.0}, w[NAME_JOINTS] = {0.0}, goal[NAME_JOINTS] = {0.0}, tau[NAME_JOINTS] = {0.0};
    double first[NAME_JOINTS];
    static const NAME_state fresh;
    NAME_state state = fresh;
    int i, k, same = 1;
    check(NAME_step(&state, q, goal, tau) == NAME_OK, "a good reading is flagged");
    for (i = 0; i < NAME_JOINTS; i++) {
        first[i] = tau[i];
    }
    q[NAME_JOINTS - 1] = bad;
    check(NAME_torque(q, w, goal, tau) == NAME_REFUSED, what);
    check(NAME_torque(w, w, q, tau) == NAME_REFUSED, what);
    check(fabs(bad) <= DBL_MAX || NAME_torque(w, q, goal, tau) == NAME_REFUSED, what);
    for (i = 0; i < NAME_JOINTS; i++) {
        check(fabs(tau[i] - first[i]) <= 0.0, "a refusal changes tau");
    }
    for (k = 1; k <= NAME_HOLD + 1; k++) {
        check(NAME_step(&state, q, goal, tau) == (k <= NAME_HOLD ? NAME_HELD : NAME_GRAVITY), what);
        for (i = 0; i < NAME_JOINTS; i++) {
            same = same && (k > NAME_HOLD || fabs(tau[i] - first[i]) <= 0.0) && fabs(tau[i]) <= DBL_MAX;
        }
    }
    check(same, "the last torque is not held");
    q[NAME_JOINTS - 1] = 0.0;
    check(NAME_step(&state, q, goal, tau) == NAME_GRAVITY, "the flag does not stay");
}

int main(void)
{
    double worst = 0.0;
    int i, k;
    for (k = 0; k < COUNT_VALUE; k++) {
        double tau[NAME_JOINTS];
        check(NAME_torque(VECTORS[k].q, VECTORS[k].w, VECTORS[k].goal, tau) == NAME_OK, "a vector is refused");
        for (i = 0; i < NAME_JOINTS; i++) {
            const double error = fabs((tau[i] - VECTORS[k].high[i]) - VECTORS[k].low[i]);
            const double bound = BOUND[VECTORS[k].far][i];
            check(error <= bound, "a torque is farther from its ball than the bound of rounding");
            worst = bound > 0.0 && error / bound > worst ? error / bound : worst;
        }
    }
    check_bad(NAN, "a reading that is no number");
    check_bad(INFINITY, "an infinite reading");
    check_bad(-2.0 * NAME_LARGEST, "a reading beyond the largest angle");
    printf("%s: NAME, COUNT_VALUE vectors, largest error %.2g of its bound\n", faults ? "FAIL" : "PASS", worst);
    return faults != 0;
}
