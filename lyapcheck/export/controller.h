/* NAME: joint torques of TITLE. Written by lyapcheck export; do not edit.
 *
 * tau = K_p h(goal - q) - K_v h(w) + g(q), angles in rad, rates in rad/s, torques in N.m, h: H_NAME.
 * Rounding moves no torque by more than NAME.json says, a computed bound, for |q|, |goal| up to
 * NAME_LARGEST rad and all finite w. Limits of motors are not applied by NAME_torque.
 */
#ifndef NAME_H
#define NAME_H

#ifdef __cplusplus
extern "C" {
#endif

#define NAME_JOINTS JOINTS_VALUE
#define NAME_PERIOD PERIOD_VALUE /* s between two calls of NAME_step */
#define NAME_TAPS TAPS_VALUE /* of the filter of backward differences */
#define NAME_HOLD HOLD_VALUE /* samples for which the last torque is sent without a good reading */
#define NAME_WRAPPED WRAPPED_VALUE /* whether readings jump at a full turn */
#define NAME_TURN TURN_VALUE
#define NAME_LARGEST 1073741824.0 /* rad; angles beyond are refused */

enum {
    NAME_OK = 0,
    NAME_REFUSED = 1, /* NAME_torque: an argument is not finite or too large, tau is left as it was */
    NAME_HELD = 2,    /* NAME_step: a last torque was sent in place of one that could not be computed */
    NAME_GRAVITY = 3  /* NAME_step: readings failed for longer, and gravity alone was held */
};

/* One of zeros is a new one. */
typedef struct {
    double reading[NAME_JOINTS]; /* the last good one, as it came */
    double turns[NAME_JOINTS];
    double q[NAME_JOINTS]; /* the same, unwrapped */
    double rate[NAME_TAPS][NAME_JOINTS]; /* backward differences over the period, newest first */
    double tau[NAME_JOINTS];             /* what was sent last */
    int started, missed;
    int flag; /* the worst so far; stays until you set it to NAME_OK */
} NAME_state;

int NAME_torque(const double q[NAME_JOINTS], const double w[NAME_JOINTS], const double goal[NAME_JOINTS],
                double tau[NAME_JOINTS]);
int NAME_step(NAME_state *state, const double q[NAME_JOINTS], const double goal[NAME_JOINTS],
              double tau[NAME_JOINTS]);

#ifdef __cplusplus
}
#endif

#endif
