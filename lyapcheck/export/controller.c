/* NAME: joint torques of TITLE. Written by lyapcheck export; do not edit.
 *
 * The bounds of rounding in NAME.json hold for doubles of IEEE 754, rounded to nearest, whether or not a
 * compiler fuses a product with a sum. Of the library only fabs is called; nothing is allocated.
 */
#include <float.h>
#include <limits.h>
#include <math.h>

#include "NAME.h"

#if FLT_RADIX != 2 || DBL_MANT_DIG != 53 || FLT_EVAL_METHOD != 0
#error "NAME needs doubles of IEEE 754 without excess precision; for x87 add -msse2 -mfpmath=sse"
#endif
#ifdef __FAST_MATH__
#error "NAME must be compiled without -ffast-math and -Ofast"
#endif

#define FLAT FLAT_VALUE /* from this |x| on h(x) is h of it, to the last bit but one */

static const double KP[NAME_JOINTS] = {KP_VALUES};
static const double KV[NAME_JOINTS] = {KV_VALUES};
static const double LIMIT[NAME_JOINTS] = {LIMIT_VALUES};
static const double FILTER[NAME_TAPS] = {FILTER_VALUES};

/* x less the nearest multiple k of c; 1/c and c in four parts, of which the first three times k are exact. */
static double reduced(double x, double inverse, double c0, double c1, double c2, double c3, double *k)
{
    const double turns = x * inverse;
    *k = (double)(long)(turns + (turns < 0.0 ? -0.5 : 0.5));
    return (((x - *k * c0) - *k * c1) - *k * c2) - *k * c3;
}

static void turned(double x, double *s, double *c)
{
    double k, sine, cosine;
SINE_TEXT
    switch ((int)(((long)k % 4 + 4) % 4)) {
    case 0:
        *s = sine;
        *c = cosine;
        break;
    case 1:
        *s = cosine;
        *c = -sine;
        break;
    case 2:
        *s = -sine;
        *c = -cosine;
        break;
    default:
        *s = -cosine;
        *c = sine;
        break;
    }
}

static double h(double x)
{
    const double a = fabs(x) < FLAT ? fabs(x) : FLAT;
H_TEXT
    return x < 0.0 ? -y : y;
}

/* g(q) from sines and cosines, N.m */
static void gravity(const double q[NAME_JOINTS], double g[NAME_JOINTS])
{
    double s[NAME_JOINTS], c[NAME_JOINTS];
    int i;
    for (i = 0; i < NAME_JOINTS; i++) {
        turned(q[i], &s[i], &c[i]);
    }
GRAVITY_TEXT
}

static int within(double x, double largest)
{
    return fabs(x) <= largest; /* which no NaN is */
}

int NAME_torque(const double q[NAME_JOINTS], const double w[NAME_JOINTS], const double goal[NAME_JOINTS],
                double tau[NAME_JOINTS])
{
    double g[NAME_JOINTS];
    int i;
    for (i = 0; i < NAME_JOINTS; i++) {
        if (!within(q[i], NAME_LARGEST) || !within(goal[i], NAME_LARGEST) || !within(w[i], DBL_MAX)) {
            return NAME_REFUSED;
        }
    }
    gravity(q, g);
    for (i = 0; i < NAME_JOINTS; i++) {
        const double kp = KP[i], kv = KV[i], he = h(goal[i] - q[i]), hw = h(w[i]), gi = g[i];
TORQUE_TEXT
    }
    return NAME_OK;
}

static void send(NAME_state *state, double tau[NAME_JOINTS])
{
    int i;
    for (i = 0; i < NAME_JOINTS; i++) {
        tau[i] = tau[i] > LIMIT[i] ? LIMIT[i] : tau[i] < -LIMIT[i] ? -LIMIT[i] : tau[i];
        state->tau[i] = tau[i];
    }
}

/* A reading that jumps by more than half a turn has passed the end of the encoder. */
static double turns_at(const NAME_state *state, int i, double q)
{
    double turns = state->turns[i];
    if (NAME_WRAPPED && state->started) {
        const double jump = q - state->reading[i];
        turns += jump > 0.5 * NAME_TURN ? -1.0 : jump < -0.5 * NAME_TURN ? 1.0 : 0.0;
    }
    return turns;
}

static int usable(const NAME_state *state, const double q[NAME_JOINTS], const double goal[NAME_JOINTS])
{
    int i;
    for (i = 0; i < NAME_JOINTS; i++) {
        if (!within(q[i], NAME_LARGEST) || !within(goal[i], NAME_LARGEST) ||
            !within(q[i] + NAME_TURN * turns_at(state, i, q[i]), NAME_LARGEST)) {
            return 0;
        }
    }
    return 1;
}

/* The last torque for NAME_HOLD samples; then gravity at the last good reading. */
static int held(NAME_state *state, double tau[NAME_JOINTS])
{
    int i;
    if (state->missed < INT_MAX - 1) {
        state->missed++;
    }
    if (state->flag == NAME_OK) {
        state->flag = NAME_HELD;
    }
    for (i = 0; i < NAME_JOINTS; i++) {
        tau[i] = state->tau[i];
    }
    if (state->started && state->missed > NAME_HOLD) {
        state->flag = NAME_GRAVITY;
        gravity(state->q, tau);
    }
    send(state, tau);
    return state->flag;
}

int NAME_step(NAME_state *state, const double q[NAME_JOINTS], const double goal[NAME_JOINTS],
              double tau[NAME_JOINTS])
{
    double w[NAME_JOINTS];
    int i, j, k;
    if (!usable(state, q, goal)) {
        return held(state, tau);
    }
    for (i = 0; i < NAME_JOINTS; i++) {
        const double turns = turns_at(state, i, q[i]), angle = q[i] + NAME_TURN * turns;
        const int samples = state->missed + 1; /* missed ones are bridged by a straight line */
        const double rate = state->started ? (angle - state->q[i]) / (NAME_PERIOD * samples) : 0.0;
        for (k = 0; k < samples && k < NAME_TAPS; k++) {
            for (j = NAME_TAPS - 1; j > 0; j--) {
                state->rate[j][i] = state->rate[j - 1][i];
            }
            state->rate[0][i] = rate;
        }
        w[i] = 0.0;
        for (j = 0; j < NAME_TAPS; j++) {
            w[i] += FILTER[j] * state->rate[j][i];
        }
        state->turns[i] = turns;
        state->reading[i] = q[i];
        state->q[i] = angle;
    }
    state->started = 1;
    state->missed = 0;
    (void)NAME_torque(state->q, w, goal, tau); /* which takes all that is usable */
    send(state, tau);
    return state->flag;
}
