"""The paper's controllers on the computer that ran them, from printed numbers: a reading every 2.5 ms.

The paper's theorem is about a torque that changes at every instant. Its computer holds a torque for 2.5 ms
and takes velocities from backward differences. With F_j the weights of these differences (here one, of 1), d
the samples from a reading to its torque, and Γ_i = Σ_j min(k_gi, k_gj),

    (S)  b_i > L k_vi Σ|F_j| + (½ + d) T (ρ k_pi + Γ_i)   for every joint

makes the goal globally asymptotically stable, whatever the inertia. ``formal/`` proves it for every n.

Each claim rests on six suppositions, which ``lyapcheck explain sampled.m1`` and its certificate list:
torques go out as soon as a reading is taken; no interval is longer than 2.5 ms; readings are exact and
unwrapped; g is known; b_i ≥ 0.406, the least viscous friction that is printed, and there is no dry friction;
the arm is serial, its joints revolute.
"""

from fractions import Fraction

from lyapcheck.claims import Proof, sampled

proof = Proof(
    "sampled", "The paper's controllers on a computer, from printed numbers", reference="reyes2019family"
)

GAINS = {
    # Table 2: K_p, K_v; the longest period, ms; that of one sample late, ms
    1: ((28, 60, 5), "0.233", "3.389", "1.129"),
    2: ((27, 50, 5), "0.223", "3.379", "1.126"),
    3: ((25, 50, 5), "0.223", "2.185", "0.7283"),
}
PRINTED = {"k_g": (0, "40.28", "1.81"), "viscous_min": ("0.406",) * 3}
"""Bounds of the torques of gravity, and the least viscous friction."""
PERIOD = "2.5"


def loop(m, milliseconds=PERIOD, **others):
    """The gains of Table 2 at one period."""
    kp, kv, *_ = GAINS[m]
    return sampled(kp, (kv,) * 3, Fraction(milliseconds) / 1000, m=m, **PRINTED | others)


proof.section("A reading every 2.5 ms, its torque at once")
for m in GAINS:
    proof.add(
        f"sampled.m{m}",
        f"m{m} of Table 2, read every {PERIOD} ms, is globally asymptotically stable if six things are so",
        loop(m),
        "Section 5",
    )

proof.section("Up to which period")
for m, (*_, most, late) in GAINS.items():
    proof.add(f"sampled.m{m}.period", f"so it is for m{m} at every period up to {most} ms", loop(m, most))
    proof.add(
        f"sampled.m{m}.late.period",
        f"with torques one sample late: up to {late} ms",
        loop(m, late, delay=1),
    )

proof.section("What m = 3 lacks, and one sample more")
proof.add(
    "sampled.m3.friction",
    f"at {PERIOD} ms friction of b₂ ≥ 0.4334 is enough for m3",
    loop(3, viscous_min=("0.406", "0.4334", "0.406")),
)
for m in GAINS:
    proof.add(
        f"sampled.m{m}.late",
        f"at {PERIOD} ms with torques one sample late, the goal is globally asymptotically stable under m{m}",
        loop(m, delay=1),
    )

proof.section("A load that the controller does not know")
for m in (1, 2):
    proof.add(
        f"sampled.m{m}.rest",
        f"no load makes the loop of m{m} swing for ever at {PERIOD} ms: it comes to rest, if not at its goal",
        loop(m, conclusion="rest"),
    )
